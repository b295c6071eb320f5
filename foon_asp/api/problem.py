"""One question, ready to be asked, and cheap to vary."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.api.arguments import Number
from foon_asp.api.tree import Tree
from foon_asp.api.warning import warn
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, Source, TaskTree, unit_at_level
from foon_asp.problem import problem as plain
from foon_asp.text import FoonReader, summarize
from foon_asp.text.answer_file import read_listed_tree

if TYPE_CHECKING:
    from foon_asp.api.foon import Foon, Names


@dataclass(frozen=True, eq=False, repr=False)
class Problem(plain.Problem):
    """What is asked: goals, a kitchen and a container rule, over a network.

    :meth:`foon_asp.Foon.problem` makes one from names. Inside, object nodes and units are numbers:
    ``kitchen`` and ``goals`` are places in ``network.objects``; ``network.unit(u)`` is unit ``u`` as a value.
    ``rates`` has the success rate of every motion, ``None`` where none are known; ``utensils`` are the labels
    that the rule ``implied`` looks at. Of a store, ``network`` is the part that can matter for the goals.

    ``origin`` is the data that it was asked of, ``None`` for a problem put together by hand.
    """

    origin: "Foon | None" = field(default=None, kw_only=True)

    @property
    def goal_nodes(self) -> tuple[ObjectNode, ...]:
        """The goals."""
        return tuple(self.network.objects[goal] for goal in self.goals)

    @cached_property
    def foon(self) -> "Foon":
        """The data with the kitchen of this problem, to ask it for other problems."""
        from foon_asp.api.foon import foon_of  # noqa: PLC0415 - they know each other

        return foon_of(self)

    @cached_property
    def whole(self) -> "Problem":
        """The same problem over the whole network: of a store, all of it is read."""
        if not self.network.object_numbers:
            return self
        goals = tuple(self.network.object_number(goal) for goal in self.goals)
        return self.foon.pose(goals, self.containers, everything=True)

    def vary(
        self,
        goals: "Names | None" = None,
        containers: str | None = None,
        *,
        kitchen: "Names | Path | None" = None,
        adding: "Names" = (),
        without: "Names" = (),
        rates: Mapping[str, Number] | None = None,
    ) -> "Problem":
        """Give the same problem with other goals, another container rule, kitchen or rates.

        Nothing is read again, and nothing of the network is looked up anew; a store is read as far as the
        new question goes beyond the old one. The kitchen varies as in :meth:`foon_asp.Foon.vary`. Raises
        :class:`UserError` for names that mean nothing or too much.
        """
        foon = self.foon.vary(kitchen=kitchen, adding=adding, without=without, rates=rates)
        if goals is None:
            ids = tuple(self.network.object_number(goal) for goal in self.goals)
        else:
            ids = foon.goal_ids(goals)
        posed = foon.pose(ids, self.containers if containers is None else containers)
        if not self.own_rates:
            return posed
        numbered = {self.network.unit_number(unit): rate for unit, rate in self.own_rates.items()}
        own = {posed.network.unit_of_number(number): rate for number, rate in numbered.items()}
        return replace(posed, own_rates={unit: rate for unit, rate in own.items() if unit is not None})

    def at_hand(self, node: ObjectNode) -> bool:
        """Whether the kitchen has an object node."""
        return self.network.object_id(node) in self.kitchen

    def tree(self, units: Iterable[int], claim: str = "") -> Tree:
        """Give units, by id and in the order given, as a tree; ``claim`` is what is proved of it."""
        units = tuple(units)
        network = self.network
        places = tuple(network.sources[unit][0] for unit in units)
        return Tree(tuple(network.unit(unit) for unit in units), self, places, claim)

    def read_tree(self, file: str | PathLike[str]) -> Tree:
        """Read a tree from FOON text, or from an answer of foon-asp in JSON, whatever its units are.

        It is a tree for the goals of this problem, whatever goals an answer names. Raises
        :class:`UserError` for a file that is not understood or has no tree.
        """
        reader = FoonReader()
        listed = read_listed_tree(Path(file), reader)
        for remark in summarize(reader.diagnostics):
            warn(remark)
        if listed.units is None:
            raise UserError(f"{file}: the answer has no tree ({listed.status})")
        return self.given(*zip(*listed.units, strict=True)) if listed.units else self.given((), ())

    def given(self, units: Iterable[FunctionalUnit], places: Iterable[Source] = ()) -> Tree:
        """Take units of any origin as a tree for the goals, in the order listed.

        Without ``places``, units stand where the network has them, or in no file.
        """
        units = tuple(unit_at_level(unit, self.network.level) for unit in units)
        problem = self._with_part(TaskTree(units))
        places = tuple(places) or tuple(problem.place(unit) for unit in units)
        return Tree(units, problem, places)

    def place(self, unit: FunctionalUnit) -> Source:
        """Give the first place where a unit was read; one of no network stands in no file."""
        number = self.network.unit_id(unit)
        return Source("-", 0) if number is None else self.network.sources[number][0]

    def _with_part(self, tree: TaskTree) -> "Problem":
        """Of a store, read what a tree is made of."""
        if not self.network.object_numbers:
            return self
        goals = tuple(self.network.object_number(goal) for goal in self.goals)
        return self.foon.pose_for(goals, self.containers, tree)

    def __repr__(self) -> str:
        return f"<Problem: {' + '.join(map(str, self.goal_nodes))} ({self.conditions})>"


def taken(problem: plain.Problem, origin: "Foon | None" = None) -> Problem:
    """Take a problem of the rooms below as one of these."""
    if isinstance(problem, Problem) and origin is None:
        return problem
    pieces = {piece.name: getattr(problem, piece.name) for piece in fields(plain.Problem)}
    return Problem(**pieces, origin=origin)
