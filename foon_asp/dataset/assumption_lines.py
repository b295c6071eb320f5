"""Messages about the kitchen and the goals that were assumed because none were given."""

from collections.abc import Iterable, Iterator, Sequence

from foon_asp.dataset.dataset import Dataset
from foon_asp.network import ObjectNode, counted
from foon_asp.problem import Problem, kitchen_needed
from foon_asp.text.assumed_goals import MARKED


def kitchen_lines(dataset: Dataset, problems: Iterable[Problem], verbose: bool) -> Iterator[str]:
    """Yield a line on the assumed starting kitchen, with the number of its items that problems can use.

    The line also names the first six used items that some unit makes, and how many more there are. With
    ``verbose``, a line for each used item follows. It says whether some unit makes the item.
    """
    used_items = {
        problem.network.object_number(o): problem.network.objects[o]
        for problem in problems
        for o in kitchen_needed(problem)
    }
    made_items = set(dataset.made_by_units(used_items))
    count_text = f"{counted(len(used_items), 'item')} used" + (
        "" if verbose or not used_items else "; -v lists them"
    )
    line = f"No kitchen given: assuming what the recipe does not make is available ({count_text})"
    if made_items:
        first_items = [str(used_items[number]) for number in sorted(made_items)[:6]]
        if len(made_items) > 6:
            first_items.append(f"{len(made_items) - 6} more")
        line += f", and of what a unit makes too: {', '.join(first_items)}"
    yield line
    if verbose:
        for number in sorted(used_items):
            yield f"  {used_items[number]}" + ("  (a unit makes it too)" if number in made_items else "")


def goal_lines(dataset: Dataset, goals: Sequence[ObjectNode], verbose: bool) -> Iterator[str]:
    """Yield a line which says that ``goals`` were assumed, and where they come from.

    They come from the goals file, from marks in the files, or from the last unit. The line names the goal if
    there is only one. If there are several goals, ``verbose`` adds a line for each.
    """
    origin = {"": "of the goals file", MARKED: "marked in the files"}.get(dataset.goals_from)
    if len(goals) == 1:
        assumed_text = f"the goal {origin}" if origin else "what the last unit makes"
        yield f"No --goal: using {assumed_text}: {goals[0]}"
        return
    assumed_text = (
        f"the {len(goals)} goals {origin}" if origin else f"what the last unit makes ({len(goals)} goals)"
    )
    yield f"No --goal: using {assumed_text}, each by itself" + ("" if verbose else "; -v lists them")
    if verbose:
        yield from (f"  {goal}" for goal in goals)
