"""Task trees: units in the order in which they are listed."""

from collections.abc import Iterator
from dataclasses import dataclass

from foon_asp.network.functional_unit import FunctionalUnit


@dataclass(frozen=True, slots=True)
class TaskTree:
    """Functional units in a listed order; whether they execute is for ``foon_asp.proof`` to say."""

    units: tuple[FunctionalUnit, ...]

    def __iter__(self) -> Iterator[FunctionalUnit]:
        return iter(self.units)

    def __len__(self) -> int:
        return len(self.units)
