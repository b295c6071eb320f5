"""The same question as a mixed integer program, solved by HiGHS.

For every unit a 0-1 variable says that it is used; for every unit and node that it makes another one that
it is the maker of that node, and a level for every node that has to be made. A used unit has a maker for
each node it needs, and a made node stands above the nodes that its maker needs, so nothing supports itself.
"""

import time
from typing import Any, Final

from foon_asp.bounds.highs_run import libraries, silent_highs
from foon_asp.engines.engine import EngineAnswer, cost, scope_of, taken
from foon_asp.errors import BugError
from foon_asp.problem import Objective, Problem

NAME: Final = "HiGHS"
_CLOSE: Final = 1e-6  # within which HiGHS keeps to a sum of logarithms
_OPTIONS: Final = {
    "threads": 1,
    "mip_rel_gap": 0.0,
    "mip_abs_gap": 1e-9,
    "mip_detect_symmetry": False,  # with it, version 1.16.0 proves what is not the best
}


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
            return EngineAnswer(NAME, objectives, None, status == "infeasible" and units is None)
        units = program.units()
        program.hold(objective)
    return EngineAnswer(NAME, objectives, units, True)


class _Program:
    """The mixed integer program of a problem."""

    def __init__(self, problem: Problem, forbidden: frozenset[int]) -> None:
        self._library, self._numpy = libraries()
        self._problem, self._highs = problem, silent_highs()
        for option, value in _OPTIONS.items():
            self._highs.setOptionValue(option, value)
        binary, require, total = self._highs.addBinary, self._highs.addConstr, self._highs.qsum
        scope = scope_of(problem, forbidden)
        self._use = {unit: binary() for unit in scope.units}
        self._take = {o: binary() for o in taken(problem, scope.units)}
        highest = len(scope.objects) + 1
        level = {o: self._highs.addVariable(0, highest) for o in scope.objects}
        makers: dict[int, list[Any]] = {o: [] for o in scope.objects}
        for unit, used in self._use.items():
            needs = problem.needs[unit]
            for o in set(problem.gives[unit]) & level.keys() - set(needs):
                maker = binary()
                makers[o].append(maker)
                require(maker <= used)
                for need in level.keys() & set(needs):
                    require(level[o] - level[need] - (highest + 1) * maker >= -highest)
        for unit, used in self._use.items():
            for need in problem.needs[unit]:
                if need in level:
                    require(total(makers[need]) - used >= 0)
                elif need in self._take:
                    require(self._take[need] >= used)
        for goal in scope.goals:
            require(total(makers[goal]) >= 1)

    def minimize(self, objective: Objective, seconds: float) -> str:
        """Minimize one objective; return ``optimal``, ``infeasible`` or ``stopped``."""
        highs, statuses = self._highs, self._library.HighsModelStatus
        highs.setOptionValue("time_limit", float(highs.getRunTime() + seconds))
        highs.minimize(highs.qsum(weight * variable for variable, weight in self._costs(objective)))
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
        values, costs = self._highs.getSolution().col_value, self._costs(objective)
        most = sum(weight * round(values[variable.index]) for variable, weight in costs)
        most += 0.5 if objective.row.whole else _CLOSE
        columns = self._numpy.array([variable.index for variable, _ in costs], dtype="int32")
        weights = self._numpy.array([weight for _, weight in costs])
        # not as a constraint of an expression, which refuses weights that are next to nothing
        self._highs.addRow(-self._library.kHighsInf, most, len(costs), columns, weights)

    def units(self) -> tuple[int, ...]:
        """Return the units that are used."""
        values = self._highs.getSolution().col_value
        return tuple(unit for unit, used in self._use.items() if values[used.index] > 0.5)

    def _costs(self, objective: Objective) -> list[tuple[Any, float]]:
        if objective.row.item:
            return [(variable, 1.0) for variable in self._take.values()]
        return [(used, cost(self._problem, objective, unit)) for unit, used in self._use.items()]
