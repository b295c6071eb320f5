"""``foon-asp draw``: pictures of units, task trees and networks."""

import sys
from pathlib import Path

import click

from foon_asp.asp import Settings, solve
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.network import Network
from foon_asp.problem import parse_objectives
from foon_asp.report.answer import headline
from foon_asp.report.dot import write_dot
from foon_asp.report.drawing import Drawing, draw_units
from foon_asp.report.mermaid import write_mermaid
from foon_asp.report.picture import render_png, render_svg
from foon_asp.report.whole_file import write_whole
from foon_asp.text import FoonReader, find_goal, summarize

_SUFFIXES = {".dot": "dot", ".svg": "svg", ".png": "png", ".mmd": "mermaid"}
_LARGEST = 300  # units in a picture: laying out more takes minutes, and nobody could follow it


@click.command("draw")
@options.goal_option
@click.option("--tree", type=click.Path(path_type=Path), metavar="TREE.txt", help="A task tree in FOON text.")
@click.option("--unit", "units", type=int, multiple=True, metavar="ID", help="A unit by id; repeatable.")
@click.option(
    "--output", "-o", type=click.Path(path_type=Path), metavar="FILE", help="Where to; stdout by default."
)
@click.option(
    "--format",
    "format_",
    type=click.Choice(["dot", "svg", "png", "mermaid"]),
    help="By default what the suffix of FILE says, or dot.",
)
@options.objective_option
@options.containers_option
@options.time_limit_option
@options.data_options
def command(
    goals_named: tuple[str, ...],
    tree: Path | None,
    units: tuple[int, ...],
    output: Path | None,
    format_: str | None,
    objectives: tuple[str, ...],
    containers: str,
    time_limit: float | None,
    lenient: bool,
    **data: object,
) -> ExitCode:
    r"""Draw a task tree, units of the network, or the network as a whole.

    \b
    foon-asp draw --goal macaroni -o tree.svg        the optimal task tree
    foon-asp draw --tree tree.txt -o tree.png        a task tree in FOON text
    foon-asp draw --unit 12 --unit 13 -o units.svg   units, by id
    foon-asp draw --network recipe.txt -o whole.dot  everything

    Objects are green, those at hand pale green, goals framed in gold; motions are red. A dashed arrow gives
    back an input; in a task tree, what a step gives back is left out.
    """
    chosen = parse_objectives(objectives)
    format_ = _format(format_, output)
    question = options.read_question(lenient=lenient, **data)  # type: ignore[arg-type]
    network, kitchen = question.data.network, question.data.kitchen
    goals = [find_goal(name, network, question.data.goals) for name in goals_named]
    code = ExitCode.DONE
    if tree is not None:
        drawing = draw_units(network, _tree_units(network, tree, lenient), kitchen, goals, numbered=True)
    elif units:
        unknown = [unit for unit in units if not 0 <= unit < len(network)]
        if unknown:
            raise UserError(f"the network has no unit {unknown[0]}; its units are 0 to {len(network) - 1}")
        drawing = draw_units(network, units, kitchen, goals)
    elif goals:
        with Progress() as progress:
            problem = question.problem(tuple(goals), containers)
            outcome = solve(problem, chosen, Settings(time_limit=time_limit), progress)
        click.echo(headline(outcome), err=True)
        code = of_status(outcome.status)
        if outcome.units is None:
            return code
        drawing = draw_units(network, outcome.units, kitchen, goals, numbered=True)
    else:
        drawing = draw_units(network, range(len(network)), kitchen, goals)
    picture = _render(drawing, format_)
    if output is None:
        sys.stdout.buffer.write(picture)
    else:
        write_whole(output, picture)
        click.echo(f"wrote {output}", err=True)
    return code


def _format(format_: str | None, output: Path | None) -> str:
    if format_ is None and output is not None:
        format_ = _SUFFIXES.get(output.suffix.lower())
        if format_ is None:
            raise UserError(f"{output}: expected a name that ends in {', '.join(_SUFFIXES)}, or --format")
    if format_ == "png" and output is None and sys.stdout.isatty():
        raise UserError("a PNG does not go to a terminal; name a file with --output")
    return format_ or "dot"


def _tree_units(network: Network, file: Path, lenient: bool) -> list[int]:
    reader = FoonReader(lenient)
    units = []
    for unit, source in reader.read_tree(file):
        unit_id = network.unit_id(unit)
        if unit_id is None:
            raise UserError(f"{source}:1: error: the unit {unit.motion!r} is not one of the network")
        units.append(unit_id)
    for text in summarize(reader.diagnostics):
        click.echo(text, err=True)
    return units


def _render(drawing: Drawing, format_: str) -> bytes:
    if format_ == "mermaid":
        return write_mermaid(drawing).encode()
    dot = write_dot(drawing)
    if format_ == "dot":
        return dot.encode()
    if drawing.units > _LARGEST:
        raise UserError(
            f"a picture of {drawing.units} units would take minutes to lay out, and nobody could follow it: "
            "draw a task tree (--goal) or units (--unit), or write DOT (--format dot) for another program"
        )
    return render_svg(dot) if format_ == "svg" else render_png(dot)
