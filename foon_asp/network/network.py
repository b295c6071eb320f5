"""The merged network (universal FOON): object nodes and units, each interned once."""

from bisect import bisect_left
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeVar

from foon_asp.network.counted import counted
from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.node_pattern import LookupKey, NodePattern, lookup_keys
from foon_asp.network.object_node import ObjectNode
from foon_asp.network.source import Source
from foon_asp.network.spelling import near_labels

# motion, ids of the inputs, ids of the outputs: the identity of a unit within one network
UnitKey = tuple[str, frozenset[int], frozenset[int]]

_Value = TypeVar("_Value")


@dataclass(frozen=True, eq=False)
class Network:
    """An immutable directed hypergraph of object nodes and functional units.

    Nodes and units are numbered from 0 in the order in which they were first read. These numbers are the ids
    in facts, answers and messages. ``objects`` are the nodes. ``motions[u]`` is the motion of unit ``u``;
    ``inputs[u]`` and ``outputs[u]`` are node ids; ``sources[u]`` lists where each copy of the unit was read.
    A :class:`NetworkBuilder` makes networks.

    A network below ``level`` 3 was made from a network of level 3, which is ``detailed``. Unit ``u`` stands
    for the detailed units with the ids ``stands_for[u]``, and node ``o`` for the detailed nodes with the ids
    ``objects_stand_for[o]``.

    A network may be a part of a larger one, the whole network, that was not read in full. ``unit_numbers``
    and ``object_numbers`` then have the ids of its units and nodes in the whole network, in rising order.
    Users are shown these ids. An empty tuple means that the ids are the same in both networks.

    Example:
        >>> network = foon_asp.load().network
        >>> len(network), network.motions[0], len(network.objects)
        (220, 'turn on', 418)
        >>> ice = foon_asp.parse_node("ice; crushed; in [drinking glass]")
        >>> network.object_id(ice), str(network.node(50)), network.object_number(50)
        (50, 'ice; crushed; in [drinking glass]', 50)
        >>> crush = network.unit(27)
        >>> crush.motion, network.unit_id(crush), network.unit_number(27), network.unit_of_number(27)
        ('crush', 27, 27, 27)
        >>> len(network.without([27])), len(network.with_copies([27])), network.is_like(network.without([27]))
        (219, 221, False)
        >>> network.labelled("ice"), network.beginning("ic", 2), network.near("icee", 1)
        ((5, (43, 46, 50, 52, 55)), ['ice', 'ice cube tray'], ['ice'])
    """

    objects: tuple[ObjectNode, ...]
    motions: tuple[str, ...]
    inputs: tuple[tuple[int, ...], ...]
    outputs: tuple[tuple[int, ...], ...]
    sources: tuple[tuple[Source, ...], ...]
    _object_ids: dict[ObjectNode, int] = field(repr=False)
    _unit_ids: dict[UnitKey, int] = field(repr=False)
    level: int = 3
    detailed: "Network | None" = field(default=None, repr=False)
    stands_for: tuple[tuple[int, ...], ...] = field(default=(), repr=False)
    objects_stand_for: tuple[tuple[int, ...], ...] = field(default=(), repr=False)
    unit_numbers: tuple[int, ...] = field(default=(), repr=False)
    object_numbers: tuple[int, ...] = field(default=(), repr=False)

    def __len__(self) -> int:
        """Count the units."""
        return len(self.motions)

    def __repr__(self) -> str:
        size = f"{counted(len(self), 'unit')}, {counted(len(self.objects), 'object node')}"
        return f"<Network: {size}, level {self.level}>"

    def __iter__(self) -> Iterator[FunctionalUnit]:
        """Return an iterator over the units, in order of id."""
        return map(self.unit, range(len(self)))

    def is_like(self, other: "Network") -> bool:
        """Whether another network has the same level, and the same nodes and units, ids and sources.

        For parts of networks, the ids in the whole network have to be the same, too.

        Parameters:
            other: The other network.
        """
        return self is other or (
            (self.objects, self.motions, self.inputs, self.outputs, self.sources, self.level)
            == (other.objects, other.motions, other.inputs, other.outputs, other.sources, other.level)
            and (self.unit_numbers, self.object_numbers) == (other.unit_numbers, other.object_numbers)
        )

    def to_networkx(self) -> Any:
        """Return the network as a directed graph of the package networkx.

        Nodes of the graph are each :class:`ObjectNode`, and a pair ``("unit", id)`` for each unit. Edges lead
        from the inputs of a unit to the unit, and from the unit to its outputs. The attribute ``kind`` is
        ``object`` or ``unit``. Object nodes have the attributes ``id`` and ``label``, and lists ``states``,
        ``relations`` and ``contents`` of texts; units have ``motion``. Ids are those of the whole network.

        Raises:
            ImportError: if networkx is not installed.

        Example:
            >>> foon_asp.load().network.to_networkx()  # doctest: +SKIP
            <networkx.classes.digraph.DiGraph object at ...>
        """
        try:
            import networkx  # noqa: PLC0415 (an extra)
        except ImportError:
            raise ImportError("a graph needs networkx: pip install 'foon-asp[notebook]'") from None
        graph = networkx.DiGraph()
        for o, node in enumerate(self.objects):
            graph.add_node(
                node,
                kind="object",
                id=self.object_number(o),
                label=node.label,
                states=sorted(node.states),
                relations=[str(relation) for relation in sorted(node.relations)],
                contents=[str(contents) for contents in node.contents],
            )
        for unit, motion in enumerate(self.motions):
            name = ("unit", self.unit_number(unit))
            graph.add_node(name, kind="unit", motion=motion)
            graph.add_edges_from((self.objects[o], name) for o in self.inputs[unit])
            graph.add_edges_from((name, self.objects[o]) for o in self.outputs[unit])
        return graph

    def unit(self, unit_id: int) -> FunctionalUnit:
        """Return the unit with an id.

        Parameters:
            unit_id: The id of the unit.
        """
        objects = self.objects
        return FunctionalUnit(
            self.motions[unit_id],
            tuple(objects[o] for o in self.inputs[unit_id]),
            tuple(objects[o] for o in self.outputs[unit_id]),
        )

    def unit_number(self, unit_id: int) -> int:
        """Return the id that a unit has in the whole network.

        Parameters:
            unit_id: The id of the unit in this network.
        """
        return self.unit_numbers[unit_id] if self.unit_numbers else unit_id

    def unit_of_number(self, number: int) -> int | None:
        """Return the id that a unit of the whole network has in this one, or ``None`` if this one lacks it.

        Parameters:
            number: The id of the unit in the whole network.
        """
        if not self.unit_numbers:
            return number if 0 <= number < len(self) else None
        position = bisect_left(self.unit_numbers, number)
        return position if position < len(self) and self.unit_numbers[position] == number else None

    def units_of_numbers(self, numbers: Iterable[int]) -> tuple[int, ...]:
        """Return the ids that units of the whole network have in this one, in the order of ``numbers``.

        Units that are not in this network are left out.

        Parameters:
            numbers: The ids of the units in the whole network.
        """
        unit_ids = map(self.unit_of_number, numbers)
        return tuple(unit for unit in unit_ids if unit is not None)

    def object_number(self, object_id: int) -> int:
        """Return the id that a node has in the whole network.

        Parameters:
            object_id: The id of the node in this network.
        """
        return self.object_numbers[object_id] if self.object_numbers else object_id

    def object_id(self, node: ObjectNode) -> int | None:
        """Return the id of a node, or ``None`` if the network does not have it.

        Parameters:
            node: The node.
        """
        return self._object_ids.get(node)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit, or ``None`` if the network does not have it.

        Parameters:
            unit: The unit.
        """
        ids = self._object_ids
        if not all(node in ids for node in (*unit.inputs, *unit.outputs)):
            return None
        inputs, outputs = (frozenset(ids[node] for node in nodes) for nodes in (unit.inputs, unit.outputs))
        return self._unit_ids.get((unit.motion, inputs, outputs))

    def without(self, units: Iterable[int]) -> "Network":
        """Return this network without some units.

        Nodes keep their ids. The other units have new ids; ``unit_numbers`` has their ids in the whole
        network.

        Parameters:
            units: The ids of the units to leave out.
        """
        removed = set(units)
        kept = [unit for unit in range(len(self)) if unit not in removed]
        new_ids = {unit: new_id for new_id, unit in enumerate(kept)}
        return replace(
            self,
            motions=tuple(self.motions[unit] for unit in kept),
            inputs=tuple(self.inputs[unit] for unit in kept),
            outputs=tuple(self.outputs[unit] for unit in kept),
            sources=tuple(self.sources[unit] for unit in kept),
            _unit_ids={key: new_ids[unit] for key, unit in self._unit_ids.items() if unit in new_ids},
            stands_for=tuple(self.stands_for[unit] for unit in kept) if self.stands_for else (),
            unit_numbers=tuple(self.unit_number(unit) for unit in kept),
        )

    def with_copies(self, units: Sequence[int]) -> "Network":
        """Return this network with some units a second time, after all others.

        Only the ids distinguish a copy from its unit; :meth:`unit_id` returns the id of the unit. If there
        are ``unit_numbers``, the copies get the numbers after the last one.

        Parameters:
            units: The ids of the units to copy, in the order of the copies.
        """

        def extended(values: tuple[_Value, ...]) -> tuple[_Value, ...]:
            """Return the values of units followed by those of the copies; an empty tuple stays empty."""
            return (*values, *(values[unit] for unit in units)) if values else ()

        numbers = self.unit_numbers
        if numbers:
            numbers += tuple(range(numbers[-1] + 1, numbers[-1] + 1 + len(units)))
        return replace(
            self,
            motions=extended(self.motions),
            inputs=extended(self.inputs),
            outputs=extended(self.outputs),
            sources=extended(self.sources),
            stands_for=extended(self.stands_for),
            unit_numbers=numbers,
        )

    @cached_property
    def different_motions(self) -> frozenset[str]:
        """The motions of the units, each once."""
        return frozenset(self.motions)

    @cached_property
    def producers(self) -> tuple[tuple[int, ...], ...]:
        """For each object node, the ids of the units that have it as an output, in rising order."""
        return _lists_containing(self.outputs, len(self.objects))

    @cached_property
    def consumers(self) -> tuple[tuple[int, ...], ...]:
        """For each object node, the ids of the units that have it as an input, in rising order."""
        return _lists_containing(self.inputs, len(self.objects))

    @cached_property
    def by_label(self) -> dict[str, tuple[int, ...]]:
        """For each label, the ids of the object nodes that have it, in rising order."""
        ids_by_label: defaultdict[str, list[int]] = defaultdict(list)
        for object_id, node in enumerate(self.objects):
            ids_by_label[node.label].append(object_id)
        return {label: tuple(ids) for label, ids in ids_by_label.items()}

    @cached_property
    def by_ingredient(self) -> dict[str, tuple[int, ...]]:
        """For each ingredient, the ids of the object nodes that contain it, in rising order."""
        ids_by_ingredient: defaultdict[str, list[int]] = defaultdict(list)
        for object_id, node in enumerate(self.objects):
            if node.contents:
                for ingredient in {item for contents in node.contents for item in contents.ingredients}:
                    ids_by_ingredient[ingredient].append(object_id)
        return {ingredient: tuple(ids) for ingredient, ids in ids_by_ingredient.items()}

    def node(self, object_id: int) -> ObjectNode:
        """Return the object node with an id.

        Parameters:
            object_id: The id of the node.
        """
        return self.objects[object_id]

    def labelled(self, label: str) -> tuple[int, tuple[int, ...]]:
        """Return how many nodes have a label, and their ids in rising order.

        Parameters:
            label: The label.
        """
        ids = self.by_label.get(label, ())
        return len(ids), ids

    def beginning(self, start: str, max_labels: int) -> list[str]:
        """Return labels that begin with a text, in alphabetical order.

        Parameters:
            start: The text.
            max_labels: The greatest number of labels to return.
        """
        return sorted(label for label in self.by_label if label.startswith(start))[:max_labels]

    def near(self, label: str, max_labels: int) -> list[str]:
        """Return labels that are similar to a given one, the most similar first.

        Parameters:
            label: The label to compare with.
            max_labels: The greatest number of labels to return.
        """
        return near_labels(label, self.by_label, max_labels)

    def find(self, pattern: NodePattern) -> tuple[int, ...]:
        """Return the ids of the nodes that match an entry of a kitchen or goals file, in rising order.

        Parameters:
            pattern: The entry.
        """
        candidates = self._by_lookup_key.get(pattern.lookup_key, ())
        return tuple(o for o in candidates if pattern.matches(self.objects[o]))

    @cached_property
    def _by_lookup_key(self) -> dict[LookupKey, list[int]]:
        """For each lookup key, the ids of the nodes that have it, in rising order."""
        ids: dict[LookupKey, list[int]] = {}
        for object_id, node in enumerate(self.objects):
            for key in lookup_keys(node):
                ids.setdefault(key, []).append(object_id)
        return ids


class NetworkBuilder:
    """Collects units from any number of files; copies of a unit are merged, and all their sources kept.

    Example:
        >>> builder = foon_asp.NetworkBuilder()
        >>> water, tea = foon_asp.parse_node("water"), foon_asp.parse_node("tea; hot")
        >>> builder.add("brew", [water], [tea], foon_asp.Source("by hand", 1))
        0
        >>> builder.build()
        <Network: 1 unit, 2 object nodes, level 3>
    """

    def __init__(self) -> None:
        self._object_ids: dict[ObjectNode, int] = {}
        self._unit_ids: dict[UnitKey, int] = {}
        self._motions: list[str] = []
        self._inputs: list[tuple[int, ...]] = []
        self._outputs: list[tuple[int, ...]] = []
        self._sources: list[list[Source]] = []

    def add(
        self, motion: str, inputs: Iterable[ObjectNode], outputs: Iterable[ObjectNode], *sources: Source
    ) -> int:
        """Add a unit, and return its id. If it was added before, only the sources are added to it.

        Parameters:
            motion: The label of the motion.
            inputs: The object nodes that the unit needs.
            outputs: The object nodes that the unit makes.
            sources: Where the unit was read; several places stand for several copies.
        """
        ids = self._object_ids
        # dict.fromkeys: a node that one unit lists twice is one input, in the place of its first mention
        input_ids = tuple(dict.fromkeys([ids.setdefault(node, len(ids)) for node in inputs]))
        output_ids = tuple(dict.fromkeys([ids.setdefault(node, len(ids)) for node in outputs]))
        key = (motion, frozenset(input_ids), frozenset(output_ids))
        unit_id = self._unit_ids.setdefault(key, len(self._motions))
        if unit_id == len(self._motions):
            self._motions.append(motion)
            self._inputs.append(input_ids)
            self._outputs.append(output_ids)
            self._sources.append([*sources])
        else:
            self._sources[unit_id] += sources
        return unit_id

    def build(self) -> Network:
        """Return a network of level 3 with the units that were added so far."""
        return Network(
            tuple(self._object_ids),
            tuple(self._motions),
            tuple(self._inputs),
            tuple(self._outputs),
            tuple(map(tuple, self._sources)),
            dict(self._object_ids),
            dict(self._unit_ids),
        )


def _lists_containing(lists: Sequence[Sequence[int]], size: int) -> tuple[tuple[int, ...], ...]:
    """Return for each number below ``size`` the indices of the lists that contain it, in rising order."""
    owners: list[list[int]] = [[] for _ in range(size)]
    for owner, members in enumerate(lists):
        for member in members:
            owners[member].append(owner)
    return tuple(map(tuple, owners))
