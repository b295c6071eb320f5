"""``foon-asp shell``: a session: data is read once, and many questions are asked."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

import click

from foon_asp.cli import options
from foon_asp.cli.click_option import click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.cli.output_file import read_files
from foon_asp.cli.shell_session import Leave, ShellSession
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule
from foon_asp.questions.options import CONTAINERS, GOALS, LIMITS, OBJECTIVES, RULES
from foon_asp.rules.constraint import Constraint

_NETWORK = re.compile(r"([^\S\n]*(#.*)?\n)*(//|O\d*\s|[\[{])")  # as FOON text and JSON begin, and no session
_DATA = "data are named with --network or --data"


@click.command("shell")
@click.argument("script", required=False, type=click.Path(path_type=NamedPath), metavar="[SCRIPT]")
@options.sources_argument
@click_options(GOALS, OBJECTIVES, CONTAINERS, *RULES, *LIMITS)
@options.data_options
def command(
    script: Path | None,
    goals_named: tuple[str, ...],
    objectives: tuple[str, ...],
    containers: str,
    constraints: tuple[Constraint, ...],
    encodings: Path | None,
    constants: tuple[str, ...],
    time_limit: float | None,
    memory_limit: int | None,
    lenient: bool,
    level: int,
    **data: object,
) -> ExitCode:
    """Read the data once, then change kitchen, goals, rule, constraints and objectives, and ask again.

    \b
    foon-asp shell --data my_foon
    foon-asp shell evening.txt           the lines of a file
    foon-asp shell < evening.txt

    \b
    goal macaroni
    solve
    lack 'pot; empty'
    why-not
    constraint forbid_motion forbidden_motion=pour
    solve --objective success

    help lists the words. Questions are asked as on the command line, with the same options; for options that
    are not given, the session's settings are used. Ctrl-C ends a question with the best answer so far.

    At a terminal, the session continues after an error, and exits with 0. A script ends at the first error,
    reports its line, and exits with 2; otherwise it exits with the code of the last question.
    """
    from_terminal = script is None and sys.stdin.isatty() and sys.stdout.isatty()
    dataset = options.read_dataset(lenient=lenient, level=level, **data)  # type: ignore[arg-type]
    if not dataset.has_kitchen:
        text = "warning: no kitchen is given, so what no unit makes is at hand; the word kitchen lists it"
        click.echo(text, err=True)
    session = ShellSession(dataset, lenient, level, encodings)
    session.files += read_files()
    session.containers = ContainerRule(containers)
    session.time_limit, session.memory_limit = time_limit, memory_limit
    session.choose(objectives)
    if constraints or constants or encodings:
        session.constrain(constraints, constants)
    if goals_named:
        session.set_goals(goals_named)
    if not from_terminal:
        return _run_script(session, script)
    from foon_asp.cli.shell_prompt import prompted_lines  # slow to import, and only for terminals

    click.echo("help lists the words, tab completes them, ctrl-D leaves", err=True)
    for line in prompted_lines(session):
        try:
            session.run(line)
        except Leave:
            break
        except (UserError, click.ClickException) as error:
            click.echo(f"error: {_message(error)}", err=True)
        except (click.Abort, KeyboardInterrupt):
            click.echo("interrupted before there was an answer", err=True)
    return ExitCode.DONE


def _run_script(session: ShellSession, script: Path | None) -> ExitCode:
    name = "<stdin>" if script is None else str(script)
    for number, line in enumerate(_lines(script), 1):
        try:
            session.run(line)
        except Leave:
            break
        except (UserError, click.ClickException) as error:
            raise UserError(f"{name}:{number}: error: {_message(error)}") from error
    return session.code


def _lines(script: Path | None) -> Iterator[str]:
    """Give the lines, each as soon as it can be read."""
    if script is None:
        yield from sys.stdin
        return
    try:
        if script.is_dir():
            raise UserError(f"{script}: found a folder, expected the lines of a session; {_DATA}")
        text = script.read_text(encoding="utf-8")
    except OSError as error:
        raise UserError(f"{script}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise UserError(f"{script}: cannot be read: {error}") from None
    if _NETWORK.match(text):
        raise UserError(f"{script}: found a network, expected the lines of a session; {_DATA}")
    yield from text.splitlines()


def _message(error: UserError | click.ClickException) -> str:
    return error.format_message() if isinstance(error, click.ClickException) else str(error)
