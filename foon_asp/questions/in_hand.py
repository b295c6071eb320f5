"""What every function takes in Python: a time limit, who hears of progress, and a token that ends it."""

import functools
from collections.abc import Callable
from contextlib import nullcontext
from fractions import Fraction
from typing import Any, ParamSpec, TypeVar

from foon_asp.asp import Reporter
from foon_asp.deadline import Deadline, seconds, stoppable
from foon_asp.problem import Costs, Objective
from foon_asp.problem.progress import OnProgress, Progress
from foon_asp.questions.caller import asked_by, caller, is_python
from foon_asp.typed import checker

P = ParamSpec("P")
T = TypeVar("T")

HELP = {
    "time_limit": "Stop after this many seconds, with what was found by then.",
    "on_progress": "Is called with a :class:`Progress` whenever something is found.",
    "cancel": "A token that ends the question from another thread, with what was found by then.",
}


class _Listener(Reporter):
    """Passes on what is found to a function, and warnings to who asks."""

    def __init__(self, tell: OnProgress, warned: Reporter) -> None:
        self._tell, self._warned = tell, warned
        self._progress = Progress()

    def warning(self, message: str) -> None:
        """Pass on a warning."""
        self._warned.warning(message)

    def tree(self, costs: Costs) -> None:
        """Tell of a tree."""
        self._told(self._progress._replace(costs=costs))

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Tell of a bound."""
        self._told(self._progress._replace(bounds={**self._progress.bounds, objective: bound}))

    def step(self, word: str, done: int, total: int) -> None:
        """Tell of an answer."""
        self._told(self._progress._replace(done=done, total=total))

    def _told(self, progress: Progress) -> None:
        self._progress = progress
        self._tell(progress)


def in_hand(takes_time: bool) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Make a decorator that sees to ``cancel`` and ``on_progress`` of a function.

    So it does to ``time_limit``, unless the function ``takes_time`` limits itself.
    """

    def decorate(ask: Callable[P, T]) -> Callable[P, T]:
        name, check = ask.__name__, checker(ask)

        @functools.wraps(ask)
        def asked(*about: P.args, **named: P.kwargs) -> T:
            if is_python():  # commands hand over what they have read
                check(about, named)
            token: Any = named.pop("cancel", None)
            tell: Any = named.pop("on_progress", None)
            limit = None if takes_time else named.pop("time_limit", None)
            if token is None and tell is None and limit is None:
                with stoppable(None, None, f"asking {name}") if is_python() else nullcontext():
                    return ask(*about, **named)
            within = None if limit is None else seconds(limit)  # type: ignore[arg-type]
            who = caller()
            reporter = who.reporter if tell is None else _Listener(tell, who.reporter)
            with (
                stoppable(within, token, f"asking {name}") as deadline,
                asked_by(who._replace(reporter=reporter, deadline=who.deadline or Deadline(within=deadline))),
            ):
                return ask(*about, **named)

        return asked

    return decorate
