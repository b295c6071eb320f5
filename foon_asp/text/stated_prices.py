"""Prices that networks state for their units."""

from collections.abc import Mapping
from fractions import Fraction

from foon_asp.network import FunctionalUnit, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity


class StatedPrices:
    """The prices that copies of units state."""

    def __init__(self) -> None:
        self._copies: dict[FunctionalUnit, dict[Fraction, Source]] = {}
        self._least: dict[FunctionalUnit, Fraction] = {}

    def __len__(self) -> int:
        """The number of units of which a copy states a price."""
        return len(self._copies.keys() | self._least.keys()) if self._copies else len(self._least)

    def add(self, unit: FunctionalUnit, price: Fraction, source: Source) -> None:
        """Record the price of one copy of a unit, and where it is stated; all such copies have to agree."""
        self._copies.setdefault(unit, {}).setdefault(price, source)

    def add_least(self, unit: FunctionalUnit, price: Fraction) -> None:
        """Record the price of one copy of a unit; the least price of all copies counts."""
        if self._least.setdefault(unit, price) > price:
            self._least[unit] = price

    def price_by_unit(self, chosen: Mapping[FunctionalUnit, Fraction]) -> dict[FunctionalUnit, Fraction]:
        """Return the price of each unit that was recorded.

        If a copy of the unit was recorded with :meth:`add_least`, this is the least price of all copies. If
        all copies have one price, it is this price. Otherwise, it is the ``chosen`` price.

        Raises :class:`InputError` if copies disagree and ``chosen`` has no price for the unit.
        """
        errors: list[Diagnostic] = []
        settled_prices = dict(self._least)
        for unit, prices in self._copies.items():
            (price, first_source), *others = prices.items()
            if unit in settled_prices:
                settled_prices[unit] = min(settled_prices[unit], *prices)
                continue
            settled_prices[unit] = chosen.get(unit, price) if others else price
            if others and unit not in chosen:
                _, second_source = others[0]
                message = (
                    f"found a copy of the unit {unit.motion!r} of {first_source} with another price, "
                    "expected one price: choose one with a line for this unit in a file of prices "
                    "(--unit-prices FILE)"
                )
                errors.append(Diagnostic(Severity.ERROR, "unit-price", message, second_source))
        if errors:
            raise InputError(errors)
        return settled_prices
