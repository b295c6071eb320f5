"""Task trees with the problem that they are for, as text and pictures."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Self

from msgspec import UNSET

from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source, TaskTree, counted, unit_at_level
from foon_asp.problem import Problem
from foon_asp.questions.caller import caller
from foon_asp.questions.result import NoTreeError
from foon_asp.results.values import Lack, Unit
from foon_asp.results.values_of import listed_unit
from foon_asp.text.answer_file import ListedTree, read_listed_tree
from foon_asp.text.diagnostics import summarize
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_units

if TYPE_CHECKING:  # only drawings need it
    from foon_asp.pictures.drawing import Drawing

OTHER_READING = "if what is there can be used again: --items lasting"
"""Advice for a plan that lacks a copy: it may run if items last."""


@dataclass(frozen=True, slots=True, repr=False)
class Tree(TaskTree):
    """Functional units in a listed order, and the ``problem`` that they are for.

    ``units`` are values (``motion``, ``inputs``, ``outputs``); ``places`` has the place where each was read.
    ``claim`` is a text about what is proved of the tree, or empty. As a string, a tree is FOON text. Two
    trees are equal if they list the same units in the same order.

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

        Units are reduced to the level of detail of the network.

        Parameters:
            problem: The problem that the tree is for. If its network is a part of a store, the problem of the
                tree also has those units that the store has.
            units: The units, in the order of the tree.
            places: Where each unit was read; by default its place in the network, if it has one.
        """
        units = tuple(unit_at_level(unit, problem.network.level) for unit in units)
        about = problem.about(units)
        return cls(units, about, tuple(places) or tuple(map(about.place, units)))

    @classmethod
    def read(cls, problem: Problem, file: str | PathLike[str]) -> Self:
        """Read a tree from FOON text, from an answer of foon-asp in JSON, or from the atoms of clingo.

        Parameters:
            problem: The problem that the tree is for, whatever goals an answer names.
            file: The path of the file; its units need not be in the network.

        Raises:
            UserError: for a file that is not understood or has no tree.
        """
        listed, _ = read_listed_units(Path(file), lambda: problem.whole.network)
        return cls.given(problem, [unit for unit, _ in listed], [source for _, source in listed])

    @property
    def ids(self) -> tuple[int, ...]:
        """The units that are in the network of the problem, by id in it, in the order listed."""
        ids = map(self.problem.network.unit_id, self.units)
        return tuple(unit for unit in ids if unit is not None)

    def __str__(self) -> str:
        comments = filter(None, [f"Task tree for: {self._goals_text()}", self.claim])
        return write_units(self.units, comments, self.problem.amounts)

    def __repr__(self) -> str:
        return f"<Tree for {self._goals_text()}: {counted(len(self), 'unit')}>"

    def lack_text(self, lack: Lack) -> str:
        """Return in words the missing copy, the step that needs it, and the steps that used up the copies.

        Parameters:
            lack: The copy that is missing.
        """
        if lack.position is None:
            remaining = "no copy is" if lack.amount is UNSET else f"fewer than {lack.amount} copies are"
            text = f"every step runs, but in the end {remaining} left of the goal: {lack.missing}"
        else:
            copies = "a copy" if lack.amount is UNSET else f"{lack.amount} copies"
            text = f"step {lack.position}, {self.step_text(lack.position)}, lacks {copies} of {lack.missing}"
        if not lack.used_up_by:
            return f"{text}; there never {'was one' if lack.amount is UNSET else 'were as many'}"
        takers = (f"step {number} ({self.units[number - 1].motion})" for number in lack.used_up_by)
        return f"{text}; used up by {', '.join(takers)}"

    def in_order(self, order: Iterable[int]) -> "Tree":
        """Return the tree in another order, without a claim.

        Parameters:
            order: The positions of the units, from 0, in the new order.
        """
        order = tuple(order)
        places = tuple(self.places[index] for index in order)
        return Tree(tuple(self.units[index] for index in order), self.problem, places)

    def step_unit(self, position: int) -> Unit:
        """Return the unit of a step as a value, whether or not the network has the unit.

        Parameters:
            position: The number of the step, from 1.
        """
        return listed_unit(self.problem.network, self.units[position - 1], self.places[position - 1])

    def step_text(self, position: int) -> str:
        """Return the motion of a step and where it was read.

        Parameters:
            position: The number of the step, from 1.
        """
        return f"{self.units[position - 1].motion}    [{self.places[position - 1].short}]"

    def drawing(self) -> "Drawing":
        """Return the drawing of the tree; of a plan if items are used up.

        Units of a tree without a claim are numbered in an order that executes, if there is one.
        """
        from foon_asp.pictures.tree_drawing import plan_drawing, tree_drawing  # noqa: PLC0415
        from foon_asp.questions.used_up_note import used_up_note  # noqa: PLC0415

        if self.problem.items is not None:
            return plan_drawing(self.problem, self.units, caption=self.claim)
        network = self.problem.network
        touched = {node for unit in self.units for nodes in (unit.inputs, unit.outputs) for node in nodes}
        kitchen = {node for node in touched.union(self.problem.goal_nodes) if self.problem.at_hand(node)}
        goals = self.problem.goal_nodes
        rule, utensils = self.problem.containers, self.problem.utensils
        claim = [self.claim, *used_up_note(self.problem, self.units)] if self.claim else ()
        return tree_drawing(self, kitchen, goals, rule, utensils, network, claim)

    def svg(self) -> str:
        """Return the picture as SVG.

        Raises :class:`UserError` without the packages of ``foon-asp[pictures]``, and for a tree too large
        for a picture.
        """
        from foon_asp.pictures.graphviz import svg_picture  # noqa: PLC0415

        return svg_picture(self.drawing())

    def _goals_text(self) -> str:
        """Return the goal nodes in one-line notation, joined by ``+``."""
        return " + ".join(map(str, self.problem.goal_nodes))

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Return the notebook display by media type: the picture."""
        from foon_asp.pictures.notebook import picture_bundle  # noqa: PLC0415

        return picture_bundle(self, self.drawing())


def as_tree(problem: Problem, tree: str | PathLike[str] | Iterable[FunctionalUnit]) -> Tree:
    """Return a tree for a problem: read from the path of a file, or made of units.

    If ``tree`` is a :class:`Tree`, its places are kept and its claim is not.
    """
    if isinstance(tree, str | PathLike):
        return Tree.read(problem, tree)
    return Tree.given(problem, tree, tree.places if isinstance(tree, Tree) else ())


def read_listed_units(
    file: Path, network: Callable[[], Network]
) -> tuple[Sequence[tuple[FunctionalUnit, Source]], Sequence[ObjectNode]]:
    """Return the units that a file lists, each with its place, and the goals if the file is an answer.

    ``network`` returns the network that ids in the file refer to; it is called only if there are ids.
    Assumptions of the reader are reported as warnings. Raises :class:`UserError` for a file that is not
    understood or has no tree.
    """
    listed = read_answer(file).with_units(file, network)
    return listed.units or (), listed.goals


def read_answer(file: Path) -> ListedTree:
    """Return the tree in a file; if the file is an answer, its other fields, too.

    Units that the file gives by id are not looked up: they stay ids. Assumptions of the reader are reported
    as warnings. Raises :class:`NoTreeError` for an answer without a tree.
    """
    current_caller = caller()
    reader = FoonReader(current_caller.lenient)
    listed = read_listed_tree(file, reader)
    for remark in summarize(reader.diagnostics):
        current_caller.reporter.warning(remark)
    if listed.units is None:
        raise NoTreeError(f"{file}: the answer has no tree ({listed.status})")
    return listed
