"""Changes of units: objects and contents that appear or vanish. Habits: how often units of a motion do so."""

from collections.abc import Collection, Iterator
from collections.abc import Set as AbstractSet
from functools import cached_property
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode

_STEM, _SHORTEST = 4, 3  # letters by which words count as one: wrapped, wrapping
_NO_NAMES: frozenset[str] = frozenset()


class Changes(NamedTuple):
    """The changes of a unit that may be slips. Nodes are given as ids.

    ``lost``: by container, the names of the contents that it loses. The container is an output that keeps
    other contents.
    ``gained``: by such a container, the names of the contents that it gains.
    ``new``: outputs that come from no input.
    ``gone``: inputs that are in no output.
    ``keeps``: whether a container keeps some of its contents.
    """

    lost: dict[int, list[str]]
    gained: dict[int, list[str]]
    new: list[int]
    gone: list[int]
    keeps: bool


def content_names(node: ObjectNode) -> AbstractSet[str]:
    """Return the names of all contents of a node; empty without contents."""
    return _NO_NAMES if not node.contents else {item for _, items in node.contents for item in items}


def mentioned_names(nodes: Collection[ObjectNode]) -> set[str]:
    """Return every name in nodes: their labels, contents and related objects."""
    names = {node.label for node in nodes}
    names.update(related_object for node in nodes for _, related_object in node.relations)
    return names.union(*map(content_names, nodes))


class Habit(NamedTuple):
    """How often units with one motion change something.

    ``units``: all units with the motion.
    ``keep``: units with a container that keeps some of its contents.
    ``lose``, ``gain``: units in which such a container also loses or gains contents.
    ``make``: units with outputs that come from no input.
    ``end``: units with inputs that are in no output.
    """

    units: int = 0
    keep: int = 0
    lose: int = 0
    gain: int = 0
    make: int = 0
    end: int = 0


class Habits:
    """The changes that each unit of a network makes, and which names are ingredients.

    ``ingredients``: all names that stand among contents.
    ``foods``: the ingredients that never have contents and to which no object has a relation.
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
    def changes_by_unit(self) -> list[Changes]:
        """The changes of each unit, by its id."""
        return [self.changes(unit) for unit in range(len(self.network))]

    def changes(self, unit: int) -> Changes:
        """Return the changes that a unit makes to objects and contents, as far as they may be slips.

        Names that share a word, such as egg and beaten egg, count as one object. Only inputs that are foods
        can be gone. If foods are gone and outputs are new, the foods became the outputs, and neither are
        listed. A container that both loses and gains contents is not listed either.
        """
        objects = self.network.objects
        inputs = {node: objects[node] for node in self.network.inputs[unit]}
        outputs = {node: objects[node] for node in self.network.outputs[unit]}
        input_names, output_names = mentioned_names(inputs.values()), mentioned_names(outputs.values())
        emptied = {
            node.label
            for node in inputs.values()
            if content_names(node) and content_names(node) <= output_names
        }
        lost: dict[int, list[str]] = {}
        gained: dict[int, list[str]] = {}
        kept = list(_kept_containers(inputs, outputs))
        for node, old_contents, new_contents in kept:
            missing = _names_sharing_no_word(
                old_contents - new_contents - output_names - emptied, new_contents - old_contents
            )
            added = _names_sharing_no_word(new_contents - old_contents - input_names, input_names)
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
            and not _comes_from_any(object_node, input_names)
            and not _is_named_by_state(object_node.label, outputs.values())
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
            and not _comes_from_any(object_node, input_names)
            and input_names.isdisjoint(content_names(object_node))
            and not any(
                word.startswith(stem[:_STEM])
                for word in words_in([object_node.label])
                for stem in stems
                if len(stem) >= _SHORTEST
            )
        ]
        return Changes(lost, gained, unrelated, [], bool(kept))

    def habits_of_units(self) -> Iterator[tuple[str, Habit]]:
        """Yield for each unit its motion, and a habit in which this unit alone is counted."""
        for motion, changes in zip(self.network.motions, self.changes_by_unit, strict=True):
            changed = changes.keeps, changes.lost, changes.gained, changes.new, changes.gone
            yield motion, Habit(1, *(int(bool(names)) for names in changed))


def _comes_from_any(node: ObjectNode, places: AbstractSet[str]) -> bool:
    """Whether a state or relation of a node says that it comes from one of ``places``: water from a tap."""
    origins = {state.removeprefix("from ") for state in node.states if state.startswith("from ")}
    return not places.isdisjoint(origins.union(origin for word, origin in node.relations if word == "from"))


def _is_named_by_state(name: str, nodes: Collection[ObjectNode]) -> bool:
    """Whether a word in a state of a node begins like a word of ``name``: salted for the name salt.

    The first four letters are compared.
    """
    words = [word for node in nodes for state in node.states for word in state.split(" ")]
    return any(word.startswith(name_word[:_STEM]) for name_word in words_in([name]) for word in words)


def _kept_containers(
    inputs: dict[int, ObjectNode], outputs: dict[int, ObjectNode]
) -> Iterator[tuple[int, AbstractSet[str], AbstractSet[str]]]:
    """Yield the id of each output that keeps some contents, with the names of its old and new contents.

    The old contents are those of the input with the same label. Outputs whose label is not unique among
    inputs, or among outputs, are skipped.
    """
    for node, output in outputs.items():
        same_label = [other for other in inputs.values() if other.label == output.label]
        if len(same_label) == 1 and sum(other.label == output.label for other in outputs.values()) == 1:
            old_contents, new_contents = content_names(same_label[0]), content_names(output)
            if old_contents & new_contents:
                yield node, old_contents, new_contents


def _names_sharing_no_word(names: Collection[str], others: Collection[str]) -> list[str]:
    """Return the names that share no word with any of ``others``, sorted."""
    words = words_in(others)
    return sorted(name for name in names if words.isdisjoint(words_in([name])))


def words_in(names: Collection[str]) -> set[str]:
    """Return all words of names, each without a final s; blanks and hyphens separate words."""
    return {word.removesuffix("s") for name in names for word in name.replace("-", " ").split(" ")}
