"""The linear relaxation of counts of executions, with indicators.

Rows are conditions. Columns are the counts of actions, and the indicators of actions: 1 if the action is
executed at all. Further columns are auxiliary.
"""

from collections.abc import Callable, Sequence

from foon_asp.plans.conditions import (
    Balance,
    Condition,
    Counts,
    Landmark,
    Level,
    Measure,
    Sum,
    SumLimit,
)
from foon_asp.plans.flows import Flows
from foon_asp.plans.whole_program import WholeProgram


class CountModel:
    """The relaxation of counts: a linear program, and the conditions of its rows.

    ``program``: the program. Column ``a`` is the count of action ``a``. Column ``a`` plus the number of
    actions is the indicator of the action.
    ``conditions``: the condition of each row that states one, by row.
    ``stock``, ``items``: the columns of initial copies and of endless items by object, if they have costs.

    Parameters:
        flows: The preconditions and effects of actions.
        measures: The measures of objectives.
        landmarks: The landmarks known so far.
        limits: Limits on weighted sums.
        excluded_counts: A plan is excluded if it executes all actions at least as often as one entry
            says.
        assumed_cap: An upper bound that is assumed for counts that have none. If ``None``, nothing is
            assumed, and each class of a measure with exact costs has a column.
        expired: Returns whether time is up.
    """

    def __init__(
        self,
        flows: Flows,
        measures: Sequence[Measure],
        landmarks: Sequence[Landmark],
        limits: Sequence[SumLimit],
        excluded_counts: Sequence[Counts],
        assumed_cap: int | None,
        expired: Callable[[], bool],
    ) -> None:
        """Build the program with the rows of all conditions."""
        action_count, achievers_of = len(flows.asks), flows.achievers
        self._flows = flows
        self.program = program = WholeProgram(action_count, expired)
        self._action_count, self._assumed_cap = action_count, assumed_cap
        self.conditions: dict[int, Condition] = {}  # by row
        for _ in range(action_count):
            program.add_column(0, 1)  # whether an action is executed at all
        self._indicator_rows = [program.add_open_row((action_count + a, a), 0) for a in range(action_count)]
        for a in range(action_count):
            program.add_row({a: 1, action_count + a: -1}, 0)
        self._classes: dict[int, list[int]] = {}
        priced = any(measure.item for measure in measures)
        self.stock: dict[int, int] = {}
        if priced:
            self.stock = {o: program.add_column(0, count) for o, count in flows.start.items() if count}
        for o, change, least in flows.balances():
            self.conditions[program.add_row(*self._with_stock(o, change, least))] = Balance(o)
        for supply in flows.supplies:
            row = {**flows.copy_changes(supply), action_count + supply.action: -supply.copies}
            self.conditions[program.add_row(*self._with_stock(supply.object, row, 0))] = supply
        items = self.items = dict[int, int]()
        for action in range(action_count):
            indicator = action_count + action
            for o in (needed for needed in flows.asks[action] if needed not in flows.uses[action]):
                achievers = {action_count + achiever: 1 for achiever in achievers_of.get(o, ())}
                row_number = program.add_row(*self._with_stock(o, {**achievers, indicator: -1}, 0))
                if o in self.stock or not flows.start.get(o):  # otherwise an initial copy satisfies it
                    self.conditions[row_number] = Landmark((), (), action, (o,))
            for o in flows.items[action] if priced else ():
                if o not in items:
                    items[o] = program.add_column(0, 1)
                row_number = program.add_row({items[o]: 1, indicator: -1}, 0)
                self.conditions[row_number] = Landmark((), (), action, (o,))
        for landmark in landmarks:
            self.add_landmark(landmark)
        for i, (weights, limit, at_least, counts_once) in enumerate(limits):
            first_column, sign = action_count if counts_once else 0, 1 if at_least else -1
            row = {first_column + a: sign * weight for a, weight in weights.items()}
            self.conditions[program.add_row(row, sign * limit)] = Sum(i)
            for a, weight in weights.items() if not at_least and not counts_once else ():
                program.cap(a, max(limit, 0) // weight)
        for measure in measures:
            if measure.exact is not None and assumed_cap is None:
                self._add_classes(measure)
        self._count_indicators: dict[tuple[int, int], tuple[int, int]] = {}
        for counts in excluded_counts:
            columns = [self._count_indicator(a, n) for a, n in counts.items()]
            program.add_row(dict.fromkeys(columns, -1), 1 - len(columns))
        self.tighten()

    def _count_indicator(self, action: int, count: int) -> int:
        """Return the column that is 1 if an action is executed at least ``count`` times, and else 0.

        Unless ``count`` is 1, the column and its rows are added at the first call.
        """
        if count == 1:
            return self._action_count + action
        if (action, count) not in self._count_indicators:
            column = self.program.add_column(0, 1)
            self.program.add_row({action: 1, column: -count}, 0)
            self._count_indicators[action, count] = (
                column,
                self.program.add_open_row((column, action), 1 - count),
            )
        return self._count_indicators[action, count][0]

    def unforced_count(self, counts: Counts, x: Sequence[float]) -> tuple[int, int, int] | None:
        """Return an indicator that is 0 in ``x`` although ``counts`` reach its count.

        Only indicators of counts above 1 are considered. Return the action, the count and the column of the
        indicator; ``None`` if there is no such indicator.
        """
        for (action, count), (column, _) in self._count_indicators.items():
            if action in counts and counts[action] >= count and not round(x[column]):
                return action, count, column
        return None

    def _with_stock(self, o: int, row: dict[int, int], least: int) -> tuple[dict[int, int], int]:
        """Return a row and its least sum, changed so that the initial copies of an object are included.

        If the object has a column of initial copies, this column is added to the row. Otherwise, the number
        of copies is subtracted from the least sum.
        """
        if o in self.stock:
            return {**row, self.stock[o]: 1}, least
        return row, least - self._flows.start.get(o, 0)

    def _add_classes(self, measure: Measure) -> None:
        """Add a column for each class of actions of a measure, equal to the sum of their counts.

        Class -1 gets no column. The columns are kept for :meth:`class_columns`.
        """
        columns = []
        for number in sorted(set(measure.classes) - {-1}):
            members = [a for a, class_number in enumerate(measure.classes) if class_number == number]
            column = self.program.add_column(0, None)
            self.program.add_row({column: 1, **dict.fromkeys(members, -1)}, 0)
            self.program.add_row({column: -1, **dict.fromkeys(members, 1)}, 0)
            columns.append(column)
        self._classes[id(measure)] = columns

    def class_columns(self, measure: Measure) -> list[int]:
        """Return the columns of the classes of a measure, ascending by class.

        Raises ``KeyError`` if the measure has no such columns: its costs are exact, or a cap is assumed.
        """
        return self._classes[id(measure)]

    def add_landmark(self, landmark: Landmark) -> None:
        """Add the row of a landmark.

        Add nothing if an initial copy that has no column may satisfy the landmark.
        """
        members, stock, action, _ = landmark
        if not self.stock.keys() >= set(stock):
            return
        row = {self._action_count + member: 1 for member in members} | {self.stock[o]: 1 for o in stock}
        if action is None:
            row_number = self.program.add_row(row, 1)
        else:
            row_number = self.program.add_row({**row, self._action_count + action: -1}, 0)
        self.conditions[row_number] = landmark

    def tighten(self) -> None:
        """Adapt the rows that force an indicator to 1 if its action is executed.

        Their coefficients are the present upper bounds of counts. If a count has no upper bound, its row is
        made empty.
        """
        program = self.program
        for action, row in enumerate(self._indicator_rows):
            max_count = self._max_count(action)
            program.change_row(
                row, {} if max_count is None else {self._action_count + action: max_count, action: -1}
            )
        for (action, count), (column, row) in self._count_indicators.items():
            max_count = self._max_count(action)
            program.change_row(row, {} if max_count is None else {column: max_count - count + 1, action: -1})

    def _max_count(self, action: int) -> int | None:
        """Return the upper bound of an action's count, or else the assumed cap; ``None`` without both."""
        upper = self.program.upper[action]
        return self._assumed_cap if upper is None else upper

    def cap_counts(self, measure: Measure, max_cost: int) -> None:
        """Bound the count of each action so that its executions alone cost at most ``max_cost``.

        Then :meth:`tighten` the rows of indicators.
        """
        for action, cost in enumerate(measure.costs):
            if cost:
                self.program.cap(action, max(max_cost, 0) // cost)
        self.tighten()

    def objective(self, measure: Measure) -> dict[int, int]:
        """Return the costs of columns by a measure; columns without cost are omitted."""
        costs = {a: cost for a, cost in enumerate(measure.costs) if cost}
        if measure.item:
            costs |= dict.fromkeys((*self.items.values(), *self.stock.values()), measure.item)
        return costs

    def add_level(self, level: Level) -> None:
        """Add the row of a level: the cost is at most its ``max_cost``.

        This also caps the counts of single actions (:meth:`cap_counts`).
        """
        costs = self.objective(level.measure)
        row = self.program.add_row({column: -cost for column, cost in costs.items()}, -level.max_cost)
        self.conditions[row] = level
        self.cap_counts(level.measure, level.max_cost)

    def limit_cost(self, measure: Measure, solution: Sequence[float]) -> None:
        """Add a row: the cost by a measure is at most that of a solution, rounded to whole values."""
        costs = self.objective(measure)
        max_cost = sum(cost * round(solution[column]) for column, cost in costs.items())
        self.program.add_row({column: -cost for column, cost in costs.items()}, -max_cost)
