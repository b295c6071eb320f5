"""``foon-asp encodings``: where the answer-set programs are, and a copy of them to edit."""

import shlex
import shutil
from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.resources import encodings_folder


@click.command("encodings")
@click.option(
    "--copy",
    type=click.Path(path_type=NamedPath),
    metavar="DIR",
    help="Copy them into a new folder, to edit them or to run clingo there.",
)
@shared_options.debug_option
def command(copy: Path | None) -> ExitCode:
    """Print the folder of the answer-set programs; README.md there explains every predicate.

    \b
    foon-asp encodings --copy mine              a copy to edit
    foon-asp solve --goal ice --encodings mine  solve with it

    The copy is for bare clingo, too:

    \b
    foon-asp encodings --copy encodings
    foon-asp facts --goal ice > facts.lp
    python -m clingo encodings/task_tree.lp encodings/objectives.lp encodings/show.lp facts.lp
    """
    folder = encodings_folder()
    if copy is None:
        click.echo(folder)
        return ExitCode.DONE
    if copy.exists() and (not copy.is_dir() or any(copy.iterdir())):
        raise UserError(f"{copy} already exists: name a new folder, or an empty one")
    try:
        shutil.copytree(folder, copy, dirs_exist_ok=True, copy_function=shutil.copyfile)
    except (OSError, shutil.Error) as error:
        raise UserError(f"{copy}: cannot be written: {error}") from None
    count = sum(1 for _ in copy.rglob("*.lp"))
    click.echo(
        f"wrote {copy}: {count} programs; solve with them: --encodings {shlex.quote(escaped(str(copy)))}"
    )
    return ExitCode.DONE
