"""Actions that every tree has, and what no tree needs beside them."""

from collections.abc import Container
from dataclasses import replace

from foon_asp.reduce.graph import Graph


def beside_forced(graph: Graph, allowed: Container[int]) -> set[int]:
    """Leave out the actions that no tree without spare ones has, seen from those that every tree has.

    Where a goal has one maker only, every tree has it, so what it needs has to be made as well. What it
    gives is then there anyway, and other makers of that are of no use, unless the forced action may itself
    build upon it. Going backwards from the goals so extended, and stopping at what forced actions give,
    leaves every tree that has no spare action.
    """
    needs, gives, makers = graph.needs, graph.gives, graph.makers
    goals = list(graph.goals)
    start = set(graph.start)
    forced: set[int] = set()
    open_: list[int] = []
    while goals:
        o = goals.pop()
        if o in start:
            continue
        able = [a for a in makers[o] if a in allowed]
        if len(able) != 1:
            open_.append(o)
            continue
        action = able[0]
        if action in forced:
            continue
        forced.add(action)
        goals.extend(needs[action])
        _, upstream = replace(graph, start=frozenset(start), goals=tuple(needs[action])).cone(allowed)
        if upstream.isdisjoint(gives[action]):
            start.update(gives[action])
    left, _ = replace(graph, start=frozenset(start), goals=tuple(open_)).cone(allowed)
    return forced.union(left)
