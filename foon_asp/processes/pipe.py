"""Messages through pipes between two processes of this program: pickled values, each after its length."""

import contextlib
import os
import pickle
import queue
import signal
import struct
import sys
from collections.abc import Callable
from io import FileIO, RawIOBase
from typing import Any, TypeVar

from foon_asp.daemon_thread import DaemonThread

T = TypeVar("T")

OUT_OF_MEMORY = 77
"""The exit code of a process that ran out of memory."""

CHUNK_BYTES = 1 << 20
"""Bytes of a pipe that are read at once: memory is allocated as content arrives."""

_LENGTH_HEADER = struct.Struct("!Q")


def pack_message(value: object) -> bytes:
    """Return a value as the bytes of a message, which :func:`receive` reads."""
    content = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    return _LENGTH_HEADER.pack(len(content)) + content


def write(pipe: RawIOBase, content: bytes) -> None:
    """Write all of ``content``; raises ``OSError`` if the other end is closed."""
    unwritten = memoryview(content)
    while unwritten:
        unwritten = unwritten[pipe.write(unwritten) :]


def write_if_open(pipe: RawIOBase, content: bytes) -> None:
    """Write all of ``content``; do nothing if the other end is closed.

    The thread that reads from the other process notices its end as well, so nothing is raised here.
    """
    with contextlib.suppress(OSError, ValueError):
        write(pipe, content)


def send(pipe: RawIOBase, value: object) -> None:
    """Write a value as a message; raises ``OSError`` where the other end is closed."""
    write(pipe, pack_message(value))


def receive(pipe: RawIOBase) -> Any:
    """Wait for a message, and return its value; raises ``EOFError`` where the other end is closed."""
    return pickle.loads(receive_pickled(pipe))


def receive_pickled(pipe: RawIOBase) -> bytes:
    """Wait for a message, and return it without unpickling it.

    Raises ``EOFError`` where the other end is closed.
    """
    (length,) = _LENGTH_HEADER.unpack(_read_exactly(pipe, _LENGTH_HEADER.size))
    return _read_exactly(pipe, length)


def become_worker(read: Callable[[RawIOBase], T]) -> "tuple[queue.SimpleQueue[T], FileIO]":
    """Make this process a worker: return the queue of its requests, and the pipe for its answers.

    A thread reads requests from standard input by ``read``, and puts them into the queue. The thread ends the
    process when the parent process has ended, even during a computation. It also does so if memory runs out
    while it reads.

    Answers go to what was standard output. Whatever else this process prints goes to standard error. Standard
    input is empty for all other code. Ctrl-C is ignored, since the parent handles it.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    incoming, answers = FileIO(os.dup(0), "rb"), FileIO(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    received: queue.SimpleQueue[T] = queue.SimpleQueue()

    def listen() -> None:
        """Put each request into the queue; end the process at the end of standard input or without memory."""
        while True:
            try:
                received.put(read(incoming))
            except EOFError:  # the parent has ended
                os._exit(0)
            except MemoryError:
                os._exit(OUT_OF_MEMORY)

    DaemonThread(listen)
    return received, answers


def _read_exactly(pipe: RawIOBase, size: int) -> bytes:
    """Read and return ``size`` bytes; raises ``EOFError`` if the pipe ends or is closed before."""
    chunks: list[bytes] = []
    while size:
        try:
            chunk = pipe.read(min(size, CHUNK_BYTES))
        except (OSError, ValueError):  # closed
            chunk = None
        if not chunk:
            raise EOFError
        chunks.append(chunk)
        size -= len(chunk)
    return b"".join(chunks)
