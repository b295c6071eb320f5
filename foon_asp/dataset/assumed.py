"""What was assumed because nobody said it, in words: the kitchen, and the goals."""

from collections.abc import Iterator, Sequence

from foon_asp.dataset.dataset import Dataset
from foon_asp.network import ObjectNode, counted
from foon_asp.problem import Problem, kitchen_needed
from foon_asp.text.assumed_goals import MARKED

_SHOWN = 40  # items of a starting kitchen that are listed


def kitchen_lines(problem: Problem) -> Iterator[str]:
    """Say that the starting kitchen is at hand, and list of it what can matter for the goals."""
    needed = kitchen_needed(problem)
    count = f"of it {counted(len(needed), 'object node')} can be needed" + (":" if needed else "")
    yield f"warning: no kitchen is given, so what no unit makes is at hand (--kitchen @starting); {count}"
    yield from (f"  {problem.network.objects[o]}" for o in needed[:_SHOWN])
    if len(needed) > _SHOWN:
        yield f"  ... and {len(needed) - _SHOWN} more; --format json lists all"


def goal_lines(dataset: Dataset, goals: Sequence[ObjectNode]) -> Iterator[str]:
    """Say which goals were taken, and why."""
    if dataset.goals_from == MARKED:
        why = "what is marked as a goal in the files"
    else:
        why = "what the last unit makes"
    if len(goals) == 1:
        yield f"no goal is named (--goal), so it is {why}: {goals[0]}"
    else:
        yield f"no goal is named (--goal), so the goals are {why}, each by itself:"
        yield from (f"  {goal}" for goal in goals)
