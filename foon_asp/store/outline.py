"""The outline of a network: its units and nodes as bare numbers, looked through all at once."""

from collections.abc import Callable, Collection, Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Having, Trait
from foon_asp.store.columns import encoded_label, quoted

Numbers = NDArray[np.uint32]
Mask = NDArray[np.bool_]
Distances = NDArray[np.int64]

FAR = 2**62
"""The distance of what cannot be reached."""

_LABELLED = "label = (SELECT id FROM label WHERE name = ?)"


class Outline:
    """What is asked of all units of a store at once; ids are those of the whole network.

    ``outline`` are the rows of the table, for so many ``units`` and ``nodes``. ``motions`` are the names of
    motions, by number, and ``nodes_where`` gives the nodes of which a condition in SQL holds. Raises
    :class:`LookupError` for ids that are none.
    """

    def __init__(
        self,
        outline: Iterable[tuple[str, bytes]],
        units: int,
        nodes: int,
        motions: Sequence[str],
        nodes_where: Callable[..., Collection[int]],
    ) -> None:
        self._nodes_where, self._nodes, self.motion_names = nodes_where, nodes, motions
        columns = {name: np.frombuffer(content, dtype="<u4") for name, content in outline}
        self.motions = _below(columns["motions"], len(motions))
        self.inputs, self.outputs = (
            _Lists(columns[f"{side}_counts"], _below(columns[f"{side}s"], nodes))
            for side in ("input", "output")
        )
        if not len(self.motions) == self.inputs.count == self.outputs.count == units:
            raise LookupError("the outline does not have all units")
        self._known: dict[str, Mask] = {}  # nodes by word

    @cached_property
    def _takers(self) -> "_Lists":
        """The units that have each node as an input."""
        return self.inputs.turned(self._nodes)

    @cached_property
    def _makers(self) -> "_Lists":
        """The units that have each node as an output."""
        return self.outputs.turned(self._nodes)

    def nodes(self, ids: Collection[int]) -> Mask:
        """Return for each node whether it is among some."""
        found = np.zeros(self._nodes, dtype=np.bool_)
        found[np.fromiter(ids, np.int64, len(ids))] = True
        return found

    def units(self, ids: Collection[int]) -> Mask:
        """Return for each unit whether it is among some."""
        found = np.zeros(len(self.motions), dtype=np.bool_)
        found[np.fromiter(ids, np.int64, len(ids))] = True
        return found

    def labelled(self, labels: Iterable[str]) -> Mask:
        """Return for each node whether its label is among some."""
        found = np.zeros(self._nodes, dtype=np.bool_)
        for label in labels:
            found |= self.nodes(self._nodes_where(_LABELLED, encoded_label(label)))
        return found

    def named(self, word: str) -> Mask:
        """Return for each node whether a word is its label, or may be an ingredient."""
        found = self._known.get(word)
        if found is None:
            holds = self.nodes(self._nodes_where("instr(contents, ?)", quoted(word)))
            found = self._known[word] = self.labelled((word,)) | holds
        return found

    def with_all(self, traits: Iterable[Trait], kitchen: Mask) -> Mask:
        """Return for each unit whether it may have all of some traits, under a kitchen."""
        found = np.ones(len(self.motions), dtype=np.bool_)
        for having, word in traits:
            if having is Having.MOTION:
                found &= np.isin(
                    self.motions, [n for n, name in enumerate(self.motion_names) if name == word]
                )
            else:
                side = self.outputs if having is Having.OUTPUT else self.inputs
                nodes = self.named(word)
                if having is Having.MADE:
                    nodes = nodes & ~kitchen
                found &= side.any(nodes[side.entries])
        return found

    def made_by(self, units: Mask) -> Mask:
        """Return for each node whether one of some units has it as an output."""
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
        """Return what each unit costs with the dearest way to it, :data:`FAR` above ``most``.

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
        """Return units, and those among others that make what they need, and so on, but for what is there."""
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


def _below(ids: Numbers, count: int) -> Numbers:
    """Return ids of which there have to be so many; raises :class:`LookupError` for others."""
    if len(ids) and int(ids.max()) >= count:
        raise LookupError("a unit has a motion or an object node that is missing")
    return ids


class _Lists:
    """A list for each of some things, one after the other; some may be empty."""

    def __init__(self, lengths: Numbers, entries: Numbers) -> None:
        self.entries, self.count = entries, len(lengths)
        self._lengths = lengths
        self._starts = np.cumsum(lengths, dtype=np.int64) - lengths
        if int(lengths.sum(dtype=np.int64)) != len(entries):
            raise LookupError("the lists of the outline do not have their lengths")

    @cached_property
    def owners(self) -> Numbers:
        """By entry, the list that it is in."""
        return np.repeat(np.arange(len(self._lengths), dtype=np.uint32), self._lengths)

    def any(self, entries: Mask) -> Mask:
        """Return for each list whether something holds of one of its entries at least."""
        found = np.zeros(len(self._lengths), dtype=np.bool_)
        found[self.owners[np.flatnonzero(entries)]] = True
        return found

    def entries_of_all(self, lists: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the entries of some lists, ascending, each once."""
        return np.unique(self.entries[self.of(lists)[0]]).astype(np.int64)

    def turned(self, size: int) -> "_Lists":
        """Return the lists in which each of so many numbers is, as a list for each of these."""
        counts = np.bincount(self.entries, minlength=size).astype(np.uint32)
        return _Lists(counts, self.owners[np.argsort(self.entries, kind="stable")])

    def of(self, lists: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the places of all entries of some lists, and for each of them the list that it is in."""
        lengths = self._lengths[lists].astype(np.int64)
        of = np.repeat(lists, lengths)
        before = np.repeat(np.cumsum(lengths) - lengths, lengths)
        return np.arange(len(of)) - before + self._starts[of], of
