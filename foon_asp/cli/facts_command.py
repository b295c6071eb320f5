"""``foon-asp facts``: the facts of a problem, for bare clingo."""

import shlex
from pathlib import Path

import click

from foon_asp.asp import Settings
from foon_asp.cli import shared_options
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.dataset.assumption_lines import goal_lines, kitchen_lines
from foon_asp.dataset.item_options import items_for
from foon_asp.errors import UserError
from foon_asp.problem import parse_objectives
from foon_asp.questions.facts import facts_of
from foon_asp.questions.options import (
    CONSTRAINTS,
    CONTAINERS,
    ENCODINGS,
    GOALS,
    ITEMS,
    OBJECTIVES,
    RULE,
    SOFT,
)
from foon_asp.rules.passed_constraint import Constraint


@click.command("facts")
@click_options(GOALS, OBJECTIVES, CONTAINERS, *ITEMS, CONSTRAINTS, RULE, ENCODINGS, SOFT)
@shared_options.format_option("text", "json")
@shared_options.sources_argument
@shared_options.data_options
def command(
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    items: str,
    stock: Path | None,
    stays: Path | None,
    constraints: tuple[Constraint, ...],
    encodings: Path | None,
    soft: dict[Constraint, int],
    format_: str,
    **data: object,
) -> ExitCode:
    """Print the facts that clingo is given for a goal; encodings/README.md says what they mean.

    Units that no goal can need are left out, which is right for constraints that only forbid. If a constraint
    demands something, name it with --constraint; then all units that can be made are printed. What is in no
    file is printed with the facts: a --rule, and a ready-made constraint with constants of its own, in which
    these and its helper predicates have names of their own. So are the rules of a --soft file, as rules for
    what is broken.

    \b
    foon-asp facts --goal ice > facts.lp
    python -m clingo encodings/{task_tree,objectives,show}.lp facts.lp mine.lp

    \b
    foon-asp facts --goal ice --soft mine.lp=3 > facts.lp
    python -m clingo encodings/*.lp encodings/questions/soft.lp facts.lp

    \b
    foon-asp facts --goal ice --items used-up > facts.lp
    python -m clingo encodings/used_up/*.lp facts.lp

    With items used up, they say how often the best plan can execute each unit, for which it is solved first.
    """
    dataset = shared_options.read_dataset(**data)  # type: ignore[arg-type]
    chosen = parse_objectives(objectives, dataset.measures)
    goals = dataset.command_goal_ids(goals_named)
    used_up = items_for(dataset, goals, (), items, stock, stays)
    problem = dataset.problem(goals, containers, items=used_up)
    if dataset.goals_from and not goals_named:
        if len(goals) > 1:
            goal_options = "".join(f"\n  --goal {shlex.quote(str(goal))}" for goal in dataset.assumed_goals())
            fault = "no file lists goals, and taken for them are"
            raise UserError(f"name a goal with --goal; {fault}{goal_options}")
        click.echo("\n".join(goal_lines(dataset, problem.goal_nodes, shared_options.is_verbose())), err=True)
    if not dataset.has_kitchen:
        click.echo("\n".join(kitchen_lines(dataset, [problem], shared_options.is_verbose())), err=True)
    facts = facts_of(problem, chosen, Settings(constraints, encodings), soft)
    if format_ == "json":
        click.echo(facts.json_text(), nl=False)
    else:
        write_data(facts.program)
    return ExitCode.DONE
