"""Figures as text: the costs of trees, bounds, and success rates in a few digits."""

from collections.abc import Iterable, Sequence
from decimal import Context, Decimal, Inexact
from fractions import Fraction

from foon_asp.network import counted
from foon_asp.problem import Costs, Objective, multiplies
from foon_asp.results.plain_values import nearest_float


def figure_text(objective: Objective, figure: int | Fraction) -> str:
    """Return a value by an objective as text.

    Success has four digits (:func:`success_text`). Another value is exact if 15 digits are enough for it;
    else it has four digits behind ``≈``.
    """
    if multiplies(objective):
        return success_text(Fraction(figure))
    if objective.row.whole:
        return str(figure)
    context = Context(prec=15)
    exact = context.divide(*map(Decimal, Fraction(figure).as_integer_ratio()))
    if context.flags[Inexact]:
        return f"≈ {_four_digits(Fraction(figure))}"
    return f"{exact if exact.adjusted() < 15 else exact.normalize(context):g}"


def bound_text(objective: Objective, bound: int | Fraction) -> str:
    """Return a bound in words: ``units at least 3``, ``success at most 0.5``."""
    direction = "at most" if multiplies(objective) else "at least"
    return f"{objective} {direction} {figure_text(objective, bound)}"


def costs_text(costs: Costs, objectives: Iterable[Objective] = ()) -> str:
    """Return the costs of a tree by units, inputs, success if known, and ``objectives``.

    The text is like ``2 units, 6 inputs, success 0.644``.
    """
    text = f"{counted(costs.units, 'unit')}, {counted(costs.inputs, 'input')}"
    listed = {Objective.UNITS, Objective.INPUTS}
    usual = [Objective.SUCCESS] if costs.success is not None else []
    for objective in dict.fromkeys((*usual, *objectives)):
        if objective not in listed:
            text += f", {objective} {figure_text(objective, costs.measure(objective))}"
    return text


def success_text(success: Fraction) -> str:
    """Return a success rate in four significant digits, behind ``≈`` if it is rounded.

    A rate that would be rounded to 1 is shown by its distance from 1: ``≈ 1 - 0.0001``.
    """
    shown = _four_digits(success)
    if success < 1 and Fraction(shown) == 1:
        return f"≈ 1 - {_four_digits(1 - success)}"
    return shown if Fraction(shown) == success else f"≈ {shown}"


def _four_digits(value: Fraction) -> str:
    """Return a number rounded to four significant digits, also beyond the range of floats."""
    approx = nearest_float(value)
    if approx is None or (value and not approx):  # there are numbers below the least float, and above all
        return f"{Decimal(value.numerator) / Decimal(value.denominator):.4g}"
    return f"{approx:.4g}"


def success_texts(values: Sequence[Fraction]) -> list[str]:
    """Return success rates as texts, with enough digits that different rates have different texts.

    All have the same number of significant digits: the least from 4 to 40 that is enough. ``≈`` stands before
    a rounded rate.
    """
    digits = 4
    while digits < 40 and len({_round_to_digits(v, digits) for v in values}) < len(set(values)):
        digits += 1
    shown = {value: _round_to_digits(value, digits) for value in values}
    return [f"{shown[v]:g}" if Fraction(shown[v]) == v else f"≈ {shown[v]:g}" for v in values]


def _round_to_digits(value: Fraction, digits: int) -> Decimal:
    """Return a number rounded to ``digits`` significant digits."""
    return Context(prec=digits).divide(Decimal(value.numerator), Decimal(value.denominator))
