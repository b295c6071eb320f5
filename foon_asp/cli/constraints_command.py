"""``foon-asp constraints``: a list of the ready-made constraints, and explanations of rules."""

import click

from foon_asp.cli import shared_options
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_parts
from foon_asp.cli.progress_line import Progress
from foon_asp.errors import UserError
from foon_asp.questions.constraint_list import list_constraints
from foon_asp.questions.options import CONSTANTS, CONSTRAINTS, RULE
from foon_asp.questions.question import TABLES, Role
from foon_asp.results.document import Document
from foon_asp.rules.passed_constraint import Constraint, RuleText

_EXPLAIN = CONSTRAINTS._replace(
    name="explained",
    flags=("--explain",),
    help="Say what the rules of a file or of a ready-made constraint do, and how fast that is.",
)
_RULE = RULE._replace(
    name="rule_texts", role=Role.COMMAND, help="A rule to explain, by itself or beside files."
)
_CONSTANTS = CONSTANTS._replace(name="constant_values", help="The value of a #const in what is explained.")


@click.command("constraints")
@click_options(_EXPLAIN, _RULE, _CONSTANTS)
@shared_options.format_option(*TABLES)
@shared_options.debug_option
def command(
    explained: tuple[Constraint, ...],
    rule_texts: tuple[str, ...],
    constant_values: tuple[str, ...],
    format_: str,
) -> ExitCode:
    """List the ready-made constraints: what each demands, and how to use it.

    Add the last line of an entry to solve, why-not or shopping-list. A constraint is a file of a few
    lines; the docs (writing-constraints.md) teach writing one of your own.

    With --explain or --rule, say of each rule what it does to trees, and whether it looks at more than the
    tree: that decides how much can be left out before the search. Name all that you use together, since a
    rule may depend on others.
    """
    constraints = (*explained, *map(RuleText, rule_texts))
    if constraints:
        return _explain(constraints, constant_values, format_)
    if constant_values:
        raise UserError("-c sets a constant of what is explained: name that with --explain")
    return _show(list_constraints(), format_)


def _explain(constraints: tuple[Constraint, ...], constants: tuple[str, ...], format_: str) -> ExitCode:
    """Print what each rule does; return ``ExitCode.DONE``.

    Raises :class:`UserError` if the built-in encodings were changed, so that nothing is known of rules.
    """
    from foon_asp.questions.explained_rules import explain_rules  # takes clingo along

    return _show(explain_rules(constraints, constants, Progress()), format_)


def _show(document: Document, format_: str) -> ExitCode:
    """Print a document in a format; return ``ExitCode.DONE``."""
    if format_ == "text":
        write_parts(document.show())
    else:
        click.echo(document.json_text() if format_ == "json" else getattr(document, format_)(), nl=False)
    return ExitCode.DONE
