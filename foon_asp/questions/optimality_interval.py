"""Sensitivity of the best tree to one success rate: the ends of its optimality interval."""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.problem import Costs, Objective, Problem, levels, reach, relevant_units
from foon_asp.problem.root import Root

_SUCCESS = (Objective.SUCCESS,)
_TINY = Fraction(1, 10**9)  # a rate at which a motion is almost forbidden


class _Tree(NamedTuple):
    """A tree, and its success as a function of the rate x of one motion: ``factor`` * x^``power``."""

    units: tuple[int, ...]
    power: int
    factor: Fraction


class IntervalEnd(NamedTuple):
    """One end of the interval of a rate in which the tree stays optimal, and the best tree beyond.

    ``at``: the rate at which another tree is as good; ``None`` if no rate on this side makes another tree
        better.
    ``beyond``: the ids of the units of the other tree, in an order that executes; ``None`` if ``at`` is
        ``None``.
    ``proved``: false if a limit came first; the true end may then be nearer to the rate.
    """

    at: Root | None
    beyond: tuple[int, ...] | None
    proved: bool = True


class Envelope:
    """A search for the interval of each success rate in which the best tree stays the best.

    The success of each tree is a function of the rate. The upper envelope of the functions is the best
    success at each rate. The interval is where the best tree is on the envelope. docs/dev/questions.md has
    the argument. ``motions`` are the motions that a tree for the goals may have.
    """

    def __init__(self, problem: Problem, tree: tuple[int, ...], settings: Settings) -> None:
        """Find the motions that trees may have, and the motions that may rise to 1 while the tree stays best.

        At a limit or ctrl-C, the second search is given up, and the deadline counts as interrupted.
        """
        self._problem, self._tree, self._settings = problem, tree, settings
        self._postconditions = Postconditions(problem, levels(_SUCCESS), settings)
        reached = reach(problem)
        # A unit that the goals cannot need makes no tree better, but user rules may require it.
        is_plain = not settings.constraints and settings.replaced is None
        self._units = relevant_units(problem, reached) if is_plain else reached.units
        self._unit_counts = self._count_by_motion(self._units)
        self.motions = sorted(self._unit_counts)
        try:
            self._free_to_rise = self._motions_free_to_rise()
        except KeyboardInterrupt:
            settings.effective_deadline.interrupt()
            self._free_to_rise = set()

    def unit_count(self, motion: str) -> int:
        """Return how many units of the best tree have a motion, and no rate of their own."""
        return self._count_by_motion(self._tree)[motion]

    def end(self, motion: str, above: bool) -> IntervalEnd:
        """Return the end of the interval above a motion's rate if ``above``, else the end below the rate.

        At a limit or ctrl-C, the end is not proved, and the deadline is interrupted.
        """
        rate, unit_count = (self._problem.rates or {})[motion], self.unit_count(motion)
        if above and (rate == 1 or self._unit_counts[motion] == unit_count or motion in self._free_to_rise):
            return IntervalEnd(None, None)
        if not above and not unit_count:
            return IntervalEnd(None, None)
        try:
            if above:
                return self._end_from(motion, 1, Fraction(1))
            tiny = _TINY if rate > _TINY else rate * _TINY
            end = self._end_from(motion, 1, tiny)
            # a tree with fewer units of the motion wins below some rate: below this one, if it has all others
            tree_of_all_units = self._as_function(motion, tuple(self._units))
            if (
                end.at is None
                and end.proved
                and tree_of_all_units.factor <= self._as_function(motion, self._tree).factor * tiny
            ):
                end = self._end_from(motion, 0, Fraction(1, 2))
            return end
        except KeyboardInterrupt:
            self._settings.effective_deadline.interrupt()
            return IntervalEnd(None, None, proved=False)

    def _end_from(self, motion: str, degree: int, raised_rate: Fraction) -> IntervalEnd:
        """Return the end of the interval of a motion's rate, searched from a distant rate inwards.

        ``raised_rate`` is the distant rate to the power of ``degree``. If a tree is better there, the rate at
        which it is as good as the present tree is tried next. This repeats until no tree is better. If the
        last search reached a limit, the end is not proved.

        At degree 0, the motion has the rate ``raised_rate``, and all others have 1. This finds the tree with
        the fewest units of the motion.
        """
        tree = self._as_function(motion, self._tree)
        rate = Root(1, (self._problem.rates or {})[motion])
        end = IntervalEnd(None, None)
        while True:
            rival, proved = self._better_tree(motion, degree, raised_rate)
            if rival is None:
                return end._replace(proved=proved)
            higher, lower = (rival, tree) if rival.power > tree.power else (tree, rival)
            at = Root.simplify(higher.power - lower.power, lower.factor / higher.factor)
            end = IntervalEnd(at, rival.units)
            if at == rate or (degree and proved and higher.power - lower.power == 1):
                return end
            degree, raised_rate = at.degree, at.of

    def _better_tree(self, motion: str, degree: int, raised_rate: Fraction) -> tuple[_Tree | None, bool]:
        """Return a tree that is better at another rate of a motion, and whether the search was complete.

        Without a better tree, return ``None`` in its place. ``raised_rate`` is the other rate to the power of
        ``degree``. The search raises all rates to this power. Then the other rate is rational, and the order
        of trees by success stays the same.
        """
        outcome, better = self._solve_varied(_at_rate(self._problem, motion, degree, raised_rate))
        proved = outcome.status is Status.OPTIMAL
        if not better or outcome.units is None:
            return None, proved
        return self._as_function(motion, outcome.units), proved

    def _motions_free_to_rise(self) -> set[str]:
        """Return motions whose rates may each rise to 1 while the tree stays optimal; there may be more.

        A test covers many motions at once: it sets to 1 the rates of their units outside the tree. If the
        tree stays optimal, all these motions are returned. Otherwise, the motions by which the better tree
        gains are removed, and the test is repeated. If a limit comes first, the set is empty.
        """
        network, own_rates = self._problem.network, self._problem.own_rates
        motions = set(self.motions)
        while motions:
            varied_units = {unit for unit in self._units if network.motions[unit] in motions}.difference(
                self._tree
            )
            raised_rates = dict.fromkeys(varied_units, Fraction(1)) | dict(own_rates)
            outcome, better = self._solve_varied(
                replace(self._problem, own_rates=raised_rates, as_seen=self._problem)
            )
            if not better or outcome.units is None:
                return motions if outcome.status is Status.OPTIMAL else set()
            motions.difference_update(
                network.motions[unit] for unit in varied_units.intersection(outcome.units)
            )
        return motions

    def _solve_varied(self, varied: Problem) -> tuple[Outcome, bool]:
        """Return the optimum of a problem with other rates, and whether it beats the tree of the envelope.

        After a limit, the outcome is the best tree found, if any. Raises :class:`BugError` if a proved
        optimum is worse than the tree of the envelope.
        """
        outcome = solve(varied, _SUCCESS, self._settings, Reporter())
        tree_success = _success(varied.costs(self._tree))
        rival_success = Fraction(0) if outcome.costs is None else _success(outcome.costs)
        self._postconditions.require(
            rival_success >= tree_success or outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE},
            lambda: f"at other success rates {outcome.status} is said, but the tree {self._tree} is better",
        )
        return outcome, rival_success > tree_success

    def _count_by_motion(self, units: Iterable[int]) -> Counter[str]:
        """Count the units by motion, without units that have a rate of their own."""
        network, own_rates = self._problem.network, self._problem.own_rates
        return Counter(network.motions[unit] for unit in units if unit not in own_rates)

    def _as_function(self, motion: str, units: tuple[int, ...]) -> _Tree:
        """Return ``units`` as a tree with its success as a function of the rate of a motion."""
        network, own_rates = self._problem.network, self._problem.own_rates
        fixed = [unit for unit in units if network.motions[unit] != motion or unit in own_rates]
        factor = math.prod(map(self._problem.rate, fixed), start=Fraction(1))
        return _Tree(units, len(units) - len(fixed), factor)


def _at_rate(problem: Problem, motion: str, degree: int, raised_rate: Fraction) -> Problem:
    """Return a problem with all rates to the power of ``degree``, and ``raised_rate`` for the motion.

    Own rates of units are raised to the power, also for units with the motion. User rules see the rates as
    given.
    """
    raised = {name: rate**degree for name, rate in (problem.rates or {}).items()}
    own_rates = {unit: rate**degree for unit, rate in problem.own_rates.items()}
    return replace(problem, rates=raised | {motion: raised_rate}, own_rates=own_rates, as_seen=problem)


def _success(costs: Costs) -> Fraction:
    """Return the success in the costs of a tree, as an exact fraction."""
    return Fraction(costs.measure(Objective.SUCCESS))
