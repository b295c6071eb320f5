"""Upper bounds on the costs of a tree by objectives that add up."""

from collections.abc import Iterable, Mapping

from foon_asp.asp.settings import Bounded
from foon_asp.encoding.facts import write_at_most
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.problem import Costs, Objective


def better_than(known: Iterable[Costs], objectives: Iterable[Objective]) -> Bounded:
    """Ask for trees that are better than each of some known ones by one of some objectives.

    For :class:`foon_asp.asp.Settings`. ``success`` is none of the objectives. Raises :class:`UserError` for
    numbers that clingo does not have.
    """
    by = tuple(objectives)
    if all(objective.row.whole for objective in by):
        return _bounded({o: int(costs.measure(o)) - 1 for o in by} for costs in known)
    below = tuple({o: costs.measure(o) for o in by} for costs in known)
    return Bounded("", (question_encoding("at_most.lp"),), below)


def _bounded(bounds: Iterable[Mapping[Objective, int]]) -> Bounded:
    """Ask for trees that are within one number of each set of bounds."""
    rules = "".join(write_at_most(number, bound) for number, bound in enumerate(bounds))
    return Bounded(rules, (question_encoding("at_most.lp"),))
