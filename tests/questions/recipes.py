"""Small problems, written as they are read aloud."""

from typing import Any

import foon_asp
from foon_asp.problem import Problem
from foon_asp.text.line_parser import parse_node


def posed(kitchen: str, goals: str, *units: str, **named: Any) -> Problem:
    """Pose a problem of units ``water + tea bag > tea``, each of which has another motion.

    Names in the kitchen and among the goals are separated by ``+``, too. Other parameters are those of
    ``Foon.problem``.
    """

    def nodes(names: str) -> list[foon_asp.ObjectNode]:
        return [parse_node(name.strip()) for name in names.split("+") if name.strip()]

    sides = ([nodes(side) for side in unit.split(">")] for unit in units)
    motions = [(f"m{line}", inputs, outputs) for line, (inputs, outputs) in enumerate(sides, 1)]
    foon = foon_asp.build(motions, kitchen=nodes(kitchen), utensils=["bowl", "pan"])
    return foon.problem(*nodes(goals), **named)
