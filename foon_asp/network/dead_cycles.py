"""Objects that need themselves: made by units, and only by units that need them."""

from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

from foon_asp.network import Network
from foon_asp.network.graph import cycles


class DeadCycle(NamedTuple):
    """A set of object nodes, each made only by units that need one of the set.

    ``steps`` lead once around: each is a node and the unit that needs it and makes the node of the next step,
    the last that of the first. No way around is shorter for the first node, which is the one that is needed
    first in the order of the units. ``nodes`` are all of the set.
    """

    steps: tuple[tuple[int, int], ...]
    nodes: frozenset[int]


def dead_cycles(network: Network, at_hand: Collection[int] = ()) -> list[DeadCycle]:
    """Find the dead cycles, all else being at hand: linear in the size of the network.

    A unit does not make what it needs, it hands it on: a knife that chops is a knife before. What no unit
    makes, and what is ``at_hand``, is there from the start. If none is found, everything can be made. Where
    some of a set that need each other can be made and others not, the parts of those others are given that
    wait for no other part.
    """
    inputs = [frozenset(nodes) for nodes in network.inputs]
    made = [
        tuple(node for node in outputs if node not in needed)
        for needed, outputs in zip(inputs, network.outputs, strict=True)
    ]
    waiting = {node for nodes in made for node in nodes}.difference(at_hand)
    component = _components(network, made, waiting)
    if not component:
        return []
    dead = _unreached(network, made, component)
    component = {node: number for node, number in component.items() if node in dead}
    roots = _components(network, made, dead)
    members: dict[int, set[int]] = {}
    for node, root in roots.items():
        members.setdefault(root, set()).add(node)
    makers: dict[int, list[int]] = {root: [] for root in members}
    for unit, outputs in enumerate(made):
        needed: dict[int, set[int | None]] = {}  # the sets that it waits for, of each component
        for node in network.inputs[unit]:
            if node in component:
                needed.setdefault(component[node], set()).add(roots.get(node))
        for root, number in {roots[node]: component[node] for node in outputs if node in roots}.items():
            if needed.get(number) != {root}:  # it waits for another set too, which is at the root
                members.pop(root, None)
            else:
                makers[root].append(unit)
    return [_around(network, made, frozenset(nodes), makers[root]) for root, nodes in members.items()]


def _components(network: Network, made: list[tuple[int, ...]], nodes: Collection[int]) -> dict[int, int]:
    """Number the sets of nodes that need each other, within the nodes given; others have no number."""
    part = replace(
        network,
        inputs=tuple(tuple(n for n in side if n in nodes) for side in network.inputs),
        outputs=tuple(tuple(n for n in side if n in nodes) for side in made),
    )
    return {node: number for number, found in enumerate(cycles(part)) for node in found}


def _unreached(network: Network, made: list[tuple[int, ...]], component: dict[int, int]) -> set[int]:
    """Return the nodes of each component that cannot be made although all nodes outside of it are at hand."""
    lacking: dict[tuple[int, int], int] = {}  # inputs that a unit lacks, within a component of its outputs
    for unit, outputs in enumerate(made):
        for number in {component[node] for node in outputs if node in component}:
            lacking[unit, number] = sum(1 for n in network.inputs[unit] if component.get(n) == number)
    ready = [key for key, count in lacking.items() if not count]
    unreached = set(component)
    while ready:
        unit, number = ready.pop()
        for node in made[unit]:
            if node not in unreached or component[node] != number:
                continue
            unreached.remove(node)
            for user in network.consumers[node]:
                key = user, number
                if key in lacking:
                    lacking[key] -= 1
                    if not lacking[key]:
                        ready.append(key)
    return unreached


def _around(
    network: Network, made: list[tuple[int, ...]], nodes: frozenset[int], makers: list[int]
) -> DeadCycle:
    """Go around a set of nodes that need each other, breadth first from the one that is needed first.

    ``makers`` are the units that make one of the set, in order.
    """
    users: dict[int, list[int]] = {}
    for unit in makers:
        for node in network.inputs[unit]:
            if node in nodes:
                users.setdefault(node, []).append(unit)
    start = next(iter(users))
    came_from: dict[int, tuple[int, int]] = {}
    gone_through: set[int] = set()
    frontier = [start]
    while start not in came_from:
        reached = []
        for node in frontier:
            for unit in users[node]:
                if unit in gone_through:
                    continue
                gone_through.add(unit)
                for output in made[unit]:
                    if output in nodes and output not in came_from:
                        came_from[output] = node, unit
                        reached.append(output)
        frontier = reached
    steps = [came_from[start]]
    while steps[-1][0] != start:
        steps.append(came_from[steps[-1][0]])
    return DeadCycle(tuple(reversed(steps)), nodes)
