"""``foon-asp search``: the tree that one of the searches of the literature returns."""

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.cli.search_options import search_options
from foon_asp.deadline import Deadline
from foon_asp.proof import Verdict, simulate_for
from foon_asp.report.retrieval import retrieval_foon, retrieval_json, retrieval_text
from foon_asp.search import SEARCHES, Count, Ending, SearchSettings, Ties


@click.command("search")
@click.argument("name", type=click.Choice(list(SEARCHES)))
@options.goal_option
@search_options
@click.option("--published", is_flag=True, help="ids as published: the first unit everywhere, as bfs.")
@options.containers_option
@options.limit_options
@options.format_option("text", "json", "foon")
@options.data_options
def command(
    name: str,
    goals_named: tuple[str, ...],
    ties: str,
    count: str,
    depth_limit: int | None,
    published: bool,
    containers: str,
    deadline: Deadline,
    format_: str,
    **data: object,
) -> ExitCode:
    """Retrieve a task tree as the literature does, and say whether it executes.

    \b
    foon-asp search bfs --goal 'greek salad'
    foon-asp search ids --goal macaroni --containers implied

    bfs, dfs, greedy-success and greedy-inputs choose one unit for each object and never look back; ids
    backtracks, and returns a tree of least depth that executes or says that none does.

    Exits with 0 when the tree executes, as listed or in another order; 1 when it never does or there is
    none; 3 when stopped at a limit.
    """
    dataset = options.read_dataset(**data)  # type: ignore[arg-type]
    with options.reading():
        problem = dataset.problem(dataset.goals(goals_named), containers)
    settings = SearchSettings(
        Ties(ties), Count(count), published, depth_limit, deadline.left, deadline.memory
    )
    search = SEARCHES[name]
    retrieval = search.run(problem, settings)
    simulation = None
    if retrieval.ending is Ending.TREE:
        simulation = simulate_for(problem, problem.tree(retrieval.units))
    render = {"text": retrieval_text, "json": retrieval_json, "foon": retrieval_foon}[format_]
    text = render(problem, search, retrieval, simulation)
    if format_ == "foon":
        write_data(text)
    else:
        click.echo(text, nl=False)
    if retrieval.ending is Ending.UNKNOWN:
        return ExitCode.LIMIT
    executes = simulation is not None and simulation.verdict is not Verdict.NEVER
    return ExitCode.DONE if executes else ExitCode.NEGATIVE
