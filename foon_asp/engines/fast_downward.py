"""The same question as a planning task, solved by Fast Downward: A* with the landmark-cut heuristic.

It comes with the extra ``cross-check`` (GPL, so it is never installed otherwise) and runs as a program of
its own. The task is written in the form that its search reads: a yes-no variable for each node that would
have to be made, an operator for each unit, and one for taking each kitchen item where items are what costs.
"""

import importlib.util
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

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
        task.write_text("\n".join(_task(problem, objectives[0], forbidden)) + "\n", encoding="ascii")
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


def _task(problem: Problem, objective: Objective, forbidden: frozenset[int]) -> Iterator[str]:
    """Write the planning task, line by line; a variable is 0 once its node is at hand."""
    scope = scope_of(problem, forbidden)
    items = taken(problem, scope.units) if objective.row.item else []
    places = {o: place for place, o in enumerate([*scope.objects, *items])}
    scale = 1 if objective.row.whole else _SCALE
    yield from ("begin_version", "3", "end_version", "begin_metric", "1", "end_metric", str(len(places) or 1))
    for place in range(len(places) or 1):
        yield from ("begin_variable", f"var{place}", "-1", "2", f"Atom at-hand({place})")
        yield from (f"NegatedAtom at-hand({place})", "end_variable")
    yield from ("0", "begin_state", *["1"] * (len(places) or 1), "end_state")
    yield from (
        "begin_goal",
        str(len(scope.goals)),
        *(f"{places[goal]} 0" for goal in scope.goals),
        "end_goal",
    )
    operators: list[Iterator[str]] = []
    total = len(items)
    for unit in scope.units:
        needs = [o for o in problem.needs[unit] if o in places]
        gives = [o for o in problem.gives[unit] if o in places and o not in items and o not in needs]
        if gives:  # an operator has to have an effect
            weight = round(scale * cost(problem, objective, unit))
            total += weight
            if total > _LARGEST:
                raise NotCheckedError("the costs add up to more than its whole numbers hold")
            rows = [places[o] for o in needs], [places[o] for o in gives]
            operators.append(_operator(f"use {unit}", *rows, weight))
    operators += [_operator(f"take {o}", [], [places[o]], 1) for o in items]
    yield str(len(operators))
    for operator in operators:
        yield from operator
    yield "0"


def _operator(name: str, needs: list[int], gives: list[int], weight: int) -> Iterator[str]:
    yield from ("begin_operator", name, str(len(needs)), *(f"{place} 0" for place in needs))
    yield from (str(len(gives)), *(f"0 {place} -1 0" for place in gives), str(weight), "end_operator")
