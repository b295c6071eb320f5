"""``foon-asp``: the group of all verbs, and the exit code and the message of every error."""

import contextlib
import os
import sys
import traceback
import warnings
from typing import TYPE_CHECKING

import click

from foon_asp import __version__
from foon_asp.cli.early_exit import end_at_ctrl_c, raise_at_ctrl_c
from foon_asp.cli.exit_code import ExitCode, code_and_message
from foon_asp.cli.output import flush_or_drop_output, safe_streams, show_remarks
from foon_asp.cli.verbs import FIRST_VERBS, FOR_PROGRAMS, SHELL_REQUEST, VERBS, verb_command, write_verbs
from foon_asp.cli.whole_process import BEGAN, exit_process, keep_until_exit
from foon_asp.deadline import resend_lost_interrupts
from foon_asp.errors import FoonWarning, UserError

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_REPLACEMENTS = {  # advice for names of verbs that no longer exist
    "certify": "type: foon-asp solve --certificate FILE, or foon-asp check TREE --certificate FILE",
    "diff-network": "type: foon-asp diff A B (two networks, too)",
    "clash": "type: foon-asp why-not --constraint A.lp --constraint B.lp (which clash, and what to drop)",
    "optima": "type: foon-asp solve --all-goals --objective units --objective success",
    "draw": "type: foon-asp view -o FILE.svg (or .png .pdf .dot .mmd .graphml)",
    "menu": "type: foon-asp solve --goal A --goal B (what each costs alone, and what they share)",
    "search": "type: foon-asp compare --search NAME --trees",
    "shell": "ask with a command for each question, or in Python, where vary changes it",
    "vocabulary": "type: foon-asp lint --learn FILES -o names.txt",
    "import": "type: foon-asp merge FILES --store NAME.foon",
    "units": "type: foon-asp stats --units",
}


class _Verbs(click.Group):
    """The group of all verbs, which imports the module of a verb only when the verb is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return all verbs."""
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import and return the command of a verb; return ``None`` for an unknown verb.

        After this call, ctrl-C raises an exception.
        """
        command = verb_command(cmd_name) if cmd_name in VERBS else None
        raise_at_ctrl_c()  # after all imports
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Find the command of a verb; for an unknown verb, fail with a hint.

        The hint says what replaces a verb that no longer exists, or else names the most similar verb.
        """
        word = args[0]
        if word not in VERBS and not word.startswith("-") and not ctx.resilient_parsing:
            from difflib import get_close_matches

            similar = get_close_matches(word.lower().replace("_", "-"), VERBS, n=1)
            hint = f"did you mean {similar[0]!r}?" if similar else "foon-asp help lists the verbs"
            hint = _REPLACEMENTS.get(word, hint)
            ctx.fail(f"there is no verb {word!r}; {hint}")
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write only the verbs that most people need into the help."""
        write_verbs(formatter, "Verbs that most people need", FIRST_VERBS)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> "list[CompletionItem[str]]":
        """Return completions: verbs that are not for programs, and the options of ``foon-asp`` itself."""
        from click.shell_completion import CompletionItem

        verbs = [verb for verb, entry in VERBS.items() if entry.group != FOR_PROGRAMS]
        items = [CompletionItem(verb) for verb in verbs if verb.startswith(incomplete)]
        return items + click.Command.shell_complete(self, ctx, incomplete)


@click.group(
    cls=_Verbs,
    subcommand_metavar="VERB [ARGS]...",
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="'foon-asp help' lists all verbs, and 'foon-asp help VERB' explains one.",
)
@click.version_option(__version__, prog_name="foon-asp")
def cli() -> None:
    """Provably optimal task trees for FOON, by answer set programming.

    The bundled kitchen is read only where no recipe, folder or store is named: a verb that got such a file
    never falls back to it.
    """


def main(arguments: list[str] | None = None) -> None:
    """Run a command line, and exit the process with its exit code.

    ``arguments`` are the words after ``foon-asp``; ``None`` takes them from the process. Only in that case,
    limits count from the start of the process, and its memory is not freed at exit. Output is escaped by
    :func:`safe_streams`. With ``--quiet``, only errors are written to stderr.
    """
    words = sys.argv[1:] if arguments is None else arguments
    with safe_streams(), resend_lost_interrupts(), warnings.catch_warnings():
        warnings.simplefilter("always", FoonWarning)
        warnings.showwarning = _show_warning
        show_remarks("--quiet" not in words[: words.index("--") if "--" in words else None])
        code = _run(words, BEGAN if arguments is None else None)
        try:
            sys.stdout.flush()
        except (OSError, UserError) as error:
            code = _report_error(error, debug=False)
        if code is not ExitCode.DONE:
            flush_or_drop_output()
    if arguments is None:
        exit_process(int(code))
    sys.exit(int(code))


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    """Print the message of a warning on stderr, without its place in the code."""
    click.echo(f"warning: {message}", err=True)


def _run(words: list[str], began: float | None) -> ExitCode:
    """Run a verb, or answer a shell that asks for completions; return the exit code.

    An error is reported on stderr. ``began`` is the time of the monotonic clock from which limits count. If
    it is ``None``, they count from now. Otherwise, ctrl-C exits the process at once after the verb.
    """
    try:
        try:
            if SHELL_REQUEST in os.environ:
                from foon_asp.cli.completion_command import answer_shell

                return answer_shell(cli, os.environ[SHELL_REQUEST])
            code = cli.main(args=words, prog_name="foon-asp", standalone_mode=False, obj=began)
            return ExitCode(code or 0)
        finally:
            if began is not None:
                end_at_ctrl_c()
    except Exception as error:
        return _report_error(error, "--debug" in words)
    except KeyboardInterrupt as error:
        return _report_error(error, debug=False)


def _report_error(error: BaseException, debug: bool) -> ExitCode:
    """Report an error on stderr, also under ``--quiet``, and return its exit code.

    With ``debug``, its traceback is printed, too, unless the error is wrong usage or ctrl-C. A closed pipe is
    no error: the remaining output is discarded, and the code is ``DONE``.
    """
    keep_until_exit(error)  # with the frames of its traceback, whose memory would take long to free
    show_remarks(True)
    if debug and not isinstance(error, click.ClickException | click.Abort | KeyboardInterrupt):
        traceback.print_exception(error)
    if isinstance(error, BrokenPipeError):  # the reader of our output has ended, as `head` does
        flush_or_drop_output()
        return ExitCode.DONE
    ignored_output_errors = contextlib.suppress(OSError, UserError)
    if isinstance(error, click.ClickException):
        with ignored_output_errors:
            error.show(sys.stderr)
        return ExitCode.USAGE
    code, text = code_and_message(error)
    with ignored_output_errors:
        click.echo(text, err=True)
    return code
