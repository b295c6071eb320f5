"""Amounts in FOON text: a comment line under an object line, ``# Amount:⇥2``, which other readers skip."""

from foon_asp.network import MAX_AMOUNT
from foon_asp.text.line import LineError, is_number

_MARK = "# Amount:"
EXPECTED_AMOUNT = f"a whole number from 1 to {MAX_AMOUNT}"
"""What an amount is, for messages."""


def is_amount(comment: str) -> bool:
    """Whether a comment line is meant to state an amount."""
    return comment.startswith(_MARK)


def read_amount(comment: str) -> int:
    """Return the amount that a comment line states; raises :class:`LineError` for any other text."""
    written = comment[len(_MARK) :].strip()
    return parse_amount(written, len(_MARK) + 1 + comment[len(_MARK) :].find(written))


def parse_amount(written: str, column: int) -> int:
    """Return the number of a written amount; raises :class:`LineError` at ``column`` for any other text."""
    if not is_number(written) or len(written) > len(str(MAX_AMOUNT)) or not 1 <= int(written) <= MAX_AMOUNT:
        raise LineError(column, f"the amount {written[:40]!r}", (EXPECTED_AMOUNT,))
    return int(written)


def write_amount(amount: int) -> str:
    """Return the comment line, with its line end, that :func:`read_amount` reads."""
    return f"{_MARK}\t{amount}\n"
