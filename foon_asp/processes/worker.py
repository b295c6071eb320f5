"""Worker processes that answer requests one after the other; idle ones are kept, since a start is slow."""

import contextlib
import os
import queue
from collections.abc import Callable, Hashable, Mapping
from io import RawIOBase
from typing import Any, TypeVar

from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import BugError
from foon_asp.processes.pipe import receive, write_if_open
from foon_asp.processes.python_process import PythonProcess

Message = tuple[str, Any]
"""A message of a process: its kind, and a value."""


class DiedError(Exception):
    """A process died while it answered a request; ``code`` is its exit code, negative after a signal."""

    def __init__(self, code: int) -> None:
        super().__init__(f"ended with exit code {code}")
        self.code = code


class Worker(PythonProcess):
    """A process in which the function ``serve`` of a module answers requests from standard input.

    ``module``, ``activity``, ``options``, ``stderr``: as for :class:`PythonProcess`.
    ``read``: reads a message of the process; by default, a message is a pickled pair of kind and value.
    ``has_spoken``: whether the process has sent a message.
    """

    def __init__(
        self,
        module: str,
        activity: str,
        *options: str,
        stderr: int | None = None,
        read: Callable[[RawIOBase], Message] = receive,
    ) -> None:
        super().__init__(module, activity, *options, stderr=stderr)
        self.has_spoken = False
        self._busy = False  # from a request until its answer, and after the end
        self._messages: queue.SimpleQueue[Message | None] = queue.SimpleQueue()
        self.start_thread(_queue_messages, self._from_process, read, self._messages)

    @property
    def is_ready(self) -> bool:
        """Whether the process runs and has no request to answer."""
        return not self._busy and self.is_alive

    def ask(
        self, request: bytes, deadline: Deadline, handlers: Mapping[str, Callable[[Any], None]] | None = None
    ) -> Message:
        """Send a request, and return the answer: the first message whose kind has no handler.

        Earlier messages, such as progress, have a handler for their kind, which is called with the value. The
        memory of the process counts towards the limit of ``deadline``.

        Raises :class:`LimitError` at a limit. Ctrl-C also stops the deadline and raises :class:`LimitError`.
        Raises :class:`DiedError` if the process dies, and any exception of a handler. Each such exception
        ends the process. Raises :class:`BugError` for a process that is busy or was ended.
        """
        if self._busy:
            raise BugError("a process was asked that had been ended")
        self._busy = True
        deadline.count_memory_of(self._process.pid)
        try:
            self.start_thread(write_if_open, self._to_process, request)
            while True:
                kind, value = self._next_message(deadline)
                if handlers is None or kind not in handlers:
                    break
                handlers[kind](value)
        except BaseException as error:
            self.end()
            if isinstance(error, KeyboardInterrupt) and not isinstance(error, LimitError):
                deadline.interrupt()
                raise LimitError(deadline) from None
            raise
        finally:
            deadline.uncount_memory_of(self._process.pid)
        self._busy = False
        return kind, value

    def tell(self, request: bytes) -> None:
        """Send a request that has no answer; do nothing if the process has died.

        The request has to be short enough for the buffer of the pipe. Otherwise the call waits until the
        process reads it.
        """
        write_if_open(self._to_process, request)

    def _next_message(self, deadline: Deadline) -> Message:
        """Wait for a message and return it; raises :class:`DiedError` or, at a limit, :class:`LimitError`."""
        while True:
            with contextlib.suppress(queue.Empty):
                message = self._messages.get(timeout=max(0.001, deadline.seconds_to_next_check()))
                if message is None:
                    raise DiedError(self.wait_for_exit())
                self.has_spoken = True
                return message
            deadline.check()

    def end(self) -> int:
        """Kill the process and the processes that it has started; return its exit code.

        The worker is never ready again.
        """
        self._busy = True
        return super().end()

    def abandon(self) -> None:
        """Close the pipes, but let the process run.

        A copy of this program made by fork calls this, since the process is a child of the original program.
        """
        self._busy = True
        super().abandon()


W = TypeVar("W", bound=Worker)

# One worker for each key. Accesses are single atomic operations, and have no lock: the garbage collector may
# call ``give_back_worker`` at any time, also while the lock is held.
_idle: dict[Hashable, Any] = {}


def take_worker(key: Hashable, start: Callable[[], W]) -> W:
    """Return the idle worker that is kept for a key; it then is no longer idle.

    If the key has no idle worker, or if its worker has died, return a new one, which ``start`` starts.
    """
    worker: W | None = _idle.pop(key, None)
    if worker is not None and worker.is_ready:
        return worker
    if worker is not None:
        worker.end()
    return start()


def give_back_worker(key: Hashable, worker: Worker) -> None:
    """Keep a worker as the idle one of a key.

    If the worker is not ready, or if the key has another idle worker, kill it instead.
    """
    if not worker.is_ready or _idle.setdefault(key, worker) is not worker:
        worker.end()


def _queue_messages(
    pipe: RawIOBase, read: Callable[[RawIOBase], Message], messages: "queue.SimpleQueue[Message | None]"
) -> None:
    """Put the messages of a process into a queue, and ``None`` at the end of its output."""
    with contextlib.suppress(EOFError):
        while True:
            messages.put(read(pipe))
    messages.put(None)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_idle.clear)  # the workers are children of the parent
