"""Numbers that steer searches with clingo; none of them decides what is proved."""

from typing import NamedTuple


class SearchTuning(NamedTuple):
    """Sizes of the programs that clingo gets, and of the results that are stored.

    ``nearest_units``: units of the first reduced-cost neighbourhood, and of landmarks explored at once.
    ``nearest_growth``: factor by which the neighbourhood grows if it has no tree.
    ``explored_units``: explored units, at most, not counting units that mattered before.
    ``explored_growth``: factor by which the explored units grow in each round.
    ``open_rounds``: searches for trees with open preconditions, each with more units explored.
    ``cut_objects``: object nodes of the cuts that a certificate tries first; it finds others by itself.
    ``units_without_clingo``: units of a network that is searched faster than clingo is imported.
    ``max_weight``: greatest weight of a constraint that may be broken or dropped, so that sums of weights fit
    clingo.
    """

    nearest_units: int = 200
    nearest_growth: int = 4
    explored_units: int = 5000
    explored_growth: float = 1.5
    open_rounds: int = 12
    cut_objects: int = 200_000
    units_without_clingo: int = 10_000
    max_weight: int = 1_000_000


SEARCH = SearchTuning()
