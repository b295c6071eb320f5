"""What every second engine is asked and answers."""

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import NamedTuple, Protocol

from foon_asp.asp import Outcome, Settings
from foon_asp.problem import Objective, Problem, backwards, executable_order, multiplies
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.rules.constraint import Constraint

_GREATEST = 10**9  # of what a unit costs: beside more, floats lose costs that count


class Asked(NamedTuple):
    """An answer to be checked, and all that it was asked under.

    ``soft`` are the weights of constraints that may be broken, and ``penalty`` is what the tree of the
    outcome is said to pay for those it breaks.
    """

    outcome: Outcome
    settings: Settings = Settings()
    soft: Mapping[Constraint, int] = {}
    penalty: int | None = None


class EngineAnswer(NamedTuple):
    """What an engine says.

    ``units`` is a tree that it calls best by ``objectives``, of which it looks at the first or at all, or
    ``None`` where it says that there is no tree. ``finished`` is false where it stopped before an answer.
    """

    engine: str
    objectives: tuple[Objective, ...]
    units: tuple[int, ...] | None
    finished: bool


class Solve(Protocol):
    """The function of an engine, ours or that of another package (docs/entry-points.md)."""

    def __call__(
        self,
        problem: Problem,
        objectives: tuple[Objective, ...],
        forbidden: frozenset[int],
        seconds: float,
        /,
    ) -> EngineAnswer:
        """Find a best tree by objectives, of which the first counts most, without the forbidden units.

        It may look only at the first of the objectives, and then says so. It gives up after ``seconds``.
        Raises :class:`NotCheckedError` for what it cannot be asked.
        """


class Engine(NamedTuple):
    """A second engine that knows no constraints but units ruled out, whether it is there, how it is asked.

    ``package`` is the one that it is of if it is not ours.
    """

    name: str
    installed: Callable[[], bool]
    solve: Solve
    package: str | None = None


class DisagreementError(Exception):
    """Two engines give answers that cannot both be right: a bug, here or there.

    ``ours`` says that it is here: the tree of the other is one, and better than what we call the best.
    """

    def __init__(self, message: str, answer: EngineAnswer, ours: bool = False) -> None:
        super().__init__(message)
        self.answer, self.ours = answer, ours


def differing(
    by: str, ours: int | Fraction, theirs: int | Fraction, answer: EngineAnswer, more_is_better: bool = False
) -> DisagreementError:
    """Return the error that two trees called best cost something else by an objective."""
    better = theirs > ours if more_is_better else theirs < ours
    which = "ours is not the best" if better else f"{answer.engine} calls a worse one the best"
    words = f"by {by} our tree has {ours}, the one of {answer.engine} {theirs}; {which}"
    return DisagreementError(words, answer, ours=better)


class NotCheckedError(Exception):
    """An engine says nothing of an answer, neither for it nor against it; the message says why."""


def check_tree(problem: Problem, answer: EngineAnswer) -> tuple[int, ...]:
    """Return the units of an engine's tree in an order that executes; raises :class:`DisagreementError`."""
    order = executable_order(problem, answer.units or ())
    if order is None or simulate_for(problem, problem.tree(order)).verdict is not Verdict.AS_LISTED:
        raise DisagreementError(f"the tree of {answer.engine} does not execute", answer)
    return order


class Scope(NamedTuple):
    """The units that the goals can need, and the nodes that would have to be made."""

    units: list[int]
    objects: list[int]
    goals: list[int]


def scope_of(problem: Problem, forbidden: frozenset[int]) -> Scope:
    """Go back from the goals to the kitchen through all units that are not forbidden, can they run or not."""
    allowed = frozenset(range(len(problem.network))) - forbidden
    units, objects = backwards(problem.goals, problem.makers, problem.needs, problem.kitchen, allowed)
    return Scope(sorted(units), sorted(objects), [goal for goal in problem.goals if goal in objects])


def cost(problem: Problem, objective: Objective, unit: int) -> float:
    """Return what a unit alone costs: a whole number, but for ``success``; ``kitchen`` is no such cost."""
    if multiplies(objective):
        rate = problem.rate(unit)
        return math.log(rate.denominator) - math.log(rate.numerator)
    figure = problem.figure(objective, unit)
    if figure > _GREATEST:
        raise NotCheckedError("a unit costs more than its floats hold beside others")
    return float(figure)


def taken(problem: Problem, units: Iterable[int]) -> list[int]:
    """Return the kitchen items that some units need."""
    return sorted({o for unit in units for o in problem.needs[unit] if o in problem.kitchen})
