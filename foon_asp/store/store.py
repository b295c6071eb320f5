"""A store, opened to ask questions: names, and the part of the network that a question is about."""

from collections import Counter
from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from foon_asp.garbage import uncollected
from foon_asp.network import FunctionalUnit, Network, NodePattern, ObjectNode, Source
from foon_asp.network.network import UnitKey
from foon_asp.network.starting import goal_changes, recipe_kitchen
from foon_asp.problem import ContainerRule, Unpriced, needed_inputs
from foon_asp.store.block import Table
from foon_asp.store.cone import Cone
from foon_asp.store.label_index import LabelIndex
from foon_asp.store.plain_values import entry_of, node_hashes, node_of, pattern_hash
from foon_asp.store.store_file import StoreFile
from foon_asp.text.object_list import ListedObject
from foon_asp.text.repeated_node import RepeatedNode

if TYPE_CHECKING:  # few answers need numpy
    from foon_asp.store.outline import Outline


class Store:
    """An opened store. Ids of units and nodes are those that the whole network has when read from text.

    ``with Store(file) as store:`` closes it at the end, as :meth:`close` does; so does Python when nothing
    refers to the store any more.

    Every method reads what it needs and no more, so that what it costs does not grow with the network.
    Opening and each method raise :class:`UserError` where the store turns out to be none, newer or damaged.
    """

    level = 3

    def __init__(self, file: Path) -> None:
        self._file, self.name = StoreFile(file), str(file)
        about = self._file.block(Table.ABOUT, 0)
        self.units: int = about["units"]
        self.objects: int = about["objects"]
        self.left_out: int = about["left_out"]
        self.has_kitchen = about["kitchen"] is not None  # if only an empty one
        self.goals_from: str = about["goals_from"]  # what no goals file says
        self.repeated = tuple(
            RepeatedNode(node, Source(file, line, column), bool(meant))
            for node, file, line, column, meant in about["repeated"]
        )
        self._counts = about
        labels = LabelIndex(self._file, about["labels"], about["trigram_blocks"])
        self.labelled, self.beginning, self.near = labels.labelled, labels.beginning, labels.near
        self._nodes: dict[int, ObjectNode] = {}
        # what there is of each by number
        tables = Table.UNIT, Table.NODE, Table.PRODUCERS, Table.MOTION, Table.ORIGIN, Table.PRICE
        each = map(self._file.values, tables)
        self._unit, self._node, self._makers, self._motion, self._origin, self._price_row = each
        self._starting, self._file_units = map(self._file.values, (Table.STARTING, Table.FILE))

    def close(self) -> None:
        """Close the file; to read more of it raises :class:`UserError`."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @cached_property
    def rates(self) -> dict[str, Fraction] | None:
        """The success rates of motions, or ``None`` when none were imported."""
        rates = self._file.block(Table.ABOUT, 1)
        return None if rates is None else {motion: Fraction(rate) for motion, rate in rates.items()}

    @cached_property
    def motion_prices(self) -> dict[str, Fraction] | None:
        """The prices of units by motion, or ``None`` when no file of prices was imported."""
        prices = self._file.block(Table.ABOUT, 5)
        return None if prices is None else {motion: Fraction(price) for motion, price in prices.items()}

    @cached_property
    def digests(self) -> dict[str, str]:
        """The digests of ``network``, ``kitchen`` and ``prices`` that were made when it was imported.

        Certificates name them; nothing here says that they are true.
        """
        found: dict[str, str] = self._file.block(Table.ABOUT, 6)
        return found

    @property
    def has_unit_prices(self) -> bool:
        """Whether single units have prices."""
        return bool(self._counts["prices"])

    def unit_prices(self, network: Network, listed: bool) -> dict[FunctionalUnit, Fraction]:
        """Read the prices of single units of a part of the network, or of all of it.

        They are those that the networks had which were imported, and where ``listed`` those of the file that
        was imported beside them, which count before the others.
        """
        if not self.has_unit_prices:
            return {}
        rows: Iterable[Any]
        if network.object_numbers:  # a part, be it one without units
            rows = (self._price_row(unit) for unit in network.unit_numbers)
        else:
            rows = [row for block in self._file.blocks(Table.PRICE) for row in block]
            if len(rows) != self.units:
                self._file.damaged(f"{len(rows)} prices for {self.units} units")
        prices = ((unit, _price(row, listed)) for unit, row in zip(range(len(network)), rows, strict=True))
        return {network.unit(unit): Fraction(price) for unit, price in prices if price is not None}

    def unpriced(
        self, motions: Container[str], units: Iterable[FunctionalUnit], listed: bool
    ) -> list[Unpriced]:
        """Give the units that have no price, but for those with some motions, and for some others.

        ``listed`` is as for :meth:`unit_prices`.
        """
        ids = {unit_id for unit in units if (unit_id := self.unit_id(unit)) is not None}
        others = Counter(self._unit(u)[0] for u in ids if self._stored_price(u, listed) is None)
        found: dict[int, Unpriced] = {}
        for number in range(self._counts["motions"]):
            motion, *_, own, first_own, both, first_both = self._motion(number)
            count, first = (both, first_both) if listed else (own, first_own)
            count -= others[number]
            if motion in motions or count <= 0:
                continue
            while first in ids or not self._is_unpriced(first, number, listed):
                first += 1
            source = self._source(*self._unit(first)[3][:3])
            found[first] = Unpriced(motion, count, source)
        return [found[first] for first in sorted(found)]

    def _is_unpriced(self, unit: int, motion: int, listed: bool) -> bool:
        return self._unit(unit)[0] == motion and self._stored_price(unit, listed) is None

    def _stored_price(self, unit: int, listed: bool) -> str | None:
        return _price(self._price_row(unit), listed) if self.has_unit_prices else None

    @cached_property
    def utensils(self) -> frozenset[str]:
        """The labels of utensils."""
        return frozenset(self._file.block(Table.ABOUT, 2) or ())

    @cached_property
    def goals(self) -> tuple[ListedObject, ...]:
        """The entries of the goals file."""
        return tuple(map(entry_of, self._file.block(Table.ABOUT, 3)))

    def kitchen_items(self) -> tuple[ListedObject, ...]:
        """Read the entries of the kitchen file: all of them, which only a whole network needs."""
        return tuple(entry_of(values) for block in self._file.blocks(Table.KITCHEN) for values in block)

    def motion_sources(self) -> list[tuple[str, Source]]:
        """Read every motion, with the place of the first unit that has it."""
        motions = range(self._counts["motions"])
        return [(values[0], Source(*values[1:4])) for values in (self._motion(m) for m in motions)]

    def node(self, object_id: int) -> ObjectNode:
        """Give the node with that id."""
        found = self._nodes.get(object_id)
        if found is None:
            found = self._nodes[object_id] = node_of(self._node(object_id))
        return found

    def in_kitchen(self, object_id: int) -> bool:
        """Whether the node is in the kitchen that was imported."""
        return bool(self._node(object_id)[0])

    def is_starting(self, object_id: int) -> bool:
        """Whether the node is in the starting kitchen, see :class:`foon_asp.network.StartingKitchen`."""
        return bool(self._starting(object_id))

    def starting_kitchen(self) -> frozenset[int]:
        """Read the whole starting kitchen."""
        rows = (row for block in self._file.blocks(Table.STARTING) for row in block)
        return frozenset(o for o, row in enumerate(rows) if row)

    def starting_changes(self, goals: Iterable[int]) -> tuple[frozenset[int], frozenset[int]]:
        """Return what the starting kitchen has more, and what it lacks, because these are the goals."""
        makers = {o: self._making(o) for o in goals if o < self.objects and self.is_starting(o)}
        assumed = [o for o, units in makers.items() if units]
        return goal_changes(assumed, self._granting, lambda o: self._files_of(makers[o]), self._kitchen_of)

    def made_too(self, objects: Iterable[int]) -> list[int]:
        """Return those of some nodes that a unit makes out of others."""
        return [o for o in objects if self._making(o)]

    def _making(self, object_id: int) -> list[int]:
        """Return the units that make a node out of others."""
        return [unit for unit in self.producers(object_id) if object_id not in self._unit(unit)[1]]

    def _granting(self, object_id: int) -> list[int]:
        row: int | list[int] = self._starting(object_id)
        return row if isinstance(row, list) else []

    def _files_of(self, units: Iterable[int]) -> Iterator[int]:
        """Return the files of units, by the number of the first origin of each."""
        for unit in units:
            for origin in self._unit(unit)[3][::3]:
                row = self._file_units(origin)
                yield row if isinstance(row, int) else origin

    def _kitchen_of(self, file: int, goals: Collection[int]) -> set[int]:
        units = [self._unit(unit) for unit in self._file_units(file)]
        raw, granted = recipe_kitchen([unit[1] for unit in units], [unit[2] for unit in units], goals)
        return {*raw, *granted}

    def object_id(self, node: ObjectNode) -> int | None:
        """Give the id of a node, or ``None`` when the network does not have it."""
        found = self._hashed(node_hashes(node)[0], lambda other: other == node)
        return found[0] if found else None

    def find(self, pattern: NodePattern) -> list[int]:
        """Give the ids of the nodes that a kitchen or goals entry stands for."""
        return self._hashed(pattern_hash(pattern), pattern.matches)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Give the id of a unit, or ``None`` when the network does not have it."""
        sides = [[self.object_id(node) for node in side] for side in (unit.inputs, unit.outputs)]
        if None in sides[0] or None in sides[1]:
            return None
        outputs = sides[1]
        candidates = self._file.block(Table.ABOUT, 4) if not outputs else self.producers(outputs[0])  # type: ignore[arg-type]
        for candidate in candidates:
            motion, inputs, outputs, _ = self._unit(candidate)
            if [set(inputs), set(outputs)] == [set(side) for side in sides] and (
                self._motion(motion)[0] == unit.motion
            ):
                return candidate
        return None

    @uncollected()
    def cone(
        self,
        goals: Iterable[int],
        containers: ContainerRule,
        utensils: frozenset[str],
        in_kitchen: Callable[[int], bool] | None = None,
        most: int | None = None,
    ) -> Cone:
        """Find the units that goals can need: backwards through all producers, stopping at the kitchen.

        ``utensils`` are what the container rule looks at, ``in_kitchen`` says of a node whether it is at
        hand (in the store's kitchen if ``None``). Whatever tree for these goals is best in the whole
        network, without a unit to spare, is one of them. Producers are units with a node among their
        outputs, whether or not the rule has them make it: there may be more than need be. With ``most``,
        about as many are found at first.
        """
        cone = Cone(
            goals,
            self.producers,
            lambda unit: self._needs(unit, containers, utensils),
            in_kitchen or self.in_kitchen,
        )
        cone.grow(sorted(cone.open), most)
        return cone

    def part_of(self, cone: Cone) -> Network:
        """Read what was found of a cone."""
        return self.part(cone.units, cone.goals)

    @uncollected()
    def part(self, units: Iterable[int], objects: Iterable[int] = ()) -> Network:
        """Read some units, the nodes in them, and further nodes, as a part of the whole network."""
        unit_ids = sorted(set(units))
        read = [self._unit(unit) for unit in unit_ids]
        object_ids = sorted(
            {*objects, *(o for _, ins, outs, _ in read for side in (ins, outs) for o in side)}
        )
        new_ids = {o: place for place, o in enumerate(object_ids)}
        network = self._network(read, [self.node(o) for o in object_ids], new_ids)
        return replace(network, unit_numbers=tuple(unit_ids), object_numbers=tuple(object_ids))

    @uncollected()
    def whole(self) -> tuple[Network, frozenset[int]]:
        """Read the whole network, and which nodes are in the kitchen."""
        values = [values for block in self._file.blocks(Table.NODE) for values in block]
        units = [values for block in self._file.blocks(Table.UNIT) for values in block]
        if len(values) != self.objects or len(units) != self.units:
            self._file.damaged(f"{len(units)} of {self.units} units, {len(values)} of {self.objects} nodes")
        network = self._network(units, [node_of(node) for node in values], range(len(values)))
        return network, frozenset(o for o, node in enumerate(values) if node[0])

    def _network(
        self, units: Sequence[Any], objects: Sequence[ObjectNode], ids: Mapping[int, int] | range
    ) -> Network:
        """Put a network together; ``ids`` are the new ids of the nodes by the old ones."""
        motions: list[str] = []
        inputs: list[tuple[int, ...]] = []
        outputs: list[tuple[int, ...]] = []
        sources: list[tuple[Source, ...]] = []
        unit_ids: dict[UnitKey, int] = {}
        named = [o for _, ins, outs, _ in units for side in (ins, outs) for o in side]
        if isinstance(ids, range) and max(named, default=-1) >= len(ids):
            self._file.damaged("a unit has an object node that is missing")
        for motion, ins, outs, places in units:
            motions.append(self._motion(motion)[0])
            inputs.append(tuple([ids[o] for o in ins]))
            outputs.append(tuple([ids[o] for o in outs]))
            sources.append(tuple(self._source(*places[i : i + 3]) for i in range(0, len(places), 3)))
            unit_ids[motions[-1], frozenset(inputs[-1]), frozenset(outputs[-1])] = len(unit_ids)
        object_ids = {node: place for place, node in enumerate(objects)}
        if len(object_ids) != len(objects) or len(unit_ids) != len(units):
            self._file.damaged("an object node or a unit is there twice")
        if any(len(set(side)) != len(side) for side in (*inputs, *outputs)):
            self._file.damaged("a unit has an object node twice")
        return Network(
            tuple(objects),
            tuple(motions),
            tuple(inputs),
            tuple(outputs),
            tuple(sources),
            object_ids,
            unit_ids,
        )

    def _source(self, origin: int, line: int, column: int) -> Source:
        file, videos = self._origin(origin)
        return Source(file, line, column, tuple(videos))

    def _needs(self, unit: int, containers: ContainerRule, utensils: frozenset[str]) -> list[int]:
        inputs: list[int] = self._unit(unit)[1]
        if containers is ContainerRule.STRICT:
            return inputs
        nodes = tuple(map(self.node, inputs))
        needed = set(needed_inputs(FunctionalUnit("", nodes, ()), containers, utensils))
        return [o for o, node in zip(inputs, nodes, strict=True) if node in needed]

    def producers(self, object_id: int) -> list[int]:
        """Give the units that have a node as an output, in order."""
        found: list[int] = self._makers(object_id)
        return found

    @cached_property
    def outline(self) -> "Outline":
        """Read the outline of the whole network: 55 bytes or so for each unit."""
        from foon_asp.store.outline import Outline  # noqa: PLC0415 (few answers need numpy)

        motions = [motion for motion, _ in self.motion_sources()]
        return Outline(self._file.column, self.units, self.objects, motions, self._file.damaged)

    def outline_with(self, units: Iterable[int]) -> "Outline":
        """Give the outline, which has to say the same of some units as the rest of the store."""
        outline = self.outline
        kitchen = outline.kitchen()
        for unit in units:
            motion, inputs, outputs, _ = self.unit_parts(unit)
            held = all(bool(kitchen[o]) is self.in_kitchen(o) for o in (*inputs, *outputs))
            if not held or not outline.has(unit, motion, inputs, outputs):
                self._file.damaged(f"the outline has another unit {unit}")
        return outline

    def unit_parts(self, unit: int) -> tuple[str, tuple[int, ...], tuple[int, ...], tuple[Source, ...]]:
        """Give the motion, the inputs, the outputs and the places of a unit."""
        motion, ins, outs, places = self._unit(unit)
        sources = tuple(self._source(*places[i : i + 3]) for i in range(0, len(places), 3))
        return self._motion(motion)[0], tuple(ins), tuple(outs), sources

    def _hashed(self, wanted: int, is_it: Callable[[ObjectNode], bool]) -> list[int]:
        """Give the ids of the nodes that have this hash and that ``is_it`` says yes of."""
        bucket = self._file.block(Table.NODE_HASH, wanted % self._counts["hash_blocks"])
        found = zip(bucket[::2], bucket[1::2], strict=True)
        return [o for known, o in found if known == wanted and is_it(self.node(o))]


def _price(row: list[str | None] | None, listed: bool) -> str | None:
    """Give the price of a unit: its own, or where those of the file count, the file's if it has one."""
    own, of_file = row or (None, None)
    return of_file if listed and of_file is not None else own
