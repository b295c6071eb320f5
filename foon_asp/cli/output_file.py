"""Output files of a command, which must not be files that it reads."""

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import click

from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.shared_options import with_sources
from foon_asp.encoding.encoding_file import included_files
from foon_asp.errors import UserError
from foon_asp.rules.passed_constraint import LibraryUse, find_constraint
from foon_asp.text.data_folder import find_data, network_files

_DATA_OPTIONS = ("kitchen", "rates", "utensils", "goals", "unit_prices", "unit_amounts")
_STDIN = Path("/dev/stdin")  # may be a file: foon-asp lint - < recipe.txt


def check_outputs(read: Iterable[Path] = (), written: Iterable[Path] | None = None) -> None:
    """Raise :class:`UserError` if the current command would write a file that it reads, or one file twice.

    ``read`` are inputs that its parameters do not name, such as the files of a folder, and ``written`` its
    outputs, if the parameters do not name them. The check runs before a search, which may take an hour.
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
    """Return the files that the current command reads: named files, and the files of folders."""
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
        files = find_data(folder, network, **{name: context.params[name] for name in _DATA_OPTIONS})
        yield from files.network
        yield from filter(None, files[1:])
    yield _STDIN


def _written(context: click.Context) -> list[click.Parameter]:
    return [parameter for parameter in context.command.params if isinstance(parameter.type, WrittenPath)]


def _outputs() -> Iterator[Path]:
    """Return the output files that the parameters of the current command name."""
    context = click.get_current_context()
    for parameter in _written(context):
        for path in _paths(context.params[str(parameter.name)]):
            if parameter.name == "folder_written":
                from foon_asp.questions.export import FILES

                yield from (path / name for name in FILES)
            elif str(path) != "-":
                yield path


def _paths(value: object) -> list[Path]:
    """Return the paths in the value of a parameter: a path, several, or the keys of a mapping."""
    values = value if isinstance(value, tuple | Mapping) else (value,)
    return [
        item.file if isinstance(item, LibraryUse) else item
        for item in values
        if isinstance(item, Path | LibraryUse)
    ]


def _files(path: Path) -> Iterator[Path]:
    """Yield the files read for a path: files of a folder, a file with includes, a ready-made constraint."""
    with contextlib.suppress(UserError, OSError):  # reported when it is read
        if path.is_dir():
            for encoding in path.glob("*.lp"):
                yield from _files(encoding)
            yield from network_files(path)
            return
        file = path if path.exists() else find_constraint(path)
        assert isinstance(file, Path)
        yield file
        if file.suffix == ".lp":
            yield from included_files(file)
        elif file.suffix == ".pddl":  # a problem may have its domain in its folder
            yield from file.parent.glob("*domain*.pddl")


def _same_file(file: Path, other: Path) -> bool:
    """Return whether two paths are one regular file, also through links."""
    return file.is_file() and other.is_file() and file.samefile(other)


def _same_output(file: Path, other: Path) -> bool:
    """Return whether two paths are one file, which need not exist."""
    return _same_file(file, other) or file.resolve() == other.resolve()
