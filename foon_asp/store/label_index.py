"""The labels of a store: by name, by how they begin, and by what they are like, without reading them all."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple
from zlib import crc32

from foon_asp.network.spelling import near_labels
from foon_asp.store.block import SIZES, Table

LISTED = 12  # node ids kept with a label: as many as a message has room for

_TELLING = 5_000  # three letters that more labels have tell nothing: only how many do is kept
_COMPARED = 300  # labels looked at closely when a similar one is wanted

Read = Callable[[Table, int], Any]


class Labelled(NamedTuple):
    """A label: how many ``nodes`` have it, and the ids of the first :data:`LISTED`."""

    label: str
    nodes: int
    first: tuple[int, ...]


def trigrams(label: str) -> set[str]:
    """Give every three letters in a row of a label, small, with a blank before and after it."""
    text = f" {label.lower()} "
    return {text[i : i + 3] for i in range(len(text) - 2)}


def trigram_block(trigram: str, blocks: int) -> int:
    """Give the number of the block that has the labels with a trigram."""
    return crc32(trigram.encode("utf-8", "surrogatepass")) % blocks


def label_blocks(nodes: Mapping[str, Sequence[int]]) -> Iterator[list[list[object]]]:
    """Give the contents of the table ``label`` for labels and the ids of their nodes."""
    ordered = sorted(nodes)
    size = SIZES[Table.LABEL]
    for start in range(0, len(ordered), size):
        labels = ordered[start : start + size]
        yield [[label, len(nodes[label]), nodes[label][:LISTED]] for label in labels]


def trigram_blocks(labels: Mapping[str, object]) -> list[dict[str, list[int] | int]]:
    """Give the contents of the table ``trigram``; there is at least one block."""
    places: defaultdict[str, list[int]] = defaultdict(list)
    for place, label in enumerate(sorted(labels)):
        for trigram in trigrams(label):
            places[trigram].append(place)
    blocks: list[dict[str, list[int] | int]] = [{} for _ in range(len(places) // SIZES[Table.TRIGRAM] + 1)]
    for trigram in sorted(places):
        found = places[trigram]
        block = blocks[trigram_block(trigram, len(blocks))]
        block[trigram] = found if len(found) <= _TELLING else len(found)
    return blocks


class LabelIndex:
    """Looks labels up in blocks.

    ``read`` gives the content of a block by table and number, ``at`` what a table has under a number.
    """

    def __init__(self, read: Read, at: Read, labels: int, trigram_blocks: int) -> None:
        self._read = read
        self._value = at
        self._labels = labels
        self._trigram_blocks = trigram_blocks

    def labelled(self, label: str) -> Labelled:
        """Give the nodes of a label, which may be none."""
        place = self._place(label)
        found = self._at(place) if place < self._labels else None
        return found if found is not None and found.label == label else Labelled(label, 0, ())

    def beginning(self, start: str, most: int) -> list[str]:
        """Give labels that begin so, in alphabetical order, and not more of them than ``most``."""
        found: list[str] = []
        for place in range(self._place(start), self._labels):
            label = self._at(place).label
            if len(found) == most or not label.startswith(start):
                break
            found.append(label)
        return found

    def near(self, label: str, most: int) -> list[str]:
        """Give labels that are like one, the likest first, of those that share rare letters with it."""
        lists: list[list[int]] = []
        for trigram in trigrams(label):
            block = self._read(Table.TRIGRAM, trigram_block(trigram, self._trigram_blocks))
            places = block.get(trigram)
            if isinstance(places, list):
                lists.append(places)
        shared: defaultdict[int, int] = defaultdict(int)
        for places in sorted(lists, key=len):
            for place in places:
                shared[place] += 1
        likest = sorted(shared, key=lambda place: (-shared[place], place))[:_COMPARED]
        return near_labels(label, (self._at(place).label for place in sorted(likest)), most)

    def _place(self, label: str) -> int:
        """Give the place of the first label that is not before this one."""
        low, high = 0, self._labels
        while low < high:
            middle = (low + high) // 2
            if self._at(middle).label < label:
                low = middle + 1
            else:
                high = middle
        return low

    def _at(self, place: int) -> Labelled:
        label, count, first = self._value(Table.LABEL, place)
        return Labelled(label, count, tuple(first))
