"""The same question in CP-SAT, the constraint solver of OR-Tools."""

import importlib
import time
from collections.abc import Iterable, Sequence
from typing import Any

from contest.elimination import ordered
from contest.instance import Instance, cuts


def ready() -> None:
    """Import what solving needs."""
    importlib.import_module("ortools.sat.python.cp_model")


def solve_cp_sat(
    instance: Instance, seconds: float, levels: bool, parameters: dict[str, Any], elimination: bool = False
) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none.

    Variables and cycles are as in :mod:`contest.mixed_integer`, but that a level follows from its maker by
    implication.
    """
    cp_model: Any = importlib.import_module("ortools.sat.python.cp_model")
    began = time.monotonic()
    model = cp_model.CpModel()
    use = [model.new_bool_var("") for _ in instance.units]
    for action, needs in enumerate(instance.needs):
        for node in needs:
            model.add_bool_or([~use[action], *(use[maker] for maker in instance.makers[node])])
    for goal in instance.goals:
        model.add_bool_or([use[maker] for maker in instance.makers[goal]])
    if levels:
        _add_levels(model, instance, use)
    if elimination:
        _add_clauses(model, ordered(instance) or (), use)
    model.minimize(cp_model.LinearExpr.weighted_sum(use, instance.costs))
    while True:
        solver = cp_model.CpSolver()
        for name, value in parameters.items():
            setattr(solver.parameters, name, value)
        solver.parameters.max_time_in_seconds = max(0.001, began + seconds - time.monotonic())
        status = solver.solve(model)
        if status == cp_model.INFEASIBLE:
            return None
        if status in (cp_model.FEASIBLE, cp_model.UNKNOWN):
            raise TimeoutError
        if status != cp_model.OPTIMAL:
            raise RuntimeError(f"CP-SAT ends with {solver.status_name(status)}")
        used = [action for action, variable in enumerate(use) if solver.boolean_value(variable)]
        found = cuts(instance, used)
        if not found:
            return used
        for supports, user in found:
            clause = [use[support] for support in supports]
            model.add_bool_or(clause if user is None else [~use[user], *clause])


def _add_clauses(model: Any, clauses: Iterable[Sequence[int]], use: Sequence[Any]) -> None:
    variables = list(use)
    for clause in clauses:
        for literal in clause:
            while abs(literal) > len(variables):
                variables.append(model.new_bool_var(""))
        model.add_bool_or([variables[abs(n) - 1] if n > 0 else ~variables[abs(n) - 1] for n in clause])


def _add_levels(model: Any, instance: Instance, use: list[Any]) -> None:
    sizes, component = instance.sizes, instance.component
    heights = {
        node: model.new_int_var(0, sizes[number] - 1, "")
        for node, number in enumerate(component)
        if sizes[number] > 1
    }
    charges: dict[int, list[Any]] = {}
    for node, height in heights.items():
        charge = charges[node] = []
        for action in instance.makers[node]:
            inner = instance.inner(action, node)
            if not inner:
                charge.append(use[action])
                continue
            in_charge = model.new_bool_var("")
            charge.append(in_charge)
            model.add_implication(in_charge, use[action])
            for need in inner:
                model.add(height >= heights[need] + 1).only_enforce_if(in_charge)
    for action, needs in enumerate(instance.needs):
        for node in needs:
            if node in charges:
                model.add_bool_or([~use[action], *charges[node]])
    for goal in instance.goals:
        if goal in charges:
            model.add_bool_or(charges[goal])
