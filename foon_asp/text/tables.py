"""The kinds of tables beside a network, and how their rows are read."""

import re
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.text.exact_number import decimal_text, read_decimal
from foon_asp.text.line import LineError, NameKind
from foon_asp.text.line_parser import parse_name, parse_node
from foon_asp.text.plain_file import read_plain_text, split_lines
from foon_asp.text.reading import Reading
from foon_asp.text.text_units import TextUnits
from foon_asp.text.value_table import Table

_TIME_UNITS = {"": 1, "s": 1, "min": 60, "h": 3600}
_DURATION = "a number of seconds such as 90 or 1.5, or of minutes or hours such as 25 min"
_PRICE = re.compile(r"\d{1,9}(\.\d{1,6})?", re.ASCII)
_TOOLS = re.compile(r"[1-9]\d{0,5}", re.ASCII)
_COPIES = re.compile(r"\d+", re.ASCII)
_STAYS = {"stays": True, "used-up": False}
_OBJECT_LINE = re.compile(r"^(?:\ufeff)?O\d*[\t ]", re.MULTILINE)


class Duration(NamedTuple):
    """The duration of a motion in ``seconds``.

    A ``passive`` motion, such as baking, needs nobody to stand by.

    Example:
        >>> foon_asp.Duration(1500, passive=True).seconds
        1500
    """

    seconds: Fraction | int
    passive: bool = False


def motion_in_first_column(name: str, found: str) -> str:
    """Return ``name``, the motion in the first column of a row, unchanged.

    Raises :class:`LineError` for an empty name; ``found`` describes in the message what the next column has.
    """
    if not name:
        raise LineError(1, found, ("the motion before it",))
    return name


def stated_name(name: str) -> str | ObjectNode:
    """Return the name in the first column: a label, which means all nodes with it, or a single node.

    A label with a semicolon after it is the node without states, relations and contents. A text that is no
    notation is taken as a label, unless it has a semicolon or begins with a quote. Raises :class:`LineError`
    for such a text, and for an empty one.
    """
    name = name.strip()
    if not name:
        raise LineError(1, "nothing", ("a label or an object node",))
    try:
        return parse_name(name)
    except LineError:
        if ";" in name or name.startswith('"'):
            raise
        return name  # a label as it is


def _rate_row(name: str, value: str, column: int) -> tuple[str, Fraction]:
    """Return the motion of a row and its exact success rate, above 0 and at most 1.

    Raises :class:`LineError` at a fault.
    """
    motion = motion_in_first_column(name, "a success rate")
    rate = read_decimal(value, column, "a success rate as a decimal such as 0.85")
    if not 0 < rate <= 1:
        raise LineError(column, f"the success rate {value}", ("a rate above 0 and at most 1",))
    return motion, rate


def _duration_row(name: str, value: str, column: int) -> tuple[str, Duration]:
    """Return the motion of a row and its duration.

    The duration is passive if another tab and ``passive`` follow it. Raises :class:`LineError` at a fault.
    """
    motion = motion_in_first_column(name, "a duration")
    written, tab, word = value.partition("\t")
    if tab and word.strip() != "passive":
        raise LineError(column + len(written) + 1, repr(word), ("passive", "the end of the line"))
    return motion, Duration(_seconds(written.strip(), column), bool(tab))


def _seconds(written: str, column: int) -> Fraction:
    """Return the exact seconds of a duration such as ``90``, ``25 min`` or ``1.5 h``.

    Raises :class:`LineError` for another form, and for 0; ``column`` is that of ``written`` in its line.
    """
    number, _, unit = written.partition(" ")
    unit = unit.strip()
    if unit not in _TIME_UNITS:
        raise LineError(column + len(number) + 1, repr(unit), tuple(filter(None, _TIME_UNITS)))
    seconds = read_decimal(number, column, _DURATION) * _TIME_UNITS[unit]
    if not seconds:
        raise LineError(column, f"the duration {written}", ("one above 0",))
    return seconds


def _tool_row(name: str, value: str, column: int) -> tuple[str | ObjectNode, int | None]:
    """Return the tool of a row, as a label or a node, and the number of such tools.

    The number is from 1 to 999,999, or ``None`` for the word ``free``. Raises :class:`LineError` at a fault.
    """
    if value != "free" and not _TOOLS.fullmatch(value):
        raise LineError(column, repr(value), ("a number from 1", "free"))
    return stated_name(name), None if value == "free" else int(value)


def _stays_row(name: str, value: str, column: int) -> tuple[str | ObjectNode, bool]:
    """Return the item of a row, as a label or a node, and whether it stays.

    Raises :class:`LineError` at a fault.
    """
    if value not in _STAYS:
        raise LineError(column, repr(value), tuple(_STAYS))
    return stated_name(name), _STAYS[value]


def _copies_row(name: str, value: str, column: int) -> tuple[ObjectNode, int]:
    """Return the node of a row and how many copies of it there are, from 0 to 1,000,000.

    Raises :class:`LineError` at a fault.
    """
    max_copies = 1_000_000  # of a node; clingo's integers are limited
    if not _COPIES.fullmatch(value) or len(value) > len(str(max_copies)) or int(value) > max_copies:
        raise LineError(column, repr(value), (f"a number of copies, from 0 to {max_copies}",))
    return parse_node(name), int(value)


def _price_row(name: str, value: str, column: int) -> tuple[str | ObjectNode, Fraction]:
    """Return the item of a row, as a label or a node, and its exact price from 0.

    The price has up to nine digits before the point and six behind it. Raises :class:`LineError` at a fault.
    """
    if not _PRICE.fullmatch(value):
        raise LineError(column, repr(value[:40]), ("a price as a decimal such as 1.99",))
    return parse_name(name), Fraction(value)


def _label_row(name: str, _: str, __: int) -> tuple[str, None]:
    """Return the label of a row, which has no value."""
    return name, None


RATES = Table("rate", NameKind.MOTION, "a success rate", _rate_row, "a second success rate for {name!r}")
"""``motion⇥0.85``: success rates of motions, decimals above 0 and at most 1, kept exactly."""

DURATIONS = Table(
    "duration", NameKind.MOTION, "a number of seconds", _duration_row, "a second duration for {name!r}"
)
"""``motion⇥90`` and ``motion⇥25 min⇥passive``: durations of motions, above 0, kept exactly."""

TOOLS = Table(
    "tool", NameKind.OBJECT, "a number from 1, or free,", _tool_row, "{value}, and something else above"
)
"""``NAME⇥2`` and ``NAME⇥free``: how many there are of tools and vessels; ``None`` is for what is free."""

STAYS = Table("stays", NameKind.OBJECT, "stays or used-up", _stays_row, "{value}, and the opposite above")
"""``NAME⇥stays`` and ``NAME⇥used-up``: of items that are used up, which of them stay."""

STOCK = Table("stock", NameKind.OBJECT, "a number of copies", _copies_row, "a second count for {name!r}")
"""``NODE⇥12``: how many copies of an object node there are."""

PRICES = Table("price", NameKind.OBJECT, "a price", _price_row, "a second price for {name!r}")
"""``NAME⇥1.99``: prices of things to buy, with up to nine digits before the point and six behind it."""

UTENSILS = Table("utensil", NameKind.OBJECT, "", _label_row)
"""``LABEL``: labels of utensils, one on each line."""


def read_utensils(file: Path) -> frozenset[str]:
    """Return the labels of utensils in a file, which has one on each line."""
    return frozenset(UTENSILS.read(file))


def read_stock(file: Path) -> dict[ObjectNode, int]:
    """Return the number of copies of each node in a table, or in FOON text if the file has an object line.

    In FOON text, an object block states its amount of copies, or else one copy. Copies of equal nodes are
    added up. Raises :class:`InputError` for a line of another form. It is also raised for a node with two
    different counts in a table.
    """
    text = "\n".join(split_lines(read_plain_text(file)))
    if not _OBJECT_LINE.search(text):
        return STOCK.read(file)
    reading = Reading()
    blocks = TextUnits([text], str(file), reading).objects()
    reading.raise_errors()
    copies: dict[ObjectNode, int] = {}
    for block in blocks:
        copies[block.node] = copies.get(block.node, 0) + (block.amount or 1)
    return copies


def read_default_duration(written: str) -> Fraction:
    """Return the seconds of the default duration, written as ``90``, ``25 min`` or ``1.5 h``.

    Raises :class:`UserError` for another form, and for 0.
    """
    try:
        return _seconds(written.strip(), 1)
    except LineError as error:
        raise UserError(f"the default duration: {error}") from None


def duration_template(motions: Mapping[str, Duration | None]) -> str:
    """Return the text of a file of durations; a motion with ``None`` gets the placeholder ``SECONDS``."""
    lines = ["# motion, tab, seconds (or 25 min, 1.5 h); behind another tab passive, if nobody stands by"]
    for motion, duration in motions.items():
        seconds = "SECONDS" if duration is None else decimal_text(Fraction(duration.seconds))
        lines.append(
            f"{motion}\t{seconds}" + ("\tpassive" if duration is not None and duration.passive else "")
        )
    return "\n".join(lines) + "\n"
