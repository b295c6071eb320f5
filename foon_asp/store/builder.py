"""Builder of a store: it writes a network into a database, unit by unit."""

import sqlite3
import sys
from array import array
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any

from foon_asp.network import DataAmounts, FunctionalUnit, ObjectNode, Source
from foon_asp.network.node_pattern import LookupKey, lookup_keys
from foon_asp.network.starting_kitchen import recipe_kitchen
from foon_asp.store.columns import (
    attribute_columns,
    decode_ids,
    decode_label,
    decode_node,
    encode_entry,
    encode_ids,
    encode_json,
    encode_label,
    json_list,
    json_string,
)
from foon_asp.store.digests import content_digests
from foon_asp.store.label_search import write_trigrams
from foon_asp.store.store_tables import OUTLINE, UNITS_OF_FILE, create_indexes, create_tables
from foon_asp.store.tuning import STORE
from foon_asp.text.assumed_goals import final_outputs, goal_entry
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode
from foon_asp.text.unit_price_list import UnitPriceList


class StoreBuilder:
    """A builder that writes units into a new database; it merges copies of a unit and keeps all sources.

    ``kitchen``: the entries of the kitchen file; ``None`` without such a file.
    ``matched``: for each entry of ``kitchen``, whether a node added so far matches it.
    ``copy_count``: the number of copies of units added so far.

    Nodes and units get the ids that :class:`~foon_asp.network.NetworkBuilder` would give them. The ids of all
    nodes and units are kept in memory, some 400 bytes for each. All writing is one transaction, which the
    caller commits.
    """

    def __init__(self, database: sqlite3.Connection, kitchen: Sequence[ListedObject] | None) -> None:
        """Create the tables of the store in an empty database."""
        self._database = database
        create_tables(database)
        self.copy_count = 0  # of units, added so far
        self._written_units = self._sources = 0  # rows of the tables unit and source
        self.matched = [False] * len(kitchen or ())
        self._kitchen = kitchen
        self._entries: dict[LookupKey, list[int]] = {}
        self._stock: dict[int, int] = {}  # nodes of the kitchen with an amount
        for number, (pattern, *_) in enumerate(kitchen or ()):
            self._entries.setdefault(pattern.lookup_key, []).append(number)
        self._entry_labels = {entry.pattern.label for entry in kitchen or ()}
        self._nodes: dict[tuple[int, int], int] = {}  # ids by label and attributes
        self._latest: dict[ObjectNode, int] = {}  # ids of nodes met lately
        self._units: dict[str, int] = {}  # ids by motion, inputs and outputs
        self._labels: dict[str, int] = {}
        self._attributes: dict[str, int] = {}  # of nodes, by their columns
        self._motions: dict[str, int] = {}
        self._motion_sources: list[Source] = []  # of the first unit with each
        self._files: dict[str, int] = {}
        self._origins: dict[tuple[str, tuple[str, ...]], int] = {}
        self._outline = {name: array("I") for name in OUTLINE}
        self._rows: dict[str, list[tuple[Any, ...]]] = {}  # to be written, by statement

    @property
    def unit_count(self) -> int:
        """The number of distinct units added so far."""
        return len(self._units)

    @property
    def object_count(self) -> int:
        """The number of distinct object nodes added so far."""
        return len(self._nodes)

    def add(
        self,
        motion: str,
        inputs: Iterable[ObjectNode],
        outputs: Iterable[ObjectNode],
        sources: Sequence[Source],
    ) -> int:
        """Add one copy of a unit with its sources, at least one, and return the id of the unit.

        A node that one side lists twice counts once. A copy of a unit that was added before only adds its
        sources.
        """
        # As in NetworkBuilder: inputs before outputs, a node that one side lists twice once.
        ins = list(dict.fromkeys(map(self._node_id, inputs)))
        outs = list(dict.fromkeys(map(self._node_id, outputs)))
        unit = self._units.setdefault(_unit_key(motion, ins, outs), len(self._units))
        if unit == self._written_units:
            motion_id = self._motions.setdefault(motion, len(self._motions))
            if motion_id == len(self._motion_sources):
                self._motion_sources.append(sources[0])
                self._insert("motion", motion_id, json_string(motion), unit)
            self._insert("unit", unit, motion_id, encode_ids(ins), encode_ids(outs))
            for o in outs:
                self._insert("producer", o, unit)
            outline = self._outline
            outline["motions"].append(motion_id)
            outline["input_counts"].append(len(ins))
            outline["inputs"].extend(ins)
            outline["output_counts"].append(len(outs))
            outline["outputs"].extend(outs)
            self._written_units += 1
        for file, line, column, videos in sources:
            self._insert("source", unit, self._sources, self._origin_id(file, videos), line, column)
            self._sources += 1
        self.copy_count += 1
        return unit

    def final_outputs(self, units: Mapping[int, Source]) -> list[ListedObject]:
        """Return the final outputs of the last unit of each file, as entries of a goals file.

        Final outputs are those that no unit needs. If all are needed,
        :func:`~foon_asp.text.assumed_goals.final_outputs` says which are returned. ``units`` are the ids of
        the last units, each with its source. An entry has the source of the first unit in ``units`` that
        makes it. All waiting rows are written first.
        """
        self._write_all_rows()
        statement = "SELECT inputs, outputs FROM unit WHERE id = ?"
        inputs_outputs = {
            unit: [decode_ids(column) for column in self._database.execute(statement, (unit,)).fetchone()]
            for unit in units
        }
        made = {o for _, outputs in inputs_outputs.values() for o in outputs}
        rows = self._database.execute("SELECT inputs FROM unit") if made else ()
        needed = {o for (inputs,) in rows for o in decode_ids(inputs) if o in made}
        sources: dict[int, Source] = {}
        for unit, source in units.items():
            inputs, outputs = inputs_outputs[unit]
            for o in final_outputs(inputs, sorted(outputs), needed):
                sources.setdefault(o, source)
        return [goal_entry(self._read_node(o), source) for o, source in sources.items()]

    def finish(
        self,
        goals: Sequence[ListedObject],
        goals_from: str,
        rates: Mapping[str, Fraction] | None,
        utensils: Iterable[str] | None,
        left_out: int,
        repeated: Sequence[RepeatedNode],
        amounts: DataAmounts,
        stated: Mapping[FunctionalUnit, Fraction],
        prices: UnitPriceList | None,
    ) -> None:
        """Write the remaining rows, the indexes, the starting kitchen, the parameters and the digests.

        Nothing can be added afterwards, as the ids are removed from memory. Prices of units that were not
        added are left out. If ``amounts`` has nodes of no unit, they are added.

        Parameters:
            goals: The entries of the goals file, or the assumed goals.
            goals_from: The origin of the assumed goals; empty if a file lists the goals.
            rates: The success rates of motions; ``None`` without a file of rates.
            utensils: The labels of utensils; ``None`` is stored as no utensils.
            left_out: The number of lines that were not understood.
            repeated: The nodes that a unit lists twice.
            amounts: The amounts of units.
            stated: The prices that networks state for their units.
            prices: The prices of a file; ``None`` without one.
        """
        amounts_by_id = [
            (self.unit_id(unit), *(self._amounts_by_id(side) for side in sides))
            for unit, sides in amounts.units.items()
        ]
        prices_by_id = [
            self._prices_by_id(prices_of_kind) for prices_of_kind in (stated, prices.units if prices else {})
        ]
        for unit in sorted({*prices_by_id[0], *prices_by_id[1]}):
            stated_price, listed_price = (
                None if unit not in prices_of_kind else str(prices_of_kind[unit])
                for prices_of_kind in prices_by_id
            )
            self._insert("price", unit, stated_price, listed_price)
        for number, entry in enumerate(self._kitchen or ()):
            self._insert("kitchen_item", number, encode_entry(entry))
        for name, column in self._outline.items():
            if sys.byteorder == "big":
                column.byteswap()
            self._insert("outline", name, column.tobytes())
        self._write_all_rows()
        write_trigrams(self._database)
        units, objects = self.unit_count, self.object_count
        self._units.clear()  # all this frees memory for the indexes
        self._nodes.clear()
        for index in (self._attributes, self._latest, self._outline):
            index.clear()
        create_indexes(self._database)
        self._write_starting()
        all_prices = {**prices_by_id[0], **prices_by_id[1]}
        properties: dict[str, Any] = {
            "units": units,
            "objects": objects,
            "kitchen": self._kitchen is not None,
            "left_out": left_out,
            "unit_prices": bool(all_prices),
            "goals": [encode_entry(entry) for entry in goals],
            "goals_from": goals_from,
            "rates": None if rates is None else {motion: str(rate) for motion, rate in rates.items()},
            "utensils": sorted(utensils or ()),
            "motion_prices": prices and {motion: str(price) for motion, price in prices.motions.items()},
            "repeated": [[node, *source[:3]] for node, source in repeated],
            "stock": [*self._stock.items()],
            "amounts": amounts_by_id,
            "amounts_conflict": amounts.conflict,
            "digests": content_digests(
                self._database,
                prices.motions if prices else None,
                all_prices if all_prices or prices else None,
            ),
        }
        for name, value in properties.items():
            self._insert("about", name, encode_json(value))
        self._write_all_rows()

    def motion_sources(self) -> Iterator[tuple[str, Source]]:
        """Yield every motion, with the first source of the first unit that has it."""
        return zip(self._motions, self._motion_sources, strict=True)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit that was added, or ``None`` if it was not."""
        ins, outs = ([*map(self._added_id, nodes)] for nodes in (unit.inputs, unit.outputs))
        if None in ins or None in outs:
            return None
        return self._units.get(_unit_key(unit.motion, ins, outs))  # type: ignore[arg-type]

    def _amounts_by_id(self, side: Mapping[ObjectNode, int]) -> list[tuple[int, int]]:
        """Return the nodes of a side as ids, each with its amount; nodes that are new are added."""
        return [(self._node_id(node), amount) for node, amount in side.items()]

    def _prices_by_id(self, prices: Mapping[FunctionalUnit, Fraction]) -> dict[int, Fraction]:
        """Return prices by the ids of their units; units that were not added are left out."""
        by_id = ((self.unit_id(unit), price) for unit, price in prices.items())
        return {unit: price for unit, price in by_id if unit is not None}

    def _node_id(self, node: ObjectNode) -> int:
        """Return the id of a node; a new node is added to the store."""
        node_id = self._latest.get(node)
        if node_id is None:
            label = self._labels.get(node.label)
            if label is None:
                label = self._labels[node.label] = len(self._labels)
                self._insert("label", label, encode_label(node.label))
            columns = attribute_columns(*node[1:])
            attributes = self._attributes.setdefault("".join(columns), len(self._attributes))
            new_id = len(self._nodes)
            node_id = self._nodes.setdefault((label, attributes), new_id)
            if node_id == new_id:
                self._insert("node", node_id, label, *columns, int(self._matches_kitchen(node_id, node)), 0)
            if len(self._latest) >= STORE.cached_nodes:
                self._latest.clear()
            self._latest[node] = node_id
        return node_id

    def _added_id(self, node: ObjectNode) -> int | None:
        """Return the id of a node that was added, or ``None`` if it was not."""
        label = self._labels.get(node.label)
        attributes = self._attributes.get("".join(attribute_columns(*node[1:])))
        return None if label is None or attributes is None else self._nodes.get((label, attributes))

    def _matches_kitchen(self, node_id: int, node: ObjectNode) -> bool:
        """Whether a node matches entries of the kitchen file.

        Records these entries as matched, and the amount of the last one as the stock of the node.
        """
        matches = False
        if self._kitchen is not None and node.label in self._entry_labels:
            for key in lookup_keys(node):
                for entry in self._entries.get(key, ()):
                    item = self._kitchen[entry]
                    if item.pattern.matches(node):
                        matches = self.matched[entry] = True
                        if item.amount is not None:
                            self._stock[node_id] = item.amount
        return matches

    def _read_node(self, node_id: int) -> ObjectNode:
        """Read the node with an id from the database, to which its row must have been written."""
        label, *columns = self._database.execute(
            "SELECT name, states, relations, contents FROM node JOIN label ON label.id = label "
            "WHERE node.id = ?",
            (node_id,),
        ).fetchone()
        return decode_node(decode_label(label), *columns)

    def _origin_id(self, file: str, videos: tuple[str, ...]) -> int:
        """Return the id of a file together with its videos; a new pair is added to the store."""
        origin_id = self._origins.get((file, videos))
        if origin_id is None:
            origin_id = self._origins[file, videos] = len(self._origins)
            if file not in self._files:
                self._files[file] = len(self._files)
                self._insert("file", self._files[file], json_string(file))
            self._insert("origin", origin_id, self._files[file], json_list(videos))
        return origin_id

    def _write_starting(self) -> None:
        """Write the starting kitchen, which is the union of the starting kitchens of the files.

        Its nodes are marked. A file may grant a node that one of its units makes; such files are recorded.
        """
        for file in self._files.values():
            rows = self._database.execute(UNITS_OF_FILE, (file,))
            units = {unit: (decode_ids(inputs), decode_ids(outputs)) for unit, inputs, outputs in rows}
            kitchen = recipe_kitchen(units.values())
            self._database.executemany(
                "UPDATE node SET starting = 1 WHERE id = ?", [(o,) for o in (*kitchen.raw, *kitchen.granted)]
            )
            for o in kitchen.granted:
                self._insert("granted", o, file)

    def _insert(self, table: str, *row: Any) -> None:
        """Add a row to those waiting for a table. Write the waiting rows once they are many."""
        waiting = self._rows.setdefault(table, [])
        waiting.append(row)
        if len(waiting) >= STORE.rows_per_write:
            self._write_rows(table, waiting)

    def _write_rows(self, table: str, rows: list[tuple[Any, ...]]) -> None:
        """Write the rows to a table, and empty the list ``rows``."""
        if rows:
            marks = ",".join("?" * len(rows[0]))
            self._database.executemany(f"INSERT INTO {table} VALUES ({marks})", rows)
            rows.clear()

    def _write_all_rows(self) -> None:
        """Write the waiting rows of all tables."""
        for table, rows in self._rows.items():
            self._write_rows(table, rows)


def _unit_key(motion: str, inputs: Iterable[int], outputs: Iterable[int]) -> str:
    """Return a text that is equal for equal units; the order of inputs and of outputs does not count."""
    return f"{sorted(inputs)}{sorted(outputs)}{motion}"
