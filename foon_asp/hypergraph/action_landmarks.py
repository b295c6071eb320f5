"""Pruning by action landmarks: actions that every tree has make other actions irrelevant."""

from collections.abc import Container
from dataclasses import replace

from foon_asp.hypergraph.goal_graph import GoalGraph


def relevant_beside_landmarks(graph: GoalGraph, allowed: Container[int]) -> set[int]:
    """Return the allowed actions that an irredundant tree can have: action landmarks and relevant others.

    The only achiever of a goal is an action landmark, and its preconditions become goals, too. Every tree
    makes the effects of an action landmark, so other achievers of its effects are redundant, unless the
    preconditions of the landmark may be derived from its effects. So the backward search from the goals stops
    at effects of landmarks.
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
