"""The ids of a kitchen in a store, as a collection that is not in memory."""

from collections.abc import Callable, Collection, Iterator

from foon_asp.store.store import Store


class StoredIds(Collection[int]):
    """The ids of the nodes in the kitchen of a store, or in its starting kitchen; read on access.

    ``column`` is ``"kitchen"`` or ``"starting"``.
    """

    def __init__(self, store: Store, column: str) -> None:
        self._store, self._column = store, column
        self._has: Callable[[int], bool] = store.in_kitchen if column == "kitchen" else store.is_starting

    def __contains__(self, o: object) -> bool:
        return isinstance(o, int) and 0 <= o < self._store.object_count and self._has(o)

    def __iter__(self) -> Iterator[int]:
        return iter(self._store.nodes_where(self._column))

    def __len__(self) -> int:
        return len(self._store.nodes_where(self._column))
