"""Levels of FOON: how much of an object node counts.

At level 3 all parts count. Level 2 drops contents, level 1 keeps only the label. Units that then have the
same motion, inputs and outputs are one unit, which stands for all of them.
"""

from dataclasses import replace

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.network import Network, NetworkBuilder
from foon_asp.network.node_pattern import NodePattern
from foon_asp.network.object_node import ObjectNode

LEVELS = (1, 2, 3)


def node_at_level(node: ObjectNode, level: int) -> ObjectNode:
    """Return a node with only the parts that count at a level."""
    if level == 3:
        return node
    return ObjectNode(node.label) if level == 1 else ObjectNode(node.label, node.states, node.relations)


def unit_at_level(unit: FunctionalUnit, level: int) -> FunctionalUnit:
    """Return a unit with the parts of its nodes that count at a level; equal nodes are listed once."""
    if level == 3:
        return unit
    inputs, outputs = (
        [node_at_level(node, level) for node in side_nodes] for side_nodes in (unit.inputs, unit.outputs)
    )
    return FunctionalUnit.of(unit.motion, inputs, outputs)


def pattern_at_level(pattern: NodePattern, level: int) -> NodePattern:
    """Return a kitchen or goals entry with only the parts that count at a level."""
    if level == 3:
        return pattern
    return NodePattern(pattern.label) if level == 1 else pattern._replace(ingredients=(), contents=())


def network_at_level(network: Network, level: int) -> Network:
    """Return a level-3 network at a level, with new ids; ``detailed`` and ``stands_for`` lead to the old ids.

    A unit keeps the sources of all units that it stands for. Raises :class:`ValueError` when the network is
    not of level 3 or there is no such level.
    """
    if level not in LEVELS or network.level != 3:
        raise ValueError(f"no way from level {network.level} to level {level}")
    if level == 3:
        return network
    nodes = [node_at_level(node, level) for node in network.objects]
    builder = NetworkBuilder()
    stands_for: list[list[int]] = []
    for unit, (motion, inputs, outputs) in enumerate(
        zip(network.motions, network.inputs, network.outputs, strict=True)
    ):
        merged = builder.add(
            motion, [nodes[o] for o in inputs], [nodes[o] for o in outputs], *network.sources[unit]
        )
        if merged == len(stands_for):
            stands_for.append([])
        stands_for[merged].append(unit)
    merged_network = builder.build()
    objects: dict[ObjectNode, list[int]] = {node: [] for node in merged_network.objects}
    for o, node in enumerate(nodes):
        objects[node].append(o)
    return replace(
        merged_network,
        level=level,
        detailed=network,
        stands_for=tuple(map(tuple, stands_for)),
        objects_stand_for=tuple(map(tuple, objects.values())),
    )
