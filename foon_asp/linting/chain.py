"""Chains: the units of one file in order, with the producers and consumers of each object node."""

from collections.abc import Iterator

from foon_asp.linting.habits import content_names
from foon_asp.linting.linted_files import Copy
from foon_asp.network import Network, ObjectNode
from foon_asp.network.slip import slip_between

_SHORT_DISTANCE, _MIDDLE_DISTANCE, MAX_DISTANCE = 2, 8, 25  # units from making to taking


class Chain:
    """The units of one sheet, ordered by their first copies in it.

    A position is the index of a unit in this order, from 0.

    ``units``: by position, the id of the unit in the network.
    ``copies``: by position, the first copy of the unit.
    ``made``: by position, the ids of the nodes that the unit makes: its outputs that are not inputs.
    ``producers``: by node id, the positions of the units that make the node, ascending.
    ``consumers``: by node id, the positions of the units that need the node, ascending.
    """

    def __init__(self, network: Network, copies: list[tuple[Copy, int]]) -> None:
        """Index the units by the nodes that they make and need.

        ``copies`` are the copies of units in the order of the sheet, each with the id of its unit.
        """
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

    def unmade_nodes(self) -> Iterator[tuple[int, int]]:
        """Yield the id of each needed node that no unit makes, with the position of its first consumer."""
        return (
            (node, positions[0]) for node, positions in self.consumers.items() if node not in self.producers
        )

    def side_labels(self, position: int, side: int) -> set[str]:
        """Return the labels of the inputs (``side`` 0) or outputs (1) of the unit at a position."""
        nodes_by_side = self.network.inputs, self.network.outputs
        return {self.objects[node].label for node in nodes_by_side[side][self.units[position]]}

    def nearest_similar(self, node: int, consumer: int) -> tuple[int, int] | None:
        """Return the position of the nearest unit that makes a node similar to ``node``, and that node's id.

        ``node`` is the id of a node that the unit at the position ``consumer`` needs. A made node is similar
        if it differs little from ``node`` and no unit needs it. A node made up to 8 units back is also
        similar if it is ``node`` with one more state. Only the 25 units before ``consumer`` are searched. If
        a unit makes several similar nodes, the one with the least id is returned. Return ``None`` if no unit
        makes a similar node.
        """
        wanted = self.objects[node]
        for distance in range(1, min(consumer, MAX_DISTANCE) + 1):
            producer = consumer - distance
            candidates = [
                other
                for other in self.made[producer]
                if (other not in self.consumers and self._may_be_same(node, consumer, other, producer))
                or (distance <= _MIDDLE_DISTANCE and _lacks_a_state(wanted, self.objects[other]))
            ]
            if candidates:
                return producer, min(candidates)
        return None

    def _may_be_same(self, node: int, consumer: int, other: int, producer: int) -> bool:
        """Whether the needed ``node`` and the made node ``other`` are probably meant to be one node.

        ``consumer`` and ``producer`` are the positions of the units. The nodes have to differ little. Two
        nodes in different places are not one node if each unit lists the places of its node. Places that
        differ by a slip of spelling do not count as different.
        """
        needed, made = self.objects[node], self.objects[other]
        return _differ_little(needed, made, consumer - producer) and (
            needed.relations == made.relations
            or len(needed.relations) != len(made.relations)
            or slip_between(needed, made) is not None
            or not self._lists_locations_of(needed, consumer, 0)
            or not self._lists_locations_of(made, producer, 1)
        )

    def _lists_locations_of(self, node: ObjectNode, position: int, side: int) -> bool:
        """Whether a side of a unit also lists all objects to which a node has a relation.

        The unit is the one at a position; ``side`` is 0 for inputs and 1 for outputs.
        """
        return self.side_labels(position, side).issuperset(related for _, related in node.relations)


def _differ_little(needed: ObjectNode, made: ObjectNode, distance: int) -> bool:
    """Whether two nodes differ so little that they may be meant to be one, for example in one state.

    ``distance`` is the number of units from the one that makes ``made`` to the one that needs ``needed``. The
    nodes may differ in one way:

    - in a slip of spelling, in one state, or in one of several ingredients;
    - in one relation, if ``needed`` has a relation or contents, or if the distance is at most 2;
    - in one state or relation in place of another, if they have several attributes and the distance is at
      most 8;
    - in their labels alone, if they have several attributes and the distance is at most 2.
    """
    if needed.label != made.label:
        return distance <= _SHORT_DISTANCE and _count_attributes(needed) > 1 and needed[1:] == made[1:]
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
        return (
            distance <= _MIDDLE_DISTANCE
            and _count_attributes(needed) > 1
            and _count_attributes(needed) == _count_attributes(made)
        )
    # raw items are taken repeatedly: sugar, after other sugar was put into the bowl
    moved = distance <= _SHORT_DISTANCE or bool(needed.relations or needed.contents)
    return len(states) == 1 or (len(relations) == 1 and moved)


def _lacks_a_state(needed: ObjectNode, made: ObjectNode) -> bool:
    """Whether the needed node is the made node without one of its states.

    False for nodes that have neither relations nor contents.
    """
    other_parts = needed.relations, needed.contents
    is_alike = (
        needed.label == made.label and any(other_parts) and other_parts == (made.relations, made.contents)
    )
    return is_alike and needed.states < made.states and len(made.states - needed.states) == 1


def _count_attributes(node: ObjectNode) -> int:
    """Return the number of states, relations and contents of a node."""
    return len(node.states) + len(node.relations) + len(node.contents)
