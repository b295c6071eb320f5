"""``foon-asp why-not``: why there is no tree."""

import click

from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.explain.why_not import why_not
from foon_asp.report.explanation import explanation_json, explanation_text


@click.command("why-not")
@options.goal_option
@options.containers_option
@options.format_option("text", "json")
@options.data_options
def command(goals_named: tuple[str, ...], containers: str, format_: str, **data: object) -> ExitCode:
    """Explain."""
    question = options.read_question(**data)  # type: ignore[arg-type]
    problem = question.problem(question.goals(goals_named), containers)
    explanation = why_not(problem, question.data.kitchen_items)
    render = {"text": explanation_text, "json": explanation_json}[format_]
    click.echo(render(explanation), nl=False)
    return ExitCode.NEGATIVE
