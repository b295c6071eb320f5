"""An order of executions in which some executions precede others."""

from graphlib import TopologicalSorter

from foon_asp.plans.plan_question import Plan
from foon_asp.problem import Problem


def order_executions(
    problem: Problem, times: frozenset[tuple[int, ...]], after: frozenset[tuple[int, ...]]
) -> Plan:
    """Return a plan that has the given executions in topological order.

    ``times`` has pairs of a unit number and its count. An execution is a unit number and its turn, from 1.
    ``after`` has pairs of executions, written as four numbers: the second execution comes before the first.
    Among executions that are ready together, smaller ones come first.
    """
    predecessors: dict[tuple[int, int], set[tuple[int, int]]] = {
        (unit, turn): set() for unit, count in times for turn in range(1, count + 1)
    }
    for unit, turn, earlier_unit, earlier_turn in after:
        predecessors[unit, turn].add((earlier_unit, earlier_turn))
    plan: list[int] = []
    sorter = TopologicalSorter(predecessors)
    sorter.prepare()
    while sorter.is_active():
        ready = sorted(sorter.get_ready())
        for unit, _ in ready:
            unit_id = problem.network.unit_of_number(unit)
            assert unit_id is not None
            plan.append(unit_id)
        sorter.done(*ready)
    return tuple(plan)
