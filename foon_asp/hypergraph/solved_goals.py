"""Solved questions about a network, by which other questions are answered faster."""

from contextlib import suppress
from typing import TYPE_CHECKING

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.exact_costs import ExactCosts, TooFineError
from foon_asp.hypergraph.h_values import Derivations, compute_h_values
from foon_asp.hypergraph.incumbent_gap import Gap
from foon_asp.hypergraph.incumbent_trees import irredundant_subset
from foon_asp.hypergraph.reductions import Reduction
from foon_asp.hypergraph.task import Task

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.shared_landmarks import SharedLandmarks


class SolvedGoals:
    """Trees of solved questions, and landmarks that the questions share.

    The questions differ only in goals and removed units.

    Landmarks are shared as soon as a question was solved that greedy cuts alone do not solve. Easier
    questions are solved faster one by one.
    """

    def __init__(self) -> None:
        self._trees: dict[tuple[int, ...], frozenset[int]] = {}  # by goals; with units that others remove
        self._derivations: Derivations | None = None  # by h_add, once landmarks are shared
        self._landmarks: SharedLandmarks | None = None
        self._sharing_tried = False  # it fails where costs are rounded

    @property
    def sharing(self) -> bool:
        """Whether landmarks are shared yet."""
        return self._landmarks is not None

    def h_add(self, goal: int) -> int:
        """Return the h_add value of a goal at rough costs; 0 if it has no tree, or nothing is shared yet."""
        return 0 if self._derivations is None else self._derivations.h_objects.get(goal, 0)

    def gap(self, task: Task) -> Gap | None:
        """Return the gap of a question from shared landmarks.

        New landmarks are kept for later questions. Return ``None`` if landmarks are not shared yet, or the
        question has no tree.
        """
        if self._landmarks is None or self._derivations is None:
            return None
        if not self._derivations.h_objects.keys() >= set(task.graph.goals):
            return None
        restriction, units = task.problem.restriction, task.graph.units
        removed = frozenset(
            action
            for action in self._derivations.h_actions
            if restriction is not None and action < units and restriction.removed(action)
        )
        tree = (
            self._tree_without(task, removed)
            if removed or len(task.graph.goals) > 1
            else self._tree_from_solved(task)
        )
        return None if tree is None else self._landmarks.tighten(task, removed, tree)

    @property
    def costs(self) -> ExactCosts | None:
        """The exact costs of all actions that can run; ``None`` before landmarks are shared."""
        return None if self._landmarks is None else self._landmarks.costs

    def _tree_from_solved(self, task: Task) -> frozenset[int]:
        """Return the best tree found for the only goal of a question.

        For each achiever of the goal, a union is formed: the achiever and trees of its preconditions. The
        trees of preconditions are known from solved questions, or follow h_add. Redundant actions are removed
        from the cheapest unions.
        """
        graph, costs, derivations, trees = task.graph, task.costs, self._derivations, list[set[int]]()
        assert costs is not None
        assert derivations is not None
        (goal,) = graph.goals
        for achiever in graph.makers[goal]:
            if achiever in derivations.h_actions:
                needs = graph.needs[achiever]
                solved = [self._trees[o,] for o in needs if (o,) in self._trees]
                others = derivations.tree(graph, [o for o in needs if (o,) not in self._trees])
                assert others is not None
                trees.append(others.union([achiever], *solved))
        trees.sort(key=lambda tree: sum(map(costs, tree)))
        smallest = (irredundant_subset(graph, tree, costs) for tree in trees[: tuning.SHARED.unions])
        return frozenset(min(smallest, key=lambda tree: sum(map(costs, tree))))

    def _tree_without(self, task: Task, removed: frozenset[int]) -> frozenset[int] | None:
        """Return a tree without the removed actions; ``None`` if no such tree exists.

        It is the better of two irredundant trees. One follows h_add. The other is a subset of the union of
        two trees: the first one, and the tree found earlier for the same goals.
        """
        graph, costs, derivations = task.graph, task.costs, self._derivations
        assert costs is not None
        assert derivations is not None
        allowed = derivations.h_actions.keys() - removed
        tree = compute_h_values(graph, allowed, costs, h_add=True).tree(graph, graph.goals)
        if tree is None:
            return None
        union = (tree | self._trees.get(graph.goals, frozenset())) - removed
        trees = (irredundant_subset(graph, actions, costs) for actions in (union, tree))
        return frozenset(min(trees, key=lambda tree: sum(map(costs, tree))))

    def record(self, task: Task, gap: Gap | None) -> None:
        """Store the tree of a proved gap; other gaps, and ``None``, are ignored.

        Landmarks are shared as soon as a proof needed the linear relaxation. If the question of the first
        such proof has rounded costs, or is not reduced by both ``bounds`` and ``dear``, landmarks are never
        shared.
        """
        if gap is None or not gap.proved:
            return
        self._trees[task.graph.goals] = gap.incumbent
        if not gap.evidence.tight or self._landmarks is not None or self._sharing_tried:
            return
        self._sharing_tried = True
        if not {Reduction.BOUNDS, Reduction.DEAR} <= task.reductions:
            return
        graph = task.graph
        derivations = compute_h_values(graph, range(len(graph.needs)), task.coarse_costs, h_add=True)
        with suppress(TooFineError):
            costs = ExactCosts(task.problem, task.objectives, derivations.h_actions)
            if not costs.doubt:
                from foon_asp.hypergraph.shared_landmarks import SharedLandmarks  # noqa: PLC0415 (numpy)

                self._derivations = derivations
                objects = sorted(derivations.h_objects)
                self._landmarks = SharedLandmarks(task, costs, derivations.h_actions, objects)


def can_use_solved_goals(task: Task) -> bool:
    """Return whether solved goals can help with a question.

    The question needs goals and must not have required sets. Its network must not be so large that only a
    part of it is looked at.
    """
    restriction = task.problem.restriction
    return (
        len(task.graph.goals) > 0
        and (restriction is None or not restriction.required)
        and len(task.graph.needs) <= task.tuning.lazy_actions
    )
