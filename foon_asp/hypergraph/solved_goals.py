"""What answers for some goals of a network teach about others."""

from contextlib import suppress
from typing import TYPE_CHECKING

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.exact_costs import ExactCosts, TooFineError
from foon_asp.hypergraph.gap import Gap
from foon_asp.hypergraph.h_values import Derivations, derive
from foon_asp.hypergraph.incumbent_trees import irredundant
from foon_asp.hypergraph.reductions import Reduction
from foon_asp.hypergraph.task import Task

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.shared_landmarks import SharedLandmarks


class SolvedGoals:
    """The best trees of questions that differ in their one goal alone, and the landmarks that they share.

    Landmarks are shared from the first question on that greedy cuts did not answer: with easier questions it
    is faster to begin each anew.
    """

    def __init__(self) -> None:
        self._trees: dict[int, frozenset[int]] = {}
        self._derivations: Derivations | None = None  # by h_add, once landmarks are shared
        self._landmarks: SharedLandmarks | None = None
        self._declined = False  # whether costs are rounded, so that nothing is shared

    @property
    def sharing(self) -> bool:
        """Whether questions share landmarks now."""
        return self._landmarks is not None

    def h_add(self, goal: int) -> int:
        """Return the h_add value of a goal, 0 where landmarks are not shared and where there is no tree."""
        return 0 if self._derivations is None else self._derivations.cost.get(goal, 0)

    def gap(self, task: Task) -> Gap | None:
        """Return the gap of a question with shared costs; ``None`` where nothing is, or there is no tree."""
        if self._landmarks is None or self._derivations is None:
            return None
        (goal,) = task.graph.goals
        if goal not in self._derivations.cost:
            return None
        return self._landmarks.tighten(task, goal, self._first_tree(task, goal))

    @property
    def costs(self) -> ExactCosts | None:
        """The costs of all actions that can run, by which shared gaps are measured."""
        return None if self._landmarks is None else self._landmarks.costs

    def _first_tree(self, task: Task, goal: int) -> frozenset[int]:
        """Return the best tree of known trees of the preconditions of an achiever, and of h_add."""
        graph, costs, derivations = task.graph, task.costs, self._derivations
        assert costs is not None
        assert derivations is not None
        trees: list[set[int]] = []
        for achiever in graph.makers[goal]:
            if achiever in derivations.h_actions:
                needs = graph.needs[achiever]
                solved = [self._trees[o] for o in needs if o in self._trees]
                others = derivations.tree(graph, [o for o in needs if o not in self._trees])
                assert others is not None
                trees.append(others.union([achiever], *solved))
        trees.sort(key=lambda tree: sum(map(costs, tree)))
        smallest = (irredundant(graph, tree, costs) for tree in trees[: tuning.SHARED.unions])
        return frozenset(min(smallest, key=lambda tree: sum(map(costs, tree))))

    def learn(self, task: Task, gap: Gap | None) -> None:
        """Keep the tree of a proved gap; share landmarks from now on if greedy cuts did not prove it."""
        if gap is None or not gap.proved:
            return
        (goal,) = task.graph.goals
        self._trees[goal] = gap.incumbent
        if not gap.evidence.tight or self._landmarks is not None or self._declined:
            return
        self._declined = True
        if not {Reduction.BOUNDS, Reduction.DEAR} <= task.reductions:
            return
        graph = task.graph
        derivations = derive(graph, range(len(graph.needs)), task.coarse, h_add=True)
        with suppress(TooFineError):
            costs = ExactCosts(task.problem, task.objectives, derivations.h_actions)
            if not costs.doubt:
                from foon_asp.hypergraph.shared_landmarks import SharedLandmarks  # noqa: PLC0415 (numpy)

                self._derivations = derivations
                objects = sorted(derivations.cost)
                self._landmarks = SharedLandmarks(task, costs, derivations.h_actions, objects)


def is_open_to(task: Task) -> bool:
    """Return whether a question has one goal, no rules, and a network that is looked at as a whole."""
    return (
        len(task.graph.goals) == 1
        and task.problem.restriction is None
        and len(task.graph.needs) <= task.tuning.lazy_actions
    )
