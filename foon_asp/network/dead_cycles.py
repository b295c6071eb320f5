"""Dead cycles: object nodes that are made only by units that need them."""

from collections.abc import Collection
from dataclasses import replace
from typing import NamedTuple

from foon_asp.network import Network
from foon_asp.network.graph import cycles


class DeadCycle(NamedTuple):
    """A set of object nodes, each made only by units that need a node of the set.

    ``nodes`` are the ids of the set. ``steps`` are a shortest cycle through one of them. Each step is the id
    of a node and the id of a unit that needs the node. The unit makes the node of the next step; the last
    unit makes the node of the first step.
    """

    steps: tuple[tuple[int, int], ...]
    nodes: frozenset[int]


def dead_cycles(network: Network, available: Collection[int] = ()) -> list[DeadCycle]:
    """Return the dead cycles among nodes that are not ``available``, in time linear in the network.

    A node that a unit needs, such as the knife that chops, does not count as made by this unit. Nodes that no
    unit makes count as available. If there is no dead cycle, all nodes are available or can be made.

    Algorithm: nodes that can be made are removed from each strongly connected component. The rest of the
    component falls into components of its own. Such a component is a dead cycle if it needs no node of
    another one.
    """
    inputs = [frozenset(nodes) for nodes in network.inputs]
    made = [
        tuple(node for node in outputs if node not in needed)
        for needed, outputs in zip(inputs, network.outputs, strict=True)
    ]
    made_nodes = {node for nodes in made for node in nodes}.difference(available)
    component = _components(network, made, made_nodes)
    if not component:
        return []
    dead = _dead_nodes(network, made, component)
    component = {node: number for node, number in component.items() if node in dead}
    subcomponent = _components(network, made, dead)
    members: dict[int, set[int]] = {}
    for node, subnumber in subcomponent.items():
        members.setdefault(subnumber, set()).add(node)
    producers: dict[int, list[int]] = {subnumber: [] for subnumber in members}
    for unit, outputs in enumerate(made):
        needed: dict[int, set[int | None]] = {}  # by component: the subcomponents of its input nodes
        for node in network.inputs[unit]:
            if node in component:
                needed.setdefault(component[node], set()).add(subcomponent.get(node))
        for subnumber, number in {
            subcomponent[node]: component[node] for node in outputs if node in subcomponent
        }.items():
            if needed.get(number) != {subnumber}:  # the unit needs another set too
                members.pop(subnumber, None)
            else:
                producers[subnumber].append(unit)
    return [
        _shortest_cycle(network, made, frozenset(nodes), producers[subnumber])
        for subnumber, nodes in members.items()
    ]


def _components(network: Network, made: list[tuple[int, ...]], nodes: Collection[int]) -> dict[int, int]:
    """Map each node on a cycle to the number of its strongly connected component, from 0.

    Only ``nodes`` and the edges between them count. ``made`` has for each unit the nodes that it makes and
    does not need.
    """
    subnetwork = replace(
        network,
        inputs=tuple(tuple(n for n in unit_nodes if n in nodes) for unit_nodes in network.inputs),
        outputs=tuple(tuple(n for n in unit_nodes if n in nodes) for unit_nodes in made),
    )
    return {node: number for number, component in enumerate(cycles(subnetwork)) for node in component}


def _dead_nodes(network: Network, made: list[tuple[int, ...]], component: dict[int, int]) -> set[int]:
    """Return the nodes on cycles that cannot be made, even if all nodes of other components are available.

    ``made`` has for each unit the nodes that it makes and does not need. ``component`` maps each node on a
    cycle to the number of its component.
    """
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
            for consumer in network.consumers[node]:
                key = consumer, number
                if key in lacking:
                    lacking[key] -= 1
                    if not lacking[key]:
                        ready.append(key)
    return unreached


def _shortest_cycle(
    network: Network, made: list[tuple[int, ...]], nodes: frozenset[int], producers: list[int]
) -> DeadCycle:
    """Return the dead cycle of ``nodes``, which are strongly connected; its steps are a shortest cycle.

    ``producers`` are the units that make a node of the set, in rising order. The cycle is found by
    breadth-first search from an input of the first producer. ``made`` has for each unit the nodes that it
    makes and does not need.
    """
    consumers: dict[int, list[int]] = {}
    for unit in producers:
        for node in network.inputs[unit]:
            if node in nodes:
                consumers.setdefault(node, []).append(unit)
    start = next(iter(consumers))
    predecessor: dict[int, tuple[int, int]] = {}
    visited: set[int] = set()
    frontier = [start]
    while start not in predecessor:
        reached = []
        for node in frontier:
            for unit in consumers[node]:
                if unit in visited:
                    continue
                visited.add(unit)
                for output in made[unit]:
                    if output in nodes and output not in predecessor:
                        predecessor[output] = node, unit
                        reached.append(output)
        frontier = reached
    steps = [predecessor[start]]
    while steps[-1][0] != start:
        steps.append(predecessor[steps[-1][0]])
    return DeadCycle(tuple(reversed(steps)), nodes)
