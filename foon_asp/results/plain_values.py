"""Plain values, as JSON can hold them: dictionaries, lists, texts and numbers."""

from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from pathlib import PurePath
from typing import Any, TypeVar

import msgspec

from foon_asp.json_layout import Json
from foon_asp.problem import Costs, Objective, OptionalData

T = TypeVar("T")


def plain(value: object) -> Any:
    """Return a value as dictionaries, lists, texts and numbers, in the order in which JSON has them.

    A fraction is ``{"exact": "27/1250", "approx": 0.0216}``; for one beyond the largest float, ``approx`` is
    ``None``.
    """
    return msgspec.to_builtins(value, enc_hook=_encode)


def _encode(value: object) -> object:
    """Return a fraction, costs, an objective or a path as a value that JSON can hold.

    Raises :class:`TypeError` for any other value.
    """
    if isinstance(value, Fraction):
        return {"exact": fraction_text(value), "approx": nearest_float(value)}
    if isinstance(value, Costs):
        return costs_plain(value)
    if isinstance(value, str | PurePath):
        return str(value)
    raise TypeError(f"found {type(value).__name__}, which JSON cannot hold")


def costs_plain(costs: Costs) -> Json:
    """Return the costs of a tree as plain values by the name of the objective.

    The number of ingredients is a further entry. An unknown cost is ``None``.
    """
    values: Json = plain(costs_by_name(costs))
    return values


def costs_by_name(costs: Costs) -> dict[str, int | Fraction | None]:
    """Return the costs of a tree by the name of the objective, as exact numbers.

    The number of ``ingredients`` is a further entry. An unknown cost is ``None``. ``dissimilarity`` is left
    out in costs without stand-ins.
    """
    usual = (objective for objective in Objective if objective.row.needs is not OptionalData.STAND_INS)
    measures = {**dict.fromkeys(usual), **costs.measures}
    return {**exact_measures(measures), "ingredients": costs.ingredients}


def exact_measures(
    measures: Mapping[Objective, int | Fraction | None],
) -> dict[str, int | Fraction | None]:
    """Return measures by the name of the objective.

    A measure is an integer if all values of the objective are whole numbers; otherwise it is a fraction.
    ``None`` stays ``None``.
    """
    return {
        str(objective): None
        if measure is None
        else int(measure)
        if objective.row.whole
        else Fraction(measure)
        for objective, measure in measures.items()
    }


def read_plain(kind: type[T], value: Json) -> T:
    """Return the value of class ``kind`` from its plain form; this is the inverse of :func:`plain`.

    Keys of dictionaries stay texts. For a wrong form, raises :class:`msgspec.ValidationError` (a
    :class:`ValueError`), :class:`KeyError`, :class:`TypeError`, :class:`AttributeError` or
    :class:`ArithmeticError`.
    """
    return msgspec.convert(value, kind, dec_hook=_decode)


def _decode(kind: type, value: Any) -> Objective | Fraction | int:
    """Return the objective (if ``kind`` is its class) or else the fraction that a plain form stands for.

    A value that is an objective or an integer already is returned as it is.
    """
    if isinstance(value, Objective) or type(value) is int:
        return value
    if kind is Objective:
        return Objective(value)
    return Fraction(*map(int, value["exact"].split("/")))  # without exponents: those stand for many digits


def fraction_text(value: Fraction) -> str:
    """Return an exact number as text, ``27/1250`` or ``3``, with all its digits."""
    # through Decimal: products of long rates have more digits than Python turns into text at once
    parts = [str(Decimal(n)) for n in (value.numerator, value.denominator)]
    return "/".join(parts) if value.denominator != 1 else parts[0]


def nearest_float(value: Fraction) -> float | None:
    """Return the nearest float; ``None`` for a number beyond the largest float."""
    try:
        return float(value)
    except OverflowError:
        return None
