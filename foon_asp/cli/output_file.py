"""Files that a command writes, which are never those it reads."""

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import click

from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.options import with_sources
from foon_asp.encoding.encoding_file import included_files
from foon_asp.errors import UserError
from foon_asp.rules.constraint import LibraryUse, find_constraint
from foon_asp.text.data_folder import find_data, network_files

_DATA = ("kitchen", "rates", "utensils", "goals", "unit_prices")
_STDIN = Path("/dev/stdin")  # which may be a file: foon-asp lint - < recipe.txt


def check_outputs(read: Iterable[Path] = (), written: Iterable[Path] | None = None) -> None:
    """Raise :class:`UserError` if the current command would write a file that it reads, or one file twice.

    ``read`` are files that its parameters do not name, such as those of a folder, and ``written`` what is
    written in place of what they name. To be called before anything is solved, so that nobody waits an hour
    for this error.
    """
    outputs = [*(_outputs() if written is None else written)]
    if not outputs:
        return
    inputs = [*read_files(), *read]
    for number, file in enumerate(outputs):
        refuse_inputs(file, inputs)
        if any(_same_output(file, other) for other in outputs[:number]):
            raise UserError(f"{file}: would be written twice by this command; name another file")


def refuse_inputs(file: Path, inputs: Iterable[Path]) -> None:
    """Raise :class:`UserError` if a file that is to be written is one of the inputs."""
    if any(_same_file(file, other) for other in inputs):
        raise UserError(f"{file}: is read by this command and is not overwritten; name another file")


def read_files() -> Iterator[Path]:
    """Return the files that the current command reads: those named, and those that they stand for."""
    context = click.get_current_context()
    written = {parameter.name for parameter in _written(context)}
    named: list[Path] = []
    for name, value in context.params.items():
        if name not in written:
            named += _paths(value)
    for path in named:
        yield from _files(path)
    if "network" in context.params:
        sources = context.params.get("sources", ())
        folder, network = with_sources(sources, context.params["folder"], context.params["network"])
        files = find_data(folder, network, **{name: context.params[name] for name in _DATA})
        yield from files.network
        yield from filter(None, files[1:])
    yield _STDIN


def _written(context: click.Context) -> list[click.Parameter]:
    return [each for each in context.command.params if isinstance(each.type, WrittenPath)]


def _outputs() -> Iterator[Path]:
    """Return the files that the parameters of the current command name to be written."""
    context = click.get_current_context()
    for parameter in _written(context):
        for path in _paths(context.params[str(parameter.name)]):
            if parameter.name == "folder_written":
                from foon_asp.questions.export import FILES

                yield from (path / name for name in FILES)
            elif str(path) != "-":
                yield path


def _paths(value: object) -> list[Path]:
    """Return the paths that the value of a parameter has; a mapping has them as keys."""
    values = value if isinstance(value, tuple | Mapping) else (value,)
    return [
        each.file if isinstance(each, LibraryUse) else each
        for each in values
        if isinstance(each, Path | LibraryUse)
    ]


def _files(path: Path) -> Iterator[Path]:
    """Return what is read where a path is named, which may be that of a folder or a ready-made constraint."""
    with contextlib.suppress(UserError, OSError):  # told where it is read
        if path.is_dir():
            for encoding in path.glob("*.lp"):
                yield from _files(encoding)
            yield from network_files(path)
            return
        found = path if path.exists() else find_constraint(path)
        assert isinstance(found, Path)
        yield found
        if found.suffix == ".lp":
            yield from included_files(found)
        elif found.suffix == ".pddl":  # of a problem, the domain beside it is read
            yield from found.parent.glob("*domain*.pddl")


def _same_file(file: Path, other: Path) -> bool:
    """Whether two names are those of one file, also through links; pipes and terminals do not count."""
    return file.is_file() and other.is_file() and file.samefile(other)


def _same_output(file: Path, other: Path) -> bool:
    """Whether two names are those of one file, which need not be there yet."""
    return _same_file(file, other) or file.resolve() == other.resolve()
