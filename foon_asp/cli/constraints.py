"""``foon-asp constraints``: the ready-made constraints and their parameters, and what any rules do."""

import click

from foon_asp.cli import options
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_parts
from foon_asp.cli.progress import Progress
from foon_asp.errors import UserError
from foon_asp.questions.constraint_list import list_constraints
from foon_asp.questions.contract import TABLES, Role
from foon_asp.questions.options import CONSTANTS, CONSTRAINTS, RULE
from foon_asp.results.document import Document
from foon_asp.rules.constraint import Constraint, RuleText

_EXPLAIN = CONSTRAINTS._replace(
    name="explained",
    flags=("--explain",),
    help="Say what the rules of a file or of a ready-made constraint do, and how fast that is.",
)
_RULE = RULE._replace(name="stated", role=Role.COMMAND, help="A rule to explain, by itself or beside files.")
_CONSTANTS = CONSTANTS._replace(name="given", help="The value of a #const in what is explained.")


@click.command("constraints")
@click_options(_EXPLAIN, _RULE, _CONSTANTS)
@options.format_option(*TABLES)
@options.debug_option
def command(
    explained: tuple[Constraint, ...], stated: tuple[str, ...], given: tuple[str, ...], format_: str
) -> ExitCode:
    """List the ready-made constraints: what each demands, and how to use it.

    Add the last line of an entry to solve, why-not or shopping-list. A constraint is a file of a few
    lines; the docs (writing-constraints.md) teach writing one of your own.

    With --explain or --rule, say of each rule what it does to trees, and whether it looks at more than the
    tree: that decides how much can be left out before the search. Name all that you use together, since a
    rule may depend on others.
    """
    asked = (*explained, *map(RuleText, stated))
    if asked:
        return _explain(asked, given, format_)
    if given:
        raise UserError("-c sets a constant of what is explained: name that with --explain")
    return _show(list_constraints(), format_)


def _explain(asked: tuple[Constraint, ...], constants: tuple[str, ...], format_: str) -> ExitCode:
    """Print what rules do."""
    from foon_asp.questions.explained_rules import explain_rules  # takes clingo along

    return _show(explain_rules(asked, constants, Progress()), format_)


def _show(found: Document, format_: str) -> ExitCode:
    if format_ == "text":
        write_parts(found.show())
    else:
        click.echo(found.json_text() if format_ == "json" else getattr(found, format_)(), nl=False)
    return ExitCode.DONE
