"""The starting kitchen: the object nodes assumed to be available where no kitchen is given."""

from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Collection, Hashable, Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from foon_asp.network.network import Network
from foon_asp.network.source import Source

File = TypeVar("File", bound=Hashable)

STARTING = Path("@starting")
"""Stands for the starting kitchen, in place of a file."""


def is_starting(kitchen: object) -> bool:
    """Whether a kitchen is the starting one: none is given (``None``), or ``@starting`` is in its place."""
    return kitchen is None or (isinstance(kitchen, Path | str) and str(kitchen) == str(STARTING))


class RecipeKitchen(NamedTuple):
    """The starting kitchen of one file, as ids of object nodes.

    A ``raw`` node is one that no unit of the file makes, except units that need the node themselves. A
    ``granted`` node is one that a unit makes, but that is assumed to be available so that all units can
    execute.
    """

    raw: list[int]
    granted: list[int]


def recipe_kitchen(
    units: Iterable[tuple[Sequence[int], Sequence[int]]], goals: Collection[int] = ()
) -> RecipeKitchen:
    """Return the starting kitchen of one file, in time linear in its size.

    ``units`` has the inputs and the outputs of each unit, in the order of the file. They are ids of object
    nodes, as ``goals`` are. Inputs are not used up.

    Raw nodes are available. Then units execute as far as they can. When none can, the first unit in the file
    that lacks inputs is granted what it lacks, except ``goals``. This repeats until only goals are lacking.
    Then goals are granted in the same way, for example if two goals need each other.
    """
    unit_sides = list(units)
    missing = [len(inputs) for inputs, _ in unit_sides]  # by unit: how many inputs are not available yet
    consumers: defaultdict[int, list[int]] = defaultdict(list)
    made: set[int] = set()
    for unit, (inputs, outputs) in enumerate(unit_sides):
        for o in inputs:
            consumers[o].append(unit)
        made.update(o for o in outputs if o not in inputs)
    available: set[int] = set()

    def add(nodes: Iterable[int]) -> None:
        """Make nodes available, and also all outputs of the units that can execute with them."""
        stack = list(nodes)
        while stack:
            o = stack.pop()
            if o in available:
                continue
            available.add(o)
            for unit in consumers.get(o, ()):
                missing[unit] -= 1
                if not missing[unit]:
                    stack += unit_sides[unit][1]

    raw = [
        o for o in dict.fromkeys(o for unit in unit_sides for nodes in unit for o in nodes) if o not in made
    ]
    add(raw)
    add(o for inputs, outputs in unit_sides if not inputs for o in outputs)
    granted: list[int] = []
    for withheld in (goals, ()) if goals else ((),):
        for inputs, _ in unit_sides:
            for o in inputs:
                if o not in available and o not in withheld:
                    granted.append(o)
                    add((o,))
    return RecipeKitchen(raw, granted)


class StartingKitchen(ABC, Generic[File]):
    """The object nodes assumed to be available in a network: the union of the starting kitchens of its files.

    Because it is a union, merging files loses no goal and makes no optimum worse. Ids are those of the whole
    network.
    """

    @property
    @abstractmethod
    def nodes(self) -> Collection[int]:
        """The object nodes that are available, whatever the goals are."""

    @abstractmethod
    def makers(self, o: int) -> Sequence[int]:
        """Return the ids of the units that make a node and do not need it."""

    @abstractmethod
    def granting_files(self, o: int) -> Iterable[File]:
        """Return the files whose starting kitchen grants a node; see :class:`RecipeKitchen`."""

    @abstractmethod
    def files_of(self, units: Iterable[int]) -> Iterable[File]:
        """Return the files in which units were read, with repetitions."""

    @abstractmethod
    def units_of(self, file: File) -> Iterable[tuple[Sequence[int], Sequence[int]]]:
        """Return the inputs and the outputs of each unit of a file, in its order."""

    def changes_for_goals(self, goals: Iterable[int]) -> tuple[frozenset[int], frozenset[int]]:
        """Return the nodes that these goals add to the kitchen, and the nodes that they remove from it.

        A goal is removed if the units of one file can make it from nodes that are no goals. Other nodes of
        the file may be granted in its place. Added nodes may be in the kitchen already. A goal changes
        nothing if it is not in the kitchen, or if no unit makes it without needing it.
        """
        goals = [goal for goal in goals if goal in self.nodes and self.makers(goal)]
        kitchens = {
            file: self._nodes_of_file(file, goals) for goal in goals for file in self.granting_files(goal)
        }
        added = {o for kitchen in kitchens.values() for o in kitchen}
        removed = set()
        for goal in goals:
            for file in self.files_of(self.makers(goal)):
                if file not in kitchens:
                    kitchens[file] = self._nodes_of_file(file, goals)
                if kitchens[file].isdisjoint(goals):  # this file alone makes it from the others
                    removed.add(goal)
                    break
        return frozenset(added - removed), frozenset(removed)

    def _nodes_of_file(self, file: File, goals: Collection[int]) -> set[int]:
        """Return the nodes of the starting kitchen of one file for these goals."""
        raw, granted = recipe_kitchen(self.units_of(file), goals)
        return {*raw, *granted}


class NetworkStartingKitchen(StartingKitchen[str]):
    """The starting kitchen of a network in memory. Units without a source count as one file, named ``""``."""

    def __init__(self, network: Network) -> None:
        """Compute the starting kitchen of every file."""
        self._network = network
        self._files: dict[str, list[int]] = {}
        for unit, sources in enumerate(network.sources):
            for file in _files_of_sources(sources):
                self._files.setdefault(file, []).append(unit)
        self._granting: dict[int, list[str]] = {}
        nodes: set[int] = set()
        for file, units in self._files.items():
            units.sort(key=lambda unit, file=file: _first_position(network, unit, file))  # type: ignore[misc]
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
    def made_by_units(self) -> frozenset[int]:
        """The nodes of the kitchen that a unit makes and does not need."""
        return frozenset(filter(self.makers, self.nodes))

    @property
    def file_count(self) -> int:
        """The number of files in which units were read."""
        return len(self._files)

    def makers(self, o: int) -> list[int]:
        """Return the ids of the units that make a node and do not need it."""
        inputs = self._network.inputs
        return [unit for unit in self._network.producers[o] if o not in inputs[unit]]

    def granting_files(self, o: int) -> Sequence[str]:
        """Return the files whose starting kitchen grants a node; see :class:`RecipeKitchen`."""
        return self._granting.get(o, ())

    def files_of(self, units: Iterable[int]) -> Iterator[str]:
        """Yield the files in which units were read, with repetitions."""
        return (file for unit in units for file in _files_of_sources(self._network.sources[unit]))

    def units_of(self, file: str) -> Iterator[tuple[Sequence[int], Sequence[int]]]:
        """Yield the inputs and the outputs of each unit of a file, in its order."""
        network = self._network
        return ((network.inputs[unit], network.outputs[unit]) for unit in self._files[file])


def _files_of_sources(sources: Iterable[Source]) -> Iterable[str]:
    """Return the files of the sources of a unit, each once; a unit without a source has the file ``""``."""
    return dict.fromkeys(source.file for source in sources) or ("",)


def _first_position(network: Network, unit: int, file: str) -> tuple[int, int]:
    """Return the first line and column at which a file has a unit.

    A unit without a source has its id in place of the line.
    """
    return min(
        ((source.line, source.column) for source in network.sources[unit] if source.file == file),
        default=(unit, 0),
    )


@lru_cache(maxsize=4)  # successive questions are about one network
def starting_kitchen(network: Network) -> NetworkStartingKitchen:
    """Return the starting kitchen of a network; those of the last four networks are cached."""
    return NetworkStartingKitchen(network)


def starting_nodes(network: Network, goals: Collection[int] = ()) -> frozenset[int]:
    """Return the ids of the nodes of the starting kitchen for these goals."""
    kitchen = starting_kitchen(network)
    added, removed = kitchen.changes_for_goals(goals)
    return kitchen.nodes.union(added).difference(removed)
