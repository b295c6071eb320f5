"""Where the best tree by success stops being it as one rate changes: solving at one rate after another."""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.problem import Costs, Objective, Problem, levels, reach, relevant
from foon_asp.problem.root import Root

_SUCCESS = (Objective.SUCCESS,)
_TINY = Fraction(1, 10**9)  # a rate at which a motion is as good as forbidden, mostly


class _Tree(NamedTuple):
    """A tree as one motion sees it: at a rate x it succeeds as often as ``rest`` * x^``power``."""

    units: tuple[int, ...]
    power: int
    rest: Fraction


class End(NamedTuple):
    """How far a rate may go to one side, and the best tree beyond.

    ``at`` is where another tree is as good, and beyond it better: ``beyond``, its units by id in an order
    that executes. Both are ``None`` where no rate on that side makes another tree better. ``proved`` says
    that this is the end; where it is false a limit came first, and the end may be nearer to the rate.
    """

    at: Root | None
    beyond: tuple[int, ...] | None
    proved: bool = True


class Envelope:
    """The best trees as one rate changes, as far as it takes to find where the one in hand stops being it.

    docs/dev/questions.md has the argument. ``motions`` are those that a tree for the goals may have.
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
        try:
            self._settled = self._unmoved()
        except KeyboardInterrupt:
            how.begun.interrupt()
            self._settled = set()

    def units(self, motion: str) -> int:
        """Return how many units of the tree have the rate of a motion."""
        return self._counted(self._tree)[motion]

    def end(self, motion: str, above: bool) -> End:
        """Find how far the rate of a motion may go up or down; at a limit, as far as it is known."""
        rate, units = (self._problem.rates or {})[motion], self.units(motion)
        if above and (rate == 1 or self._most[motion] == units or motion in self._settled):
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
                and everything.rest <= self._seen(motion, self._tree).rest * tiny
            ):
                end = self._end_from(motion, 0, Fraction(1, 2))
            return end
        except KeyboardInterrupt:
            self._how.begun.interrupt()
            return End(None, None, proved=False)

    def _end_from(self, motion: str, degree: int, of: Fraction) -> End:
        """Go from a rate that is far away towards that of a motion, from one better tree to another.

        At degree 0 all other rates are 1, so that the tree with the fewest units of the motion is found.
        """
        tree = self._seen(motion, self._tree)
        rate = Root(1, (self._problem.rates or {})[motion])
        found = End(None, None)
        while True:
            rival, proved = self._better(motion, degree, of)
            if rival is None:
                return found._replace(proved=proved)
            more, fewer = (rival, tree) if rival.power > tree.power else (tree, rival)
            at = Root.taken(more.power - fewer.power, fewer.rest / more.rest)
            found = End(at, rival.units)
            if at == rate or (degree and proved and more.power - fewer.power == 1):
                return found
            degree, of = at.degree, at.of

    def _better(self, motion: str, degree: int, of: Fraction) -> tuple[_Tree | None, bool]:
        """Look for a tree that is better than the one in hand at another rate, and say if that is proved.

        The rate is a root of this degree of a number. All rates are raised to that degree, which makes it
        rational and leaves products in the order in which they are.
        """
        outcome, better = self._compared(_at_rate(self._problem, motion, degree, of))
        proved = outcome.status is Status.OPTIMAL
        if not better or outcome.units is None:
            return None, proved
        return self._seen(motion, outcome.units), proved

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

    def _seen(self, motion: str, units: tuple[int, ...]) -> _Tree:
        network, own = self._problem.network, self._problem.own_rates
        fixed = [unit for unit in units if network.motions[unit] != motion or unit in own]
        rest = math.prod(map(self._problem.rate, fixed), start=Fraction(1))
        return _Tree(units, len(units) - len(fixed), rest)


def _at_rate(problem: Problem, motion: str, degree: int, of: Fraction) -> Problem:
    """Raise all rates of a problem to the degree of a root, which the rate of a motion is."""
    raised = {name: rate**degree for name, rate in (problem.rates or {}).items()}
    own = {unit: rate**degree for unit, rate in problem.own_rates.items()}
    return replace(problem, rates=raised | {motion: of}, own_rates=own, as_seen=problem)


def _success(costs: Costs) -> Fraction:
    return Fraction(costs.measure(Objective.SUCCESS))
