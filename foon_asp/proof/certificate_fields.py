"""The fields of a certificate: JSON lists, ids, names and fractions, refused unless they are well-formed."""

import re
from collections.abc import Container, Sequence
from fractions import Fraction
from typing import Any

from foon_asp.network import Network
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import LimitError, require

_RATIONAL = re.compile(r"-?(0|[1-9]\d*)(/[1-9]\d*)?", re.ASCII)
_SURROGATE = re.compile("[\ud800-\udfff]")


def read_object(value: Any, keys: Sequence[str] | None = None) -> dict[str, Any]:
    """Return a value; refuse it unless it is a JSON object with exactly these keys.

    If ``keys`` is ``None``, the object may have any keys.
    """
    require(isinstance(value, dict), "expected an object")
    content: dict[str, Any] = value
    require(keys is None or set(content) == set(keys), f"expected the keys {', '.join(keys or ())}")
    return content


def read_list(value: Any) -> list[Any]:
    """Return a value; refuse it unless it is a JSON list."""
    require(isinstance(value, list), "expected a list")
    items: list[Any] = value
    return items


def read_pair(value: Any, what: str) -> tuple[Any, Any]:
    """Return the two entries of a list; refuse other values; ``what`` names the list in the error."""
    require(isinstance(value, list) and len(value) == 2, f"expected {what}")
    first, second = value
    return first, second


def read_number(value: Any, allowed: Container[int], what: str) -> int:
    """Return a whole number; refuse values that are not ``allowed``; ``what`` names it in the error.

    JSON's ``true`` is no number.
    """
    require(type(value) is int and value in allowed, f"expected {what}")
    return int(value)


def read_numbers(value: Any, below: int, ascending: bool = True) -> list[int]:
    """Return a list of numbers; refuse it unless they are distinct and from 0 to ``below - 1``.

    With ``ascending``, refuse a list that is empty or not ascending, too.
    """
    numbers = read_list(value)
    require(all(type(n) is int and 0 <= n < below for n in numbers), "expected ids of the network")
    require(len(set(numbers)) == len(numbers), "an id stands twice")
    require(not ascending or (numbers == sorted(numbers) and len(numbers) > 0), "expected ids in order")
    return numbers


def read_names(value: Any) -> tuple[str, ...]:
    """Return a list of texts as a tuple; refuse it unless they are sorted and different.

    Texts with surrogates (half letters) are refused, too.
    """
    names = read_list(value)
    require(all(isinstance(name, str) for name in names), "expected names")
    require(names == sorted(set(names)), "expected names in order, each of them once")
    require(not any(map(_SURROGATE.search, names)), "a name has half of a letter (a surrogate)")
    return tuple(names)


def read_goal(value: Any, network: Network) -> int:
    """Return the id of a goal from an object with its id and text; refuse it unless these agree."""
    goal = read_object(value, ("id", "node"))
    (node,) = read_numbers([goal["id"]], len(network.objects))
    require(str(network.objects[node]) == goal["node"], "a goal is not the node of its id")
    return node


def read_rational(value: Any) -> Fraction:
    """Return the fraction that a text such as ``3/2`` or ``-7`` stands for; refuse other values.

    The text has to be in lowest terms.
    """
    require(isinstance(value, str) and bool(_RATIONAL.fullmatch(value)), "expected a number such as 3/2")
    if len(value) > ALLOWED.digits:
        raise LimitError(f"a fraction has more than {ALLOWED.digits:,} digits")
    number = Fraction(value)
    require(str(number) == value, "expected a fraction in lowest terms")
    return number
