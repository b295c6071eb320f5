"""Does a tree execute?"""

from collections.abc import Iterable
from os import PathLike
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Source
from foon_asp.problem import Problem
from foon_asp.proof import Simulation, Verdict, simulate_for
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.report.drawing import Drawing
from foon_asp.report.verdict import verdict_json, verdict_text


class _Checked(NamedTuple):
    tree: Tree
    simulation: Simulation


class Checked(Result, _Checked):
    """What a simulation of ``tree`` found: ``simulation`` has the ``verdict`` and what stops the tree."""

    __slots__ = ()

    @property
    def executes(self) -> bool:
        """Whether the tree executes, as listed or in another order."""
        return self.simulation.verdict is not Verdict.NEVER

    @property
    def in_order(self) -> Tree | None:
        """The tree in an order that executes, ``None`` where no order does."""
        if not self.executes:
            return None
        units, places = self.tree.units, self.tree.places
        order = self.simulation.order
        return Tree(tuple(units[n] for n in order), self.tree.problem, tuple(places[n] for n in order))

    @property
    def problem(self) -> Problem:
        """What the tree is for."""
        return self.tree.problem

    def text(self) -> str:
        """Say whether the tree executes, as ``foon-asp check`` does."""
        return verdict_text(self.problem, self._listed(), self.simulation)

    def json_text(self) -> str:
        """Say whether the tree executes, as ``foon-asp check --format json`` does."""
        return verdict_json(self.problem, self._listed(), self.simulation)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.tree.drawing()

    def _listed(self) -> list[tuple[FunctionalUnit, Source]]:
        return list(zip(self.tree.units, self.tree.places, strict=True))


def check(problem: Problem, tree: str | PathLike[str] | Iterable[FunctionalUnit]) -> Checked:
    """Simulate a tree for the goals of a problem, and say whether and in which order it executes.

    ``tree`` is the path of a file, FOON text or an answer in JSON, or functional units in the order listed,
    such as a :class:`~foon_asp.TaskTree`.
    """
    given = Tree.read(problem, tree) if isinstance(tree, str | PathLike) else Tree.given(problem, tree)
    return Checked(given, simulate_for(given.problem, given))
