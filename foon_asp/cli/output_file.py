"""Files that a command writes, which are never those it reads."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import click

from foon_asp.cli.held import held
from foon_asp.errors import UserError
from foon_asp.text.data_folder import find_data

# The parameters of verbs that name what is written, and those that name data.
_WRITTEN = {"output", "file", "charts", "results", "results_file", "certificate_file"}
_DATA = ("folder", "network", "kitchen", "rates", "utensils", "goals", "unit_prices")


def check_outputs() -> None:
    """Raise :class:`UserError` if the current command would write a file that it reads.

    To be called before anything is solved, so that nobody waits an hour for this error.
    """
    parameters = click.get_current_context().params
    for name in _WRITTEN & parameters.keys():
        for file in _paths(parameters[name]):
            if any(same_file(file, other) for other in read_files()):
                raise UserError(f"{file}: is read by this command and is not overwritten; name another file")


def read_files() -> Iterator[Path]:
    """Give the files that the current command reads: those named, and those in a folder of data."""
    parameters = click.get_current_context().params
    here = held()
    if here is not None:
        yield from here.files
    for name, value in parameters.items():
        if name not in _WRITTEN:
            yield from _paths(value)
    data = {name: parameters.get(name) or None for name in _DATA}
    if "network" in parameters and any(data.values()):
        files = find_data(**(data | {"network": data["network"] or ()}))
        yield from files.network
        yield from filter(None, files[1:])


def same_file(file: Path, other: Path) -> bool:
    """Whether two names are those of one file, also through links; pipes and terminals do not count."""
    return file.is_file() and other.is_file() and file.samefile(other)


def _paths(value: object) -> Iterator[Path]:
    if isinstance(value, Path):
        yield value
    elif isinstance(value, tuple | Mapping):  # a mapping has its files as keys
        yield from (each for each in value if isinstance(each, Path))
