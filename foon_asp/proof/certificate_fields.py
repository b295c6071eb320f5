"""The fields of a certificate: JSON lists, ids, names and fractions.

A field that is not well-formed is *refused*: :class:`RefusedError` is raised.
"""

import re
from collections.abc import Container, Sequence
from fractions import Fraction
from typing import Any

from foon_asp.network import Network
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import CheckLimitError, require

_RATIONAL = re.compile(r"-?(0|[1-9]\d*)(/[1-9]\d*)?", re.ASCII)
_SURROGATE = re.compile("[\ud800-\udfff]")


def read_object(value: Any, keys: Sequence[str] | None = None) -> dict[str, Any]:
    """Return the value; raise :class:`RefusedError` unless it is a JSON object with exactly these keys.

    If ``keys`` is ``None``, the object may have any keys.
    """
    require(isinstance(value, dict), "expected an object")
    fields: dict[str, Any] = value
    require(keys is None or set(fields) == set(keys), f"expected the keys {', '.join(keys or ())}")
    return fields


def read_list(value: Any) -> list[Any]:
    """Return the value; raise :class:`RefusedError` unless it is a JSON list."""
    require(isinstance(value, list), "expected a list")
    items: list[Any] = value
    return items


def read_pair(value: Any, what: str) -> tuple[Any, Any]:
    """Return the two entries of a list; raise :class:`RefusedError` unless it has exactly two.

    ``what`` names the list in the error.
    """
    require(isinstance(value, list) and len(value) == 2, f"expected {what}")
    first, second = value
    return first, second


def read_number(value: Any, allowed: Container[int], what: str) -> int:
    """Return the value; raise :class:`RefusedError` unless it is a whole number in ``allowed``.

    JSON's ``true`` and ``false`` are no numbers. ``what`` names the value in the error.
    """
    require(type(value) is int and value in allowed, f"expected {what}")
    return int(value)


def read_numbers(value: Any, below: int, ascending: bool = True) -> list[int]:
    """Return a list of whole numbers; raise :class:`RefusedError` unless it is well-formed.

    The numbers have to be distinct and from 0 to ``below - 1``. With ``ascending``, they have to ascend, and
    the list must not be empty.
    """
    numbers = read_list(value)
    require(all(type(n) is int and 0 <= n < below for n in numbers), "expected ids of the network")
    require(len(set(numbers)) == len(numbers), "an id stands twice")
    require(not ascending or (numbers == sorted(numbers) and len(numbers) > 0), "expected ids in order")
    return numbers


def read_names(value: Any) -> tuple[str, ...]:
    """Return a list of texts as a tuple; raise :class:`RefusedError` unless they are sorted and distinct.

    Texts with surrogates (half letters) are refused. The list may be empty.
    """
    names = read_list(value)
    require(all(isinstance(name, str) for name in names), "expected names")
    require(names == sorted(set(names)), "expected names in order, each of them once")
    require(not any(map(_SURROGATE.search, names)), "a name has half of a letter (a surrogate)")
    return tuple(names)


def read_goal(value: Any, network: Network) -> int:
    """Return the id of a goal node, from an object such as ``{"id": 3, "node": "ice"}``.

    Raises :class:`RefusedError` unless the node of the network with this id has this text.
    """
    goal = read_object(value, ("id", "node"))
    (node,) = read_numbers([goal["id"]], len(network.objects))
    require(str(network.objects[node]) == goal["node"], "a goal is not the node of its id")
    return node


def read_rational(value: Any) -> Fraction:
    """Return the fraction that a text such as ``3/2`` or ``-7`` stands for.

    Raises :class:`RefusedError` for other values and for texts not in lowest terms. Raises
    :class:`CheckLimitError` for a text that is longer than :class:`CertificateLimits` allows.
    """
    require(isinstance(value, str) and bool(_RATIONAL.fullmatch(value)), "expected a number such as 3/2")
    if len(value) > ALLOWED.digits:
        raise CheckLimitError(f"a fraction has more than {ALLOWED.digits:,} digits")
    number = Fraction(value)
    require(str(number) == value, "expected a fraction in lowest terms")
    return number
