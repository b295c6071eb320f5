"""What one unit adds to an objective that adds up counts: what bounds, reductions and engines go by."""

from foon_asp.errors import BugError
from foon_asp.network import Network
from foon_asp.problem.objective import Objective


def unit_count(network: Network, objective: Objective, unit: int) -> int:
    """Give what a unit counts by itself; for ``kitchen`` nothing, where each item taken counts 1.

    Raises :class:`BugError` for an objective that does not add up counts, or of which it is not known.
    """
    if objective is Objective.UNITS:
        return 1
    if objective is Objective.KITCHEN:
        return 0
    inputs = network.inputs[unit]
    if objective is Objective.INPUTS:
        return len(inputs)
    if objective is Objective.INPUTS_AND_INGREDIENTS:
        return len(inputs) + sum(len(network.objects[o].ingredients) for o in inputs)
    raise BugError(f"nothing says what a unit counts by the objective {str(objective)!r}")
