"""Landmarks that questions about one network share.

A disjunctive action landmark belongs to no single goal: it is a landmark of every object that cannot be
reached without its actions. So landmarks found for one goal also bound the trees of other goals, and the
trees of questions that exclude actions.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.cost_partition import CostPartition, float_quotient, has_stalled
from foon_asp.hypergraph.covering import Covering, UnsolvedError
from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.incumbent_gap import Gap
from foon_asp.hypergraph.incumbent_trees import trees_by_lp_values
from foon_asp.hypergraph.landmark_relaxation import PARTS, LandmarkRelaxation
from foon_asp.hypergraph.relaxation_stages import apply_partition
from foon_asp.hypergraph.task import Task


class _LpTolerance(NamedTuple):
    """Tolerances of LP values, which are floats; bounds do not rely on them.

    ``used``: an action counts as used if its LP value is greater.
    ``violated``: a landmark is violated if the sum of its LP values is smaller.
    ``tight``: a landmark is tight if the sum of its LP values is smaller.
    """

    used: float = 1e-6
    violated: float = 0.999
    tight: float = 1.001


_LP = _LpTolerance()


class _Relaxation(NamedTuple):
    """The result of a relaxation: a tree, and the last LP solution.

    ``tree``: the best tree found.
    ``rows``: for each row of the LP, the number of its landmark.
    ``x``: the LP value of each action, by its number in the relaxation.
    ``duals``: the dual of each row of the LP.
    """

    tree: frozenset[int]
    rows: Sequence[int]
    x: Sequence[float]
    duals: Sequence[float]


class SharedLandmarks:
    """Landmarks of all objects that a network can make from a kitchen, for costs without rounding.

    ``actions`` are all actions that can run, and ``objects`` the objects that they make. A question has some
    ``objects`` as goals, and may exclude actions. Its linear relaxation begins with the known landmarks of
    its goals. Landmarks that it adds are kept for later questions.
    """

    def __init__(self, task: Task, costs: ExactCosts, actions: Iterable[int], objects: Sequence[int]) -> None:
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        self._np, self.costs, self._actions = np, costs, frozenset(actions)
        # rows are landmarks; its covering problem stays unsolved, since each goal has one of its own
        self._relaxation = LandmarkRelaxation(task.graph, objects, self._actions, costs, task.expired)
        self._number = dict(zip(objects, self._relaxation.targets, strict=True))
        self._position = {action: i for i, action in enumerate(self._relaxation.actions)}
        self._reached_without: list[bytearray] = []  # for each landmark, what is reached without its actions

    def tighten(self, task: Task, excluded: frozenset[int], tree: frozenset[int]) -> Gap:
        """Return the gap of a question by its relaxation.

        ``excluded``: the actions that the question excludes.
        ``tree``: a tree of the question. The incumbent of the gap is this tree or a better one.

        Cuts become evidence only if the gap is not closed by the bound alone, since they are many and large.
        New landmarks are kept for later questions. If HiGHS fails, the bound of the gap is 0, and its
        candidates are all actions except the excluded ones.
        """
        result = self._relax(task, excluded, tree)
        candidates = self._actions - excluded
        if result is None:
            return Gap(tree, 0, candidates)
        relaxation, gap = self._relaxation, Gap(result.tree, 0, candidates)
        capacity = relaxation.costs_in_parts()
        capacity[[self._position[action] for action in excluded]] = capacity.sum()  # they limit no weight
        weights = relaxation.feasible_weights(zip(result.rows, result.duals, strict=False), capacity)
        bound, total = sum(weights.values()), task.incumbent_cost(gap)
        if bound > (total - 1) * PARTS:
            return gap.with_bound(total, gap.evidence).as_proved()
        sums, targets = self._row_sums(result.rows, self._np.array(result.x)), self._targets(task)
        cuts = {
            row: self._cut_of_row(row, targets)
            for row, value in zip(result.rows, sums, strict=True)
            if weights.get(row) or value < _LP.tight
        }
        partition = CostPartition(
            bound,
            dict(zip(relaxation.actions, capacity.tolist(), strict=True)),
            [(cuts[row], weight) for row, weight in weights.items() if weight],
            dict(zip(relaxation.actions, result.x, strict=True)),
            [*cuts.values()],
        )
        return apply_partition(task, gap, partition)

    def _targets(self, task: Task) -> list[int]:
        """Return the goals of a question by their numbers in the relaxation."""
        return [self._number[goal] for goal in task.graph.goals]

    def _relax(self, task: Task, excluded: frozenset[int], tree: frozenset[int]) -> _Relaxation | None:
        """Solve the relaxation for a question, until its value proves the best tree found optimal.

        Known landmarks that the LP solution violates are added. If the solution violates no known landmark,
        new landmarks are found, added and recorded. Also ends when no violated cut is found, the value hardly
        grows, or time is up. Returns ``None`` if HiGHS fails. The arguments are those of :meth:`tighten`.
        """
        np, relaxation, targets = self._np, self._relaxation, self._targets(task)
        landmarks = [
            row for row, reached in enumerate(self._reached_without) if not all(reached[o] for o in targets)
        ]
        forbidden = frozenset(self._position[action] for action in excluded)
        use_counts = self._row_sums(landmarks, self._value_array(dict.fromkeys(tree, 1.0)))
        # by complementary slackness, others have no weight where the tree is optimal and the relaxation tight
        rows = [row for row, count in zip(landmarks, use_counts, strict=True) if count == 1]
        covering, cutter = Covering(relaxation.relative_costs.tolist()), None
        for column in forbidden:
            covering.set_bounds(column, 0.0, 0.0)
        for row in rows:
            covering.add_row(relaxation.rows[row])
        values: list[float] = []
        budget = tuning.RELAXATION.cuts * len(relaxation.actions)
        while True:
            try:
                solution = covering.solve(task.expired)
            except UnsolvedError:
                return None
            x = np.where(relaxation.relative_costs > 0, np.array(solution.x), 1.0)
            tree = self._improve_by_lp(task, tree, x)
            values.append(solution.value)
            # costs are whole, so a bound above the total less one proves the total
            sufficient_hundredths = 100 * sum(map(self.costs, tree)) - 99
            remaining_gap = (
                float_quotient(sufficient_hundredths, 100 * relaxation.greatest_cost) - solution.value
            )
            if remaining_gap <= 0 or has_stalled(values, remaining_gap) or task.expired():
                break
            current_rows = frozenset(rows)
            sums = self._row_sums(landmarks, x)
            violated = sorted(
                (value, row)
                for row, value in zip(landmarks, sums, strict=True)
                if value < _LP.violated and row not in current_rows
            )
            added = [row for _, row in violated[: tuning.SHARED.violated_landmarks]]
            if not added:
                cutter = cutter or Cutter(relaxation.graph, targets, forbidden)
                count = len(relaxation.rows)
                relaxation.separate([cutter], (), x.copy(), budget, task.expired)
                added = list(range(count, len(relaxation.rows)))
                self._record_reached(added)
                landmarks += added
            if not added:
                break
            rows += added
            for row in added:
                covering.add_row(relaxation.rows[row])
        return _Relaxation(tree, rows, solution.x, covering.duals())

    def _value_array(self, value_of_action: dict[int, float]) -> Any:
        """Return an array of values by number in the relaxation; actions without a value have 0."""
        values = self._np.zeros(len(self._relaxation.actions))
        for action, value in value_of_action.items():
            values[self._position[action]] = value
        return values

    def _row_sums(self, rows: Sequence[int], values: Any) -> list[float]:
        """Return, for each landmark numbered in ``rows``, the sum of the ``values`` of its actions."""
        if not rows:
            return []
        arrays = [self._relaxation.rows[row] for row in rows]
        starts = self._np.cumsum([0, *map(len, arrays[:-1])])
        return self._np.add.reduceat(values[self._np.concatenate(arrays)], starts).tolist()  # type: ignore[no-any-return]

    def _record_reached(self, rows: Iterable[int]) -> None:
        """Record for each new landmark, given by number, which objects are reachable without its actions.

        An object that is not reachable without them has the landmark.
        """
        for row in rows:
            landmark = frozenset(self._relaxation.rows[row].tolist())
            self._reached_without.append(self._relaxation.graph.reach(landmark))

    def _improve_by_lp(self, task: Task, tree: frozenset[int], x: Any) -> frozenset[int]:
        """Return the best of ``tree`` and trees that combine its actions with those of an LP solution.

        If the LP solution uses only actions of ``tree``, return ``tree``.
        """
        actions, costs = self._relaxation.actions, self.costs
        used = self._np.flatnonzero(x > _LP.used).tolist()
        lp_values = dict.fromkeys(tree, 0.0) | {actions[i]: float(x[i]) for i in used}
        if len(lp_values) == len(tree):
            return tree
        trees = trees_by_lp_values(task.graph, lp_values, costs, lp_values, ())
        return min(tree, *map(frozenset, trees), key=lambda tree: sum(map(costs, tree)))

    def _cut_of_row(self, row: int, targets: Iterable[int]) -> frozenset[int]:
        """Return a cut of one of the targets whose landmark is contained in the landmark number ``row``.

        ``targets`` are numbers in the relaxation. The result has object numbers of the whole graph.
        """
        relaxation, reached = self._relaxation, self._reached_without[row]
        graph, landmark = relaxation.graph, frozenset(relaxation.rows[row].tolist())
        target = next(o for o in targets if not reached[o])
        cut, stack = {target}, [target]
        while stack:
            for action in graph.makers[stack.pop()]:
                if action not in landmark and cut.isdisjoint(graph.needs[action]):
                    lacking = next(o for o in graph.needs[action] if not reached[o])
                    cut.add(lacking)
                    stack.append(lacking)
        return relaxation.whole_cut(frozenset(cut))
