"""The state equation alone, strengthened by mixed-integer rounding: bounds, and counts of least cost.

The rows are about counts only, without indicators. Rows of the inverse basis of its relaxation are weights of
rows which add up to one that a fractional solution violates once it is rounded (Gomory 1960; Nemhauser &
Wolsey 1990): where ``sum a[j] x[j] >= b`` holds of counts from 0, and ``f`` is the fractional part of ``b``,
so does ``sum (floor(a[j]) + min(1, fraction(a[j]) / f)) x[j] >= ceil(b)``. Weights may be any numbers from 0, so
floats only suggest them.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from operator import itemgetter

from foon_asp.plans.conditions import (
    Balance,
    Condition,
    Landmark,
    Level,
    Remainder,
    Rounded,
    Sum,
    SumLimit,
    Supply,
)
from foon_asp.plans.flows import Flows
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import INTEGRALITY, Solved, WholeProgram

_Row = tuple[dict[int, int], int]


class StateEquation:
    """The conditions on counts alone as rows: balances, sums of executions, levels, and rounded rows."""

    def __init__(
        self,
        flows: Flows,
        limits: Sequence[SumLimit],
        expired: Callable[[], bool],
    ) -> None:
        self._flows = flows
        self.program = WholeProgram(len(flows.asks), expired)
        self._conditions: list[Condition | None] = []  # of each row, if it is about counts alone
        self._indicators: dict[int, int] = {}  # columns, of a few actions
        for o, change, least in flows.balances():
            self.add(Balance(o), change, least - flows.start.get(o, 0))
        for number, (weights, limit, at_least, used) in enumerate(limits):
            sign = 1 if at_least else -1
            if not used:
                self.add(Sum(number), {a: sign * weight for a, weight in weights.items()}, sign * limit)

    def keep(self, level: Level) -> None:
        """Add the row that counts are as good by a level as the incumbent."""
        # without the costs of items, which have no columns, the row is weaker
        costs = level.measure.costs
        self.add(level, {a: -cost for a, cost in enumerate(costs) if cost}, -level.max_cost)

    def add(self, condition: Condition, row: dict[int, int], least: int) -> None:
        """Add the row of a condition."""
        self.program.row(row, least)
        self._conditions.append(condition)

    def add_landmark(self, landmark: Landmark) -> bool:
        """Add the row of a landmark, of executions of its members; return whether it can be stated."""
        if landmark.stock:
            return False
        row, least = dict.fromkeys(landmark.members, 1), 1
        if landmark.action is not None:
            indicator = self._indicator(landmark.action)
            if indicator is None:
                return False
            row[indicator], least = -1, 0
        self._add_row(row, least)
        return True

    def add_copies(self, condition: Supply | Remainder) -> bool:
        """Add the row of copies that an executed action asks for or leaves; return whether it can be stated."""
        indicator = self._indicator(condition.action)
        if indicator is None:
            return False
        row = {**self._flows.change(condition), indicator: -condition.copies}
        self._add_row(row, -self._flows.start.get(condition.object, 0))
        return True

    def _indicator(self, action: int) -> int | None:
        """Return the column that is 1 if an action is executed; ``None`` if it has no bound on its count."""
        max_count = self.program.upper[action]
        if action not in self._indicators and max_count is not None:
            self._indicators[action] = self.program.column(0, 1)
            self._add_row({self._indicators[action]: max_count, action: -1}, 0)
        return self._indicators.get(action)

    def _add_row(self, row: dict[int, int], least: int) -> None:
        self.program.row(row, least)
        self._conditions.append(None)

    @property
    def rounded(self) -> Iterator[tuple[Rounded, dict[int, int], int]]:
        """The rounded rows, with the conditions that they follow from."""
        for number, condition in enumerate(self._conditions):
            if isinstance(condition, Rounded):
                yield condition, *self.program.row_of(number)

    def optimum(self, costs: Sequence[int]) -> list[float] | None:
        """Return whole values of least cost in floats; ``None`` if HiGHS finds none, or when time is up."""
        objective = {a: cost for a, cost in enumerate(costs) if cost}
        x = self.strengthen(objective).x
        if x is None or all(abs(value - round(value)) < INTEGRALITY for value in x):
            return x
        least = sum(cost * x[a] for a, cost in objective.items())
        # HiGHS has cuts of its own, and is slower with rows of great coefficients
        program = self.program.without(
            {row for row, condition in enumerate(self._conditions) if isinstance(condition, Rounded)}
        )
        return program.whole_optimum(objective, math.ceil(least - INTEGRALITY * max(1.0, abs(least))))

    def strengthen(self, costs: Mapping[int, int], cutoff: float | None = None) -> Solved:
        """Add rounded rows while they raise the bound; return the last solution of the relaxation.

        A bound above ``cutoff`` is enough; without one, none is proved.
        """
        program, value = self.program, -math.inf
        while True:
            if cutoff is None:
                solved = Solved(program.relaxation(costs).x, -math.inf)
            else:
                solved = program.solve(costs, cutoff)
            if solved.x is None or (cutoff is not None and solved.bound > cutoff):
                return solved
            previous, value = value, sum(cost * solved.x[a] for a, cost in costs.items())
            if value < previous + INTEGRALITY * max(1.0, abs(previous)) or not self._round(solved.x):
                return solved

    def _round(self, x: Sequence[float]) -> bool:
        """Add the rounded rows that a solution violates most; return whether there are any."""
        candidates: dict[tuple[tuple[int, int], ...], tuple[float, Rounded, _Row]] = {}
        for weights in self.program.inverse_rows(x):
            of_counts = {row: weight for row, weight in weights.items() if self._conditions[row]}
            for sign in (1, -1):
                shares = {row: _share(sign * weight) for row, weight in of_counts.items()}
                rounded = self._rounded({row: share for row, share in shares.items() if share})
                if rounded is None:
                    continue
                condition, (row, least) = rounded
                length = math.sqrt(sum(coefficient**2 for coefficient in row.values()))
                violation = (least - sum(n * x[column] for column, n in row.items())) / length
                if violation > INTEGRALITY:
                    candidates[tuple(sorted(row.items()))] = violation, condition, (row, least)
        for _, condition, (row, least) in sorted(candidates.values(), key=itemgetter(0))[-PLANS.rounded_rows :]:
            self.add(condition, row, least)
        return bool(candidates)

    def _rounded(self, weights: Mapping[int, Fraction]) -> tuple[Rounded, _Row] | None:
        """Return the rounded sum of weighted rows, scaled to whole numbers; ``None`` where it says nothing."""
        parts = math.lcm(*(weight.denominator for weight in weights.values()))
        coefficients: dict[int, int] = {}
        least = 0
        for number, weight in weights.items():
            times = int(weight * parts)
            row, wanted = self.program.row_of(number)
            least += times * wanted
            for column, coefficient in row.items():
                coefficients[column] = coefficients.get(column, 0) + times * coefficient
        part = least % parts
        if not part:
            return None
        sums = {column: n // parts * part + min(part, n % parts) for column, n in coefficients.items()}
        least = -(-least // parts) * part
        common = math.gcd(least, *sums.values())
        scale = Fraction(part, common)
        if scale > PLANS.rounding_denominator:
            return None
        conditions = ((self._conditions[row], weight) for row, weight in weights.items())
        condition = Rounded(tuple((part, weight) for part, weight in conditions if part), scale)
        return condition, ({column: n // common for column, n in sums.items() if n}, least // common)


def _share(weight: float) -> Fraction:
    """Return the fractional part of a weight: whole multiples of a row only add what is whole already."""
    share = Fraction(weight).limit_denominator(PLANS.rounding_denominator)
    return share - math.floor(share)
