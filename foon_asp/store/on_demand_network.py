"""The whole network of a store, whose units and nodes are read only when they are accessed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self, TypeVar, overload

from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.store.store import Store

Value = TypeVar("Value")


class _LazySequence(Sequence[Value]):
    """A sequence of ``size`` values; each access of a value calls ``read`` with its index."""

    def __init__(self, size: int, read: Callable[[int], Value]) -> None:
        self._ids, self._read = range(size), read

    def __len__(self) -> int:
        return len(self._ids)

    @overload
    def __getitem__(self, index: int) -> Value: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Value]: ...
    def __getitem__(self, index: int | slice) -> Value | Sequence[Value]:
        if isinstance(index, slice):
            return [self._read(number) for number in self._ids[index]]
        return self._read(self._ids[index])


def _read_on_access(size: int, read: Callable[[int], Value]) -> Any:
    """Return a lazy sequence, typed so that it can stand for a tuple."""
    return _LazySequence(size, read)


@dataclass(frozen=True, eq=False, repr=False)
class TouchedNetwork(Network):
    """The whole network of a store; each unit and node is read when it is accessed."""

    store: Store = field(kw_only=True)

    @classmethod
    def of(cls, store: Store) -> Self:
        """Return the network of a store."""
        nodes = _read_on_access(store.object_count, store.node)

        def part_reader(position: int) -> Callable[[int], Any]:
            """Return the function that reads one of the :meth:`~.Store.unit_parts` of a unit."""
            return lambda unit: store.unit_parts(unit)[position]

        motions, inputs, outputs, sources = [
            _read_on_access(store.unit_count, part_reader(position)) for position in range(4)
        ]
        return cls(nodes, motions, inputs, outputs, sources, {}, {}, store=store)

    @cached_property
    def producers(self) -> Any:
        """For each object node, the ids of the units that have it as an output, in order."""
        return _read_on_access(self.store.object_count, self.store.producers)

    @cached_property
    def different_motions(self) -> frozenset[str]:
        """The motions of the units, each once."""
        return frozenset(motion for motion, _ in self.store.motion_sources())

    def object_id(self, node: ObjectNode) -> int | None:
        """Return the id of a node, or ``None`` if the network does not have it."""
        return self.store.object_id(node)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit, or ``None`` if the network does not have it."""
        return self.store.unit_id(unit)
