"""Trade-offs: the whole Pareto front of two or three objectives, every point with a tree."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.at_most import better_than
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.settings import Bounded
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, figures_json, steps_json
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.problem import Costs, Objective, Problem, multiplies
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    asked_with,
    chosen_objectives,
    settings,
    usual_objectives,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, Part, question
from foon_asp.questions.options import CONTAINERS, GOALS, HOW, ITEMS, OBJECTIVES
from foon_asp.questions.result import Ending, NothingToDrawError, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import (
    changes_text,
    costs_text,
    figure_text,
    goal_lines,
    missing,
    success_texts,
    unit_lines,
)
from foon_asp.report.stacked import is_narrow, stacked_lines

_FEWEST, _MOST = 2, 3  # objectives

Box = tuple[int | Fraction | None, ...]
"""For each objective but the first, what plans cost less than; ``None`` allows any cost."""


class Point(NamedTuple):
    """A tree of the front by unit ids in an order that executes, and what it costs."""

    units: tuple[int, ...]
    costs: Costs


@dataclass(frozen=True, repr=False)
class Front(Result):
    """The Pareto front: trees of which none is as good as another by every objective and better by one.

    ``problem`` and ``objectives`` are those asked about. Each of ``points`` is one combination of measures,
    with its smallest tree: ``units`` by id, and ``costs``. The best by the first objective come first;
    :attr:`task_trees` has the trees as values. ``complete`` tells whether every tree is as good as one of
    these or worse. If not, a limit was reached and other points may exist, but these stay on the front.
    ``seconds`` is the time it took, ``encodings`` the folder that replaced the built-in encodings, if any.

    Example:
        >>> front = foon_asp.pareto(foon_asp.load().problem("ice"))
        >>> [point.costs.units for point in front.points], front.complete
        ([2, 3], True)
        >>> front.measures(front.points[0])
        (2, Fraction(161, 250))
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    points: tuple[Point, ...]
    complete: bool
    seconds: float
    encodings: Path | None = None

    def measures(self, point: Point) -> tuple[int | Fraction, ...]:
        """Give the measures of a point by each objective, exact.

        Parameters:
            point: The point.
        """
        return tuple(map(point.costs.measure, self.objectives))

    @property
    def values(self) -> tuple[tuple[int | Fraction, ...], ...]:
        """Where the points stand: for each its measure by every objective, exact."""
        return tuple(map(self.measures, self.points))

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as values, in the same order."""
        return tuple(
            Tree.of(self.problem, point.units, f"point {number}: {costs_text(point.costs)}")
            for number, point in enumerate(self.points, 1)
        )

    @property
    def ending(self) -> Ending:
        """Done when the front is whole."""
        if not self.complete:
            return Ending.LIMIT
        return Ending.DONE if self.points else Ending.NEGATIVE

    def text(self, trees: bool = False) -> str:
        """Give the points as a table, each with what its tree does differently from the one above.

        Parameters:
            trees: Whether to list the units, too: those of the first tree, and those that go and come with
                each other one.
        """
        lines = [*goal_lines(self.problem), _headline(self)]
        if self.points:
            lines += ["", *_table(self)]
        if trees:
            for number, point in enumerate(self.points):
                lines += ["", f"point {number + 1}: {costs_text(point.costs)}", *_units(self, number)]
        return "\n".join(line.rstrip() for line in lines) + "\n"

    def json_dict(self) -> object:
        """Give the points, each with its measures, all that its tree costs, and its units."""
        network = self.problem.network
        points = []
        for number, point in enumerate(self.points):
            gone, new = _changes(self, number)
            measures = dict(zip(self.objectives, self.measures(point), strict=True))
            points.append(
                {
                    "measures": figures_json(measures),
                    "costs": costs_json(point.costs),
                    "units": steps_json(self.problem, point.units),
                    "gone": list(map(network.unit_number, gone)),
                    "new": list(map(network.unit_number, new)),
                }
            )
        return document(
            "pareto",
            self.problem,
            self.objectives,
            encodings=None if self.encodings is None else str(self.encodings),
            complete=self.complete,
            points=points,
            seconds=round(self.seconds, 6),
        )

    def write_chart(self, file: File) -> None:
        """Draw the front into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            NothingToDrawError: if there is no point.
            UserError: for another file name, or if the packages of ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.report.front_chart import Plotted, write_front_chart  # noqa: PLC0415 (seldom asked for)

        if not self.points:
            raise NothingToDrawError("there is no point to draw")
        objects = self.problem.network.objects
        goals = " + ".join(objects[goal].label for goal in self.problem.goals)
        plotted = Plotted(goals, self.problem.conditions, self.objectives, self.values, self.complete)
        write_front_chart(plotted, Path(file))


@question(
    GOALS,
    OBJECTIVES._replace(
        help=f"Two or three of {', '.join(Objective)}. By default units and success, or units and inputs "
        "where no rates are known.",
        default=None,
    ),
    CONTAINERS,
    *ITEMS,
    Option("trees", "Also list the units of the trees.", Kind.FLAG, Part.TEXT),
    Option(
        "charts",
        "A file for a chart of the front (.svg or .png).",
        Kind.FILE,
        Part.CHART,
        flags=("--chart",),
        many=True,
    ),
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp pareto --goal macaroni                                  units against success
    foon-asp pareto --goal macaroni --objective inputs,success,kitchen --trees
    foon-asp pareto --goal macaroni --chart front.svg

    A point is on the front when no tree is as good by every objective and better by one. Points are compared
    exactly. Each comes with its smallest tree, and it is proved that there are no other points.

    Exits with 0 when the front is complete, 1 when there is no tree, 3 when a limit came first; the points
    found by then are on the front, too.
    """,
)
def pareto(
    problem: Problem,
    objectives: Objectives = (),
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Front:
    """Find all trade-offs between two or three objectives (the Pareto front), with a tree for each.

    The limits are for the whole question.

    Parameters:
        objectives: Two or three names, or a list separated by commas. Without any: units and success, or
            units and inputs where no rates are known.

    Returns:
        The ``points`` of the front; ``complete`` tells whether they are proved to be all.

    Raises:
        UserError: for a wrong argument or constraint, or another number of objectives.

    Example:
        >>> front = foon_asp.pareto(foon_asp.load().problem("macaroni"))
        >>> [(point.costs.units, round(float(point.costs.success), 4)) for point in front.points]
        [(9, 0.4988), (10, 0.5955), (11, 0.6293)]
    """
    given = usual_objectives(problem, objectives, ("units", "success"), ("units", "inputs"))
    asked = chosen_objectives(problem, given)
    if not _FEWEST <= len(asked) <= _MOST:
        raise UserError(
            f"found {counted(len(asked), 'objective')}, "
            f"expected {_FEWEST} or {_MOST} to trade against each other"
        )
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    problem = asked_with(problem, how)
    # One objective leads: success, which no sum can bound, if it is there, else one that is a fraction
    # and may have to be rounded, else the first. Each tree is
    # the best by the leading objective, then by the others, among those that are better than every tree
    # before it by one of the others. What would be better than a tree everywhere, or as good and
    # somewhere better, would be among those too, and come before it: so no tree found is dominated. When
    # no tree is left, each tree there is was left out first with some tree that is as good as it by the
    # others, and no worse by the leading objective, by which that tree was the best of those that were
    # left. So every point of the front is there.
    leading = min(asked, key=lambda objective: (not multiplies(objective), objective.row.whole))
    order = leading, *(objective for objective in asked if objective is not leading)
    began = time.monotonic()
    found: list[Point] = []
    complete = True
    next_best = _best_trees if problem.items is None else _best_plans
    try:
        for outcome in next_best(problem, order, how, found):
            if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
                complete = False
                break
            point = Point(outcome.units, outcome.costs)
            _require_apart(Postconditions(problem, asked, how), point, found)
            found.append(point)
    except KeyboardInterrupt:
        complete = False  # what was found stands
    found.sort(key=lambda point: point.costs.key(asked))
    seconds = time.monotonic() - began
    return Front(problem, asked, tuple(found), complete, seconds, how.replaced)


def _best_trees(
    problem: Problem, order: tuple[Objective, ...], how: Settings, found: Sequence[Point]
) -> Iterator[Outcome]:
    """Give the best tree that is better than each point found by one of the objectives but the first.

    It takes one search more than there are points. An outcome without a proof is the last.
    """
    reporter = caller().reporter
    while True:
        now = how
        if found:
            known = _nearest([point.costs for point in found], order[1:])
            now = how._replace(bounded=better_than(known, order[1:]))
        outcome = solve(problem, order, now, _Silent(reporter) if found else reporter)
        if outcome.status is Status.INFEASIBLE:
            return
        yield outcome


def _best_plans(
    problem: Problem, order: tuple[Objective, ...], how: Settings, found: Sequence[Point]
) -> Iterator[Outcome]:
    """Give the best plan as :func:`_best_trees` gives trees.

    What is better than each point found is divided into boxes, which are below one cost by each objective.
    The best plan of a box stays the best of it until the box is divided.
    """
    reporter, others = caller().reporter, order[1:]
    boxes: list[Box] = [(None,) * len(others)]
    solved: dict[Box, Outcome] = {}
    while True:
        for box in boxes:
            if box not in solved:
                below = tuple({o: most} for o, most in zip(others, box, strict=True) if most is not None)
                now = how._replace(bounded=Bounded(below=below))
                solved[box] = solve(problem, order, now, _Silent(reporter) if found else reporter)
                if solved[box].status not in {Status.OPTIMAL, Status.INFEASIBLE}:
                    yield solved[box]
        boxes = [box for box in boxes if solved[box].costs is not None]
        if not boxes:
            return
        best = min(
            (solved[box] for box in boxes), key=lambda each: each.costs.key(order) if each.costs else ()
        )
        assert best.costs is not None
        yield best
        boxes = _divided(boxes, tuple(map(best.costs.measure, others)))


def _divided(boxes: Sequence[Box], point: Sequence[int | Fraction]) -> list[Box]:
    """Divide boxes that a point is in, and leave out those that are within another."""
    parts = set[Box]()
    for box in boxes:
        if all(most is None or cost < most for cost, most in zip(point, box, strict=True)):
            parts.update((*box[:n], cost, *box[n + 1 :]) for n, cost in enumerate(point))
        else:
            parts.add(box)

    def holds(box: Box, part: Box) -> bool:
        return box != part and all(
            most is None or (less is not None and less <= most) for most, less in zip(box, part, strict=True)
        )

    return [part for part in parts if not any(holds(box, part) for box in parts)]


def _require_apart(holds: Postconditions, point: Point, found: Sequence[Point]) -> None:
    """Require that a point of the front is as good as no other, and that no other is as good as it."""
    key = point.costs.key(holds.levels)
    for other in found:
        theirs = other.costs.key(holds.levels)
        holds.require(
            any(a < b for a, b in zip(key, theirs, strict=True))
            and any(a > b for a, b in zip(key, theirs, strict=True)),
            partial(
                "of two points of the front, {} and {}, one is as good as the other everywhere".format,
                list(point.units),
                list(other.units),
            ),
        )


def _nearest(known: Sequence[Costs], objectives: Sequence[Objective]) -> list[Costs]:
    """Leave out the costs that are no less than others everywhere: what beats those beats these by one."""

    def key(costs: Costs) -> tuple[int | Fraction, ...]:
        return tuple(map(costs.measure, objectives))

    best: list[Costs] = []
    for costs in sorted(known, key=key):
        if not any(all(a <= b for a, b in zip(key(other), key(costs), strict=True)) for other in best):
            best.append(costs)
    return best


class _Silent(Reporter):
    """Passes on the progress of one search after another, and no warning, which came with the first."""

    def __init__(self, reporter: Reporter) -> None:
        self._reporter = reporter

    def tree(self, costs: Costs) -> None:
        self._reporter.tree(costs)

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        self._reporter.bound(objective, bound)


def _headline(front: Front) -> str:
    rule = front.problem.conditions
    if front.encodings is not None:
        rule += f", as {front.encodings} has it"
    if not front.points:
        if front.complete:
            return f"infeasible: proved that no task tree exists ({rule})"
        return f"unknown: stopped at a limit before any point of the front was found ({rule})"
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
        figures = [point.costs.measure(objective) for point in front.points]
        texts = (
            success_texts([Fraction(f) for f in figures])
            if multiplies(objective)
            else [figure_text(objective, f) for f in figures]
        )
        columns.append([str(objective), *map(str, texts)])
    widths = [max(map(len, column)) for column in columns]
    network = front.problem.network
    changes = (_changes(front, number) for number in range(len(front.points)))
    words = ["", *(changes_text(network, gone, new) for gone, new in changes)]
    if len(front.points) > 1:
        words[0] = "units that go (-) and come (+)"
    if is_narrow():
        headings, *rows = zip(*columns, words, strict=True)
        yield from stacked_lines([*headings[:-1], "changes"], rows)
        return
    for *cells, note in zip(*columns, words, strict=True):
        row = "  ".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True))
        yield f"{row}    {note}"


def _changes(front: Front, number: int) -> tuple[list[int], list[int]]:
    """Give the units that only the tree before has, and those that only this one has."""
    if not number:
        return [], []
    before, point = front.points[number - 1], front.points[number]
    return missing(before.units, point.units), missing(point.units, before.units)


def _units(front: Front, number: int) -> Iterator[str]:
    network = front.problem.network
    if not number:
        yield from unit_lines(network, front.points[0].units)
        return
    gone, new = _changes(front, number)
    yield from unit_lines(network, gone, "-")
    yield from unit_lines(network, new, "+")
