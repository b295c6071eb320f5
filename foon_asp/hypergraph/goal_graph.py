"""A question as a hypergraph of actions with preconditions and add effects, and goals."""

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, replace
from heapq import nsmallest

from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.problem import FilteredSets, Objective, Problem, search_backward


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class GoalGraph(Hypergraph):
    """A hypergraph with goals; it shares the lists of the network where possible.

    ``units``: the number of units. Action ``a`` below it is the unit with the id ``a``.
    ``goals``: the goals that are not initial.
    ``start``: the kitchen. Add effects may be initial objects.
    ``required``: additional objects, one for each required set. A tree has a unit of each set. So the object
    of a set is a goal, and each unit of the set achieves it.

    If an objective counts the items taken from the kitchen, ``start`` is empty. Then action ``units + o``
    takes item ``o``: it has no preconditions and the effect ``o``.
    """

    units: int
    goals: tuple[int, ...]
    start: frozenset[int]
    required: range

    def cone(self, allowed: Container[int] | None = None) -> tuple[set[int], set[int]]:
        """Return the relevant actions and objects, found backwards from the goals through allowed actions.

        The search stops at initial objects. ``allowed``: the actions that are allowed; ``None`` for all.
        """
        return search_backward(self.goals, self.makers, self.needs, self.start, allowed)

    def thin(self, max_achievers: int, cost: Callable[[int], int]) -> "GoalGraph":
        """Return a graph in which each required set has at most ``max_achievers`` units, for estimates.

        The units with the fewest non-initial preconditions stay. Among units with equally many, the cheapest
        stay. The achievers of other objects do not change. Without required sets, the graph itself is
        returned.
        """

        def sort_key(action: int) -> tuple[int, int, int]:
            """Return the number of non-initial preconditions of an action, its cost and its number."""
            return sum(o not in self.start for o in self.needs[action]), cost(action), action

        kept = {o: tuple(nsmallest(max_achievers, self.makers[o], sort_key)) for o in self.required}
        if not kept:
            return self
        assert isinstance(self.makers, FilteredSets)
        return replace(self, known_makers=self.makers.with_sets(kept))


def graph_of(problem: Problem, objectives: Iterable[Objective]) -> GoalGraph:
    """Return the graph of a problem under a list of objectives.

    Goals in the kitchen are left out. If an objective counts kitchen items, the graph has an action for
    taking each item. Then units have no kitchen items among their add effects.
    """
    network, kitchen, restriction = problem.network, problem.kitchen, problem.restriction
    units, size = len(network), len(network.objects)
    goals = tuple(o for o in dict.fromkeys(problem.targets) if o not in kitchen)
    required = range(size, size + (len(restriction.required) if restriction else 0))
    gives: Sequence[Sequence[int]] = problem.gives
    if restriction and restriction.required:
        gives = extended = list(problem.gives)
        for o, units_of_set in enumerate(restriction.required, start=size):
            for unit in units_of_set:
                extended[unit] = (*extended[unit], o)
    graph = GoalGraph(
        size + len(required),
        problem.needs,
        gives,
        start=kitchen,
        known_makers=problem.makers,
        units=units,
        goals=goals,
        required=required,
    )
    if not any(objective.row.item for objective in objectives):
        return graph
    taking = {o: (units + o,) for o in kitchen}
    achievers = problem.makers
    return replace(
        graph,
        needs=[*problem.needs, *([()] * size)],
        gives=[
            *([o for o in effects if o not in kitchen] for effects in gives),
            *((o,) for o in range(size)),
        ],
        start=frozenset(),
        known_makers=achievers.with_sets(taking)
        if isinstance(achievers, FilteredSets)
        else [taking.get(o, units_of_set) for o, units_of_set in enumerate(achievers)],
    )
