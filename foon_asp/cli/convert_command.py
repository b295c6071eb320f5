"""``foon-asp convert``: FOON files in another dialect, with a report of losses."""

from collections import Counter
from pathlib import Path
from typing import NamedTuple

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.output import write_data
from foon_asp.cli.output_file import check_outputs
from foon_asp.errors import UserError
from foon_asp.text.conversion import Converted, Converter
from foon_asp.text.diagnostics import Diagnostic, InputError, summarize
from foon_asp.text.folder_files import FolderFile, foon_files
from foon_asp.text.format import Dialect
from foon_asp.text.formats import format_of, format_with
from foon_asp.text.plain_file import read_plain_text
from foon_asp.whole_file import utf_8, write_whole


class _Task(NamedTuple):
    """A file to convert.

    ``to``: the path of the result; ``None`` for stdout.
    """

    file: Path
    to: Path | None


@click.command("convert")
@shared_options.files_argument
@click.option(
    "--to",
    "target",
    required=True,
    type=click.Choice([str(dialect) for dialect in Dialect]),
    help="The dialect to write.",
)
@shared_options.output_option(
    "FILE|DIR", "Where to write one file (stdout, if not given), or a folder for several."
)
@shared_options.lenient_option
@shared_options.debug_option
def command(paths: tuple[Path, ...], target: str, output: Path | None, lenient: bool) -> ExitCode:
    """Write FOON files in another dialect, and list what gets lost.

    \b
    foon-asp convert recipe.txt --to json               print one file in another dialect
    foon-asp convert recipe.txt --to plain -o out.txt   or write it
    foon-asp convert recipes/ --to ids -o numbered/     convert all files of a folder
    foon-asp convert kitchen.json --to plain            kitchens and goals, too

    \b
    plain       O→onion           M→chop                 names only, as in a universal FOON
    no-ids      O→onion→1         M→chop→<0:14,0:20>     motion flags and times
    ids         O294→onion→1      M12→chop→0:14→0:20     ids, flags and times in two fields
    json        {"functional_units": [{"input_nodes": [{"object_id": 294, "object_label": "onion", ...
    json-list   [{"input_nodes": [{"label": "onion", "states": [], ...}], "motion_node": "chop", ...
    neutral     {"id": "chop", "inputs": ["onion"], "outputs": ["onion; chopped"]}       a unit a line

    The dialect of the input is detected. From text to text, comments, blank lines and the order of lines
    stay. ids keeps the ids that are there and numbers what has none: objects by label, states by word,
    motions by label, the same in all files of one call. What the target cannot hold is listed on stderr, each
    kind with its number and its first place; everything else can be read back from the result.
    docs/formats.md has the dialects in full.

    Exits with 0 when all files are written; with 2, and nothing written, when something is not understood or
    a name would mean something else in the target.
    """
    dialect = Dialect(target)
    tasks = _tasks(foon_files(paths), any(path.is_dir() for path in paths), output, dialect)
    check_outputs((task.file for task in tasks), [task.to for task in tasks if task.to is not None])
    texts: list[str] = []
    errors: list[Diagnostic] = []
    converter = Converter(dialect, lenient)
    for task in tasks:
        try:
            texts.append(read_plain_text(task.file))
            converter.learn(texts[-1])
        except InputError as error:
            errors += error.diagnostics
            texts.append("")
    results: list[Converted] = []
    for task, text in zip(tasks, texts, strict=True):
        try:
            results.append(converter.convert(text, str(task.file)))
        except InputError as error:
            errors += error.diagnostics
    if errors:
        raise InputError(errors)
    for warning in summarize(converter.diagnostics):
        click.echo(warning, err=True)
    contents = [utf_8(result.text) for result in results]  # errors of any come before the first is written
    for task, content in zip(tasks, contents, strict=True):
        if task.to is None:
            write_data(content)
        else:
            _make_folder(task.to.parent)
            write_whole(task.to, content)
    click.echo(_summary(tasks, results, dialect, converter.left_out), err=True)
    return ExitCode.DONE


def _make_folder(folder: Path) -> None:
    """Create a folder and its parents, unless it exists; raises :class:`UserError` if that fails."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(f"{folder}: cannot be created as a folder: {error.strerror or error}") from None


def _tasks(files: list[FolderFile], is_folder: bool, output: Path | None, target: Dialect) -> list[_Task]:
    """Return a task for each file: where its conversion is written to.

    ``is_folder`` says that a folder is converted. ``output`` is the value of ``--output``. For a single file,
    it is the file to write, or an existing folder to write into. Otherwise, it is a folder, which may be new.
    Raises :class:`UserError` for several files without an output folder, and for two files that would be
    written to one path.
    """
    if len(files) == 1 and not is_folder:
        file = files[0].file
        if output is None or str(output) == "-":
            return [_Task(file, None)]
        name = file.with_suffix(_suffix(file, target)).name
        return [_Task(file, output / name if output.is_dir() else output)]
    if output is None or str(output) == "-":
        raise UserError(f"{len(files)} files need a folder: name one with -o")
    if output.exists() and not output.is_dir():
        raise UserError(f"{output}: expected a folder for {len(files)} files, found a file")
    tasks = [_Task(file, output / relative.with_suffix(_suffix(file, target))) for file, relative in files]
    sources: dict[Path | None, Path] = {}
    for file, to in tasks:
        resolved = None if to is None else to.resolve()
        if resolved in sources:
            raise UserError(f"{sources[resolved]} and {file} would both be written to {to}")
        sources[resolved] = file
    return tasks


def _suffix(file: Path, target: Dialect) -> str:
    """Return the ending of the name of a converted file; for a list of objects, it may be a special one."""
    text, format_ = read_plain_text(file), format_with(target)
    return format_.list_suffix if format_of(text, str(file)).lists_objects(text) else format_.suffix


def _summary(tasks: list[_Task], results: list[Converted], target: Dialect, left_out: int) -> str:
    """Return a summary in words: the dialects, and the losses, the most frequent first.

    ``left_out`` is the number of lines that belong to no unit.
    """
    dialects = Counter(result.dialect for result in results)
    if len(tasks) == 1:
        first_line = f"{tasks[0].file}: {results[0].dialect} → {target}"
    else:
        dialect_counts = ", ".join(f"{count} {dialect}" for dialect, count in dialects.items())
        first_line = f"{len(tasks)} files ({dialect_counts}) → {target}"
    losses = [(kind, lost) for result in results for kind, lost in result.lost.items()]
    counted_losses = []
    for kind in dict.fromkeys(kind for kind, _ in losses):
        losses_of_kind = [lost for lost_kind, lost in losses if lost_kind is kind]
        count = sum(lost.occurrences for lost in losses_of_kind)
        counted_losses.append((count, f"{kind}; first at {losses_of_kind[0].first}"))
    if left_out:
        counted_losses.append((left_out, "lines that are in no unit; see the warnings"))
    if not counted_losses:
        return f"{first_line}; nothing is lost"
    counted_losses.sort(key=lambda loss: -loss[0])
    width = len(f"{counted_losses[0][0]:,}")
    lines = (f"  {count:>{width},}  {text}" for count, text in counted_losses)
    return "\n".join([f"{first_line}; not in the result:", *lines])
