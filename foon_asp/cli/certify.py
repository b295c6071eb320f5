"""``foon-asp certify``: a certificate for a question, or for a tree that some program wrote."""

from pathlib import Path

import click

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.program import assemble
from foon_asp.certificate import Certificate, Coverage, NotBestError, certify, certify_outcome, coverage
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.progress import Progress
from foon_asp.deadline import Deadline
from foon_asp.network import unit_at_level
from foon_asp.problem import Objective, Problem, levels, parse_objectives
from foon_asp.proof import Verdict, simulate_for
from foon_asp.report.answer import costs_text, headline
from foon_asp.report.certified import bound_text, certificate_lines
from foon_asp.report.whole_file import write_whole
from foon_asp.text import FoonReader, summarize


@click.command("certify")
@options.goal_option
@click.option(
    "--tree",
    "tree_file",
    type=click.Path(path_type=NamedPath),
    metavar="TREE.txt",
    help="A task tree to prove best.",
)
@click.option(
    "-o",
    "--output",
    "file",
    type=click.Path(path_type=NamedPath),
    metavar="FILE",
    help="Where to write it; stdout by default.",
)
@options.objective_option
@options.containers_option
@options.constraint_options
@options.constant_option
@options.limit_options
@options.data_options
def command(
    goals_named: tuple[str, ...],
    tree_file: Path | None,
    file: Path | None,
    objectives: tuple[str, ...],
    containers: str,
    constraints: tuple[Path, ...],
    encodings: Path | None,
    constants: tuple[str, ...],
    deadline: Deadline,
    lenient: bool,
    **data: object,
) -> ExitCode:
    """Write a certificate: a proof that `foon-asp verify` checks without a solver.

    \b
    foon-asp certify --goal 'greek salad' -o proof.json           the optimum is found and proved
    foon-asp certify --goal macaroni --tree tree.txt -o t.json    a tree in FOON text is proved best

    Exits with 0 when the certificate proves a tree optimal by every objective; with 1 when it proves that
    there is no tree, or when the tree given does not execute or is not the best; with 3 when it proves less
    (a bound, or the first objectives alone) or when none was found.
    """
    chosen = parse_objectives(objectives)
    check_outputs()
    dataset = options.read_dataset(lenient=lenient, **data)  # type: ignore[arg-type]
    # a certificate speaks about the whole network, by its digest
    with options.reading():
        problem = dataset.problem(dataset.goals(goals_named), containers, everything=True)
    settings = Settings(constraints, encodings, constants, session=options.session_here(), deadline=deadline)
    name = "standard output" if file is None else str(file)
    if tree_file is not None:
        return _certify_tree(problem, chosen, tree_file, settings, deadline, file, lenient)
    with Progress() as progress:
        outcome = solve(problem, chosen, settings, progress)
    outcome, certificate = find_certificate(outcome, settings, deadline)
    for line in (headline(outcome), *certificate_lines(outcome, certificate, name)):
        click.echo(line, err=True)
    write_certificate(certificate, file)
    if outcome.status is Status.INFEASIBLE and certificate is not None:
        return ExitCode.NEGATIVE
    if certificate is None or certificate.claim != "optimal" or certificate.certified != levels(chosen):
        return ExitCode.LIMIT
    return ExitCode.DONE


def find_certificate(
    outcome: Outcome, settings: Settings, deadline: Deadline
) -> tuple[Outcome, Certificate | None]:
    """Look for a certificate; at a limit, and at ctrl-C, the answer stands without one."""
    try:
        with deadline.watched("looking for a certificate"):
            return certify_outcome(outcome, settings, lambda: deadline.passed)
    except KeyboardInterrupt:
        return outcome, None


def write_certificate(certificate: Certificate | None, file: Path | None) -> None:
    """Write a certificate, if there is one, to a file or to stdout."""
    if certificate is None:
        return
    if file is None:
        click.echo(certificate.text(), nl=False)
    else:
        write_whole(file, certificate.text().encode())


def _certify_tree(
    problem: Problem,
    chosen: tuple[Objective, ...],
    tree_file: Path,
    settings: Settings,
    deadline: Deadline,
    file: Path | None,
    lenient: bool,
) -> ExitCode:
    """Prove a given tree best, with no solver but the linear relaxation."""
    problem.require_rates_for(chosen)
    # no solver looks at the rules and constants here, so a fault in them would go by without a word
    assemble(settings, lambda message: click.echo(message, err=True))
    covered = coverage(settings)
    with options.reading():
        ordered = _given_tree(problem, tree_file, covered, lenient)
    if ordered is None:
        return ExitCode.NEGATIVE
    wanted = levels(chosen)
    try:
        with deadline.watched("looking for a certificate"):
            certificate = certify(problem, wanted, ordered, covered, lambda: deadline.passed)
    except NotBestError as better:
        click.echo(
            f"no certificate: the tree is not the best by {', then '.join(wanted)}: it has "
            f"{costs_text(problem.costs(ordered))}, and there is one with {costs_text(better.costs)}",
            err=True,
        )
        return ExitCode.NEGATIVE
    if certificate is None:
        click.echo("no certificate was found", err=True)
        return ExitCode.LIMIT
    write_certificate(certificate, file)
    if certificate.claim == "bound":
        click.echo(f"a bound only: {bound_text(certificate.content)}", err=True)
        return ExitCode.LIMIT
    click.echo(f"proved best by {', then '.join(certificate.certified)}", err=True)
    return ExitCode.DONE if certificate.certified == wanted else ExitCode.LIMIT


def _given_tree(problem: Problem, tree_file: Path, covered: Coverage, lenient: bool) -> list[int] | None:
    """Read a tree and put it into an order that executes; says why there is none."""
    reader = FoonReader(lenient)
    tree = [unit_at_level(unit, problem.network.level) for unit, _ in reader.read_tree(tree_file)]
    for text in summarize(reader.diagnostics):
        click.echo(text, err=True)
    units = [problem.network.unit_id(unit) for unit in tree]
    known = [unit for unit in units if unit is not None]
    simulation = simulate_for(problem, problem.tree(known))
    why = None
    if len(known) < len(tree) or len(set(known)) < len(known):
        why = "a unit of the tree is not one of the network, or stands twice"
    elif simulation.verdict is Verdict.NEVER:
        why = "the tree does not execute; `foon-asp check` says why"
    elif covered.forbids(problem.network) & {*known}:
        why = "a unit of the tree is forbidden by the constraints"
    if why is not None:
        click.echo(f"no certificate: {why}", err=True)
        return None
    return [known[position] for position in simulation.order]
