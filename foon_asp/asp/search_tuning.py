"""Numbers that steer searches with clingo; none of them decides what is proved."""

from typing import NamedTuple


class SearchTuning(NamedTuple):
    """Sizes of the programs that clingo gets, and of the results that are stored.

    ``nearest_units``: the number of units in the first reduced-cost neighbourhood. Landmarks of at most this
    number of units are explored at once.
    ``nearest_growth``: the factor by which the neighbourhood grows if it has no tree.
    ``explored_units``: the greatest number of explored units. Units that a similar question explored do not
    count.
    ``explored_growth``: the greatest factor by which the explored units grow in each round.
    ``open_rounds``: the greatest number of searches for trees with open preconditions; each explores more
    units.
    ``cut_objects``: the number of object nodes in the cuts that a certificate tries first; it finds others by
    itself.
    ``units_without_clingo``: the greatest number of units of a network that is searched faster than clingo is
    imported.
    ``max_weight``: the greatest weight of a constraint that may be broken or dropped, so that sums of weights
    fit clingo.
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
