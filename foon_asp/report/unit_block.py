"""The units of a network that are nearly the same, and were kept apart."""

from foon_asp.network import Network, counted
from foon_asp.network.near_units import units_kept_apart
from foon_asp.results.values_of import differences_of, listed_unit


def kept_apart_text(network: Network) -> str:
    """List the pairs of units of a network that differ in one thing alone, each with its places."""
    pairs = units_kept_apart(network)
    lines = [f"nearly the same, and kept apart: {counted(len(pairs), 'pair', ',')}"]
    for pair in pairs:
        lines.append("")
        for letter, unit in (("A", pair.left), ("B", pair.right)):
            number = network.unit_id(unit)
            assert number is not None
            first, *others = listed_unit(network, unit, network.sources[number][0]).lines()
            lines += [f"{letter}{first[1:]}", *others]
        lines += [f"    {difference}" for difference in differences_of(pair)]
    return "\n".join(lines) + "\n\n"
