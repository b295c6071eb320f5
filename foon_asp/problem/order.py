"""Orders of the units of a tree in which they can be executed, as in a recipe."""

from collections.abc import Iterable

from foon_asp.problem.problem import Problem


def executable_order(problem: Problem, units: Iterable[int]) -> tuple[int, ...] | None:
    """Return unit ids in an order in which each unit can be executed; ``None`` if there is no such order.

    Each unit is listed once. Units that the goals do not need come last. The units need not make the goals.
    As in a recipe, the units that make the inputs of a step come directly before the step (depth-first from
    the goals). The time is linear in the number of units and their inputs and outputs.
    """
    needs, gives, kitchen = problem.needs, problem.gives, problem.kitchen
    chosen = sorted(set(units))
    missing = {unit: sum(o not in kitchen for o in needs[unit]) for unit in chosen}
    consumers: dict[int, list[int]] = {}
    for unit in chosen:
        for o in needs[unit]:
            if o not in kitchen:
                consumers.setdefault(o, []).append(unit)
    achievers: dict[int, int] = {}  # the first achiever in one executable order: they have no cycle
    ready = [unit for unit in chosen if not missing[unit]]
    for unit in ready:
        for o in gives[unit]:
            if o not in kitchen and o not in achievers:
                achievers[o] = unit
                for consumer in consumers.get(o, ()):
                    missing[consumer] -= 1
                    if not missing[consumer]:
                        ready.append(consumer)
    if len(ready) < len(chosen):
        return None

    order: dict[int, None] = {}
    roots = [achievers[goal] for goal in problem.goals if goal in achievers]
    for root in (*roots, *ready):
        stack = [(root, False)]
        while stack:
            unit, has_inputs = stack.pop()
            if unit in order:
                continue
            if has_inputs:
                order[unit] = None
            else:
                stack.append((unit, True))
                stack += [(achievers[o], False) for o in reversed(needs[unit]) if o in achievers]
    return tuple(order)
