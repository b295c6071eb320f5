"""Bounds from above on what a tree costs by objectives that count."""

from collections.abc import Mapping

from foon_asp.asp.facts import write_at_most
from foon_asp.asp.program import Bounded
from foon_asp.problem import Objective
from foon_asp.resources import encodings_folder


def at_most(bounds: Mapping[Objective, int]) -> Bounded:
    """Ask for trees that cost no more than so much by each of some objectives, of which ``success`` is none.

    For :class:`foon_asp.asp.Settings`. Raises ``ValueError`` for ``success``, and :class:`UserError` for
    numbers that clingo does not have.
    """
    return Bounded(write_at_most(bounds), (encodings_folder() / "questions" / "at_most.lp",))
