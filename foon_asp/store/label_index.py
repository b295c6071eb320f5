"""The labels of a store: by name, by how they begin, and by what they are like, without reading them all."""

from array import array
from bisect import bisect_left
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from itertools import chain
from zlib import crc32

from foon_asp.network.spelling import near_labels
from foon_asp.store.block import SIZES, Table
from foon_asp.store.store_file import StoreFile

LISTED = 12  # node ids kept with a label: as many as a message has room for

_TELLING = 5_000  # three letters that more labels have tell nothing: only how many do is kept
_COMPARED = 300  # labels looked at closely when a similar one is wanted


def trigrams(label: str) -> set[str]:
    """Give every three letters in a row of a label, small, with a blank before and after it."""
    text = f" {label.lower()} "
    return {text[i : i + 3] for i in range(len(text) - 2)}


def trigram_block(trigram: str, blocks: int) -> int:
    """Give the number of the block that has the labels with a trigram."""
    return crc32(trigram.encode("utf-8", "surrogatepass")) % blocks


def trigram_blocks(labels: Collection[str]) -> list[dict[str, "array[int]"]]:
    """Give the places of labels in alphabetical order by trigram, in the blocks of the table ``trigram``.

    There is at least one block.
    """
    places: dict[str, array[int]] = {}
    for place, label in enumerate(labels):
        for trigram in trigrams(label):
            found = places.get(trigram)
            if found is None:
                found = places[trigram] = array("I")
            found.append(place)
    blocks: list[dict[str, array[int]]] = [{} for _ in range(len(places) // SIZES[Table.TRIGRAM] + 1)]
    for trigram in sorted(places):
        blocks[trigram_block(trigram, len(blocks))][trigram] = places[trigram]
    return blocks


def trigram_values(blocks: Sequence[dict[str, "array[int]"]]) -> Iterator[dict[str, list[int] | int]]:
    """Give the contents of the table ``trigram``."""
    for block in blocks:
        yield {
            trigram: places.tolist() if len(places) <= _TELLING else len(places)
            for trigram, places in block.items()
        }


class LabelIndex:
    """Looks labels up in the blocks of a file."""

    def __init__(self, file: StoreFile, labels: int, trigram_blocks: int) -> None:
        self._file, self._label = file, file.values(Table.LABEL)
        self._labels = labels
        self._trigram_blocks = trigram_blocks

    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        """Give how many nodes have a label, and the ids of the first :data:`LISTED`."""
        place = self._place(label)
        if place == self._labels or self._at(place) != label:
            return 0, ()
        _, count, first = self._label(place)
        return count, first

    def beginning(self, start: str, most: int) -> list[str]:
        """Give labels that begin so, in alphabetical order, and not more of them than ``most``."""
        found: list[str] = []
        for place in range(self._place(start), self._labels):
            label = self._at(place)
            if len(found) == most or not label.startswith(start):
                break
            found.append(label)
        return found

    def near(self, label: str, most: int) -> list[str]:
        """Give labels that are like one, the likest first, of those that share rare letters with it."""
        lists: list[list[int]] = []
        for trigram in trigrams(label):
            block = self._file.block(Table.TRIGRAM, trigram_block(trigram, self._trigram_blocks))
            places = block.get(trigram)
            if isinstance(places, list):
                lists.append(places)
        shared = Counter(chain.from_iterable(lists))
        likest = sorted(shared, key=lambda place: (-shared[place], place))[:_COMPARED]
        return near_labels(label, map(self._at, sorted(likest)), most)

    def _place(self, label: str) -> int:
        """Give the place of the first label that is not before this one."""
        return bisect_left(range(self._labels), label, key=self._at)

    def _at(self, place: int) -> str:
        label: str = self._label(place)[0]
        return label
