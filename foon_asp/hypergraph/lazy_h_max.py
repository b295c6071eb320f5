"""Lazy h_max: whether objects can be made at a reduced cost up to a limit, computed on demand."""

import math
from collections.abc import Callable, Container

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.goal_graph import GoalGraph


def lazy_h_max_test(
    graph: GoalGraph, allowed: Container[int], reduced_cost: Callable[[int], int]
) -> Callable[[int, float], bool]:
    """Return a function that tests whether the h_max of an object is at most a limit.

    h_max is computed over the ``allowed`` actions at their reduced costs. :func:`compute_h_values` computes
    h_max of all objects at once. The returned function goes backwards from one object instead, and prunes by
    the limit. With a low limit, it looks at a small part of a large network. It returns ``True`` without
    proof if it would go too deep or take too long. Bounds on h_max that one call finds are kept for later
    calls. Initial objects are within any limit.
    """
    needs, achievers, start = graph.needs, graph.makers, graph.start
    lower_bounds: dict[int, float] = {}  # on the h_max of objects
    sufficient_limits: dict[int, float] = {}  # limits for which the answer was ``True``
    budget = tuning.CUTS.lazy_looks

    def is_within(o: int, limit: float, depth: int = tuning.CUTS.lazy_depth) -> bool:
        """Return whether the h_max of an object is at most a limit, and record what this implies.

        Preconditions are looked at up to this ``depth`` of recursion. Beyond it, and once the budget is used
        up, the result is ``True`` without proof.
        """
        nonlocal budget
        if lower_bounds.get(o, 0) > limit:
            return False
        if o in start or sufficient_limits.get(o, math.inf) <= limit or budget < 0:
            return True
        lowest = math.inf
        for action in achievers[o]:
            if action not in allowed:
                continue
            budget -= 1
            h_action: float = reduced_cost(action)
            if h_action <= limit:
                remaining = limit - h_action
                for needed in needs[action]:
                    if needed not in start and depth and not is_within(needed, remaining, depth - 1):
                        missing = lower_bounds[needed]
                        h_action = (
                            missing if missing == math.inf else h_action + missing
                        )  # whole numbers may be huge
                        break
                else:
                    sufficient_limits[o] = limit
                    return True
            lowest = min(lowest, h_action)
        lower_bounds[o] = lowest
        return False

    return is_within
