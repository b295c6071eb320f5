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
    """Return the names of what a node contains."""
    return _NOTHING if not node.contents else {item for _, items in node.contents for item in items}


def mentioned(nodes: Collection[ObjectNode]) -> set[str]:
    """Return every name in nodes: labels, contents and places."""
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
    """What the units of a network change.

    ``foods`` are the names of what is among contents, and never a container or a place.
    """

    def __init__(self, network: Network) -> None:
        self.network = network
        objects = network.objects
        self.ingredients = {name for node in objects for name in held(node)}
        holders = {node.label for node in objects if node.contents}
        self.foods = self.ingredients - holders - {place for node in objects for _, place in node.relations}

    @cached_property
    def units(self) -> list[Changes]:
        """What each unit changes."""
        return [self.changes(unit) for unit in range(len(self.network))]

    def changes(self, unit: int) -> Changes:
        """Return what a unit changes."""
        objects = self.network.objects
        inputs = {node: objects[node] for node in self.network.inputs[unit]}
        outputs = {node: objects[node] for node in self.network.outputs[unit]}
        before, after = mentioned(inputs.values()), mentioned(outputs.values())
        emptied = {node.label for node in inputs.values() if held(node) and held(node) <= after}
        lost: dict[int, list[str]] = {}
        gained: dict[int, list[str]] = {}
        kept = list(_containers(inputs, outputs))
        for node, had, has in kept:
            missing = _unlike(had - has - after - emptied, has - had)
            added = _unlike(has - had - before, before)
            if missing and not added:
                lost[node] = missing
            elif added and not missing:
                gained[node] = added
        new = {node: found for node, found in outputs.items() if found.label not in before}
        gone = [
            node
            for node, found in inputs.items()
            if found.label in self.foods
            and found.label not in after
            and not _comes_from(found, before)
            and not _is_said(found.label, outputs.values())
        ]
        if gone or not new:
            return Changes(lost, gained, [], [] if new else gone, bool(kept))
        # a product stands in something, or something of its name or in it was there
        products = {name for node in outputs.values() for name in held(node)}
        stems = words_in(before.union(*(node.states for node in inputs.values())))
        fresh = [
            node
            for node, found in new.items()
            if found.label not in products
            and not _comes_from(found, before)
            and before.isdisjoint(held(found))
            and not any(
                word.startswith(stem[:_STEM])
                for word in words_in([found.label])
                for stem in stems
                if len(stem) >= _SHORTEST
            )
        ]
        return Changes(lost, gained, fresh, [], bool(kept))

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
    """Yield the outputs that keep some contents, with what they had and what they have."""
    for node, after in outputs.items():
        befores = [other for other in inputs.values() if other.label == after.label]
        if len(befores) == 1 and sum(other.label == after.label for other in outputs.values()) == 1:
            had, has = held(befores[0]), held(after)
            if had & has:
                yield node, had, has


def _unlike(names: Collection[str], others: Collection[str]) -> list[str]:
    """Return the names that have no word of the others, sorted."""
    words = words_in(others)
    return sorted(name for name in names if words.isdisjoint(words_in([name])))


def words_in(names: Collection[str]) -> set[str]:
    """Return the words of names, in the singular."""
    return {word.removesuffix("s") for name in names for word in name.replace("-", " ").split(" ")}
