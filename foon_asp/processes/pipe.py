"""Values through pipes between two processes of this program, each with its length before it."""

import os
import pickle
import queue
import signal
import struct
import sys
from collections.abc import Callable
from io import FileIO, RawIOBase
from typing import Any, TypeVar

from foon_asp.aside import Aside

T = TypeVar("T")

OUT_OF_MEMORY = 77
"""The exit code of a process that has no more memory."""

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


def requests(read: Callable[[RawIOBase], T]) -> "tuple[queue.SimpleQueue[T], FileIO]":
    """Take standard input for requests, which ``read`` reads one by one, and standard output for answers.

    For a process that another one asks. Ctrl-C is for the other one, and whatever else this one prints goes
    to standard error. A thread reads, so that this process ends with the other one, whatever it is at.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    incoming, answers = FileIO(os.dup(0), "rb"), FileIO(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    asked: queue.SimpleQueue[T] = queue.SimpleQueue()

    def listen() -> None:
        while True:
            try:
                asked.put(read(incoming))
            except EOFError:  # nobody asks any more
                os._exit(0)
            except MemoryError:
                os._exit(OUT_OF_MEMORY)

    Aside(listen)
    return asked, answers


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
