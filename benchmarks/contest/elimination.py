"""The question in clauses, where vertex elimination keeps what is made from going round in circles.

Rankooh and Rintanen: Propositional encodings of acyclicity and reachability by using vertex elimination,
AAAI 2022; and: Efficient computation and informative estimation of h+ by integer and linear programming,
ICAPS 2022.
"""

from collections.abc import Iterator
from itertools import count

from contest.instance import Instance

_MOST_FILLED = 3_000_000  # clauses of eliminated nodes; above, cycles are cut off when they turn up


def clauses(instance: Instance, elimination: bool) -> Iterator[list[int]]:
    """Give what every tree keeps to; literals 1 and up are the actions, in order, and then others.

    With ``elimination``, models that are no trees are excluded, unless that took too many clauses.
    """
    makers = instance.makers
    for action, needs in enumerate(instance.needs):
        for node in needs:
            yield [-action - 1, *(maker + 1 for maker in makers[node])]
    for goal in instance.goals:
        yield [maker + 1 for maker in makers[goal]]
    if elimination:
        yield from ordered(instance) or ()


def ordered(instance: Instance) -> list[list[int]] | None:
    """Give clauses that keep nodes on cycles in an order, or ``None`` where there would be too many.

    A literal for each pair of a node and what it is made of; nodes are eliminated one after the other, those
    with the fewest pairs first, and pairs that meet in the eliminated one are joined (vertex elimination,
    Rankooh and Rintanen, AAAI 2022).
    """
    sizes, component = instance.sizes, instance.component
    numbers = count(len(instance.units) + 1)
    found: list[list[int]] = []
    arcs: dict[tuple[int, int], int] = {}
    charges: dict[int, list[int]] = {}
    for node in range(instance.nodes):
        if sizes[component[node]] == 1:
            continue
        charges[node] = []
        for action in instance.makers[node]:
            inner = instance.inner(action, node)
            charge = next(numbers) if inner else action + 1
            charges[node].append(charge)
            if inner:
                found.append([-charge, action + 1])
            for need in inner:
                if (node, need) not in arcs:
                    arcs[node, need] = next(numbers)
                found.append([-charge, arcs[node, need]])
    for action, needs in enumerate(instance.needs):
        found += [[-action - 1, *charges[node]] for node in needs if node in charges]
    found += [charges[goal] for goal in instance.goals if goal in charges]
    below: dict[int, set[int]] = {node: set() for node in charges}
    above: dict[int, set[int]] = {node: set() for node in charges}
    for node, need in arcs:
        below[node].add(need)
        above[need].add(node)
    buckets: dict[int, set[int]] = {}
    for node in charges:
        buckets.setdefault(len(below[node]) * len(above[node]), set()).add(node)
    while buckets:
        least = min(buckets)
        node = buckets[least].pop()
        if not buckets[least]:
            del buckets[least]
        near = below[node] | above[node]
        before = {n: len(below[n]) * len(above[n]) for n in near}
        for top in above[node]:
            below[top].discard(node)
        for bottom in below[node]:
            above[bottom].discard(node)
        for top in above[node]:
            for bottom in below[node]:
                pair = [-arcs[top, node], -arcs[node, bottom]]
                if top == bottom:
                    found.append(pair)
                    continue
                if (top, bottom) not in arcs:
                    arcs[top, bottom] = next(numbers)
                    below[top].add(bottom)
                    above[bottom].add(top)
                found.append([*pair, arcs[top, bottom]])
        if len(found) > _MOST_FILLED:
            return None
        for n in near:
            now = len(below[n]) * len(above[n])
            if now != before[n]:
                buckets[before[n]].discard(n)
                if not buckets[before[n]]:
                    del buckets[before[n]]
                buckets.setdefault(now, set()).add(n)
    return found
