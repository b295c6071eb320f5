"""Search in the facts of a question: whether a fact matches constants, and which text is most similar."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import islice
from typing import ClassVar, Final, NamedTuple

from foon_asp.encoding.fact_writer import quote, source_names
from foon_asp.escapes import encodable
from foon_asp.network import Network, ObjectNode, Source
from foon_asp.network.spelling import near_labels
from foon_asp.problem import Problem

Names = tuple[str, ...]
Value = str | int | None
"""A text, a number, or ``None`` for a term that occurs in no fact: a word without quotes."""


class Columns(NamedTuple):
    """Argument positions of a predicate, from 0, by type of argument.

    ``units``: the arguments that are numbers of units.
    ``objects``: the arguments that are numbers of object nodes.
    ``numbers``: the arguments that are other numbers.
    ``texts``: the arguments that are texts.
    """

    units: tuple[int, ...] = ()
    objects: tuple[int, ...] = ()
    numbers: tuple[int, ...] = ()
    texts: tuple[int, ...] = ()


_UNIT_OBJECT: Final = Columns(units=(0,), objects=(1,))
_NUMBER_COLUMNS: Final = Columns(units=(0,), numbers=(1,))
_UNIT_TEXT: Final = Columns(units=(0,), texts=(1,))
_OBJECT_TEXT: Final = Columns(objects=(0,), texts=(1,))
_OBJECT: Final = Columns(objects=(0,))

COLUMNS: Final[Mapping[tuple[str, int], Columns]] = {
    ("unit", 1): Columns(units=(0,)),
    ("use", 1): Columns(units=(0,)),
    ("times", 2): _NUMBER_COLUMNS,
    ("motion", 2): _UNIT_TEXT,
    ("source", 2): _UNIT_TEXT,
    ("video", 2): _UNIT_TEXT,
    **dict.fromkeys(
        ((name, 2) for name in ("input", "output", "needs", "gives", "stays", "uses_up")), _UNIT_OBJECT
    ),
    **dict.fromkeys(
        ((name, 2) for name in ("inputs", "ingredients", "rate", "price", "risk")), _NUMBER_COLUMNS
    ),
    **dict.fromkeys(((name, 1) for name in ("object", "kitchen", "goal", "available")), _OBJECT),
    **dict.fromkeys(((name, 2) for name in ("label", "state", "ingredient")), _OBJECT_TEXT),
    ("located", 3): Columns(objects=(0,), texts=(1, 2)),
    ("utensil", 1): Columns(texts=(0,)),
    ("stock", 2): Columns(objects=(0,), numbers=(1,)),
}

MOTIONS: Final = ("motion",)
CONTENTS: Final = ("label", "ingredient")

# Predicates that user files add facts to, each with the predicates whose texts its names have to match.
LISTED_FACTS: Final[Mapping[tuple[str, int], tuple[str, ...]]] = {
    ("allergen", 1): CONTENTS,
    ("allowed", 1): ("source",),
    ("heats", 1): MOTIONS,
}


class _NetworkPart(NamedTuple):
    """The parts of a network whose names are searched: motions, sources, object nodes and utensils.

    Of a store, only the first sources and object nodes are included.
    """

    motions: Iterable[str]
    sources: Iterable[Sequence[Source]]
    objects: Iterable[ObjectNode]
    utensils: Iterable[str]


_TEXTS: Final[Mapping[str, Callable[[_NetworkPart], Iterable[Names]]]] = {
    "motion": lambda scope: ((motion,) for motion in scope.motions),
    "source": lambda scope: ((name,) for sources in scope.sources for name in source_names(sources)),
    "video": lambda scope: (
        (encodable(video),) for sources in scope.sources for source in sources for video in source.videos
    ),
    "label": lambda scope: ((node.label,) for node in scope.objects),
    "state": lambda scope: ((state,) for node in scope.objects for state in node.states),
    "ingredient": lambda scope: ((item,) for node in scope.objects for item in node.ingredients),
    "located": lambda scope: (tuple(relation) for node in scope.objects for relation in node.relations),
    "utensil": lambda scope: ((label,) for label in scope.utensils),
}


def position_of_wrong_type(columns: Columns, values: Mapping[int, Value]) -> int | None:
    """Return the first position whose value has the wrong type; ``None`` if all types are right.

    ``values`` has values by position. A text has the wrong type where a number is expected, a number where a
    text is expected. A value ``None`` always has the wrong type.
    """
    for position, value in values.items():
        if not isinstance(value, str if position in columns.texts else int):
            return position
    return None


class FactValues:
    """Search in the facts about the whole network of a question, not only in the part that goals can need.

    In a store, the part in memory is searched first, then all units and nodes, one by one. The search reads
    at most ``max_read`` units and as many nodes. If a store has more, a name that was not found counts as
    present.
    """

    max_read: ClassVar[int] = 200_000

    def __init__(self, problem: Problem) -> None:
        """Prepare a search in the facts of a problem; nothing is read yet."""
        self._problem = problem
        self._lookups_left = 20

    def matches(self, name: str, columns: Columns, values: Mapping[int, Value]) -> bool:
        """Whether some fact of the predicate ``name`` may have ``values``, given by argument position.

        One fact must have all the texts. The number of a unit or node need only exist; it is not checked in a
        store. Any other number matches. A value of the wrong type matches nothing.
        """
        if position_of_wrong_type(columns, values) is not None:
            return False
        network = self._problem.network
        for size, numbers, positions in (
            (len(network), network.unit_numbers, columns.units),
            (len(network.objects), network.object_numbers, columns.objects),
        ):
            if not numbers and any(
                values[position] not in range(size) for position in positions if position in values
            ):
                return False
        wanted = {
            number: values[position] for number, position in enumerate(columns.texts) if position in values
        }
        if not wanted or self._has_fact(name, wanted, network):
            return True
        return bool(network.object_numbers) and self._may_have_fact_outside_memory(name, wanted)

    def nearest(self, name: str, columns: Columns, words: Mapping[int, str]) -> dict[int, str] | None:
        """Return the texts of the fact spelled most like ``words``; both are given by argument position.

        If a fact has exactly these texts, they are returned. Return ``None`` if no text is similar. From the
        21st call on, nothing is searched, and the result is ``None``.
        """
        self._lookups_left -= 1
        if self._lookups_left < 0:
            return None
        wanted = {
            number: words[position] for number, position in enumerate(columns.texts) if position in words
        }
        networks = {
            id(network): network
            for network in (self._problem.network, self._whole_network)
            if network is not None
        }
        spelt: dict[str, Names] = {}
        for network in networks.values():
            for row in self._fact_texts(name, network):
                spelt.setdefault("\n".join(row[number] for number in wanted), row)
        word = "\n".join(wanted.values())
        matches = [word] if word in spelt else near_labels(word, sorted(spelt), 1)
        if not matches:
            return None
        return {columns.texts[number]: spelt[matches[0]][number] for number in wanted}

    def _fact_texts(self, name: str, network: Network) -> Iterable[Names]:
        """Return the texts of each fact of a predicate in a network.

        In a store, only facts about the first ``max_read`` units and nodes are included.
        """
        limit = self.max_read if _is_read_one_by_one(network) else None
        sources, objects = islice(network.sources, limit), islice(network.objects, limit)
        return _TEXTS[name](_NetworkPart(network.different_motions, sources, objects, self._problem.utensils))

    def _has_fact(self, name: str, wanted: Mapping[int, Value], network: Network) -> bool:
        """Whether a fact of a predicate has the ``wanted`` texts, given by index among its texts."""
        return any(
            all(row[number] == value for number, value in wanted.items())
            for row in self._fact_texts(name, network)
        )

    @property
    def _whole_network(self) -> Network | None:
        """The whole network of a store; ``None`` if it is unknown."""
        origin = self._problem.origin
        return None if origin is None else origin.whole_network

    def _may_have_fact_outside_memory(self, name: str, wanted: Mapping[int, Value]) -> bool:
        """Whether the part of a store that is not in memory may have a fact with the ``wanted`` texts.

        It may if that part is unknown, or too large to be read to the end. Motions and utensils are always
        read to the end.
        """
        network = self._whole_network
        if network is None or self._has_fact(name, wanted, network):
            return True
        is_cut = _is_read_one_by_one(network) and max(len(network), len(network.objects)) > self.max_read
        return is_cut and name not in {"motion", "utensil"}


def unknown_text_message(facts: Sequence[str], word: str, meant: str | None) -> str:
    """Return the message that no fact of the predicates ``facts`` has the text ``word``.

    It suggests ``meant`` as the intended name, unless ``meant`` is ``None``.
    """
    text = f"nothing in this network has the {' or '.join(facts)} {quote(word)}"
    return text if meant is None else f"{text}; did you mean {quote(meant)}?"


def nearest_text(facts: Sequence[str], word: str, values: FactValues) -> str | None:
    """Return the text most similar to a word in facts of the predicates ``facts``.

    Return ``None`` if no text is similar, or if :meth:`FactValues.nearest` was called too often.
    """
    nearest = [values.nearest(fact, COLUMNS[fact, 2], {1: word}) for fact in facts]
    best = near_labels(word, sorted({match[1] for match in nearest if match is not None}), 1)
    return best[0] if best else None


def has_text(facts: Sequence[str], word: str, values: FactValues) -> bool:
    """Whether a fact of one of the predicates ``facts`` has the text ``word``."""
    return any(values.matches(fact, COLUMNS[fact, 2], {1: word}) for fact in facts)


def _is_read_one_by_one(network: Network) -> bool:
    """Whether the nodes of a network are read from a store, not kept in memory."""
    return not isinstance(network.objects, tuple)
