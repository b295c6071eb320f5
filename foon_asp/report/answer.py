"""An outcome as text, as JSON and as FOON text."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from decimal import Context, Decimal, Inexact
from fractions import Fraction

from foon_asp.asp import Outcome, Status
from foon_asp.deadline import Deadline
from foon_asp.document.json_document import (
    approximate,
    input_origins,
)
from foon_asp.network import Network, counted
from foon_asp.problem import Costs, Objective, Problem, multiplies, reach
from foon_asp.report.used_up_note import used_up_note
from foon_asp.text.writer import write_units

_DIGITS = 4  # of a success, if these tell several apart
_MOST_DIGITS = 40
_SUM_DIGITS = 15  # of a sum of costs, if it has no more
_CIRCLE = 3  # object nodes of a cycle that are named after the first
_NAMED = 6  # motions that are named of those that come, and of those that go


def figure_text(objective: Objective, figure: int | Fraction) -> str:
    """Write a value by an objective: exactly, or four digits after ``≈`` where that takes too many."""
    if multiplies(objective):
        return success_text(Fraction(figure))
    if objective.row.whole:
        return str(figure)
    context = Context(prec=_SUM_DIGITS)
    exact = context.divide(*map(Decimal, Fraction(figure).as_integer_ratio()))
    if context.flags[Inexact]:
        return f"≈ {_four_digits(Fraction(figure))}"
    return f"{exact if exact.adjusted() < _SUM_DIGITS else exact.normalize(context):g}"


def bound_text(objective: Objective, bound: int | Fraction) -> str:
    """Say between what and a bound an objective is: ``units at least 3``, ``success at most 0.5``."""
    side = "at most" if multiplies(objective) else "at least"
    return f"{objective} {side} {figure_text(objective, bound)}"


def outcome_foon(outcome: Outcome) -> str:
    """Give the tree as FOON text with a comment that says what it is; empty where there is no tree."""
    if outcome.units is None:
        return ""
    goals = " + ".join(str(outcome.problem.network.objects[o]) for o in outcome.problem.goals)
    comments = [f"Task tree for: {goals}", *headlines(outcome)]
    return write_units(map(outcome.problem.network.unit, outcome.units), comments)


def goal_lines(problem: Problem, shown: int = 5) -> Iterator[str]:
    """Name the goals; below level 3 with the level-3 nodes that each stands for."""
    network = problem.network
    for goal in problem.goals:
        yield f"goal: {network.objects[goal]}"
        if network.detailed is None:
            continue
        details = network.objects_stand_for[goal]
        yield f"  stands for {counted(len(details), 'object node')} at level 3:"
        yield from (f"    {network.detailed.objects[detail]}" for detail in details[:shown])
        if len(details) > shown:
            yield f"    ... and {len(details) - shown} more; --format json lists all"


def headline(outcome: Outcome) -> str:
    """Give the claim in one line."""
    rule = outcome.problem.conditions
    best = ", then ".join(outcome.objectives)
    what = "task tree" if outcome.problem.items is None else "plan"
    if outcome.encodings is not None:
        rule += f", as {outcome.encodings} has it"
    if outcome.costs is None:
        if outcome.status is Status.INFEASIBLE:
            return f"infeasible: proved that no {what} exists ({rule})"
        return f"unknown: stopped at {outcome.stopped or 'a limit'}, before any {what} was found ({rule})"
    claim = "optimal" if outcome.status is Status.OPTIMAL else "feasible, not proved best"
    return f"{claim} by {best} ({rule}): {costs_text(outcome.costs, outcome.objectives)}"


def headlines(outcome: Outcome) -> list[str]:
    """Return the claim, and under it a note where the tree would not run with items used up."""
    problem, units = outcome.problem, outcome.units
    return [headline(outcome), *([] if units is None else used_up_note(problem, problem.tree(units)))]


def costs_text(costs: Costs, objectives: Iterable[Objective] = ()) -> str:
    """Give the measures of a tree in a few words, those by some objectives among them."""
    text = f"{counted(costs.units, 'unit')}, {counted(costs.inputs, 'input')}"
    shown = {Objective.UNITS, Objective.INPUTS}
    others = [Objective.SUCCESS] if costs.success is not None else []
    for objective in dict.fromkeys((*others, *objectives)):
        if objective not in shown:
            text += f", {objective} {figure_text(objective, costs.measure(objective))}"
    return text


def success_text(success: Fraction) -> str:
    """Give a success rate to four significant digits, with ``≈`` where that is rounded.

    A rate that is rounded to 1 is shown by what it lacks of 1.
    """
    shown = _four_digits(success)
    if success < 1 and Fraction(shown) == 1:
        return f"≈ 1 - {_four_digits(1 - success)}"
    return shown if Fraction(shown) == success else f"≈ {shown}"


def _four_digits(value: Fraction) -> str:
    approx = approximate(value)
    if approx is None or (value and not approx):  # there are numbers below the least float, and above all
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.4g}"
    return f"{approx:.4g}"


def success_texts(values: Sequence[Fraction]) -> list[str]:
    """Write successes with enough significant digits that different ones look different, at least four.

    ``≈`` stands before what is rounded.
    """
    digits = _DIGITS
    while digits < _MOST_DIGITS and len({_rounded(v, digits) for v in values}) < len(set(values)):
        digits += 1
    shown = {value: _rounded(value, digits) for value in values}
    return [f"{shown[v]:g}" if Fraction(shown[v]) == v else f"≈ {shown[v]:g}" for v in values]


def _rounded(value: Fraction, digits: int) -> Decimal:
    return Context(prec=digits).divide(Decimal(value.numerator), Decimal(value.denominator))


def steps(problem: Problem, units: tuple[int, ...], bought: Collection[int] = ()) -> Iterator[str]:
    """Number the units, and say of every input whether it is from the kitchen or from which step.

    ``bought`` are the items of the kitchen, by id, that were not there before. In a list that does not
    execute as it is, a needed input may be made by later steps only, or by none.
    """
    network = problem.network
    for number, (unit, origins) in enumerate(input_origins(problem, units, bought), 1):
        yield f"{number:>3}  {network.motions[unit]}    [{network.sources[unit][0].short}]"
        for o, origin in zip(network.inputs[unit], origins, strict=True):
            ((where, step),) = origin.items()
            said = {"step": f"step {step}", "later_step": f"step {step}, which is later"}.get(where, where)
            if problem.items is not None and o in problem.flows[unit].uses:
                said += ", used up"
            yield f"       {network.objects[o]}  ({said})"
        for o in network.outputs[unit]:
            made = "" if o in problem.gives[unit] else "  (implied, not made here)"
            yield f"     → {network.objects[o]}{made}"
        yield from _details(network, unit)


def _details(network: Network, unit: int, shown: int = 5) -> Iterator[str]:
    """Say which level-3 units a step stands for: id, first place, and the whole unit."""
    detailed = network.detailed
    if detailed is None:
        return
    details = network.stands_for[unit]
    yield f"     stands for {counted(len(details), 'unit')} at level 3:"
    for detail in details[:shown]:
        yield f"       {detail}    [{detailed.sources[detail][0].short}]  {detailed.unit(detail)}"
    if len(details) > shown:
        yield f"       ... and {len(details) - shown} more; --format json lists all"


def unit_lines(network: Network, units: Iterable[int], sign: str = " ") -> Iterator[str]:
    """List units by id, each after a sign, with motion and place; those of a set in order of id."""
    listed = sorted(units) if isinstance(units, frozenset) else units
    for unit in listed:
        place = network.sources[unit][0].short
        yield f"  {sign} {network.unit_number(unit)}  {network.motions[unit]}    [{place}]"


def missing(units: Sequence[int], other: Iterable[int]) -> list[int]:
    """Give the units of a tree that another one does not have; those of a plan, as often as it lacks them."""
    left, found = Counter(units) - Counter(other), list[int]()
    for unit in units:
        if left[unit]:
            left[unit] -= 1
            found.append(unit)
    return found


def changes_text(network: Network, gone: Sequence[int], new: Sequence[int]) -> str:
    """Name the motions of the units that go and that come: ``- heat  + pour (2)``."""
    return "  ".join(
        f"{sign} {_motions(network, units)}" for sign, units in (("-", gone), ("+", new)) if units
    )


def _motions(network: Network, units: Sequence[int]) -> str:
    """Name the motions of units, ``pour (2)`` for two of them."""
    counts = Counter(network.motions[unit] for unit in units)
    named = [motion if count == 1 else f"{motion} ({count})" for motion, count in counts.items()]
    if len(named) <= _NAMED:
        return ", ".join(named)
    shown = _NAMED - 1
    return f"{', '.join(named[:shown])} and {sum(list(counts.values())[shown:])} more"


def why_infeasible(problem: Problem, deadline: Deadline | None = None) -> Iterator[str]:
    """Return lines that say why there is no tree, if that is found by the deadline."""
    try:
        with (deadline or Deadline()).watched("looking for the reason", late=True, grace=True):
            lines = list(_reasons(problem))
    except KeyboardInterrupt:
        lines = ["foon-asp why-not explains why; there was no time left for it here"]
    yield from lines


def _reasons(problem: Problem, shown: int = 5) -> Iterator[str]:
    """Say for each goal that cannot be made which units would make it and what the first of them lack.

    Where every goal can be made, it is the constraints that leave no tree.
    """
    available = reach(problem).available
    network = problem.network
    if all(available[goal] for goal in problem.goals) and problem.items is not None:
        yield (
            "if items lasted, every goal could be made: each plan would use up more than there is, or break "
            "a constraint"
        )
        return
    if all(available[goal] for goal in problem.goals):
        yield "without the constraints there is one: together they rule out every tree"
        yield "foon-asp why-not finds those that do, and which to drop"
        return
    for goal in problem.goals:
        if available[goal]:
            continue
        makers = problem.makers[goal]
        skipping = len(network.producers[goal]) - len(makers)
        if makers:
            yield f"no unit that makes {network.objects[goal]} can run:"
        else:
            yield f"no unit makes {network.objects[goal]}, and it is not in the kitchen"
        if skipping:
            yield f"  {counted(skipping, 'unit')} took it as given, and so did not make it"
        for unit in makers[:shown]:
            yield f"  {network.motions[unit]}    [{network.sources[unit][0].short}] lacks"
            yield from (f"       {network.objects[o]}" for o in problem.needs[unit] if not available[o])
        if len(makers) > shown:
            yield f"  ... and {counted(len(makers) - shown, 'more unit')}"
    yield from _cause_lines(problem)
    yield "foon-asp why-not explains why, and foon-asp shopping-list finds what would help"


def _cause_lines(problem: Problem, shown: int = 3) -> Iterator[str]:
    """Say in a sentence each what is at the root of it, on the way that takes the fewest things."""
    from foon_asp.problem.dead_ends import dead_ends  # noqa: PLC0415 (only where there is no tree)

    objects = problem.network.objects
    roots = [root for root in dead_ends(problem).roots if root.on_the_way]
    for root in roots[:shown]:
        if root.cycle is None:
            if root.object not in problem.goals:
                yield f"the cause: {objects[root.object]} is not in the kitchen, and no unit makes it"
            continue
        first, *others = [str(objects[o]) for o, _ in reversed(root.cycle.steps)]
        back = (*others, first)
        circle = "".join(f", and that only from {other}" for other in back[1:_CIRCLE])
        if len(back) > _CIRCLE:
            circle += f", and so on: {len(back)} object nodes wait for each other"
        yield f"the cause: {first} can only be made from {back[0]}{circle}"
    if len(roots) > shown:
        yield f"  ... and {len(roots) - shown} more"
