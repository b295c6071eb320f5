"""Asking what another package offers, in a process of its own: whatever it does, it does there.

It cannot change our data, nor keep us past a limit, nor print among our answers. What it gives is JSON, and
nothing of it is believed.
"""

import atexit
import contextlib
import json
import os
import pickle
import queue
import signal
import sys
import threading
from io import RawIOBase
from typing import Any, cast

from foon_asp.deadline import Deadline
from foon_asp.offered.offer import Offer, Raised
from foon_asp.python_process import start_python

_MOST = 64 * 2**20  # bytes of an answer


def ask_offered(offer: Offer, deadline: Deadline, *arguments: object) -> Any:
    """Call the function that is offered, and give what it gave as plain values; ``Raised`` if it raised.

    Raises :class:`~foon_asp.deadline.LimitError` at a limit, and :class:`UserError` where there is no such
    function, or none that ends with plain values.
    """
    key = (offer.package, *sys.path)
    process = _idle.pop(key, None)
    if process is None or not process.alive:
        process = _Process()
        _all.add(process)
    try:
        line = process.ask(pickle.dumps((offer, arguments), pickle.HIGHEST_PROTOCOL), deadline)
    except BaseException:
        process.end()
        raise
    if not line.endswith(b"\n"):
        code = process.end()
        raise offer.fault(
            "gave more than an answer can be" if len(line) > _MOST else f"ended its process ({code})"
        )
    if _idle.setdefault(key, process) is not process:
        process.end()
    try:
        kind, value = json.loads(line)
    except (ValueError, TypeError, RecursionError):
        raise offer.fault("gave what cannot be read") from None
    if kind == "fault":
        raise offer.fault(*value)
    return Raised(tuple(value[0]), *value[1:]) if kind == "raised" else value


class _Process:
    """A process that imports what a package offers, and calls it."""

    def __init__(self) -> None:
        self._process = start_python("foon_asp.offered.worker", "what other packages offer is run")
        self._out = cast("RawIOBase", self._process.stdin)
        self._in = cast("RawIOBase", self._process.stdout)
        self._thread: threading.Thread | None = None

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def ask(self, request: bytes, deadline: Deadline) -> bytes:
        """Send a request and give the answer, a line; it has no end where it is too long, or cut off."""
        answers: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._exchange, args=(request, answers), daemon=True)
        self._thread.start()
        deadline.count(self._process.pid)
        try:
            while True:
                with contextlib.suppress(queue.Empty):
                    return answers.get(timeout=max(0.001, deadline.slice()))
                deadline.check()
        finally:
            deadline.uncount(self._process.pid)

    def _exchange(self, request: bytes, answers: "queue.SimpleQueue[bytes]") -> None:
        line = bytearray()
        with contextlib.suppress(OSError, ValueError):
            left = memoryview(len(request).to_bytes(8, "big") + request)
            while left:
                left = left[self._out.write(left) :]
            while not line.endswith(b"\n") and len(line) <= _MOST:
                part = self._in.read(1 << 20)
                if not part:
                    break
                line += part
        answers.put(bytes(line))

    def end(self) -> int:
        """End the process, and those it has started, whatever they are at; give what it ended with."""
        _all.discard(self)
        if hasattr(os, "killpg"):
            with contextlib.suppress(OSError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        code = self._process.wait()
        if self._thread is not None:
            self._thread.join(5)  # before another file gets the number that it reads from
        self._close()
        return code

    def abandon(self) -> None:
        """Let go of a process that belongs to another: this one is a copy of that one."""
        self._process.returncode = 0
        self._close()

    def _close(self) -> None:
        for pipe in (self._out, self._in):
            with contextlib.suppress(OSError):
                pipe.close()


_idle: dict[tuple[str, ...], _Process] = {}  # by package, and where it was found
_all: set[_Process] = set()


def _end_all() -> None:
    for process in list(_all):
        process.end()


def _forget_all() -> None:
    """Know of no process after a fork: those there are belong to the other."""
    for process in _all:
        process.abandon()
    _all.clear()
    _idle.clear()


atexit.register(_end_all)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)
