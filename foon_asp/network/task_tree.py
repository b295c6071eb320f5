"""Task trees: units in the order in which they are listed."""

from collections.abc import Iterator
from dataclasses import dataclass

from foon_asp.network.functional_unit import FunctionalUnit


@dataclass(frozen=True, slots=True)
class TaskTree:
    """Functional ``units`` in a listed order, which may or may not execute; see :func:`foon_asp.check`.

    Example:
        >>> tree = foon_asp.TaskTree(tuple(foon_asp.solve(foon_asp.load().problem("ice")).tree))
        >>> len(tree), [unit.motion for unit in tree]
        (2, ['twist', 'crush'])
    """

    units: tuple[FunctionalUnit, ...]

    def __iter__(self) -> Iterator[FunctionalUnit]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)

    def __getitem__(self, position: int) -> FunctionalUnit:
        return self.units[position]
