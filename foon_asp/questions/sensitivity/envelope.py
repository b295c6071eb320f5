"""Where the best tree by success stops being it as one rate changes: solving at one rate after another."""

import math
from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.problem import Costs, Objective, Problem, levels, reach, relevant
from foon_asp.problem.root import Root
from foon_asp.questions.sensitivity.interval import End, Interval

_SUCCESS = (Objective.SUCCESS,)
_TINY = Fraction(1, 10**9)  # a rate at which a motion is as good as forbidden, mostly
_HALF = Fraction(1, 2)


class _Tree(NamedTuple):
    """A tree as one motion sees it: at a rate x it succeeds as often as ``rest`` * x^``power``.

    ``best`` says that it is proved to be the best where it was looked for.
    """

    units: tuple[int, ...]
    power: int
    rest: Fraction
    best: bool


class Envelope:
    """The best trees as one rate changes, as far as it takes to find where the one in hand stops being it.

    docs/questions.md has the argument. ``motions`` are those that a tree for the goals may have.
    """

    def __init__(self, problem: Problem, tree: tuple[int, ...], how: Settings) -> None:
        self._problem, self._tree, self._how = problem, tree, how
        self._holds = Postconditions(problem, levels(_SUCCESS), how)
        reached = reach(problem)
        # A unit that the goals cannot need makes no tree better, but rules of the user's may ask for it.
        plain = not how.constraints and how.replaced is None
        self._units = relevant(problem, reached) if plain else reached.units
        self._most = self._counted(self._units)
        self.motions = sorted(self._most)
        self._looser: Problem | None = None
        if not plain:
            from foon_asp.certificate import coverage  # noqa: PLC0415 (for constraints alone)

            self._looser = _without(problem, coverage(how).forbids(problem))
        try:
            self._settled = self._unmoved()
        except KeyboardInterrupt:
            how.begun.interrupt()
            self._settled = set()

    def interval(self, motion: str) -> Interval:
        """Find the interval of one motion; at a limit, what is known of it."""
        rate = (self._problem.rates or {})[motion]
        tree = self._seen(motion, self._tree, best=True)
        ends = []
        for search in (self._below, self._above):
            try:
                ends.append(search(motion, tree))
            except KeyboardInterrupt:
                self._how.begun.interrupt()
                ends.append(End(None, None, proved=False))
        return Interval(motion, rate, tree.power, *ends)

    def _above(self, motion: str, tree: _Tree) -> End:
        """Find the greatest rate at which the tree is optimal."""
        rate = (self._problem.rates or {})[motion]
        if rate == 1 or self._most[motion] == tree.power or motion in self._settled:
            return End(None, None)
        return self._end_from(motion, tree, Fraction(1))

    def _below(self, motion: str, tree: _Tree) -> End:
        """Find the least rate at which the tree is optimal."""
        if not tree.power or self._ruled_out(motion, 0, _HALF):
            return End(None, None)
        rate = (self._problem.rates or {})[motion]
        tiny = _TINY if rate > _TINY else rate * _TINY
        end = self._end_from(motion, tree, tiny)
        if end.at is not None or not end.proved:
            return end
        # A tree with fewer units of the motion is better below some rate, and if it has all other units there
        # are, below this one; it would be better than the best there.
        if self._rest(motion, self._units) > tree.rest * tiny:
            return end
        rival, proved = self._better(motion, 0, _HALF)  # all others are 1: the fewest units of it
        return (
            End(None, None, proved)
            if rival is None
            else self._end_at(motion, tree, rival._replace(best=False))
        )

    def _end_from(self, motion: str, tree: _Tree, far: Fraction) -> End:
        """Find the end on the way to a rate that is far away, if another tree is better there."""
        rival, proved = self._better(motion, 1, far)
        return End(None, None, proved) if rival is None else self._end_at(motion, tree, rival)

    def _end_at(self, motion: str, tree: _Tree, rival: _Tree) -> End:
        """Go from a tree that is better far away towards the rate, to the nearest end."""
        rate = Root(1, (self._problem.rates or {})[motion])
        while True:
            more, fewer = (rival, tree) if rival.power > tree.power else (tree, rival)
            end = Root.taken(more.power - fewer.power, fewer.rest / more.rest)
            if end == rate or (rival.best and more.power - fewer.power == 1):
                return End(end, rival.units)
            nearer, proved = self._better(motion, end.degree, end.of)
            if nearer is None:
                return End(end, rival.units, proved)
            rival = nearer

    def _better(self, motion: str, degree: int, of: Fraction) -> tuple[_Tree | None, bool]:
        """Look for a tree that is better than the one in hand at another rate, and say if that is proved.

        The rate is a root of this degree of a number. All rates are raised to that degree, which makes it
        rational and leaves products in the order in which they are.
        """
        if self._ruled_out(motion, degree, of):
            return None, True
        outcome, better = self._compared(_at_rate(self._problem, motion, degree, of))
        proved = outcome.status is Status.OPTIMAL
        if not better or outcome.units is None:
            return None, proved
        return self._seen(motion, outcome.units, proved), proved

    def _ruled_out(self, motion: str, degree: int, of: Fraction) -> bool:
        """Say whether even without the constraints no tree is better at another rate.

        What they rule out unit by unit is left out. This is fast: there is mostly nothing to search.
        """
        if self._looser is None:
            return False
        ours = _success(_at_rate(self._problem, motion, degree, of).costs(self._tree))
        free = self._how._replace(constraints=(), constants=(), encodings=None)
        bound = solve(_at_rate(self._looser, motion, degree, of), _SUCCESS, free, Reporter())
        return bound.status is Status.OPTIMAL and bound.costs is not None and _success(bound.costs) <= ours

    def _unmoved(self) -> set[str]:
        """Find motions whose rates may be as great as can be, many at once.

        If the tree is optimal where all units but its own that have one of these motions never fail, it is so
        where the rate of one of the motions rises: other trees gain no more by that. If it is not, the
        motions by which another tree gains are left out.
        """
        network, own = self._problem.network, self._problem.own_rates
        motions = set(self.motions)
        while motions:
            others = {unit for unit in self._units if network.motions[unit] in motions}.difference(self._tree)
            sure = dict.fromkeys(others, Fraction(1)) | dict(own)
            outcome, better = self._compared(replace(self._problem, own_rates=sure, as_seen=self._problem))
            if not better or outcome.units is None:
                return motions if outcome.status is Status.OPTIMAL else set()
            motions.difference_update(network.motions[unit] for unit in others.intersection(outcome.units))
        return motions

    def _compared(self, there: Problem) -> tuple[Outcome, bool]:
        """Find the best tree at other rates, and say whether it is better there than the one in hand."""
        outcome = solve(there, _SUCCESS, self._how, Reporter())
        ours = _success(there.costs(self._tree))
        theirs = Fraction(0) if outcome.costs is None else _success(outcome.costs)
        self._holds.require(
            theirs >= ours or outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE},
            lambda: f"at other success rates {outcome.status} is said, but the tree {self._tree} is better",
        )
        return outcome, theirs > ours

    def _counted(self, units: Iterable[int]) -> Counter[str]:
        """Count the units of each motion whose rate is that of the motion."""
        network, own = self._problem.network, self._problem.own_rates
        return Counter(network.motions[unit] for unit in units if unit not in own)

    def _seen(self, motion: str, units: tuple[int, ...], best: bool) -> _Tree:
        return _Tree(
            units, sum(self._varies(motion, unit) for unit in units), self._rest(motion, units), best
        )

    def _rest(self, motion: str, units: Iterable[int]) -> Fraction:
        """Multiply the rates of units that do not vary with that of the motion."""
        fixed = (self._problem.rate(unit) for unit in units if not self._varies(motion, unit))
        return math.prod(fixed, start=Fraction(1))

    def _varies(self, motion: str, unit: int) -> bool:
        return self._problem.network.motions[unit] == motion and unit not in self._problem.own_rates


def _at_rate(problem: Problem, motion: str, degree: int, of: Fraction) -> Problem:
    """Raise all rates of a problem to the degree of a root, which the rate of a motion is."""
    raised = {name: rate**degree for name, rate in (problem.rates or {}).items()}
    own = {unit: rate**degree for unit, rate in problem.own_rates.items()}
    return replace(problem, rates=raised | {motion: of}, own_rates=own, as_seen=problem)


def _success(costs: Costs) -> Fraction:
    return Fraction(costs.measure(Objective.SUCCESS))


def _without(problem: Problem, units: Collection[int]) -> Problem:
    """Leave units out of a problem, whose others keep the rates that are their own."""
    kept = [unit for unit in range(len(problem.network)) if unit not in units]
    own = {place: problem.own_rates[unit] for place, unit in enumerate(kept) if unit in problem.own_rates}
    return replace(problem, network=problem.network.without(units), own_rates=own)
