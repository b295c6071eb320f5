"""Writing a store, unit by unit."""

import sqlite3
from array import array
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import islice
from typing import Any

from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.store.block import APPLICATION_ID, SIZES, VERSION, Table, seal, table_statement, unseal
from foon_asp.store.label_index import label_values, trigram_blocks
from foon_asp.store.plain_values import entry_values, node_hashes, node_values, pattern_hash
from foon_asp.text.assumed_goals import as_entry, wanted_outputs
from foon_asp.text.object_list import ListedObject
from foon_asp.text.unit_price_list import UnitPriceList

_LATER_COPIES = 100_000  # copies of units written before, kept back to be written together


class StoreBuilder:
    """Writes units into a database as they come; copies of a unit are merged and all sources kept.

    Nodes and units get the ids that :class:`~foon_asp.network.NetworkBuilder` would give them. ``kitchen``
    are the entries of the kitchen file, or ``None`` where there is none. In memory are the distinct nodes,
    some numbers for each unit, and the labels; the database is in one transaction, to be committed.
    """

    def __init__(self, database: sqlite3.Connection, kitchen: Sequence[ListedObject] | None) -> None:
        self._database = database
        database.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        database.execute(f"PRAGMA user_version = {VERSION}")
        for table in Table:
            database.execute(table_statement(table))
        self.copies = 0  # of units, added so far
        self.units = 0  # distinct ones
        self.matched = [False] * len(kitchen or ())
        self._kitchen = kitchen
        self._entries: dict[int, list[int]] = {}  # of the kitchen, by hash
        for number, (pattern, _) in enumerate(kitchen or ()):
            self._entries.setdefault(pattern_hash(pattern), []).append(number)

        self._nodes: dict[ObjectNode, int] = {}
        self._same: dict[int, int] = {}  # ids of nodes by the address of the object in _nodes
        self._units: dict[tuple[int, ...], int] = {}
        self._motions: dict[str, int] = {}
        self._motion_sources: list[Source] = []  # of the first unit with each
        self._without_outputs: list[int] = []  # units
        self._origins: dict[tuple[str, tuple[str, ...]], int] = {}
        self._last_origin: tuple[str, tuple[str, ...]] | None = None
        self._last_number = -1
        self._labels: defaultdict[str, list[int]] = defaultdict(list)  # nodes
        self._hashes = array("I")
        self._hashed = array("I")  # the node with the hash at the same place
        self._makers = array("I")  # with the node at the same place in _made
        self._made = array("I")
        self._node_block: list[object] = []
        self._unit_block: list[list[Any]] = []
        self._later: defaultdict[int, list[int]] = defaultdict(list)  # sources of later copies, by unit
        self._kept_back = 0

    @property
    def objects(self) -> int:
        """How many distinct object nodes there are so far."""
        return len(self._nodes)

    def add(
        self,
        motion: str,
        inputs: Iterable[ObjectNode],
        outputs: Iterable[ObjectNode],
        sources: Sequence[Source],
    ) -> int:
        """Add one copy of a unit with the places that it comes from, and return the unit's id."""
        # As in NetworkBuilder: inputs before outputs, a node that one side lists twice once.
        ins = self._ids(inputs)
        outs = self._ids(outputs)
        motion_id = self._motions.setdefault(motion, len(self._motions))
        if motion_id == len(self._motion_sources):
            self._motion_sources.append(sources[0])
        places: list[int] = []
        for file, line, column, videos in sources:
            if (file, videos) != self._last_origin:
                self._last_origin = (file, videos)
                self._last_number = self._origins.setdefault(self._last_origin, len(self._origins))
            places += (self._last_number, line, column)
        self.copies += 1
        key = (motion_id, *sorted(ins), -1, *sorted(outs))
        unit = self._units.setdefault(key, self.units)
        block = self._unit_block
        at_hand = self.units - len(block)  # the first unit of the block
        if unit == self.units:
            self.units += 1
            block.append([motion_id, ins, outs, places])
            if not outs:
                self._without_outputs.append(unit)
            self._made.extend(outs)
            self._makers.extend([unit] * len(outs))
            if len(block) == SIZES[Table.UNIT]:
                self._flush(Table.UNIT, unit, block)
        elif unit >= at_hand:
            block[unit - at_hand][3] += places
        else:
            self._later[unit] += places
            self._kept_back += 1
            if self._kept_back == _LATER_COPIES:
                self._write_later()
        return unit

    def last_outputs(self, units: Mapping[int, Source]) -> list[ListedObject]:
        """Give what the last unit of each file is for, as entries of a goals file.

        ``units`` are the last units by id, each with its place.
        """
        keys = {unit: key for key, unit in self._units.items() if unit in units}
        outputs = {o for key in keys.values() for o in _sides(key)[1]}
        needed = {
            o for key in self._units if not outputs.isdisjoint(key) for o in _sides(key)[0] if o in outputs
        }
        nodes = list(self._nodes)
        found: dict[int, Source] = {}
        for unit, place in units.items():
            for o in wanted_outputs(*_sides(keys[unit]), needed):
                found.setdefault(o, place)
        return [as_entry(nodes[o], place) for o, place in found.items()]

    def finish(
        self,
        goals: Sequence[ListedObject],
        goals_from: str,
        rates: Mapping[str, Fraction] | None,
        utensils: Iterable[str] | None,
        left_out: int,
        stated: Mapping[FunctionalUnit, Fraction],
        listed: UnitPriceList | None,
    ) -> None:
        """Write what is left, and the indexes; ``left_out`` counts lines that were not understood.

        ``goals_from`` says what the goals were assumed from, and is empty where a file lists them.
        ``stated`` are prices that networks have for their units, ``listed`` those of a file, if there is one.
        """
        self._flush(Table.UNIT, self.units - 1, self._unit_block)
        self._flush(Table.NODE, len(self._nodes) - 1, self._node_block)
        self._write_later()
        own, beside_own = (self._by_id(prices) for prices in (stated, listed.units if listed else {}))
        lacking = [self._lacking(own.keys()), self._lacking(own.keys() | beside_own.keys())]
        self._units.clear()  # memory for what follows
        producers = _by_key(self._made, self._makers, len(self._nodes))
        self._write_values(Table.PRODUCERS, producers)
        hashes, hashed = self._hashes, self._hashed
        buckets = len(hashes) // SIZES[Table.NODE_HASH] + 1
        by_hash = _by_key(array("I", [h % buckets for h in hashes]), range(len(hashes)), buckets)
        pairs = ([number for at in places for number in (hashes[at], hashed[at])] for places in by_hash)
        self._write_all(Table.NODE_HASH, pairs)
        self._write_values(Table.LABEL, label_values(self._labels))
        trigrams = trigram_blocks(self._labels)
        self._write_all(Table.TRIGRAM, trigrams)
        motions = (
            [motion, *source[:3], *lacking[0][number], *lacking[1][number]]
            for number, (motion, source) in enumerate(self.motion_sources())
        )
        self._write_values(Table.MOTION, motions)
        self._write_values(Table.ORIGIN, self._origins)
        self._write_values(Table.KITCHEN, map(entry_values, self._kitchen or ()))
        priced = self.units if own or beside_own else 0
        prices = ((own.get(unit), beside_own.get(unit)) for unit in range(priced))
        self._write_values(Table.PRICE, (None if row == (None, None) else row for row in prices))
        counts: dict[str, object] = {
            "units": self.units,
            "objects": len(self._nodes),
            "labels": len(self._labels),
            "motions": len(self._motions),
            "origins": len(self._origins),
            "hash_blocks": buckets,
            "trigram_blocks": len(trigrams),
            "kitchen": None if self._kitchen is None else len(self._kitchen),
            "left_out": left_out,
            "prices": priced,
            "goals_from": goals_from,
        }
        beside = [
            counts,
            None if rates is None else {motion: str(rate) for motion, rate in rates.items()},
            None if utensils is None else sorted(utensils),
            [entry_values(entry) for entry in goals],
            self._without_outputs,
            {motion: str(price) for motion, price in listed.motions.items()} if listed else None,
        ]
        self._write_all(Table.ABOUT, beside)

    def motion_sources(self) -> Iterator[tuple[str, Source]]:
        """Give every motion with the place of the first unit that has it."""
        return zip(self._motions, self._motion_sources, strict=True)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Give the id of a unit that was added, or ``None`` where it was not."""
        motion = self._motions.get(unit.motion)
        sides = [[self._nodes.get(node) for node in side] for side in (unit.inputs, unit.outputs)]
        ins, outs = ([o for o in side if o is not None] for side in sides)
        if motion is None or [ins, outs] != sides:
            return None
        return self._units.get((motion, *sorted(ins), -1, *sorted(outs)))

    def _by_id(self, prices: Mapping[FunctionalUnit, Fraction]) -> dict[int, str]:
        """Give prices of units that were added, by id."""
        found = ((self.unit_id(unit), price) for unit, price in prices.items())
        return {unit: str(price) for unit, price in found if unit is not None}

    def _lacking(self, priced: Collection[int]) -> list[tuple[int, int]]:
        """Give for each motion how many units with it are not among these, and the first of them, or 0."""
        found = [(0, 0)] * len(self._motions)
        for key, unit in self._units.items():
            if unit not in priced:
                count, first = found[key[0]]
                found[key[0]] = (count + 1, first if count else unit)
        return found

    def _new_node(self, node: ObjectNode, number: int) -> None:
        in_kitchen = False
        hashes = node_hashes(node)
        self._hashes.extend(hashes)
        self._hashed.extend([number] * len(hashes))
        for node_hash in hashes:
            for entry in self._entries.get(node_hash, ()):
                if self._kitchen is not None and self._kitchen[entry].pattern.matches(node):
                    in_kitchen = self.matched[entry] = True
        self._labels[node.label].append(number)
        self._node_block.append(node_values(node, in_kitchen))
        if len(self._node_block) == SIZES[Table.NODE]:
            self._flush(Table.NODE, number, self._node_block)

    def _ids(self, nodes: Iterable[ObjectNode]) -> list[int]:
        # The reader gives one object for each node: knowing that object is quicker than comparing nodes.
        known = self._same.get
        # 0 stands for none, so that node 0 is looked up each time.
        ids = [known(id(node)) or self._id(node) for node in nodes]
        return ids if len(ids) == len(set(ids)) else list(dict.fromkeys(ids))

    def _id(self, node: ObjectNode) -> int:
        new = len(self._nodes)
        number = self._nodes.setdefault(node, new)
        if number == new:
            self._new_node(node, number)
            self._same[id(node)] = number  # which is kept from now on, and with it the address
        return number

    def _flush(self, table: Table, last: int, block: list[Any]) -> None:
        """Write the block at hand, whose last value belongs to that id."""
        if block:
            self._write(table, last // SIZES[table], block)
            block.clear()

    def _write_later(self) -> None:
        """Add the sources of later copies to the units they are copies of."""
        by_block: dict[int, list[int]] = {}
        for unit in sorted(self._later):
            by_block.setdefault(unit // SIZES[Table.UNIT], []).append(unit)
        for number, units in by_block.items():
            row = self._database.execute(f"SELECT content FROM {Table.UNIT} WHERE number = ?", (number,))
            block: Any = unseal(Table.UNIT, number, row.fetchone()[0])
            for unit in units:
                block[unit % SIZES[Table.UNIT]][3] += self._later[unit]
            content = seal(Table.UNIT, number, block)
            self._database.execute(f"UPDATE {Table.UNIT} SET content = ? WHERE number = ?", (content, number))
        self._later.clear()
        self._kept_back = 0

    def _write_values(self, table: Table, values: Iterable[object]) -> None:
        waiting = iter(values)
        self._write_all(table, iter(lambda: list(islice(waiting, SIZES[table])), []))

    def _write_all(self, table: Table, blocks: Iterable[object]) -> None:
        for number, block in enumerate(blocks):
            self._write(table, number, block)

    def _write(self, table: Table, number: int, block: object) -> None:
        content = seal(table, number, block)
        self._database.execute(f"INSERT INTO {table} VALUES (?, ?)", (number, content))


def _sides(key: tuple[int, ...]) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Give the inputs and outputs of a unit by its key."""
    between = key.index(-1)
    return key[1:between], key[between + 1 :]


def _by_key(keys: Sequence[int], values: Sequence[int], size: int) -> Iterator[list[int]]:
    """Give for each key from 0 to ``size`` its values, in order: a counting sort."""
    starts = array("Q", bytes(8 * (size + 1)))
    for key in keys:
        starts[key + 1] += 1
    for key in range(size):
        starts[key + 1] += starts[key]
    sorted_values = array("I", bytes(4 * len(keys)))
    free = starts[:]
    for key, value in zip(keys, values, strict=True):
        sorted_values[free[key]] = value
        free[key] += 1
    for key in range(size):
        yield sorted_values[starts[key] : starts[key + 1]].tolist()
