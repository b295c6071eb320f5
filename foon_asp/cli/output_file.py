"""Output files of a command, which must not be files that it reads."""

import contextlib
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import click

from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.shared_options import folder_and_networks
from foon_asp.encoding.encoding_file import included_files
from foon_asp.errors import UserError
from foon_asp.rules.passed_constraint import LibraryUse, find_constraint
from foon_asp.text.data_folder import find_data, network_files

_DATA_OPTIONS = ("kitchen", "rates", "utensils", "goals", "unit_prices", "unit_amounts")
_STDIN = Path("/dev/stdin")  # may be a file: foon-asp lint - < recipe.txt


def check_outputs(further_inputs: Iterable[Path] = (), written: Iterable[Path] | None = None) -> None:
    """Raise :class:`UserError` if the current command would write a file that it reads, or one file twice.

    ``further_inputs`` are inputs that no parameter of the command names. ``written`` are the outputs; by
    default, the parameters name them. The check runs before a search, which may take an hour.
    """
    outputs = [*(_output_files() if written is None else written)]
    if not outputs:
        return
    inputs = [*read_files(), *further_inputs]
    for number, file in enumerate(outputs):
        refuse_inputs(file, inputs)
        if any(_same_output(file, other) for other in outputs[:number]):
            raise UserError(f"{file}: would be written twice by this command; name another file")


def refuse_inputs(file: Path, inputs: Iterable[Path]) -> None:
    """Raise :class:`UserError` if a file that is to be written is one of the inputs."""
    if any(_same_file(file, other) for other in inputs):
        raise UserError(f"{file}: is read by this command and is not overwritten; name another file")


def read_files() -> Iterator[Path]:
    """Yield the files that the current command reads: named files, files of folders, and data files.

    The bundled data are among them if the command names no data. Standard input is always one of them, since
    it may be a file.
    """
    context = click.get_current_context()
    written = {parameter.name for parameter in _output_parameters(context)}
    paths: list[Path] = []
    for name, value in context.params.items():
        if name not in written:
            paths += _paths_in(value)
    for path in paths:
        yield from _files_read_for(path)
    if "network" in context.params:
        sources = context.params.get("sources", ())
        folder, network = folder_and_networks(sources, context.params["folder"], context.params["network"])
        files = find_data(folder, network, **{name: context.params[name] for name in _DATA_OPTIONS})
        yield from files.network
        yield from filter(None, files[1:])
    yield _STDIN


def _output_parameters(context: click.Context) -> list[click.Parameter]:
    """Return the parameters of the current command that name an output."""
    return [parameter for parameter in context.command.params if isinstance(parameter.type, WrittenPath)]


def _output_files() -> Iterator[Path]:
    """Yield the output files that the parameters of the current command name; ``-`` is no file.

    For an output folder of ``export``, these are the files to be written into it.
    """
    context = click.get_current_context()
    for parameter in _output_parameters(context):
        for path in _paths_in(context.params[str(parameter.name)]):
            if parameter.name == "folder_written":
                from foon_asp.questions.export import FILES

                yield from (path / name for name in FILES)
            elif str(path) != "-":
                yield path


def _paths_in(value: object) -> list[Path]:
    """Return the paths in the value of a parameter: a path, several paths, or the keys of a mapping.

    A ready-made constraint counts as its file.
    """
    values = value if isinstance(value, tuple | Mapping) else (value,)
    return [
        item.file if isinstance(item, LibraryUse) else item
        for item in values
        if isinstance(item, Path | LibraryUse)
    ]


def _files_read_for(path: Path) -> Iterator[Path]:
    """Yield the files read for a path that a parameter names.

    - For a folder: its encodings, the files that they include, and its networks.
    - For an encoding: the file, and the files that it includes.
    - For a problem in PDDL: the file, and the domains in its folder.
    - For a ready-made constraint: its file, and the files that it includes.

    For any other file, yield the file; for a path that cannot be read, nothing.
    """
    with contextlib.suppress(UserError, OSError):  # reported when it is read
        if path.is_dir():
            for encoding in path.glob("*.lp"):
                yield from _files_read_for(encoding)
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
    """Whether two paths are one regular file that exists, also through links."""
    return file.is_file() and other.is_file() and file.samefile(other)


def _same_output(file: Path, other: Path) -> bool:
    """Whether two paths name one file, which need not exist yet."""
    return _same_file(file, other) or file.resolve() == other.resolve()
