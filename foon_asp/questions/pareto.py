"""Trade-offs: the whole Pareto front of two or three objectives, every point with a tree."""

import time
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Annotated, NamedTuple, Unpack

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.at_most import better_than
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.settings import Bounded
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.problem import Costs, Objective, Problem, multiplies
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, CHART, CONTAINERS, GOALS, ITEMS, OBJECTIVES
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    problem_for_rules,
    usual_objectives,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Option, question
from foon_asp.questions.result import NothingToDrawError, Result
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.figure_text import costs_text, figure_text, success_texts
from foon_asp.results.table import Block, Table
from foon_asp.results.values import (
    CostedTree,
    Measures,
    Step,
    UsedUpRun,
    Value,
    changed_motions,
    step_lines,
    steps_not_in,
)
from foon_asp.results.values_of import costed_tree, question_fields

_MIN_OBJECTIVES, _MAX_OBJECTIVES = 2, 3

Box = tuple[int | Fraction | None, ...]
"""For each objective but the first: a bound that the costs of plans are below; ``None`` for no bound."""


class Point(Value, frozen=True):
    """A point of the front with its smallest tree.

    Attributes:
        measures: What the tree costs by each of the objectives, exact.
        costs: What it costs by every objective.
        used_up: Whether the steps, each done once, run where items are used up; null where items are used
            up anyway.
        units: The steps, in an order that executes.
        gone: The ids of the units that the tree of the previous point has and this tree lacks.
        new: The ids of the units that this tree has and the tree of the previous point lacks.
    """

    measures: Measures
    costs: Costs
    used_up: UsedUpRun | None
    units: tuple[Step, ...]
    gone: tuple[int | None, ...]
    new: tuple[int | None, ...]

    @property
    def ids(self) -> tuple[int, ...]:
        """The ids of the units in the whole network, in an order that executes."""
        return tuple(step.id for step in self.units if step.id is not None)


class Front(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("pareto")):
    """The Pareto front: its points are the costs that no tree dominates, each with one tree that has them.

    Attributes:
        encodings: The folder that replaced the built-in encodings, if any.
        complete: Whether it is proved that there are no other points. If not, a limit came first; the points
            found by then are on the front, too.
        points: The points, the best by the first objective first.
        seconds: The time that the question took, in seconds.

    Example:
        >>> front = foon_asp.pareto(foon_asp.load().problem("ice"))
        >>> [point.costs.units for point in front.points], front.complete
        ([2, 3], True)
        >>> front.values[0], front.task_trees[0]
        ((2, Fraction(161, 250)), <Tree for ice; crushed; in [drinking glass]: 2 units>)
    """

    ROWS = "points"

    encodings: Path | None
    complete: bool
    points: tuple[Point, ...]
    seconds: float

    problem = Unserialized[Problem]()
    """The problem that was asked about."""

    lists_trees = Unserialized[bool]()
    """Whether the units of the trees are listed."""

    @property
    def values(self) -> tuple[tuple[int | Fraction, ...], ...]:
        """The exact measures of each point by the objectives of the front, in their order."""
        return tuple(tuple(map(point.costs.measure, self.objectives)) for point in self.points)

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as :class:`Tree` values for other questions, in the order of ``points``.

        The claim of each tree is the number of its point, and its costs.
        """
        ids = (self.problem.network.units_of_numbers(point.ids) for point in self.points)
        claims = (f"point {number}: {costs_text(point.costs)}" for number, point in enumerate(self.points, 1))
        return tuple(Tree.of(self.problem, *ids_and_claim) for ids_and_claim in zip(ids, claims, strict=True))

    @property
    def ending(self) -> Ending:
        """``DONE`` if the front is complete, ``NEGATIVE`` if no tree exists, else ``LIMIT``."""
        if not self.complete:
            return Ending.LIMIT
        return Ending.DONE if self.points else Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Yield what is proved, and the points as a table with the units that change from point to point.

        If trees were asked for, the units of the first tree follow. For each further tree, the dropped units
        (-) and the added units (+) follow. Notes name the trees that would not run if items were used up.
        """
        yield from self.goal_lines()
        yield self._claim_text()
        if self.points:
            yield ""
            yield self._points_table()
        if not self.lists_trees:
            yield from self._used_up_lines()
            return
        for index, (point, tree) in enumerate(zip(self.points, self.task_trees, strict=True)):
            yield from ("", f"point {index + 1}: {costs_text(point.costs)}")
            yield from used_up_note(self.problem, tree)
            yield from step_lines(self._dropped_steps(index), "-") if index else step_lines(point.units)
            yield from step_lines(self._added_steps(index), "+")

    def _claim_text(self) -> str:
        """Return one line on what is proved: the number of points, and whether these are all.

        Without a point, the line says that no tree exists, or that a limit came first.
        """
        conditions = self.conditions
        if self.encodings is not None:
            conditions += f", as {self.encodings} has it"
        if not self.points and self.complete:
            return f"infeasible: proved that no task tree exists ({conditions})"
        if not self.points:
            return f"unknown: stopped at a limit before any point of the front was found ({conditions})"
        *first, last = self.objectives
        by = f"{', '.join(first)} and {last}"
        points = counted(len(self.points), "point")
        if not self.complete:
            return f"at least {points} on the Pareto front of {by} ({conditions}; stopped at a limit)"
        if len(self.points) == 1:
            every = "both" if len(self.objectives) == 2 else "each"
            claim = f"1 point on the Pareto front of {by}, one tree being the best by {every}: proved"
            return f"{claim} ({conditions})"
        return f"{points} on the Pareto front of {by}, and no others: proved ({conditions})"

    def _points_table(self) -> Table:
        """Return a row for each point: its number, its measures, and the motions that go and come."""
        columns = [[str(number) for number in range(1, len(self.points) + 1)]]
        for objective in self.objectives:
            measures = [point.costs.measure(objective) for point in self.points]
            if multiplies(objective):
                columns.append(success_texts([Fraction(measure) for measure in measures]))
            else:
                columns.append([figure_text(objective, measure) for measure in measures])
        indices = range(len(self.points))
        columns.append([changed_motions(self._dropped_steps(i), self._added_steps(i)) for i in indices])
        changes = "units that go (-) and come (+)" if len(self.points) > 1 else ""
        rows = list(zip(*columns, strict=True))
        return Table(["point", *self.objectives, changes], rows, frozenset({len(self.objectives) + 1}))

    def _dropped_steps(self, index: int) -> list[Step]:
        """Return the steps of the previous tree that the tree at ``index`` lacks; none for the first tree."""
        return steps_not_in(self.points[index - 1].units, self.points[index].units) if index else []

    def _added_steps(self, index: int) -> list[Step]:
        """Return the steps that the tree at ``index`` adds to the previous tree; none for the first tree."""
        return steps_not_in(self.points[index].units, self.points[index - 1].units) if index else []

    def _used_up_lines(self) -> Iterator[str]:
        """Yield a note on the trees that would not run if items were used up; nothing without such trees."""
        runs = (point.used_up is None or point.used_up.runs is not False for point in self.points)
        points = [str(number) for number, run in enumerate(runs, 1) if not run]
        if points:
            several = f"trees of points {', '.join(points)} do"
            which = several if len(points) > 1 else f"tree of point {points[0]} does"
            yield from ("", f"note: the {which} not run with each item used once, see --items used-up")

    def write_chart(self, file: File) -> None:
        """Draw the front into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            NothingToDrawError: if there is no point.
            UserError: for another file name, or if the packages of ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.pictures.front_chart import PlottedFront, write_front_chart  # noqa: PLC0415

        if not self.points:
            raise NothingToDrawError("there is no point to draw")
        goals = " + ".join(goal.label for goal in self.goals)
        plotted = PlottedFront(goals, self.conditions, self.objectives, self.values, self.complete)
        write_front_chart(plotted, Path(file))


class _FoundTree(NamedTuple):
    """A tree of the front: its unit ids in an order that executes, and its costs."""

    units: tuple[int, ...]
    costs: Costs


@question(
    GOALS,
    OBJECTIVES._replace(
        help=f"Two or three of {', '.join(Objective)}. By default units and success, or units and inputs "
        "where no rates are known.",
        default=None,
    ),
    CONTAINERS,
    *ITEMS,
    AMOUNT,
    CHART._replace(help="A file for a chart of the front (.svg or .png)."),
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
    trees: Annotated[bool, Option()] = False,
    **options: Unpack[CommonOptions],
) -> Front:
    """Find all trade-offs between two or three objectives (the Pareto front), with a tree for each.

    The limits are for the whole question. At a limit, or when interrupted, the front has the points that were
    found by then.

    Parameters:
        objectives: Two or three names, or a list separated by commas. Without any: units and success, or
            units and inputs where no rates are known.
        trees: Also list the units of the trees.

    Returns:
        The ``points`` of the front; ``complete`` tells whether they are proved to be all.

    Raises:
        UserError: for a wrong argument or constraint, or another number of objectives.

    Example:
        >>> front = foon_asp.pareto(foon_asp.load().problem("macaroni"))
        >>> [(point.costs.units, round(float(point.costs.success), 4)) for point in front.points]
        [(9, 0.4988), (10, 0.5955), (11, 0.6293)]
    """
    usual = usual_objectives(problem, objectives, ("units", "success"), ("units", "inputs"))
    chosen = chosen_objectives(problem, usual)
    if not _MIN_OBJECTIVES <= len(chosen) <= _MAX_OBJECTIVES:
        raise UserError(
            f"found {counted(len(chosen), 'objective')}, "
            f"expected {_MIN_OBJECTIVES} or {_MAX_OBJECTIVES} to trade against each other"
        )
    settings = settings_of(options)
    problem = problem_for_rules(problem, settings)
    # Lexicographic epsilon-constraint method. The leading objective is success, if it is chosen, since no
    # sum can bound it; else an objective with fractions, which a bound would round; else the first. Each
    # tree is optimal by the leading objective, then by the others, among the trees that are better than
    # every tree before by some other objective. A tree that dominates it would be among these, too, and
    # would come first: so no tree found is dominated. In the end every tree is excluded, each first by a
    # tree that is as good by the others, and no worse by the leading objective, by which that tree was
    # optimal among the trees not excluded. So every point of the front is found.
    leading = min(chosen, key=lambda objective: (not multiplies(objective), objective.row.whole))
    order = leading, *(objective for objective in chosen if objective is not leading)
    began = time.monotonic()
    points: list[_FoundTree] = []
    complete = True
    next_best = _best_trees if problem.items is None else _best_plans
    try:
        for outcome in next_best(problem, order, settings, points):
            if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
                complete = False
                break
            point = _FoundTree(outcome.units, outcome.costs)
            _require_incomparable(Postconditions(problem, chosen, settings), point, points)
            points.append(point)
    except KeyboardInterrupt:
        complete = False  # the points found so far are on the front
    points.sort(key=lambda point: point.costs.key(chosen))
    seconds = round(time.monotonic() - began, 6)
    front = Front(
        **question_fields(problem, chosen),
        encodings=settings.replaced,
        complete=complete,
        points=tuple(_front_points(problem, chosen, points)),
        seconds=seconds,
    )
    return front.set_unserialized(problem=problem, lists_trees=trees)


def _front_points(
    problem: Problem, objectives: Sequence[Objective], points: Sequence[_FoundTree]
) -> Iterator[Point]:
    """Yield a point of the front for each tree, with the units that change from the previous tree.

    The first tree has no changes.
    """
    before: CostedTree | None = None
    for units, costs in points:
        tree = costed_tree(problem, units, costs)
        gone = () if before is None else tuple(step.id for step in steps_not_in(before.units, tree.units))
        new = () if before is None else tuple(step.id for step in steps_not_in(tree.units, before.units))
        measures = {objective: costs.measure(objective) for objective in objectives}
        yield Point(measures, costs, tree.used_up, tree.units, gone, new)
        before = tree


def _best_trees(
    problem: Problem, order: tuple[Objective, ...], settings: Settings, points: Sequence[_FoundTree]
) -> Iterator[Outcome]:
    """Yield outcomes with trees of the front, by the lexicographic epsilon-constraint method.

    The caller appends each tree to ``points`` before it takes the next outcome. A tree qualifies if, compared
    with each tree in ``points``, it costs less by some objective other than the first. Each outcome is the
    best qualifying tree by ``order``. The outcomes end when no tree qualifies. An outcome without a proof is
    yielded as well; the caller stops there.
    """
    reporter = caller().reporter
    while True:
        bounded_settings = settings
        if points:
            minimal_costs = _pareto_minimal([point.costs for point in points], order[1:])
            bounded_settings = settings._replace(bounded=better_than(minimal_costs, order[1:]))
        outcome = solve(problem, order, bounded_settings, _WithoutWarnings(reporter) if points else reporter)
        if outcome.status is Status.INFEASIBLE:
            return
        yield outcome


def _best_plans(
    problem: Problem, order: tuple[Objective, ...], settings: Settings, points: Sequence[_FoundTree]
) -> Iterator[Outcome]:
    """Yield outcomes with plans of the front, by dividing the space of costs into boxes.

    A box is an upper bound on the costs by each objective but the first. Together, the boxes have the plans
    that are not dominated so far: compared with each plan yielded, they cost less by one of the bounded
    objectives. Each box is solved once. The best plan of all boxes by ``order`` is yielded. Then the boxes
    that contain its costs are divided. The outcomes end when no box has a plan.

    An outcome without a proof is yielded as well; the caller stops there.
    """
    reporter, other_objectives = caller().reporter, order[1:]
    boxes: list[Box] = [(None,) * len(other_objectives)]
    solved: dict[Box, Outcome] = {}
    while True:
        for box in boxes:
            if box not in solved:
                upper_bounds = tuple(
                    {objective: bound}
                    for objective, bound in zip(other_objectives, box, strict=True)
                    if bound is not None
                )
                bounded_settings = settings._replace(bounded=Bounded(below=upper_bounds))
                solved[box] = solve(
                    problem, order, bounded_settings, _WithoutWarnings(reporter) if points else reporter
                )
                if solved[box].status not in {Status.OPTIMAL, Status.INFEASIBLE}:
                    yield solved[box]
        boxes = [box for box in boxes if solved[box].costs is not None]
        if not boxes:
            return
        best = min(
            (solved[box] for box in boxes),
            key=lambda outcome: outcome.costs.key(order) if outcome.costs else (),
        )
        assert best.costs is not None
        yield best
        boxes = _divide_boxes(boxes, tuple(map(best.costs.measure, other_objectives)))


def _divide_boxes(boxes: Sequence[Box], point: Sequence[int | Fraction]) -> list[Box]:
    """Return the boxes without the part that a point dominates; boxes inside other boxes are dropped.

    A box that contains the point becomes one box for each objective. In it, the cost of the point is the
    bound by this objective.
    """
    divided = set[Box]()
    for box in boxes:
        if all(bound is None or cost < bound for cost, bound in zip(point, box, strict=True)):
            divided.update((*box[:n], cost, *box[n + 1 :]) for n, cost in enumerate(point))
        else:
            divided.add(box)

    def contains(box: Box, inner: Box) -> bool:
        """Return whether ``box`` has all the costs that ``inner`` has; false for equal boxes."""
        return box != inner and all(
            bound is None or (inner_bound is not None and inner_bound <= bound)
            for bound, inner_bound in zip(box, inner, strict=True)
        )

    return [inner for inner in divided if not any(contains(box, inner) for box in divided)]


def _require_incomparable(
    postconditions: Postconditions, point: _FoundTree, points: Sequence[_FoundTree]
) -> None:
    """Require that ``point`` is better than each of ``points`` by some objective, and worse by another.

    Raises :class:`BugError` if it is not.
    """
    key = point.costs.key(postconditions.levels)
    for other in points:
        other_key = other.costs.key(postconditions.levels)
        postconditions.require(
            any(a < b for a, b in zip(key, other_key, strict=True))
            and any(a > b for a, b in zip(key, other_key, strict=True)),
            partial(
                "of two points of the front, {} and {}, one is as good as the other everywhere".format,
                list(point.units),
                list(other.units),
            ),
        )


def _pareto_minimal(candidates: Sequence[Costs], objectives: Sequence[Objective]) -> list[Costs]:
    """Return the candidates that no other candidate dominates by ``objectives``, in ascending order.

    Of candidates with equal costs, one is returned.
    """

    def key(costs: Costs) -> tuple[int | Fraction, ...]:
        """Return the costs by each of the objectives."""
        return tuple(map(costs.measure, objectives))

    best: list[Costs] = []
    for costs in sorted(candidates, key=key):
        if not any(all(a <= b for a, b in zip(key(other), key(costs), strict=True)) for other in best):
            best.append(costs)
    return best


class _WithoutWarnings(Reporter):
    """A reporter that forwards trees and bounds alone; the first search has given the warnings already."""

    def __init__(self, reporter: Reporter) -> None:
        self._reporter = reporter

    def tree(self, costs: Costs) -> None:
        self._reporter.tree(costs)

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        self._reporter.bound(objective, bound)
