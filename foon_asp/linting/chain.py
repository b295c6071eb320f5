"""Chains: the units of one file in order, with the units that make and need each object node."""

from collections.abc import Iterator

from foon_asp.linting.habits import content_names
from foon_asp.linting.linted_files import Copy
from foon_asp.network import Network, ObjectNode
from foon_asp.network.near_nodes import slip_between

_SHORT_DISTANCE, _MIDDLE_DISTANCE, MAX_DISTANCE = 2, 8, 25  # units from making to taking


class Chain:
    """The units of one sheet in order of their first copies; a position is an index in this order.

    ``producers`` and ``consumers`` have by node the positions of the units that make it and that need it,
    in order. ``made`` has by position the nodes that a unit makes.
    """

    def __init__(self, network: Network, copies: list[tuple[Copy, int]]) -> None:
        """Index the units by the nodes that they make and need; ``copies`` are in the order of the sheet."""
        self.network, self.objects = network, network.objects
        firsts: dict[int, Copy] = {}
        for copy, unit in copies:
            firsts.setdefault(unit, copy)
        self.units, self.copies = list(firsts), list(firsts.values())
        self.made: list[set[int]] = []
        self.producers: dict[int, list[int]] = {}
        self.consumers: dict[int, list[int]] = {}
        for position, unit in enumerate(self.units):
            inputs = set(network.inputs[unit])
            self.made.append(set(network.outputs[unit]) - inputs)
            for node in self.made[position]:
                self.producers.setdefault(node, []).append(position)
            for node in inputs:
                self.consumers.setdefault(node, []).append(position)

    def unmade(self) -> Iterator[tuple[int, int]]:
        """Yield each needed node that no unit makes, with the position of its first consumer."""
        return (
            (node, positions[0]) for node, positions in self.consumers.items() if node not in self.producers
        )

    def labels(self, position: int, side: int) -> set[str]:
        """Return the labels of the inputs (0) or outputs (1) of the unit at a position."""
        nodes_by_side = self.network.inputs, self.network.outputs
        return {self.objects[node].label for node in nodes_by_side[side][self.units[position]]}

    def nearest(self, node: int, consumer: int) -> tuple[int, int] | None:
        """Return the last unit before ``consumer`` that makes a node similar to a needed node, and that node.

        Units are positions in the chain. ``None`` if no unit makes a similar node that may be meant.
        """
        wanted = self.objects[node]
        for distance in range(1, min(consumer, MAX_DISTANCE) + 1):
            producer = consumer - distance
            candidates = [
                other
                for other in self.made[producer]
                if (other not in self.consumers and self._may_be_one(node, consumer, other, producer))
                or (distance <= _MIDDLE_DISTANCE and _lacks_a_state(wanted, self.objects[other]))
            ]
            if candidates:
                return producer, min(candidates)
        return None

    def _may_be_one(self, node: int, consumer: int, other: int, producer: int) -> bool:
        """Whether a needed and a made node may be meant to be one node.

        ``consumer`` and ``producer`` are the positions of the units. False if the nodes differ in more than a
        little, or are in different places that both units list.
        """
        needed, made = self.objects[node], self.objects[other]
        return _differ_little(needed, made, consumer - producer) and (
            needed.relations == made.relations
            or len(needed.relations) != len(made.relations)
            or slip_between(needed, made) is not None
            or not self._locations_listed(needed, consumer, 0)
            or not self._locations_listed(made, producer, 1)
        )

    def _locations_listed(self, node: ObjectNode, position: int, side: int) -> bool:
        """Whether a side of a unit also lists all objects that a node is in or on."""
        return self.labels(position, side).issuperset(related for _, related in node.relations)


def _differ_little(needed: ObjectNode, made: ObjectNode, distance: int) -> bool:
    """Whether two nodes differ so little that they may be meant to be one; ``distance`` is in units."""
    if needed.label != made.label:
        return distance <= _SHORT_DISTANCE and _parts(needed) > 1 and needed[1:] == made[1:]
    if slip_between(needed, made):
        return True
    states, relations = needed.states ^ made.states, needed.relations ^ made.relations
    contents_differ = needed.contents != made.contents
    if bool(states) + bool(relations) + contents_differ > 1:
        return False
    if contents_differ:
        return (
            len(content_names(needed) ^ content_names(made)) == 1
            and min(len(content_names(needed)), len(content_names(made))) > 1
        )
    if len(states) + len(relations) == 2:  # one replaced by another
        return distance <= _MIDDLE_DISTANCE and _parts(needed) > 1 and _parts(needed) == _parts(made)
    # raw items are taken repeatedly: sugar, after other sugar was put into the bowl
    moved = distance <= _SHORT_DISTANCE or bool(needed.relations or needed.contents)
    return len(states) == 1 or (len(relations) == 1 and moved)


def _lacks_a_state(needed: ObjectNode, made: ObjectNode) -> bool:
    """Whether the needed node is the made node without one of its states."""
    other_parts = needed.relations, needed.contents
    same = needed.label == made.label and any(other_parts) and other_parts == (made.relations, made.contents)
    return same and needed.states < made.states and len(made.states - needed.states) == 1


def _parts(node: ObjectNode) -> int:
    return len(node.states) + len(node.relations) + len(node.contents)
