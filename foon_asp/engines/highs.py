"""HiGHS as a second engine: the question as a mixed integer program.

A binary variable for every unit says that it is used. A binary variable for every unit and each node that it
makes says that the unit is the achiever of this node. A continuous variable is the level of every node that
has to be made.

Each precondition of a used unit has an achiever. An achieved node is on a higher level than the preconditions
of its achiever, so that no node supports itself.
"""

import time
from typing import Any, Final

from foon_asp.engines.engine import EngineAnswer, float_cost, kitchen_items, scope_of
from foon_asp.errors import BugError
from foon_asp.hypergraph.highs_run import libraries, silent_highs
from foon_asp.problem import Objective, Problem

HIGHS: Final = "HiGHS"
_HIGHS_OPTIONS: Final = {
    "threads": 1,
    "mip_rel_gap": 0.0,
    "mip_abs_gap": 1e-9,
    "mip_detect_symmetry": False,  # with it, version 1.16.0 proves what is not the best
}


def solve_with_highs(
    problem: Problem, objectives: tuple[Objective, ...], forbidden: frozenset[int], seconds: float
) -> EngineAnswer:
    """Search for a lexicographically optimal tree, as :class:`Solve` does.

    Objectives are minimized one after the other, each with the more important ones fixed at their optimum. If
    time runs out before the last is minimized, the answer has no tree and is not ``finished``. Once one
    objective is minimized, an infeasible program is an error of rounding, and the answer is not ``finished``
    either. If all goals are in the kitchen, the empty tree is returned at once.
    """
    if not scope_of(problem, forbidden).goals:  # a program without variables; the empty tree is optimal
        return EngineAnswer(HIGHS, objectives, (), True)
    end = time.monotonic() + seconds
    program = _Program(problem, forbidden)
    units: tuple[int, ...] | None = None
    for objective in objectives:
        status = program.minimize(objective, max(end - time.monotonic(), 0.001))
        if status != "optimal":
            return EngineAnswer(HIGHS, objectives, None, status == "infeasible" and units is None)
        units = program.units()
        program.fix(objective)
    return EngineAnswer(HIGHS, objectives, units, True)


class _Program:
    """The mixed integer program of a problem."""

    def __init__(self, problem: Problem, forbidden: frozenset[int]) -> None:
        """Add the variables and rows for all units that are relevant and not forbidden."""
        self._library, self._numpy = libraries()
        self._problem, self._highs = problem, silent_highs()
        for option, value in _HIGHS_OPTIONS.items():
            self._highs.setOptionValue(option, value)
        binary, require, total = self._highs.addBinary, self._highs.addConstr, self._highs.qsum
        scope = scope_of(problem, forbidden)
        self._use = {unit: binary() for unit in scope.units}
        self._take = {o: binary() for o in kitchen_items(problem, scope.units)}
        highest = len(scope.objects) + 1
        level = {o: self._highs.addVariable(0, highest) for o in scope.objects}
        achievers: dict[int, list[Any]] = {o: [] for o in scope.objects}
        for unit, used in self._use.items():
            preconditions = problem.needs[unit]
            for o in set(problem.gives[unit]) & level.keys() - set(preconditions):
                achieves = binary()
                achievers[o].append(achieves)
                require(achieves <= used)
                for node in level.keys() & set(preconditions):
                    require(level[o] - level[node] - (highest + 1) * achieves >= -highest)
        for unit, used in self._use.items():
            for node in problem.needs[unit]:
                if node in level:
                    require(total(achievers[node]) - used >= 0)
                elif node in self._take:
                    require(self._take[node] >= used)
        for goal in scope.goals:
            require(total(achievers[goal]) >= 1)

    def minimize(self, objective: Objective, seconds: float) -> str:
        """Minimize one objective; return ``optimal``, ``infeasible`` or, if time ran out, ``stopped``.

        Raises :class:`BugError` if HiGHS ends in another way. Raises :class:`NotCheckedError` as
        :func:`float_cost` does.
        """
        highs, statuses = self._highs, self._library.HighsModelStatus
        highs.setOptionValue("time_limit", float(highs.getRunTime() + seconds))
        highs.minimize(highs.qsum(weight * variable for variable, weight in self._variable_costs(objective)))
        status = highs.getModelStatus()
        if status == statuses.kOptimal:
            return "optimal"
        if status in (statuses.kInfeasible, statuses.kUnboundedOrInfeasible):
            return "infeasible"  # nothing is unbounded: no cost is below zero
        if status == statuses.kTimeLimit:
            return "stopped"
        raise BugError(f"HiGHS ends with {status}")

    def fix(self, objective: Objective) -> None:
        """Add a row by which later solutions are no worse by an objective than the current solution.

        The row allows for rounding in floats: 0.5 for an objective in whole numbers, else 1e-6.
        """
        values, costs = self._highs.getSolution().col_value, self._variable_costs(objective)
        max_cost = sum(weight * round(values[variable.index]) for variable, weight in costs)
        max_cost += (
            0.5 if objective.row.whole else 1e-6
        )  # the tolerance of HiGHS, of logarithms and fractions
        columns = self._numpy.array([variable.index for variable, _ in costs], dtype="int32")
        weights = self._numpy.array([weight for _, weight in costs])
        # not as a constraint of an expression, which refuses weights close to 0
        self._highs.addRow(-self._library.kHighsInf, max_cost, len(costs), columns, weights)

    def units(self) -> tuple[int, ...]:
        """Return the ids of the units that the current solution uses."""
        values = self._highs.getSolution().col_value
        return tuple(unit for unit, used in self._use.items() if values[used.index] > 0.5)

    def _variable_costs(self, objective: Objective) -> list[tuple[Any, float]]:
        """Return pairs of a variable and its cost by an objective.

        If the objective counts kitchen items, the variables say which items are taken. Otherwise, they say
        which units are used.
        """
        if objective.row.item:
            return [(variable, 1.0) for variable in self._take.values()]
        return [(used, float_cost(self._problem, objective, unit)) for unit, used in self._use.items()]
