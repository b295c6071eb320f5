"""What every unit of the best tree, and every item that it takes, is worth: the optimum without it.

Motions and pairs of items are asked about too, where somebody wants to know.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from functools import partial
from itertools import combinations
from typing import NamedTuple

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.asp import solve as find
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, figures_json, mention_json, nodes_json
from foon_asp.errors import UserError
from foon_asp.network.spelling import near_labels
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings, whole
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import HOW, ITEMS, TREE
from foon_asp.questions.result import Ending
from foon_asp.report.answer import costs_text, goal_lines, headline, success_text


class Part(StrEnum):
    """What is left out: a unit of the network, all of one motion, one item of the kitchen, or two."""

    UNIT = "unit"
    MOTION = "motion"
    ITEM = "item"
    PAIR = "pair"


class Regret(NamedTuple):
    """The best that is left without one part of a question.

    ``id`` is that of a unit (of a motion, its first) or of an object node of the kitchen. ``status`` and
    ``costs`` are those of the optimum without it; ``costs`` is ``None`` where there is no tree. ``other`` is
    the second item of a pair.
    """

    part: Part
    id: int
    status: Status
    costs: Costs | None
    other: int | None = None

    def loss(self, best: Costs, objective: Objective) -> int | Fraction | None:
        """Say how much worse it is by an objective: by how much more, or for ``success`` by what share.

        ``None`` where there is no tree without this.
        """
        if self.costs is None:
            return None
        ours, theirs = best.measure(objective), self.costs.measure(objective)
        if multiplies(objective):
            return 1 - Fraction(theirs) / Fraction(ours) if ours else Fraction(0)
        return theirs - ours


_TITLES = {
    Part.UNIT: "without the unit",
    Part.MOTION: "without all units of the motion",
    Part.ITEM: "without from the kitchen",
    Part.PAIR: "without both from the kitchen, where each alone can be done without",
}


@dataclass(frozen=True, repr=False)
class Regrets(WithOutcome):
    """An optimal tree as the ``outcome``, and what its parts are worth, the greatest loss first.

    Each of ``regrets`` has ``part`` (``unit``, ``motion``, ``item`` or ``pair``), the ``id`` of that unit or
    object node in the problem's network, and ``status`` and ``costs`` of the optimum without it; ``json()``
    has names, too. ``regrets`` is empty if there is no tree, or if it was not proved the best.

    Example:
        >>> found = foon_asp.regret(foon_asp.load().problem("ice"))
        >>> len(found.regrets), found.outcome.costs.units
        (6, 2)
    """

    outcome: Answer
    regrets: tuple[Regret, ...]

    @property
    def ending(self) -> Ending:
        """Done when every answer is proved."""
        proved = all(regret.status in {Status.OPTIMAL, Status.INFEASIBLE} for regret in self.regrets)
        return self.outcome.ending if proved else Ending.LIMIT

    def text(self) -> str:
        """Give the optimum, and under it what is missed most first."""
        lines = [*goal_lines(self.outcome.problem), headline(self.outcome)]
        for part, title in _TITLES.items():
            regrets = [regret for regret in self.regrets if regret.part is part]
            if regrets:
                lines += ["", title, *(line for regret in regrets for line in _lines(self.outcome, regret))]
        return "\n".join(lines) + "\n"

    def json_dict(self) -> object:
        """Give the answer and the regrets."""
        best = self.outcome
        regrets = [_json(best, regret) for regret in self.regrets]
        return document("regret", best.problem, best.objectives, answer=best.json_dict(), regrets=regrets)


@question(
    *TREE,
    *ITEMS,
    Option(
        "units",
        "The id of a unit to ask about as well.",
        Kind.WHOLE,
        flags=("--unit",),
        many=True,
        metavar="ID",
    ),
    Option(
        "motions",
        "A motion to ask about as well: the optimum without all of its units.",
        flags=("--motion",),
        many=True,
        metavar="MOTION",
    ),
    Option("pairs", "Ask about pairs of kitchen items as well.", Kind.FLAG, default=False),
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp regret --goal macaroni
    foon-asp regret --goal macaroni --objective success --unit 17
    foon-asp regret --goal macaroni --motion pour --pairs

    What is missed most comes first. Exits with 0 when every answer is proved, 1 when there is no tree at all,
    3 when a limit came first.
    """,
)
def regret(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    units: Iterable[int] = (),
    motions: str | Iterable[str] = (),
    pairs: bool = False,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Regrets:
    """Find the optimum without each unit of the best tree, and without each kitchen item that it uses.

    The limits are for the whole question.

    Parameters:
        units: Ids of other units to ask about, as in ``json()``.
        motions: Motions to ask about, each without all of its units.
        pairs: Whether to ask about any two items that the tree takes and that can be done without alone.

    Returns:
        The best tree as the ``outcome``, and the ``regrets``, of which the greatest loss comes first.

    Raises:
        UserError: for a wrong argument or constraint, or a unit or motion that the network does not have.

    Example:
        >>> found = foon_asp.regret(foon_asp.load().problem("ice"))
        >>> worst = found.regrets[0]
        >>> str(worst.part), str(worst.status)
        ('item', 'infeasible')
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    more, moved = tuple(units), tuple([motions] if isinstance(motions, str) else motions)
    problem = whole(problem) if more or moved else asked_with(problem, how)
    found = [problem.network.unit_of_number(number) for number in more]
    if None in found:
        raise UserError(f"there is no unit {more[found.index(None)]} in the network")
    of_motion = {motion: _units_of(problem, motion) for motion in moved}
    outcome = find(problem, chosen, how, caller().reporter)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Regrets(Answer._make(outcome), ())
    tree = set(outcome.units)
    taken = sorted({o for unit in tree for o in problem.needs[unit] if o in problem.kitchen})
    regrets = []
    own = how.constraints == () and how.replaced is None  # else rules may ask for what is missing
    holds = Postconditions(problem, levels(chosen), how)

    def without(
        part: Part, id_: int, leave_out: Callable[[], Problem], how: Settings, other: int | None = None
    ) -> None:
        try:
            with how.begun.watched("leaving out a part"):  # which takes a while in a large network
                fewer = leave_out()
        except KeyboardInterrupt:
            regrets.append(Regret(part, id_, Status.UNKNOWN, None, other))
            return
        left = find(fewer, chosen, how, Reporter())
        # an item that is not at hand is not taken, so a tree that makes it has fewer by ``kitchen``
        if own and (part in {Part.UNIT, Part.MOTION} or Objective.KITCHEN not in chosen):
            holds.no_better(left, outcome, f"with the {part} {id_}")
        regrets.append(Regret(part, id_, left.status, left.costs, other))

    alone = how._replace(session=None)  # another network: a program kept for it would be of no use
    for unit in sorted(tree.union(unit for unit in found if unit is not None)):
        without(Part.UNIT, unit, partial(_without_units, problem, [unit]), alone)
    for of_one in of_motion.values():
        without(Part.MOTION, of_one[0], partial(_without_units, problem, of_one), alone)
    for o in taken:
        without(Part.ITEM, o, partial(_kitchen_without, problem, o), how)
    if pairs:
        spared = [each.id for each in regrets if each.part is Part.ITEM and each.costs is not None]
        for o, other in combinations(spared, 2):
            without(Part.PAIR, o, partial(_kitchen_without, problem, o, other), how, other)
    order = (*chosen, Objective.UNITS)
    regrets.sort(key=lambda each: _worst_first(each, order))
    return Regrets(Answer._make(outcome), tuple(regrets))


def regret_of(best: Answer, part: Part, id_: int, how: Settings) -> Regret:
    """Find the optimum without one unit or one kitchen item of a problem that was answered."""
    unit = part is Part.UNIT
    fewer = _without_units(best.problem, [id_]) if unit else _kitchen_without(best.problem, id_)
    left = find(fewer, best.objectives, how, Reporter())
    return Regret(part, id_, left.status, left.costs)


def loss_text(best: Answer, regret: Regret) -> str:
    """Say in one line how much worse it is without a part, and what the best is then."""
    left = "" if regret.costs is None else f"; the best is then {costs_text(regret.costs, best.objectives)}"
    return f"{_loss(best, regret).strip()}{left}"


def _kitchen_without(problem: Problem, *gone: int) -> Problem:
    if problem.network.object_numbers and problem.origin is not None:  # what makes the items is read
        return problem.vary(without=[problem.network.objects[o] for o in gone])
    return replace(problem, kitchen=problem.kitchen.difference(gone))


def _without_units(problem: Problem, gone: Sequence[int]) -> Problem:
    """Give a problem over the network without some units; rates of their own go with the others."""
    kept = [unit for unit in range(len(problem.network)) if unit not in gone]
    rates = problem.own_rates
    own = {place: rates[unit] for place, unit in enumerate(kept) if unit in rates} if rates else {}
    return replace(problem, network=problem.network.without(gone), own_rates=own)


def _units_of(problem: Problem, motion: str) -> list[int]:
    """Give the units of a motion; raises :class:`UserError` if there are none."""
    motions = problem.network.motions
    found = [unit for unit, each in enumerate(motions) if each == motion]
    if not found:
        near = near_labels(motion, dict.fromkeys(motions), 3)
        similar = f"; similar are {', '.join(map(repr, near))}" if near else ""
        raise UserError(f"no unit has the motion {motion!r}{similar}")
    return found


def _worst_first(
    regret: Regret, objectives: tuple[Objective, ...]
) -> tuple[bool, tuple[int | Fraction, ...], Part, int]:
    costs = regret.costs
    key = () if costs is None else tuple(-figure for figure in costs.key(objectives))
    return costs is not None, key, regret.part, regret.id


def _lines(best: Answer, regret: Regret) -> Iterator[str]:
    network = best.problem.network
    if regret.part is Part.UNIT:
        name = f"{network.unit_number(regret.id)}  {network.motions[regret.id]}"
        name += f"    [{network.sources[regret.id][0]}]"
    elif regret.part is Part.MOTION:
        name = network.motions[regret.id]
    else:
        items = (regret.id,) if regret.other is None else (regret.id, regret.other)
        name = " and ".join(str(network.objects[o]) for o in items)
    yield f"  {_loss(best, regret)}    {name}"
    if regret.costs is not None and best.costs is not None and regret.costs != best.costs:
        yield f"       the best is then {costs_text(regret.costs, best.objectives)}"


def _loss(best: Answer, regret: Regret) -> str:
    if regret.status is Status.INFEASIBLE:
        return "no tree " if best.problem.items is None else "no plan "
    if regret.status is not Status.OPTIMAL:
        return "unknown "
    first = best.objectives[0]
    assert best.costs is not None
    loss = regret.loss(best.costs, first)
    if not loss:
        return "nothing "
    if multiplies(first):
        text = success_text(Fraction(loss * 100))
        return f"≈ -{text[2:]} %" if text.startswith("≈") else f"-{text} %"
    return f"{int(loss):+} {first}"  # less by ``kitchen`` where an item is made that is not at hand


def _json(best: Answer, regret: Regret) -> object:
    network = best.problem.network
    assert best.costs is not None
    losses = {}
    if regret.status is Status.OPTIMAL:
        losses = figures_json({each: regret.loss(best.costs, each) for each in best.objectives})
    part = regret.part
    return {
        "unit": mention_json(network, regret.id) if part is Part.UNIT else None,
        "motion": network.motions[regret.id] if part is Part.MOTION else None,
        "item": nodes_json(network, [regret.id])[0] if part in {Part.ITEM, Part.PAIR} else None,
        "second_item": None if regret.other is None else nodes_json(network, [regret.other])[0],
        "status": str(regret.status),
        "costs": costs_json(regret.costs),
        "loss": losses or None,
    }
