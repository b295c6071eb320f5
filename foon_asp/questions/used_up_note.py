"""A note where a tree would not run if items were used up."""

from collections.abc import Iterable, Sequence

from foon_asp.dataset import Dataset
from foon_asp.network import FunctionalUnit
from foon_asp.problem import Problem, UsedUp
from foon_asp.proof.replay import Shortage
from foon_asp.proof.used_up_run import used_up_run


def used_up_note(problem: Problem, tree: Iterable[FunctionalUnit]) -> list[str]:
    """Return a note of one line if items last and the tree would not run with items used up, else none.

    There is no note if no step used up the copy that is missing. If units, the kitchen or the goals have
    amounts that matter for the tree, the note says that amounts are not counted.
    """
    units = tuple(tree)
    if problem.items is not None:
        return []
    counted = _counted(problem, units)
    if counted:
        return [f"note: amounts, as {counted}, are not counted where items last: --items used-up"]
    run = used_up_run(problem, units)
    if run.shortage is None or not run.shortage.consumers:
        return []
    text = _lack_text(problem, units, run.shortage)
    text += "" if run.proved else ", and no other order was found"
    return [f"note: {text}: with each item used once, see --items used-up"]


def _counted(problem: Problem, units: Sequence[FunctionalUnit]) -> str:
    """Return in words an amount that a tree does not count, of a unit, an item or a goal; empty if none."""
    if problem.amounts:
        for unit in units:
            if problem.amounts.get(unit):
                return f"in {unit.motion}"
    origin = problem.origin
    if not isinstance(origin, Dataset):
        return ""
    if origin.stock:
        for node in (node for unit in units for node in unit.inputs):
            if node in origin.stock and problem.at_hand(node):
                return f"of {node} in the kitchen"
    wanted = origin.goal_amounts
    for goal in problem.goals if wanted else ():
        if wanted.get(problem.network.object_number(goal), 1) > 1:
            return f"of the goal {problem.network.objects[goal]}"
    return ""


def _lack_text(problem: Problem, units: Sequence[FunctionalUnit], lack: Shortage) -> str:
    """Return in words which steps compete for the copy that is missing."""
    node, before = lack.node, [position + 1 for position in lack.consumers]
    used = f"{_steps_text(before)} use{'s' if len(before) == 1 else ''} up"
    if lack.step is None:
        return f"{used} the goal {node}"
    step = lack.step + 1
    if UsedUp().fate(units[lack.step], node, problem.utensils).stays:
        return f"step {step} needs {node}, which {used}"
    if len(before) == 1:
        return f"{_steps_text(sorted([*before, step]))} both take {node}"
    return f"{_steps_text(sorted([*before, step]))} all take {node}, of which there are {len(before)}"


def _steps_text(steps: Sequence[int]) -> str:
    *first, last = map(str, steps)
    return f"steps {', '.join(first)} and {last}" if first else f"step {last}"
