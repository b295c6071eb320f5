"""``foon-asp solve``: the optimal task tree, and what is proved of it."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from foon_asp.asp import Settings, Status, solve
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode, of_status
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output import write_data
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import Progress
from foon_asp.cli.weighted_files import weighted_files
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, parse_objectives, reach
from foon_asp.reduce import Reduction, parse_reductions
from foon_asp.report import answer


@click.command("solve")
@options.goal_option
@options.objective_option
@options.containers_option
@options.constraint_options
@options.constant_option
@options.soft_option
@options.limit_options
@click.option(
    "--reduce",
    "reductions",
    default="all",
    show_default=True,
    metavar="all|safe|none|LIST",
    help=f"What comes before the search; safe keeps every optimal tree. LIST of: {', '.join(Reduction)}.",
)
@click.option(
    "--certificate",
    "certificate_file",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Also write a proof of the answer that `foon-asp verify` checks without a solver.",
)
@click.option(
    "--cross-check",
    is_flag=True,
    help="Also ask other engines: bare clingo, HiGHS, and Fast Downward where it is installed.",
)
@options.format_option("text", "json", "foon")
@options.data_options
@click.argument("clingo_options", nargs=-1, type=click.UNPROCESSED, metavar="[-- CLINGO OPTIONS]")
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    constraints: tuple[Path, ...],
    encodings: Path | None,
    constants: tuple[str, ...],
    soft: tuple[str, ...],
    deadline: Deadline,
    reductions: str,
    certificate_file: Path | None,
    cross_check: bool,
    format_: str,
    clingo_options: tuple[str, ...],
    **data: object,
) -> ExitCode:
    """Find the best task tree for a goal, and prove that none is better.

    \b
    foon-asp solve --goal 'greek salad'
    foon-asp solve --goal macaroni --objective success --containers implied
    foon-asp solve --goal ice --constraint forbid_motion -c forbidden_motion=crush
    foon-asp solve --goal ice --soft forbid_motion.lp=3 -c forbidden_motion=crush

    The rules without a head of a --soft file may be broken: each way, by other values of the variables, costs
    the weight. The least sum of weights comes before all objectives.

    Exits with 0 when the tree is proved optimal, 1 when no tree exists, 2 for bad input, 3 when stopped
    at a limit.
    """
    if clingo_options and not clingo_options[0].startswith("-"):
        raise UserError(f"found {clingo_options[0]!r}, expected an option; a goal is named by --goal NAME")
    chosen = parse_objectives(objectives)
    check_outputs()
    dataset = options.read_dataset(**data)  # type: ignore[arg-type]
    # What is asked by rules of the user's, and what is proved or asked again, is about the whole network.
    everything = bool(constraints or encodings or soft) or cross_check or certificate_file is not None
    with options.reading():
        problem = dataset.problem(dataset.goals(goals_named), containers, everything)
    settings = Settings(
        constraints,
        encodings,
        constants,
        clingo_options,
        reductions=parse_reductions(reductions),
        session=options.session_here(),
        deadline=deadline,
    )
    if soft:
        if certificate_file is not None:
            raise UserError("soft constraints have no certificates; leave one of them out")
        weights = weighted_files(soft, "--soft")
        return _solve_soft(problem, chosen, settings, weights, dataset.read_seconds, cross_check, format_)
    with Progress() as progress:
        outcome = solve(problem, chosen, settings, progress)
    outcome.seconds["read"] = dataset.read_seconds
    remarks: list[str] = []
    if certificate_file is not None:
        from foon_asp.cli.certify import find_certificate, write_certificate
        from foon_asp.report.certified import certificate_lines

        outcome, certificate = find_certificate(outcome, settings, deadline)
        write_certificate(certificate, certificate_file)
        remarks = certificate_lines(outcome, certificate, str(certificate_file))
    more: dict[str, object] = {}
    if cross_check:
        from foon_asp.cli.cross_check import check_across
        from foon_asp.engines import Asked

        lines, more = check_across(Asked(outcome, settings))
        remarks += lines
    if format_ == "json":
        click.echo(answer.outcome_json(outcome, more), nl=False)
    elif format_ == "foon":
        write_data(answer.outcome_foon(outcome))
    else:
        click.echo(answer.outcome_text(outcome), nl=False)
    if format_ == "text" and outcome.status is Status.INFEASIBLE:
        for line in answer.why_infeasible(problem, reach(problem).available):
            click.echo(line)
    if format_ != "text" and outcome.status is not Status.OPTIMAL:
        click.echo(answer.headline(outcome), err=True)
    for line in remarks:
        click.echo(line, err=format_ != "text")
    return of_status(outcome.status)


def _solve_soft(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    weights: Mapping[Path, int],
    read_seconds: float,
    cross_check: bool,
    format_: str,
) -> ExitCode:
    from foon_asp.asp.soft import solve_soft
    from foon_asp.report.soft import soft_json, soft_lines, soft_text

    with Progress() as progress:
        found = solve_soft(problem, objectives, settings, weights, progress)
    outcome = found.outcome
    outcome.seconds["read"] = read_seconds
    more: dict[str, object] = {}
    remarks: list[str] = []
    if cross_check:
        from foon_asp.cli.cross_check import check_across
        from foon_asp.engines import Asked

        remarks, more = check_across(Asked(outcome, settings, weights, found.penalty))
    if format_ == "json":
        click.echo(soft_json(found, more), nl=False)
    elif format_ == "text":
        click.echo(soft_text(found), nl=False)
    else:
        write_data(answer.outcome_foon(outcome))
        click.echo("\n".join([answer.headline(outcome), *soft_lines(found)]), err=True)
    if outcome.status is Status.INFEASIBLE and format_ == "text":
        for line in answer.why_infeasible(problem, reach(problem).available):
            click.echo(line)
    for line in remarks:
        click.echo(line, err=format_ != "text")
    return of_status(outcome.status)
