"""What terms come to in whole numbers of any size, where clingo's have 32 bits."""

from collections.abc import Callable, Sequence
from typing import Final

LARGEST: Final = 2**31 - 2  # clingo adds 1 to a bound: with 2^31 - 1 a condition would be dropped


class _BeyondError(Exception):
    """A number is none of clingo's."""


def _divided(a: int, b: int) -> int:
    """Divide as clingo does: towards 0."""
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


def _power(a: int, b: int) -> int:
    if b < 0 and a:
        raise _BeyondError  # for clingo 2**(-1) is 0, and so is 1**(-1)
    power: int = a ** (b if abs(a) < 2 else min(b, 32))
    return power


_TWO: Final[dict[str, Callable[[int, int], int]]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divided,
    "\\": lambda a, b: a - b * _divided(a, b),
    "**": _power,
    "&": lambda a, b: a & b,
    "?": lambda a, b: a | b,
    "^": lambda a, b: a ^ b,
}
_ONE: Final[dict[str, Callable[[int], int]]] = {"neg": lambda a: -a, "abs": abs, "~": lambda a: ~a}


def is_beyond(text: str, values: Sequence[int]) -> bool:
    """Whether a term has no exact value among clingo's numbers, or something on the way to it has none.

    The text has the places of values, and operators behind what they are applied to: ``0 1 + 0 *``.
    """
    known: list[int] = []
    try:
        for word in text.split():
            if word in _TWO:
                b = known.pop()
                found = _TWO[word](known.pop(), b)
            else:
                found = _ONE[word](known.pop()) if word in _ONE else values[int(word)]
            if abs(found) > LARGEST:
                return True
            known.append(found)
    except _BeyondError:
        return True
    except ZeroDivisionError:  # clingo says so
        return False
    return False
