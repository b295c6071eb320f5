"""The values that facts of a question have: whether some fact matches constants, and the nearest that do."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import islice
from typing import Final, NamedTuple

from foon_asp.encoding.facts import quote, source_names
from foon_asp.escapes import encodable
from foon_asp.network import Network, ObjectNode, Source
from foon_asp.network.spelling import near_labels
from foon_asp.problem import Problem

Names = tuple[str, ...]
Value = str | int | None
"""A text, a number, or ``None`` for a term that no fact has: a word without quotes."""

_MAX_LOOKUPS = 20  # suggestions for one question
_MAX_READ = 200_000  # units or object nodes of a store that are looked through for a name


class Columns(NamedTuple):
    """The arguments of a fact, by place: numbers of units, numbers of object nodes, other numbers, texts."""

    units: tuple[int, ...] = ()
    objects: tuple[int, ...] = ()
    numbers: tuple[int, ...] = ()
    texts: tuple[int, ...] = ()


_SIDE: Final = Columns(units=(0,), objects=(1,))
_NUMBER: Final = Columns(units=(0,), numbers=(1,))
_UNIT_TEXT: Final = Columns(units=(0,), texts=(1,))
_OBJECT_TEXT: Final = Columns(objects=(0,), texts=(1,))
_OBJECT: Final = Columns(objects=(0,))

COLUMNS: Final[Mapping[tuple[str, int], Columns]] = {
    ("unit", 1): Columns(units=(0,)),
    ("use", 1): Columns(units=(0,)),
    ("times", 2): _NUMBER,
    ("motion", 2): _UNIT_TEXT,
    ("source", 2): _UNIT_TEXT,
    ("video", 2): _UNIT_TEXT,
    **dict.fromkeys(((name, 2) for name in ("input", "output", "needs", "gives", "stays", "uses_up")), _SIDE),
    **dict.fromkeys(((name, 2) for name in ("inputs", "ingredients", "rate", "price", "risk")), _NUMBER),
    **dict.fromkeys(((name, 1) for name in ("object", "kitchen", "goal", "available")), _OBJECT),
    **dict.fromkeys(((name, 2) for name in ("label", "state", "ingredient")), _OBJECT_TEXT),
    ("located", 3): Columns(objects=(0,), texts=(1, 2)),
    ("utensil", 1): Columns(texts=(0,)),
    ("stock", 2): Columns(objects=(0,), numbers=(1,)),
}

MOTIONS: Final = ("motion",)
CONTENTS: Final = ("label", "ingredient")

# Predicates that files of the user's add facts to, by the facts that the names are looked for in.
LISTED_FACTS: Final[Mapping[tuple[str, int], tuple[str, ...]]] = {
    ("allergen", 1): CONTENTS,
    ("allowed", 1): ("source",),
    ("heats", 1): MOTIONS,
}


class _Part(NamedTuple):
    """What is looked through of a network."""

    motions: Iterable[str]
    sources: Iterable[Sequence[Source]]
    objects: Iterable[ObjectNode]
    utensils: Iterable[str]


_TEXTS: Final[Mapping[str, Callable[[_Part], Iterable[Names]]]] = {
    "motion": lambda part: ((motion,) for motion in part.motions),
    "source": lambda part: ((name,) for each in part.sources for name in source_names(each)),
    "video": lambda part: (
        (encodable(video),) for each in part.sources for source in each for video in source.videos
    ),
    "label": lambda part: ((node.label,) for node in part.objects),
    "state": lambda part: ((state,) for node in part.objects for state in node.states),
    "ingredient": lambda part: ((item,) for node in part.objects for item in node.ingredients),
    "located": lambda part: (tuple(relation) for node in part.objects for relation in node.relations),
    "utensil": lambda part: ((label,) for label in part.utensils),
}


def misplaced(columns: Columns, values: Mapping[int, Value]) -> int | None:
    """Return the place of a value that no fact can have: a text for a number, or anything but a text for one.

    ``None`` where there is no such place.
    """
    for place, value in values.items():
        if not isinstance(value, str if place in columns.texts else int):
            return place
    return None


class FactValues:
    """The facts of a question about the whole network, whatever of it the goals can need.

    Of a store it is the part that was read; where that does not match, units and nodes of the rest are read
    one by one, up to a limit beyond which a name counts as known.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._lookups_left = _MAX_LOOKUPS

    def matches(self, name: str, columns: Columns, values: Mapping[int, Value]) -> bool:
        """Whether some fact has these values, by place; texts have to be in one fact together."""
        if misplaced(columns, values) is not None:
            return False
        network = self._problem.network
        for size, numbers, places in (
            (len(network), network.unit_numbers, columns.units),
            (len(network.objects), network.object_numbers, columns.objects),
        ):
            if not numbers and any(values[place] not in range(size) for place in places if place in values):
                return False
        wanted = {number: values[place] for number, place in enumerate(columns.texts) if place in values}
        if not wanted or self._has(name, wanted, network):
            return True
        return bool(network.object_numbers) and self._may_have_beyond(name, wanted)

    def nearest(self, name: str, columns: Columns, words: Mapping[int, str]) -> dict[int, str] | None:
        """Return the texts of a fact, by place, that are spelt most like some words.

        ``None`` where none is near, and after so many that more suggestions would only take time.
        """
        self._lookups_left -= 1
        if self._lookups_left < 0:
            return None
        wanted = {number: words[place] for number, place in enumerate(columns.texts) if place in words}
        networks = {id(each): each for each in (self._problem.network, self._whole) if each is not None}
        spelt: dict[str, Names] = {}
        for network in networks.values():
            for row in self._rows(name, network):
                spelt.setdefault("\n".join(row[number] for number in wanted), row)
        word = "\n".join(wanted.values())
        found = [word] if word in spelt else near_labels(word, sorted(spelt), 1)
        if not found:
            return None
        return {columns.texts[number]: spelt[found[0]][number] for number in wanted}

    def _rows(self, name: str, network: Network) -> Iterable[Names]:
        limit = _MAX_READ if _is_read_one_by_one(network) else None
        sources, objects = islice(network.sources, limit), islice(network.objects, limit)
        return _TEXTS[name](_Part(network.different_motions, sources, objects, self._problem.utensils))

    def _has(self, name: str, wanted: Mapping[int, Value], network: Network) -> bool:
        return any(
            all(row[number] == value for number, value in wanted.items()) for row in self._rows(name, network)
        )

    @property
    def _whole(self) -> Network | None:
        """The whole network of a store, ``None`` where nobody knows it."""
        origin = self._problem.origin
        return None if origin is None else origin.whole_network

    def _may_have_beyond(self, name: str, wanted: Mapping[int, Value]) -> bool:
        whole = self._whole
        if whole is None or self._has(name, wanted, whole):
            return True
        is_cut = _is_read_one_by_one(whole) and max(len(whole), len(whole.objects)) > _MAX_READ
        return is_cut and name not in {"motion", "utensil"}


def unknown_text(facts: Sequence[str], word: str, meant: str | None) -> str:
    """Return a message about a name that nothing has in facts, with the one that may be meant."""
    text = f"nothing in this network has the {' or '.join(facts)} {quote(word)}"
    return text if meant is None else f"{text}; did you mean {quote(meant)}?"


def nearest_text(facts: Sequence[str], word: str, values: FactValues) -> str | None:
    """Return the text of some facts that is spelt most like a word, ``None`` where none is near."""
    known = [values.nearest(fact, COLUMNS[fact, 2], {1: word}) for fact in facts]
    found = near_labels(word, sorted({each[1] for each in known if each is not None}), 1)
    return found[0] if found else None


def has_text(facts: Sequence[str], word: str, values: FactValues) -> bool:
    """Whether one of some facts has a text."""
    return any(values.matches(fact, COLUMNS[fact, 2], {1: word}) for fact in facts)


def _is_read_one_by_one(network: Network) -> bool:
    return not isinstance(network.objects, tuple)
