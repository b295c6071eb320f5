"""The same question as a planning task, solved by Fast Downward: A* with the landmark-cut heuristic.

It comes with the extra ``cross-check`` (GPL, so it is never installed otherwise) and runs as a program of
its own. The task is written in the form that its search reads: a yes-no variable for each node that would
have to be made, an operator for each unit, and one for taking each kitchen item where items are what costs.
"""

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from foon_asp.engines.engine import EngineAnswer, NotCheckedError, cost, scope_of, taken
from foon_asp.errors import BugError
from foon_asp.problem import Objective, Problem

NAME = "Fast Downward"
_SCALE = 10**6  # of logarithms of rates, which it adds as whole numbers
_LARGEST = 2**31 - 1  # of its whole numbers
_MEMORY = "4G"
_NONE = ("Completely explored state space", "Initial state is a dead end", "unsolvable")


def driver() -> Path | None:
    """Give the program that starts Fast Downward, or ``None`` where it is not installed."""
    found = importlib.util.find_spec("up_fast_downward")
    if found is None or found.origin is None:
        return None
    file = Path(found.origin).parent / "downward" / "fast-downward.py"
    return file if file.is_file() else None


def installed() -> bool:
    """Whether the engine can be asked."""
    return driver() is not None


def solve_with_fast_downward(
    problem: Problem, objectives: tuple[Objective, ...], forbidden: frozenset[int], seconds: float
) -> EngineAnswer:
    """Find a best tree by the first objective alone; ``success`` to a millionth of each logarithm."""
    program = driver()
    if program is None:
        raise BugError("Fast Downward is asked for where it is not installed")
    if not scope_of(problem, forbidden).goals:  # which it refuses, and it takes nothing to make none
        return EngineAnswer(NAME, objectives[:1], (), True)
    with tempfile.TemporaryDirectory() as name:
        task, plan = Path(name, "task.sas"), Path(name, "plan")
        task.write_text(_task(problem, objectives[0], forbidden), encoding="ascii")
        limits = f"--overall-time-limit={max(1, round(seconds))}", f"--overall-memory-limit={_MEMORY}"
        asked = "--plan-file", str(plan), str(task), "--search", "astar(lmcut())"
        command = [sys.executable, str(program), *limits, *asked]
        ended = subprocess.run(command, cwd=name, capture_output=True, text=True, check=False)
        units: tuple[int, ...] | None = None
        finished = ended.returncode == 0
        if finished:
            steps = (line.strip("() ") for line in plan.read_text(encoding="ascii").split("\n"))
            units = tuple(sorted(int(step.split()[1]) for step in steps if step.startswith("use ")))
        elif ended.returncode in {10, 11, 12} and any(text in ended.stdout for text in _NONE):
            finished = True
        elif ended.returncode not in {20, 21, 22, 23, 24}:  # out of memory or of time
            raise BugError(
                f"Fast Downward ends with {ended.returncode}: {(ended.stdout + ended.stderr)[-2000:]}"
            )
    return EngineAnswer(NAME, objectives[:1], units, finished)


def _task(problem: Problem, objective: Objective, forbidden: frozenset[int]) -> str:
    """Write the planning task; a variable is 0 once its node is available."""
    scope = scope_of(problem, forbidden)
    items = taken(problem, scope.units) if objective.row.item else []
    places = {o: place for place, o in enumerate([*scope.objects, *items])}
    scale = 1 if objective.row.whole else _SCALE
    operators = [_operator(f"take {o}", [], [places[o]], 1) for o in items]
    total = len(items)
    for unit in scope.units:
        needs = [o for o in problem.needs[unit] if o in places]
        gives = [o for o in problem.gives[unit] if o in places and o not in items and o not in needs]
        if gives:  # an operator has to have an effect
            weight = round(scale * cost(problem, objective, unit))
            total += weight
            rows = [places[o] for o in needs], [places[o] for o in gives]
            operators.append(_operator(f"use {unit}", *rows, weight))
    if total > _LARGEST:
        raise NotCheckedError("the costs add up to more than its whole numbers hold")
    return _TASK.format(
        number=len(places),
        variables="".join(map(_VARIABLE.format, range(len(places)))),
        state="1\n" * len(places),
        goals=len(scope.goals),
        goal="".join(f"{places[goal]} 0\n" for goal in scope.goals),
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


def _operator(name: str, needs: list[int], gives: list[int], weight: int) -> str:
    conditions = "".join(f"{place} 0\n" for place in needs)
    effects = "".join(f"0 {place} -1 0\n" for place in gives)
    return (
        f"begin_operator\n{name}\n{len(needs)}\n{conditions}{len(gives)}\n{effects}{weight}\nend_operator\n"
    )
