"""``foon-asp draw``: pictures of units, task trees and networks."""

import sys
from enum import StrEnum
from pathlib import Path

import click
from click.core import ParameterSource

from foon_asp.asp import Settings, Status, solve
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import utf_8, write_data
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import Progress
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import TaskTree, unit_at_level
from foon_asp.problem import ContainerRule, parse_objectives
from foon_asp.report.answer import counted, headline
from foon_asp.report.dot import dot_text
from foon_asp.report.drawing import Drawing, draw_network
from foon_asp.report.mermaid import mermaid_markdown, mermaid_text
from foon_asp.report.picture import png_picture, svg_picture
from foon_asp.report.tree_drawing import given_tree, solved_tree
from foon_asp.report.whole_file import write_whole
from foon_asp.text import Data, FoonReader, summarize


class _Format(StrEnum):
    DOT = "dot"
    SVG = "svg"
    PNG = "png"
    MERMAID = "mermaid"


_SUFFIXES = {
    ".dot": _Format.DOT,
    ".svg": _Format.SVG,
    ".png": _Format.PNG,
    ".mmd": _Format.MERMAID,
    ".md": _Format.MERMAID,
}


@click.command("draw")
@options.goal_option
@click.option(
    "--tree",
    "tree_file",
    type=click.Path(path_type=NamedPath),
    metavar="TREE.txt",
    help="A task tree to draw.",
)
@click.option("--unit", "units", multiple=True, type=int, metavar="ID", help="A unit to draw; repeatable.")
@click.option(
    "-o",
    "--output",
    "file",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help=f"Where to write; {' '.join(_SUFFIXES)} say in which format.",
)
@click.option(
    "--format",
    "format_",
    type=click.Choice([str(form) for form in _Format]),
    help="In which format, whatever the file is called; without a file DOT, to stdout.",
)
@options.objective_option
@options.containers_option
@options.limit_options
@options.data_options
def command(
    goals_named: tuple[str, ...],
    tree_file: Path | None,
    units: tuple[int, ...],
    file: Path | None,
    format_: str | None,
    objectives: tuple[str, ...],
    containers: str,
    deadline: Deadline,
    lenient: bool,
    **data: object,
) -> ExitCode:
    """Draw an optimal task tree, a given one, some functional units, or a whole network.

    \b
    foon-asp draw --goal macaroni -o tree.svg                the optimal task tree for a goal
    foon-asp draw --tree tree.txt --goal macaroni -o t.png   a task tree read from FOON text
    foon-asp draw --unit 12 -o unit.svg                      one functional unit, by id
    foon-asp draw --network FILE -o whole.dot                a whole network

    With --tree and --unit, --goal says which nodes are shown as goals, and nothing is solved. Exits with 0
    when there is a picture; for the tree of a goal as `solve` does.
    """
    form = _format(file, format_)
    if tree_file is not None and units:
        raise UserError("--tree and --unit are two different drawings: give one of them")
    to_solve = bool(goals_named) and tree_file is None and not units
    source = click.get_current_context().get_parameter_source("objectives")
    if not to_solve and source not in {ParameterSource.DEFAULT, ParameterSource.DEFAULT_MAP}:
        raise UserError("--objective chooses among the task trees for a --goal: here is nothing to choose")
    chosen = parse_objectives(objectives)
    check_outputs()
    dataset = options.read_dataset(lenient=lenient, **data)  # type: ignore[arg-type]
    goals = dataset.goals(goals_named) if goals_named else ()
    code = ExitCode.DONE
    if to_solve:
        with Progress() as progress:
            with options.reading():
                problem = dataset.problem(goals, containers)
            outcome = solve(problem, chosen, Settings(deadline=deadline), progress)
        code = of_status(outcome.status)
        if outcome.status is not Status.OPTIMAL:
            click.echo(headline(outcome), err=True)
        if outcome.units is None:
            return code
        drawing = solved_tree(outcome, outcome.units)
    elif tree_file is not None:
        drawing = _given_tree(dataset, goals, tree_file, ContainerRule(containers), lenient)
    else:
        data_shown, goals = dataset.part(goals, units) if units else (dataset.data, goals)
        drawing = _subgraph(data_shown, goals, units)
    _write(drawing, form, file)
    return code


def _format(file: Path | None, named: str | None) -> _Format:
    """Choose the format, before anything is read or solved."""
    if named is not None:
        form = _Format(named)
    elif file is None:
        form = _Format.DOT
    else:
        found = _SUFFIXES.get(file.suffix.lower())
        if found is None:
            raise UserError(
                f"{file}: the name says no format: end it in {' '.join(_SUFFIXES)}, or give --format"
            )
        form = found
    if form is _Format.PNG and file is None and sys.stdout.isatty():
        raise UserError("a terminal cannot show PNG: name a file with -o")
    return form


def _given_tree(
    dataset: Dataset, goal_ids: tuple[int, ...], file: Path, containers: ContainerRule, lenient: bool
) -> Drawing:
    """Read a tree and draw it with the data that it is about."""
    reader = FoonReader(lenient)
    level = dataset.names.level
    listed = (unit_at_level(unit, level) for unit, _ in reader.read_tree(file))
    tree = TaskTree(tuple(dict.fromkeys(listed)))
    for text in summarize(reader.diagnostics):
        click.echo(text, err=True)
    if not tree.units:
        raise UserError(f"{file}: no functional unit to draw")
    data, goal_ids = dataset.part(goal_ids, tree=tree)
    objects = data.network.objects
    kitchen = {objects[o] for o in data.kitchen}
    goals = [objects[o] for o in goal_ids]
    return given_tree(file.name, tree, kitchen, goals, containers, data.utensils, data.network)


def _subgraph(data: Data, goal_ids: tuple[int, ...], unit_ids: tuple[int, ...]) -> Drawing:
    """Draw the units that are named, or else all."""
    network = data.network
    shown = tuple(range(len(network)))
    if unit_ids:
        ids = map(network.unit_of_number, dict.fromkeys(unit_ids))
        shown = tuple(unit for unit in ids if unit is not None)
    if not unit_ids:
        caption = [f"A network of {counted(len(shown), 'unit')}"]
    elif len(shown) == 1:
        file, line, *_ = network.sources[shown[0]][0]
        caption = [f"Functional unit {unit_ids[0]} ({Path(file).name}, line {line})"]
    else:
        caption = [f"Functional units {', '.join(map(str, dict.fromkeys(unit_ids)))}"]
    units = [(network.unit_number(unit), network.unit(unit)) for unit in shown]
    objects = network.objects
    return draw_network(units, {objects[o] for o in data.kitchen}, {objects[o] for o in goal_ids}, caption)


def _write(drawing: Drawing, form: _Format, file: Path | None) -> None:
    """Write the picture to the file, or to stdout."""
    if form is _Format.SVG:
        content = svg_picture(drawing)
    elif form is _Format.PNG:
        content = png_picture(drawing)
    elif form is _Format.DOT:
        content = utf_8(dot_text(drawing))
    elif file is not None and file.suffix.lower() == ".md":
        content = utf_8(mermaid_markdown(drawing))
    else:
        content = utf_8(mermaid_text(drawing))
    if file is None:
        write_data(content)
    else:
        write_whole(file, content)
        click.echo(f"wrote {file}", err=True)
