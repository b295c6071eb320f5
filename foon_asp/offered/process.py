"""Asking what another package offers, in a process of its own: whatever it does, it does there.

It cannot change our data, nor keep us past a limit, nor print among our answers. What it gives is JSON, and
nothing of it is believed.
"""

import contextlib
import json
import os
import queue
import signal
import sys
from typing import Any

from foon_asp.deadline import Deadline
from foon_asp.offered.offer import Offer, Raised
from foon_asp.pipe import packed, write
from foon_asp.python_process import PythonProcess

_MOST = 64 * 2**20  # bytes of an answer


def ask_offered(offer: Offer, deadline: Deadline, *arguments: object) -> Any:
    """Call the function that is offered, and give what it gave as plain values; ``Raised`` if it raised.

    Raises :class:`~foon_asp.deadline.LimitError` at a limit, and :class:`UserError` where there is no such
    function, or none that ends with plain values.
    """
    key = (offer.package, *sys.path)
    process = _idle.pop(key, None)
    if process is None or not process.alive:
        process = _Process("foon_asp.offered.worker", "what other packages offer is run")
    try:
        line = process.ask(packed((offer, arguments)), deadline)
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


class _Process(PythonProcess):
    """A process that imports what a package offers, and calls it."""

    def ask(self, request: bytes, deadline: Deadline) -> bytes:
        """Send a request and give the answer, a line; it has no end where it is too long, or cut off."""
        answers: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self.beside(self._exchange, request, answers)
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
            write(self._out, request)
            while not line.endswith(b"\n") and len(line) <= _MOST:
                part = self._in.read(1 << 20)
                if not part:
                    break
                line += part
        answers.put(bytes(line))

    def end(self) -> int:
        """End the process, and those it has started, whatever they are at; give what it ended with."""
        if hasattr(os, "killpg"):
            with contextlib.suppress(OSError):
                os.killpg(self._process.pid, signal.SIGKILL)
        return super().end()


_idle: dict[tuple[str, ...], _Process] = {}  # by package, and where it was found
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_idle.clear)
