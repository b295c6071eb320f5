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
    """A tree as a function of the rate x of one motion; its success is ``factor`` * x^``power``."""

    units: tuple[int, ...]
    power: int
    factor: Fraction


class End(NamedTuple):
    """One end of the interval of a rate in which the tree stays optimal, and the best tree beyond.

    ``at`` is the rate at which another tree is as good, and ``beyond`` its units by id in an order that
    executes. Both are ``None`` if no rate on that side makes another tree better. ``proved`` is false if
    a limit came first: the end may then be nearer to the rate.
    """

    at: Root | None
    beyond: tuple[int, ...] | None
    proved: bool = True


class Envelope:
    """Finds the interval of each success rate in which the best tree stays the best.

    As functions of one rate, the successes of all trees have an upper envelope; the interval is where the
    best tree is on it. docs/dev/questions.md has the argument. ``motions`` are the motions that a tree for
    the goals may have.
    """

    def __init__(self, problem: Problem, tree: tuple[int, ...], settings: Settings) -> None:
        """Find the motions of possible trees, and by searches the rates that may rise to 1 without effect."""
        self._problem, self._tree, self._settings = problem, tree, settings
        self._holds = Postconditions(problem, levels(_SUCCESS), settings)
        reached = reach(problem)
        # A unit that the goals cannot need makes no tree better, but user rules may require it.
        plain = not settings.constraints and settings.replaced is None
        self._units = relevant_units(problem, reached) if plain else reached.units
        self._units_of_motion = self._counted(self._units)
        self.motions = sorted(self._units_of_motion)
        try:
            self._settled = self._unmoved()
        except KeyboardInterrupt:
            settings.begun.interrupt()
            self._settled = set()

    def units(self, motion: str) -> int:
        """Return how many units of the tree have the rate of a motion."""
        return self._counted(self._tree)[motion]

    def end(self, motion: str, above: bool) -> End:
        """Find the end of the optimality interval of a rate, above or below; at a limit, unproved."""
        rate, units = (self._problem.rates or {})[motion], self.units(motion)
        if above and (rate == 1 or self._units_of_motion[motion] == units or motion in self._settled):
            return End(None, None)
        if not above and not units:
            return End(None, None)
        try:
            if above:
                return self._end_from(motion, 1, Fraction(1))
            tiny = _TINY if rate > _TINY else rate * _TINY
            end = self._end_from(motion, 1, tiny)
            # a tree with fewer units of the motion wins below some rate: below this one, if it has all others
            everything = self._seen(motion, tuple(self._units))
            if (
                end.at is None
                and end.proved
                and everything.factor <= self._seen(motion, self._tree).factor * tiny
            ):
                end = self._end_from(motion, 0, Fraction(1, 2))
            return end
        except KeyboardInterrupt:
            self._settings.begun.interrupt()
            return End(None, None, proved=False)

    def _end_from(self, motion: str, degree: int, of: Fraction) -> End:
        """Return the end of the interval of a motion's rate, found from a distant rate towards the given one.

        The distant rate is the root of ``of`` of this degree; each better tree gives the next rate to try. At
        degree 0 all other rates count as 1, so that the tree with the fewest units of the motion is found.
        """
        tree = self._seen(motion, self._tree)
        rate = Root(1, (self._problem.rates or {})[motion])
        end = End(None, None)
        while True:
            rival, proved = self._better(motion, degree, of)
            if rival is None:
                return end._replace(proved=proved)
            higher, lower = (rival, tree) if rival.power > tree.power else (tree, rival)
            at = Root.simplify(higher.power - lower.power, lower.factor / higher.factor)
            end = End(at, rival.units)
            if at == rate or (degree and proved and higher.power - lower.power == 1):
                return end
            degree, of = at.degree, at.of

    def _better(self, motion: str, degree: int, of: Fraction) -> tuple[_Tree | None, bool]:
        """Return a tree that is better at another rate of a motion, or ``None``, and whether this is proved.

        The other rate is the root of ``of`` of this degree. All rates are raised to the degree: then this
        rate is rational, and the order of trees by success stays the same.
        """
        outcome, better = self._compared(_at_rate(self._problem, motion, degree, of))
        proved = outcome.status is Status.OPTIMAL
        if not better or outcome.units is None:
            return None, proved
        return self._seen(motion, outcome.units), proved

    def _unmoved(self) -> set[str]:
        """Return motions whose rates may rise to 1 while the tree stays optimal; many are tested at once.

        In the test, units with one of the motions, outside the tree, never fail. If the tree stays optimal,
        it also does when the rate of one motion alone rises, since no other tree gains more by that.
        Otherwise the motions by which the better tree gains are removed, and the test is repeated.
        """
        network, own_rates = self._problem.network, self._problem.own_rates
        motions = set(self.motions)
        while motions:
            others = {unit for unit in self._units if network.motions[unit] in motions}.difference(self._tree)
            sure = dict.fromkeys(others, Fraction(1)) | dict(own_rates)
            outcome, better = self._compared(replace(self._problem, own_rates=sure, as_seen=self._problem))
            if not better or outcome.units is None:
                return motions if outcome.status is Status.OPTIMAL else set()
            motions.difference_update(network.motions[unit] for unit in others.intersection(outcome.units))
        return motions

    def _compared(self, varied: Problem) -> tuple[Outcome, bool]:
        """Return the optimum at other rates, and whether it is better there than the envelope's own tree."""
        outcome = solve(varied, _SUCCESS, self._settings, Reporter())
        tree_success = _success(varied.costs(self._tree))
        rival_success = Fraction(0) if outcome.costs is None else _success(outcome.costs)
        self._holds.require(
            rival_success >= tree_success or outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE},
            lambda: f"at other success rates {outcome.status} is said, but the tree {self._tree} is better",
        )
        return outcome, rival_success > tree_success

    def _counted(self, units: Iterable[int]) -> Counter[str]:
        """Count the units by motion, without units that have a rate of their own."""
        network, own_rates = self._problem.network, self._problem.own_rates
        return Counter(network.motions[unit] for unit in units if unit not in own_rates)

    def _seen(self, motion: str, units: tuple[int, ...]) -> _Tree:
        network, own_rates = self._problem.network, self._problem.own_rates
        fixed = [unit for unit in units if network.motions[unit] != motion or unit in own_rates]
        factor = math.prod(map(self._problem.rate, fixed), start=Fraction(1))
        return _Tree(units, len(units) - len(fixed), factor)


def _at_rate(problem: Problem, motion: str, degree: int, of: Fraction) -> Problem:
    """Return a problem with all rates raised to a degree; ``of`` is the raised rate of the motion."""
    raised = {name: rate**degree for name, rate in (problem.rates or {}).items()}
    own_rates = {unit: rate**degree for unit, rate in problem.own_rates.items()}
    return replace(problem, rates=raised | {motion: of}, own_rates=own_rates, as_seen=problem)


def _success(costs: Costs) -> Fraction:
    return Fraction(costs.measure(Objective.SUCCESS))
