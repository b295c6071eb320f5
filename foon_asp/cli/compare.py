"""``foon-asp compare``: the searches of the literature held against the optimum."""

import contextlib
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import console
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import bar
from foon_asp.cli.search_options import search_options
from foon_asp.compare import (
    Comparison,
    ResultsFile,
    all_proved,
    compare_goals,
    comparison_json,
    makeable,
    summarize_comparisons,
)
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.report.comparison_table import (
    comparisons_csv,
    comparisons_markdown,
    print_comparisons,
    summary_lines,
)
from foon_asp.report.published_table import PublishedTable, published_markdown, read_published
from foon_asp.resources import published_table
from foon_asp.search import SEARCHES, Count, SearchSettings, Ties

_CHARTED = 60  # goals that a chart has room for


@click.command("compare")
@click.option(
    "--goal", "goals_named", multiple=True, metavar="NAME", help="A goal by label or notation; repeatable."
)
@click.option("--all-makeable", is_flag=True, help="Every object that can be made; prints a summary.")
@click.option(
    "--search",
    "searches",
    multiple=True,
    type=click.Choice(list(SEARCHES)),
    default=tuple(SEARCHES),
    help="Searches to run; all of them by default.",
)
@search_options
@click.option("--published", is_flag=True, help="Lay the published table beside what is measured.")
@options.containers_option
@options.each_limit_options
@click.option("--jobs", type=click.IntRange(min=1), default=1, show_default=True, help="Processes to use.")
@click.option(
    "--results",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="JSON Lines, written as results come; run again to go on after an interruption.",
)
@click.option(
    "--chart",
    "charts",
    multiple=True,
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Bar chart of units (.svg or .png); repeatable.",
)
@options.format_option("text", "json", "csv", "markdown")
@options.data_options
def command(
    goals_named: tuple[str, ...],
    all_makeable: bool,
    searches: tuple[str, ...],
    ties: str,
    count: str,
    depth_limit: int | None,
    published: bool,
    containers: str,
    time_limit: float | None,
    memory_limit: int | None,
    jobs: int,
    results: Path | None,
    charts: tuple[Path, ...],
    format_: str,
    **data: object,
) -> ExitCode:
    """Run the searches, simulate every tree they return, and prove the optima beside them.

    \b
    foon-asp compare                                   every goal of the goals file
    foon-asp compare --goal macaroni --containers implied
    foon-asp compare --all-makeable --jobs 2 --results makeable.jsonl

    Each goal is a question of its own, and the limits are for each of its answers. Exits with 0 when every
    optimum is proved, and with 3 when one was stopped at a limit.
    """
    check_outputs()
    dataset = options.read_dataset(**data)  # type: ignore[arg-type]
    table = read_published(published_table()) if published else None
    if table is not None:
        goals_named = goals_named or tuple(table.goals)
        unknown = [name for name in goals_named if name not in table.goals]
        if unknown or all_makeable:
            raise UserError(f"the published table has the goals {', '.join(table.goals)} and no others")
    if all_makeable:
        goals = makeable(dataset.problem((0,), containers, everything=True))
    else:
        goals = list(dict.fromkeys(dataset.each_goal(goals_named)))
    if not goals:
        raise UserError("there are no goals: name some with --goal, or a file of them with --goals")
    if charts and len(goals) > _CHARTED:
        raise UserError(f"a chart of {len(goals)} goals could not be read; name up to {_CHARTED} with --goal")
    settings = SearchSettings(Ties(ties), Count(count), published, depth_limit, time_limit, memory_limit)
    # Results are kept with a digest of all the data.
    everything = all_makeable or results is not None
    problem = dataset.problem(goals, containers, everything)
    goals = list(problem.goals)
    rows = _run(problem, goals, searches, settings, jobs, results)

    for chart in charts:
        _write_chart(rows, problem, goals, chart)
    if table is not None and format_ in {"text", "markdown"}:
        click.echo(_published(table, goals_named, rows, problem), nl=False)
    else:
        _print(rows, format_, all_makeable)
    return ExitCode.DONE if all_proved(rows) else ExitCode.LIMIT


def _run(
    problem: Problem,
    goals: Sequence[int],
    searches: Sequence[str],
    settings: SearchSettings,
    jobs: int,
    results: Path | None,
) -> list[Comparison]:
    """Compare goal by goal, with a progress bar, keeping results in a file if one is named."""
    names = {goal: str(problem.network.objects[goal]) for goal in goals}
    with contextlib.ExitStack() as stack:
        done: dict[str, Comparison] = {}
        file = None
        if results is not None:
            file = stack.enter_context(ResultsFile(results, _question(problem, searches, settings)))
            done = file.done
        left = [goal for goal in dict.fromkeys(goals) if names[goal] not in done]
        advance = stack.enter_context(bar("comparing", len(names), len(names) - len(left)))
        for row in compare_goals(problem, left, searches, settings, settings.time_limit, jobs):
            if file is None:
                done[row.goal] = row
            else:
                file.add(row)
            advance()
    return [done[names[goal]] for goal in goals]


def _question(problem: Problem, searches: Sequence[str], settings: SearchSettings) -> dict[str, object]:
    """Describe what is asked, so that results of another question are not taken for this one's."""
    network = problem.network
    digest = hashlib.sha256()
    for part in (
        [str(node) for node in network.objects],
        [network.motions, network.inputs, network.outputs],
        sorted(problem.kitchen),
        sorted(problem.utensils),
        sorted((motion, str(rate)) for motion, rate in (problem.rates or {}).items()),
    ):
        digest.update(json.dumps(part).encode())
    return {
        "data": digest.hexdigest()[:16],
        "containers": str(problem.containers),
        "level": problem.network.level,
        "searches": list(searches),
        "ties": str(settings.ties),
        "count": str(settings.count),
        "published": settings.published,
        "depth_limit": settings.depth_limit,
        "time_limit": settings.time_limit,
        **({} if settings.memory_limit is None else {"memory_limit": settings.memory_limit}),
    }


def _print(rows: list[Comparison], format_: str, summary_only: bool) -> None:
    summaries = summarize_comparisons(rows)
    words = "\n".join(summary_lines(summaries, all_proved(rows))) + "\n"
    if format_ == "json":
        click.echo(json.dumps([comparison_json(row) for row in rows], indent=2, ensure_ascii=False))
    elif format_ == "csv":
        click.echo(comparisons_csv(rows), nl=False)
    elif summary_only:
        click.echo(words, nl=False)
    elif format_ == "markdown":
        click.echo(comparisons_markdown(rows), nl=False)
    else:
        print_comparisons(rows, console())


def _published(table: PublishedTable, labels: Sequence[str], rows: list[Comparison], problem: Problem) -> str:
    if str(problem.containers) != table.containers:
        click.echo(
            f"warning: the published searches use {table.containers} containers, this is "
            f"{problem.containers}: add --containers {table.containers}",
            err=True,
        )
    return published_markdown(table, labels, rows)


def _write_chart(rows: list[Comparison], problem: Problem, goals: Sequence[int], file: Path) -> None:
    from foon_asp.report.bar_chart import write_chart
    from foon_asp.report.comparison_chart import comparison_chart

    labels = [problem.network.objects[goal].label for goal in goals]
    write_chart(comparison_chart(labels, rows), file)
    click.echo(f"wrote {file}", err=True)
