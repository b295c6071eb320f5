"""Values as plain ones, for JSON: dictionaries, lists, texts and numbers."""

from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from pathlib import PurePath
from typing import Any, TypeVar

import msgspec

from foon_asp.problem import Costs, Objective, OptionalData
from foon_asp.text.json_value import Json

T = TypeVar("T")


def plain(value: object) -> Any:
    """Return a value as dictionaries, lists, texts and numbers, in the order in which JSON has them.

    A fraction is ``{"exact": "27/1250", "approx": 0.0216}``; ``approx`` is ``None`` above all floats.
    """
    return msgspec.to_builtins(value, enc_hook=_plain)


def _plain(value: object) -> object:
    """Return a number, costs or a path as a value that JSON can hold."""
    if isinstance(value, Fraction):
        return {"exact": fraction_text(value), "approx": nearest_float(value)}
    if isinstance(value, Costs):
        return costs_plain(value)
    if isinstance(value, str | PurePath):
        return str(value)
    raise TypeError(f"found {type(value).__name__}, which JSON cannot hold")


def costs_plain(costs: Costs) -> Json:
    """Return the costs of a tree as plain values, by objective (``None`` if unknown), and its ingredients."""
    values: Json = plain(costs_by_name(costs))
    return values


def costs_by_name(costs: Costs) -> dict[str, int | Fraction | None]:
    """Return the costs of a tree by the name of the objective, as exact numbers; ``None`` if unknown.

    Costs without stand-ins have no dissimilarity.
    """
    usual = (objective for objective in Objective if objective.row.needs is not OptionalData.STAND_INS)
    measures = {**dict.fromkeys(usual), **costs.measures}
    return {**exact_measures(measures), "ingredients": costs.ingredients}


def exact_measures(
    measures: Mapping[Objective, int | Fraction | None],
) -> dict[str, int | Fraction | None]:
    """Return measures by objective name: integers, or fractions if the objective is not integral."""
    return {
        str(objective): None
        if measure is None
        else int(measure)
        if objective.row.whole
        else Fraction(measure)
        for objective, measure in measures.items()
    }


def read_plain(kind: type[T], value: Json) -> T:
    """Return the value of a kind from its plain form, the inverse of :func:`plain`.

    Keys of dictionaries stay texts. For a value of another form, raises :class:`msgspec.ValidationError`,
    which is a :class:`ValueError`, or :class:`KeyError`, :class:`TypeError`, :class:`AttributeError` or
    :class:`ArithmeticError`.
    """
    return msgspec.convert(value, kind, dec_hook=_exact)


def _exact(kind: type, value: Any) -> Objective | Fraction | int:
    """Return an objective, fraction or integer from its plain form."""
    if isinstance(value, Objective) or type(value) is int:
        return value
    if kind is Objective:
        return Objective(value)
    return Fraction(*map(int, value["exact"].split("/")))  # without exponents: those stand for many digits


def fraction_text(value: Fraction) -> str:
    """Return an exact number as a text, without a limit on its digits."""
    # through Decimal: products of long rates have more digits than Python turns into text at once
    parts = [str(Decimal(n)) for n in (value.numerator, value.denominator)]
    return "/".join(parts) if value.denominator != 1 else parts[0]


def nearest_float(value: Fraction) -> float | None:
    """Return the nearest float; ``None`` for a number above the largest float."""
    try:
        return float(value)
    except OverflowError:
        return None
