"""Pruning by action landmarks: an action that every tree has can make other actions irrelevant."""

from collections.abc import Container
from dataclasses import replace

from foon_asp.hypergraph.goal_graph import GoalGraph


def relevant_given_landmarks(graph: GoalGraph, allowed: Container[int]) -> set[int]:
    """Return the allowed actions that an irredundant tree can have: action landmarks and relevant others.

    If a goal has only one allowed achiever, this action is an action landmark: every tree has it. Then its
    preconditions are handled as goals. Every tree makes the effects of a landmark, so other achievers of
    these effects are redundant. So the backward search from the goals stops at effects of landmarks.

    There is one exception: a landmark that may help to derive its own preconditions. The search does not stop
    at effects of such a landmark.
    """
    needs, gives, achievers = graph.needs, graph.gives, graph.makers
    goals = list(graph.goals)
    start = set(graph.start)
    landmarks: set[int] = set()
    other_goals: list[int] = []
    while goals:
        o = goals.pop()
        if o in start:
            continue
        candidates = [a for a in achievers[o] if a in allowed]
        if len(candidates) != 1:
            other_goals.append(o)
            continue
        action = candidates[0]
        if action in landmarks:
            continue
        landmarks.add(action)
        goals.extend(needs[action])
        _, upstream = replace(graph, start=frozenset(start), goals=tuple(needs[action])).cone(allowed)
        if upstream.isdisjoint(gives[action]):
            start.update(gives[action])
    relevant, _ = replace(graph, start=frozenset(start), goals=tuple(other_goals)).cone(allowed)
    return landmarks.union(relevant)
