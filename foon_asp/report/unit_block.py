"""Functional units as a few lines, and in what two of them differ."""

import textwrap
from collections.abc import Iterator

from foon_asp.network import FunctionalUnit, Network, counted
from foon_asp.network.near_units import UnitDifference, units_kept_apart
from foon_asp.report.stacked import columns

_WIDTH = 100


def unit_block(unit: FunctionalUnit, place: str) -> Iterator[str]:
    """Give the lines of a unit: its motion and place, what it takes, and what it makes."""
    yield f"  {unit.motion}    [{place}]"
    for sign, nodes in (("    ", unit.inputs), ("  → ", unit.outputs)):
        text = " + ".join(map(str, nodes))
        yield from textwrap.wrap(
            text, columns(_WIDTH), initial_indent=sign, subsequent_indent="      ", break_on_hyphens=False
        )


def kept_apart_text(network: Network) -> str:
    """List the pairs of units of a network that differ in one thing alone, each with its places."""
    pairs = units_kept_apart(network.unit(unit) for unit in range(len(network)))
    lines = [f"nearly the same, and kept apart: {counted(len(pairs), 'pair', ',')}"]
    for pair in pairs:
        lines.append("")
        for letter, unit in (("A", pair.left), ("B", pair.right)):
            number = network.unit_id(unit)
            assert number is not None
            lines += [
                f"{letter}{line[1:]}" if not place else line
                for place, line in enumerate(unit_block(unit, str(network.sources[number][0])))
            ]
        lines += [f"    {difference_text(difference)}" for difference in pair.differences]
    return "\n".join(lines) + "\n\n"


def difference_text(difference: UnitDifference) -> str:
    """Say in what two units differ."""
    kind, left, right, of = difference
    before = f"{of}: " if of else ""
    if left and right:
        return f"{before}{kind} {left!r} in A, {right!r} in B"
    return f"{before}{kind} {left or right!r} only in {'A' if left else 'B'}"
