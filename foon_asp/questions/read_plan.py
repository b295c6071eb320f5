"""A plan of another planner, read back into a task tree and executed."""

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Unpack

from foon_asp.dataset.item_options import items_of
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.planning.name_map import name_map_of, read_name_map
from foon_asp.planning.plan_file import PlanStep, read_plan_text
from foon_asp.planning.planning_task import planning_task
from foon_asp.problem import ITEMS, Problem
from foon_asp.proof.simulation import Verdict
from foon_asp.questions.check import Checked
from foon_asp.questions.ending import Ending
from foon_asp.questions.posing import Command
from foon_asp.questions.posing_plan import count_units_in
from foon_asp.questions.python_arguments import over_whole_network
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import Kind, Option, Role, question
from foon_asp.questions.tree import Tree
from foon_asp.results.table import Block
from foon_asp.text.plain_file import read_plain_text


class PlanRead(Checked, frozen=True, kw_only=True, tag=schema_name("read-plan")):
    r"""The plan of another planner as a ``tree``, and what stops it.

    Attributes:
        sound: Whether the plan executes as it is written, with units of the network alone.

    Example:
        >>> import pathlib, tempfile
        >>> plan = pathlib.Path(tempfile.mkdtemp(), "plan")
        >>> written = plan.write_text("(u27-crush)\n(u26-twist)\n")
        >>> foon_asp.read_plan(foon_asp.load().problem("ice"), plan).sound
        False
    """

    sound: bool

    @property
    def ending(self) -> Ending:
        """``DONE`` for a sound plan, ``NEGATIVE`` for one that is refused."""
        return Ending.DONE if self.sound else Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Return whether the plan executes, what stops it at which line, and its costs."""
        first, *others = super().show()
        yield from (first if self.sound else f"refused: {first}", *others)

    def foon(self) -> str:
        """Return the tree as FOON text; empty where the plan is refused."""
        return str(self.tree) if self.sound else ""

    def remark(self, format_: str) -> str:
        """Return why the plan is refused; empty for a sound plan."""
        return "" if self.sound else self.text().rstrip()


def _pose_from_map(command: Command, names: Path | None) -> tuple[Problem]:
    """Return the problem that a name map states, over the data of the command.

    The map, which ``foon-asp export`` wrote, has the goals, the container rule, and how items are used up. If
    the command names no data, the bundled kitchen is used; it has to have at least half of the units of the
    map. Raises :class:`UserError` without a map, and for a map of another level than the data.
    """
    if names is None:
        raise UserError(
            "name the map of names with --map: foon-asp export wrote it beside the PDDL (map.json)"
        )
    name_map, dataset = read_name_map(names), command.dataset
    units = set(name_map.units.values())
    if not command.names_data and 2 * count_units_in(dataset.data.network, units) < len(units):
        raise UserError(f"{names}: it is not of the bundled kitchen: name the data that were exported")
    if dataset.names.level != name_map.level:
        raise UserError(
            f"{names}: is about level {name_map.level}, and the data are read at level "
            f"{dataset.names.level}: add --level {name_map.level}"
        )
    with command.reading():
        used_up = name_map.items and items_of(
            dataset, ITEMS[1], name_map.items.stock, name_map.items.told, name_map.items.wanted
        )
        return (dataset.problem(dataset.python_goal_ids(name_map.goals), name_map.containers, items=used_up),)


@question(
    Option("plan", "The plan that a planner wrote.", Kind.FILE, metavar="PLAN", positional=True),
    Option(
        "names",
        "The map of names that `foon-asp export` wrote beside the PDDL.",
        Kind.FILE,
        Role.PROBLEM | Role.QUESTION,
        flags=("--map",),
        metavar="map.json",
        python="Without it, the names are those that :func:`foon_asp.export` gives to the whole network.",
    ),
    pose=_pose_from_map,
    used_up=True,
    formats=("text", "json", "foon"),
    help_="""
    \b
    foon-asp export --to pddl --goal 'greek salad' -o task
    foon-asp read-plan plan --map task/map.json
    foon-asp read-plan plan --map task/map.json --format foon > tree.txt

    Plans of Fast Downward, Metric-FF, pyperplan, planners of the IPC (numbered, or with times) and
    unified-planning are read; of the first two also their log, with the plan in it. The goals and the
    container rule are those of the map; the plan is executed step by step.

    Exits with 0 when the plan executes as it is written and makes the goals; with 1 when it does not, with
    the line and the reason; with 2 for a line that is no step, or an action that the map does not have.
    """,
)
def read_plan(
    problem: Problem,
    plan: str | PathLike[str] | object,
    *,
    names: File | None = None,
    **options: Unpack[Posed],
) -> PlanRead:
    r"""Read the plan of another planner back into a task tree, and execute it.

    A unit that a plan executes twice is in the tree once, unless items are used up.

    Parameters:
        plan: The path of the file that the planner wrote, or a plan of unified-planning.

    Returns:
        The ``tree``, whether it is ``sound``, and what stops it.

    Raises:
        UserError: for a file that cannot be read, a line that is no step of a plan, or an action that the
            map does not have.

    Example:
        >>> import pathlib, tempfile
        >>> plan = pathlib.Path(tempfile.mkdtemp(), "plan")
        >>> written = plan.write_text("0: (u26-twist)\n1: (u27-crush)\n")
        >>> foon_asp.read_plan(foon_asp.load().problem("ice"), plan).tree
        <Tree for ice; crushed; in [drinking glass]: 2 units>
    """
    if names is None:
        problem = over_whole_network(problem)
        name_map = name_map_of(planning_task(problem, whole=True))
    else:
        name_map = read_name_map(Path(names))
    with start_deadline(options).watched("reading"):
        if isinstance(plan, str | PathLike):
            steps = read_plan_text(read_plain_text(Path(plan)), str(plan), name_map)
        else:  # as unified-planning writes it
            steps = read_plan_text(str(plan), "the plan", name_map)
    if problem.items is None:
        place_of_unit = dict(reversed(steps))  # of the first execution
        steps = [PlanStep(unit, place_of_unit[unit]) for unit in dict.fromkeys(unit for unit, _ in steps)]
    tree = Tree.given(problem, [unit for unit, _ in steps], [source for _, source in steps])
    checked = Checked.of(tree)
    sound = checked.verdict is Verdict.AS_LISTED and not checked.not_in_network
    return PlanRead.of(tree, sound=sound)
