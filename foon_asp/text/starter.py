"""The files of a new data folder, with comments that explain them."""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from foon_asp.network import Network, ObjectNode
from foon_asp.text.writer import write_node

RATES_FILE = "motion.txt"
"""The name of the file of success rates."""
_KITCHEN = """\
# What is available: an O line for each object, and below it its S lines, as in the recipe.
# It begins with what makes the units of the recipe run: take out what you do not have, and add what you have.
# What is listed never runs out, unless a line below its S lines says how many there are, for --items used-up:
# "# Amount:", a tab and a number.
"""
_MOTIONS = """\
# How often each motion succeeds: a motion, a tab, and a decimal above 0 and at most 1.
"""
_UNKNOWN = """\
# 1 says that it never fails: nothing is known yet. Put in what you measured.
"""
_UTENSILS_HEAD = """\
# Things to hold something, one a line. Only --containers implied looks at them: a unit is then not asked for
# the bowl that holds its flour, if the flour is there.
"""
_GOALS = """\
# What is to be made: --goal finds it by its name, and solve --all-goals solves all of it. "# Amount:", a tab
# and a number below it ask for as many copies, and items are used up then.
"""


def starter_files(
    recipe: str,
    network: Network,
    kitchen: Iterable[int],
    goals: Iterable[ObjectNode],
    rates: Mapping[str, Fraction] | None = None,
) -> dict[str, str]:
    """Return the texts of the files of a new data folder, by file name.

    ``recipe`` is the text of the network; ``kitchen`` has ids of nodes. A motion without a rate gets the rate
    1. If ``rates`` is empty or missing, a comment says that nothing is known yet. Utensils are guessed from
    the nodes.
    """
    motions = sorted(dict.fromkeys(network.motions))
    all_rates = {motion: (rates or {}).get(motion, Fraction(1)) for motion in motions}
    return {
        "recipe.txt": recipe,
        "kitchen.txt": _KITCHEN + "".join(write_node(network.objects[o]) for o in sorted(kitchen)),
        RATES_FILE: _MOTIONS
        + ("" if rates else _UNKNOWN)
        + "".join(f"{motion}\t{float(rate):g}\n" for motion, rate in all_rates.items()),
        "utensils.txt": _UTENSILS_HEAD + "".join(f"{label}\n" for label in _utensils(network.objects)),
        "goal_nodes.txt": _GOALS + "".join(map(write_node, goals)),
    }


def _utensils(nodes: Sequence[ObjectNode]) -> list[str]:
    """Return the sorted labels of utensils: nodes with contents, to which relations of other nodes lead.

    Labels that are also ingredients are left out.
    """
    labels_with_contents = {node.label for node in nodes if node.ingredients}
    related_objects = {relation.object for node in nodes for relation in node.relations}
    ingredients = {item for node in nodes for item in node.ingredients}
    return sorted((labels_with_contents & related_objects) - ingredients)
