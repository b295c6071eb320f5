"""What is best: the objectives and lexicographic lists of them."""

from collections.abc import Iterable
from enum import StrEnum

from foon_asp.errors import BugError, UserError


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


_ADDED_UP = frozenset(
    {Objective.UNITS, Objective.INPUTS, Objective.INPUTS_AND_INGREDIENTS, Objective.KITCHEN}
)


def multiplies(objective: Objective) -> bool:
    """Whether an objective multiplies rates, and more is better; the others add up counts, and less is.

    To be asked wherever that makes a difference, since it raises :class:`BugError` for an objective of which
    nobody has said so: one that is added falls through nowhere.
    """
    if objective is Objective.SUCCESS:
        return True
    if objective not in _ADDED_UP:
        raise BugError(f"nothing says how the objective {str(objective)!r} is measured")
    return False


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
