"""Values through pipes between two processes of this program, each with its length before it."""

import pickle
import struct
from io import RawIOBase
from typing import Any

_LENGTH = struct.Struct("!Q")


def packed(value: object) -> bytes:
    """Give a value as :func:`receive` reads it."""
    content = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    return _LENGTH.pack(len(content)) + content


def write(pipe: RawIOBase, content: bytes) -> None:
    """Write all of some bytes; raises ``OSError`` where nobody reads any more."""
    left = memoryview(content)
    while left:
        left = left[pipe.write(left) :]


def send(pipe: RawIOBase, value: object) -> None:
    """Write a value; raises ``OSError`` where nobody reads any more."""
    write(pipe, packed(value))


def receive(pipe: RawIOBase) -> Any:
    """Wait for a value; raises ``EOFError`` where nobody writes any more."""
    return pickle.loads(receive_packed(pipe))


def receive_packed(pipe: RawIOBase) -> bytes:
    """Wait for a value, and give it pickled; raises ``EOFError`` where nobody writes any more."""
    (length,) = _LENGTH.unpack(_exactly(pipe, _LENGTH.size))
    return _exactly(pipe, length)


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
