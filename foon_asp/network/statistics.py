"""Statistics of a network: sizes, degrees, cycles, layers and connected components."""

import statistics
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from foon_asp.network.graph import UNREACHED, component_sizes, cycles, layers
from foon_asp.network.network import Network
from foon_asp.network.starting_kitchen import starting_kitchen

MANY = 4  # units that make a node; nodes with as many or more are counted together


@dataclass(frozen=True)
class Statistics:
    """The counts of a network at one level; every mean is over units.

    ``labels``, ``motions``, ``states``, ``relations`` and ``contents`` are numbers of different ones.
    ``producers[n]`` is the number of object nodes that exactly ``n`` units make; its last entry counts the
    nodes that ``MANY`` or more units make. ``most_producers`` is the greatest number of units that make one
    node. ``unused`` counts the object nodes that no unit needs, and ``unchanged`` the units whose inputs are
    their outputs.

    A cycle is a set of object nodes that need each other. ``in_cycles`` counts the nodes in all cycles,
    ``largest_cycle`` those in the largest one. ``at_hand`` counts the available nodes. ``depth`` is the
    highest layer reached from them, and ``median_depth`` the median layer of the units reached. ``parts``
    counts the connected components, and ``largest_part`` the units of the largest one.
    """

    level: int
    units: int
    objects: int
    labels: int
    motions: int
    states: int
    relations: int
    contents: int
    mean_inputs: float
    most_inputs: int
    mean_outputs: float
    most_outputs: int
    producers: tuple[int, ...]
    most_producers: int
    unused: int
    unchanged: int
    cycles: int
    in_cycles: int
    largest_cycle: int
    at_hand: int
    depth: int
    median_depth: float
    unreached_objects: int
    unreached_units: int
    parts: int
    largest_part: int


def network_statistics(network: Network, at_hand: Iterable[int] | None = None) -> Statistics:
    """Return the statistics of a network.

    ``at_hand`` has the ids of the available nodes; ``None`` for those of the starting kitchen.
    """
    if at_hand is None:
        at_hand = starting_kitchen(network).nodes
    start = list(at_hand)
    node_layer, unit_layer = layers(network, start)
    node_cycles = cycles(network)
    unit_counts = component_sizes(network)
    producers = [len(makers) for makers in network.producers]
    objects = network.objects
    inputs, outputs = (
        [len(nodes) for nodes in nodes_by_unit] for nodes_by_unit in (network.inputs, network.outputs)
    )
    reached = [layer for layer in unit_layer if layer != UNREACHED]
    return Statistics(
        level=network.level,
        units=len(network),
        objects=len(objects),
        labels=len(network.by_label),
        motions=len(set(network.motions)),
        states=len({state for node in objects for state in node.states}),
        relations=len({relation for node in objects for relation in node.relations}),
        contents=len({contents for node in objects for contents in node.contents}),
        mean_inputs=statistics.fmean(inputs) if inputs else 0.0,
        most_inputs=max(inputs, default=0),
        mean_outputs=statistics.fmean(outputs) if outputs else 0.0,
        most_outputs=max(outputs, default=0),
        producers=tuple(
            sum(1 for producer_count in producers if min(producer_count, MANY) == entry)
            for entry in range(MANY + 1)
        ),
        most_producers=max(producers, default=0),
        unused=sum(1 for users in network.consumers if not users),
        unchanged=sum(
            1 for i, o in zip(network.inputs, network.outputs, strict=True) if frozenset(i) == frozenset(o)
        ),
        cycles=len(node_cycles),
        in_cycles=sum(map(len, node_cycles)),
        largest_cycle=max(map(len, node_cycles), default=0),
        at_hand=len(start),
        depth=max(reached, default=0),
        median_depth=statistics.median(reached) if reached else 0.0,
        unreached_objects=node_layer.count(UNREACHED),
        unreached_units=unit_layer.count(UNREACHED),
        parts=len(unit_counts),
        largest_part=unit_counts[0] if unit_counts else 0,
    )


def most_connected_labels(network: Network, max_labels: int) -> list[tuple[str, int]]:
    """Return up to ``max_labels`` labels that the most units have, each with its number of units.

    A unit has the labels of its inputs and outputs. Labels with equal numbers are in alphabetical order.
    """
    unit_counts: Counter[str] = Counter()
    objects = network.objects
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        unit_counts.update({objects[node].label for node in (*inputs, *outputs)})
    return sorted(unit_counts.items(), key=lambda label: (-label[1], label[0]))[:max_labels]


def most_connected_objects(network: Network, max_nodes: int) -> list[tuple[int, int, int]]:
    """Return up to ``max_nodes`` object nodes that the most units need or make.

    Each entry is the id of a node, the number of units that need it, and the number of units that make it.
    Nodes that equally many units need or make are in order of id.
    """
    unit_counts = [
        (len({*consumers, *producers}), -node)
        for node, (consumers, producers) in enumerate(zip(network.consumers, network.producers, strict=True))
    ]
    top = (-node for _, node in sorted(unit_counts, reverse=True)[:max_nodes])
    return [(node, len(network.consumers[node]), len(network.producers[node])) for node in top]
