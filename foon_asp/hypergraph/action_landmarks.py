"""Pruning by action landmarks: actions that every tree has make other actions irrelevant."""

from collections.abc import Container
from dataclasses import replace

from foon_asp.hypergraph.goal_graph import GoalGraph


def relevant_beside_landmarks(graph: GoalGraph, allowed: Container[int]) -> set[int]:
    """Return the allowed actions that stay: action landmarks, and actions relevant beside them.

    The only achiever of a goal is an action landmark, so its preconditions are goals, too. Every tree has the
    effects of the landmark, so that other achievers of these effects are of no use, unless the landmark may
    be derived from its own effects. The search backwards from the extended goals stops at effects of
    landmarks; every irredundant tree remains.
    """
    needs, gives, achievers = graph.needs, graph.gives, graph.makers
    goals = list(graph.goals)
    start = set(graph.start)
    landmarks: set[int] = set()
    open_: list[int] = []
    while goals:
        o = goals.pop()
        if o in start:
            continue
        candidates = [a for a in achievers[o] if a in allowed]
        if len(candidates) != 1:
            open_.append(o)
            continue
        action = candidates[0]
        if action in landmarks:
            continue
        landmarks.add(action)
        goals.extend(needs[action])
        _, upstream = replace(graph, start=frozenset(start), goals=tuple(needs[action])).cone(allowed)
        if upstream.isdisjoint(gives[action]):
            start.update(gives[action])
    relevant, _ = replace(graph, start=frozenset(start), goals=tuple(open_)).cone(allowed)
    return landmarks.union(relevant)
