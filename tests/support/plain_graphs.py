"""Graphs of the reductions and questions written down as lists of numbers, and random graphs."""

import random
from collections.abc import Collection, Iterable, Sequence
from fractions import Fraction

from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem

Action = tuple[Sequence[int], Sequence[int]]  # what it needs, what it gives


def plain(actions: Sequence[Action], goals: Iterable[int], start: Iterable[int] = ()) -> GoalGraph:
    """Give the graph of some actions, each by what it needs and what it gives."""
    needs, gives = [need for need, _ in actions], [give for _, give in actions]
    named = {*goals, *start}.union(*needs, *gives)
    return GoalGraph(
        1 + max(named, default=0),
        needs,
        gives,
        start=frozenset(start),
        units=len(actions),
        goals=tuple(goals),
        required=range(0),
    )


def plain_problem(
    actions: Sequence[Action], goals: Iterable[int], prices: Sequence[int] = (), rates: Sequence[str] = ()
) -> Problem:
    """Ask for things that come of the kitchen's item 0, by units of as many inputs as their price.

    Without prices each unit has what it needs, and item 0 where that is nothing. What makes up for the
    price are items of the kitchen. Units have the numbers of the actions.
    """
    builder = NetworkBuilder()
    for number, (needs, gives) in enumerate(actions):
        missing = prices[number] - len(needs) if prices else not needs
        assert missing >= 0
        inputs = [*map(_thing, needs), *(_thing(0, str(n)) for n in range(missing))]
        builder.add(f"motion {number}", inputs, list(map(_thing, gives)), Source("plain", number + 1))
    network = builder.build()
    ids = {node: o for o, node in enumerate(network.objects)}
    return Problem(
        network,
        frozenset(o for node, o in ids.items() if node.label == "thing 0"),
        tuple(ids[_thing(goal)] for goal in goals),
        {f"motion {n}": Fraction(rate) for n, rate in enumerate(rates)} if rates else None,
        frozenset(),
        ContainerRule.STRICT,
    )


def _thing(number: int, *states: str) -> ObjectNode:
    return ObjectNode.of(f"thing {number}", states)


def random_graph(seed: int, actions: int = 9, objects: int = 8) -> GoalGraph:
    """Give a graph of which much can be made, with circles in it; object 0 is there from the start."""
    rng = random.Random(f"plain {seed}")
    made = []
    for _ in range(actions):
        needs = rng.sample(range(objects), rng.choice((0, 1, 1, 2, 2)))
        made.append((needs, rng.sample(range(objects), rng.choice((1, 1, 1, 2)))))
    return plain(made, rng.sample(range(1, objects), rng.choice((1, 1, 2))), [0])


def executes(graph: GoalGraph, actions: Collection[int]) -> bool:
    """Whether all of the actions can run, one after the other, and make the goals."""
    made, waiting = set(graph.start), set(actions)
    while ready := {a for a in waiting if made.issuperset(graph.needs[a])}:
        waiting -= ready
        made = made.union(*(graph.gives[a] for a in ready))
    return not waiting and made.issuperset(graph.goals)
