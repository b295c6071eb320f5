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
    """Return a node reduced to its label at level 1, or to label, states and relations at level 2.

    At level 3, return it unchanged.
    """
    if level == 3:
        return node
    return ObjectNode(node.label) if level == 1 else ObjectNode(node.label, node.states, node.relations)


def unit_at_level(unit: FunctionalUnit, level: int) -> FunctionalUnit:
    """Return a unit whose nodes are reduced to a level; nodes that become equal on one side are merged.

    At level 3, return it unchanged.
    """
    if level == 3:
        return unit
    inputs, outputs = (
        [node_at_level(node, level) for node in side_nodes] for side_nodes in (unit.inputs, unit.outputs)
    )
    return FunctionalUnit.of(unit.motion, inputs, outputs)


def pattern_at_level(pattern: NodePattern, level: int) -> NodePattern:
    """Return an entry of a kitchen or goals file with only the parts that count at a level.

    At level 2 it has no ingredients and contents, at level 1 its label alone. At level 3 it is unchanged.
    """
    if level == 3:
        return pattern
    return NodePattern(pattern.label) if level == 1 else pattern._replace(ingredients=(), contents=())


def network_at_level(network: Network, level: int) -> Network:
    """Return a network of level 3 reduced to a level; units that are then equal are merged.

    Nodes and units have new ids; ``detailed``, ``stands_for`` and ``objects_stand_for`` lead to the old ones.
    A merged unit has the sources of all its units. At level 3, the network itself is returned.

    Raises :class:`ValueError` if the network is not of level 3, or if there is no such level.
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
