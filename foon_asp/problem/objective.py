"""What is best: the objectives and lexicographic lists of them."""

from collections.abc import Iterable
from enum import StrEnum

from foon_asp.errors import UserError


class Objective(StrEnum):
    """One criterion.

    ``units``: fewest functional units. ``inputs``: fewest input object nodes, summed over the units.
    ``inputs+ingredients``: the same plus the ingredients of those nodes (the published heuristic's
    measure). ``success``: greatest product of success rates. ``kitchen``: fewest distinct kitchen items
    among the inputs that the units need.
    """

    UNITS = "units"
    INPUTS = "inputs"
    INPUTS_AND_INGREDIENTS = "inputs+ingredients"
    SUCCESS = "success"
    KITCHEN = "kitchen"


def parse_objectives(names: Iterable[str]) -> tuple[Objective, ...]:
    """Read a lexicographic list, first the most important; raises :class:`UserError` for unknown names.

    Each name may itself be a comma-separated list.
    """
    objectives: list[Objective] = []
    for name in (part.strip() for item in names for part in item.split(",")):
        try:
            objective = Objective(name)
        except ValueError:
            raise UserError(f"found the objective {name!r}, expected one of {', '.join(Objective)}") from None
        if objective in objectives:
            raise UserError(f"the objective {name!r} is listed twice")
        objectives.append(objective)
    return tuple(objectives)


def levels(objectives: tuple[Objective, ...]) -> tuple[Objective, ...]:
    """Give the list that is optimized: ``units`` comes last, so that no tree carries a spare unit."""
    return objectives if Objective.UNITS in objectives else (*objectives, Objective.UNITS)
