"""Enumeration of trees in order of their costs; no tree contains another."""

from bisect import insort
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import prepare
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.encoding.fact_writer import write_avoided, write_objectives
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.run import Run
from foon_asp.errors import UserError
from foon_asp.problem import Costs, Objective, Problem

Rounded = tuple[int, ...]  # by level: costs rounded as in clingo


class _Tree(NamedTuple):
    """A tree: its units by id in an executable order, its exact costs, and its costs rounded as in clingo."""

    units: tuple[int, ...]
    costs: Costs
    rounded: Rounded


class Ranked:
    """The trees of a question, the best first, under a lexicographic list of objectives.

    Trees that contain an earlier tree are excluded. Iteration yields each tree as unit ids in an executable
    order, with its costs. An iteration cannot be repeated. Afterwards, ``complete`` says whether all trees
    were yielded; after a limit or ctrl-C, it is false. Then ``pending`` has the trees that were found but not
    yielded, in order. Better trees than these may be missing.

    The constructor assembles the program and prepares the question. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """

    def __init__(
        self,
        problem: Problem,
        objectives: Sequence[Objective],
        settings: Settings,
        reporter: Reporter | None = None,
    ) -> None:
        """Assemble the program and prepare the question; only warnings are reported."""
        self._program = assemble(settings, (reporter or Reporter()).warning, problem=problem)
        self._prepared = prepare(problem, objectives, settings, self._program)
        self._holds = self._prepared.holds
        self._last_key: tuple[int | Fraction, ...] = ()  # costs of the last tree yielded
        self.problem, self.levels = problem, self._prepared.levels
        self.complete = self._prepared.tree is None and not self._prepared.stopped
        self.pending: list[tuple[tuple[int, ...], Costs]] = []

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], Costs]]:
        """Yield trees in order of their exact costs.

        clingo finds trees in order of their rounded costs. With rounded costs, a later tree can be better
        than an earlier one (docs/dev/exact-success.md). So a tree is yielded once no better tree can be found
        later.
        """
        if self.complete or self._prepared.stopped:
            return
        waiting: list[_Tree] = []
        found: list[_Tree] = []
        avoided = ""
        while True:
            text = write_objectives(self.levels) + avoided
            run = self._prepared.run(text, encodings=(question_encoding("other_trees.lp"),))
            if run.units is None:
                break
            tree = self._tree_of_numbers(run.units)
            insort(waiting, tree, key=lambda entry: (entry.costs.key(self.levels), sorted(entry.units)))
            if not run.exhausted:
                break
            self._require_in_order(run, tree, found)
            while waiting and self._is_settled(waiting[0], tree.rounded):
                yield self._next_in_order(waiting)
            if not tree.units:  # every other tree contains it
                break
            avoided += write_avoided(len(found), map(self.problem.network.unit_number, tree.units))
            found.append(tree)
        if not run.exhausted:
            self.pending = [(tree.units, tree.costs) for tree in waiting]
            return
        self.complete = True
        while waiting:
            yield self._next_in_order(waiting)

    def _tree_of_numbers(self, numbers: frozenset[int]) -> _Tree:
        """Return the tree of units that are given by id in the whole network, with exact and rounded costs.

        Raises :class:`UserError` for an id of no unit. Checks that the tree executes and keeps to the rules
        that were applied before the search; if not, raises :class:`BugError`.
        """
        network = self.problem.network
        units = [network.unit_of_number(number) for number in sorted(numbers)]
        ids = [unit for unit in units if unit is not None]
        if len(ids) < len(units):
            raise UserError("a tree was found with units that are not in the network: check the encodings")
        order = self._holds.require_executable(ids)
        self._prepared.require_kept(order)
        costs, scales = self.problem.costs(order), self._prepared.scales
        rounded = (
            int(costs.measure(objective)) if objective.row.whole else scales.weight(objective, order)
            for objective in self.levels
        )
        return _Tree(order, costs, tuple(rounded))

    def _require_in_order(self, run: Run, tree: _Tree, earlier: Sequence[_Tree]) -> None:
        """Require that clingo's costs of a tree are right and in order, and that it contains no earlier tree.

        ``earlier`` are the trees found before, in order. Raises :class:`UserError` where replaced encodings
        measure something else.
        """
        units, _, rounded = tree
        agree = [cost % 2**32 for cost in rounded] == [cost % 2**32 for cost in run.cost]
        last_rounded = earlier[-1].rounded if earlier else ()
        if not (agree and last_rounded <= rounded) and self._program.replaced:
            raise UserError(
                f"{self._program.files[1]} does not measure what the objectives {', '.join(self.levels)} "
                "measure here, so trees cannot be ordered"
            )
        self._holds.require(
            agree, lambda: f"clingo reports the costs {list(run.cost)}, the units {units} cost {rounded}"
        )
        self._holds.require(
            last_rounded <= rounded,
            lambda: f"the tree {units} costs {rounded}, but comes after one for {last_rounded}",
        )
        self._holds.require(
            not any(set(units).issuperset(before.units) for before in earlier),
            lambda: f"the tree {units} holds one that was found before",
        )

    def _next_in_order(self, waiting: list[_Tree]) -> tuple[tuple[int, ...], Costs]:
        """Remove and return the best waiting tree; require that it is not better than trees before it."""
        units, costs, _ = waiting.pop(0)
        key = costs.key(self.levels)
        self._holds.require(
            self._last_key <= key, lambda: f"the tree {units} is better than one that was given before it"
        )
        self._last_key = key
        return units, costs

    def _is_settled(self, tree: _Tree, last: Rounded) -> bool:
        """Whether a tree is at least as good as every tree whose rounded costs are ``last`` or more.

        Always true if no costs are rounded.
        """
        rounded_objective = self._prepared.scales.rounded
        if rounded_objective is None:
            return True
        position = self.levels.index(rounded_objective)
        if last[:position] > tree.rounded:  # with equal prefixes, the prefix is less
            return True
        return last[position] >= tree.rounded[position] + self._prepared.scales.count_rounded(tree.units)
