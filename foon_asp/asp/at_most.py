"""Bounds from above on what a tree costs by objectives that count."""

from collections.abc import Iterable, Mapping

from foon_asp.asp.facts import write_at_most
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.settings import Bounded
from foon_asp.problem import Costs, Objective


def at_most(bounds: Mapping[Objective, int]) -> Bounded:
    """Ask for trees that cost no more than so much by each of some objectives that count whole numbers.

    For :class:`foon_asp.asp.Settings`. Raises ``ValueError`` for other objectives, and :class:`UserError` for
    numbers that clingo does not have.
    """
    fractions = [str(objective) for objective in bounds if not objective.row.whole]
    if fractions:
        raise ValueError(f"{' and '.join(fractions)} is no whole number that a bound could be put on")
    return _bounded({objective: bound} for objective, bound in bounds.items())


def better_than(known: Iterable[Costs], objectives: Iterable[Objective]) -> Bounded:
    """Ask for trees that are better than each of some known ones by one of some objectives.

    ``success`` is none of the objectives. Raises like :func:`at_most`.
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
