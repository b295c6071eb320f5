"""The outline of a store: all units and nodes as arrays of numbers, so that all are searched at once."""

from collections.abc import Callable, Collection, Iterable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from foon_asp.problem import Role, Trait
from foon_asp.store.columns import encode_label, json_string

Numbers = NDArray[np.uint32]
Mask = NDArray[np.bool_]
Distances = NDArray[np.int64]

FAR = 2**62
"""The distance of a unit or node that cannot be reached."""

_LABELLED = "label = (SELECT id FROM label WHERE name = ?)"


class Outline:
    """The units of a store: their motions, inputs and outputs as arrays. Ids are those in the whole network.

    A mask is an array of booleans, one for each unit, node or list. It stands for the set of all units, nodes
    or lists whose value is true.
    """

    def __init__(
        self,
        outline: Iterable[tuple[str, bytes]],
        units: int,
        nodes: int,
        motions: Sequence[str],
        nodes_where: Callable[..., Collection[int]],
    ) -> None:
        """Decode the arrays; raises :class:`LookupError` if they do not fit each other or the store.

        Parameters:
            outline: The rows of the table ``outline``: the name and the bytes of each array.
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
        """For each node, the units that have it as an input."""
        return self.inputs.inverse(self._nodes)

    @cached_property
    def _producers(self) -> "_Lists":
        """For each node, the units that have it as an output."""
        return self.outputs.inverse(self._nodes)

    def node_mask(self, ids: Collection[int]) -> Mask:
        """Return the mask of the nodes with these ids."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        mask[np.fromiter(ids, np.int64, len(ids))] = True
        return mask

    def unit_mask(self, ids: Collection[int]) -> Mask:
        """Return the mask of the units with these ids."""
        mask = np.zeros(len(self.motions), dtype=np.bool_)
        mask[np.fromiter(ids, np.int64, len(ids))] = True
        return mask

    def labelled_nodes(self, labels: Iterable[str]) -> Mask:
        """Return the mask of the nodes that have one of the labels."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        for label in labels:
            mask |= self.node_mask(self._nodes_where(_LABELLED, encode_label(label)))
        return mask

    def nodes_named(self, word: str) -> Mask:
        """Return the mask of the nodes that have the word as their label or in the text of their contents.

        The mask has every node with the word as an ingredient, and maybe others. Masks are kept for further
        calls.
        """
        mask = self._named_masks.get(word)
        if mask is None:
            may_contain = self.node_mask(self._nodes_where("instr(contents, ?)", json_string(word)))
            mask = self._named_masks[word] = self.labelled_nodes((word,)) | may_contain
        return mask

    def units_with_traits(self, traits: Iterable[Trait], kitchen: Mask) -> Mask:
        """Return the mask of the units that may have all of the traits.

        Names are searched in the text of contents, so the mask may have further units. For the trait
        :attr:`.Role.MADE`, nodes in the mask ``kitchen`` do not count.
        """
        mask = np.ones(len(self.motions), dtype=np.bool_)
        for role, word in traits:
            if role is Role.MOTION:
                mask &= np.isin(self.motions, [n for n, name in enumerate(self.motion_names) if name == word])
            else:
                lists = self.outputs if role is Role.OUTPUT else self.inputs
                nodes = self.nodes_named(word)
                if role is Role.MADE:
                    nodes = nodes & ~kitchen
                mask &= lists.lists_with_any(nodes[lists.entries])
        return mask

    def nodes_made_by(self, units: Mask) -> Mask:
        """Return the mask of the nodes that are outputs of the units in a mask."""
        mask = np.zeros(self._nodes, dtype=np.bool_)
        positions, _ = self.outputs.positions_of(np.flatnonzero(units))
        mask[self.outputs.entries[positions]] = True
        return mask

    def unit_distances(
        self,
        available: Mask,
        costs: NDArray[np.int64],
        max_distance: int,
        free: Mask,
        limit: Callable[[Distances], int] | None = None,
    ) -> Distances:
        """Return the distance of each unit: its cost plus the largest distance of its inputs (``h_max``).

        The distance of a node is the least one of its producers. A tree costs at least the distance of each
        of its units.

        ``available``: the nodes whose distance is 0.
        ``costs``: by motion, the cost of its units.
        ``max_distance``: greater distances become :data:`FAR`.
        ``free``: the units whose distance is 0.
        ``limit``: a function that may lower ``max_distance`` in each round of the search. It gets the
        distances found so far, and returns the greatest one for later rounds. ``None`` for no function.
        """
        node_distances = np.where(available, 0, FAR)
        distances = np.where(free, 0, FAR)
        own_costs = costs[self.motions]
        # units whose distances may fall
        units = np.flatnonzero(~self.inputs.lists_with_any(~available[self.inputs.entries]))
        new_distances = own_costs[units]
        while True:
            if limit is not None:
                max_distance = min(max_distance, limit(distances))
            is_closer = (new_distances <= max_distance) & (new_distances < distances[units])
            units = units[is_closer]
            if not len(units):
                return distances
            distances[units] = new_distances[is_closer]
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

    def units_leading_to(self, units: Mask, available: Mask, candidates: Mask) -> Mask:
        """Return the mask of ``units`` and of the candidates through which their inputs can be made.

        A candidate is in the mask if it makes an input of another unit in the mask, and this input is not
        ``available``.
        """
        mask = units.copy()
        new = np.flatnonzero(mask)
        while len(new):
            needed = self.inputs.entries_of_all(new)
            producers_of_needed = self._producers.entries_of_all(needed[~available[needed]])
            new = producers_of_needed[candidates[producers_of_needed] & ~mask[producers_of_needed]]
            mask[new] = True
        return mask


def _saturating_sum(distances: Distances, costs: Distances) -> Distances:
    """Return distances plus costs. A distance of :data:`FAR` stays; all other sums are less than it."""
    return np.where(distances < FAR, np.minimum(distances + costs, FAR - 1), FAR)


def _checked_ids(ids: Numbers, count: int) -> Numbers:
    """Return ids as they are; raises :class:`LookupError` unless all are below ``count``."""
    if len(ids) and int(ids.max()) >= count:
        raise LookupError("a unit has a motion or an object node that is missing")
    return ids


class _Lists:
    """Lists of numbers, one after the other in one array (compressed sparse rows).

    ``lengths``: the length of each list.
    ``entries``: the numbers of all lists.
    ``count``: the number of lists.

    Raises :class:`LookupError` if the lengths do not add up to the number of entries.
    """

    def __init__(self, lengths: Numbers, entries: Numbers) -> None:
        self.entries, self.count = entries, len(lengths)
        self._lengths = lengths
        self._starts = np.cumsum(lengths, dtype=np.int64) - lengths
        if int(lengths.sum(dtype=np.int64)) != len(entries):
            raise LookupError("the lists of the outline do not have their lengths")

    @cached_property
    def owners(self) -> Numbers:
        """For each entry, the number of the list that it is in."""
        return np.repeat(np.arange(len(self._lengths), dtype=np.uint32), self._lengths)

    def lists_with_any(self, entries: Mask) -> Mask:
        """Return the mask of the lists of which at least one entry is in a mask of entries."""
        mask = np.zeros(len(self._lengths), dtype=np.bool_)
        mask[self.owners[np.flatnonzero(entries)]] = True
        return mask

    def entries_of_all(self, lists: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the distinct entries of the lists with these numbers, ascending."""
        return np.unique(self.entries[self.positions_of(lists)[0]]).astype(np.int64)

    def inverse(self, size: int) -> "_Lists":
        """Return new lists: list ``n`` has the numbers of the lists with the entry ``n``, ascending.

        There are ``size`` new lists.
        """
        counts = np.bincount(self.entries, minlength=size).astype(np.uint32)
        return _Lists(counts, self.owners[np.argsort(self.entries, kind="stable")])

    def positions_of(self, lists: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the positions in ``entries`` of all entries of ``lists``, and for each position its list.

        Lists are given by their numbers.
        """
        lengths = self._lengths[lists].astype(np.int64)
        owners = np.repeat(lists, lengths)
        offsets = np.repeat(np.cumsum(lengths) - lengths, lengths)
        return np.arange(len(owners)) - offsets + self._starts[owners], owners
