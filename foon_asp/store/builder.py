"""Writing a store, unit by unit."""

import json
import sqlite3
import sys
from array import array
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import accumulate, islice
from typing import Any

from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.network.starting import recipe_kitchen
from foon_asp.store.block import APPLICATION_ID, SIZES, VERSION, Table, seal, sealed, table_statement, unseal
from foon_asp.store.label_index import LISTED, trigram_blocks, trigram_values
from foon_asp.store.numbering import Numbering
from foon_asp.store.outline import Column, word_hash
from foon_asp.store.plain_values import (
    entry_values,
    node_hashes,
    node_of,
    node_texts,
    node_values,
    pattern_hash,
)
from foon_asp.store.stated_digests import StatedDigests, price_digest
from foon_asp.text.assumed_goals import as_entry, wanted_outputs
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode
from foon_asp.text.unit_price_list import UnitPriceList

_LATER_COPIES = 100_000  # copies of units written before, kept back to be written together
_REMEMBERED = 50_000  # nodes whose number is known at once: what comes again mostly comes soon


class StoreBuilder:
    """Writes units into a database as they come; copies of a unit are merged and all sources kept.

    Nodes and units get the ids that :class:`~foon_asp.network.NetworkBuilder` would give them. ``kitchen``
    are the entries of the kitchen file, or ``None`` where there is none. In memory are some numbers for each
    node and each unit, and the labels; the database is in one transaction, to be committed. ``digests`` get
    all that is added.
    """

    def __init__(
        self,
        database: sqlite3.Connection,
        kitchen: Sequence[ListedObject] | None,
        digests: StatedDigests,
    ) -> None:
        self._database = database
        self._digests = digests
        database.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        database.execute(f"PRAGMA user_version = {VERSION}")
        for table in Table:
            database.execute(table_statement(table))
        self.copies = 0  # of units, added so far
        self.matched = [False] * len(kitchen or ())
        self._kitchen = kitchen
        self._entries: dict[int, list[int]] = {}  # of the kitchen, by hash
        for number, (pattern, _) in enumerate(kitchen or ()):
            self._entries.setdefault(pattern_hash(pattern), []).append(number)

        self._nodes = Numbering()
        self._latest: dict[ObjectNode, int] = {}  # the numbers of some nodes
        self._same: dict[int, int] = {}  # the same by the address of the object in _latest
        self._needed = bytearray()  # by node: whether a unit has it as an input
        self._at_hand = bytearray()  # by node: whether it is in the kitchen
        self._units = Numbering()
        self._motions: dict[str, int] = {}
        self._motion_sources: list[Source] = []  # of the first unit with each
        self._motion_of = array("I")  # by unit
        self._without_outputs: list[int] = []  # units
        self._origins: dict[tuple[str, tuple[str, ...]], int] = {}
        self._last_origin: tuple[str, tuple[str, ...]] | None = None
        self._last_number = -1
        self._copy_units = array("I")  # by copy of a unit: which it is, and where
        self._copy_origins = array("I")
        self._copy_lines = array("I")
        self._copy_columns = array("I")
        self._labels: dict[str, int] = {}
        self._label_of = array("I")  # by node
        self._hashes = array("I")
        self._hashed = array("I")  # the node with the hash at the same place
        self._makers = array("I")  # with the node at the same place in _made
        self._made = array("I")
        self._outputs = array("I")  # by unit: how many
        self._taken = array("I")  # nodes, unit by unit
        self._inputs = array("I")  # by unit: how many
        self._word_hashes = array("I")  # of labels, by node
        self._held = array("I")  # hashes of ingredients, node by node
        self._holds = array("I")  # by node: how many
        self._node_block: list[str] = []
        self._unit_block: list[list[Any]] = []
        self._later: defaultdict[int, list[int]] = defaultdict(list)  # sources of later copies, by unit
        self._kept_back = 0

    @property
    def units(self) -> int:
        """How many distinct units there are so far."""
        return len(self._units)

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
            self._digests.add_motion(motion)
        places: list[int] = []
        for file, line, column, videos in sources:
            if (file, videos) != self._last_origin:
                self._last_origin = (file, videos)
                self._last_number = self._origins.setdefault(self._last_origin, len(self._origins))
            places += (self._last_number, line, column)
            self._copy_origins.append(self._last_number)
            self._copy_lines.append(line)
            self._copy_columns.append(column)
        self.copies += 1
        new = len(self._units)
        unit = self._units.number(_unit_content(motion_id, ins, outs))
        self._copy_units.extend([unit] * len(sources))
        block = self._unit_block
        at_hand = new - len(block)  # the first unit of the block
        if unit == new:
            block.append([motion_id, ins, outs, places])
            self._digests.add_unit(motion_id, ins, outs)
            self._motion_of.append(motion_id)
            if not outs:
                self._without_outputs.append(unit)
            for o in ins:
                self._needed[o] = 1
            self._taken.extend(ins)
            self._inputs.append(len(ins))
            self._outputs.append(len(outs))
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
        found: dict[int, Source] = {}
        for unit, place in units.items():
            _, inputs, outputs, _ = self._written(Table.UNIT, unit)
            needed = {o for o in outputs if self._needed[o]}
            for o in wanted_outputs(inputs, sorted(outputs), needed):
                found.setdefault(o, place)
        return [as_entry(node_of(self._written(Table.NODE, o)), place) for o, place in found.items()]

    def _written(self, table: Table, number: int) -> Any:
        """Give what was added under a number, written already or not."""
        at, place = divmod(number, SIZES[table])
        count, block = len(self._units), self._unit_block
        if table is Table.NODE:
            count, block = len(self._nodes), [json.loads(node) for node in self._node_block]
        return block[place] if at == count // SIZES[table] else self._read(table, at)[place]

    def finish(
        self,
        goals: Sequence[ListedObject],
        goals_from: str,
        rates: Mapping[str, Fraction] | None,
        utensils: Iterable[str] | None,
        left_out: int,
        repeated: Sequence[RepeatedNode],
        stated: Mapping[FunctionalUnit, Fraction],
        listed: UnitPriceList | None,
    ) -> None:
        """Write what is left, and the indexes; ``left_out`` counts lines that were not understood.

        ``goals_from`` says what the goals were assumed from, and is empty where a file lists them.
        ``repeated`` are nodes that a unit lists twice.
        ``stated`` are prices that networks have for their units, ``listed`` those of a file, if there is one.
        """
        self._flush(Table.UNIT, self.units - 1, self._unit_block)
        self._flush_nodes(len(self._nodes) - 1)
        self._write_later()
        own, beside_own = (self._by_id(prices) for prices in (stated, listed.units if listed else {}))
        lacking = [self._lacking(own.keys()), self._lacking(own.keys() | beside_own.keys())]
        units, objects = len(self._units), len(self._nodes)
        self._units, self._nodes = Numbering(), Numbering()  # makes room for what follows
        self._latest.clear()
        self._same.clear()
        self._write_outline()
        self._write_starting(objects)
        producers = _by_key(self._made, self._makers, objects)
        self._write_values(Table.PRODUCERS, producers)
        hashes, hashed = self._hashes, self._hashed
        buckets = len(hashes) // SIZES[Table.NODE_HASH] + 1
        by_hash = _by_key(array("I", (h % buckets for h in hashes)), range(len(hashes)), buckets)
        pairs = ([number for at in places for number in (hashes[at], hashed[at])] for places in by_hash)
        self._write_all(Table.NODE_HASH, pairs)
        labels = sorted(self._labels)
        self._write_values(Table.LABEL, self._label_values(labels))
        trigrams = trigram_blocks(labels)
        self._write_all(Table.TRIGRAM, trigram_values(trigrams))
        motions = (
            [motion, *source[:3], *lacking[0][number], *lacking[1][number]]
            for number, (motion, source) in enumerate(self.motion_sources())
        )
        self._write_values(Table.MOTION, motions)
        self._write_values(Table.ORIGIN, self._origins)
        self._write_values(Table.KITCHEN, map(entry_values, self._kitchen or ()))
        priced = units if own or beside_own else 0
        prices = ((own.get(unit), beside_own.get(unit)) for unit in range(priced))
        self._write_values(Table.PRICE, (None if row == (None, None) else row for row in prices))
        counts: dict[str, object] = {
            "units": units,
            "objects": objects,
            "labels": len(self._labels),
            "motions": len(self._motions),
            "origins": len(self._origins),
            "hash_blocks": buckets,
            "trigram_blocks": len(trigrams),
            "kitchen": None if self._kitchen is None else len(self._kitchen),
            "left_out": left_out,
            "prices": priced,
            "goals_from": goals_from,
            "repeated": [[node, *source[:3], int(meant)] for node, source, meant in repeated],
        }
        by_motion = listed.motions if listed else {} if priced else None
        settled = {**own, **beside_own}
        each = ((unit, settled[unit]) for unit in sorted(settled))
        beside = [
            counts,
            None if rates is None else {motion: str(rate) for motion, rate in rates.items()},
            None if utensils is None else sorted(utensils),
            [entry_values(entry) for entry in goals],
            self._without_outputs,
            {motion: str(price) for motion, price in listed.motions.items()} if listed else None,
            {**self._digests.finished(), "prices": price_digest(by_motion, each)},
        ]
        self._write_all(Table.ABOUT, beside)

    def motion_sources(self) -> Iterator[tuple[str, Source]]:
        """Give every motion with the place of the first unit that has it."""
        return zip(self._motions, self._motion_sources, strict=True)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Give the id of a unit that was added, or ``None`` where it was not."""
        motion = self._motions.get(unit.motion)
        sides = [
            [self._nodes.find(_node_content(node_texts(node))) for node in side]
            for side in (unit.inputs, unit.outputs)
        ]
        ins, outs = ([o for o in side if o is not None] for side in sides)
        if motion is None or [ins, outs] != sides:
            return None
        return self._units.find(_unit_content(motion, ins, outs))

    def _by_id(self, prices: Mapping[FunctionalUnit, Fraction]) -> dict[int, str]:
        """Give prices of units that were added, by id."""
        found = ((self.unit_id(unit), price) for unit, price in prices.items())
        return {unit: str(price) for unit, price in found if unit is not None}

    def _lacking(self, priced: Collection[int]) -> list[tuple[int, int]]:
        """Give for each motion how many units with it are not among these, and the first of them, or 0."""
        found = [(0, 0)] * len(self._motions)
        for unit, motion in enumerate(self._motion_of):
            if unit not in priced:
                count, first = found[motion]
                found[motion] = (count + 1, first if count else unit)
        return found

    def _label_values(self, labels: Iterable[str]) -> Iterator[list[object]]:
        """Give what the table ``label`` has for labels in alphabetical order."""
        counts = array("I", bytes(4 * len(self._labels)))
        first: list[list[int]] = [[] for _ in self._labels]
        for node, label in enumerate(self._label_of):
            counts[label] += 1
            if counts[label] <= LISTED:
                first[label].append(node)
        return (
            [label, counts[number], first[number]] for label in labels for number in (self._labels[label],)
        )

    def _new_node(self, node: ObjectNode, number: int, texts: tuple[str, ...], content: bytes) -> None:
        in_kitchen = False
        hashes = node_hashes(node)
        self._hashes.extend(hashes)
        self._hashed.extend([number] * len(hashes))
        for node_hash in hashes:
            for entry in self._entries.get(node_hash, ()):
                if self._kitchen is not None and self._kitchen[entry].pattern.matches(node):
                    in_kitchen = self.matched[entry] = True
        self._label_of.append(self._labels.setdefault(node.label, len(self._labels)))
        self._needed.append(0)
        self._at_hand.append(in_kitchen)
        self._word_hashes.append(word_hash(node.label))
        ingredients = node.ingredients
        self._holds.append(len(ingredients))
        self._held.extend(map(word_hash, ingredients))
        self._digests.add_node(number, content, in_kitchen)
        self._node_block.append(node_values(texts, in_kitchen))
        if len(self._node_block) == SIZES[Table.NODE]:
            self._flush_nodes(number)

    def _ids(self, nodes: Iterable[ObjectNode]) -> list[int]:
        # The reader gives one object for each node: knowing that object is quicker than comparing nodes.
        known = self._same.get
        # 0 stands for none, so that node 0 is looked up each time.
        ids = [known(id(node)) or self._id(node) for node in nodes]
        return ids if len(ids) == len(set(ids)) else list(dict.fromkeys(ids))

    def _id(self, node: ObjectNode) -> int:
        number = self._latest.get(node)
        if number is None:
            new, texts = len(self._nodes), node_texts(node)
            content = _node_content(texts)
            number = self._nodes.number(content)
            if number == new:
                self._new_node(node, number, texts, content)
            if len(self._latest) >= _REMEMBERED:
                self._latest.clear()
                self._same.clear()
            self._latest[node] = number
            self._same[id(node)] = number  # which is kept as long, and with it the address
        return number

    def _flush_nodes(self, last: int) -> None:
        if self._node_block:
            number, content = last // SIZES[Table.NODE], f"[{','.join(self._node_block)}]".encode("ascii")
            self._insert(Table.NODE, number, sealed(Table.NODE, number, content))
            self._node_block.clear()

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
            block = self._read(Table.UNIT, number)
            for unit in units:
                block[unit % SIZES[Table.UNIT]][3] += self._later[unit]
            content = seal(Table.UNIT, number, block)
            self._database.execute(f"UPDATE {Table.UNIT} SET content = ? WHERE number = ?", (content, number))
        self._later.clear()
        self._kept_back = 0

    def _read(self, table: Table, number: int) -> Any:
        row = self._database.execute(f"SELECT content FROM {table} WHERE number = ?", (number,))
        return unseal(table, number, row.fetchone()[0])

    def _write_outline(self) -> None:
        columns = {
            Column.MOTIONS: self._motion_of,
            Column.INPUT_COUNTS: self._inputs,
            Column.INPUTS: self._taken,
            Column.OUTPUT_COUNTS: self._outputs,
            Column.OUTPUTS: self._made,
            Column.LABELS: self._word_hashes,
            Column.INGREDIENT_COUNTS: self._holds,
            Column.INGREDIENTS: self._held,
            Column.KITCHEN: array("I", iter(self._at_hand)),
        }
        for number, column in columns.items():
            if sys.byteorder == "big":
                column.byteswap()
            self._insert(Table.OUTLINE, number, sealed(Table.OUTLINE, number, column.tobytes()))
            if sys.byteorder == "big":
                column.byteswap()

    def _write_starting(self, objects: int) -> None:
        """Write the units of each file in its order, and the starting kitchen: the union over the files."""
        first: dict[str, int] = {}  # the first origin of each file
        file_of = [first.setdefault(file, number) for number, (file, _) in enumerate(self._origins)]
        copies = _by_key(
            array("I", (file_of[origin] for origin in self._copy_origins)),
            range(len(self._copy_units)),
            len(file_of),
        )
        starting = bytearray(objects)
        granting: defaultdict[int, list[int]] = defaultdict(list)
        input_ends, output_ends = (
            array("Q", accumulate(counts, initial=0)) for counts in (self._inputs, self._outputs)
        )

        def rows() -> Iterator[int | list[int]]:
            for origin, places in enumerate(copies):
                if file_of[origin] != origin:
                    yield file_of[origin]
                    continue
                units = self._in_order(places)
                found = recipe_kitchen(
                    (self._taken[input_ends[unit] : input_ends[unit + 1]] for unit in units),
                    (self._made[output_ends[unit] : output_ends[unit + 1]] for unit in units),
                )
                for o in found.raw:
                    starting[o] = 1
                for o in found.granted:
                    granting[o].append(origin)
                yield units

        self._write_values(Table.FILE, rows())
        self._write_values(Table.STARTING, (granting.get(o) or starting[o] for o in range(objects)))

    def _in_order(self, copies: list[int]) -> list[int]:
        """Return the units of these copies, each once, in the order of their lines."""
        lines, columns = self._copy_lines, self._copy_columns
        copies.sort(key=lambda copy: (lines[copy], columns[copy], self._copy_units[copy]))
        return list(dict.fromkeys(self._copy_units[copy] for copy in copies))

    def _write_values(self, table: Table, values: Iterable[object]) -> None:
        waiting = iter(values)
        self._write_all(table, iter(lambda: list(islice(waiting, SIZES[table])), []))

    def _write_all(self, table: Table, blocks: Iterable[object]) -> None:
        for number, block in enumerate(blocks):
            self._write(table, number, block)

    def _write(self, table: Table, number: int, block: object) -> None:
        self._insert(table, number, seal(table, number, block))

    def _insert(self, table: Table, number: int, content: bytes) -> None:
        self._database.execute(f"INSERT INTO {table} VALUES (?, ?)", (number, content))


def _node_content(texts: Iterable[str]) -> bytes:
    """Give what makes a node what it is, as certificates have it digested."""
    return f"[{','.join(texts)}]".encode("ascii")


def _unit_content(motion: int, inputs: Iterable[int], outputs: Iterable[int]) -> bytes:
    """Give what makes a unit what it is."""
    return repr((motion, sorted(inputs), sorted(outputs))).encode()


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
