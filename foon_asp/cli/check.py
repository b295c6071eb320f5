"""``foon-asp check``: does a tree that some program wrote execute?"""

from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.dataset import ask
from foon_asp.network import TaskTree, unit_at_level
from foon_asp.proof import Verdict, simulate_for
from foon_asp.report.verdict import verdict_json, verdict_text
from foon_asp.text import FoonReader, summarize


@click.command("check")
@click.argument("tree_file", type=click.Path(path_type=NamedPath), metavar="TREE.txt")
@options.goal_option
@options.containers_option
@options.format_option("text", "json")
@options.data_options
def command(
    tree_file: Path,
    goals_named: tuple[str, ...],
    containers: str,
    format_: str,
    lenient: bool,
    **data: object,
) -> ExitCode:
    """Simulate a task tree given as FOON text, units in the order of execution.

    \b
    foon-asp check tree.txt --goal macaroni

    Exits with 0 when the tree executes, as listed or in the order that is then given; with 1 when no
    order executes or when a unit is not one of the network.
    """
    dataset = options.read_dataset(lenient=lenient, **data)  # type: ignore[arg-type]
    goals = dataset.goals(goals_named)
    reader = FoonReader(lenient)
    listed = reader.read_tree(tree_file)
    for text in summarize(reader.diagnostics):
        click.echo(text, err=True)
    listed = [(unit_at_level(unit, dataset.names.level), source) for unit, source in listed]
    tree = TaskTree(tuple(unit for unit, _ in listed))
    data_of_tree, goals = dataset.part(goals, tree=tree)
    problem = ask(data_of_tree, goals, containers)
    simulation = simulate_for(problem, tree)
    render = {"text": verdict_text, "json": verdict_json}[format_]
    click.echo(render(problem, listed, simulation), nl=False)
    foreign = any(problem.network.unit_id(unit) is None for unit in tree)
    return ExitCode.NEGATIVE if foreign or simulation.verdict is Verdict.NEVER else ExitCode.DONE
