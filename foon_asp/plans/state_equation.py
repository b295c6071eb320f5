"""The state equation alone, strengthened by mixed-integer rounding: bounds, and counts of least cost.

The rows are about counts only, without indicators. A row of the inverse basis of the relaxation gives each
row of the program a weight. The weighted sum of rows is then rounded to a row that a fractional solution
violates (Gomory 1958; Nemhauser & Wolsey 1990).

If ``sum a[j] x[j] >= b`` holds for counts from 0, and ``f`` is the fractional part of ``b``, then ``sum
(floor(a[j]) + min(1, fraction(a[j]) / f)) x[j] >= ceil(b)`` holds, too. This is valid for any weights from 0,
so it is enough to find weights in floats.
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


class RoundedProgram:
    """A linear program over counts, whose rows are sums of conditions; rounded rows can be added.

    ``expired`` returns whether time is up; solving then raises :class:`Stopped`.
    """

    def __init__(self, columns: int, expired: Callable[[], bool]) -> None:
        """Make a program with this number of columns and without rows."""
        self.program = WholeProgram(columns, expired)
        self._conditions: list[
            Sequence[Condition]
        ] = []  # of each row; empty if the row is about more than counts

    def add(self, conditions: Sequence[Condition], row: dict[int, int], least: int) -> None:
        """Add a row, which is the sum of ``conditions``; a row without conditions is never rounded."""
        self.program.add_row(row, least)
        self._conditions.append(conditions)

    @property
    def rounded_rows(self) -> Iterator[tuple[Rounded, dict[int, int], int]]:
        """The rounded rows, each with its condition, its coefficients by column, and its least sum."""
        for number, conditions in enumerate(self._conditions):
            for condition in conditions:
                if isinstance(condition, Rounded):
                    yield condition, *self.program.row_of(number)

    def strengthen(self, costs: Mapping[int, int], cutoff: float | None = None) -> Solved:
        """Add rounded rows while they increase the cost; return the last solution of the relaxation.

        The search for rows ends at a proved bound above ``cutoff``. Without a cutoff, no bound is proved, and
        the bound of the result is -infinity. Raises :class:`Stopped` if time is up.
        """
        program, cost_of_solution, stalled_rounds = self.program, -math.inf, 0
        while True:
            if cutoff is None:
                solved = Solved(program.relaxation(costs).x, -math.inf)
            else:
                solved = program.solve(costs, cutoff)
            if solved.x is None or (cutoff is not None and solved.bound > cutoff):
                return solved
            previous_cost, cost_of_solution = (
                cost_of_solution,
                sum(cost * solved.x[a] for a, cost in costs.items()),
            )
            stalled_rounds = (
                stalled_rounds + 1
                if cost_of_solution < previous_cost + INTEGRALITY * max(1.0, abs(previous_cost))
                else 0
            )
            if stalled_rounds > PLANS.stalled_rounds or not self._add_rounded_rows(solved.x):
                return solved

    def _add_rounded_rows(self, x: Sequence[float]) -> bool:
        """Add the rounded rows that the last solution ``x`` violates most; return whether there are any."""
        violated: dict[tuple[tuple[int, int], ...], tuple[float, Rounded, _Row]] = {}
        for floats in self.program.inverse_rows(x):
            for sign in (1, -1):
                shares = {
                    row: _fraction_of_weight(sign * floats[row]) for row in floats if self._conditions[row]
                }
                rounded = self._round_sum({row: share for row, share in shares.items() if share})
                if rounded is None:
                    continue
                condition, (row, least) = rounded
                length = math.sqrt(sum(coefficient**2 for coefficient in row.values()))
                violation = (least - sum(n * x[column] for column, n in row.items())) / length
                if violation > INTEGRALITY:
                    violated[tuple(sorted(row.items()))] = violation, condition, (row, least)
        for _, condition, (row, least) in sorted(violated.values(), key=itemgetter(0))[-PLANS.rounded_rows :]:
            self.add((condition,), row, least)
        return bool(violated)

    def _round_sum(self, weights: Mapping[int, Fraction]) -> tuple[Rounded, _Row] | None:
        """Return the rounded sum of rows with these weights: its condition, and its row in whole numbers.

        Return ``None`` if rounding changes nothing. Also return ``None`` if the row would have to be
        multiplied by too large a number to become whole.
        """
        denominator = math.lcm(*(weight.denominator for weight in weights.values()))
        coefficients: dict[int, int] = {}
        least = 0
        for number, weight in weights.items():
            times = int(weight * denominator)
            row, row_least = self.program.row_of(number)
            least += times * row_least
            for column, coefficient in row.items():
                coefficients[column] = coefficients.get(column, 0) + times * coefficient
        fraction = least % denominator
        if not fraction:
            return None
        sums = {
            column: n // denominator * fraction + min(fraction, n % denominator)
            for column, n in coefficients.items()
        }
        least = -(-least // denominator) * fraction
        common = math.gcd(least, *sums.values())
        if not common:
            return None
        scale = Fraction(fraction, common)
        if scale > PLANS.rounding_denominator:
            return None
        conditions = (
            (condition, weight) for row, weight in weights.items() for condition in self._conditions[row]
        )
        return Rounded(tuple(conditions), scale), (
            {column: n // common for column, n in sums.items() if n},
            least // common,
        )


def _fraction_of_weight(weight: float) -> Fraction:
    """Return the fractional part of a weight of a row, as a fraction with a small denominator.

    The whole part is dropped, since whole multiples of a row need no rounding.
    """
    share = Fraction(weight).limit_denominator(PLANS.rounding_denominator)
    return share - math.floor(share)


class StateEquation(RoundedProgram):
    """The conditions on counts alone as rows: balances, limits on sums, levels, and rounded rows.

    Landmarks, supplies and remainders may be added. Actions that they mention get an indicator: a column that
    is 1 if the action is executed at all.

    ``caps``: an upper bound on the count of each action, or ``None``; empty if there are no bounds.
    """

    def __init__(
        self,
        flows: Flows,
        limits: Sequence[SumLimit],
        caps: Sequence[int | None],
        expired: Callable[[], bool],
    ) -> None:
        """Build the program with the balances, and the limits that count each execution."""
        super().__init__(len(flows.asks), expired)
        self._flows, self._expired = flows, expired
        for action, cap in enumerate(caps):
            if cap is not None:
                self.program.cap(action, cap)
        self._caps = list(self.program.upper)
        self._indicators: dict[int, int] = {}  # column by action
        for o, change, least in flows.balances():
            self.add((Balance(o),), change, least - flows.start.get(o, 0))
        for number, (weights, limit, at_least, counts_once) in enumerate(limits):
            sign = 1 if at_least else -1
            if not counts_once:
                self.add((Sum(number),), {a: sign * weight for a, weight in weights.items()}, sign * limit)

    def add_level(self, level: Level) -> None:
        """Add the row of a level: the cost, without items, is at most its ``max_cost``."""
        # without the costs of items, which have no columns, the row is weaker
        costs = level.measure.costs
        self.add((level,), {a: -cost for a, cost in enumerate(costs) if cost}, -level.max_cost)

    def add_landmark(self, landmark: Landmark) -> None:
        """Add the row of a landmark: a member is executed, or the landmark's action is not executed.

        Nothing is added if initial copies may satisfy the landmark, or if its action has no indicator.
        """
        row, least = dict.fromkeys(landmark.members, 1), 1
        indicator = None if landmark.action is None else self._indicator_column(landmark.action)
        if indicator is not None:
            row[indicator], least = -1, 0
        if not landmark.stock and (landmark.action is None) == (indicator is None):
            self.add((), row, least)

    def add_copies(self, condition: Supply | Remainder) -> None:
        """Add the row of a supply or remainder; add nothing if its action has no indicator."""
        indicator = self._indicator_column(condition.action)
        if indicator is not None:
            row = {**self._flows.copy_changes(condition), indicator: -condition.copies}
            self.add((), row, -self._flows.start.get(condition.object, 0))

    def _indicator_column(self, action: int) -> int | None:
        """Return the column that is 1 if an action is executed; ``None`` if its count is unbounded.

        The first call for an action adds the column and its row.
        """
        max_count = self._caps[action]
        if action not in self._indicators and max_count is not None:
            self._indicators[action] = self.program.add_column(0, 1)
            self.add((), {self._indicators[action]: max_count, action: -1}, 0)
        return self._indicators.get(action)

    def strengthen(self, costs: Mapping[int, int], cutoff: float | None = None) -> Solved:
        """Add rounded rows while they increase the cost; return the last solution of the relaxation.

        Parameters and result are those of :meth:`RoundedProgram.strengthen`. The first rows come from a
        smaller program that merges similar objects (:meth:`_round_alternatives`).
        """
        self._costs: Mapping[int, int] | None = costs
        return super().strengthen(costs, cutoff)

    def _add_rounded_rows(self, x: Sequence[float]) -> bool:
        """Add rounded rows that a solution violates; return whether there are any.

        The first call in :meth:`strengthen` tries rows of the program that merges similar objects before
        others.
        """
        if all(abs(value - round(value)) < INTEGRALITY for value in x):
            return False  # whole counts violate no rounded row
        costs, self._costs = self._costs, None
        return (costs is not None and self._round_alternatives(costs)) or super()._add_rounded_rows(x)

    def _round_alternatives(self, costs: Mapping[int, int]) -> bool:
        """Add rounded rows of a smaller program that merges similar objects; return whether any is added.

        Objects of one role (:attr:`Flows.roles`), such as planks of any wood, are merged: their balances are
        added up to one row. A row about a single object would be weak, since a solution can use another one.
        Actions that are alike in all rows and in cost share a column. If no actions share a column, nothing
        is added.
        """
        roles = self._flows.roles
        sums: dict[object, tuple[list[Condition], dict[int, int], int]] = {}
        for number, conditions in enumerate(self._conditions):
            for condition in conditions:
                role = roles[condition.object] if isinstance(condition, Balance) else -1 - number
                summands, row_sum, least = sums.get(role, ([], {}, 0))
                row, row_least = self.program.row_of(number)
                for column, coefficient in row.items():
                    row_sum[column] = row_sum.get(column, 0) + coefficient
                sums[role] = [*summands, condition], row_sum, least + row_least
        columns: dict[tuple[int, ...], list[int]] = {}
        for action in range(len(self._flows.asks)):
            signature = (costs.get(action, 0), *(row_sum.get(action, 0) for _, row_sum, _ in sums.values()))
            columns.setdefault(signature, []).append(action)
        if len(columns) == len(self._flows.asks):
            return False
        merged = RoundedProgram(len(columns), self._expired)
        members_by_column = list(columns.values())
        for summands, row_sum, least in sums.values():
            row = {column: row_sum.get(actions[0], 0) for column, actions in enumerate(members_by_column)}
            merged.add(summands, {column: n for column, n in row.items() if n}, least)
        earlier_count = len(list(merged.rounded_rows))
        merged.strengthen({column: signature[0] for column, signature in enumerate(columns) if signature[0]})
        for condition, row, least in list(merged.rounded_rows)[earlier_count:]:
            self.add(
                (condition,), {a: n for column, n in row.items() for a in members_by_column[column]}, least
            )
        return len(list(merged.rounded_rows)) > earlier_count

    def optimum(self, costs: Sequence[int]) -> list[float] | None:
        """Return whole counts of least cost, as far as floats tell; ``None`` if HiGHS finds none in time.

        Columns of indicators are included. Rounded rows are added first, which raises :class:`Stopped` if
        time is up.
        """
        objective = {a: cost for a, cost in enumerate(costs) if cost}
        x = self.strengthen(objective).x
        if x is None or all(abs(value - round(value)) < INTEGRALITY for value in x):
            return x
        least = sum(cost * x[a] for a, cost in objective.items())
        # HiGHS has cuts of its own, and is slower with rows of great coefficients
        program = self.program.without_rows(
            {
                row
                for row, conditions in enumerate(self._conditions)
                if conditions and isinstance(conditions[0], Rounded)
            }
        )
        return program.whole_optimum(objective, math.ceil(least - INTEGRALITY * max(1.0, abs(least))))
