"""A picture of an optimal task tree, of a given one, of some functional units, or of a whole network."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

from foon_asp.dataset.nearby import shown
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import FunctionalUnit, TaskTree, counted, unit_at_level
from foon_asp.problem import ContainerRule, Problem, container_rule
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, answered_under
from foon_asp.questions.arguments import Constants, Objectives, chosen_objectives, settings
from foon_asp.questions.caller import is_python
from foon_asp.questions.contract import Kind, Option, Part, question, question_of
from foon_asp.questions.options import CONTAINERS, GOALS, HOW, ITEMS, OBJECTIVES
from foon_asp.questions.posing import Command, one_problem_or_nearby, the_data
from foon_asp.questions.result import Ending, NothingToDrawError, Result
from foon_asp.questions.tree import Tree, read_listed
from foon_asp.report.dot import dot_text
from foon_asp.report.drawing import Drawing, draw_network
from foon_asp.report.mermaid import mermaid_markdown, mermaid_text
from foon_asp.report.notebook import picture_bundle
from foon_asp.report.picture import png_picture, svg_picture
from foon_asp.report.tree_drawing import given_tree, plan_drawing, solved_tree
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.data_folder import Data

_MERMAID_PAGE = ".md"
_FOR_THE_BEST = {
    "objectives": "--objective",
    "constraints": "--constraint",
    "rules": "--rule",
    "constants": "-c",
    "encodings": "--encodings",
}


@dataclass(frozen=True, repr=False)
class Drawn(Result):
    """A picture: ``picture`` is what it shows, or ``None`` if there is no tree.

    ``outcome`` is the answer that it shows, or ``None`` if nothing was solved. Each format raises
    :class:`NothingToDrawError` if there is no tree. SVG and PNG raise :class:`UserError` if the picture
    would be too large, or if the packages of ``foon-asp[pictures]`` are missing.

    Example:
        >>> drawn = foon_asp.draw(foon_asp.load().problem("ice"))
        >>> drawn.mermaid().splitlines()[0]
        '---'
        >>> drawn.dot().splitlines()[0]
        'digraph foon {'
    """

    picture: Drawing | None
    outcome: Answer | None = None

    @property
    def ending(self) -> Ending:
        """Done when there is a picture; for the tree of a goal as that was solved."""
        return Ending.DONE if self.outcome is None else self.outcome.ending

    def remark(self, format_: str) -> str:
        """Say what is known of a tree that is not proved to be the best, or why there is none."""
        return "" if self.outcome is None else self.outcome.remark(format_)

    def text(self) -> str:
        """Give the picture in DOT, or why there is none."""
        return self.remark("text") + "\n" if self.picture is None else self.dot()

    def json_dict(self) -> object:
        """Refuse: a picture is written in its own formats.

        Raises:
            UserError: always.
        """
        raise UserError("a picture has no JSON; the JSON of the answer contains the tree")

    def dot(self) -> str:
        """Give the picture in DOT, Graphviz' language."""
        return dot_text(self._shown())

    def svg(self) -> str:
        """Give the picture as SVG, a document by itself."""
        return svg_picture(self._shown()).decode()

    def png(self) -> bytes:
        """Give the picture as PNG."""
        return png_picture(self._shown())

    def mermaid(self) -> str:
        """Give the picture as a Mermaid flowchart."""
        return mermaid_text(self._shown())

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the picture into a file; a file that ends in ``.md`` is a page with a Mermaid flowchart.

        Parameters:
            file: The path of the file.
            format_: ``dot``, ``svg``, ``png`` or ``mermaid``; without it, the end of the file name chooses
                one.

        Raises:
            NothingToDrawError: if there is no tree.
            UserError: for another format, or a picture that cannot be made.
        """
        file = Path(file)
        how = question_of(draw)
        form = format_ or how.format_of(file)
        if form not in how.formats:
            raise UserError(f"found the format {form!r}, expected one of {', '.join(how.formats)}")
        page = form == "mermaid" and file.suffix.lower() == _MERMAID_PAGE
        content: str | bytes = mermaid_markdown(self._shown()) if page else getattr(self, form)()
        write_whole(file, utf_8(content) if isinstance(content, str) else content)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.picture

    def _shown(self) -> Drawing:
        if self.picture is None:
            raise NothingToDrawError("there is no tree to draw")
        return self.picture

    def __repr__(self) -> str:
        return f"<Drawn: {self.remark('text') if self.picture is None else self.picture.caption[0]}>"

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the picture."""
        return super()._in_notebook() if self.picture is None else picture_bundle(self, self.picture)


def _posed(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    tree: File | None,
    units: Sequence[int],
    **items: Any,
) -> tuple[Problem | Foon]:
    """Pose the goals that are named; without any it is about the data."""
    if not goals_named and command.given("items"):
        raise UserError("--items is for a plan for a --goal: name one")
    solves = bool(goals_named) and tree is None and not units
    for option, flag in _FOR_THE_BEST.items():
        if command.given(option) and not solves:
            raise UserError(f"{flag} is for the best tree for a --goal; nothing is solved here")
    if not goals_named:
        return the_data(command)
    return one_problem_or_nearby(command, goals_named, containers, **items)


@question(
    GOALS,
    Option("tree", "A task tree to draw.", Kind.FILE, Part.PROBLEM | Part.QUESTION, metavar="TREE.txt"),
    Option(
        "units",
        "The id of a unit to draw.",
        Kind.WHOLE,
        Part.PROBLEM | Part.QUESTION,
        flags=("--unit",),
        many=True,
        metavar="ID",
    ),
    OBJECTIVES,
    CONTAINERS._replace(part=Part.PROBLEM | Part.QUESTION),
    *ITEMS,
    *HOW,
    help_="""
    \b
    foon-asp draw --goal macaroni -o tree.svg                the optimal task tree for a goal
    foon-asp draw --goal ice --constraint mine.lp -o i.svg   the best one under rules
    foon-asp draw --tree tree.txt --goal macaroni -o t.png   a task tree read from FOON text
    foon-asp draw --unit 12 -o unit.svg                      one functional unit, by id
    foon-asp draw --network FILE -o whole.svg                a whole network

    With --tree and --unit, --goal says which nodes are shown as goals, and nothing is solved. Exits with 0
    when there is a picture; for the tree of a goal as `solve` does.
    """,
    formats=("dot", "svg", "png", "mermaid"),
    suffixes={".dot": "dot", ".svg": "svg", ".png": "png", ".mmd": "mermaid", _MERMAID_PAGE: "mermaid"},
    pose=_posed,
)
def draw(
    about: Problem | Foon,
    objectives: Objectives = "units",
    *,
    tree: str | PathLike[str] | Iterable[FunctionalUnit] | None = None,
    units: Iterable[int] = (),
    containers: str = "strict",
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Drawn:
    """Draw the optimal task tree of a problem, a given tree, some units, or a whole network.

    Only the first of these is solved, and only for that are there ``objectives``, rules and limits.

    Parameters:
        about: A problem, whose goals are marked in the picture; or data that were loaded, whose whole
            network is drawn.
        tree: A tree to draw: the path of a file (FOON text, or an answer in JSON), or functional units.
        units: Ids of units to draw, as in ``json()``.
        containers: The container rule for a tree that is drawn with data: ``strict`` or ``implied``. A
            problem has its own.

    Returns:
        The drawing, which gives ``svg()``, ``png()``, ``dot()`` and ``mermaid()``, and can ``write`` a file.

    Raises:
        UserError: for a wrong argument, a file that cannot be read, a unit that the network does not
            have, or rules where nothing is solved.

    Example:
        >>> drawn = foon_asp.draw(foon_asp.load().problem("ice"))
        >>> drawn.dot().splitlines()[0]
        'digraph foon {'
    """
    wanted = tuple(dict.fromkeys(units))
    if tree is not None and wanted:
        raise UserError("a tree and units are two different drawings: give one of them")
    if isinstance(about, Problem) and tree is None and not wanted:
        how = settings(constraints, constants, encodings, time_limit, memory_limit)
        outcome = answered_under(about, chosen_objectives(about, objectives), how)
        return Drawn(None if outcome.units is None else solved_tree(outcome, outcome.units), outcome)
    if is_python() and (constraints or constants or encodings is not None):  # those of a session stand
        raise UserError("rules are for the best tree of a problem; nothing is solved here")
    if isinstance(about, Problem) and about.items is not None and tree is not None:
        read = Tree.read(about, tree) if isinstance(tree, str | PathLike) else Tree.given(about, tree)
        name = Path(tree).name if isinstance(tree, str | PathLike) else ""
        return Drawn(plan_drawing(read.problem, read.units, name))
    foon, goals, rule = _data(about, containers)
    if tree is not None:
        return Drawn(_given_tree(foon, goals, rule, tree))
    if wanted:
        return Drawn(_subgraph(*foon.dataset.part(goals, wanted), wanted))
    return Drawn(_subgraph(foon.dataset.data, (), ()))


def _data(about: Problem | Foon, containers: str) -> tuple[Foon, Sequence[int], ContainerRule]:
    """Give the data, the goals by id in the whole network, and the container rule."""
    if isinstance(about, Foon):
        return about, (), container_rule(containers)
    part = shown(about)
    goals = [part.network.object_number(goal) for goal in part.goals]
    return Foon.of(about), goals, about.containers


def _given_tree(
    foon: Foon,
    goal_ids: Sequence[int],
    rule: ContainerRule,
    given: str | PathLike[str] | Iterable[FunctionalUnit],
) -> Drawing:
    """Draw a tree with the data that it is about."""
    name = ""
    if isinstance(given, str | PathLike):
        name = Path(given).name
        listed = [unit for unit, _ in read_listed(Path(given))[0]]
    else:
        listed = list(given)
    tree = TaskTree(tuple(dict.fromkeys(unit_at_level(unit, foon.level) for unit in listed)))
    if not tree.units:
        raise UserError(f"{given}: no functional unit to draw" if name else "no functional unit to draw")
    data, goal_ids = foon.dataset.part(goal_ids, tree=tree)
    objects = data.network.objects
    kitchen = {objects[o] for o in data.kitchen}
    goals = [objects[o] for o in goal_ids]
    return given_tree(name, tree, kitchen, goals, rule, data.utensils, data.network)


def _subgraph(data: Data, goal_ids: Iterable[int], unit_ids: tuple[int, ...]) -> Drawing:
    """Draw the units that are named, or else all."""
    network = data.network
    drawn = tuple(range(len(network)))
    if unit_ids:
        drawn = tuple(unit for unit in map(network.unit_of_number, unit_ids) if unit is not None)
    if not unit_ids:
        caption = [f"A network of {counted(len(drawn), 'unit')}"]
    elif len(drawn) == 1:
        file, line, *_ = network.sources[drawn[0]][0]
        caption = [f"Functional unit {unit_ids[0]} ({Path(file).name}, line {line})"]
    else:
        caption = [f"Functional units {', '.join(map(str, unit_ids))}"]
    units = [(network.unit_number(unit), network.unit(unit)) for unit in drawn]
    objects = network.objects
    return draw_network(units, {objects[o] for o in data.kitchen}, {objects[o] for o in goal_ids}, caption)
