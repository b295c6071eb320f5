"""A run of HiGHS, which ends when time is up."""

from collections.abc import Callable
from typing import Any, Final

from foon_asp.aside import Aside
from foon_asp.deadline import uninterrupted

_SMALL: Final = 6000  # columns and rows, with which so many steps take at most about a second
_STEPS: Final = 4000  # of the simplex algorithm
_LOOKS = 0.05  # seconds between two looks at the time
_LATE = 0.3  # seconds that HiGHS has to end; a step of the interior point method may take longer


def libraries() -> tuple[Any, Any]:
    """Import HiGHS and numpy, which takes ten times as long as all else here: only when needed."""
    with uninterrupted():
        import highspy  # noqa: PLC0415
        import numpy as np  # noqa: PLC0415

    return highspy, np


def silent_highs() -> Any:
    """Make an instance of HiGHS that writes nothing.

    From version 1.16 on, it writes its name when it is made, where it sets callbacks, before it has options.
    """
    libraries()
    import highspy  # noqa: PLC0415 (it is there now)

    class Silent(highspy.Highs):
        def enableCallbacks(self) -> None:  # noqa: N802
            self.setOptionValue("output_flag", False)
            super().enableCallbacks()  # type: ignore[no-untyped-call]

    return Silent()  # type: ignore[no-untyped-call]


def run(highs: Any, expired: Callable[[], bool], whole: bool = False) -> bool:
    """Let HiGHS solve what it was told, in ``whole`` numbers if it was; whether there was time to its end.

    Else what it has by then can be read. Raises ``KeyboardInterrupt`` where it does not end even then, after
    which it may not be asked anything.
    """
    if whole or highs.getNumCol() + highs.getNumRow() > _SMALL:
        return _Run(highs, expired).wait()
    import highspy  # noqa: PLC0415 (slow to import, so only when it is there already)

    highs.setOptionValue("simplex_iteration_limit", _STEPS)
    highs.run()
    while highs.getModelStatus() == highspy.HighsModelStatus.kIterationLimit:
        if expired():
            return False
        highs.run()
    return True


class _Run:
    """A run in a thread of its own, in which HiGHS asks at each step whether to go on.

    In this one, ctrl-C could come while it asks, and it does not survive exceptions there.
    """

    def __init__(self, highs: Any, expired: Callable[[], bool]) -> None:
        self._highs, self._expired = highs, expired
        self._stopped = False

    def wait(self) -> bool:
        import highspy  # noqa: PLC0415 (slow to import, so only when it is there already)

        kinds = highspy.cb.HighsCallbackType
        self._highs.setOptionValue("simplex_iteration_limit", highspy.kHighsIInf)
        self._highs.setCallback(self._look, None)
        for name in ("kCallbackSimplexInterrupt", "kCallbackIpmInterrupt", "kCallbackMipInterrupt"):
            self._highs.startCallback(getattr(kinds, name))
        beside = Aside(self._highs.run)
        try:
            while not beside.ended(_LOOKS) and not self._expired():
                pass
        finally:
            self._stopped = not beside.ended(0)
            ended = beside.ended(_LATE)
        if not ended:
            raise KeyboardInterrupt
        return bool(self._highs.getModelStatus() != highspy.HighsModelStatus.kInterrupt)

    def _look(self, _: object, __: object, ___: object, answer: Any, ____: object) -> None:
        if self._stopped:
            answer.user_interrupt = True
