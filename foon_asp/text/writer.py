"""Writing FOON text in its canonical form (no ids, flags or times)."""

from collections.abc import Iterable

from foon_asp.network import FunctionalUnit, ObjectNode


def write_node(node: ObjectNode) -> str:
    """Give the object block of a node: its object line and, sorted, its state lines."""
    lines = [f"O\t{node.label}"]
    lines += [f"S\t{state}" for state in sorted(node.states)]
    lines += [f"S\t{word}\t[{related}]" for word, related in sorted(node.relations)]
    lines += [f"S\t{word}\t{{{','.join(items)}}}" for word, items in node.contents]
    return "\n".join(lines) + "\n"


def write_unit(unit: FunctionalUnit) -> str:
    """Give the lines of a unit, the closing ``//`` included."""
    inputs = "".join(map(write_node, unit.inputs))
    outputs = "".join(map(write_node, unit.outputs))
    return f"{inputs}M\t{unit.motion}\n{outputs}//\n"


def write_units(units: Iterable[FunctionalUnit], comments: Iterable[str] = ()) -> str:
    """Give a whole FOON text: comment lines, ``//``, and the units in order."""
    return (
        "".join(f"# {line}\n" for comment in comments for line in comment.split("\n"))
        + "//\n"
        + "".join(map(write_unit, units))
    )
