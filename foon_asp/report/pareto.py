"""A Pareto front for people and for programs: what each point costs, and what its tree does otherwise."""

import json
from collections import Counter
from collections.abc import Iterator, Sequence
from decimal import Context, Decimal
from fractions import Fraction

from foon_asp.explain.alternatives import Tree
from foon_asp.explain.pareto import Front
from foon_asp.network import Network
from foon_asp.problem import multiplies
from foon_asp.report.alternatives import unit_lines
from foon_asp.report.answer import costs_json, costs_text, counted, fraction_json, goal_lines, unit_json

_NAMED = 6  # motions that are named of those that a tree has and its neighbour does not
_DIGITS = 4  # of a success, where so many tell the points apart
_MOST_DIGITS = 40


def front_text(front: Front, trees: bool = False) -> str:
    """Give the points as a table, each with what its tree does otherwise than the one above it.

    ``trees`` lists the units too: those of the first tree, and those that go and come with each other one.
    """
    lines = [*goal_lines(front.problem), _headline(front)]
    if front.points:
        lines += ["", *_table(front)]
    if trees:
        for number, tree in enumerate(front.points):
            lines += ["", f"point {number + 1}: {costs_text(tree.costs)}", *_units(front, number)]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def front_json(front: Front) -> str:
    """Give the points, each with its measures, all that its tree costs, and its units."""
    network = front.problem.network
    points = []
    for number, tree in enumerate(front.points):
        gone, new = _changes(front, number)
        points.append(
            {
                "measures": {
                    str(objective): fraction_json(measure) if isinstance(measure, Fraction) else measure
                    for objective, measure in zip(front.objectives, front.measures(tree), strict=True)
                },
                "costs": costs_json(tree.costs),
                "units": [unit_json(network, unit) for unit in tree.units],
                "gone": [network.unit_number(unit) for unit in gone],
                "new": [network.unit_number(unit) for unit in new],
            }
        )
    given = {
        "goals": [str(network.objects[goal]) for goal in front.problem.goals],
        "containers": str(front.problem.containers),
        "level": network.level,
        "objective": [str(objective) for objective in front.objectives],
        "encodings": None if front.encodings is None else str(front.encodings),
        "complete": front.complete,
        "points": points,
        "seconds": round(front.seconds, 6),
    }
    return json.dumps(given, indent=2, ensure_ascii=False) + "\n"


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


def _headline(front: Front) -> str:
    rule = front.problem.conditions
    if not front.points:
        if front.complete:
            return f"infeasible: proved that no task tree exists ({rule})"
        return f"unknown: stopped at a limit before any point of the front was found ({rule})"
    if front.encodings is not None:
        rule += f", as {front.encodings} has it"
    *first, last = front.objectives
    by = f"{', '.join(first)} and {last}"
    number = len(front.points)
    points = counted(number, "point")
    if not front.complete:
        return f"at least {points} on the Pareto front of {by} ({rule}; stopped at a limit)"
    if number == 1:
        every = "both" if len(front.objectives) == 2 else "each"
        return f"1 point on the Pareto front of {by}, one tree being the best by {every}: proved ({rule})"
    return f"{points} on the Pareto front of {by}, and no others: proved ({rule})"


def _table(front: Front) -> Iterator[str]:
    """Align numbers to the right, and put the words beside them."""
    columns = [["point", *(str(number + 1) for number in range(len(front.points)))]]
    for objective in front.objectives:
        figures = [tree.costs.measure(objective) for tree in front.points]
        texts = success_texts([Fraction(f) for f in figures]) if multiplies(objective) else figures
        columns.append([str(objective), *map(str, texts)])
    widths = [max(map(len, column)) for column in columns]
    words = ["", *(_words(front, number) for number in range(len(front.points)))]
    if len(front.points) > 1:
        words[0] = "units that go (-) and come (+)"
    for *cells, note in zip(*columns, words, strict=True):
        row = "  ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True))
        yield f"{row}    {note}"


def _changes(front: Front, number: int) -> tuple[list[int], list[int]]:
    """Give the units that only the tree before has, and those that only this one has."""
    if not number:
        return [], []
    before, tree = front.points[number - 1], front.points[number]
    return _missing(before, tree), _missing(tree, before)


def _missing(tree: Tree, other: Tree) -> list[int]:
    known = set(other.units)
    return [unit for unit in tree.units if unit not in known]


def _words(front: Front, number: int) -> str:
    gone, new = _changes(front, number)
    network = front.problem.network
    parts = [f"{sign} {_motions(network, units)}" for sign, units in (("-", gone), ("+", new)) if units]
    return "  ".join(parts)


def _motions(network: Network, units: Sequence[int]) -> str:
    """Name the motions of units, ``pour (2)`` for two of them."""
    counts = Counter(network.motions[unit] for unit in units)
    named = [motion if count == 1 else f"{motion} ({count})" for motion, count in counts.items()]
    if len(named) <= _NAMED:
        return ", ".join(named)
    shown = _NAMED - 1
    return f"{', '.join(named[:shown])} and {sum(list(counts.values())[shown:])} more"


def _units(front: Front, number: int) -> Iterator[str]:
    network = front.problem.network
    if not number:
        yield from unit_lines(network, front.points[0].units)
        return
    gone, new = _changes(front, number)
    yield from unit_lines(network, gone, "-")
    yield from unit_lines(network, new, "+")
