"""``foon-asp help``: all verbs by group, or the help of one."""

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.verbs import FOR_PROGRAMS, GROUPS, verbs_of, write_verbs


@click.command("help")
@click.argument("verb", required=False, metavar="[VERB]")
@click.option("--all", "lists_all", is_flag=True, help="Also list the verbs that are for programs.")
@shared_options.debug_option
@click.pass_context
def command(context: click.Context, verb: str | None, lists_all: bool) -> ExitCode:
    """List all verbs by group, or explain one.

    \b
    foon-asp help                all verbs
    foon-asp help solve          one verb, as -h behind it
    foon-asp help --all          also those for programs: editors, shells, scripts
    """
    if verb is not None:
        context.find_root().command.main([verb, "-h"], "foon-asp", standalone_mode=False)
        return ExitCode.DONE
    formatter = context.make_formatter()
    for heading in GROUPS:
        if lists_all or heading != FOR_PROGRAMS:
            write_verbs(formatter, heading, verbs_of(heading))
    click.echo(formatter.getvalue().strip("\n"))
    return ExitCode.DONE
