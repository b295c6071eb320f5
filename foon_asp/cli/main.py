"""``foon-asp``: the verbs, and the exit code of every ending."""

import contextlib
import os
import sys
import traceback

import click

from foon_asp import __version__
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import drop_output, safe_streams, say_remarks
from foon_asp.cli.verbs import GROUPS, VERBS, verb_command
from foon_asp.cli.whole_process import BEGAN, keep, leave
from foon_asp.deadline import LimitError, none_lost
from foon_asp.errors import UserError
from foon_asp.escapes import escaped, note_line_end


class _Verbs(click.Group):
    """Imports a verb's module only when that verb is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        return verb_command(cmd_name) if cmd_name in VERBS else None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        word = args[0]
        if word not in VERBS and not word.startswith("-"):
            from difflib import get_close_matches

            near = get_close_matches(word.lower().replace("_", "-"), VERBS, n=1)
            hint = f"did you mean {near[0]!r}?" if near else "foon-asp -h lists the verbs"
            ctx.fail(f"there is no verb {word!r}; {hint}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        for group in GROUPS:
            with formatter.section(group):
                formatter.write_dl([(verb, each.line) for verb, each in VERBS.items() if each.group == group])


@click.group(cls=_Verbs, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="foon-asp")
def cli() -> None:
    """Provably optimal task trees for FOON, by answer set programming.

    Every verb reads the bundled kitchen unless --data or --network names another.
    """


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit with the documented code."""
    words = sys.argv[1:] if arguments is None else arguments
    with safe_streams(), none_lost():
        for word in words:
            note_line_end(word)
            note_line_end(word.partition("=")[2])
        say_remarks("--quiet" not in words[: words.index("--") if "--" in words else None])
        code = _run(words, BEGAN if arguments is None else None)
        try:
            sys.stdout.flush()
        except (OSError, UserError) as error:
            code = _ended(error, debug=False)
        if code is not ExitCode.DONE:
            drop_output()
    if arguments is None:
        leave(int(code))
    sys.exit(int(code))


def _run(words: list[str], began: float | None) -> ExitCode:
    """Run a verb; report what went wrong, and give the exit code.

    Its limits count from when it ``began``, or from when they are made.
    """
    try:
        ended = cli.main(args=words, prog_name="foon-asp", standalone_mode=False, obj=began)
        return ExitCode(ended or 0)
    except Exception as error:
        return _ended(error, "--debug" in words)
    except KeyboardInterrupt as error:
        return _ended(error, debug=False)


def _ended(error: BaseException, debug: bool) -> ExitCode:
    """Report on stderr how a command ended, and give its exit code."""
    keep(error)  # with all that was at hand where it was raised
    say_remarks(True)
    if debug and not isinstance(error, click.ClickException | click.Abort | KeyboardInterrupt):
        traceback.print_exception(error)
    if isinstance(error, BrokenPipeError):  # the reader of our output went away, as `head` does
        drop_output()
        return ExitCode.DONE
    code = ExitCode.USAGE
    if isinstance(error, click.ClickException):
        text = _usage(error)
    elif isinstance(error, click.Abort | KeyboardInterrupt):
        limit = error.__cause__ if isinstance(error, click.Abort) else error
        text, code = "interrupted before there was an answer", ExitCode.LIMIT
        if isinstance(limit, LimitError):
            text = (
                f"unknown: stopped at {limit.stopped}, before there was an answer\nwhat to do: {limit.advice}"
            )
    elif isinstance(error, MemoryError):
        text, code = "unknown: out of memory; --memory-limit stops before that", ExitCode.LIMIT
    elif isinstance(error, UserError):
        text = str(error) if ": error: " in str(error) else f"error: {error}"
    elif isinstance(error, OSError):  # the world's: a full disk, no permission, a folder in place of a file
        name = "" if error.filename is None else f"{escaped(os.fsdecode(error.filename))}: "
        text = f"error: {name}{error.strerror or error}"
    else:
        code = ExitCode.BUG
        text = (
            f"foon-asp has a bug: {type(error).__name__}: {error}\n"
            "please report it with the command and its input; --debug shows where it happened"
        )
    with contextlib.suppress(OSError, UserError):  # nobody to say it to
        click.echo(text, err=True)
    return code


def _usage(error: click.ClickException) -> str:
    """Give click's complaint about a command, with the words quoted; without a verb, the help."""
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        return error.format_message()
    lines = []
    if isinstance(error, click.UsageError) and error.ctx is not None:
        lines = [error.ctx.get_usage()]
        if error.ctx.command.get_help_option(error.ctx) is not None:
            lines.append(f"Try '{error.ctx.command_path} {error.ctx.help_option_names[0]}' for help.\n")
    message = error.format_message()
    if isinstance(error, click.MissingParameter):  # lists choices in lines, and quotes no word of the user
        message = " ".join(message.split())
    return "\n".join([*lines, f"Error: {escaped(message)}"])
