"""A thread beside this one, without the locks of :mod:`threading`.

An interrupt may land in the middle of taking one of those, and whoever wants it next waits for ever. Queues
of the kind used here are told and asked in one step each, in which none lands.
"""

import _thread
import contextlib
from collections.abc import Callable
from queue import Empty, SimpleQueue


class Aside:
    """Calls a function in a thread that this process does not wait for at its end."""

    def __init__(self, function: Callable[..., object], *arguments: object) -> None:
        self._over = False
        self._wake: SimpleQueue[None] = SimpleQueue()
        _thread.start_new_thread(self._call, (function, arguments))

    def ended(self, seconds: float) -> bool:
        """Whether it has come to its end, for which this waits so long."""
        if not self._over:
            with contextlib.suppress(Empty):
                self._wake.get(timeout=seconds)
        return self._over

    def _call(self, function: Callable[..., object], arguments: tuple[object, ...]) -> None:
        try:
            function(*arguments)
        finally:
            self._over = True
            self._wake.put(None)
