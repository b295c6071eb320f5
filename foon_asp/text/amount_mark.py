"""Amounts in FOON text: comment lines under object lines, ``# Amount:⇥2``, which other programs skip."""

from foon_asp.network import MAX_AMOUNT
from foon_asp.text.line import LineError, is_number

_MARK = "# Amount:"
EXPECTED_AMOUNT = f"a whole number from 1 to {MAX_AMOUNT}"
"""The description of an amount in messages."""


def is_amount(comment: str) -> bool:
    """Whether a comment line begins with ``# Amount:``, even if no amount follows."""
    return comment.startswith(_MARK)


def read_amount(comment: str) -> int:
    """Return the amount in a comment line for which :func:`is_amount` is true: 2 for ``# Amount:⇥2``.

    Blanks around the amount are ignored. Raises :class:`LineError` if anything else follows the colon.
    """
    written = comment[len(_MARK) :].strip()
    return parse_amount(written, len(_MARK) + 1 + comment[len(_MARK) :].find(written))


def parse_amount(written: str, column: int) -> int:
    """Return the amount that digits state, from 1 to 1,000,000 (``MAX_AMOUNT``).

    Raises :class:`LineError` for any other text. ``column`` is where ``written`` begins in its line.
    """
    if not is_number(written) or len(written) > len(str(MAX_AMOUNT)) or not 1 <= int(written) <= MAX_AMOUNT:
        raise LineError(column, f"the amount {written[:40]!r}", (EXPECTED_AMOUNT,))
    return int(written)


def write_amount(amount: int) -> str:
    """Return the comment line that states an amount, with its line end: ``# Amount:⇥2``."""
    return f"{_MARK}\t{amount}\n"
