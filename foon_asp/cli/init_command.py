"""``foon-asp init``: a new data folder, with comments, to be edited."""

import shlex
from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.network import starting_nodes
from foon_asp.resources import starter_recipe
from foon_asp.text.clip_times import median_clips
from foon_asp.text.data_folder import Data, DataFiles, network_files, read_data
from foon_asp.text.diagnostics import summarize
from foon_asp.text.formats import TEXT, format_of
from foon_asp.text.plain_file import is_store, read_plain_text
from foon_asp.text.starter import RATES_FILE, starter_files
from foon_asp.text.tables import RATES, Duration, duration_template
from foon_asp.text.writer import write_units
from foon_asp.whole_file import utf_8, write_whole


@click.command("init")
@click.argument("folder", type=click.Path(path_type=NamedPath), metavar="DIR")
@click.option(
    "--from",
    "recipe",
    type=click.Path(path_type=NamedPath),
    metavar="RECIPE",
    help="Your recipe, FOON text or JSON; without one, a small recipe shows how they are written.",
)
@click.option("--rates", is_flag=True, help="Only write the success rates, to be filled in.")
@click.option(
    "--durations",
    is_flag=True,
    help="Only write how long motions take, to be filled in; from the times of the recipe, if it has some.",
)
@shared_options.debug_option
def command(folder: Path, recipe: Path | None, rates: bool, durations: bool) -> ExitCode:
    """Write a data folder to start from: a recipe, a kitchen, success rates, utensils and goals.

    \b
    foon-asp init my_foon                       a small recipe, to be replaced by yours
    foon-asp init my_foon --from recipe.txt     your recipe
    foon-asp init my_foon --from recipe.txt --rates --durations
    foon-asp solve --all-goals --data my_foon

    Every file says in comments what it is for and how its lines are written. The kitchen has what makes
    the units of the recipe run, the rates have every motion, and the goals are those marked in the recipe, or
    what its last unit makes. Where one of the files exists already, nothing is written. With --rates or
    --durations, these files alone are written, with the motions of the recipe.
    """
    data, source = _read_recipe(recipe)
    files = _starter_texts(data, source, recipe)
    if rates or durations:
        files = {RATES_FILE: files[RATES_FILE]} if rates else {}
        if durations:
            clips = median_clips(network_files(source))
            motions = sorted(dict.fromkeys(data.network.motions))
            durations_known = {
                motion: Duration(clips[motion]) if motion in clips else None for motion in motions
            }
            files["durations.txt"] = duration_template(durations_known)
    for name in files:
        if (folder / name).exists():
            raise UserError(f"{folder / name} already exists: name another folder, or remove it first")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(f"{folder}: cannot be created: {error.strerror or error}") from None
    for name, text in files.items():
        write_whole(folder / name, utf_8(text))
        click.echo(f"wrote {folder / name}")
    name = shlex.quote(escaped(str(folder)))
    if durations:
        click.echo(f"fill it in, and ask: foon-asp schedule PLAN --durations {name}/durations.txt")
    elif not rates:
        click.echo(f"edit them, and ask: foon-asp solve --all-goals --data {name}")
    if recipe is not None and not (rates or durations):
        click.echo(f"check the recipe: foon-asp lint {name}")
    return ExitCode.DONE


def _read_recipe(recipe: Path | None) -> tuple[Data, Path]:
    """Read a recipe, by default the bundled one; return its data and its path.

    Warnings are printed. Raises :class:`UserError` for a store, and for a recipe without a unit.
    """
    source = recipe or starter_recipe() / "FOON.txt"
    if is_store(source):
        raise UserError(f"{source}: expected a recipe, FOON text or JSON, found a store")
    data = read_data(DataFiles(tuple(network_files(source))))
    if not len(data.network):
        raise UserError(f"{source}: there is no functional unit in it, so it is no recipe")
    for remark in summarize(data.warnings):
        click.echo(remark, err=True)
    return data, source


def _starter_texts(data: Data, source: Path, recipe: Path | None) -> dict[str, str]:
    """Return the texts of all files of a new data folder, by name.

    A recipe in FOON text is put into canonical form. A folder or another format is written as FOON text.
    ``source`` is the path of the recipe. ``recipe`` is the same path, or ``None`` for the bundled recipe,
    which comes with success rates.
    """
    network = data.network
    text = "" if source.is_dir() else read_plain_text(source)
    recipe_text = write_units(map(network.unit, range(len(network))), (), data.amounts.units)
    if text and format_of(text, str(source)) is TEXT:
        recipe_text = TEXT.canonical_text(text, str(source))
    rates = None if recipe else RATES.read(starter_recipe() / "motion.txt")
    goals = [network.objects[o] for entry in data.goals for o in network.find(entry.pattern)]
    kitchen = starting_nodes(network, [o for entry in data.goals for o in network.find(entry.pattern)])
    return starter_files(recipe_text, network, kitchen, goals, rates)
