"""``foon-asp``: the verbs, and how every ending becomes an exit code."""

import gc
import os
import sys
import traceback

import click

from foon_asp import __version__
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.verbs import VERBS, verb_command
from foon_asp.errors import UserError


class _Verbs(click.Group):
    """Imports a verb's module only when that verb is asked for."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(VERBS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        return verb_command(cmd_name) if cmd_name in VERBS else None


@click.group(cls=_Verbs, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="foon-asp")
def cli() -> None:
    """Provably optimal task trees for FOON, by answer set programming.

    Every verb reads the bundled kitchen unless --data or --network names another.
    """


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit with the documented code."""
    # Networks are many small objects that stay to the end: looking for garbage among them finds none.
    gc.set_threshold(100_000, 50, 50)
    words = sys.argv[1:] if arguments is None else arguments
    debug = "--debug" in words
    try:
        code = cli.main(args=words, prog_name="foon-asp", standalone_mode=False)
        sys.stdout.flush()
    except click.ClickException as error:
        error.show()
        code = ExitCode.USAGE
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted before there was an answer", err=True)
        code = ExitCode.LIMIT
    except UserError as error:
        if debug:
            traceback.print_exc()
        text = str(error)
        click.echo(text if ": error: " in text else f"error: {text}", err=True)
        code = ExitCode.USAGE
    except BrokenPipeError:  # the reader of our output went away, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = ExitCode.DONE
    except Exception as error:
        if debug:
            traceback.print_exc()
        click.echo(
            f"foon-asp has a bug: {type(error).__name__}: {error}\n"
            "please report it with the command and its input; --debug shows where it happened",
            err=True,
        )
        code = ExitCode.BUG
    sys.exit(int(code or 0))
