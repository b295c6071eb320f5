"""The kitchen: the object nodes available from the start."""

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property


class Kitchen(Collection[int]):
    """The available object nodes, by id in the whole network: a ``base`` with nodes added and removed.

    A node that is both added and removed is not available. A base in a store is read on access.
    """

    def __init__(self, base: Collection[int], added: Iterable[int] = (), removed: Iterable[int] = ()) -> None:
        self._base, self._added, self._removed = base, frozenset(added), frozenset(removed)

    def with_changes(self, added: Collection[int], removed: Collection[int]) -> "Kitchen":
        """Return this kitchen with further nodes added and removed.

        A node that was removed before can be added again, and a node that was added can be removed. If
        ``added`` and ``removed`` are empty, return this kitchen itself.
        """
        return Kitchen(self, added, removed) if added or removed else self

    def is_exactly(self, base: Collection[int] | None) -> bool:
        """Whether the kitchen has the very object ``base`` as its base, without added or removed nodes."""
        return self._base is base and not self._added and not self._removed

    def __contains__(self, o: object) -> bool:
        return o not in self._removed and (o in self._added or o in self._base)

    def __iter__(self) -> Iterator[int]:
        return iter(self.ids)

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def ids(self) -> frozenset[int]:
        """The ids of all nodes of the kitchen."""
        base = self._base.ids if isinstance(self._base, Kitchen) else frozenset(self._base)
        return base.union(self._added).difference(self._removed) if self._added or self._removed else base
