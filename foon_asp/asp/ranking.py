"""Trees in order of their costs, one by one; none contains another."""

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
    units: tuple[int, ...]
    costs: Costs
    rounded: Rounded


class Ranked:
    """The trees of a question, the best first, under a lexicographic list of objectives.

    Trees that contain an earlier one are excluded. Construction cuts the network down. Iterate to get each
    tree as unit ids in an executable order, with its costs. After iteration, ``complete`` is true if there
    are no other trees; after a limit or ctrl-C it is false. Then ``pending`` has the other trees found, in
    order, but better trees may be missing. Raises :class:`UserError` like :func:`foon_asp.asp.solve`.
    """

    def __init__(
        self,
        problem: Problem,
        objectives: Sequence[Objective],
        settings: Settings,
        reporter: Reporter | None = None,
    ) -> None:
        self._program = assemble(settings, (reporter or Reporter()).warning, problem=problem)
        self._prepared = prepare(problem, objectives, settings, self._program)
        self._holds = self._prepared.holds
        self._last_key: tuple[int | Fraction, ...] = ()  # costs of the last tree yielded
        self.problem, self.levels = problem, self._prepared.levels
        self.complete = self._prepared.tree is None and not self._prepared.stopped
        self.pending: list[tuple[tuple[int, ...], Costs]] = []

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], Costs]]:
        """Iterate over trees in order of exact costs.

        clingo finds trees in order of rounded costs. A tree is yielded once no better tree can be found
        later. With rounded costs, a tree found later can be better if its weight is higher by less than the
        number of units whose weight is rounded down (docs/dev/exact-success.md).
        """
        if self.complete or self._prepared.stopped:
            return
        waiting: list[_Tree] = []
        found: list[_Tree] = []
        avoided = ""
        while True:
            text = write_objectives(self.levels) + avoided
            ended = self._prepared.run(text, encodings=(question_encoding("other_trees.lp"),))
            if ended.units is None:
                break
            tree = self._tree(ended.units)
            insort(waiting, tree, key=lambda entry: (entry.costs.key(self.levels), sorted(entry.units)))
            if not ended.exhausted:
                break
            self._check(ended, tree, found)
            while waiting and self._is_settled(waiting[0], tree.rounded):
                yield self._next_in_order(waiting)
            if not tree.units:  # every other tree contains it
                break
            avoided += write_avoided(len(found), map(self.problem.network.unit_number, tree.units))
            found.append(tree)
        if not ended.exhausted:
            self.pending = [(tree.units, tree.costs) for tree in waiting]
            return
        self.complete = True
        while waiting:
            yield self._next_in_order(waiting)

    def _tree(self, numbers: frozenset[int]) -> _Tree:
        """Return a tree from the public numbers of its units, with exact and rounded costs."""
        network = self.problem.network
        units = [network.unit_of_number(number) for number in sorted(numbers)]
        ids = [unit for unit in units if unit is not None]
        if len(ids) < len(units):
            raise UserError("a tree was found with units that are not in the network: check the encodings")
        order = self._holds.tree(ids)
        self._prepared.require_kept(order)
        costs, scales = self.problem.costs(order), self._prepared.scales
        rounded = (
            int(costs.measure(objective)) if objective.row.whole else scales.weight(objective, order)
            for objective in self.levels
        )
        return _Tree(order, costs, tuple(rounded))

    def _check(self, ended: Run, tree: _Tree, earlier: Sequence[_Tree]) -> None:
        """Require right rounded costs of a tree, in order, and that it contains no earlier tree.

        Raises :class:`UserError` where replaced encodings measure something else.
        """
        units, _, rounded = tree
        agree = [cost % 2**32 for cost in rounded] == [cost % 2**32 for cost in ended.cost]
        last = earlier[-1].rounded if earlier else ()
        if not (agree and last <= rounded) and self._program.replaced:
            raise UserError(
                f"{self._program.files[1]} does not measure what the objectives {', '.join(self.levels)} "
                "measure here, so trees cannot be ordered"
            )
        self._holds.require(
            agree, lambda: f"clingo reports the costs {list(ended.cost)}, the units {units} cost {rounded}"
        )
        self._holds.require(
            last <= rounded, lambda: f"the tree {units} costs {rounded}, but comes after one for {last}"
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
        """Whether a tree is at least as good as every tree with rounded costs of ``last`` or more."""
        by = self._prepared.scales.rounded
        if by is None:
            return True
        position = self.levels.index(by)
        if last[:position] > tree.rounded:  # with equal prefixes, the prefix is less
            return True
        return last[position] >= tree.rounded[position] + self._prepared.scales.count_rounded(tree.units)
