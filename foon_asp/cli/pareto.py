"""``foon-asp pareto``: what one objective costs by another, as the whole Pareto front."""

from pathlib import Path

import click

from foon_asp.cli.asked import Asked, asking
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import Progress
from foon_asp.explain.pareto import Front, pareto_front
from foon_asp.problem import Objective
from foon_asp.report.chart_file import check_suffix
from foon_asp.report.pareto import front_json, front_text


@click.command("pareto")
@asking(
    click.option("--trees", is_flag=True, help="List the units of the trees too."),
    click.option(
        "--chart",
        "charts",
        multiple=True,
        type=click.Path(path_type=NamedPath),
        metavar="FILE",
        help="Draw the front (.svg or .png); repeatable.",
    ),
    objective=click.option(
        "--objective",
        "objectives",
        multiple=True,
        default=("units,success",),
        show_default=True,
        metavar="LIST",
        help=f"Two or three of {', '.join(Objective)}.",
    ),
)
def command(asked: Asked, trees: bool, charts: tuple[Path, ...]) -> ExitCode:
    """Find the whole Pareto front of two or three objectives, with a tree for every point.

    \b
    foon-asp pareto --goal macaroni                                  units against success
    foon-asp pareto --goal macaroni --objective inputs,success,kitchen --trees
    foon-asp pareto --goal macaroni --chart front.svg

    A point is on the front when no tree is as good by every objective and better by one. Points are compared
    exactly, each has the smallest tree that it can have, and that there are no others is proved.

    Exits with 0 when the front is whole, 1 when there is no tree, 3 when a limit came first; the points that
    were found by then are on the front too.
    """
    for chart in charts:
        check_suffix(chart)
    check_outputs()
    problem = asked.problem()
    with Progress() as progress:
        front = pareto_front(problem, asked.objectives, asked.settings, progress)
    for chart in charts:
        _write_chart(front, chart)
    click.echo(front_json(front) if asked.format_ == "json" else front_text(front, trees), nl=False)
    if not front.complete:
        return ExitCode.LIMIT
    return ExitCode.DONE if front.points else ExitCode.NEGATIVE


def _write_chart(front: Front, file: Path) -> None:
    from foon_asp.report.front_chart import write_front_chart

    if not front.points:
        click.echo(f"{file} is not written: there is no point to draw", err=True)
        return
    write_front_chart(front, file)
    click.echo(f"wrote {file}", err=True)
