"""Task trees that know what they are for, and show themselves."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from foon_asp.api.shown import picture_bundle, svg_text
from foon_asp.network import Source, TaskTree
from foon_asp.problem import given_outputs
from foon_asp.report.drawing import Drawing, draw_tree
from foon_asp.report.tree_drawing import given_tree
from foon_asp.text import write_units

if TYPE_CHECKING:
    from foon_asp.api.problem import Problem


@dataclass(frozen=True, slots=True, repr=False)
class Tree(TaskTree):
    """Functional units in a listed order, and the problem that they are for.

    ``units`` are values (``motion``, ``inputs``, ``outputs``), ``places`` where each was read. ``claim`` is
    what is proved of the tree, in words, or empty. As a string it is FOON text. Two trees are equal when
    they list the same units in the same order.
    """

    problem: "Problem" = field(compare=False)
    places: tuple[Source, ...] = field(compare=False)
    claim: str = field(default="", compare=False)

    def __str__(self) -> str:
        return write_units(self.units, filter(None, [f"Task tree for: {self._goals()}", self.claim]))

    def __repr__(self) -> str:
        return f"<Tree for {self._goals()}: {len(self)} unit{'' if len(self) == 1 else 's'}>"

    def drawing(self) -> Drawing:
        """Give what the picture shows; units of a tree without a claim are numbered as they execute."""
        network = self.problem.network
        met = {node for unit in self.units for side in (unit.inputs, unit.outputs) for node in side}
        kitchen = {node for node in met.union(self.problem.goal_nodes) if self.problem.at_hand(node)}
        goals = self.problem.goal_nodes
        rule, utensils = self.problem.containers, self.problem.utensils
        if self.claim:
            gives = [given_outputs(unit, rule, utensils, network) for unit in self.units]
            caption = (f"Task tree for {self._goals()}", self.claim)
            return draw_tree(self.units, kitchen, goals, caption, gives)
        return given_tree("", self, kitchen, goals, rule, utensils, network)

    def svg(self) -> str:
        """Give the picture as SVG.

        Raises :class:`UserError` without the packages of ``foon-asp[pictures]``, and for a tree too large
        for a picture.
        """
        return svg_text(self.drawing())

    def _goals(self) -> str:
        return " + ".join(map(str, self.problem.goal_nodes))

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the picture."""
        return picture_bundle(self, self.drawing())
