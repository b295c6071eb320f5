"""Writing of FOON text: lines as they were read, and nodes and units without ids, flags or times."""

import re
from collections.abc import Iterable
from functools import lru_cache
from types import MappingProxyType

from foon_asp.argument_checks import typed
from foon_asp.errors import UserError
from foon_asp.escapes import encodable
from foon_asp.network import (
    ALL_ONE,
    Amounts,
    Contents,
    FunctionalUnit,
    ObjectNode,
    Relation,
    UnitAmounts,
)
from foon_asp.text.amount_mark import write_amount
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import parse_line
from foon_asp.text.listed_unit import node_of


def write_line(line: Line) -> str:
    """Return the canonical text of a line, without line end.

    If the line was read without a remark, this is the text that was read. Ids, fields and the order of
    ingredients are kept. Parts that were left out with a remark are missing.
    """
    if isinstance(line, ObjectLine):
        return "\t".join((f"O{line.id}", line.label, *line.fields))
    if isinstance(line, MotionLine):
        return "\t".join((f"M{line.id}", line.motion + "*" * line.composite, *line.fields))
    attribute = line.attribute
    if isinstance(attribute, Relation):
        return f"S{line.id}\t{attribute.word}\t[{attribute.object}]"
    if isinstance(attribute, Contents):
        return f"S{line.id}\t{attribute.word}\t{{{','.join(line.listed)}}}"
    return f"S{line.id}\t{attribute}"


def write_node(node: ObjectNode) -> str:
    """Return the lines of a node: its object line and, sorted, its state lines.

    Raises :class:`UserError` for a name that means something else in FOON text.
    """
    states = [*map(StateLine, sorted(node.states)), *map(StateLine, sorted(node.relations))]
    states += [StateLine(contents, listed=contents.ingredients) for contents in node.contents]
    written = [_line_if_readable(line) for line in (ObjectLine(node.label), *states)]
    if None in written or node_of(node.label, [state.attribute for state in states]) != node:
        raise UserError(f"the object node {str(node)!r} has a name that FOON text cannot hold; JSON can")
    return "".join(filter(None, written))


def write_counted_node(node: ObjectNode, amount: int | None) -> str:
    """Return the lines of a node, followed by the line of its amount; ``None`` is no amount.

    Raises :class:`UserError` for a name that means something else in FOON text.
    """
    return write_node(node) + ("" if amount is None else write_amount(amount))


def write_motion(motion: str) -> str:
    """Return the line of a motion, with its line end.

    Raises :class:`UserError` for a name that FOON text cannot hold.
    """
    written = _line_if_readable(MotionLine(motion))
    if written is None:
        raise UserError(f"the motion {motion!r} is a name that FOON text cannot hold; JSON can")
    return written


@lru_cache(10_000, typed=True)  # many units have equal lines
def _line_if_readable(line: Line) -> str | None:
    """Return the text of a line with its line end.

    Return ``None`` if the text is not read back as the same line, or if UTF-8 cannot hold it.
    """
    written = write_line(line)
    try:
        read_back = None if "\n" in written or "\r" in written else parse_line(written)._replace(remarks=())
    except LineError:
        return None
    return f"{written}\n" if read_back == line and encodable(written) == written else None


def write_unit(unit: FunctionalUnit, amounts: UnitAmounts = ALL_ONE) -> str:
    """Return the lines of a unit with its amounts, and a closing ``//``.

    Raises :class:`UserError` for a unit without inputs, and for names that FOON text cannot hold.
    """
    if not unit.inputs:
        raise UserError(f"the unit {unit.motion!r} has no inputs, which FOON text cannot hold; JSON can")
    inputs, outputs = (
        "".join(write_counted_node(node, amounts_of_side.get(node)) for node in nodes)
        for nodes, amounts_of_side in zip((unit.inputs, unit.outputs), amounts, strict=True)
    )
    return f"{inputs}{write_motion(unit.motion)}{outputs}//\n"


@typed
def write_units(
    units: Iterable[FunctionalUnit],
    comments: Iterable[str] = (),
    amounts: Amounts = MappingProxyType({}),
) -> str:
    """Write functional units as FOON text.

    Parameters:
        units: The units, in the order in which they are written.
        comments: Lines of comment to put before them.
        amounts: How many copies of their object nodes units take and make, where that is not one.

    Returns:
        The FOON text.

    Raises:
        UserError: for a unit without inputs, and for names that FOON text cannot hold, as ``a[b]``.

    Example:
        >>> tree = foon_asp.solve(foon_asp.load().problem("ice")).tree
        >>> foon_asp.write_units(tree, ["a tree for ice"]).splitlines()[:2]
        ['# a tree for ice', '//']
    """
    return (
        "".join(f"# {line}\n" for comment in comments for line in re.split("\r\n|\r|\n", comment))
        + "//\n"
        + "".join(write_unit(unit, amounts.get(unit, ALL_ONE)) for unit in units)
    )
