"""Prices that networks state of their own units."""

from collections.abc import Mapping
from fractions import Fraction

from foon_asp.network import FunctionalUnit, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity


class StatedPrices:
    """The prices of copies of units, as they come; ``len`` counts the units that have any."""

    def __init__(self) -> None:
        self._copies: dict[FunctionalUnit, dict[Fraction, Source]] = {}

    def __len__(self) -> int:
        return len(self._copies)

    def add(self, unit: FunctionalUnit, price: Fraction, source: Source) -> None:
        """Note the price of one copy, and where it is stated."""
        self._copies.setdefault(unit, {}).setdefault(price, source)

    def settled(self, chosen: Mapping[FunctionalUnit, Fraction]) -> dict[FunctionalUnit, Fraction]:
        """Give the one price of each unit; where copies disagree, it is the ``chosen`` one.

        Raises :class:`InputError` for copies that disagree where none is chosen.
        """
        errors: list[Diagnostic] = []
        found: dict[FunctionalUnit, Fraction] = {}
        for unit, prices in self._copies.items():
            (price, first), *others = prices.items()
            found[unit] = chosen.get(unit, price) if others else price
            if others and unit not in chosen:
                _, second = others[0]
                message = (
                    f"found a copy of the unit {unit.motion!r} of {first} with another price, expected one "
                    "price: choose one with a line for this unit in a file of prices (--unit-prices FILE)"
                )
                errors.append(Diagnostic(Severity.ERROR, "unit-price", message, second))
        if errors:
            raise InputError(errors)
        return found
