"""The starting kitchen: what is assumed to be available where no kitchen is given."""

from abc import ABC, abstractmethod
from array import array
from collections.abc import Collection, Hashable, Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from itertools import accumulate
from typing import Generic, NamedTuple, TypeVar

from foon_asp.network.network import Network
from foon_asp.network.source import Source

File = TypeVar("File", bound=Hashable)


class RecipeKitchen(NamedTuple):
    """What makes all units of one file run: the nodes that no unit makes, and those ``granted`` with them."""

    raw: list[int]
    granted: list[int]


def recipe_kitchen(
    units: Iterable[tuple[Sequence[int], Sequence[int]]], goals: Collection[int] = ()
) -> RecipeKitchen:
    """Return the starting kitchen of one file; items last.

    ``units`` are the inputs and outputs of each in the order of the file, as ids of object nodes. Nodes
    that no unit makes out of others are available. Then units execute as far as they go; where they
    stop, the earliest unit in the file's order is granted what it lacks, but none of the ``goals``, and so
    on. A goal is granted only where goals are all that is lacking, which takes several goals that need each
    other. Linear in the size of the file.
    """
    places: dict[int, int] = {}
    inputs, input_counts, outputs, output_counts = sides = [array("I") for _ in range(4)]
    for of_unit in units:
        for flat, counts, listed in (
            (inputs, input_counts, of_unit[0]),
            (outputs, output_counts, of_unit[1]),
        ):
            flat.extend([places.setdefault(o, len(places)) for o in listed])
            counts.append(len(listed))
    withheld = {places[goal] for goal in goals if goal in places}
    ids = array("Q", places)
    found = _kitchen_of(_Units(len(ids), *sides), withheld)
    return RecipeKitchen([ids[o] for o in found.raw], [ids[o] for o in found.granted])


class _Units(NamedTuple):
    """The units of one file in its order, as flat lists: the inputs of all units, and how many each has."""

    node_count: int
    inputs: Sequence[int]
    input_counts: Sequence[int]
    outputs: Sequence[int]
    output_counts: Sequence[int]


def _kitchen_of(units: "_Units", goals: Collection[int]) -> RecipeKitchen:
    """Return the starting kitchen of units whose nodes are numbered from 0."""
    input_ends, output_ends = (
        array("q", accumulate(counts, initial=0)) for counts in (units.input_counts, units.output_counts)
    )
    unit_count = len(units.input_counts)
    waiting, starts = _consumers(units)
    available, made = bytearray(units.node_count), bytearray(units.node_count)
    missing = array("l", units.input_counts)

    def sides(unit: int) -> tuple[Sequence[int], Sequence[int]]:
        inputs = units.inputs[input_ends[unit] : input_ends[unit + 1]]
        return inputs, units.outputs[output_ends[unit] : output_ends[unit + 1]]

    for unit in range(unit_count):
        inputs, outputs = sides(unit)
        for o in outputs:
            if o not in inputs:
                made[o] = 1

    def add(nodes: Iterable[int]) -> None:
        """Make nodes available, and all that units make of them."""
        stack = list(nodes)
        while stack:
            o = stack.pop()
            if available[o]:
                continue
            available[o] = 1
            for place in range(starts[o], starts[o + 1]):
                unit = waiting[place]
                missing[unit] -= 1
                if not missing[unit]:
                    stack += units.outputs[output_ends[unit] : output_ends[unit + 1]]

    raw = [o for o in range(units.node_count) if not made[o]]
    add(raw)
    for unit in range(unit_count):
        if not units.input_counts[unit]:
            add(sides(unit)[1])
    granted: list[int] = []
    for withheld in (goals, ()) if goals else ((),):
        for o in units.inputs:
            if not available[o] and o not in withheld:
                granted.append(o)
                add((o,))
    return RecipeKitchen(raw, granted)


def _consumers(units: _Units) -> tuple[Sequence[int], Sequence[int]]:
    """Return the units that have each node as an input, node by node, and where those of each node begin."""
    starts = array("q", bytes(8 * (units.node_count + 1)))
    for o in units.inputs:
        starts[o + 1] += 1
    for o in range(units.node_count):
        starts[o + 1] += starts[o]
    consumers, free = array("l", bytes(array("l").itemsize * len(units.inputs))), starts[:]
    place = 0
    for unit, count in enumerate(units.input_counts):
        for o in units.inputs[place : place + count]:
            consumers[free[o]] = unit
            free[o] += 1
        place += count
    return consumers, starts


class StartingKitchen(ABC, Generic[File]):
    """What is assumed to be available in a network: the union over its files of what makes their units run.

    So merging files loses no goal, and makes no optimum worse. Ids are those of the whole network.
    """

    @property
    @abstractmethod
    def nodes(self) -> Collection[int]:
        """The object nodes that are available, whatever the goals are."""

    @abstractmethod
    def makers(self, o: int) -> Sequence[int]:
        """Return the units that make a node out of others."""

    @abstractmethod
    def granting(self, o: int) -> Iterable[File]:
        """Return the files that a node is granted though one of their units makes it."""

    @abstractmethod
    def files_of(self, units: Iterable[int]) -> Iterable[File]:
        """Return the files that units are from."""

    @abstractmethod
    def units_of(self, file: File) -> Iterable[tuple[Sequence[int], Sequence[int]]]:
        """Return the inputs and outputs of the units of a file, in its order."""

    def changes(self, goals: Iterable[int]) -> tuple[frozenset[int], frozenset[int]]:
        """Return what the kitchen has more, and what it lacks, because these are the goals.

        A goal is never assumed where a unit makes it.
        """
        goals = [goal for goal in goals if goal in self.nodes and self.makers(goal)]
        kitchens = {file: self._all_of(file, goals) for goal in goals for file in self.granting(goal)}
        added = {o for kitchen in kitchens.values() for o in kitchen}
        lacking = set()
        for goal in goals:
            for file in self.files_of(self.makers(goal)):
                if file not in kitchens:
                    kitchens[file] = self._all_of(file, goals)
                if kitchens[file].isdisjoint(goals):  # this file alone makes it from the others
                    lacking.add(goal)
                    break
        return frozenset(added - lacking), frozenset(lacking)

    def _all_of(self, file: File, goals: Collection[int]) -> set[int]:
        raw, granted = recipe_kitchen(self.units_of(file), goals)
        return {*raw, *granted}


class NetworkStartingKitchen(StartingKitchen[str]):
    """The starting kitchen of a network in memory. Units without a source are of one file."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._files: dict[str, list[int]] = {}
        for unit, sources in enumerate(network.sources):
            for file in _files(sources):
                self._files.setdefault(file, []).append(unit)
        self._granting: dict[int, list[str]] = {}
        nodes: set[int] = set()
        for file, units in self._files.items():
            units.sort(key=lambda unit, file=file: _place(network, unit, file))  # type: ignore[misc]
            raw, granted = recipe_kitchen(self.units_of(file))
            nodes.update(raw, granted)
            for o in granted:
                self._granting.setdefault(o, []).append(file)
        self._nodes = frozenset(nodes)

    @property
    def nodes(self) -> frozenset[int]:
        """The object nodes that are available, whatever the goals are."""
        return self._nodes

    @cached_property
    def made_too(self) -> frozenset[int]:
        """Those of them that a unit makes out of others."""
        return frozenset(filter(self.makers, self.nodes))

    @property
    def file_count(self) -> int:
        """How many files the units are from."""
        return len(self._files)

    def makers(self, o: int) -> list[int]:
        """Return the units that make a node out of others."""
        inputs = self._network.inputs
        return [unit for unit in self._network.producers[o] if o not in inputs[unit]]

    def granting(self, o: int) -> Sequence[str]:
        """Return the files that a node is granted though one of their units makes it."""
        return self._granting.get(o, ())

    def files_of(self, units: Iterable[int]) -> Iterator[str]:
        """Yield the files that units are from."""
        return (file for unit in units for file in _files(self._network.sources[unit]))

    def units_of(self, file: str) -> Iterator[tuple[Sequence[int], Sequence[int]]]:
        """Yield the inputs and outputs of the units of a file, in its order."""
        network = self._network
        return ((network.inputs[unit], network.outputs[unit]) for unit in self._files[file])


def _files(sources: Iterable[Source]) -> Iterable[str]:
    return dict.fromkeys(source.file for source in sources) or ("",)


def _place(network: Network, unit: int, file: str) -> tuple[int, int]:
    """Return the first line and column at which a file has a unit."""
    return min(
        ((source.line, source.column) for source in network.sources[unit] if source.file == file),
        default=(unit, 0),
    )


@lru_cache(maxsize=4)  # question after question is about the same network
def starting_kitchen(network: Network) -> NetworkStartingKitchen:
    """Return the starting kitchen of a network."""
    return NetworkStartingKitchen(network)


def starting_nodes(network: Network, goals: Collection[int] = ()) -> frozenset[int]:
    """Return the ids of the nodes of the starting kitchen where these are the goals."""
    kitchen = starting_kitchen(network)
    added, lacking = kitchen.changes(goals)
    return kitchen.nodes.union(added).difference(lacking)
