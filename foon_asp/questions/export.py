"""Export for planners: PDDL, and the map of its names."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Any, Unpack

from msgspec import field

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.planning.name_map import MapFile
from foon_asp.planning.pddl_writer import domain_text, items_words, problem_text, scale_words
from foon_asp.planning.planning_task import PlanningTask, planning_task
from foon_asp.planning.unified import unified_problem
from foon_asp.problem import Problem
from foon_asp.questions.options import AMOUNT, CONTAINERS, GOALS, ITEMS, OBJECTIVES
from foon_asp.questions.posing import Command, pose_problem
from foon_asp.questions.python_arguments import Objectives, chosen_objectives, over_whole_network
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import Kind, Option, Role, python_question, question
from foon_asp.questions.result import Result
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values_of import question_fields
from foon_asp.whole_file import write_whole

FILES = ("domain.pddl", "problem.pddl", "map.json")
"""What is written into a folder."""
_FORMATS = ("pddl",)
_MERGED = "set"
_ITEM_RULES = ("lasting", _MERGED, "used-up")


class Exported(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("export")):
    """A planning task in PDDL, and the map of its names.

    Attributes:
        domain_file: The domain, in PDDL: a constant for each object node, an action for each unit.
        problem_file: The problem, in PDDL: the kitchen, and the goals.
        name_map: The object nodes and units behind the names of the planning task.

    Example:
        >>> exported = foon_asp.export(foon_asp.load().problem("ice"))
        >>> print(exported.problem_file.splitlines()[0])
        (define (problem foon-goal)
    """

    domain_file: str = field(name="domain")
    problem_file: str = field(name="problem")
    name_map: MapFile = field(name="map")

    task = Unserialized[PlanningTask]()
    """The planning task as values."""

    written = Unserialized[Path | None](None)
    """The folder that the files were written into, if they were."""

    def show(self) -> Iterator[Block]:
        """Yield the problem in PDDL.

        If files were written, yield instead their names, the size of the task, and how costs were scaled.
        """
        if self.written is None:
            yield from self.problem_file.splitlines()
            return
        task = self.task
        yield f"{self.written}: {', '.join(FILES)} ({task.problem.conditions})"
        yield f"{counted(len(task.actions), 'action')}, {counted(len(task.names), 'object node')}"
        if task.problem.items is not None:
            yield items_words(task)
        yield from (f"costs of actions by {scale_words(scale)}" for scale in task.costs.scales)
        if any(scale.rounded for scale in task.costs.scales):
            yield "rounded costs may make a planner take a tree for the best that is not quite"

    def domain(self) -> str:
        """Return the domain in PDDL, which ``--format domain`` prints."""
        return self.domain_file

    def write(self, file: File, format_: str | None = None) -> None:
        """Write ``domain.pddl``, ``problem.pddl`` and ``map.json`` into a folder.

        Parameters:
            file: The path of the folder, which is made if it is not there.
            format_: The format: ``pddl``, or ``None``.

        Raises:
            UserError: if a file cannot be written, or for another format.
        """
        if format_ not in {None, *_FORMATS}:
            raise UserError(f"found the format {format_!r}, expected pddl")
        folder = Path(file)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UserError(f"{folder}: cannot be created as a folder: {error.strerror or error}") from None
        contents = (self.domain_file, self.problem_file, self.name_map.json_text())
        for name, content in zip(FILES, contents, strict=True):
            write_whole(folder / name, content.encode(errors="backslashreplace"))

    def __repr__(self) -> str:
        return f"<Exported: {counted(len(self.task.actions), 'action')}>"


def _export_and_write(
    problem: Problem, *arguments: Any, folder_written: Path | None = None, **options: Any
) -> Exported:
    """Return the result of :func:`export`; if ``folder_written`` names a folder, write the files into it.

    The attribute ``written`` of the result is then this folder.
    """
    exported = export(problem, *arguments, **options)
    if folder_written is not None:
        exported.write(folder_written)
        exported.set_unserialized(written=folder_written)
    return exported


def _pose_export(
    command: Command, goals_named: Sequence[str], containers: str, items: str | None, **files: Any
) -> tuple[Problem]:
    """Return the problem of the goals, in a tuple; with ``--items set``, items are used up in it."""
    items = "used-up" if items == _MERGED else items or "lasting"
    return pose_problem(command, goals_named, containers, items, **files)


def _has_merged_copies(problem: Problem, items: str | None) -> bool:
    """Return whether ``items`` is ``set``, by which all copies of an object node are one.

    ``None`` stands for the items of the problem as they are. Raises :class:`UserError` for an unknown word,
    and if ``items`` contradicts the problem.
    """
    if items not in {None, *_ITEM_RULES}:
        raise UserError(f"found items={items!r}, expected one of {', '.join(_ITEM_RULES)}")
    if items is not None and (items == "lasting") is not (problem.items is None):
        raise UserError(f"found items={items!r}, but the problem is posed with {problem.conditions}")
    return items == _MERGED


@question(
    GOALS,
    OBJECTIVES._replace(
        help=OBJECTIVES.help.replace("What is best", "What actions cost"),
        python="A name, names separated by commas, or several names.",
    ),
    CONTAINERS,
    ITEMS[0]._replace(
        default=None,
        help="Whether items last (by default), are used up, with copies as numbers (used-up), or as set: "
        "STRIPS with deletes, in which all copies of a node are one.",
        role=Role.PROBLEM | Role.QUESTION,
        choices=_ITEM_RULES,
        python="In Python by default as in the problem; ``set`` is for one in which items are used up.",
    ),
    *ITEMS[1:],
    AMOUNT,
    Option(
        "folder_written",
        "The folder to write domain.pddl, problem.pddl and map.json into; without it, the problem to stdout.",
        Kind.WRITTEN,
        flags=("-o", "--output"),
        metavar="DIR",
    ),
    command=_export_and_write,
    pose=_pose_export,
    formats=("text", "json", "domain"),
    help_="""
    \b
    foon-asp export --to pddl --goal 'greek salad' -o task
    fast-downward.py --plan-file plan task/domain.pddl task/problem.pddl --search 'astar(lmcut())'
    foon-asp read-plan plan --map task/map.json

    \b
    foon-asp export --goal ice                       the problem alone
    foon-asp export --goal ice --format domain       the domain alone
    foon-asp export --goal ice --format json         both, and the map of names

    While items last, no action deletes anything: the plan of least cost is the best task tree. Costs are
    whole numbers: exact where these fit into the 32 bits of planners, and otherwise rounded, as the
    logarithms of success always are; the answer says so. Of several objectives, the first counts most.

    With --items used-up, copies are numbers (:numeric-fluents), and the plan of least cost is the best plan.
    Few planners take that: with --items set, all copies of a node are one, and what is used up is deleted.
    Every such plan runs, but it may cost more than it has to, and there may be none where there is a plan.

    Exits with 0 when the task is written, whether there is a plan for it or not.
    """,
)
def export(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    target: Annotated[str, Option(flags=("--to",), choices=_FORMATS)] = "pddl",
    every_unit: Annotated[bool, Option(flags=("--whole",))] = False,
    items: str | None = None,
    **options: Unpack[Posed],
) -> Exported:
    """Write the goals of a problem as a planning task for other planners.

    Parameters:
        target: What to write: pddl, a domain and a problem.
        every_unit: Write the whole network, instead of the units that the goals can need.

    Returns:
        The PDDL as ``domain_file`` and ``problem_file``, and the ``name_map`` by which
        :func:`foon_asp.read_plan` reads plans back; ``write`` makes the three files.

    Raises:
        UserError: for a wrong argument, or where planners cannot add up what actions cost.

    Example:
        >>> exported = foon_asp.export(foon_asp.load().problem("ice"))
        >>> [action.name for action in exported.task.actions][:2]
        ['u26-twist', 'u27-crush']
    """
    if target not in _FORMATS:
        raise UserError(f"found target={target!r}, expected pddl")
    chosen = chosen_objectives(problem, objectives)
    if every_unit:
        problem = over_whole_network(problem)
    with start_deadline(options).watched("writing"):
        task = planning_task(problem, chosen, every_unit, _has_merged_copies(problem, items))
        exported = Exported(
            **question_fields(task.problem, task.objectives),
            domain_file=domain_text(task),
            problem_file=problem_text(task),
            name_map=MapFile.of(task),
        )
    return exported.set_unserialized(task=task)


@python_question
def to_unified_planning(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    every_unit: bool = False,
    items: str | None = None,
    **options: Unpack[Posed],
) -> Any:
    """Return the goals of a problem as a problem of unified-planning, with the names that PDDL has.

    :func:`foon_asp.read_plan` reads the plans for it back. The package comes with ``foon-asp[planning]``.

    Parameters:
        objectives: What actions cost: a name, names separated by commas, or several names.
        every_unit: Whether to give the whole network, instead of the units that the goals can need.
        items: How items are meant: ``lasting``, ``used-up`` with copies as numbers, or ``set``, in which all
            copies of a node are one; by default as in the problem.

    Returns:
        A ``unified_planning.model.Problem``.

    Raises:
        UserError: if unified-planning is not installed, for a wrong argument, or where planners cannot add
            up what actions cost.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> try:
        ...     len(foon_asp.to_unified_planning(problem).actions)
        ... except foon_asp.UserError:
        ...     5
        5
    """
    chosen = chosen_objectives(problem, objectives)
    problem = over_whole_network(problem) if every_unit else problem
    with start_deadline(options).watched("writing"):
        return unified_problem(problem, chosen, every_unit, _has_merged_copies(problem, items))
