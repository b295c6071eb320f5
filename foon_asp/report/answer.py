"""An outcome for people, for programs and as FOON text."""

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Sequence
from decimal import Context, Decimal
from fractions import Fraction

from foon_asp.asp import Outcome, Proof, Status
from foon_asp.network import Network
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies, reach
from foon_asp.text import write_units

_DIGITS = 4  # of a success, where so many tell several apart
_MOST_DIGITS = 40
_NAMED = 6  # motions that are named of those that come, and of those that go


def fraction_json(value: Fraction | None) -> dict[str, object] | None:
    """Give an exact number and a float beside it for people; ``None`` stays ``None``.

    There is no float (``None``) beside a number above all of them.
    """
    if value is None:
        return None
    # through Decimal: products of long rates have more digits than Python turns into text at once
    parts = [str(Decimal(n)) for n in (value.numerator, value.denominator)]
    return {"exact": "/".join(parts) if value.denominator != 1 else parts[0], "approx": _float(value)}


def costs_json(costs: Costs | None, objectives: Iterable[Objective] = ()) -> dict[str, object] | None:
    """Give the usual measures of a tree, and those by some objectives."""
    if costs is None:
        return None
    usual = {
        "units": costs.units,
        "inputs": costs.inputs,
        "ingredients": costs.ingredients,
        "kitchen": costs.kitchen,
        "success": fraction_json(costs.success),
    }
    said = {*usual, Objective.INPUTS_AND_INGREDIENTS}
    others = (objective for objective in objectives if objective not in said)
    return usual | {str(each): figure_json(each, costs.measure(each)) for each in others}


def figure_json(objective: Objective, figure: int | Fraction) -> object:
    """Give what is measured by an objective: a whole number, or an exact fraction."""
    whole = objective.row.whole
    return int(figure) if whole else fraction_json(Fraction(figure))


def figure_text(objective: Objective, figure: int | Fraction) -> str:
    """Give what is measured by an objective in words: whole, or to four digits with ``≈`` where rounded."""
    if multiplies(objective):
        return success_text(Fraction(figure))
    shown = str(figure) if objective.row.whole else _four_digits(Fraction(figure))
    return shown if Fraction(shown) == figure else f"≈ {shown}"


def bound_text(objective: Objective, bound: int | Fraction) -> str:
    """Say between what and a bound an objective is: ``units at least 3``, ``success at most 0.5``."""
    side = "at most" if multiplies(objective) else "at least"
    return f"{objective} {side} {figure_text(objective, bound)}"


def bounds_json(outcome: Outcome) -> dict[str, object]:
    """Give the proved bounds by objective."""
    return {str(objective): figure_json(objective, bound) for objective, bound in outcome.bounds.items()}


def unit_json(network: Network, unit: int) -> dict[str, object]:
    """Give a unit with its id, motion, nodes in one-line notation and every place it was read from.

    Below level 3 the level-3 units it stands for are listed in the same way.
    """
    objects = network.objects
    given: dict[str, object] = {
        "id": network.unit_number(unit),
        "motion": network.motions[unit],
        "inputs": [str(objects[o]) for o in network.inputs[unit]],
        "outputs": [str(objects[o]) for o in network.outputs[unit]],
        "source": [
            {"file": source.file, "line": source.line, "videos": list(source.videos)}
            for source in network.sources[unit]
        ],
    }
    if network.detailed is not None:
        given["stands_for"] = [unit_json(network.detailed, detail) for detail in network.stands_for[unit]]
    return given


def outcome_dict(outcome: Outcome) -> dict[str, object]:
    """Give the keys and values of an outcome in JSON; docs/json.md describes them."""
    problem = outcome.problem
    goals = [str(problem.network.objects[o]) for o in problem.goals]
    return {
        "goal": " + ".join(goals),
        "goals": goals,
        **goals_stand_for_json(problem),
        "containers": str(problem.containers),
        "level": problem.network.level,
        "objective": [str(objective) for objective in outcome.objectives],
        "encodings": None if outcome.encodings is None else str(outcome.encodings),
        "status": str(outcome.status),
        "stopped": outcome.stopped,
        "proof": None if outcome.proof is None else str(outcome.proof),
        "proof_by_objective": {
            str(objective): str(Proof.CERTIFICATE if objective in outcome.certified else outcome.proof)
            for objective in levels(outcome.objectives)
            if outcome.status is Status.OPTIMAL
        },
        "costs": costs_json(outcome.costs, outcome.objectives),
        "lower_bound": bounds_json(outcome),
        "units": None
        if outcome.units is None
        else [unit_json(problem.network, unit) for unit in outcome.units],
        "seconds": {phase: round(seconds, 6) for phase, seconds in outcome.seconds.items()},
    }


def outcome_foon(outcome: Outcome) -> str:
    """Give the tree as FOON text with a comment that says what it is; empty where there is no tree."""
    if outcome.units is None:
        return ""
    goals = " + ".join(str(outcome.problem.network.objects[o]) for o in outcome.problem.goals)
    comments = [f"Task tree for: {goals}", headline(outcome)]
    return write_units(map(outcome.problem.network.unit, outcome.units), comments)


def outcome_text(outcome: Outcome, remarks: Iterable[str] = ()) -> str:
    """Give an outcome for people: what was proved, remarks, the steps with where each input comes from.

    Where there is no tree it is said why.
    """
    problem = outcome.problem
    lines = [*goal_lines(problem), headline(outcome), *remarks]
    if outcome.status is Status.FEASIBLE:
        lines.append(_bound_line(outcome))
    if outcome.units is not None:
        if outcome.units:
            lines.append("")
            lines += steps(problem, outcome.units)
        else:
            lines.append("the kitchen already holds it: nothing to do")
    if outcome.status is Status.INFEASIBLE:
        lines += _why_infeasible(problem)
    return "\n".join(lines) + "\n"


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


def goals_stand_for_json(problem: Problem) -> dict[str, object]:
    """Give, below level 3 alone, the level-3 nodes that each goal stands for."""
    network = problem.network
    if network.detailed is None:
        return {}
    objects = network.detailed.objects
    return {
        "goals_stand_for": [[str(objects[o]) for o in network.objects_stand_for[g]] for g in problem.goals]
    }


def headline(outcome: Outcome) -> str:
    """Say in one line what is claimed."""
    rule = outcome.problem.conditions
    best = ", then ".join(outcome.objectives)
    if outcome.costs is None:
        if outcome.status is Status.INFEASIBLE:
            return f"infeasible: proved that no task tree exists ({rule})"
        return f"unknown: stopped at {outcome.stopped or 'a limit'}, before any task tree was found ({rule})"
    if outcome.encodings is not None:
        rule += f", as {outcome.encodings} has it"
    claim = "optimal" if outcome.status is Status.OPTIMAL else "feasible, not proved best"
    return f"{claim} by {best} ({rule}): {costs_text(outcome.costs, outcome.objectives)}"


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
    approx = _float(value)
    if approx is None or (value and not approx):  # there are numbers below the least float, and above all
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.4g}"
    return f"{approx:.4g}"


def _float(value: Fraction) -> float | None:
    """Give the nearest float; ``None`` for a number above all."""
    try:
        return float(value)
    except OverflowError:
        return None


def success_texts(values: Sequence[Fraction]) -> list[str]:
    """Write successes to so many significant digits that different ones look different, four at least.

    ``≈`` stands before what is rounded.
    """
    digits = _DIGITS
    while digits < _MOST_DIGITS and len({_rounded(v, digits) for v in values}) < len(set(values)):
        digits += 1
    shown = {value: _rounded(value, digits) for value in values}
    return [f"{shown[v]:g}" if Fraction(shown[v]) == v else f"≈ {shown[v]:g}" for v in values]


def _rounded(value: Fraction, digits: int) -> Decimal:
    return Context(prec=digits).divide(Decimal(value.numerator), Decimal(value.denominator))


def counted(number: int, noun: str) -> str:
    """Give a number with its noun: ``1 unit``, ``2 units``."""
    return f"{number} {noun}" + ("" if number == 1 else "s")


def _bound_line(outcome: Outcome) -> str:
    bounds = [bound_text(objective, bound) for objective, bound in outcome.bounds.items()]
    return "proved so far: " + (", ".join(bounds) or "nothing")


def steps(
    problem: Problem, units: tuple[int, ...], bought: Collection[int] = (), helped: Collection[int] = ()
) -> Iterator[str]:
    """Number the units, and say of every input whether it is from the kitchen or from which step.

    ``bought`` are the items of the kitchen, by id, that were not there before, and ``helped`` the units that
    a person does. In a list that does not execute as it is, a needed input may be made by later steps only,
    or by none.
    """
    network = problem.network
    maker: dict[int, int] = {}
    for number, unit in enumerate(units, 1):
        who = "    by the person" if unit in helped else ""
        yield f"{number:>3}  {network.motions[unit]}    [{network.sources[unit][0]}]{who}"
        for o in network.inputs[unit]:
            if o in problem.kitchen:
                origin = "bought" if o in bought else "kitchen"
            elif o in maker:
                origin = f"step {maker[o]}"
            elif o not in problem.needs[unit]:
                origin = "implied"
            else:
                later = (n for n, u in enumerate(units[number:], number + 1) if o in problem.gives[u])
                origin = f"step {step}, which is later" if (step := next(later, 0)) else "missing"
            yield f"       {network.objects[o]}  ({origin})"
        for o in network.outputs[unit]:
            if o in problem.gives[unit]:
                yield f"     → {network.objects[o]}"
                maker.setdefault(o, number)
            else:
                yield f"     → {network.objects[o]}  (implied, not made here)"
        yield from _details(network, unit)


def _details(network: Network, unit: int, shown: int = 5) -> Iterator[str]:
    """Say which level-3 units a step stands for: id, first place, and the whole unit."""
    detailed = network.detailed
    if detailed is None:
        return
    details = network.stands_for[unit]
    yield f"     stands for {counted(len(details), 'unit')} at level 3:"
    for detail in details[:shown]:
        yield f"       {detail}    [{detailed.sources[detail][0]}]  {detailed.unit(detail)}"
    if len(details) > shown:
        yield f"       ... and {len(details) - shown} more; --format json lists all"


def unit_lines(network: Network, units: Iterable[int], sign: str = " ") -> Iterator[str]:
    """List units by id, each after a sign, with motion and place; those of a set in order of id."""
    listed = sorted(units) if isinstance(units, frozenset) else units
    for unit in listed:
        yield f"  {sign} {network.unit_number(unit)}  {network.motions[unit]}    [{network.sources[unit][0]}]"


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


def _why_infeasible(problem: Problem, shown: int = 5) -> Iterator[str]:
    """Say for each goal that cannot be made which units would make it and what the first of them lack.

    Where every goal can be made, it is the constraints that leave no tree.
    """
    available = reach(problem).available
    network = problem.network
    if all(available[goal] for goal in problem.goals):
        yield "without the constraints there is one: together they rule out every tree"
        yield "foon-asp clash says which do, and which to drop"
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
            yield f"  {network.motions[unit]}    [{network.sources[unit][0]}] lacks"
            yield from (f"       {network.objects[o]}" for o in problem.needs[unit] if not available[o])
        if len(makers) > shown:
            yield f"  ... and {len(makers) - shown} more units"
    yield "foon-asp why-not says what is behind it, and foon-asp shopping-list what would help"
