"""Background threads without the locks of :mod:`threading`.

An interrupt while a thread holds such a lock leaves it locked. The next thread that takes the lock then waits
forever. Operations of ``SimpleQueue`` are atomic, and cannot be interrupted.
"""

import _thread
import contextlib
from collections.abc import Callable
from queue import Empty, SimpleQueue


class DaemonThread:
    """A daemon thread that calls a function: the process does not wait for it at exit."""

    def __init__(self, function: Callable[..., object], *arguments: object) -> None:
        """Start the thread, which calls the function with the arguments."""
        self._finished = False
        self._wake: SimpleQueue[None] = SimpleQueue()
        _thread.start_new_thread(self._call, (function, arguments))

    def wait_for_end(self, seconds: float) -> bool:
        """Wait at most ``seconds`` for the end of the thread; return whether it has ended."""
        if not self._finished:
            with contextlib.suppress(Empty):
                self._wake.get(timeout=seconds)
        return self._finished

    def _call(self, function: Callable[..., object], arguments: tuple[object, ...]) -> None:
        """Call the function, and record its end, also if it raises an exception."""
        try:
            function(*arguments)
        finally:
            self._finished = True
            self._wake.put(None)
