"""Units of some tree and of every tree up to a cost, without a list of the trees."""

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
    """The units of some tree and of every tree.

    ``in_some`` are ids of units that some tree has, ``in_every`` ids of units that every tree has. After a
    limit, ``undecided`` are the units for which it is not known: those outside ``in_some`` may be in some
    tree, those in ``in_some`` may be in every tree.
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
    objective is worse than the best value by at most this share of it. Each search finds a tree that adds a
    unit to the units of some tree, or removes one from the units of every tree; the last search proves that
    there is no such tree. Raises :class:`UserError` like :func:`foon_asp.asp.solve`, and for rules if
    ``worse`` is not 0.
    """
    best = solve(problem, objectives, settings, reporter)
    if best.status is not Status.OPTIMAL or best.units is None or best.costs is None:
        undecided = frozenset(best.units or ())
        return TreeUnion(best, undecided, frozenset(), undecided)
    program = assemble(settings, Reporter().warning, problem=problem)
    if worse and not program.own:
        raise UserError(
            "with rules or encodings of yours, --union is about the optimal trees only: leave out --within"
        )
    search = _Union(prepare(problem, objectives, settings, program), best, worse)
    return search.run()


class _Union:
    """The search: the units seen so far, and the facts that avoid trees that do not count."""

    def __init__(self, prepared: Prepared, best: Outcome, worse: Fraction) -> None:
        assert best.units is not None
        assert best.costs is not None
        self._prepared, self._costs, self._worse = prepared, best.costs, worse
        self._best = best
        self._in_some, self._in_every = set(best.units), set(best.units)
        self._number = prepared.problem.network.unit_number
        self._settled = "" if not worse else "_without_spare(1).\n"
        self._avoided = 0

    def run(self) -> TreeUnion:
        """Search until no unit is undecided or a limit is reached."""
        candidates = self._candidates()
        self._prepared = replace(self._prepared, units=candidates)
        undecided = set[int]()
        while unseen := set(candidates) - self._in_some:
            is_added = self._next(write_unseen(map(self._number, sorted(unseen))))
            if not is_added:
                undecided |= unseen if is_added is None else set()
                break
        while self._in_every:
            is_added = self._next(write_in_all(map(self._number, sorted(self._in_every))))
            if not is_added:
                undecided |= self._in_every if is_added is None else set()
                break
        in_some, in_every = frozenset(self._in_some), frozenset(self._in_every - undecided)
        return TreeUnion(self._best, in_some, in_every, frozenset(undecided))

    def _candidates(self) -> tuple[int, ...]:
        """Return the units that trees up to the cost limit can have; with added rules a superset."""
        prepared, deadline = self._prepared, self._prepared.deadline
        if not prepared.program.own or prepared.unsettled or not prepared.settings.reductions:
            return prepared.units
        problem, by = prepared.kept or prepared.problem, prepared.levels
        try:
            reduced = reduce_under_rules(
                problem, by, expired=lambda: deadline.passed, redundant=prepared.redundant
            )
            subproblem, costs = reduced.subproblem, reduced.costs
            if subproblem is None or costs is None:
                return prepared.units
            if self._worse:
                none = dict.fromkeys(by, Fraction(0)) | {o: Fraction(1) for o in by if multiplies(o)}
                limit = costs.combined_cost(Costs({**none, by[0]: self._limit()}))
            else:
                limit = subproblem.total(self._in_some) + costs.doubt
            with deadline.watched("cutting the network"):
                kept = reduce_at_costs(
                    subproblem, by, costs, lambda: deadline.passed, self._in_some, below=limit + 1
                ).units
        except KeyboardInterrupt:
            deadline.interrupt()
            return prepared.units
        return tuple(sorted({*kept, *self._in_some}))

    @cached_property
    def _opt_mode(self) -> str:
        """The ``--opt-mode`` of clasp, bounded by the costs of the best tree unless costs are rounded.

        Without a bound if worse trees count, too.
        """
        scales, by = self._prepared.scales, self._prepared.levels
        if self._worse or scales.rounded is not None:
            return "opt"
        assert self._best.units is not None
        return ",".join(["opt", *(str(scales.weight(objective, self._best.units)) for objective in by)])

    def _limit(self) -> Fraction:
        """Return a value of the first objective just worse than the values of all trees that count."""
        first = self._prepared.levels[0]
        best = Fraction(self._costs.measure(first))
        if multiplies(first):
            return best * (1 - self._worse) * (1 - _JUST_ABOVE)
        return best * (1 + self._worse) + _JUST_ABOVE

    def _next(self, question: str) -> bool | None:
        """Find another tree that changes the result, and add its units; return ``True``.

        Returns ``False`` if there is no such tree, ``None`` at a limit.
        """
        problem, by = self._prepared.problem, self._prepared.levels
        while True:
            text = write_objectives(by) + question + self._settled
            ended = self._prepared.run(text, self._opt_mode, encodings=(question_encoding("union.lp"),))
            if not ended.exhausted:
                return None
            if ended.units is None:
                return False
            units = {problem.network.unit_of_number(number) for number in ended.units}
            order = self._prepared.holds.tree([unit for unit in units if unit is not None])
            self._prepared.require_kept(order)
            if self._is_beyond(order):
                return False
            tree = self._without_spare(order) if self._worse else frozenset(order)
            counts = self._counts(tree)
            if counts:
                before = len(self._in_some), len(self._in_every)
                self._in_some |= tree
                self._in_every &= tree
            if not counts or (len(self._in_some), len(self._in_every)) == before:
                self._settled += write_avoided(self._avoided, map(self._number, sorted(tree)))
                self._avoided += 1
                continue
            return True

    def _is_beyond(self, tree: Sequence[int]) -> bool:
        """Whether this tree and all trees not found yet cost too much to count, by rounded weights."""
        prepared, costs = self._prepared, self._prepared.problem.costs(tree)
        scales = prepared.scales
        for objective in prepared.levels[:1] if self._worse else prepared.levels:
            figure: int | Fraction = costs.measure(objective)
            best = self._limit() if self._worse else self._costs.measure(objective)
            if objective is scales.rounded:
                figure = scales.bound(objective, scales.weight(objective, tree))
            if figure != best:
                return figure < best if multiplies(objective) else figure > best
            if objective is scales.rounded:
                return False
        return False

    def _counts(self, tree: Collection[int]) -> bool:
        """Whether a tree is within the cost limit, by its exact costs."""
        by, costs = self._prepared.levels, self._prepared.problem.costs(tree)
        if not self._worse:
            return costs.key(by) == self._costs.key(by)
        figure, limit = costs.measure(by[0]), self._limit()
        return figure > limit if multiplies(by[0]) else figure < limit

    def _without_spare(self, tree: Sequence[int]) -> frozenset[int]:
        """Return an irredundant subtree of a tree."""
        problem, kept = self._prepared.problem, set(tree)
        for unit in reversed(tree):
            restriction = Restriction(lambda u, kept=kept, unit=unit: u == unit or u not in kept)  # type: ignore[misc]
            fewer = replace(problem, restriction=restriction)
            reached = reach(fewer)
            if all(reached.available[goal] for goal in problem.goals):
                kept = set(reached.units)
        return frozenset(kept)
