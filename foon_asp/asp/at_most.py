"""Bounds from above on what a tree costs by objectives that count."""

from collections.abc import Iterable, Mapping

from foon_asp.asp.facts import write_at_most
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.program import Bounded
from foon_asp.problem import Costs, Objective


def at_most(bounds: Mapping[Objective, int]) -> Bounded:
    """Ask for trees that cost no more than so much by each of some objectives, of which ``success`` is none.

    For :class:`foon_asp.asp.Settings`. Raises ``ValueError`` for ``success``, and :class:`UserError` for
    numbers that clingo does not have.
    """
    return _bounded({objective: bound} for objective, bound in bounds.items())


def better_than(known: Iterable[Costs], objectives: Iterable[Objective]) -> Bounded:
    """Ask for trees that are better than each of some known ones by one of some objectives.

    ``success`` is none of the objectives. Raises like :func:`at_most`.
    """
    by = tuple(objectives)
    return _bounded({o: int(costs.measure(o)) - 1 for o in by} for costs in known)


def _bounded(bounds: Iterable[Mapping[Objective, int]]) -> Bounded:
    """Keep to one part of each bound."""
    rules = "".join(write_at_most(number, bound) for number, bound in enumerate(bounds))
    return Bounded(rules, (question_encoding("at_most.lp"),))
