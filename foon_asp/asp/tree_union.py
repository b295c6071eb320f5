"""Units of some tree and of every tree up to a cost, found without listing the trees."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.outcome import Outcome, Status
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.asp.solver import solve
from foon_asp.encoding.fact_writer import write_avoided, write_in_all, write_objectives, write_unseen
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.hypergraph.reduction import reduce_at_costs, reduce_under_rules
from foon_asp.problem import Costs, Objective, Problem, multiplies, reach
from foon_asp.problem.restriction import Restriction

_JUST_ABOVE = Fraction(1, 10**30)  # a cost that is this much above a limit is above it, at every scale


class TreeUnion(NamedTuple):
    """The ids of the units that some tree has, and of the units that every tree has.

    ``best``: the outcome with the best tree.
    ``in_some``, ``in_every``: the units that some tree has, and that every tree has, as far as it is known.
    ``undecided``: after a limit, the units that may still be added. Units in ``in_some`` may belong to
    ``in_every``; other units may belong to ``in_some``.
    """

    best: Outcome
    in_some: frozenset[int]
    in_every: frozenset[int]
    undecided: frozenset[int]


def tree_union(
    problem: Problem,
    objectives: tuple[Objective, ...],
    settings: Settings,
    reporter: Reporter,
    worse: Fraction = Fraction(0),
) -> TreeUnion:
    """Find the units of some and of every tree up to a cost, as brave and cautious consequences.

    If ``worse`` is 0, the trees are the optimal ones. Otherwise they are all irredundant trees whose first
    objective is at most the share ``worse`` worse than the best value: for ``Fraction(1, 10)``, 10%. Each
    search finds a tree with a unit that no earlier tree has, or without a unit that all earlier trees have.
    The last search proves that there is no such tree. Without a proved optimum, nothing is searched. The
    units of the tree that was found are then in ``in_some``, and undecided.

    Raises :class:`UserError` like :func:`foon_asp.asp.solve`, and for user rules if ``worse`` is not 0.
    """
    best = solve(problem, objectives, settings, reporter)
    if best.status is not Status.OPTIMAL or best.units is None or best.costs is None:
        undecided = frozenset(best.units or ())
        return TreeUnion(best, undecided, frozenset(), undecided)
    program = assemble(settings, Reporter().warning, problem=problem)
    if worse and not program.is_built_in:
        raise UserError(
            "with rules or encodings of yours, --union is about the optimal trees only: leave out --within"
        )
    search = _UnionSearch(prepare(problem, objectives, settings, program), best, worse)
    return search.run()


class _UnionSearch:
    """The search of :func:`tree_union`: the units of the trees found so far, and the trees to exclude."""

    def __init__(self, prepared: Prepared, best: Outcome, worse: Fraction) -> None:
        """Begin with the units of the ``best`` tree; for ``worse``, see :func:`tree_union`."""
        assert best.units is not None
        assert best.costs is not None
        self._prepared, self._costs, self._worse = prepared, best.costs, worse
        self._best = best
        self._in_some, self._in_every = set(best.units), set(best.units)
        self._number = prepared.problem.network.unit_number
        self._settled = "" if not worse else "_without_spare(1).\n"
        self._avoided = 0

    def run(self) -> TreeUnion:
        """Search until no unit is undecided or a limit is reached; return the result."""
        candidates = self._candidates()
        self._prepared = replace(self._prepared, units=candidates)
        undecided = set[int]()
        while unseen := set(candidates) - self._in_some:
            is_added = self._add_next_tree(write_unseen(map(self._number, sorted(unseen))))
            if not is_added:
                undecided |= unseen if is_added is None else set()
                break
        while self._in_every:
            is_added = self._add_next_tree(write_in_all(map(self._number, sorted(self._in_every))))
            if not is_added:
                undecided |= self._in_every if is_added is None else set()
                break
        in_some, in_every = frozenset(self._in_some), frozenset(self._in_every - undecided)
        return TreeUnion(self._best, in_some, in_every, frozenset(undecided))

    def _candidates(self) -> tuple[int, ...]:
        """Return the ids of the units that trees up to the cost limit can have.

        These are all units of the prepared question in three cases: without reductions, under user rules that
        clingo has to enforce, and at a limit.
        """
        prepared, deadline = self._prepared, self._prepared.deadline
        if not prepared.program.is_built_in or prepared.unsettled or not prepared.settings.reductions:
            return prepared.units
        problem, levels = prepared.restricted_problem or prepared.problem, prepared.levels
        try:
            reduced = reduce_under_rules(
                problem, levels, expired=lambda: deadline.passed, redundant=prepared.redundant
            )
            subproblem, costs = reduced.subproblem, reduced.costs
            if subproblem is None or costs is None:
                return prepared.units
            if self._worse:
                zero_costs = dict.fromkeys(levels, Fraction(0)) | {
                    o: Fraction(1) for o in levels if multiplies(o)
                }
                limit = costs.combined_cost(Costs({**zero_costs, levels[0]: self._limit()}))
            else:
                limit = subproblem.tree_cost(self._in_some) + costs.doubt
            with deadline.watched("cutting the network"):
                kept = reduce_at_costs(
                    subproblem,
                    levels,
                    costs,
                    lambda: deadline.passed,
                    self._in_some,
                    below=limit + 1,
                ).units
        except KeyboardInterrupt:
            deadline.interrupt()
            return prepared.units
        return tuple(sorted({*kept, *self._in_some}))

    @cached_property
    def _opt_mode(self) -> str:
        """The ``--opt-mode`` of clasp: ``opt,2,6`` excludes trees that cost more than the best one.

        If trees worse than the best one count, or costs are rounded, it is ``opt``, without a bound.
        """
        scales, levels = self._prepared.scales, self._prepared.levels
        if self._worse or scales.rounded is not None:
            return "opt"
        assert self._best.units is not None
        return ",".join(["opt", *(str(scales.weight(objective, self._best.units)) for objective in levels)])

    def _limit(self) -> Fraction:
        """Return a value of the first objective that is just worse than that of every tree that counts."""
        first = self._prepared.levels[0]
        best = Fraction(self._costs.measure(first))
        if multiplies(first):
            return best * (1 - self._worse) * (1 - _JUST_ABOVE)
        return best * (1 + self._worse) + _JUST_ABOVE

    def _add_next_tree(self, question: str) -> bool | None:
        """Find another tree that changes the result, and change the result by it.

        ``question`` are facts that ask for such a tree. A tree found may be above the cost limit by exact
        costs, or change nothing. Then it is excluded from all later searches, and the search goes on. Returns
        ``True`` if a tree changed the result, ``False`` if no tree does, ``None`` at a limit.
        """
        problem, levels = self._prepared.problem, self._prepared.levels
        while True:
            text = write_objectives(levels) + question + self._settled
            run = self._prepared.run(text, self._opt_mode, encodings=(question_encoding("union.lp"),))
            if not run.exhausted:
                return None
            if run.units is None:
                return False
            units = {problem.network.unit_of_number(number) for number in run.units}
            order = self._prepared.holds.require_executable([unit for unit in units if unit is not None])
            self._prepared.require_kept(order)
            if self._is_above_limit(order):
                return False
            tree = self._irredundant_subtree(order) if self._worse else frozenset(order)
            is_within_limit = self._is_within_limit(tree)
            if is_within_limit:
                sizes = len(self._in_some), len(self._in_every)
                self._in_some |= tree
                self._in_every &= tree
            if not is_within_limit or (len(self._in_some), len(self._in_every)) == sizes:
                self._settled += write_avoided(self._avoided, map(self._number, sorted(tree)))
                self._avoided += 1
                continue
            return True

    def _is_above_limit(self, tree: Sequence[int]) -> bool:
        """Whether a tree costs more than the cost limit by rounded costs.

        If worse trees count, only the first objective is compared; otherwise all are, in order. clingo finds
        trees in order of rounded costs. So if a tree is above the limit, all trees found later are as well.
        """
        prepared, costs = self._prepared, self._prepared.problem.costs(tree)
        scales = prepared.scales
        for objective in prepared.levels[:1] if self._worse else prepared.levels:
            figure: int | Fraction = costs.measure(objective)
            limit = self._limit() if self._worse else self._costs.measure(objective)
            if objective is scales.rounded:
                figure = scales.bound(objective, scales.weight(objective, tree))
            if figure != limit:
                return figure < limit if multiplies(objective) else figure > limit
            if objective is scales.rounded:
                return False
        return False

    def _is_within_limit(self, tree: Collection[int]) -> bool:
        """Whether the exact costs of a tree are within the cost limit, so that the tree counts.

        If worse trees count, the limit is on the first objective. Otherwise, all costs have to be those of
        the best tree.
        """
        levels, costs = self._prepared.levels, self._prepared.problem.costs(tree)
        if not self._worse:
            return costs.key(levels) == self._costs.key(levels)
        figure, limit = costs.measure(levels[0]), self._limit()
        return figure > limit if multiplies(levels[0]) else figure < limit

    def _irredundant_subtree(self, tree: Sequence[int]) -> frozenset[int]:
        """Return the unit ids of an irredundant subtree of a tree, which is in executable order.

        From the last unit to the first, each unit without which the rest still makes the goals is dropped.
        """
        problem, kept = self._prepared.problem, set(tree)
        for unit in reversed(tree):
            restriction = Restriction(lambda other, kept=kept, unit=unit: other == unit or other not in kept)  # type: ignore[misc]
            without_unit = replace(problem, restriction=restriction)
            reached = reach(without_unit)
            if all(reached.available[goal] for goal in problem.goals):
                kept = set(reached.units)
        return frozenset(kept)
