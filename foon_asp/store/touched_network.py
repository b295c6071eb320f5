"""The whole network of a store, of which no more is read than is looked at."""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar, overload

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


class TouchedNetwork(Network):
    """The whole network of a store; looked at one by one, units and nodes are read one by one."""

    _store: Store

    def __init__(self, store: Store) -> None:
        units, objects = store.units, store.objects
        sides: list[Any] = [
            _Each(units, lambda unit, part=part: store.unit_parts(unit)[part])  # type: ignore[misc]
            for part in range(4)
        ]
        nodes: Any = _Each(objects, store.node)
        super().__init__(nodes, sides[0], sides[1], sides[2], sides[3], {}, {})
        producers: Any = _Each(objects, store.producers)
        motions = frozenset(motion for motion, _ in store.motion_sources())
        # the class is frozen, and would work these out of everything
        self.__dict__.update(_store=store, producers=producers, different_motions=motions)

    def object_id(self, node: ObjectNode) -> int | None:
        """Give the id of a node, or ``None`` if the network does not have it."""
        return self._store.object_id(node)

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Give the id of a unit, or ``None`` if the network does not have it."""
        return self._store.unit_id(unit)
