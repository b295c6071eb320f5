"""The same question as weighted partial MaxSAT, solved by RC2 of PySAT."""

import importlib
from typing import Any, NamedTuple

from contest.elimination import clauses
from contest.instance import Instance, cuts


class Setting(NamedTuple):
    """How RC2 is set; see its documentation for the words.

    ``elimination`` says that cycles are ruled out in advance by eliminating nodes one after the other,
    instead of when an optimum has one.
    """

    stratified: bool = True
    elimination: bool = True
    solver: str = "g3"
    adapt: bool = True
    exhaust: bool = True
    minz: bool = True


def ready() -> None:
    """Import what solving needs."""
    importlib.import_module("pysat.examples.rc2")


def solve_max_sat(instance: Instance, setting: Setting) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none.

    Clauses that are added later go to a new solver: a stratified one may not be asked again after that.
    """
    formula: Any = importlib.import_module("pysat.formula").WCNF()
    rc2: Any = importlib.import_module("pysat.examples.rc2")
    if not all(instance.makers[goal] for goal in instance.goals):
        return None  # an empty clause, which the solver does not take
    for clause in clauses(instance, setting.elimination):
        formula.append(clause)
    for action, cost in enumerate(instance.costs):
        if cost:
            formula.append([-action - 1], weight=cost)
    # Where nothing costs anything, there are no strata to begin with.
    kind = rc2.RC2Stratified if setting.stratified and any(instance.costs) else rc2.RC2
    while True:
        options = {"adapt": setting.adapt, "exhaust": setting.exhaust, "minz": setting.minz}
        with kind(formula, solver=setting.solver, incr=False, **options) as solver:
            model = solver.compute()
        if model is None:
            return None
        used = [literal - 1 for literal in model if 0 < literal <= len(instance.units)]
        found = cuts(instance, used)
        if not found:
            return used
        for supports, user in found:
            clause = [support + 1 for support in supports]
            formula.append(clause if user is None else [-user - 1, *clause])
