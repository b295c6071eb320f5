"""Help at a price: questions in which nothing is counted, whose answers are those of questions that count."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Status
from foon_asp.asp.ranking import Ranked
from foon_asp.problem import Costs, Objective, Problem

_FINEST = 10_000  # denominators of prices that are not those of motions
_TRIES = 8  # prices between two neighbours


class _Answer(NamedTuple):
    """The best tree at a price, how often it succeeds with the price paid, and how many units are helped.

    Fewer than ``fewest`` or more than ``most`` it cannot be: those from ``fewest`` on are worth their price
    exactly.
    """

    units: tuple[int, ...]
    success: Fraction
    fewest: int
    most: int


class PricedHelp:
    """Trees in which every unit done by a person costs a factor of success, the price, below 1.

    Let S be the best success at price q. A tree with help for at most M units then succeeds no more often
    than S / q^M, since it would be better at that price otherwise. The best tree at the price does so where
    M is as many units as are worth their price in it: then it is best for M, by fewest units too, since
    every other tree that is as good is as good at the price. At a price there is nothing to count, so that
    the reductions do their work. Where no price has such a tree, all are looked at that are good enough at
    the price that bounds success best.

    ``stopped`` says that a limit came before an answer.
    """

    def __init__(
        self,
        problem: Problem,
        better: Mapping[str, Fraction],
        solve: Callable[[Problem], Outcome],
        ranked: Callable[[Problem], Ranked],
    ) -> None:
        """Take the person's rates of the motions that the person does better than the robot.

        ``solve`` and ``ranked`` answer questions about success.
        """
        self._problem, self._better = problem, better
        self._solve, self._ranked = solve, ranked
        self.stopped = False
        rates = self._rates = problem.rates or {}
        self._worth = {motion: rates[motion] / rate for motion, rate in better.items()}
        self._prices = sorted({*self._worth.values(), Fraction(1)})
        self._answers: dict[Fraction, _Answer | None] = {}

    def best(self, most: int, trees: int | None = None) -> tuple[int, ...] | None:
        """Give the best tree with help for at most ``most`` units, proved, in an order that executes.

        ``None`` if a limit was reached, or if more than ``trees`` trees would have to be examined.
        """
        found = self._at_one_price(most)
        return self._in_order(most, trees) if found is None and not self.stopped else found

    def _at_one_price(self, most: int) -> tuple[int, ...] | None:
        low, high = -1, len(self._prices)
        while high - low > 1:
            middle = (low + high) // 2
            answer = self._at(self._prices[middle])
            if answer is None:
                return None
            if answer.fewest <= most <= answer.most:
                return answer.units
            if answer.fewest > most:
                high = middle
            else:
                low = middle
        return self._between(self._prices[low], self._prices[high], most)

    def _in_order(self, most: int, trees: int | None) -> tuple[int, ...] | None:
        """Look at one tree after another, in order of success at the price that bounds success best."""
        best = self.good(most)
        if best is None:
            return None
        _, price = min(self._bounds(most))
        ranked = self._ranked(self._at_price(price))
        for number, (units, costs) in enumerate(ranked):
            if (costs.success or 0) / price**most < (self.costs(best, most).success or 0):
                return best
            if number == trees:
                return None
            best = min(best, units, key=lambda tree: self._key(tree, most))
        self.stopped = not ranked.complete
        return None if self.stopped else best

    def bound(self, most: int) -> Fraction | None:
        """Give a success that no tree with help for ``most`` units exceeds, if one is known."""
        return min(self._bounds(most), default=(None,))[0]

    def good(self, most: int) -> tuple[int, ...] | None:
        """Give the best known tree with help for ``most`` units."""
        known = {answer.units for answer in self._answers.values() if answer is not None}
        return min(known, key=lambda tree: self._key(tree, most), default=None)

    def costs(self, units: Sequence[int], most: int) -> Costs:
        """Compute what a tree costs with help for ``most`` of its units."""
        motions, helped = self._problem.network.motions, self.helped(units, most)
        own = {unit: self._better[motions[unit]] for unit in helped}
        return replace(self._problem, own_rates=own).costs(units)

    def helped(self, units: Sequence[int], most: int) -> frozenset[int]:
        """Choose of a tree's units those that the person does: where that makes most of a difference."""
        motions = self._problem.network.motions
        worth = sorted((self._worth[motions[u]], u) for u in units if motions[u] in self._worth)
        return frozenset(unit for _, unit in worth[:most])

    def _between(self, small: Fraction, large: Fraction, most: int) -> tuple[int, ...] | None:
        """Look between two prices at which too few and too many units are helped.

        Where the two trees are worth the same is where a third one may be better than both.
        """
        for _ in range(_TRIES):
            few, many = self._answers[small], self._answers[large]
            assert few is not None
            assert many is not None
            logs = [
                _log(few.success) - few.most * _log(small),
                _log(many.success) - many.fewest * _log(large),
            ]
            guess = math.exp((logs[0] - logs[1]) / (many.fewest - few.most))
            price = Fraction(guess).limit_denominator(_FINEST)
            answer = self._at(price) if small < price < large else None
            if answer is None:
                return None
            if answer.fewest <= most <= answer.most:
                return answer.units
            if answer.fewest > most:
                if answer.fewest == many.fewest:
                    return None
                large = price
            else:
                if answer.most == few.most:
                    return None
                small = price
        return None

    def _bounds(self, most: int) -> list[tuple[Fraction, Fraction]]:
        """Give for each price tried what it bounds success by, and the price."""
        known = ((price, answer) for price, answer in self._answers.items() if answer is not None)
        return [(answer.success / price**most, price) for price, answer in known]

    def _key(self, units: tuple[int, ...], most: int) -> tuple[object, ...]:
        """Put trees in order, and those that are as good as each other too, so that answers stay the same."""
        return (*self.costs(units, most).key((Objective.SUCCESS, Objective.UNITS)), sorted(units))

    def _at_price(self, price: Fraction) -> Problem:
        paid = {m: max(rate, self._better.get(m, 0) * price) for m, rate in self._rates.items()}
        return replace(self._problem, rates=paid)

    def _at(self, price: Fraction) -> _Answer | None:
        if price not in self._answers:
            outcome = self._solve(self._at_price(price))
            found = None
            self.stopped = outcome.status in {Status.FEASIBLE, Status.UNKNOWN}
            if outcome.status is Status.OPTIMAL and outcome.units is not None and outcome.costs is not None:
                motions = self._problem.network.motions
                worth = [self._worth[motions[u]] for u in outcome.units if motions[u] in self._worth]
                free = price == 1  # then more help than can be used is no loss
                found = _Answer(
                    outcome.units,
                    outcome.costs.success or Fraction(0),
                    sum(each < price for each in worth),
                    len(self._problem.network) if free else sum(each <= price for each in worth),
                )
            self._answers[price] = found
        return self._answers[price]


def _log(value: Fraction) -> float:
    return math.log(value.numerator) - math.log(value.denominator)
