"""A process that is asked one thing after another; between two questions it waits, for a start takes long."""

import contextlib
import os
import queue
from collections.abc import Callable, Hashable, Mapping
from io import RawIOBase
from typing import Any, TypeVar

from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import BugError
from foon_asp.processes.pipe import receive, write
from foon_asp.processes.python_process import PythonProcess

Said = tuple[str, Any]
"""What a process says: of what kind it is, and a value."""


class DiedError(Exception):
    """A process died while it was asked, with an exit code."""

    def __init__(self, code: int) -> None:
        super().__init__(f"ended with exit code {code}")
        self.code = code


class Worker(PythonProcess):
    """A process in which ``serve`` of a module answers what it reads from standard input.

    ``read`` reads one thing that it says; by default a pickled kind and value.
    """

    def __init__(
        self,
        module: str,
        what: str,
        *options: str,
        stderr: int | None = None,
        read: Callable[[RawIOBase], Said] = receive,
    ) -> None:
        super().__init__(module, what, *options, stderr=stderr)
        self.has_spoken = False
        self._asked = False  # and has not answered: in the middle of something, or ended
        self._said: queue.SimpleQueue[Said | None] = queue.SimpleQueue()
        self.beside(_listen, self._in, read, self._said)

    @property
    def ready(self) -> bool:
        """Whether it can be asked."""
        return not self._asked and self.alive

    def ask(
        self, request: bytes, deadline: Deadline, hear: Mapping[str, Callable[[Any], None]] | None = None
    ) -> Said:
        """Send a request, pass on what is said on the way by its kind, and return the answer.

        Whatever is raised ends the process: :class:`LimitError` at a limit and at ctrl-C,
        :class:`DiedError` where the process died, and what ``hear`` raises.
        """
        if self._asked:
            raise BugError("a process was asked that had been ended")
        self._asked = True
        deadline.count(self._process.pid)
        try:
            self.beside(_write, self._out, request)
            while True:
                kind, value = self._next(deadline)
                if hear is None or kind not in hear:
                    break
                hear[kind](value)
        except BaseException as error:
            self.end()
            if isinstance(error, KeyboardInterrupt) and not isinstance(error, LimitError):
                deadline.interrupt()
                raise LimitError(deadline) from None
            raise
        finally:
            deadline.uncount(self._process.pid)
        self._asked = False
        return kind, value

    def tell(self, request: bytes) -> None:
        """Send what nothing is answered to, and so short that it does not wait until it is read."""
        _write(self._out, request)

    def _next(self, deadline: Deadline) -> Said:
        while True:
            with contextlib.suppress(queue.Empty):
                said = self._said.get(timeout=max(0.001, deadline.slice()))
                if said is None:
                    raise DiedError(self.died())
                self.has_spoken = True
                return said
            deadline.check()

    def end(self) -> int:
        """End the process, whatever it is at; give what it ended with."""
        self._asked = True
        return super().end()

    def abandon(self) -> None:
        """Let go of a process that belongs to another: this one is a copy of that one."""
        self._asked = True
        super().abandon()


W = TypeVar("W", bound=Worker)

# One for each key. Taken and given in one step each: a program that is dropped gives its process back in the
# middle of anything, and a lock might be held there.
_idle: dict[Hashable, Any] = {}


def take(key: Hashable, start: Callable[[], W]) -> W:
    """Return the process that waits under a key, or start one."""
    worker: W | None = _idle.pop(key, None)
    if worker is not None and worker.ready:
        return worker
    if worker is not None:
        worker.end()
    return start()


def give_back(key: Hashable, worker: Worker) -> None:
    """Let a process wait for whoever takes it; end one that cannot be asked, or where another waits."""
    if not worker.ready or _idle.setdefault(key, worker) is not worker:
        worker.end()


def _write(pipe: RawIOBase, content: bytes) -> None:
    with contextlib.suppress(OSError, ValueError):  # that it died is seen where the answer is waited for
        write(pipe, content)


def _listen(
    pipe: RawIOBase, read: Callable[[RawIOBase], Said], said: "queue.SimpleQueue[Said | None]"
) -> None:
    with contextlib.suppress(EOFError):
        while True:
            said.put(read(pipe))
    said.put(None)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_idle.clear)  # those there are belong to the other
