"""The table ``unit_amounts.txt``: on each line a motion, a node, and its amount in units of the motion."""

import re

from foon_asp.network import MAX_AMOUNT
from foon_asp.text.line import LineError, NameKind
from foon_asp.text.line_parser import parse_node
from foon_asp.text.stated_amounts import UnitAmount
from foon_asp.text.tables import motion_in_first_column
from foon_asp.text.value_table import Table

_ARROWS = ("→", "->")
_AMOUNT = re.compile(r"[1-9]\d{0,6}", re.ASCII)


def _amount_row(name: str, value: str, column: int) -> tuple[UnitAmount, int]:
    """Return motion, side and node of a row, and the amount, from 1 to 1,000,000.

    If an arrow stands before the node, it is an output, otherwise an input. Raises :class:`LineError` at a
    fault.
    """
    motion = motion_in_first_column(name, "an object node")
    *fields, written = value.split("\t")
    written = written.strip()
    if not _AMOUNT.fullmatch(written) or int(written) > MAX_AMOUNT:
        last = column + len(value) - len(written)
        raise LineError(last, repr(written[:40]), (f"an amount, from 1 to {MAX_AMOUNT}",))
    is_output = bool(fields) and fields[0].strip() in _ARROWS
    nodes = fields[is_output:]
    if len(nodes) != 1:
        raise LineError(column, f"{len(nodes)} object nodes", ("one, between the motion and its amount",))
    return (motion, is_output, parse_node(nodes[0].strip())), int(written)


UNIT_AMOUNTS = Table(
    "unit-amount",
    NameKind.MOTION,
    "an object node, a tab and its amount",
    _amount_row,
    "a second amount for {name!r}",
)
"""``motion⇥NODE⇥2`` and ``motion⇥→⇥NODE⇥4``: how many copies of a node the units of a motion take or make."""
