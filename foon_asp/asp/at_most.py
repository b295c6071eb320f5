"""Upper bounds on the costs of a tree by objectives that add up."""

from collections.abc import Iterable, Mapping

from foon_asp.asp.settings import Bounded
from foon_asp.encoding.fact_writer import write_at_most
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.problem import Costs, Objective


def better_than(incumbents: Iterable[Costs], objectives: Iterable[Objective]) -> Bounded:
    """Return bounds that a tree meets if it is better than each incumbent by at least one objective.

    The bounds exclude the trees that an incumbent dominates. The objectives must not include ``success``. The
    result is for ``bounded`` of :class:`foon_asp.asp.Settings`. Raises :class:`UserError` for numbers beyond
    those of clingo.
    """
    summed = tuple(objectives)
    if all(objective.row.whole for objective in summed):
        return _integer_bounds({o: int(costs.measure(o)) - 1 for o in summed} for costs in incumbents)
    below = tuple({o: costs.measure(o) for o in summed} for costs in incumbents)
    return Bounded("", (question_encoding("at_most.lp"),), below)


def _integer_bounds(bounds: Iterable[Mapping[Objective, int]]) -> Bounded:
    """Return bounds from mappings of objectives to integers: a tree has to meet a bound of each mapping."""
    rules = "".join(write_at_most(number, bound) for number, bound in enumerate(bounds))
    return Bounded(rules, (question_encoding("at_most.lp"),))
