"""Execution of plans of any length, without the solver's code: copies are counted, not listed."""

from collections.abc import Iterable
from itertools import groupby
from typing import NamedTuple

from foon_asp.network import ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.execution import Executions


class CountedRun(NamedTuple):
    """The result of executing a plan with :func:`counted_run`.

    ``lacking``: the node of which too few copies exist at some step or for a goal; ``None`` if the plan runs.
    ``stock``: for each node with a finite stock, the number of initial copies that the plan needs. If the
    plan stopped, the numbers may be too small, since later steps do not count.
    """

    lacking: ObjectNode | None
    stock: dict[ObjectNode, int]


def counted_run(problem: Problem, plan: Iterable[int]) -> CountedRun:
    """Execute a plan from the kitchen of a problem whose items are used up, and check the goals at its end.

    The execution stops at the first shortage. ``plan`` has the ids of the units in order, with repeats.
    Equal units in a row are executed as one step.
    """
    executions = Executions(problem)
    initial = executions.initial_copies()
    copies, stock = initial.copy(), dict.fromkeys(initial, 0)
    for unit, equal_steps in groupby(plan):
        times = sum(1 for _ in equal_steps)
        preconditions, consumes, adds = executions.of(problem.network.unit(unit))
        for node in {*preconditions, *adds}:
            if executions.is_endless(node):
                continue
            change = adds.get(node, 0) - consumes.get(node, 0)
            least = copies[node] + min(0, (times - 1) * change)  # before one of the executions
            needed = preconditions.get(node, 0)
            if least < needed:
                return CountedRun(node, stock)
            if node in initial:
                stock[node] = max(stock[node], needed - least + initial[node])
            copies[node] += times * change
    for node, wanted_count in executions.wanted_copies().items():
        if executions.is_endless(node):
            continue
        if copies[node] < wanted_count:
            return CountedRun(node, stock)
        if node in initial:
            stock[node] = max(stock[node], wanted_count - copies[node] + initial[node])
    return CountedRun(None, stock)
