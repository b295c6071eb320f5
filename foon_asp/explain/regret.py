"""What a unit, or an item of the kitchen, is worth to a question: the optimum without it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies


class Part(StrEnum):
    """What is done without."""

    UNIT = "unit"
    ITEM = "item"


class Regret(NamedTuple):
    """The best that is left without one part of a question.

    ``id`` is that of a unit, or of an object node of the kitchen. ``status`` and ``costs`` are those of the
    optimum without it; ``costs`` is ``None`` where there is no tree.
    """

    part: Part
    id: int
    status: Status
    costs: Costs | None

    def loss(self, best: Costs, objective: Objective) -> int | Fraction | None:
        """Say how much is lost by an objective: so much more, or for ``success`` that part of it.

        ``None`` where there is no tree without this.
        """
        if self.costs is None:
            return None
        ours, theirs = best.measure(objective), self.costs.measure(objective)
        if multiplies(objective):
            return 1 - Fraction(theirs) / Fraction(ours) if ours else Fraction(0)
        return theirs - ours


class Regrets(NamedTuple):
    """An optimal tree, and what its parts are worth: what is missed most first.

    ``regrets`` is empty where there is no tree, or where it was not proved to be the best.
    """

    outcome: Outcome
    regrets: tuple[Regret, ...]


def regrets(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    units: Iterable[int] = (),
    reporter: Reporter | None = None,
) -> Regrets:
    """Solve a question, and again without each unit of the tree, each of ``units``, and each item it takes.

    ``units`` are ids. The time limit is for all of it. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """
    settings, reporter = (settings or Settings()).limited(), reporter or Reporter()
    outcome = solve(problem, objectives, settings, reporter)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Regrets(outcome, ())
    tree = set(outcome.units)
    taken = sorted({o for unit in tree for o in problem.needs[unit] if o in problem.kitchen})
    quiet = Reporter()
    found = []
    own = settings.constraints == () and settings.replaced is None  # else rules may ask for what is missing
    holds = Postconditions(problem, levels(tuple(objectives)), settings)

    def without(part: Part, id_: int, fewer: Problem, how: Settings) -> None:
        left = solve(fewer, objectives, how, quiet)
        # an item that is not at hand is not taken, so a tree that makes it has fewer by ``kitchen``
        if own and (part is Part.UNIT or Objective.KITCHEN not in objectives):
            holds.no_better(left, outcome, f"with the {part} {id_}")
        found.append(Regret(part, id_, left.status, left.costs))

    for unit in sorted(tree.union(units)):
        fewer = replace(problem, network=problem.network.without([unit]))
        alone = settings._replace(session=None)  # another network: a program kept for it would be of no use
        without(Part.UNIT, unit, fewer, alone)
    for o in taken:
        fewer = replace(problem, kitchen=problem.kitchen - {o})
        without(Part.ITEM, o, fewer, settings)
    order = (*objectives, Objective.UNITS)
    found.sort(key=lambda regret: _worst_first(regret, order))
    return Regrets(outcome, tuple(found))


def _worst_first(
    regret: Regret, objectives: tuple[Objective, ...]
) -> tuple[bool, tuple[int | Fraction, ...], Part, int]:
    costs = regret.costs
    key = () if costs is None else tuple(-figure for figure in costs.key(objectives))
    return costs is not None, key, regret.part, regret.id
