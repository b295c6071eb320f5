"""How objects come from unit to unit: chains that break, and what is left out of a unit."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.habits import held
from foon_asp.linting.linted_files import Copy
from foon_asp.linting.place_rules import misplaced_nodes, only_after, unheld_nodes
from foon_asp.linting.rule import WARNING, rule
from foon_asp.network import ObjectNode
from foon_asp.network.near_nodes import slip_between
from foon_asp.text.diagnostics import Diagnostic

_NEAR, _MIDDLE, _FAR = 2, 8, 25  # units between making and taking


class _Chain:
    """The units of one sheet, each where it first stands, and the places in their order of what makes nodes.

    ``makers`` and ``takers`` have the places of the units that make and take each node, in order.
    """

    def __init__(self, context: Context, copies: list[tuple[Copy, int]]) -> None:
        self.context = context
        self.network, self.objects = context.network, context.network.objects
        firsts: dict[int, Copy] = {}
        for copy, unit in copies:
            firsts.setdefault(unit, copy)
        self.units, self.copies = list(firsts), list(firsts.values())
        self.made: list[set[int]] = []
        self.makers: dict[int, list[int]] = {}
        self.takers: dict[int, list[int]] = {}
        for place, unit in enumerate(self.units):
            inputs = set(self.network.inputs[unit])
            self.made.append(set(self.network.outputs[unit]) - inputs)
            for node in self.made[place]:
                self.makers.setdefault(node, []).append(place)
            for node in inputs:
                self.takers.setdefault(node, []).append(place)

    def unmade(self) -> Iterator[tuple[int, int]]:
        """Yield each node that is taken and made by no unit, with the first place where it is taken."""
        return ((node, places[0]) for node, places in self.takers.items() if node not in self.makers)

    def finding(self, message: str, place: int, side: int, node: int) -> Diagnostic:
        """Return a finding about an input (0) or an output (1) of the unit at a place."""
        return self.context.at_node(self.copies[place], side, self.objects[node], message)

    def line(self, place: int, side: int, node: int) -> str:
        """Return the line of an input (0) or an output (1) of the unit at a place, as messages name it."""
        copy = self.copies[place]
        sheet = self.context.sheets[copy.sheet]
        return sheet.where(self.context.node_line(copy, side, self.objects[node]), sheet)

    def nearest(self, node: int, taker: int) -> tuple[int, int] | None:
        """Return the place where what an unmade node may be meant to be is made, and the node made there."""
        taken = self.objects[node]
        for between in range(1, min(taker, _FAR) + 1):
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

    def labels(self, place: int, side: int) -> set[str]:
        """Return the labels of the inputs (0) or outputs (1) of the unit at a place."""
        sides = self.network.inputs, self.network.outputs
        return {self.objects[node].label for node in sides[side][self.units[place]]}


def _chains(context: Context) -> Iterator[_Chain]:
    return (_Chain(context, copies) for copies in context.files.copies_by_sheet if copies)


@rule("broken-chain", WARNING, "an object that is taken, and made a little different")
def broken_chain(context: Context) -> Iterator[Diagnostic]:
    """An object that no unit makes is taken, and a unit before it makes one that differs in a little.

    Usually no unit takes that one: a state, a place or an ingredient is missing in one of the two, or spelt
    differently. No task tree can go through here. Both ends are reported. Only units near each other in one
    file are compared.
    """
    for chain in _chains(context):
        for node, taker in chain.unmade():
            if not (near := chain.nearest(node, taker)):
                continue
            maker, other = near
            here, there = (str(chain.objects[each]) for each in (node, other))
            message = f"no unit makes {here!r}; is it {there!r}, which {chain.line(maker, 1, other)} makes?"
            yield chain.finding(message, taker, 0, node)
            if other not in chain.takers:
                message = (
                    f"no unit takes {there!r}; is it {here!r}, which {chain.line(taker, 0, node)} takes?"
                )
                yield chain.finding(message, maker, 1, other)


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


@rule(
    "left-out",
    WARNING,
    "a unit that has something and not the container that it is in, or the other way round",
)
def left_out(context: Context) -> Iterator[Diagnostic]:
    """A unit makes a container with an object in it, but not the object, or the other way round.

    A later unit takes both, and no unit makes what is missing. Or an input is in or on something that is an
    output of the unit and no input: what was scraped from the board leaves it behind, so the board was there
    before.
    """
    for chain in _chains(context):
        for node, taker in chain.unmade():
            if (place := _maker_without(chain, node, taker)) and not chain.nearest(node, taker):
                maker, beside = place
                made, lacking = (str(chain.objects[each]) for each in (beside, node))
                message = (
                    f"{context.network.motions[chain.units[maker]]!r} makes {made!r}, and not {lacking!r}, "
                    f"which {chain.line(taker, 0, node)} takes with it and no unit makes; is it left out "
                    "here?"
                )
                yield chain.finding(message, maker, 1, beside)
    labels = {node.label for node in context.network.objects}
    for side in context.sides():
        places = [] if side.number else list(only_after(side))
        if places:
            told = [*unheld_nodes(side, context.habits), *misplaced_nodes(side, labels, context.habits)]
            others = {input_ for input_, _ in told}
            copy, motion = context.files.copies[side.unit][0], context.network.motions[side.unit]
            for input_, message in places:
                if input_ not in others:
                    text = f"{message} of {motion!r} have, and the inputs have not"
                    yield context.at_node(copy, 0, input_, text)


def _maker_without(chain: _Chain, node: int, taker: int) -> tuple[int, int] | None:
    """Return the place that makes a container with an unmade node in it and not the node, and the container.

    Or that makes something in the node, and not the node, which is its container.
    """
    taken = chain.objects[node]
    for beside in chain.network.inputs[chain.units[taker]]:
        other = chain.objects[beside]
        inside = taken.label in held(other) and any(place == other.label for _, place in taken.relations)
        around = other.label in held(taken) and any(place == taken.label for _, place in other.relations)
        earlier = [place for place in chain.makers.get(beside, ()) if place < taker]
        if not (inside or around) or not earlier or taker - earlier[-1] > _FAR:
            continue
        before, after = (chain.labels(earlier[-1], side) for side in (0, 1))
        if taken.label not in after and (around or taken.label in before):
            return earlier[-1], beside
    return None
