"""The interface of second engines, and functions that the built-in engines share."""

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import NamedTuple, Protocol

from foon_asp.asp import Outcome, Settings
from foon_asp.problem import Objective, Problem, executable_order, multiplies, search_backward
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.rules.passed_constraint import Constraint


class ClaimedAnswer(NamedTuple):
    """An answer to be checked.

    ``outcome``: the answer.
    ``settings``: the settings under which the answer was found.
    ``soft``: the weight of each soft constraint.
    ``penalty``: the claimed penalty of the tree: the sum of the weights of the soft constraints that it
    violates; ``None`` without soft constraints.
    """

    outcome: Outcome
    settings: Settings = Settings()
    soft: Mapping[Constraint, int] = {}
    penalty: int | None = None


class EngineAnswer(NamedTuple):
    """The answer of an engine.

    ``engine``: the name of the engine.
    ``objectives``: the first objectives of the question, at least one, by which the engine optimized.
    ``units``: the unit ids of a tree that the engine claims to be optimal by these objectives; ``None`` if it
    claims that no tree exists, or has not finished.
    ``finished``: false if the engine stopped before it had an answer.
    """

    engine: str
    objectives: tuple[Objective, ...]
    units: tuple[int, ...] | None
    finished: bool


class Solve(Protocol):
    """The interface of the function with which an engine solves a question (docs/entry-points.md)."""

    def __call__(
        self,
        problem: Problem,
        objectives: tuple[Objective, ...],
        forbidden: frozenset[int],
        seconds: float,
        /,
    ) -> EngineAnswer:
        """Search for a lexicographically optimal tree without the forbidden units.

        ``objectives`` are in order of importance, and ``forbidden`` are unit ids. An engine may optimize by
        the first objectives only; its answer then names only these. After ``seconds``, the engine stops and
        returns an answer that is not ``finished``.

        Raises :class:`NotCheckedError` for a problem or objective that the engine does not support.
        """


class Engine(NamedTuple):
    """A second engine, which supports no constraints except forbidden units.

    ``installed``: returns whether the engine can run.
    ``solve``: runs the engine.
    ``package``: the distribution that offers the engine; ``None`` for a built-in engine.
    """

    name: str
    installed: Callable[[], bool]
    solve: Solve
    package: str | None = None


class DisagreementError(Exception):
    """Two engines give answers that cannot both be right: one of them has a bug.

    ``answer``: the answer of the other engine.
    ``is_our_bug``: whether the bug is known to be in foon-asp: the tree of the other engine is valid, and
    better than the one that we call optimal.
    """

    def __init__(self, message: str, answer: EngineAnswer, is_our_bug: bool = False) -> None:
        super().__init__(message)
        self.answer, self.is_our_bug = answer, is_our_bug


def difference_error(
    measure: str,
    ours: int | Fraction,
    theirs: int | Fraction,
    answer: EngineAnswer,
    more_is_better: bool = False,
) -> DisagreementError:
    """Return the error for two trees that are both called optimal but differ in cost by ``measure``.

    ``ours`` and ``theirs`` are the costs of our tree and of the engine's tree. If the engine's tree is
    better, the error says that the bug is ours. The better cost is the smaller one or, with
    ``more_is_better``, the greater one.
    """
    better = theirs > ours if more_is_better else theirs < ours
    verdict = "ours is not the best" if better else f"{answer.engine} calls a worse one the best"
    message = f"by {measure} our tree has {ours}, the one of {answer.engine} {theirs}; {verdict}"
    return DisagreementError(message, answer, is_our_bug=better)


class NotCheckedError(Exception):
    """An engine neither confirms an answer nor contradicts it; the message says why."""


def check_tree(problem: Problem, answer: EngineAnswer) -> tuple[int, ...]:
    """Return the unit ids of an engine's tree in an executable order; an empty tuple if it has no tree.

    The order is checked by simulation. Raises :class:`DisagreementError` if the tree does not execute in any
    order.
    """
    order = executable_order(problem, answer.units or ())
    if order is None or simulate_for(problem, problem.tree(order)).verdict is not Verdict.AS_LISTED:
        raise DisagreementError(f"the tree of {answer.engine} does not execute", answer)
    return order


class Scope(NamedTuple):
    """The relevant part of a problem.

    ``units``: the ids of the units that the goals can need, ascending.
    ``objects``: the ids of the object nodes that the goals can need and that the kitchen lacks, ascending.
    ``goals``: the ids of the goals among these object nodes.
    """

    units: list[int]
    objects: list[int]
    goals: list[int]


def scope_of(problem: Problem, forbidden: frozenset[int]) -> Scope:
    """Return the part of a problem that is found backwards from the goals.

    The search goes through units that are not forbidden, and stops at kitchen items.
    """
    allowed = frozenset(range(len(problem.network))) - forbidden
    units, objects = search_backward(problem.goals, problem.makers, problem.needs, problem.kitchen, allowed)
    return Scope(sorted(units), sorted(objects), [goal for goal in problem.goals if goal in objects])


def float_cost(problem: Problem, objective: Objective, unit: int) -> float:
    """Return the cost of a unit by an objective other than ``kitchen``; for ``success``, -ln of its rate.

    Raises :class:`NotCheckedError` if the cost is above 10^9, since floats lose small costs beside it. Raises
    ``ValueError`` for a rate of 0.
    """
    if multiplies(objective):
        rate = problem.rate(unit)
        return math.log(rate.denominator) - math.log(rate.numerator)
    figure = problem.figure(objective, unit)
    if figure > 10**9:  # beside it in a sum, floats of 53 bits lose small costs
        raise NotCheckedError("a unit costs more than its floats hold beside others")
    return float(figure)


def kitchen_items(problem: Problem, units: Iterable[int]) -> list[int]:
    """Return the ids of the kitchen items that are preconditions of some units, ascending."""
    return sorted({o for unit in units for o in problem.needs[unit] if o in problem.kitchen})
