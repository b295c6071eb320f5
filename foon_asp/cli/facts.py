"""``foon-asp facts``: what the solver is given, for bare clingo."""

from pathlib import Path

import click

from foon_asp.asp import Settings, program_facts
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.problem import parse_objectives


@click.command("facts")
@options.goal_option
@options.objective_option
@options.containers_option
@options.constraint_options
@options.data_options
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    constraints: tuple[Path, ...],
    encodings: Path | None,
    **data: object,
) -> ExitCode:
    """Print the facts that clingo is given for a goal; encodings/README.md says what they mean.

    Units that no goal can need are left out, which is right for constraints that only forbid. Name a
    constraint that asks for something with --constraint, and all units that can be made are there.

    \b
    foon-asp facts --goal ice > facts.lp
    python -m clingo encodings/{task_tree,objectives,show}.lp facts.lp mine.lp
    """
    chosen = parse_objectives(objectives)
    question = options.read_question(**data)  # type: ignore[arg-type]
    problem = question.problem(
        question.goals(goals_named), containers, everything=bool(constraints or encodings)
    )
    click.echo(program_facts(problem, chosen, Settings(constraints, encodings)), nl=False)
    return ExitCode.DONE
