"""Runs of HiGHS that end when time is up."""

from collections.abc import Callable
from typing import Any, NamedTuple

from foon_asp.daemon_thread import DaemonThread
from foon_asp.deadline import uninterrupted


class RunTuning(NamedTuple):
    """How HiGHS is run such that it ends when time is up.

    ``small_size``: columns plus rows of a program. A larger program is run in a thread of its own.
    ``steps``: steps of the simplex algorithm between two checks of the time, outside a thread. They take
    about a second.
    ``poll_seconds``: seconds between two checks of the time, for a program in a thread.
    ``end_seconds``: seconds that HiGHS has to end in its thread when time is up. A step of the interior-point
    method may take longer.
    """

    small_size: int = 6000
    steps: int = 4000
    poll_seconds: float = 0.05
    end_seconds: float = 0.3


RUN = RunTuning()


def libraries() -> tuple[Any, Any]:
    """Return the modules highspy and numpy; they are imported here, not earlier, since that is slow."""
    with uninterrupted():
        import highspy  # noqa: PLC0415
        import numpy as np  # noqa: PLC0415

    return highspy, np


def silent_highs() -> Any:
    """Return an instance of HiGHS that writes nothing.

    From version 1.16 on, HiGHS writes its name already at construction, when it enables callbacks.
    """
    libraries()
    import highspy  # noqa: PLC0415 (it is there now)

    class Silent(highspy.Highs):
        """HiGHS without output."""

        def enableCallbacks(self) -> None:  # noqa: N802
            """Turn off the output, then enable callbacks."""
            self.setOptionValue("output_flag", False)
            super().enableCallbacks()  # type: ignore[no-untyped-call]

    return Silent()  # type: ignore[no-untyped-call]


def run(highs: Any, expired: Callable[[], bool], has_integers: bool = False) -> bool:
    """Run HiGHS on its model; return whether it ended before time was up.

    ``expired`` returns whether time is up, and ``has_integers`` tells whether the model has integer
    variables. A large model, or one with integer variables, is run in a thread of its own. If time was up,
    the current solution can be read. Raises ``KeyboardInterrupt`` if HiGHS does not stop when time is up.
    After that, ``highs`` must not be used.
    """
    if has_integers or highs.getNumCol() + highs.getNumRow() > RUN.small_size:
        return _Run(highs, expired).wait()
    import highspy  # noqa: PLC0415 (slow to import, so only when it is there already)

    highs.setOptionValue("simplex_iteration_limit", RUN.steps)
    highs.run()
    while highs.getModelStatus() == highspy.HighsModelStatus.kIterationLimit:
        if expired():
            return False
        highs.run()
    return True


class _Run:
    """A run of HiGHS in a thread of its own, with a callback that can interrupt it.

    In the main thread, ctrl-C could raise an exception during the callback. HiGHS does not survive that.
    """

    def __init__(self, highs: Any, expired: Callable[[], bool]) -> None:
        self._highs, self._expired = highs, expired
        self._stopped = False

    def wait(self) -> bool:
        """Run HiGHS until it ends or time is up; return whether it ended by itself.

        Ctrl-C stops HiGHS as well, and is passed on. Raises ``KeyboardInterrupt`` if HiGHS does not stop
        within ``RUN.end_seconds`` after time is up.
        """
        import highspy  # noqa: PLC0415 (slow to import, so only when it is there already)

        kinds = highspy.cb.HighsCallbackType
        self._highs.setOptionValue("simplex_iteration_limit", highspy.kHighsIInf)
        self._highs.setCallback(self._interrupt_if_stopped, None)
        for name in ("kCallbackSimplexInterrupt", "kCallbackIpmInterrupt", "kCallbackMipInterrupt"):
            self._highs.startCallback(getattr(kinds, name))
        thread = DaemonThread(self._highs.run)
        try:
            while not thread.wait_for_end(RUN.poll_seconds) and not self._expired():
                pass
        finally:
            self._stopped = not thread.wait_for_end(0)
            ended = thread.wait_for_end(RUN.end_seconds)
        if not ended:
            raise KeyboardInterrupt
        return bool(self._highs.getModelStatus() != highspy.HighsModelStatus.kInterrupt)

    def _interrupt_if_stopped(self, _: object, __: object, ___: object, answer: Any, ____: object) -> None:
        """Make HiGHS end if :meth:`wait` has stopped the run; HiGHS calls this between its steps."""
        if self._stopped:
            answer.user_interrupt = True
