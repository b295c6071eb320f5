"""An opened store: methods read names and parts of its network."""

from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from itertools import chain, groupby
from pathlib import Path
from typing import TYPE_CHECKING, Self

from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.network import (
    DataAmounts,
    FunctionalUnit,
    Network,
    NodePattern,
    ObjectNode,
    Source,
    UnitAmounts,
)
from foon_asp.network.network import UnitKey
from foon_asp.problem import ContainerRule, Unpriced, needed_inputs
from foon_asp.store.columns import (
    attribute_columns,
    decode_entry,
    decode_ids,
    decode_json,
    decode_label,
    decode_node,
    decode_number,
    encode_label,
    json_list,
)
from foon_asp.store.cone import Cone
from foon_asp.store.label_search import labels_beginning, similar_labels
from foon_asp.store.store_file import StoreFile, reporting_damage
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode

if TYPE_CHECKING:  # few answers need numpy
    from foon_asp.store.outline import Outline

_NODE = (
    "SELECT node.id, name, states, relations, contents, kitchen, starting "
    "FROM node JOIN label ON label.id = label"
)
_UNIT = "SELECT id, motion, inputs, outputs FROM unit"
_SOURCE = 'SELECT unit, origin, line, "column" FROM source'
_ORIGIN = "SELECT origin.id, name, videos FROM origin JOIN file ON file.id = file"


_NodeRow = tuple[int, bytes, str, str, str, int, int]
_Unit = tuple[int, tuple[int, ...], tuple[int, ...]]  # motion, inputs and outputs by id


class Store:
    """An opened store. Ids of units and nodes are those that the whole network has when read from text.

    ``with Store(file) as store:`` closes the store at the end, as :meth:`close` does. Python also closes it
    when nothing refers to it any more.

    Methods read only what they need, so their time does not grow with the network. Only :meth:`read_whole`
    and :attr:`outline` read the whole network. Opening and each method raise :class:`UserError` for a file
    that is no store, has another version of the format or is damaged.
    """

    level = 3

    def __init__(self, file: Path) -> None:
        """Open the file, check its header and its tables, and read its properties."""
        self.file, self.name = StoreFile(file), str(file)
        self._database = self.file.database
        self._node_rows: dict[int, _NodeRow] = {}  # rows of the nodes read so far
        self._nodes: dict[int, ObjectNode] = {}
        self._units: dict[int, _Unit] = {}
        self._origins: dict[int, tuple[str, tuple[str, ...]]] = {}  # files with their videos
        self._read_properties()

    @reporting_damage
    def _read_properties(self) -> None:
        """Read the sizes and remarks of the store, and whether it has a kitchen and prices."""
        read_property = self.file.about
        self.unit_count, self.object_count, self.left_out = (
            int(read_property(name)) for name in ("units", "objects", "left_out")
        )
        self.has_kitchen = bool(read_property("kitchen"))  # or an empty one
        self.has_unit_prices = bool(read_property("unit_prices"))
        self.goals_from = str(read_property("goals_from"))  # empty where the goals are from a file
        self.repeated = tuple(
            RepeatedNode(node, Source(file, line, column))
            for node, file, line, column in read_property("repeated")
        )

    def close(self) -> None:
        """Close the file; reading from it raises :class:`UserError` from then on."""
        self.file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Goals, rates, prices and utensils imported with the network.

    @cached_property
    @reporting_damage
    def rates(self) -> dict[str, Fraction] | None:
        """The success rates of motions, or ``None`` if none were imported."""
        rates = self.file.about("rates")
        by_motion = None if rates is None else {motion: decode_number(rate) for motion, rate in rates.items()}
        if by_motion and not all(0 < rate <= 1 for rate in by_motion.values()):
            raise ValueError("a success rate is not above 0 and at most 1")
        return by_motion

    @cached_property
    @reporting_damage
    def motion_prices(self) -> dict[str, Fraction] | None:
        """The prices of units by motion, or ``None`` if no file of prices was imported."""
        prices = self.file.about("motion_prices")
        return None if prices is None else {motion: decode_number(price) for motion, price in prices.items()}

    @cached_property
    @reporting_damage
    def amounts(self) -> DataAmounts:
        """The amounts that units use and make, as imported."""
        amounts: dict[FunctionalUnit, UnitAmounts] = {}
        for number, inputs, outputs in self.file.about("amounts"):
            motion, *sides, _ = self.unit_parts(number)
            unit = FunctionalUnit(motion, *(tuple(self.nodes(side)) for side in sides))
            counted = ({self.node(o): amount for o, amount in side} for side in (inputs, outputs))
            amounts[unit] = UnitAmounts(*counted)
        return DataAmounts(amounts, str(self.file.about("amounts_conflict")))

    @cached_property
    @reporting_damage
    def digests(self) -> dict[str, str]:
        """The digests of ``network``, ``kitchen`` and ``prices``, which were computed at the import.

        Certificates state these digests. They are not checked here.
        """
        digests = self.file.about("digests")
        return {name: bytes.fromhex(digests[name]).hex() for name in ("network", "kitchen", "prices")}

    @cached_property
    @reporting_damage
    def utensils(self) -> frozenset[str]:
        """The labels of utensils that were imported."""
        return frozenset(map(str, self.file.about("utensils")))

    @cached_property
    @reporting_damage
    def goals(self) -> tuple[ListedObject, ...]:
        """The entries of the goals file, or the assumed goals if there was none."""
        return tuple(map(decode_entry, self.file.about("goals")))

    @reporting_damage
    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Read the entries of the kitchen file; none without one."""
        rows = self._database.execute("SELECT entry FROM kitchen_item ORDER BY number")
        return tuple(decode_entry(entry) for (entry,) in rows)

    @cached_property
    @reporting_damage
    def stock(self) -> dict[ObjectNode, int]:
        """The amounts in the kitchen file, by node; nodes without an amount are left out."""
        return {self.node(o): int(amount) for o, amount in self.file.about("stock")}

    def units_with_motions(self, motions: Container[str]) -> Iterator[FunctionalUnit]:
        """Yield the units of the network that have one of the motions."""
        numbers = [number for number, (name, _) in self._motions.items() if name in motions]
        for (number,) in self.file.rows("SELECT id FROM unit WHERE motion IN ids", numbers).fetchall():
            motion, *sides, _ = self.unit_parts(number)
            yield FunctionalUnit(motion, *(tuple(self.nodes(side)) for side in sides))

    # Prices.

    @reporting_damage
    def unit_prices(self, network: Network, from_file: bool) -> dict[FunctionalUnit, Fraction]:
        """Read the prices of single units of ``network``, which is a part of the stored network or all of it.

        Units without such a price are left out. The prices are those that the imported networks state. With
        ``from_file``, prices of the imported file take precedence.
        """
        if not self.has_unit_prices:
            return {}
        statement = f"SELECT unit, {_price_sql(from_file)} FROM price"
        rows: Iterable[tuple[int, str | None]]
        if network.object_numbers:  # a part, be it one without units
            rows = self.file.rows(f"{statement} WHERE unit IN ids", network.unit_numbers)
        else:
            rows = self._database.execute(statement)
        prices = ((network.unit_of_number(number), price) for number, price in rows if price is not None)
        return {network.unit(unit): decode_number(price) for unit, price in prices if unit is not None}

    @reporting_damage
    def unpriced(
        self, motions: Container[str], units: Iterable[FunctionalUnit], from_file: bool
    ) -> list[Unpriced]:
        """Return each motion of unpriced units, with their number and the source of the first one.

        Motions are in the order of their first unpriced units. Units that have one of ``motions`` or are
        among ``units`` count as priced. ``from_file`` says whether prices of the imported file count as well.
        """
        unpriced_motions = [number for number, (name, _) in self._motions.items() if name not in motions]
        if not unpriced_motions:
            return []
        priced = {unit_id for unit in units if (unit_id := self.unit_id(unit)) is not None}
        rows = self.file.rows(
            f"SELECT motion, unit.id FROM unit LEFT JOIN price ON unit = unit.id "
            f"WHERE {_price_sql(from_file)} IS NULL AND motion IN ids ORDER BY unit.id",
            unpriced_motions,
        )
        units_by_motion: dict[int, list[int]] = {}
        for motion, unit in rows:
            if unit not in priced:
                units_by_motion.setdefault(motion, []).append(unit)
        return [
            Unpriced(
                self._motions[motion][0],
                len(motion_units),
                self.sources_of(motion_units[:1])[motion_units[0]][0],
            )
            for motion, motion_units in units_by_motion.items()
        ]

    # Object nodes, by id and by name.

    @reporting_damage
    def read_nodes(self, ids: Iterable[int]) -> None:
        """Read the rows of nodes in one query and keep them; this is faster than one by one."""
        node_rows = self._node_rows
        missing = [o for o in ids if o not in node_rows]
        if missing:
            node_rows.update(
                (row[0], row) for row in self.file.rows(f"{_NODE} WHERE node.id IN ids", missing)
            )

    @reporting_damage
    def _node_row(self, object_id: int) -> _NodeRow:
        """Return the row of a node; read it if it was not read before."""
        if object_id not in self._node_rows:
            self.read_nodes((object_id,))
        return self._node_rows[object_id]

    def node(self, object_id: int) -> ObjectNode:
        """Return the node with an id."""
        return self._nodes.get(object_id) or self.nodes((object_id,))[0]

    @reporting_damage
    def nodes(self, ids: Collection[int]) -> list[ObjectNode]:
        """Return the nodes with these ids, in their order."""
        self.read_nodes(ids)
        nodes = self._nodes
        for o in ids:
            if o not in nodes:
                _, label, states, relations, contents, _, _ = self._node_rows[o]
                nodes[o] = decode_node(decode_label(label), states, relations, contents)
        return [nodes[o] for o in ids]

    def in_kitchen(self, object_id: int) -> bool:
        """Whether a node is in the kitchen that was imported."""
        return self._node_row(object_id)[-2] == 1

    def is_starting(self, object_id: int) -> bool:
        """Whether a node is in the starting kitchen (:class:`foon_asp.network.StartingKitchen`)."""
        return self._node_row(object_id)[-1] == 1

    @reporting_damage
    def object_id(self, node: ObjectNode) -> int | None:
        """Return the id of a node, or ``None`` if the network does not have it."""
        columns = attribute_columns(*node[1:])
        return next(
            self._labelled_ids(node.label, "states = ? AND relations = ? AND contents = ?", *columns), None
        )

    @reporting_damage
    def find(self, pattern: NodePattern) -> list[int]:
        """Return the ids of the nodes that match an entry of a kitchen or goals file, ascending."""
        condition, columns = "states = ?", [json_list(sorted(pattern.states))]
        if pattern.container is None and not pattern.relations:
            condition += " AND relations = '[]'"
        candidates = [*self._labelled_ids(pattern.label, condition, *columns)]
        return [
            o for o, node in zip(candidates, self.nodes(candidates), strict=True) if pattern.matches(node)
        ]

    def _labelled_ids(self, label: str, where: str = "1", *columns: str) -> Iterator[int]:
        """Yield the ids of the nodes with a label, ascending.

        ``where`` is a further condition in SQL; ``columns`` are the values for its question marks.
        """
        statement = (
            f"SELECT id FROM node WHERE label = (SELECT id FROM label WHERE name = ?) AND {where} ORDER BY id"
        )
        return (o for (o,) in self._database.execute(statement, (encode_label(label), *columns)))

    @reporting_damage
    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        """Return the number of nodes with a label, and the ids of the first twelve of them."""
        ids = [*self._labelled_ids(label)]
        return len(ids), ids[:12]

    @reporting_damage
    def beginning(self, start: str, max_labels: int) -> list[str]:
        """Return at most ``max_labels`` labels that begin with ``start``, in order; capitals come first."""
        return self._checked_labels(labels_beginning(self._database, start, max_labels))

    @reporting_damage
    def near(self, label: str, max_labels: int) -> list[str]:
        """Return at most ``max_labels`` labels similar to ``label``, the most similar first."""
        return self._checked_labels(similar_labels(self._database, label, max_labels))

    def _checked_labels(self, labels: list[str]) -> list[str]:
        """Return the labels unchanged; raises :class:`LookupError` for a label that no object node has."""
        for label in labels:
            if next(self._labelled_ids(label), None) is None:
                raise LookupError(f"no object node has the label {label!r}")
        return labels

    @reporting_damage
    def nodes_where(self, condition: str, *values: object) -> frozenset[int]:
        """Return the ids of the nodes that meet a condition in SQL on the columns of the table ``node``.

        ``values`` are the values for the question marks of the condition.
        """
        return frozenset(
            o for (o,) in self._database.execute(f"SELECT id FROM node WHERE {condition}", values)
        )

    # Units.

    @cached_property
    @reporting_damage
    def _motions(self) -> dict[int, tuple[str, int]]:
        """The motions by id, each with the id of the first unit that has it."""
        rows = self._database.execute("SELECT id, name, first_unit FROM motion ORDER BY id")
        return {number: (str(decode_json(name)), unit) for number, name, unit in rows}

    @reporting_damage
    def motion_sources(self) -> list[tuple[str, Source]]:
        """Read every motion, with the first source of the first unit that has it."""
        sources = self.sources_of([unit for _, unit in self._motions.values()])
        return [(motion, sources[unit][0]) for motion, unit in self._motions.values()]

    @reporting_damage
    def sources_of(self, units: Iterable[int]) -> dict[int, tuple[Source, ...]]:
        """Read the sources of units by their ids: a source for each copy of a unit, in the order imported."""
        rows = self.file.rows(f"{_SOURCE} WHERE unit IN ids ORDER BY unit, copy", units).fetchall()
        new = {origin for _, origin, _, _ in rows if origin not in self._origins}
        self._cache_origins(self.file.rows(f"{_ORIGIN} WHERE origin.id IN ids", new) if new else ())
        return self._sources_of_rows(rows)

    def _cache_origins(self, rows: Iterable[tuple[int, str, str]]) -> None:
        """Decode rows of the table ``origin``, and keep the file and videos of each by its id."""
        for number, file, videos in rows:
            self._origins[number] = str(decode_json(file)), tuple(decode_json(videos))

    def _sources_of_rows(self, rows: Iterable[tuple[int, int, int, int]]) -> dict[int, tuple[Source, ...]]:
        """Return the sources of each unit, by its id, from rows of the table ``source``.

        The rows of a unit follow each other. Their origins have to be passed to :meth:`_cache_origins` first.
        """

        def source(_: int, origin: int, line: int, column: int) -> Source:
            """Return the source in a row."""
            file, videos = self._origins[origin]
            return Source(file, int(line), int(column), videos)

        copies_by_unit = groupby(rows, lambda row: row[0])
        return {unit: tuple(source(*row) for row in copies) for unit, copies in copies_by_unit}

    @reporting_damage
    def read_units(self, ids: Iterable[int]) -> None:
        """Read the rows of units in one query and keep them; this is faster than one by one."""
        missing = [unit for unit in ids if unit not in self._units]
        if missing:
            for unit, motion, inputs, outputs in self.file.rows(f"{_UNIT} WHERE id IN ids", missing):
                self._units[unit] = motion, decode_ids(inputs), decode_ids(outputs)

    @reporting_damage
    def _unit_row(self, unit_id: int) -> _Unit:
        """Return the ids of motion, inputs and outputs of a unit; read them if they were not read before."""
        if unit_id not in self._units:
            self.read_units((unit_id,))
        return self._units[unit_id]

    @reporting_damage
    def unit_parts(self, unit: int) -> tuple[str, tuple[int, ...], tuple[int, ...], tuple[Source, ...]]:
        """Return the motion, the ids of inputs, the ids of outputs, and the sources of a unit."""
        motion, inputs, outputs = self._unit_row(unit)
        return self._motions[motion][0], inputs, outputs, self.sources_of((unit,))[unit]

    @reporting_damage
    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit, or ``None`` if the network does not have it.

        The order of inputs and of outputs does not count.
        """
        inputs, outputs = ([self.object_id(node) for node in nodes] for nodes in (unit.inputs, unit.outputs))
        if None in inputs or None in outputs:
            return None
        if outputs:
            candidates = self.producers(outputs[0])  # type: ignore[arg-type]
        else:
            rows = self._database.execute("SELECT id FROM unit WHERE outputs = '[]' ORDER BY id")
            candidates = [candidate for (candidate,) in rows]
        for candidate in candidates:
            motion, *sides = self._unit_row(candidate)
            if [*map(set, sides)] == [set(inputs), set(outputs)] and self._motions[motion][0] == unit.motion:
                return candidate
        return None

    def producers(self, object_id: int) -> list[int]:
        """Return the ids of the units that have a node as an output, ascending."""
        return self.producers_of((object_id,))[0]

    @reporting_damage
    def producers_of(self, objects: Sequence[int]) -> list[list[int]]:
        """Return, for each of the nodes, the ids of the units that have it as an output, ascending.

        All producers are read in one query, and their rows are kept.
        """
        rows = self.file.rows(
            "SELECT node, id, motion, inputs, outputs FROM producer JOIN unit ON id = unit WHERE node IN ids "
            "ORDER BY node, id",
            objects,
        )
        producers: dict[int, list[int]] = {o: [] for o in objects}
        for o, unit, motion, inputs, outputs in rows:
            producers[o].append(unit)
            if unit not in self._units:
                self._units[unit] = motion, decode_ids(inputs), decode_ids(outputs)
        return [producers[o] for o in objects]

    @reporting_damage
    def needs(
        self, units: Sequence[int], containers: ContainerRule, utensils: frozenset[str]
    ) -> list[list[int]]:
        """Return, for each of the units, the ids of the nodes that it needs under a container rule.

        ``utensils`` are the labels of utensils for this rule. All rows that are read are kept.
        """
        self.read_units(units)
        inputs = [self._unit_row(unit)[1] for unit in units]
        self.read_nodes(set(chain.from_iterable(inputs)))
        if containers is ContainerRule.STRICT:
            return [*map(list, inputs)]
        needs = []
        for unit_inputs in inputs:
            nodes = tuple(self.nodes(unit_inputs))
            needed = set(needed_inputs(FunctionalUnit("", nodes, ()), containers, utensils))
            needs.append([o for o, node in zip(unit_inputs, nodes, strict=True) if node in needed])
        return needs

    def cone(
        self,
        goals: Iterable[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        available: Container[int],
        max_units: int | None = None,
    ) -> Cone:
        """Read the cone of goals: backwards through all producers, stopping at ``available`` nodes.

        ``utensils`` are those of the container rule. Every irredundant optimal tree for the goals consists of
        units of the cone. The cone may have more units, since a unit counts as a producer of all its outputs
        under every container rule. With ``max_units``, reading stops after about this number of units.
        """
        cone = Cone(goals, self, containers, utensils, available)
        cone.grow(sorted(cone.open), max_units)
        return cone

    # Networks.

    @reporting_damage
    @without_garbage_collection()
    def read_part(self, units: Iterable[int], objects: Iterable[int] = ()) -> Network:
        """Read units with their nodes, and further nodes ``objects``, as a network of its own.

        Its units and nodes have new ids, in the order of the old ones. ``unit_numbers`` and
        ``object_numbers`` of the network are the old ids.
        """
        unit_ids = sorted(set(units))
        self.read_units(unit_ids)
        rows = [self._unit_row(unit) for unit in unit_ids]
        object_ids = sorted(
            {*objects, *(o for _, *inputs_outputs in rows for nodes in inputs_outputs for o in nodes)}
        )
        new_ids = {o: new_id for new_id, o in enumerate(object_ids)}
        sources = self.sources_of(unit_ids)
        network = self._build_network(
            rows, [sources[unit] for unit in unit_ids], self.nodes(object_ids), new_ids
        )
        return replace(network, unit_numbers=tuple(unit_ids), object_numbers=tuple(object_ids))

    @reporting_damage
    @without_garbage_collection()
    def read_whole(self) -> tuple[Network, frozenset[int]]:
        """Check the digest of the file, and return the whole network and the ids of the kitchen nodes."""
        self.file.check_digest()
        labels = dict(self._database.execute("SELECT id, name FROM label"))
        labels = {number: decode_label(name) for number, name in labels.items()}
        rows = self._database.execute("SELECT label, states, relations, contents FROM node ORDER BY id")
        objects = [decode_node(labels[label], *columns) for label, *columns in rows]
        units = [
            (motion, decode_ids(inputs), decode_ids(outputs))
            for _, motion, inputs, outputs in self._database.execute(f"{_UNIT} ORDER BY id")
        ]
        self._cache_origins(self._database.execute(_ORIGIN))
        sources = self._sources_of_rows(self._database.execute(f"{_SOURCE} ORDER BY unit, copy"))
        if (len(units), len(objects)) != (self.unit_count, self.object_count):
            raise ValueError(
                f"{len(units)} of {self.unit_count} units, {len(objects)} of {self.object_count} nodes"
            )
        network = self._build_network(units, list(sources.values()), objects, range(len(objects)))
        return network, self.nodes_where("kitchen")

    def _build_network(
        self,
        units: Sequence[_Unit],
        sources: Sequence[tuple[Source, ...]],
        objects: Sequence[ObjectNode],
        ids: Mapping[int, int] | range,
    ) -> Network:
        """Build a network from rows of units, the sources of each unit, and nodes.

        ``ids`` are the new ids of the nodes by their ids in the store. Raises :class:`ValueError` if a node
        or unit is there twice, or if a unit lists a node twice.
        """
        motions: list[str] = []
        inputs: list[tuple[int, ...]] = []
        outputs: list[tuple[int, ...]] = []
        unit_ids: dict[UnitKey, int] = {}
        for motion, ins, outs in units:
            motions.append(self._motions[motion][0])
            inputs.append(tuple([ids[o] for o in ins]))
            outputs.append(tuple([ids[o] for o in outs]))
            unit_ids[motions[-1], frozenset(inputs[-1]), frozenset(outputs[-1])] = len(unit_ids)
        object_ids = {node: new_id for new_id, node in enumerate(objects)}
        if (len(object_ids), len(unit_ids), len(sources)) != (len(objects), len(units), len(units)):
            raise ValueError("an object node or a unit is there twice")
        if any(len(set(nodes)) != len(nodes) for nodes in (*inputs, *outputs)):
            raise ValueError("a unit has an object node twice")
        return Network(
            tuple(objects),
            tuple(motions),
            tuple(inputs),
            tuple(outputs),
            tuple(sources),
            object_ids,
            unit_ids,
        )

    @cached_property
    @reporting_damage
    def outline(self) -> "Outline":
        """The outline of the whole network, which is read at the first access."""
        from foon_asp.store.outline import Outline  # noqa: PLC0415 (few answers need numpy)

        motions = [motion for motion, _ in self._motions.values()]
        rows = self._database.execute("SELECT name, numbers FROM outline")
        return Outline(rows, self.unit_count, self.object_count, motions, self.nodes_where)


def _price_sql(from_file: bool) -> str:
    """Return SQL for the price of a unit, which is NULL without one.

    It is the price that networks state. With ``from_file``, the price that the imported file lists takes
    precedence.
    """
    return "coalesce(listed, stated)" if from_file else "stated"
