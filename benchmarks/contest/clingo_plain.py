"""The plain encoding in clingo: the program's own .lp files on facts, and nothing else."""

from collections.abc import Sequence

from contest.instance import Instance
from foon_asp.deadline import Deadline
from foon_asp.encoding.clingo_run import run
from foon_asp.problem import Objective
from foon_asp.resources import encodings_folder

# The criterion of objectives.lp that the costs are handed to, and the predicate that they come in.
_CRITERIA = {
    Objective.UNITS: ("units", ""),
    Objective.INPUTS: ("inputs", "inputs({0},{1})."),
    Objective.INPUTS_AND_INGREDIENTS: ("inputs", "inputs({0},{1})."),
    Objective.SUCCESS: ("success", "risk({0},{1})."),
}


def ready() -> None:
    """Import what solving needs."""
    import clingo  # noqa: F401, PLC0415


def plain_facts(instance: Instance, objective: Objective) -> str:
    """Write an instance as the fewest facts that the encodings can do with."""
    criterion, costs = _CRITERIA[objective]
    lines = [f"optimize({criterion},1)."]
    for action, (needs, gives) in enumerate(zip(instance.needs, instance.gives, strict=True)):
        facts = [f"unit({action})."]
        facts += [f"needs({action},{o})." for o in needs]
        facts += [f"gives({action},{o})." for o in gives]
        if costs:
            facts.append(costs.format(action, instance.costs[action]))
        lines.append(" ".join(facts))
    lines += [f"goal({o})." for o in instance.goals]
    return "\n".join(lines)


def solve_plain(facts: str, seconds: float, options: Sequence[str], by_need: bool) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none."""
    folder = encodings_folder()
    first = folder / "by_need" / "task_tree.lp" if by_need else folder / "task_tree.lp"
    files = (first, folder / "objectives.lp", folder / "show.lp")
    ended = run(files, facts, options, Deadline(seconds), "opt")
    if not ended.exhausted:
        raise TimeoutError
    return None if ended.units is None else sorted(ended.units)
