"""Writing FOON text: lines as they were read, and units without ids, flags or times."""

import re
from collections.abc import Iterable

from foon_asp.errors import UserError
from foon_asp.network import Contents, FunctionalUnit, ObjectNode, Relation
from foon_asp.text.line import Line, MotionLine, ObjectLine
from foon_asp.typed import typed


def write_line(line: Line) -> str:
    """Give the canonical text of a line: a line read without a remark comes out as it was.

    Ids, fields and the order of ingredients are kept, and what a remark said was left out is not there.
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
    """Give the object block of a node: its object line and, sorted, its state lines."""
    lines = [f"O\t{node.label}"]
    lines += [f"S\t{state}" for state in sorted(node.states)]
    lines += [f"S\t{word}\t[{related}]" for word, related in sorted(node.relations)]
    lines += [f"S\t{word}\t{{{','.join(items)}}}" for word, items in node.contents]
    return "\n".join(lines) + "\n"


def write_unit(unit: FunctionalUnit) -> str:
    """Give the lines of a unit, the closing ``//`` included.

    Raises :class:`UserError` for a unit without inputs, which nobody could read back.
    """
    if not unit.inputs:
        raise UserError(f"the unit {unit.motion!r} has no inputs, which FOON text cannot hold; JSON can")
    inputs = "".join(map(write_node, unit.inputs))
    outputs = "".join(map(write_node, unit.outputs))
    return f"{inputs}M\t{unit.motion}\n{outputs}//\n"


@typed
def write_units(units: Iterable[FunctionalUnit], comments: Iterable[str] = ()) -> str:
    """Write functional units as FOON text.

    Parameters:
        units: The units, in the order in which they are written.
        comments: Lines of comment to put before them.

    Returns:
        The FOON text.

    Raises:
        UserError: for a unit without inputs, which FOON text cannot hold.

    Example:
        >>> tree = foon_asp.solve(foon_asp.load().problem("ice")).tree
        >>> foon_asp.write_units(tree, ["a tree for ice"]).splitlines()[:2]
        ['# a tree for ice', '//']
    """
    return (
        "".join(f"# {line}\n" for comment in comments for line in re.split("\r\n|\r|\n", comment))
        + "//\n"
        + "".join(map(write_unit, units))
    )
