"""The note that a tree would not run if items were used up."""

from collections.abc import Iterable, Sequence

from foon_asp.dataset import Dataset
from foon_asp.network import FunctionalUnit
from foon_asp.problem import Problem, UsedUp
from foon_asp.proof.replay import Shortage
from foon_asp.proof.used_up_run import used_up_run


def used_up_note(problem: Problem, tree: Iterable[FunctionalUnit]) -> list[str]:
    """Return a note, in a list, that a tree for lasting items would not run if items were used up.

    The list is empty if the tree would run, or if no step uses up the copy that is missing. It is also empty
    for a problem whose items are used up. If units, items or goals of the tree have amounts, the note says
    instead that these amounts are not counted.
    """
    units = tuple(tree)
    if problem.items is not None:
        return []
    amount_text = _amount_text(problem, units)
    if amount_text:
        return [f"note: amounts, as {amount_text}, are not counted where items last: --items used-up"]
    run = used_up_run(problem, units)
    if run.shortage is None or not run.shortage.consumers:
        return []
    shortage_text = _shortage_text(problem, units, run.shortage)
    shortage_text += "" if run.proved else ", and no other order was found"
    return [f"note: {shortage_text}: with each item used once, see --items used-up"]


def _amount_text(problem: Problem, units: Sequence[FunctionalUnit]) -> str:
    """Return in words the first amount that concerns a tree: ``of flour in the kitchen``.

    The amounts are those of the tree's units, of its items in the kitchen, and of the goals. The text is
    empty without any amount.
    """
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


def _shortage_text(problem: Problem, units: Sequence[FunctionalUnit], shortage: Shortage) -> str:
    """Return in words which steps use up the missing copy, and which step or goal needs it.

    For example ``steps 1 and 3 both take flour``. Steps are numbered from 1.
    """
    node, before = shortage.node, [position + 1 for position in shortage.consumers]
    used = f"{_steps_text(before)} use{'s' if len(before) == 1 else ''} up"
    if shortage.step is None:
        return f"{used} the goal {node}"
    step = shortage.step + 1
    if UsedUp().fate(units[shortage.step], node, problem.utensils).stays:
        return f"step {step} needs {node}, which {used}"
    if len(before) == 1:
        return f"{_steps_text(sorted([*before, step]))} both take {node}"
    return f"{_steps_text(sorted([*before, step]))} all take {node}, of which there are {len(before)}"


def _steps_text(steps: Sequence[int]) -> str:
    """Return the numbers of steps in words: ``steps 1, 2 and 4``."""
    *first, last = map(str, steps)
    return f"steps {', '.join(first)} and {last}" if first else f"step {last}"
