"""What every unit of the best tree, and every item that it takes, is worth: the optimum without it."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.asp import solve as find
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.paths import File, Files
from foon_asp.document.json_document import costs_json, document, figures_json, mention_json, nodes_json
from foon_asp.errors import UserError
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings, whole
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.options import HOW, TREE
from foon_asp.questions.result import Ending
from foon_asp.report.answer import costs_text, goal_lines, headline, success_text


class Part(StrEnum):
    """What is left out: a unit of the network, or an item of the kitchen."""

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
        """Say how much worse it is by an objective: by how much more, or for ``success`` by what share.

        ``None`` where there is no tree without this.
        """
        if self.costs is None:
            return None
        ours, theirs = best.measure(objective), self.costs.measure(objective)
        if multiplies(objective):
            return 1 - Fraction(theirs) / Fraction(ours) if ours else Fraction(0)
        return theirs - ours


@dataclass(frozen=True, repr=False)
class Regrets(WithOutcome):
    """An optimal tree as the ``outcome``, and what its parts are worth, the greatest loss first.

    Each of ``regrets`` has ``part`` (``unit`` or ``item``), the ``id`` of that unit or object node in the
    problem's network, and ``status`` and ``costs`` of the optimum without it; ``json()`` has names, too.
    ``regrets`` is empty if there is no tree, or if it was not proved the best.

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
        for part, title in ((Part.UNIT, "without the unit"), (Part.ITEM, "without from the kitchen")):
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
    Option(
        "units",
        "The id of a unit to ask about as well.",
        Kind.WHOLE,
        flags=("--unit",),
        many=True,
        metavar="ID",
    ),
    *HOW,
    help_="""
    \b
    foon-asp regret --goal macaroni
    foon-asp regret --goal macaroni --objective success --unit 17

    What is missed most comes first. Exits with 0 when every answer is proved, 1 when there is no tree at all,
    3 when a limit came first.
    """,
)
def regret(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    units: Iterable[int] = (),
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Regrets:
    """Find the optimum without each unit of the best tree, and without each kitchen item that it uses.

    The limits are for the whole question.

    Parameters:
        units: Ids of other units to ask about, as in ``json()``.

    Returns:
        The best tree as the ``outcome``, and the ``regrets``, of which the greatest loss comes first.

    Raises:
        UserError: for a wrong argument or constraint, or a unit that the network does not have.

    Example:
        >>> found = foon_asp.regret(foon_asp.load().problem("ice"))
        >>> worst = found.regrets[0]
        >>> str(worst.part), str(worst.status)
        ('item', 'infeasible')
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    more = tuple(units)
    problem = whole(problem) if more else asked_with(problem, how)
    found = [problem.network.unit_of_number(number) for number in more]
    if None in found:
        raise UserError(f"there is no unit {more[found.index(None)]} in the network")
    outcome = find(problem, chosen, how, caller().reporter)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Regrets(Answer._make(outcome), ())
    tree = set(outcome.units)
    taken = sorted({o for unit in tree for o in problem.needs[unit] if o in problem.kitchen})
    regrets = []
    own = how.constraints == () and how.replaced is None  # else rules may ask for what is missing
    holds = Postconditions(problem, levels(chosen), how)

    def without(part: Part, id_: int, fewer: Problem, how: Settings) -> None:
        left = find(fewer, chosen, how, Reporter())
        # an item that is not at hand is not taken, so a tree that makes it has fewer by ``kitchen``
        if own and (part is Part.UNIT or Objective.KITCHEN not in chosen):
            holds.no_better(left, outcome, f"with the {part} {id_}")
        regrets.append(Regret(part, id_, left.status, left.costs))

    for unit in sorted(tree.union(unit for unit in found if unit is not None)):
        fewer = replace(problem, network=problem.network.without([unit]))
        alone = how._replace(session=None)  # another network: a program kept for it would be of no use
        without(Part.UNIT, unit, fewer, alone)
    for o in taken:
        if problem.network.object_numbers and problem.origin is not None:  # what makes the item is read
            fewer = problem.vary(without=problem.network.objects[o])
        else:
            fewer = replace(problem, kitchen=problem.kitchen - {o})
        without(Part.ITEM, o, fewer, how)
    order = (*chosen, Objective.UNITS)
    regrets.sort(key=lambda each: _worst_first(each, order))
    return Regrets(Answer._make(outcome), tuple(regrets))


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
    else:
        name = str(network.objects[regret.id])
    yield f"  {_loss(best, regret)}    {name}"
    if regret.costs is not None and best.costs is not None and regret.costs != best.costs:
        yield f"       the best is then {costs_text(regret.costs, best.objectives)}"


def _loss(best: Answer, regret: Regret) -> str:
    if regret.status is Status.INFEASIBLE:
        return "no tree "
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
    is_unit = regret.part is Part.UNIT
    return {
        "unit": mention_json(network, regret.id) if is_unit else None,
        "item": None if is_unit else nodes_json(network, [regret.id])[0],
        "status": str(regret.status),
        "costs": costs_json(regret.costs),
        "loss": losses or None,
    }
