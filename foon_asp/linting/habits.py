"""The changes of units, objects and contents that appear or vanish, and the habits of motions."""

from collections.abc import Collection, Iterator
from collections.abc import Set as AbstractSet
from functools import cached_property
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode

_STEM, _SHORTEST = 4, 3  # letters by which words count as one: wrapped, wrapping
_NO_NAMES: frozenset[str] = frozenset()


class Changes(NamedTuple):
    """The changes of a unit that may be slips: names by the node that shows them.

    ``lost`` and ``gained`` are contents of a container that keeps other contents; ``new`` outputs and
    ``gone`` inputs are mentioned on one side only.
    """

    lost: dict[int, list[str]]
    gained: dict[int, list[str]]
    new: list[int]
    gone: list[int]
    keeps: bool


def content_names(node: ObjectNode) -> AbstractSet[str]:
    """Return the names of the contents of a node."""
    return _NO_NAMES if not node.contents else {item for _, items in node.contents for item in items}


def mentioned(nodes: Collection[ObjectNode]) -> set[str]:
    """Return every name in nodes: labels, contents and related objects."""
    names = {node.label for node in nodes}
    names.update(related_object for node in nodes for _, related_object in node.relations)
    return names.union(*map(content_names, nodes))


class Habit(NamedTuple):
    """Counts of the units with a motion.

    ``units``: all of them.
    ``keep``: those with a container that keeps a part of its contents.
    ``lose``, ``gain``: those in which such a container also loses or gains contents.
    ``make``: those with outputs that come from no input.
    ``end``: those with inputs that are in no output.
    """

    units: int = 0
    keep: int = 0
    lose: int = 0
    gain: int = 0
    make: int = 0
    end: int = 0


class Habits:
    """The changes of the units of a network.

    ``ingredients`` are all names among contents; ``foods`` are the ingredients that are never a container or
    a place.
    """

    def __init__(self, network: Network) -> None:
        """Collect the names of all contents, and find the foods among them."""
        self.network = network
        objects = network.objects
        self.ingredients = {name for node in objects for name in content_names(node)}
        containers = {node.label for node in objects if node.contents}
        self.foods = (
            self.ingredients
            - containers
            - {related_object for node in objects for _, related_object in node.relations}
        )

    @cached_property
    def units(self) -> list[Changes]:
        """The changes of each unit."""
        return [self.changes(unit) for unit in range(len(self.network))]

    def changes(self, unit: int) -> Changes:
        """Return the changes that a unit makes to objects and contents."""
        objects = self.network.objects
        inputs = {node: objects[node] for node in self.network.inputs[unit]}
        outputs = {node: objects[node] for node in self.network.outputs[unit]}
        input_names, output_names = mentioned(inputs.values()), mentioned(outputs.values())
        emptied = {
            node.label
            for node in inputs.values()
            if content_names(node) and content_names(node) <= output_names
        }
        lost: dict[int, list[str]] = {}
        gained: dict[int, list[str]] = {}
        kept = list(_containers(inputs, outputs))
        for node, old_contents, new_contents in kept:
            missing = _sharing_no_word(
                old_contents - new_contents - output_names - emptied, new_contents - old_contents
            )
            added = _sharing_no_word(new_contents - old_contents - input_names, input_names)
            if missing and not added:
                lost[node] = missing
            elif added and not missing:
                gained[node] = added
        new = {
            node: object_node for node, object_node in outputs.items() if object_node.label not in input_names
        }
        gone = [
            node
            for node, object_node in inputs.items()
            if object_node.label in self.foods
            and object_node.label not in output_names
            and not _comes_from(object_node, input_names)
            and not _is_in_a_state(object_node.label, outputs.values())
        ]
        if gone or not new:
            return Changes(lost, gained, [], [] if new else gone, bool(kept))
        # a product is among contents, or shares a word or contents with an input
        products = {name for node in outputs.values() for name in content_names(node)}
        stems = words_in(input_names.union(*(node.states for node in inputs.values())))
        unrelated = [
            node
            for node, object_node in new.items()
            if object_node.label not in products
            and not _comes_from(object_node, input_names)
            and input_names.isdisjoint(content_names(object_node))
            and not any(
                word.startswith(stem[:_STEM])
                for word in words_in([object_node.label])
                for stem in stems
                if len(stem) >= _SHORTEST
            )
        ]
        return Changes(lost, gained, unrelated, [], bool(kept))

    def of_units(self) -> Iterator[tuple[str, Habit]]:
        """Yield for each unit its motion, and the habit counted from this unit alone."""
        for motion, changes in zip(self.network.motions, self.units, strict=True):
            changed = changes.keeps, changes.lost, changes.gained, changes.new, changes.gone
            yield motion, Habit(1, *(int(bool(names)) for names in changed))


def _comes_from(node: ObjectNode, places: AbstractSet[str]) -> bool:
    """Whether a state or relation of a node names a place that it comes from, as water from a tap."""
    origins = {state.removeprefix("from ") for state in node.states if state.startswith("from ")}
    return not places.isdisjoint(origins.union(origin for word, origin in node.relations if word == "from"))


def _is_in_a_state(name: str, nodes: Collection[ObjectNode]) -> bool:
    """Whether a state of a node shares its stem with a name, as salted with salt."""
    words = [word for node in nodes for state in node.states for word in state.split(" ")]
    return any(word.startswith(name_word[:_STEM]) for name_word in words_in([name]) for word in words)


def _containers(
    inputs: dict[int, ObjectNode], outputs: dict[int, ObjectNode]
) -> Iterator[tuple[int, AbstractSet[str], AbstractSet[str]]]:
    """Yield the outputs that keep some contents, with their old and their new contents."""
    for node, output in outputs.items():
        same_label = [other for other in inputs.values() if other.label == output.label]
        if len(same_label) == 1 and sum(other.label == output.label for other in outputs.values()) == 1:
            old_contents, new_contents = content_names(same_label[0]), content_names(output)
            if old_contents & new_contents:
                yield node, old_contents, new_contents


def _sharing_no_word(names: Collection[str], others: Collection[str]) -> list[str]:
    """Return the names that share no word with the others, sorted."""
    words = words_in(others)
    return sorted(name for name in names if words.isdisjoint(words_in([name])))


def words_in(names: Collection[str]) -> set[str]:
    """Return the words of names, in the singular."""
    return {word.removesuffix("s") for name in names for word in name.replace("-", " ").split(" ")}
