"""What there is to say of how objects come from unit to unit: chains that break, sides that are swapped."""

from collections.abc import Iterator

from foon_asp.linting.habits import held
from foon_asp.linting.names import Names
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Network, ObjectNode
from foon_asp.network.near_nodes import slip_between
from foon_asp.text.diagnostics import Diagnostic

_NEAR, _MIDDLE, _FAR = 2, 8, 25  # units between making and taking


class _Flow:
    """The units of one sheet in order, and where each object node is made and taken."""

    def __init__(
        self, sheet: Sheet, network: Network, units: list[tuple[int, int]], ingredients: set[str]
    ) -> None:
        self.sheet = sheet
        self.network = network
        self.places = dict(reversed([(unit, at) for at, unit in units]))
        self.rank = {unit: rank for rank, unit in enumerate(dict.fromkeys(unit for _, unit in units))}
        self.ingredients = ingredients
        self.made: dict[int, list[int]] = {}
        self.taken: dict[int, list[int]] = {}
        for unit in self.places:
            inputs = set(network.inputs[unit])
            for node in set(network.outputs[unit]).difference(inputs):
                self.made.setdefault(node, []).append(unit)
            for node in inputs:
                self.taken.setdefault(node, []).append(unit)
        for units_of in (*self.made.values(), *self.taken.values()):
            units_of.sort(key=self.places.__getitem__)

    def finding(self, code: str, message: str, unit: int, node: int) -> Diagnostic:
        index = self.sheet.line_of(self.network.objects[node], self.places[unit])
        return self.sheet.finding(code, message, index, self.network.objects[node].label)

    def maker(self, node: int, before: int) -> int | None:
        """Give the last unit before another one that makes a node."""
        earlier = [unit for unit in self.made.get(node, ()) if self.rank[unit] < self.rank[before]]
        return earlier[-1] if earlier else None

    def is_told_apart(self, node: int) -> bool:
        """Whether a node is more than a tool in some state, of which there are many."""
        found = self.network.objects[node]
        return bool(found.relations or found.contents) or found.label in self.ingredients

    def has_place(self, node: int, unit: int, side: int) -> bool:
        """Whether everything that a node is in or on is on that side of the unit, too."""
        objects = self.network.objects
        labels = {objects[other].label for other in self.sides(unit)[side]}
        return labels.issuperset(place for _, place in objects[node].relations)

    def sides(self, unit: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Give the inputs and the outputs of a unit."""
        return self.network.inputs[unit], self.network.outputs[unit]

    def line(self, unit: int, node: int) -> str:
        """Name the line of a node in a unit."""
        index = self.sheet.line_of(self.network.objects[node], self.places[unit])
        return self.sheet.where(index, self.sheet)


def flow_findings(names: Names) -> Iterator[Diagnostic]:
    """Give the findings about each network by itself, in linear time: only what is near is compared."""
    files, ingredients = names.files, names.habits.ingredients
    by_sheet: dict[int, list[tuple[int, int]]] = {}
    for unit, copies in enumerate(files.copies):
        for copy in copies:
            by_sheet.setdefault(copy.sheet, []).append((copy.at, unit))
    for number, units in by_sheet.items():
        flow = _Flow(files.sheets[number], files.network, sorted(units), ingredients)
        yield from _broken(flow)
        yield from _swapped(flow)


def _broken(flow: _Flow) -> Iterator[Diagnostic]:
    """Give the findings where what is taken is not what was made before, but nearly."""
    objects = flow.network.objects
    units = list(flow.rank)
    made = [set(flow.network.outputs[unit]).difference(flow.network.inputs[unit]) for unit in units]
    for node, takers in flow.taken.items():
        if node in flow.made:
            continue
        taker, taken = takers[0], objects[node]
        rank = flow.rank[taker]
        near = [
            (between, other, units[rank - between])
            for between in range(1, min(rank, _FAR) + 1)
            for other in made[rank - between]
            if (
                other not in flow.taken
                and _may_be_one(taken, objects[other], between)
                and (
                    taken.relations == objects[other].relations
                    or len(taken.relations) != len(objects[other].relations)
                    or slip_between(taken, objects[other])
                    or not flow.has_place(node, taker, 0)
                    or not flow.has_place(other, units[rank - between], 1)
                )
            )
            or (between <= _MIDDLE and _lacks_a_state(taken, objects[other]))
        ]
        if not near:
            yield from _left_out(flow, node, taker)
            continue
        _, other, maker = min(near)
        here, there = str(taken), str(objects[other])
        message = f"no unit makes {here!r}; is it {there!r}, which {flow.line(maker, other)} makes?"
        yield flow.finding("broken-chain", message, taker, node)
        if other not in flow.taken:
            message = f"no unit takes {there!r}; is it {here!r}, which {flow.line(taker, node)} takes?"
            yield flow.finding("broken-chain", message, maker, other)


def _may_be_one(taken: ObjectNode, made: ObjectNode, between: int) -> bool:
    """Whether two nodes differ in so little that they may be meant to be the same."""
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


def _left_out(flow: _Flow, node: int, taker: int) -> Iterator[Diagnostic]:
    """Give the unit that makes a container with something in it, but not that, which is taken later.

    Or that makes something in a container, but not the container.
    """
    objects = flow.network.objects
    taken = objects[node]
    for beside in flow.network.inputs[taker]:
        other = objects[beside]
        inside = taken.label in held(other) and any(place == other.label for _, place in taken.relations)
        around = other.label in held(taken) and any(place == taken.label for _, place in other.relations)
        maker = flow.maker(beside, taker) if inside or around else None
        if maker is None or flow.rank[taker] - flow.rank[maker] > _FAR:
            continue
        before, after = ({objects[o].label for o in side} for side in flow.sides(maker))
        if taken.label not in after and (around or taken.label in before):
            message = (
                f"{flow.network.motions[maker]!r} makes {str(other)!r}, and not {str(taken)!r}, which "
                f"{flow.line(taker, node)} takes with it and no unit makes; is it left out here?"
            )
            yield flow.finding("left-out", message, maker, beside)
            return


def _swapped(flow: _Flow) -> Iterator[Diagnostic]:
    """Give the units that other units would go together with if their inputs were their outputs."""
    network = flow.network

    def others(units: dict[int, list[int]], node: int, unit: int) -> bool:
        return any(other != unit for other in units.get(node, ()))

    for unit, at in flow.places.items():
        inputs = {node for node in network.inputs[unit] if flow.is_told_apart(node)}
        outputs = {node for node in network.outputs[unit] if flow.is_told_apart(node)}
        inputs, outputs = inputs - outputs, outputs - inputs
        if any(others(flow.made, node, unit) for node in inputs):
            continue
        if any(others(flow.taken, node, unit) for node in outputs):
            continue
        back = [node for node in inputs if others(flow.taken, node, unit)]
        back_too = [node for node in outputs if others(flow.made, node, unit)]
        if outputs and back and (back_too or len(back) == len(inputs) > 1):
            message = (
                f"no unit makes what {network.motions[unit]!r} takes, and none takes what it makes; other "
                f"units would, the other way round: are inputs and outputs swapped?"
            )
            yield flow.sheet.finding("swapped-sides", message, at)
