"""The units of one file in order, and how objects come from one to the other."""

from collections.abc import Iterator

from foon_asp.linting.habits import held
from foon_asp.linting.linted_files import Copy
from foon_asp.network import Network, ObjectNode
from foon_asp.network.near_nodes import slip_between

_NEAR, _MIDDLE, FAR = 2, 8, 25  # units between making and taking


class Chain:
    """The units of one sheet, each where it first stands; their places are those in this order.

    ``makers`` and ``takers`` have the places of the units that make and take each node, in order.
    """

    def __init__(self, network: Network, copies: list[tuple[Copy, int]]) -> None:
        self.network, self.objects = network, network.objects
        firsts: dict[int, Copy] = {}
        for copy, unit in copies:
            firsts.setdefault(unit, copy)
        self.units, self.copies = list(firsts), list(firsts.values())
        self.made: list[set[int]] = []
        self.makers: dict[int, list[int]] = {}
        self.takers: dict[int, list[int]] = {}
        for place, unit in enumerate(self.units):
            inputs = set(network.inputs[unit])
            self.made.append(set(network.outputs[unit]) - inputs)
            for node in self.made[place]:
                self.makers.setdefault(node, []).append(place)
            for node in inputs:
                self.takers.setdefault(node, []).append(place)

    def unmade(self) -> Iterator[tuple[int, int]]:
        """Yield each node that is taken and made by no unit, with the first place where it is taken."""
        return ((node, places[0]) for node, places in self.takers.items() if node not in self.makers)

    def labels(self, place: int, side: int) -> set[str]:
        """Return the labels of the inputs (0) or outputs (1) of the unit at a place."""
        sides = self.network.inputs, self.network.outputs
        return {self.objects[node].label for node in sides[side][self.units[place]]}

    def nearest(self, node: int, taker: int) -> tuple[int, int] | None:
        """Return the place where what an unmade node may be meant to be is made, and the node made there."""
        taken = self.objects[node]
        for between in range(1, min(taker, FAR) + 1):
            maker = taker - between
            near = [
                other
                for other in self.made[maker]
                if (other not in self.takers and self._may_be_one(node, taker, other, maker))
                or (between <= _MIDDLE and _lacks_a_state(taken, self.objects[other]))
            ]
            if near:
                return maker, min(near)
        return None

    def _may_be_one(self, node: int, taker: int, other: int, maker: int) -> bool:
        """Whether a node that is taken may be meant to be one that is made; not where each has its place."""
        taken, made = self.objects[node], self.objects[other]
        return _differ_little(taken, made, taker - maker) and (
            taken.relations == made.relations
            or len(taken.relations) != len(made.relations)
            or slip_between(taken, made) is not None
            or not self._has_place(taken, taker, 0)
            or not self._has_place(made, maker, 1)
        )

    def _has_place(self, node: ObjectNode, place: int, side: int) -> bool:
        """Whether everything that a node is in or on is on that side of the unit, too."""
        return self.labels(place, side).issuperset(related for _, related in node.relations)


def _differ_little(taken: ObjectNode, made: ObjectNode, between: int) -> bool:
    """Whether two nodes, so many units apart, differ in so little that they may be meant to be the same."""
    if taken.label != made.label:
        return between <= _NEAR and _parts(taken) > 1 and taken[1:] == made[1:]
    if slip_between(taken, made):
        return True
    states, relations = taken.states ^ made.states, taken.relations ^ made.relations
    differ = taken.contents != made.contents
    if bool(states) + bool(relations) + differ > 1:
        return False
    if differ:
        return len(held(taken) ^ held(made)) == 1 and min(len(held(taken)), len(held(made))) > 1
    if len(states) + len(relations) == 2:  # one in place of another
        return between <= _MIDDLE and _parts(taken) > 1 and _parts(taken) == _parts(made)
    # what lies about is taken again and again: sugar, after the sugar before is in the bowl
    moved = between <= _NEAR or bool(taken.relations or taken.contents)
    return len(states) == 1 or (len(relations) == 1 and moved)


def _lacks_a_state(taken: ObjectNode, made: ObjectNode) -> bool:
    """Whether a node is one that was made, without one of its states."""
    rest = taken.relations, taken.contents
    same = taken.label == made.label and any(rest) and rest == (made.relations, made.contents)
    return same and taken.states < made.states and len(made.states - taken.states) == 1


def _parts(node: ObjectNode) -> int:
    return len(node.states) + len(node.relations) + len(node.contents)
