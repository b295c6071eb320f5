"""``foon-asp diff``: two trees, or the answers to two questions, beside each other."""

import shlex
from pathlib import Path

import click
from click.core import ParameterSource

from foon_asp.asp import Settings, solve
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.options import read_dataset
from foon_asp.cli.progress import Progress
from foon_asp.cli.verbs import verb_command
from foon_asp.dataset import Dataset
from foon_asp.errors import UserError
from foon_asp.explain.difference import Listed, Side, difference, side
from foon_asp.network import unit_at_level
from foon_asp.problem import ContainerRule, Problem, parse_objectives
from foon_asp.reduce import parse_reductions
from foon_asp.report.answer import headline
from foon_asp.report.difference import difference_json, difference_text
from foon_asp.text import FoonReader, find_goal, summarize
from foon_asp.text.answer_file import read_listed_tree

_DATA = ("folder", "network", "kitchen", "rates", "utensils", "goals")


@click.command("diff")
@click.argument("left", metavar="A")
@click.argument("right", metavar="B")
@options.goal_option
@options.containers_option
@options.format_option("text", "json")
@options.data_options
def command(
    left: str,
    right: str,
    goals_named: tuple[str, ...],
    containers: str,
    format_: str,
    **data: object,
) -> ExitCode:
    """Show what two task trees have in common, what only one has, what each costs, and where they part.

    \b
    foon-asp diff mine.txt answer.json
    foon-asp diff mine.txt 'solve --goal macaroni'
    foon-asp diff 'solve --goal macaroni' 'solve --goal macaroni --objective success'

    A and B are files (FOON text, or an answer in JSON) or questions: solve with its options, in quotes. The
    kitchen, the rates and the goal of a file are those that the options name; an answer knows its goals. What
    is given beside A and B counts for a question that does not say it itself; one that names data of its own
    takes none from there.
    Without goals the trees are followed back from all that they make and do not need.

    Exits with 0 when both were compared, whether they differ or not, and with 1 when one has no tree.
    """
    dataset: list[Dataset] = []  # read once, and only when a file is to be looked at
    sides: list[Side] = []
    ended = ExitCode.DONE
    for name in (left, right):
        if name.split(" ")[0] == "solve" and not Path(name).exists():
            found, code = _solved(name)
            ended = max(ended, code)
        else:
            dataset = dataset or [read_dataset(**data)]  # type: ignore[arg-type]
            found = _listed(Path(name), dataset[0], goals_named, containers, bool(data["lenient"]))
        if found is None:
            return ExitCode.NEGATIVE if ended is ExitCode.DONE else ended
        sides.append(found)
    render = {"text": difference_text, "json": difference_json}[format_]
    click.echo(render(difference(*sides)), nl=False)
    return ended


def _listed(
    file: Path, dataset: Dataset, goals_named: tuple[str, ...], containers: str, lenient: bool
) -> Side | None:
    """Read a tree from a file; ``None`` for an answer that has none."""
    reader = FoonReader(lenient)
    tree = read_listed_tree(file, reader)
    for text in summarize(reader.diagnostics):
        click.echo(text, err=True)
    if tree.units is None:
        click.echo(f"{file}: the answer has no tree ({tree.status})", err=True)
        return None
    data, network = dataset.data, dataset.data.network
    objects = network.objects
    goals = tree.goals or tuple(objects[find_goal(name, network, data.goals)] for name in goals_named)
    listed = [(unit_at_level(unit, network.level), source) for unit, source in tree.units]
    kitchen = frozenset(objects[o] for o in data.kitchen)
    rule = ContainerRule(containers)
    return side(str(file), listed, goals, kitchen, rule, data.utensils, data.rates, network)


def _solved(question_text: str) -> tuple[Side | None, ExitCode]:
    """Answer a question that is put as the words of a command; ``None`` where it has no tree."""
    solve_command = verb_command("solve")
    words, name = shlex.split(question_text)[1:], f"diff '{question_text}'"
    context = click.get_current_context()
    beside = {option: value for option, value in context.params.items() if _is_given(context, option)}
    own = solve_command.make_context(name, list(words), obj=context.obj)
    if any(_is_given(own, option) for option in _DATA):
        beside = {option: value for option, value in beside.items() if option not in _DATA}
    defaults = {**(context.default_map or {}), **beside}  # a session has something to say, too
    asked = dict(solve_command.make_context(name, words, default_map=defaults, obj=context.obj).params)
    if any(asked.pop(name) for name in ("certificate_file", "cross_check", "soft")):
        raise UserError(
            f"found {question_text!r}, expected a question without --certificate, --cross-check, --soft"
        )
    asked.pop("format_")
    goals, objectives = asked.pop("goals_named"), parse_objectives(asked.pop("objectives"))
    containers = asked.pop("containers")
    names = ("constraints", "encodings", "constants", "clingo_options", "time_limit")
    memory_limit = asked.pop("memory_limit")
    reductions = parse_reductions(asked.pop("reductions"))
    settings = Settings(*map(asked.pop, names))._replace(reductions=reductions, memory_limit=memory_limit)
    settings = settings.limited()
    with settings.begun.watched("reading"):
        dataset = read_dataset(**asked)
        problem = dataset.problem(dataset.goals(goals), containers, everything=True)
    settings = settings._replace(session=options.session_here())
    with Progress() as progress:
        outcome = solve(problem, objectives, settings, progress)
    code = of_status(outcome.status)
    if outcome.units is None:
        click.echo(f"{question_text}: {headline(outcome)}", err=True)
        return None, code
    return _side(question_text, problem, outcome.units), code


def _is_given(context: click.Context, option: str) -> bool:
    return context.get_parameter_source(option) is ParameterSource.COMMANDLINE


def _side(name: str, problem: Problem, units: tuple[int, ...]) -> Side:
    network = problem.network
    listed: Listed = [(network.unit(unit), network.sources[unit][0]) for unit in units]
    goals = [network.objects[goal] for goal in problem.goals]
    kitchen = frozenset(network.objects[o] for o in problem.kitchen)
    return side(name, listed, goals, kitchen, problem.containers, problem.utensils, problem.rates, network)
