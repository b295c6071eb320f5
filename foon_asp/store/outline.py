"""The outline of a network: its units and nodes as arrays of numbers, for searches of all at once."""

from collections.abc import Callable, Collection, Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Role, Trait
from foon_asp.store.columns import encoded_label, quoted

Numbers = NDArray[np.uint32]
Mask = NDArray[np.bool_]
Distances = NDArray[np.int64]

FAR = 2**62
"""The distance of a unit or node that cannot be reached."""

_LABELLED = "label = (SELECT id FROM label WHERE name = ?)"


class Outline:
    """The hypergraph of all units of a store as arrays; ids are those of the whole network."""

    def __init__(
        self,
        outline: Iterable[tuple[str, bytes]],
        units: int,
        nodes: int,
        motions: Sequence[str],
        nodes_where: Callable[..., Collection[int]],
    ) -> None:
        """Decode the arrays; raises :class:`LookupError` for ids that do not exist.

        Parameters:
            outline: The rows of the table: the name and the bytes of each array.
            units: The number of units in the store.
            nodes: The number of nodes in the store.
            motions: The names of motions, by number.
            nodes_where: A function that returns the ids of the nodes that meet a condition in SQL.
        """
        self._nodes_where, self._nodes, self.motion_names = nodes_where, nodes, motions
        columns = {name: np.frombuffer(content, dtype="<u4") for name, content in outline}
        self.motions = _checked_ids(columns["motions"], len(motions))
        self.inputs, self.outputs = (
            _Lists(columns[f"{direction}_counts"], _checked_ids(columns[f"{direction}s"], nodes))
            for direction in ("input", "output")
        )
        if not len(self.motions) == self.inputs.count == self.outputs.count == units:
            raise LookupError("the outline does not have all units")
        self._named_masks: dict[str, Mask] = {}  # nodes by word

    @cached_property
    def _consumers(self) -> "_Lists":
        """The units that have each node as an input."""
        return self.inputs.inverted(self._nodes)

    @cached_property
    def _producers(self) -> "_Lists":
        """The units that have each node as an output."""
        return self.outputs.inverted(self._nodes)

    def nodes(self, ids: Collection[int]) -> Mask:
        """Return the mask of nodes with these ids."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        mask[np.fromiter(ids, np.int64, len(ids))] = True
        return mask

    def units(self, ids: Collection[int]) -> Mask:
        """Return the mask of units with these ids."""
        mask = np.zeros(len(self.motions), dtype=np.bool_)
        mask[np.fromiter(ids, np.int64, len(ids))] = True
        return mask

    def labelled(self, labels: Iterable[str]) -> Mask:
        """Return the mask of the nodes that have one of the labels."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        for label in labels:
            mask |= self.nodes(self._nodes_where(_LABELLED, encoded_label(label)))
        return mask

    def named(self, word: str) -> Mask:
        """Return the mask of the nodes whose label is a word, or that may have the word as an ingredient."""
        mask = self._named_masks.get(word)
        if mask is None:
            holds = self.nodes(self._nodes_where("instr(contents, ?)", quoted(word)))
            mask = self._named_masks[word] = self.labelled((word,)) | holds
        return mask

    def with_all(self, traits: Iterable[Trait], kitchen: Mask) -> Mask:
        """Return the mask of the units that may have all of the traits; nodes of ``kitchen`` are not made."""
        mask = np.ones(len(self.motions), dtype=np.bool_)
        for role, word in traits:
            if role is Role.MOTION:
                mask &= np.isin(self.motions, [n for n, name in enumerate(self.motion_names) if name == word])
            else:
                lists = self.outputs if role is Role.OUTPUT else self.inputs
                nodes = self.named(word)
                if role is Role.MADE:
                    nodes = nodes & ~kitchen
                mask &= lists.any(nodes[lists.entries])
        return mask

    def made_by(self, units: Mask) -> Mask:
        """Return the mask of the nodes that are outputs of the units."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        positions, _ = self.outputs.positions_of(np.flatnonzero(units))
        mask[self.outputs.entries[positions]] = True
        return mask

    def distances(
        self,
        available: Mask,
        costs: NDArray[np.int64],
        max_distance: int,
        free: Mask,
        limit: Callable[[Distances], int] | None = None,
    ) -> Distances:
        """Return for each unit its cost plus the largest distance of its inputs (``h_max``).

        The distance of ``available`` nodes and ``free`` units is 0. The cost of another unit is that of its
        motion in ``costs``. A tree costs no less than the distance of any of its units, since only one input
        of each unit counts. A distance above ``max_distance`` becomes :data:`FAR`; ``limit`` returns a lower
        maximum from the distances found so far.
        """
        node_distances = np.where(available, 0, FAR)
        distances = np.where(free, 0, FAR)
        own_costs = costs[self.motions]
        units = np.flatnonzero(~self.inputs.any(~available[self.inputs.entries]))  # whose distances may fall
        new_distances = own_costs[units]
        while True:
            if limit is not None:
                max_distance = min(max_distance, limit(distances))
            closer = (new_distances <= max_distance) & (new_distances < distances[units])
            units = units[closer]
            if not len(units):
                return distances
            distances[units] = new_distances[closer]
            positions, owners = self.outputs.positions_of(units)
            made = self.outputs.entries[positions]
            previous = node_distances[made]
            np.minimum.at(node_distances, made, distances[owners])
            changed = np.unique(made[node_distances[made] < previous]).astype(np.int64)
            units = self._consumers.entries_of_all(changed)
            positions, owners = self.inputs.positions_of(units)
            starts = np.flatnonzero(np.diff(owners, prepend=-1))
            needed = node_distances[self.inputs.entries[positions]]
            farthest = np.maximum.reduceat(needed, starts) if len(units) else needed
            new_distances = _saturating_sum(farthest, own_costs[units])

    def leading_to(self, units: Mask, available: Mask, candidates: Mask) -> Mask:
        """Return the mask of the units, and of all ``candidates`` that lead to their unavailable inputs."""
        mask = units.copy()
        new = np.flatnonzero(mask)
        while len(new):
            needed = self.inputs.entries_of_all(new)
            makers = self._producers.entries_of_all(needed[~available[needed]])
            new = makers[candidates[makers] & ~mask[makers]]
            mask[new] = True
        return mask


def _saturating_sum(distances: Distances, costs: Distances) -> Distances:
    """Return distances plus costs; only distances that are :data:`FAR` have the sum :data:`FAR`."""
    return np.where(distances < FAR, np.minimum(distances + costs, FAR - 1), FAR)


def _checked_ids(ids: Numbers, count: int) -> Numbers:
    """Return ids as they are; raises :class:`LookupError` unless all are below ``count``."""
    if len(ids) and int(ids.max()) >= count:
        raise LookupError("a unit has a motion or an object node that is missing")
    return ids


class _Lists:
    """Lists of numbers of different lengths in one array (compressed sparse rows).

    ``count`` is the number of lists.
    """

    def __init__(self, lengths: Numbers, entries: Numbers) -> None:
        self.entries, self.count = entries, len(lengths)
        self._lengths = lengths
        self._starts = np.cumsum(lengths, dtype=np.int64) - lengths
        if int(lengths.sum(dtype=np.int64)) != len(entries):
            raise LookupError("the lists of the outline do not have their lengths")

    @cached_property
    def owners(self) -> Numbers:
        """The list that each entry is in."""
        return np.repeat(np.arange(len(self._lengths), dtype=np.uint32), self._lengths)

    def any(self, entries: Mask) -> Mask:
        """Return the mask of the lists with at least one entry in a mask of entries."""
        mask = np.zeros(len(self._lengths), dtype=np.bool_)
        mask[self.owners[np.flatnonzero(entries)]] = True
        return mask

    def entries_of_all(self, lists: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the distinct entries of some lists, ascending."""
        return np.unique(self.entries[self.positions_of(lists)[0]]).astype(np.int64)

    def inverted(self, size: int) -> "_Lists":
        """Return for each number below ``size`` the lists that it is in."""
        counts = np.bincount(self.entries, minlength=size).astype(np.uint32)
        return _Lists(counts, self.owners[np.argsort(self.entries, kind="stable")])

    def positions_of(self, lists: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the positions of all entries of some lists, and the list of each of them."""
        lengths = self._lengths[lists].astype(np.int64)
        owners = np.repeat(lists, lengths)
        offsets = np.repeat(np.cumsum(lengths) - lengths, lengths)
        return np.arange(len(owners)) - offsets + self._starts[owners], owners
