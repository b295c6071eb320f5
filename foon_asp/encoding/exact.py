"""Exact evaluation of arithmetic terms, to find values beyond clingo's integers of 32 bits."""

from collections.abc import Callable, Sequence
from typing import Final

from foon_asp.problem.number import INT32_MAX

LARGEST: Final = INT32_MAX - 1  # clingo adds 1 to a bound: with INT32_MAX a condition would be dropped


class _BeyondError(Exception):
    """A result that clingo cannot represent."""


def _divide(a: int, b: int) -> int:
    """Return ``a / b`` as clingo computes it, rounded towards 0."""
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


def _power(a: int, b: int) -> int:
    """Return ``a ** b``; a huge power is replaced by a smaller number that is beyond clingo's numbers, too.

    Raises :class:`_BeyondError` for a negative exponent, for which clingo returns wrong values. If ``a`` is
    0, a negative exponent raises ``ZeroDivisionError`` instead.
    """
    if b < 0 and a:
        raise _BeyondError  # for clingo 2**(-1) is 0, and so is 1**(-1)
    power: int = a ** (b if abs(a) < 2 else min(b, 32))
    return power


_BINARY: Final[dict[str, Callable[[int, int], int]]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divide,
    "\\": lambda a, b: a - b * _divide(a, b),
    "**": _power,
    "&": lambda a, b: a & b,
    "?": lambda a, b: a | b,
    "^": lambda a, b: a ^ b,
}
_UNARY: Final[dict[str, Callable[[int], int]]] = {"neg": lambda a: -a, "abs": abs, "~": lambda a: ~a}


def is_beyond(text: str, values: Sequence[int]) -> bool:
    """Whether the value of a term or of one of its subterms is outside clingo's numbers.

    ``text`` is the term in postfix notation, as in ``0 1 + 0 *``; a number in it is an index into ``values``.
    Negative exponents count as outside. Return ``False`` for a division by 0, which clingo reports itself.
    """
    stack: list[int] = []
    try:
        for word in text.split():
            if word in _BINARY:
                b = stack.pop()
                result = _BINARY[word](stack.pop(), b)
            else:
                result = _UNARY[word](stack.pop()) if word in _UNARY else values[int(word)]
            if abs(result) > LARGEST:
                return True
            stack.append(result)
    except _BeyondError:
        return True
    except ZeroDivisionError:  # reported by clingo
        return False
    return False
