"""Putting the units of a tree into an order that executes and that a person can follow."""

from collections.abc import Iterable

from foon_asp.problem.problem import Problem


def executable_order(problem: Problem, units: Iterable[int]) -> tuple[int, ...] | None:
    """Order units so that each finds its needed inputs made before it; ``None`` when no order does.

    What a step needs is made just before it (depth first from the goals), as a cook would read it.
    Linear in the size of the units.
    """
    needs, gives, kitchen = problem.needs, problem.gives, problem.kitchen
    chosen = sorted(set(units))
    missing = {unit: sum(o not in kitchen for o in needs[unit]) for unit in chosen}
    waiting: dict[int, list[int]] = {}
    for unit in chosen:
        for o in needs[unit]:
            if o not in kitchen:
                waiting.setdefault(o, []).append(unit)
    makers: dict[int, int] = {}  # first maker in one order that executes: following them never circles
    ready = [unit for unit in chosen if not missing[unit]]
    for unit in ready:
        for o in gives[unit]:
            if o not in kitchen and o not in makers:
                makers[o] = unit
                for consumer in waiting.get(o, ()):
                    missing[consumer] -= 1
                    if not missing[consumer]:
                        ready.append(consumer)
    if len(ready) < len(chosen):
        return None

    order: dict[int, None] = {}
    roots = [makers[goal] for goal in problem.goals if goal in makers]
    for root in (*roots, *ready):
        stack = [(root, False)]
        while stack:
            unit, supplied = stack.pop()
            if unit in order:
                continue
            if supplied:
                order[unit] = None
            else:
                stack.append((unit, True))
                stack += [(makers[o], False) for o in reversed(needs[unit]) if o in makers]
    return tuple(order)
