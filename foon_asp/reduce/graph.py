"""A question as plain arrays: actions that need and give objects, towards some goals."""

from collections.abc import Container, Iterable, Sequence
from dataclasses import dataclass

from foon_asp.bounds import Hypergraph
from foon_asp.problem import Objective, Problem, backwards


@dataclass(frozen=True, eq=False, kw_only=True)
class Graph(Hypergraph):
    """A hypergraph with goals; nothing is copied where the network has it already.

    Action ``a`` below ``units`` is the unit of that id. Where the items taken from the kitchen are counted,
    taking item ``o`` is the action ``units + o``, which needs nothing and gives ``o``, and ``start`` is
    empty; elsewhere ``start`` is the kitchen. Actions may give what is there from the start, to no effect.
    ``goals`` are those not there from the start.
    """

    units: int
    goals: tuple[int, ...]
    start: frozenset[int]

    def cone(self, allowed: Container[int] | None = None) -> tuple[set[int], set[int]]:
        """Go backwards from the goals through all (allowed) actions, and stop at the start.

        Gives the actions that something wanted can come from, in no order, and the objects that are wanted.
        """
        return backwards(self.goals, self.makers, self.needs, self.start, allowed)


def graph_of(problem: Problem, objectives: Iterable[Objective]) -> Graph:
    """Give the graph of a problem under a list of objectives."""
    network, kitchen = problem.network, problem.kitchen
    units, size = len(network), len(network.objects)
    goals = tuple(o for o in dict.fromkeys(problem.goals) if o not in kitchen)
    if not any(objective.row.item for objective in objectives):
        return Graph(
            size,
            problem.needs,
            problem.gives,
            start=kitchen,
            known_makers=problem.makers,
            units=units,
            goals=goals,
        )
    makers = list(problem.makers)
    for o in kitchen:
        makers[o] = (units + o,)
    gives: list[Sequence[int]] = [[o for o in given if o not in kitchen] for given in problem.gives]
    gives += [(o,) for o in range(size)]
    needs = [*problem.needs, *([()] * size)]
    return Graph(size, needs, gives, start=frozenset(), known_makers=makers, units=units, goals=goals)
