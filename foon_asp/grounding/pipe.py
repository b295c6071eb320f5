"""Values through pipes between two processes of this program, each with its length before it."""

import pickle
import struct
from io import RawIOBase
from typing import Any

OUT_OF_MEMORY = 77  # what a process ends with that has no more
_LENGTH = struct.Struct("!Q")


def send(pipe: RawIOBase, value: object) -> None:
    """Write a value; raises ``OSError`` where nobody reads any more."""
    content = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    left = memoryview(_LENGTH.pack(len(content)) + content)
    while left:
        written = pipe.write(left)
        left = left[written:]


def receive(pipe: RawIOBase) -> Any:
    """Wait for a value; raises ``EOFError`` where nobody writes any more."""
    (length,) = _LENGTH.unpack(_exactly(pipe, _LENGTH.size))
    return pickle.loads(_exactly(pipe, length))


def _exactly(pipe: RawIOBase, size: int) -> bytes:
    parts: list[bytes] = []
    while size:
        try:
            part = pipe.read(min(size, 1 << 20))
        except (OSError, ValueError):  # closed
            part = None
        if not part:
            raise EOFError
        parts.append(part)
        size -= len(part)
    return b"".join(parts)
