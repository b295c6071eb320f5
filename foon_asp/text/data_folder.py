"""A folder of FOON data and the pieces it is made of."""

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import Network
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.label_list import read_labels
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.rate_table import read_rates
from foon_asp.text.reader import FoonReader

_KITCHEN, _RATES, _UTENSILS, _GOALS = "kitchen.json", "motion.txt", "utensils.txt", "goal_nodes.json"


class DataFiles(NamedTuple):
    """Where each piece is read from; ``None`` where there is none."""

    network: tuple[Path, ...]
    kitchen: Path | None = None
    rates: Path | None = None
    utensils: Path | None = None
    goals: Path | None = None


class Data(NamedTuple):
    """Everything read: the merged network and what stands beside it.

    ``kitchen`` are object node ids. ``rates`` is ``None`` where there is no rates file.
    ``warnings`` lists what was assumed while reading; ``left_out`` counts the lines dropped.
    """

    network: Network
    kitchen: frozenset[int]
    goals: tuple[ListedObject, ...]
    rates: dict[str, Fraction] | None
    utensils: frozenset[str]
    warnings: tuple[Diagnostic, ...]
    left_out: int


def find_data(
    folder: Path | None,
    network: Sequence[Path] = (),
    kitchen: Path | None = None,
    rates: Path | None = None,
    utensils: Path | None = None,
    goals: Path | None = None,
) -> DataFiles:
    """Find the files of a question: the pieces given on their own, and the folder's for all others.

    A folder has its network in ``FOON.txt`` or else in its other ``*.txt`` files, and may have
    ``kitchen.json``, ``motion.txt``, ``utensils.txt`` and ``goal_nodes.json``. Raises
    :class:`UserError` where something named does not exist.
    """
    for path in (folder, kitchen, rates, utensils, goals, *network):
        if path is not None and not path.exists():
            raise UserError(f"{path}: no such file or folder")
    if folder is not None and not folder.is_dir():
        raise UserError(f"{folder}: expected a folder; a single network is given with --network")
    sources = network or ([folder] if folder else [])
    files = tuple(file for source in sources for file in network_files(source))
    if not files:
        raise UserError("no network is given")

    def beside(given: Path | None, name: str) -> Path | None:
        if given is None and folder is not None and (folder / name).exists():
            return folder / name
        return given

    return DataFiles(
        files,
        beside(kitchen, _KITCHEN),
        beside(rates, _RATES),
        beside(utensils, _UTENSILS),
        beside(goals, _GOALS),
    )


def network_files(path: Path) -> list[Path]:
    """Give the network files that a path stands for: itself, or those of a folder in order of name."""
    if not path.is_dir():
        return [path]
    if (path / "FOON.txt").is_file():
        return [path / "FOON.txt"]
    files = sorted(file for file in path.glob("*.txt") if file.name not in {_RATES, _UTENSILS})
    if not files:
        raise UserError(f"{path}: expected a folder with FOON.txt or other networks (*.txt), found none")
    return files


def read_data(files: DataFiles, lenient: bool = False) -> Data:
    """Read all pieces; raises :class:`InputError` for input that is not understood.

    With ``lenient`` the lines of a network that are not understood are left out with a warning.
    """
    reader = FoonReader(lenient)
    network = reader.read_network(files.network)
    warnings = reader.diagnostics
    kitchen: set[int] = set()
    for item in read_object_list(files.kitchen, warnings) if files.kitchen else ():
        found = network.find(item.pattern)
        kitchen.update(found)
        if not found:
            message = f"the kitchen item {str(item.pattern)!r} matches no object node of the network"
            warnings.append(Diagnostic(Severity.WARNING, "kitchen-item", message, item.source))
    goals = tuple(read_object_list(files.goals, warnings)) if files.goals else ()
    return Data(
        network,
        frozenset(kitchen),
        goals,
        read_rates(files.rates) if files.rates else None,
        read_labels(files.utensils) if files.utensils else frozenset(),
        tuple(warnings),
        reader.left_out,
    )
