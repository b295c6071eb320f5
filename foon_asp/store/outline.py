"""The outline of a network: its units and nodes as bare numbers, looked through all at once."""

from collections.abc import Callable, Collection, Iterable, Sequence
from enum import IntEnum
from functools import cached_property
from typing import NoReturn
from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Having, Trait

Numbers = NDArray[np.uint32]
Mask = NDArray[np.bool_]
Distances = NDArray[np.int64]

FAR = 2**62
"""The distance of what cannot be reached."""


class Column(IntEnum):
    """What the table ``outline`` has under each number: 32 bits, least first, for each unit, node or entry.

    By unit, the number of its motion and how many inputs and outputs it has; these, by id, unit by unit. By
    node, a hash of its label and how many ingredients it has; hashes of these, node by node; and whether it
    is in the kitchen that was imported.
    """

    MOTIONS = 0
    INPUT_COUNTS = 1
    INPUTS = 2
    OUTPUT_COUNTS = 3
    OUTPUTS = 4
    LABELS = 5
    INGREDIENT_COUNTS = 6
    INGREDIENTS = 7
    KITCHEN = 8


def word_hash(word: str) -> int:
    """Give the number that stands for a label or an ingredient; others may have the same."""
    return crc32(word.encode("utf-8", "surrogatepass"))


class Outline:
    """What is asked of all units of a store at once; ids are those of the whole network.

    ``column`` reads a column of the table, and raises where the store is damaged, as ``damaged`` does.
    ``motions`` are the names of motions, by number.
    """

    def __init__(
        self,
        column: Callable[[Column], bytes],
        units: int,
        nodes: int,
        motions: Sequence[str],
        damaged: Callable[[str], NoReturn],
    ) -> None:
        def read(which: Column, size: int, below: int = 2**32) -> Numbers:
            content = column(which)
            whole = len(content) == size * np.dtype("<u4").itemsize
            found = np.frombuffer(content if whole else b"", dtype="<u4")
            if not whole or (size and int(found.max()) >= below):
                damaged(f"column {which} of the outline has unexpected content")
            return found

        def read_lists(counts: Column, entries: Column, size: int, below: int) -> "_Lists":
            lengths = read(counts, size)
            return _Lists(lengths, read(entries, int(lengths.sum(dtype=np.int64)), below))

        self._column = read, read_lists
        self._nodes, self._names = nodes, motions
        self.motions = read(Column.MOTIONS, units, len(motions))
        self.inputs = read_lists(Column.INPUT_COUNTS, Column.INPUTS, units, nodes)
        self.outputs = read_lists(Column.OUTPUT_COUNTS, Column.OUTPUTS, units, nodes)
        self._labels = read(Column.LABELS, nodes)
        self._read_lists = read_lists
        self._known: dict[str, Mask] = {}  # nodes by word

    @cached_property
    def _takers(self) -> "_Lists":
        """The units that have each node as an input."""
        return self.inputs.turned(self._nodes)

    @cached_property
    def _makers(self) -> "_Lists":
        """The units that have each node as an output."""
        return self.outputs.turned(self._nodes)

    def has(self, unit: int, motion: str, inputs: Sequence[int], outputs: Sequence[int]) -> bool:
        """Whether a unit is this one here, too."""
        sides = self.inputs.entries_of(unit), self.outputs.entries_of(unit)
        return self._names[self.motions[unit]] == motion and sides == (tuple(inputs), tuple(outputs))

    def kitchen(self) -> Mask:
        """Say of each node whether it is in the kitchen that was imported."""
        return self._column[0](Column.KITCHEN, self._nodes, 2) > 0

    def nodes(self, ids: Collection[int]) -> Mask:
        """Say of each node whether it is among some."""
        found = np.zeros(self._nodes, dtype=np.bool_)
        found[np.fromiter(ids, np.int64, len(ids))] = True
        return found

    def units(self, ids: Collection[int]) -> Mask:
        """Say of each unit whether it is among some."""
        found = np.zeros(len(self.motions), dtype=np.bool_)
        found[np.fromiter(ids, np.int64, len(ids))] = True
        return found

    def labelled(self, labels: Collection[str]) -> Mask:
        """Say of each node whether its label may be among some; of all that have one it says so."""
        return np.isin(self._labels, [word_hash(label) for label in labels])

    def named(self, word: str) -> Mask:
        """Say of each node whether a word may be its label or an ingredient."""
        found = self._known.get(word)
        if found is None:
            held = self._read_lists(Column.INGREDIENT_COUNTS, Column.INGREDIENTS, self._nodes, 2**32)
            hashed = word_hash(word)
            found = self._known[word] = (self._labels == hashed) | held.any(held.entries == hashed)
        return found

    def with_all(self, traits: Iterable[Trait], kitchen: Mask) -> Mask:
        """Say of each unit whether it may have all of some traits, under a kitchen."""
        found = np.ones(len(self.motions), dtype=np.bool_)
        for having, word in traits:
            if having is Having.MOTION:
                found &= np.isin(self.motions, [n for n, name in enumerate(self._names) if name == word])
            else:
                side = self.outputs if having is Having.OUTPUT else self.inputs
                nodes = self.named(word)
                if having is Having.MADE:
                    nodes = nodes & ~kitchen
                found &= side.any(nodes[side.entries])
        return found

    def made_by(self, units: Mask) -> Mask:
        """Say of each node whether one of some units has it as an output."""
        found = np.zeros(self._nodes, dtype=np.bool_)
        places, _ = self.outputs.of(np.flatnonzero(units))
        found[self.outputs.entries[places]] = True
        return found

    def distances(
        self,
        there: Mask,
        costs: NDArray[np.int64],
        most: int,
        free: Mask,
        enough: Callable[[Distances], int] | None = None,
    ) -> Distances:
        """Give what each unit costs with the dearest way to it, :data:`FAR` above ``most``.

        ``there`` are nodes that cost nothing, ``free`` units that do, and ``costs`` is by motion. What leads
        to a unit is counted along one input at a time, so all that it takes together costs no less.
        ``enough`` says of what was found so far what no unit need cost more than.
        """
        nodes = np.where(there, 0, FAR)
        found = np.where(free, 0, FAR)
        own = costs[self.motions]
        units = np.flatnonzero(~self.inputs.any(~there[self.inputs.entries]))  # that may be closer now
        reached = own[units]
        while True:
            if enough is not None:
                most = min(most, enough(found))
            closer = (reached <= most) & (reached < found[units])
            units = units[closer]
            if not len(units):
                return found
            found[units] = reached[closer]
            places, makers = self.outputs.of(units)
            made = self.outputs.entries[places]
            before = nodes[made]
            np.minimum.at(nodes, made, found[makers])
            changed = np.unique(made[nodes[made] < before]).astype(np.int64)
            units = self._takers.entries_of_all(changed)
            places, of = self.inputs.of(units)
            starts = np.flatnonzero(np.diff(of, prepend=-1))
            needed = nodes[self.inputs.entries[places]]
            dearest = np.maximum.reduceat(needed, starts) if len(units) else needed
            reached = _added(dearest, own[units])

    def leading_to(self, units: Mask, there: Mask, among: Mask) -> Mask:
        """Give units, and those among others that make what these need, and so on, but for what is there."""
        found = units.copy()
        new = np.flatnonzero(found)
        while len(new):
            needed = self.inputs.entries_of_all(new)
            makers = self._makers.entries_of_all(needed[~there[needed]])
            new = makers[among[makers] & ~found[makers]]
            found[new] = True
        return found


def _added(before: Distances, own: Distances) -> Distances:
    """Add what is near enough to be reached, of which no sum is too large for that."""
    return np.where(before < FAR, np.minimum(before + own, FAR - 1), FAR)


class _Lists:
    """A list for each of some things, one after the other; some may be empty."""

    def __init__(self, lengths: Numbers, entries: Numbers) -> None:
        self.entries = entries
        self._lengths = lengths
        self._starts = np.cumsum(lengths, dtype=np.int64) - lengths

    @cached_property
    def owners(self) -> Numbers:
        """By entry, the list that it is in."""
        return np.repeat(np.arange(len(self._lengths), dtype=np.uint32), self._lengths)

    def entries_of(self, place: int) -> tuple[int, ...]:
        """Give one of the lists."""
        start = int(self._starts[place])
        return tuple(self.entries[start : start + int(self._lengths[place])].tolist())

    def any(self, entries: Mask) -> Mask:
        """Say of each list whether something holds of one of its entries at least."""
        found = np.zeros(len(self._lengths), dtype=np.bool_)
        found[self.owners[np.flatnonzero(entries)]] = True
        return found

    def entries_of_all(self, lists: NDArray[np.int64]) -> NDArray[np.int64]:
        """Give the entries of some lists, ascending, each once."""
        return np.unique(self.entries[self.of(lists)[0]]).astype(np.int64)

    def turned(self, size: int) -> "_Lists":
        """Give the lists in which each of so many numbers is, as a list for each of these."""
        counts = np.bincount(self.entries, minlength=size).astype(np.uint32)
        return _Lists(counts, self.owners[np.argsort(self.entries, kind="stable")])

    def of(self, lists: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Give the places of all entries of some lists, and for each of them the list that it is in."""
        lengths = self._lengths[lists].astype(np.int64)
        of = np.repeat(lists, lengths)
        before = np.repeat(np.cumsum(lengths) - lengths, lengths)
        return np.arange(len(of)) - before + self._starts[of], of
