"""A question as plain arrays: actions that need and give objects, towards some goals."""

from collections.abc import Callable, Container, Iterable, Sequence
from dataclasses import dataclass, replace
from heapq import nsmallest

from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.problem import Left, Objective, Problem, backwards


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Graph(Hypergraph):
    """A hypergraph with goals; nothing is copied where the network has it already.

    Action ``a`` below ``units`` is the unit of that id. Where the items taken from the kitchen are counted,
    taking item ``o`` is the action ``units + o``, which needs nothing and gives ``o``, and ``start`` is
    empty; elsewhere ``start`` is the kitchen. Actions may give what is there from the start, to no effect.
    ``goals`` are those not there from the start. A set of units of which a restriction requires one is one
    more object, which each of its units gives, and a goal; ``required`` are these objects.
    """

    units: int
    goals: tuple[int, ...]
    start: frozenset[int]
    required: range

    def cone(self, allowed: Container[int] | None = None) -> tuple[set[int], set[int]]:
        """Go backwards from the goals through all (allowed) actions, and stop at the start.

        Gives the actions that something wanted can come from, in no order, and the objects that are wanted.
        """
        return backwards(self.goals, self.makers, self.needs, self.start, allowed)

    def thin(self, most: int, cost: Callable[[int], int]) -> "Graph":
        """Return a graph in which required sets have few units each, for estimates.

        Most units of a large set are far from the goals, and one at random is enough to see that it costs no
        more. Those stay that lack least, the cheapest first; what the others give is not told.
        """

        def lacking(action: int) -> tuple[int, int, int]:
            return sum(o not in self.start for o in self.needs[action]), cost(action), action

        few = {o: tuple(nsmallest(most, self.makers[o], lacking)) for o in self.required}
        if not few:
            return self
        assert isinstance(self.makers, Left)
        return replace(self, known_makers=self.makers.instead(few))


def graph_of(problem: Problem, objectives: Iterable[Objective]) -> Graph:
    """Return the graph of a problem under a list of objectives."""
    network, kitchen, restriction = problem.network, problem.kitchen, problem.restriction
    units, size = len(network), len(network.objects)
    goals = tuple(o for o in dict.fromkeys(problem.targets) if o not in kitchen)
    required = range(size, size + (len(restriction.required) if restriction else 0))
    gives: Sequence[Sequence[int]] = problem.gives
    if restriction and restriction.required:
        gives = more = list(problem.gives)
        for o, able in enumerate(restriction.required, start=size):
            for unit in able:
                more[unit] = (*more[unit], o)
    graph = Graph(
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
    taken = {o: (units + o,) for o in kitchen}
    made = problem.makers
    return replace(
        graph,
        needs=[*problem.needs, *([()] * size)],
        gives=[*([o for o in given if o not in kitchen] for given in gives), *((o,) for o in range(size))],
        start=frozenset(),
        known_makers=made.instead(taken)
        if isinstance(made, Left)
        else [taken.get(o, able) for o, able in enumerate(made)],
    )
