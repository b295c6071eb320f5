"""Execution of plans of any length by numbers of copies, independent of the solver."""

from collections.abc import Iterable
from itertools import groupby
from typing import NamedTuple

from foon_asp.network import ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.execution import Executions


class CountedRun(NamedTuple):
    """The result of an execution by numbers.

    ``lacking`` is the node that has too few copies, ``None`` where the plan runs. ``stock`` maps each node
    with a finite stock to the number of copies that the plan needs.
    """

    lacking: ObjectNode | None
    stock: dict[ObjectNode, int]


def counted_run(problem: Problem, plan: Iterable[int]) -> CountedRun:
    """Execute a plan, given by unit ids with repeats, from the kitchen of a problem whose items are used up.

    Equal units that follow each other are executed at once.
    """
    executions = Executions(problem)
    initial = executions.initial_copies()
    copies, stock = initial.copy(), dict.fromkeys(initial, 0)
    for unit, run in groupby(plan):
        times = sum(1 for _ in run)
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
    for node, wanted in executions.wanted_copies().items():
        if executions.is_endless(node):
            continue
        if copies[node] < wanted:
            return CountedRun(node, stock)
        if node in initial:
            stock[node] = max(stock[node], wanted - copies[node] + initial[node])
    return CountedRun(None, stock)
