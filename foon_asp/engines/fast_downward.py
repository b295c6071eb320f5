"""Fast Downward as a second engine: A* with the landmark-cut heuristic (Helmert & Domshlak 2009).

Fast Downward is installed only with the extra ``cross-check``, since it is under the GPL, and runs as a
separate program. The task is written in the format of its translator. It has a binary variable for each node
that has to be made, and an operator for each unit. If the objective counts kitchen items, it also has an
operator that takes each item.
"""

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from foon_asp.engines.engine import EngineAnswer, NotCheckedError, float_cost, kitchen_items, scope_of
from foon_asp.errors import BugError
from foon_asp.problem import Objective, Problem
from foon_asp.problem.number import INT32_MAX

FAST_DOWNWARD = "Fast Downward"
_MEMORY_LIMIT = "4G"
_UNSOLVABLE = ("Completely explored state space", "Initial state is a dead end", "unsolvable")


def driver_script() -> Path | None:
    """Return the path of Fast Downward's script in the installed package ``up_fast_downward``.

    Return ``None`` if there is no such package or no script in it; no other place is searched.
    """
    spec = importlib.util.find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        return None
    file = Path(spec.origin).parent / "downward" / "fast-downward.py"
    return file if file.is_file() else None


def is_installed() -> bool:
    """Return whether Fast Downward is installed, as :func:`driver_script` finds it."""
    return driver_script() is not None


def solve_with_fast_downward(
    problem: Problem, objectives: tuple[Objective, ...], forbidden: frozenset[int], seconds: float
) -> EngineAnswer:
    """Search for an optimal tree by the first objective alone, as :class:`Solve` does.

    Fractions and logarithms of rates are rounded to millionths. The time limit is ``seconds``, rounded to
    whole seconds, at least 1. If time or memory (4 GB) runs out, the answer is not ``finished``. The units of
    the answer are ascending. If all goals are in the kitchen, the empty tree is returned at once.

    Raises :class:`NotCheckedError` if costs are too large. Raises :class:`BugError` if Fast Downward is not
    installed or fails.
    """
    program = driver_script()
    if program is None:
        raise BugError("Fast Downward is asked for where it is not installed")
    if not scope_of(problem, forbidden).goals:  # it refuses tasks without goals; the empty tree is optimal
        return EngineAnswer(FAST_DOWNWARD, objectives[:1], (), True)
    with tempfile.TemporaryDirectory() as name:
        task, plan = Path(name, "task.sas"), Path(name, "plan")
        task.write_text(_task_text(problem, objectives[0], forbidden), encoding="ascii")
        limits = f"--overall-time-limit={max(1, round(seconds))}", f"--overall-memory-limit={_MEMORY_LIMIT}"
        arguments = "--plan-file", str(plan), str(task), "--search", "astar(lmcut())"
        command = [sys.executable, str(program), *limits, *arguments]
        ended = subprocess.run(command, cwd=name, capture_output=True, text=True, check=False)
        units: tuple[int, ...] | None = None
        finished = ended.returncode == 0
        if finished:
            steps = (line.strip("() ") for line in plan.read_text(encoding="ascii").split("\n"))
            units = tuple(sorted(int(step.split()[1]) for step in steps if step.startswith("use ")))
        elif ended.returncode in {10, 11, 12} and any(text in ended.stdout for text in _UNSOLVABLE):
            finished = True
        elif ended.returncode not in {20, 21, 22, 23, 24}:  # out of memory or of time
            raise BugError(
                f"Fast Downward ends with {ended.returncode}: {(ended.stdout + ended.stderr)[-2000:]}"
            )
    return EngineAnswer(FAST_DOWNWARD, objectives[:1], units, finished)


def _task_text(problem: Problem, objective: Objective, forbidden: frozenset[int]) -> str:
    """Return the planning task as text, in the format of Fast Downward's translator.

    Each node that has to be made is a binary variable, which is 0 once the node is available. If the
    objective counts kitchen items, each needed item is a variable, too, and an operator of cost 1 takes it.
    Every other operator is a unit. A unit is left out if it makes no node that has to be made.

    Raises :class:`NotCheckedError` if the costs add up to more than 32 bits hold.
    """
    scope = scope_of(problem, forbidden)
    items = kitchen_items(problem, scope.units) if objective.row.item else []
    variables = {o: variable for variable, o in enumerate([*scope.objects, *items])}
    scale = 1 if objective.row.whole else 10**6  # it adds integers: a finer one overflows
    operators = [_operator_text(f"take {o}", [], [variables[o]], 1) for o in items]
    total = len(items)
    for unit in scope.units:
        preconditions = [o for o in problem.needs[unit] if o in variables]
        outputs = [o for o in problem.gives[unit] if o in variables]
        added = [o for o in outputs if o not in items and o not in preconditions]
        if added:  # an operator has to have an effect
            weight = round(scale * float_cost(problem, objective, unit))
            total += weight
            facts = [variables[o] for o in preconditions], [variables[o] for o in added]
            operators.append(_operator_text(f"use {unit}", *facts, weight))
    if total > INT32_MAX:
        raise NotCheckedError("the costs add up to more than its whole numbers hold")
    return _TASK.format(
        number=len(variables),
        variables="".join(map(_VARIABLE.format, range(len(variables)))),
        state="1\n" * len(variables),
        goals=len(scope.goals),
        goal="".join(f"{variables[goal]} 0\n" for goal in scope.goals),
        operators=len(operators),
        operator="".join(operators),
    )


_VARIABLE: Final = """\
begin_variable
var{0}
-1
2
Atom at-hand({0})
NegatedAtom at-hand({0})
end_variable
"""
_TASK: Final = """\
begin_version
3
end_version
begin_metric
1
end_metric
{number}
{variables}0
begin_state
{state}end_state
begin_goal
{goals}
{goal}end_goal
{operators}
{operator}0
"""


def _operator_text(name: str, preconditions: list[int], add_effects: list[int], weight: int) -> str:
    """Return the text of an operator of cost ``weight``.

    ``preconditions`` are the variables that have to be 0, and ``add_effects`` those that become 0.
    """
    conditions = "".join(f"{variable} 0\n" for variable in preconditions)
    effects = "".join(f"0 {variable} -1 0\n" for variable in add_effects)
    return (
        f"begin_operator\n{name}\n{len(preconditions)}\n{conditions}{len(add_effects)}\n{effects}{weight}\n"
        "end_operator\n"
    )
