"""Amounts: how many copies of each object node a unit takes and makes."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.object_node import ObjectNode


class UnitAmounts(NamedTuple):
    """How many copies a unit takes of its inputs and makes of its outputs; 1 of a node that is not listed."""

    inputs: Mapping[ObjectNode, int] = MappingProxyType({})
    outputs: Mapping[ObjectNode, int] = MappingProxyType({})

    def __bool__(self) -> bool:
        """Whether any amount is listed."""
        return bool(self.inputs or self.outputs)


ALL_ONE = UnitAmounts()
"""The amounts of a unit that takes and makes one copy of each node."""

Amounts = Mapping[FunctionalUnit, UnitAmounts]
"""The amounts of units; of a unit that is not in it, all amounts are 1."""


class DataAmounts(NamedTuple):
    """The amounts of units. ``conflict`` is a message about contradictory amounts, or empty."""

    units: Amounts
    conflict: str = ""


NO_AMOUNTS = DataAmounts({})
"""Amounts that are all 1."""

MAX_AMOUNT = 1_000_000
"""The greatest amount of an object node in a unit, a kitchen or a goal."""
