"""Task trees that know what they are for, and show themselves."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Self

from foon_asp.network import FunctionalUnit, ObjectNode, Source, TaskTree, counted, unit_at_level
from foon_asp.problem import Problem, given_outputs
from foon_asp.questions.caller import caller
from foon_asp.questions.result import NoTreeError
from foon_asp.report.drawing import Drawing, draw_tree
from foon_asp.report.notebook import picture_bundle, svg_text
from foon_asp.report.tree_drawing import given_tree, plan_drawing
from foon_asp.text.answer_file import ListedTree, read_listed_tree
from foon_asp.text.diagnostics import summarize
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_units


@dataclass(frozen=True, slots=True, repr=False)
class Tree(TaskTree):
    """Functional units in a listed order, and the ``problem`` that they are for.

    ``units`` are values (``motion``, ``inputs``, ``outputs``), ``places`` where each was read. ``claim`` is
    a text about what is proved of the tree, or empty. As a string it is FOON text. Two trees are equal if
    they list the same units in the same order.

    Example:
        >>> foon_asp.solve(foon_asp.load().problem("ice")).tree
        <Tree for ice; crushed; in [drinking glass]: 2 units>
        >>> problem = foon_asp.load().problem("ice")
        >>> tree = foon_asp.Tree.of(problem, [26, 27])
        >>> foon_asp.Tree.given(problem, tree) == tree, tree.drawing().caption[0]
        (True, 'Task tree for ice; crushed; in [drinking glass]')
        >>> import pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "ice.txt"
        >>> _ = file.write_text(str(tree))
        >>> foon_asp.Tree.read(problem, file)
        <Tree for ice; crushed; in [drinking glass]: 2 units>
    """

    problem: Problem = field(compare=False)
    places: tuple[Source, ...] = field(compare=False)
    claim: str = field(default="", compare=False)

    @classmethod
    def of(cls, problem: Problem, units: Iterable[int], claim: str = "") -> Self:
        """Make a tree from units of a problem's network.

        Parameters:
            problem: The problem that the tree is for.
            units: Ids of units, in the order of the tree.
            claim: What is proved of the tree, as a text.
        """
        units = tuple(units)
        network = problem.network
        places = tuple(network.sources[unit][0] for unit in units)
        return cls(tuple(network.unit(unit) for unit in units), problem, places, claim)

    @classmethod
    def given(cls, problem: Problem, units: Iterable[FunctionalUnit], places: Iterable[Source] = ()) -> Self:
        """Make a tree from units as values, which need not be in the network.

        Parameters:
            problem: The problem that the tree is for.
            units: The units, in the order of the tree.
            places: Where each unit was read; without it, where the network has it, or no file.
        """
        units = tuple(unit_at_level(unit, problem.network.level) for unit in units)
        about = problem.about(units)
        return cls(units, about, tuple(places) or tuple(map(about.place, units)))

    @classmethod
    def read(cls, problem: Problem, file: str | PathLike[str]) -> Self:
        """Read a tree from FOON text, or from an answer of foon-asp in JSON.

        Parameters:
            problem: The problem that the tree is for, whatever goals an answer names.
            file: The path of the file; its units need not be in the network.

        Raises:
            UserError: for a file that is not understood or has no tree.
        """
        listed, _ = read_listed(Path(file))
        return cls.given(problem, [unit for unit, _ in listed], [place for _, place in listed])

    def __str__(self) -> str:
        return write_units(self.units, filter(None, [f"Task tree for: {self._goals()}", self.claim]))

    def __repr__(self) -> str:
        return f"<Tree for {self._goals()}: {counted(len(self), 'unit')}>"

    def drawing(self) -> Drawing:
        """Give what the picture shows; units of a tree without a claim are numbered as they execute."""
        if self.problem.items is not None:
            return plan_drawing(self.problem, self.units, caption=self.claim)
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


def read_listed(file: Path) -> tuple[Sequence[tuple[FunctionalUnit, Source]], Sequence[ObjectNode]]:
    """Read the units of a tree with their places in the order listed, and the goals, which an answer knows.

    Who asks hears of what was assumed. Raises :class:`UserError` as :meth:`Tree.read`.
    """
    listed = read_answer(file)
    return listed.units or (), listed.goals


def read_answer(file: Path) -> ListedTree:
    """Read the same, and whatever else an answer knows; there are units, if not always any."""
    who = caller()
    reader = FoonReader(who.lenient)
    listed = read_listed_tree(file, reader)
    for remark in summarize(reader.diagnostics):
        who.reporter.warning(remark)
    if listed.units is None:
        raise NoTreeError(f"{file}: the answer has no tree ({listed.status})")
    return listed
