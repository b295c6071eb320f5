"""The wrapper of public functions, which take a path or data for a problem, and report progress."""

import functools
import inspect
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from foon_asp.argument_checks import checker
from foon_asp.asp.reporter import Reporter
from foon_asp.deadline import Deadline, stoppable
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.problem.progress import OnProgress, Progress
from foon_asp.questions.caller import asked_by, caller, is_python

P = ParamSpec("P")
T = TypeVar("T")

_POSING = ("goal", "containers")

HELP = {
    "goal": "A goal or several, by name or as :class:`ObjectNode`, where ``problem`` is a path or data; "
    "without it, the goal of the files.",
    "containers": "The container rule, ``strict`` or ``implied``, where ``problem`` is a path or data.",
    "on_progress": "Is called with a :class:`Progress` whenever something is found.",
    "cancel": "A token that ends the question from another thread, with what was found by then.",
}
"""The descriptions of parameters that questions share, by name."""


class _Listener(Reporter):
    """A reporter that passes progress to a function, and warnings to the caller.

    Statistics of clingo are dropped.
    """

    def __init__(self, on_progress: OnProgress, reporter: Reporter) -> None:
        self._on_progress, self._reporter = on_progress, reporter
        self._progress = Progress()

    def warning(self, message: str) -> None:
        """Pass a warning on to the caller's reporter."""
        self._reporter.warning(message)

    def tree(self, costs: Costs) -> None:
        """Report the progress with the costs of a new incumbent."""
        self._report(self._progress._replace(costs=costs))

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Report the progress with a new bound by an objective."""
        self._report(self._progress._replace(bounds={**self._progress.bounds, objective: bound}))

    def step(self, word: str, done: int, total: int) -> None:
        """Report the progress with the number of answers that are done, and their total; drop ``word``."""
        self._report(self._progress._replace(done=done, total=total))

    def _report(self, progress: Progress) -> None:
        """Call the function with the progress, and keep the progress for the next report."""
        self._progress = progress
        self._on_progress(progress)


def wrap_for_python(ask: Callable[P, T], signature: inspect.Signature) -> Callable[P, T]:
    """Return the function of a question for Python, with the options ``cancel`` and ``on_progress``.

    ``ask`` is the function to wrap. A path or data may be given in place of its problem. In a call from
    Python, arguments are checked against the ``signature``; a command has read them already. The token
    ``cancel`` ends the call with what was found by then. If this takes too long, the call raises
    :class:`StoppedError`. The function ``on_progress`` gets each :class:`Progress`.
    """
    name, check = ask.__name__, checker(ask, signature)

    @functools.wraps(ask)
    def wrapped(*about: P.args, **named: P.kwargs) -> T:
        """Pose the problem, check the arguments, and call the function with its limits and reporter."""
        if is_python():  # commands hand over what they have read
            about = arguments_with_problem(name, signature.parameters, about, named)
            check(about, named)
        token: Any = named.pop("cancel", None)
        on_progress: Any = named.pop("on_progress", None)
        if token is None and on_progress is None:
            with stoppable(None, None, f"asking {name}") if is_python() else nullcontext():
                return ask(*about, **named)
        current_caller = caller()
        reporter = (
            current_caller.reporter
            if on_progress is None
            else _Listener(on_progress, current_caller.reporter)
        )
        with (
            stoppable(None, token, f"asking {name}") as deadline,
            asked_by(
                current_caller._replace(
                    reporter=reporter, deadline=current_caller.deadline or Deadline(within=deadline)
                )
            ),
        ):
            return ask(*about, **named)

    wrapped.__dict__["__signature__"] = signature
    return wrapped


def arguments_with_problem(
    name: str, parameters: Mapping[str, object], positional: tuple[Any, ...], named: dict[str, Any]
) -> Any:
    """Return the positional arguments of a question, with a problem in place of a path or of data.

    ``name`` and ``parameters`` are those of the question. ``positional`` and ``named`` are the arguments of
    the call. If the question is about no problem, ``positional`` is returned unchanged. If it can be about
    data as well (its parameter is ``about``), it gets data if no goal is named. ``named`` is changed in
    place: the goal and the container rule of the problem are removed, and ``objective`` becomes
    ``objectives``.

    Raises :class:`UserError` for a call without a subject, for a path that does not exist, and for a goal
    beside a problem, which has its own.
    """
    from foon_asp.foon import Foon, load  # noqa: PLC0415 (commands ask about what they have read)

    if "objective" in named and "objectives" in parameters:
        named["objectives"] = named.pop("objective")
    subject = next(iter(parameters))
    if subject not in {"problem", "about"}:
        return positional
    subject_value = positional[0] if positional else named.pop(subject, None)
    if subject_value is None:
        raise UserError(f"{name} of what? {name}('eggs.txt'), or {name}(foon_asp.load(), goal='macaroni')")
    is_whole = subject == "about" and "goal" not in named  # the data themselves are the subject
    names_given = [option for option in _POSING if option in named and option in parameters and not is_whole]
    posing = {option: named.pop(option) for option in names_given}
    if isinstance(subject_value, Problem) and posing:
        raise UserError(f"{name}: a problem has its own {' and '.join(posing)}; Foon.problem takes them")
    if not isinstance(subject_value, str | PathLike | Foon):
        return (subject_value, *positional[1:])
    if isinstance(subject_value, str) and not Path(subject_value).exists():
        hint = f"a goal of the bundled kitchen: {name}(foon_asp.load(), goal={subject_value!r})"
        raise UserError(f"no such file or folder: {subject_value} ({hint})")
    foon = subject_value if isinstance(subject_value, Foon) else load(subject_value)
    if is_whole:
        return (foon, *positional[1:])
    goals = posing.pop("goal", ())
    is_single = isinstance(goals, str | ObjectNode)
    return (foon.problem(*([goals] if is_single else goals), **posing), *positional[1:])
