"""The object nodes at hand."""

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property


class Kitchen(Collection[int]):
    """The object nodes at hand, by id in the whole network: those of a ``base``, some more, and some less.

    Of a store, the base is read as far as it is looked at.
    """

    def __init__(self, base: Collection[int], more: Iterable[int] = (), less: Iterable[int] = ()) -> None:
        self._base, self._more, self._less = base, frozenset(more), frozenset(less)

    def changed(self, more: Collection[int], less: Collection[int]) -> "Kitchen":
        """Return a kitchen that has some nodes more and some less."""
        return Kitchen(self, more, less) if more or less else self

    def is_all_of(self, base: Collection[int] | None) -> bool:
        """Whether it is a base without changes."""
        return self._base is base and not self._more and not self._less

    def __contains__(self, o: object) -> bool:
        return o not in self._less and (o in self._more or o in self._base)

    def __iter__(self) -> Iterator[int]:
        return iter(self.ids)

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def ids(self) -> frozenset[int]:
        """All of them."""
        base = self._base.ids if isinstance(self._base, Kitchen) else frozenset(self._base)
        return base.union(self._more).difference(self._less) if self._more or self._less else base
