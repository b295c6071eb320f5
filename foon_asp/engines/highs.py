"""The same question as a mixed integer program, solved by HiGHS.

For every unit a 0-1 variable says that it is used; for every unit and node that it makes another one that
it is the maker of that node, and a level for every node that has to be made. A used unit has a maker for
each node it needs, and a made node stands above the nodes that its maker needs, so nothing supports itself.
"""

import time
from collections.abc import Iterable

from foon_asp.bounds.highs_run import libraries, silent_highs
from foon_asp.engines.engine import EngineAnswer, cost, scope_of, taken
from foon_asp.errors import BugError
from foon_asp.problem import Objective, Problem

NAME = "HiGHS"
_CLOSE = 1e-6  # within which HiGHS keeps to a sum of logarithms


def solve_with_highs(
    problem: Problem, objectives: tuple[Objective, ...], forbidden: frozenset[int], seconds: float
) -> EngineAnswer:
    """Find a best tree by all objectives, one after the other, each held where the ones before are best."""
    if not scope_of(problem, forbidden).goals:  # it has no variables then, and nothing to hold
        return EngineAnswer(NAME, objectives, (), True)
    end = time.monotonic() + seconds
    program = _Program(problem, forbidden)
    units: tuple[int, ...] | None = None
    for objective in objectives:
        status = program.minimize(objective, max(end - time.monotonic(), 0.001))
        if status != "optimal":
            found = status == "infeasible" and units is None
            return EngineAnswer(NAME, objectives, None, found)
        units = program.units()
        program.hold(objective)
    return EngineAnswer(NAME, objectives, units, True)


class _Program:
    """The mixed integer program of a problem."""

    def __init__(self, problem: Problem, forbidden: frozenset[int]) -> None:
        self._library, self._numpy = libraries()
        self._problem = problem
        scope = scope_of(problem, forbidden)
        self._highs = highs = silent_highs()
        for option, value in (
            ("threads", 1),
            ("mip_rel_gap", 0.0),
            ("mip_abs_gap", 1e-9),
            ("mip_detect_symmetry", False),  # with it, version 1.16.0 proves what is not the best
        ):
            highs.setOptionValue(option, value)
        needs, gives, levels = problem.needs, problem.gives, len(scope.objects) + 1
        self._use = {unit: self._variable(1, whole=True) for unit in scope.units}
        self._take = {o: self._variable(1, whole=True) for o in taken(problem, scope.units)}
        height = {o: self._variable(levels, whole=False) for o in scope.objects}
        makers: dict[int, list[tuple[int, float]]] = {o: [] for o in scope.objects}
        for unit, used in self._use.items():
            for o in set(gives[unit]) & height.keys() - set(needs[unit]):
                maker = self._variable(1, whole=True)
                makers[o].append((maker, 1.0))
                self._at_least(0, [(used, 1.0), (maker, -1.0)])
                for need in needs[unit]:
                    if need in height:
                        terms = [(height[o], 1.0), (height[need], -1.0), (maker, -float(levels + 1))]
                        self._at_least(-levels, terms)
        for unit, used in self._use.items():
            for need in needs[unit]:
                if need in height:
                    self._at_least(0, [*makers[need], (used, -1.0)])
                elif need in self._take:
                    self._at_least(0, [(self._take[need], 1.0), (used, -1.0)])
        for goal in scope.goals:
            self._at_least(1, makers[goal])

    def minimize(self, objective: Objective, seconds: float) -> str:
        """Minimize one objective; give ``optimal``, ``infeasible`` or ``stopped``."""
        highs, statuses = self._highs, self._library.HighsModelStatus
        count = highs.getNumCol()
        if count == 0:  # nothing to choose, which HiGHS calls empty
            return "infeasible" if highs.getNumRow() else "optimal"
        costs = [0.0] * count
        for variable, value in self._costs(objective):
            costs[variable] = value
        highs.changeColsCost(count, self._numpy.arange(count, dtype="int32"), self._numpy.array(costs))
        highs.setOptionValue("time_limit", float(highs.getRunTime() + seconds))
        highs.run()
        status = highs.getModelStatus()
        if status == statuses.kOptimal:
            return "optimal"
        if status in (statuses.kInfeasible, statuses.kUnboundedOrInfeasible):
            return "infeasible"  # nothing is unbounded: no cost is below zero
        if status == statuses.kTimeLimit:
            return "stopped"
        raise BugError(f"HiGHS ends with {status}")

    def hold(self, objective: Objective) -> None:
        """Keep an objective where it is now from here on."""
        values = self._highs.getSolution().col_value
        terms = self._costs(objective)
        now = sum(value * round(values[variable]) for variable, value in terms)
        close = 0.5 if objective.row.whole else _CLOSE
        self._at_least(-now - close, [(variable, -value) for variable, value in terms])

    def units(self) -> tuple[int, ...]:
        """Give the units that are used."""
        values = self._highs.getSolution().col_value
        return tuple(unit for unit, used in self._use.items() if values[used] > 0.5)

    def _costs(self, objective: Objective) -> list[tuple[int, float]]:
        if objective.row.item:
            return [(variable, 1.0) for variable in self._take.values()]
        return [(used, float(cost(self._problem, objective, unit))) for unit, used in self._use.items()]

    def _variable(self, upper: int, whole: bool) -> int:
        highs = self._highs
        number = int(highs.getNumCol())
        highs.addVar(0.0, float(upper))
        if whole:
            highs.changeColIntegrality(number, self._library.HighsVarType.kInteger)
        return number

    def _at_least(self, bound: float, terms: Iterable[tuple[int, float]]) -> None:
        pairs = list(terms)
        columns = self._numpy.array([variable for variable, _ in pairs], dtype="int32")
        values = self._numpy.array([value for _, value in pairs], dtype=float)
        self._highs.addRow(float(bound), self._library.kHighsInf, len(pairs), columns, values)
