"""The regret of every unit and kitchen item of the best tree: the optimum without it.

Motions and pairs of items are left out, too, on request.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from functools import partial
from itertools import combinations
from typing import Annotated, Any, Unpack

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network.spelling import near_labels
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.questions.answer import Answer, WithAnswer
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, ITEMS, TREE
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    over_whole_network,
    problem_for_rules,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, question
from foon_asp.results.figure_text import costs_text, success_text
from foon_asp.results.table import Block
from foon_asp.results.values import Measures, Mention, Node, Value
from foon_asp.results.values_of import mention_of, node_of, question_fields


class Removal(StrEnum):
    """The kind of part that is left out: a unit, all units of a motion, a kitchen item, or two items."""

    UNIT = "unit"
    MOTION = "motion"
    ITEM = "item"
    PAIR = "pair"


_TITLES = {
    Removal.UNIT: "without the unit",
    Removal.MOTION: "without all units of the motion",
    Removal.ITEM: "without from the kitchen",
    Removal.PAIR: "without both from the kitchen, where each alone can be done without",
}


class Regret(Value, frozen=True):
    """The optimum without one part of a problem.

    Attributes:
        unit: The unit that is left out, or null.
        motion: The motion whose units are all left out, or null.
        item: The kitchen item that is left out, or null.
        second_item: The other kitchen item of a pair, or null.
        status: What is proved of the best tree without the part.
        costs: The costs of the best tree without the part; null without a tree.
        loss: By how much the best tree without the part is worse by each objective: a difference, or for
            success a share. Null unless it is proved the best.
    """

    unit: Mention | None
    motion: str | None
    item: Node | None
    second_item: Node | None
    status: Status
    costs: Costs | None
    loss: Measures | None

    @property
    def part(self) -> Removal:
        """The kind of part that is left out."""
        if self.item is not None:
            return Removal.ITEM if self.second_item is None else Removal.PAIR
        return Removal.MOTION if self.unit is None else Removal.UNIT

    def __str__(self) -> str:
        if self.unit is not None:
            return f"{self.unit.id}  {self.unit}"
        return self.motion or " and ".join(str(node) for node in (self.item, self.second_item) if node)

    def loss_text(self, objective: Objective, what: str = "tree") -> str:
        """Return in a few words how much worse the best tree without the part is by an objective.

        The text is like ``+1 units`` or ``-5 %``; or it is ``nothing``, ``no tree`` or ``unknown``.

        Parameters:
            objective: One of the objectives of the question.
            what: The word for a solution: ``tree`` or ``plan``.
        """
        if self.status is Status.INFEASIBLE:
            return f"no {what}"
        loss = None if self.loss is None else self.loss[objective]
        if loss is None:
            return "unknown"
        if not loss:
            return "nothing"
        if multiplies(objective):
            text = success_text(Fraction(loss * 100))
            return f"≈ -{text[2:]} %" if text.startswith("≈") else f"-{text} %"
        return f"{int(loss):+} {objective}"  # less by ``kitchen`` if a missing item is made


class Regrets(WithAnswer, frozen=True, kw_only=True, tag=schema_name("regret")):
    """The regret of each unit and each kitchen item of the best tree.

    Attributes:
        regrets: The greatest loss first; empty if there is no tree, or if it was not proved the best.

    Example:
        >>> found = foon_asp.regret(foon_asp.load().problem("ice"))
        >>> len(found.regrets), found.answer.costs.units
        (6, 2)
        >>> last = found.regrets[-1]
        >>> str(last.part), last.unit.motion, last.loss_text(foon_asp.Objective.UNITS)
        ('unit', 'crush', '+1 units')
    """

    ROWS = "regrets"

    answer: Answer
    regrets: tuple[Regret, ...]

    @property
    def ending(self) -> Ending:
        """The ending of ``answer``; ``LIMIT`` if the optimum without some part is not proved."""
        proved = all(regret.status in {Status.OPTIMAL, Status.INFEASIBLE} for regret in self.regrets)
        return self.answer.ending if proved else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Return the best tree's costs, and the regrets under a heading for each kind of part.

        The line of a regret has the loss by the first objective. The greatest loss comes first.
        """
        yield from (*self.goal_lines(), *self.answer.headlines())
        word_for_solution = "tree" if self.items == "lasting" else "plan"
        for removal, title in _TITLES.items():
            regrets = [regret for regret in self.regrets if regret.part is removal]
            if regrets:
                yield from ("", title)
            for regret in regrets:
                yield f"  {regret.loss_text(self.objectives[0], word_for_solution).ljust(8)}    {regret}"
                if regret.costs is not None and regret.costs != self.answer.costs:
                    yield f"       the best is then {costs_text(regret.costs, self.objectives)}"


@question(
    *TREE,
    *ITEMS,
    AMOUNT,
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
    units: Annotated[Iterable[int], Option(kind=Kind.WHOLE, flags=("--unit",), many=True, metavar="ID")] = (),
    motions: Annotated[str | Iterable[str], Option(flags=("--motion",), many=True, metavar="MOTION")] = (),
    pairs: Annotated[bool, Option()] = False,
    **options: Unpack[CommonOptions],
) -> Regrets:
    """Find the optimum without each unit of the best tree, and without each kitchen item that it uses.

    The limits are for the whole question.

    Parameters:
        units: A unit to ask about as well, by its id.
        motions: A motion to ask about as well, the optimum without all of its units.
        pairs: Ask about pairs of kitchen items as well. The best tree takes both items
            of a pair. If only one of the two is left out, there is still a tree.

    Returns:
        The best tree as the ``answer``, and the ``regrets``, of which the greatest loss comes first.

    Raises:
        UserError: for a wrong argument or constraint, or a unit or motion that the network does not have.

    Example:
        >>> found = foon_asp.regret(foon_asp.load().problem("ice"))
        >>> worst = found.regrets[0]
        >>> str(worst.item), str(worst.status)
        ('ice; cubed; in [ice cube tray]', 'infeasible')
    """
    chosen, settings = chosen_objectives(problem, objectives), settings_of(options)
    numbers, motion_names = tuple(units), tuple([motions] if isinstance(motions, str) else motions)
    problem = over_whole_network(problem) if numbers or motion_names else problem_for_rules(problem, settings)
    network = problem.network
    asked_units = [network.unit_of_number(number) for number in numbers]
    if None in asked_units:
        raise UserError(f"there is no unit {numbers[asked_units.index(None)]} in the network")
    units_by_motion = {motion: _units_of_motion(problem, motion) for motion in motion_names}
    best = solve(problem, chosen, settings, caller().reporter)
    fields_of_question, answer = question_fields(problem, chosen), Answer.of(best)
    if best.units is None or best.status is not Status.OPTIMAL:
        return Regrets(**fields_of_question, answer=answer, regrets=())
    regrets: list[Regret] = []
    # under rules, the optimum may be better without a part: they may require what is missing
    unrestricted = settings.constraints == () and settings.replaced is None
    postconditions = Postconditions(problem, levels(chosen), settings)

    def solve_without(leave_out: Callable[[], Problem], **parts: Any) -> Regret:
        """Solve the problem that ``leave_out`` returns; append its regret to ``regrets``, and return it.

        ``parts`` name what is left out, as parameters of :func:`_regret_of_parts`. If a limit or ctrl-C stops
        ``leave_out``, the status of the regret is ``UNKNOWN``. Without rules, raises :class:`BugError` if the
        optimum is better without the part. By ``kitchen``, the optimum may be better without an item, which
        is no bug.
        """
        try:
            with settings.effective_deadline.watched(
                "leaving out a part"
            ):  # which takes a while in a large network
                smaller_problem = leave_out()
        except KeyboardInterrupt:
            remaining = None
        else:
            remaining = solve(smaller_problem, chosen, settings, Reporter())
        regrets.append(_regret_of_parts(best, remaining, **parts))
        # a missing item is not taken from the kitchen, so a tree that makes it costs less by ``kitchen``
        if remaining and unrestricted and ("item" not in parts or Objective.KITCHEN not in chosen):
            postconditions.require_no_better(remaining, best, f"without {regrets[-1]}")
        return regrets[-1]

    for unit in sorted({*best.units, *(unit for unit in asked_units if unit is not None)}):
        solve_without(partial(_without_units, problem, [unit]), unit=mention_of(network, unit))
    for motion, motion_units in units_by_motion.items():
        solve_without(partial(_without_units, problem, motion_units), motion=motion)
    kitchen_items = sorted({o for unit in best.units for o in problem.needs[unit] if o in problem.kitchen})
    regret_of_item = {
        o: solve_without(partial(_without_items, problem, o), item=node_of(network, o)) for o in kitchen_items
    }
    dispensable = [o for o in kitchen_items if regret_of_item[o].costs is not None]
    for o, other in combinations(dispensable if pairs else (), 2):
        nodes = {"item": node_of(network, o), "second_item": node_of(network, other)}
        solve_without(partial(_without_items, problem, o, other), **nodes)
    regrets.sort(key=lambda entry: _regret_key(entry, (*chosen, Objective.UNITS)))
    return Regrets(**fields_of_question, answer=answer, regrets=tuple(regrets))


def regret_of(best: Answer, settings: Settings, unit: int | None = None, item: int | None = None) -> Regret:
    """Return the regret of a unit or of a kitchen item; give the id of one of the two.

    The problem of the answer ``best`` is solved again without this unit or item. Progress and warnings are
    not reported.
    """
    network, outcome = best.problem.network, best.outcome
    if unit is not None:
        remaining = solve(_without_units(best.problem, [unit]), best.objectives, settings, Reporter())
        return _regret_of_parts(outcome, remaining, unit=mention_of(network, unit))
    assert item is not None
    remaining = solve(_without_items(best.problem, item), best.objectives, settings, Reporter())
    return _regret_of_parts(outcome, remaining, item=node_of(network, item))


def _regret_of_parts(
    best: Outcome,
    remaining: Outcome | None,
    unit: Mention | None = None,
    motion: str | None = None,
    item: Node | None = None,
    second_item: Node | None = None,
) -> Regret:
    """Return the regret of the parts that are given; the other parts are ``None``.

    ``best`` is the outcome of the whole problem. ``remaining`` is the outcome without the parts; ``None`` if
    a limit came before the search. The loss is ``None`` unless ``remaining`` is proved optimal.
    """
    status, costs = (Status.UNKNOWN, None) if remaining is None else (remaining.status, remaining.costs)
    loss: Measures | None = None
    if costs is not None and status is Status.OPTIMAL and best.costs is not None:
        loss = {objective: _loss_by(best.costs, costs, objective) for objective in best.objectives}
    return Regret(unit, motion, item, second_item, status, costs, loss)


def _loss_by(best: Costs, remaining: Costs, objective: Objective) -> int | Fraction:
    """Return by how much the remaining costs are worse by an objective.

    It is a difference; for ``success``, the share of the best rate that is lost, or 0 if the best rate is 0.
    """
    best_figure, figure = best.measure(objective), remaining.measure(objective)
    if multiplies(objective):
        return 1 - Fraction(figure) / Fraction(best_figure) if best_figure else Fraction(0)
    return figure - best_figure


def _without_items(problem: Problem, *removed: int) -> Problem:
    """Return the problem without some items of the kitchen, by id.

    For a problem over a part of a store, the units that make the items are also read.
    """
    if problem.network.object_numbers and problem.origin is not None:  # what makes the items is read
        return problem.vary(without=[problem.network.objects[o] for o in removed])
    return replace(problem, kitchen=problem.kitchen.difference(removed))


def _without_units(problem: Problem, removed: Sequence[int]) -> Problem:
    """Return the problem without some units, by id; the other units keep their rates, and get new ids."""
    kept = [unit for unit in range(len(problem.network)) if unit not in removed]
    rates = problem.own_rates
    own_rates = (
        {position: rates[unit] for position, unit in enumerate(kept) if unit in rates} if rates else {}
    )
    return replace(problem, network=problem.network.without(removed), own_rates=own_rates)


def _units_of_motion(problem: Problem, motion: str) -> list[int]:
    """Return the ids of the units of a motion.

    Raises :class:`UserError` if no unit has it; the message names similar motions.
    """
    motions = problem.network.motions
    units = [unit for unit, name in enumerate(motions) if name == motion]
    if not units:
        candidates = near_labels(motion, dict.fromkeys(motions), 3)
        similar = f"; similar are {', '.join(map(repr, candidates))}" if candidates else ""
        raise UserError(f"no unit has the motion {motion!r}{similar}")
    return units


def _regret_key(
    regret: Regret, objectives: tuple[Objective, ...]
) -> tuple[bool, tuple[int | Fraction, ...], Removal]:
    """Return a sort key for regrets.

    Parts without which there is no tree come first, then greater losses, then parts by kind.
    """
    costs = regret.costs
    key = () if costs is None else tuple(-figure for figure in costs.key(objectives))
    return costs is not None, key, regret.part
