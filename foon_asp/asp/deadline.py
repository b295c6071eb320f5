"""When to stop."""

import time


class Deadline:
    """A moment after which to stop, shared by all runs of one question; ``None`` is never."""

    def __init__(self, seconds: float | None) -> None:
        self._end = None if seconds is None else time.monotonic() + seconds
        self.interrupted = False

    @property
    def passed(self) -> bool:
        """Whether to stop, by time or by ctrl-C."""
        return self.interrupted or (self._end is not None and time.monotonic() >= self._end)

    def slice(self, longest: float = 0.2) -> float:
        """Give how long to wait before looking at the clock again."""
        return longest if self._end is None else max(0.0, min(longest, self._end - time.monotonic()))
