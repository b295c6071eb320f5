"""The interface of second engines, and functions that the built-in engines share."""

import math
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import NamedTuple, Protocol

from foon_asp.asp import Outcome, Settings
from foon_asp.problem import Objective, Problem, executable_order, multiplies, search_backward
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.rules.passed_constraint import Constraint


class Asked(NamedTuple):
    """An answer to be checked.

    ``outcome``, ``settings``: the answer, and the settings under which it was found.
    ``soft``: the weights of soft constraints.
    ``penalty``: the claimed sum of the weights of the soft constraints that the tree of the outcome violates;
    ``None`` without soft constraints.
    """

    outcome: Outcome
    settings: Settings = Settings()
    soft: Mapping[Constraint, int] = {}
    penalty: int | None = None


class EngineAnswer(NamedTuple):
    """The answer of an engine.

    ``objectives``: the first objectives of the question, at least one, by which the engine optimized.
    ``units``: a tree that the engine claims to be optimal by them, as unit ids; ``None`` where it claims that
    no tree exists.
    ``finished``: false where the engine stopped before an answer.
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
        """Search for a lexicographically optimal tree without the forbidden units.

        An engine may optimize only the first objectives; its answer then names only these. The engine stops
        after ``seconds``.

        Raises :class:`NotCheckedError` for a problem or objective that the engine does not support.
        """


class Engine(NamedTuple):
    """A second engine, which supports no constraints except forbidden units.

    ``installed`` returns whether it can run, and ``solve`` runs it. ``package`` is the distribution that
    offers it; ``None`` for a built-in engine.
    """

    name: str
    installed: Callable[[], bool]
    solve: Solve
    package: str | None = None


class DisagreementError(Exception):
    """Two engines give answers that cannot both be right: one of them has a bug.

    ``answer`` is the other engine's. ``ours`` says that the bug is in foon-asp: the tree of the other engine
    is valid, and better than the one that we call optimal.
    """

    def __init__(self, message: str, answer: EngineAnswer, ours: bool = False) -> None:
        super().__init__(message)
        self.answer, self.ours = answer, ours


def difference_error(
    measure: str,
    ours: int | Fraction,
    theirs: int | Fraction,
    answer: EngineAnswer,
    more_is_better: bool = False,
) -> DisagreementError:
    """Return the error that two trees, both claimed to be optimal, have different costs by ``measure``.

    The error says that ours is wrong if their cost is better: smaller or, if ``more_is_better``, greater.
    """
    better = theirs > ours if more_is_better else theirs < ours
    verdict = "ours is not the best" if better else f"{answer.engine} calls a worse one the best"
    message = f"by {measure} our tree has {ours}, the one of {answer.engine} {theirs}; {verdict}"
    return DisagreementError(message, answer, ours=better)


class NotCheckedError(Exception):
    """An engine neither confirms nor refutes an answer; the message says why."""


def check_tree(problem: Problem, answer: EngineAnswer) -> tuple[int, ...]:
    """Return the units of an engine's tree in an executable order.

    Raises :class:`DisagreementError` where no order makes the tree executable.
    """
    order = executable_order(problem, answer.units or ())
    if order is None or simulate_for(problem, problem.tree(order)).verdict is not Verdict.AS_LISTED:
        raise DisagreementError(f"the tree of {answer.engine} does not execute", answer)
    return order


class Scope(NamedTuple):
    """The relevant part of a problem.

    ``units``: the units that the goals can need, by id.
    ``objects``: the ids of the object nodes that have to be made.
    ``goals``: the ids of the goals among them.
    """

    units: list[int]
    objects: list[int]
    goals: list[int]


def scope_of(problem: Problem, forbidden: frozenset[int]) -> Scope:
    """Return the relevant part of a problem, by backward reachability from the goals.

    It passes through all units that are not forbidden. Kitchen items do not have to be made.
    """
    allowed = frozenset(range(len(problem.network))) - forbidden
    units, objects = search_backward(problem.goals, problem.makers, problem.needs, problem.kitchen, allowed)
    return Scope(sorted(units), sorted(objects), [goal for goal in problem.goals if goal in objects])


def cost(problem: Problem, objective: Objective, unit: int) -> float:
    """Return the cost of a unit by an objective other than ``kitchen``; of ``success``, -ln of its rate.

    Raises :class:`NotCheckedError` for a cost above 10^9, beside which floats lose small costs.
    """
    if multiplies(objective):
        rate = problem.rate(unit)
        return math.log(rate.denominator) - math.log(rate.numerator)
    figure = problem.figure(objective, unit)
    if figure > 10**9:  # beside it in a sum, floats of 53 bits lose small costs
        raise NotCheckedError("a unit costs more than its floats hold beside others")
    return float(figure)


def kitchen_items(problem: Problem, units: Iterable[int]) -> list[int]:
    """Return the kitchen items that are preconditions of units, by id, ascending."""
    return sorted({o for unit in units for o in problem.needs[unit] if o in problem.kitchen})
