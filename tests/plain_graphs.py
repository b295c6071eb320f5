"""Graphs of the reductions written down as lists of numbers, and random ones."""

import random
from collections.abc import Collection, Iterable, Sequence

from foon_asp.reduce.graph import Graph

Action = tuple[Sequence[int], Sequence[int]]  # what it needs, what it gives


def plain(actions: Sequence[Action], goals: Iterable[int], start: Iterable[int] = ()) -> Graph:
    """Give the graph of some actions, each by what it needs and what it gives."""
    needs, gives = [need for need, _ in actions], [give for _, give in actions]
    named = {*goals, *start}.union(*needs, *gives)
    return Graph(
        1 + max(named, default=0),
        needs,
        gives,
        start=frozenset(start),
        units=len(actions),
        goals=tuple(goals),
    )


def random_graph(seed: int, actions: int = 9, objects: int = 8) -> Graph:
    """Give a graph of which much can be made, with circles in it; object 0 is there from the start."""
    rng = random.Random(f"plain {seed}")
    made = []
    for _ in range(actions):
        needs = rng.sample(range(objects), rng.choice((0, 1, 1, 2, 2)))
        made.append((needs, rng.sample(range(objects), rng.choice((1, 1, 1, 2)))))
    return plain(made, rng.sample(range(1, objects), rng.choice((1, 1, 2))), [0])


def executes(graph: Graph, actions: Collection[int]) -> bool:
    """Whether all of the actions can run, one after the other, and make the goals."""
    made, waiting = set(graph.start), set(actions)
    while ready := {a for a in waiting if made.issuperset(graph.needs[a])}:
        waiting -= ready
        made = made.union(*(graph.gives[a] for a in ready))
    return not waiting and made.issuperset(graph.goals)
