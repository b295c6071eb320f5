"""The whole network of a store, of which no more is read than is looked at."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self, TypeVar, overload

from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.store.store import Store

Value = TypeVar("Value")


class _Each(Sequence[Value]):
    """What each id has, which is read when it is asked for."""

    def __init__(self, size: int, read: Callable[[int], Value]) -> None:
        self._ids, self._read = range(size), read

    def __len__(self) -> int:
        return len(self._ids)

    @overload
    def __getitem__(self, place: int) -> Value: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[Value]: ...
    def __getitem__(self, place: int | slice) -> Value | Sequence[Value]:
        if isinstance(place, slice):
            return [self._read(number) for number in self._ids[place]]
        return self._read(self._ids[place])


def _each(size: int, read: Callable[[int], Value]) -> Any:  # in place of a tuple
    return _Each(size, read)


@dataclass(frozen=True, eq=False, repr=False)
class TouchedNetwork(Network):
    """The whole network of a store; looked at one by one, units and nodes are read one by one."""

    store: Store = field(kw_only=True)

    @classmethod
    def of(cls, store: Store) -> Self:
        """Return the network of a store."""
        nodes = _each(store.objects, store.node)
        motions, inputs, outputs, sources = [
            _each(store.units, lambda unit, part=part: store.unit_parts(unit)[part])  # type: ignore[misc]
            for part in range(4)
        ]
        return cls(nodes, motions, inputs, outputs, sources, {}, {}, store=store)

    @cached_property
    def producers(self) -> Any:
        """For each object node, the units that have it as an output, in order."""
        return _each(self.store.objects, self.store.producers)

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
