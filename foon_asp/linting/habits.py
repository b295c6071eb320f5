"""What units do with objects: which come from nothing, vanish, or are no more among the contents."""

from collections.abc import Collection, Iterator
from collections.abc import Set as AbstractSet
from functools import cached_property
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode

_STEM, _SHORTEST = 4, 3  # letters by which words are taken for one: wrapped, wrapping
_NOTHING: frozenset[str] = frozenset()


class Changes(NamedTuple):
    """What a unit changes beyond its nodes, where a slip may be: names by the node in which they are seen.

    ``lost`` were in a container that keeps other contents, ``gained`` are in one that had other contents;
    ``new`` outputs and ``gone`` inputs are mentioned on one side alone.
    """

    lost: dict[int, list[str]]
    gained: dict[int, list[str]]
    new: list[int]
    gone: list[int]
    keeps: bool


def held(node: ObjectNode) -> AbstractSet[str]:
    """Give the names of what a node contains."""
    return _NOTHING if not node.contents else {item for _, items in node.contents for item in items}


def mentioned(nodes: Collection[ObjectNode]) -> set[str]:
    """Give every name in nodes: labels, contents and places."""
    names = {node.label for node in nodes}
    names.update(place for node in nodes for _, place in node.relations)
    return names.union(*map(held, nodes))


class Habit(NamedTuple):
    """Of the units with a motion: how many there are, how many keep contents, and how many change what."""

    units: int = 0
    keep: int = 0
    lose: int = 0
    gain: int = 0
    make: int = 0
    end: int = 0


class Habits:
    """Looks at the units of a network one by one."""

    def __init__(self, network: Network) -> None:
        self.network = network
        objects = network.objects
        self.ingredients = {name for node in objects for name in held(node)}
        self.holders = {node.label for node in objects if node.contents}
        self.holders.update(place for node in objects for _, place in node.relations)
        self.foods = self.ingredients - self.holders

    @cached_property
    def units(self) -> list[Changes]:
        """What each unit changes."""
        return [self.changes(unit) for unit in range(len(self.network))]

    def changes(self, unit: int) -> Changes:
        """Say what a unit changes."""
        objects = self.network.objects
        inputs = {node: objects[node] for node in self.network.inputs[unit]}
        outputs = {node: objects[node] for node in self.network.outputs[unit]}
        before, after = mentioned(inputs.values()), mentioned(outputs.values())
        new = [node for node, found in outputs.items() if found.label not in before]
        gone = [
            node
            for node, found in inputs.items()
            if found.label in self.foods
            and found.label not in after
            and not _comes_from(found, before)
            and not _is_said(found.label, outputs.values())
        ]
        lost: dict[int, list[str]] = {}
        gained: dict[int, list[str]] = {}
        keeps = False
        for node, had, has in _containers(inputs, outputs):
            keeps = True
            missing = sorted(
                name
                for name in had - has - after
                if words_in([name]).isdisjoint(words_in(has - had))
                and not any(
                    node.label == name and held(node) and held(node) <= after for node in inputs.values()
                )
            )
            known = words_in(before)
            more = sorted(name for name in has - had - before if known.isdisjoint(words_in([name])))
            if missing and not more:
                lost[node] = missing
            elif more and not missing:
                gained[node] = more
        if gone or not new:
            return Changes(lost, gained, [], [] if new else gone, keeps)
        known = words_in(before.union(*(node.states for node in inputs.values())))
        # a product stands in something, or something of its name or in it was there
        products = {name for node in outputs.values() for name in held(node)}
        fresh = [
            node
            for node in new
            if outputs[node].label not in products
            and not _comes_from(outputs[node], before)
            and not any(
                word.startswith(other[:_STEM])
                for word in words_in([outputs[node].label])
                for other in known
                if len(other) >= _SHORTEST
            )
            and before.isdisjoint(held(outputs[node]))
        ]
        return Changes(lost, gained, fresh, [], keeps)

    def of_units(self) -> Iterator[tuple[str, Habit]]:
        """Yield the motion of each unit, and what the unit does."""
        for motion, seen in zip(self.network.motions, self.units, strict=True):
            changed = seen.keeps, seen.lost, seen.gained, seen.new, seen.gone
            yield motion, Habit(1, *(int(bool(each)) for each in changed))


def _comes_from(node: ObjectNode, places: AbstractSet[str]) -> bool:
    """Whether a node is said to be from something that is there: water from a tap."""
    written = {state.removeprefix("from ") for state in node.states if state.startswith("from ")}
    return not places.isdisjoint(written.union(place for word, place in node.relations if word == "from"))


def _is_said(name: str, nodes: Collection[ObjectNode]) -> bool:
    """Whether a state of a node says where something is, as salted does of salt."""
    words = [word for node in nodes for state in node.states for word in state.split(" ")]
    return any(word.startswith(part[:_STEM]) for part in words_in([name]) for word in words)


def _containers(
    inputs: dict[int, ObjectNode], outputs: dict[int, ObjectNode]
) -> Iterator[tuple[int, AbstractSet[str], AbstractSet[str]]]:
    """Give the outputs that keep some contents, with what they had and what they have."""
    for node, after in outputs.items():
        befores = [other for other in inputs.values() if other.label == after.label]
        if len(befores) == 1 and sum(other.label == after.label for other in outputs.values()) == 1:
            had, has = held(befores[0]), held(after)
            if had & has:
                yield node, had, has


def words_in(names: Collection[str]) -> set[str]:
    """Give the words of names, in the singular."""
    return {word.removesuffix("s") for name in names for word in name.replace("-", " ").split(" ")}
