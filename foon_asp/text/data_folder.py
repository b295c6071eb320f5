"""Data folders: a network with its kitchen, goals, rates, prices and utensils."""

import re
from collections.abc import Iterable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.network import (
    NO_AMOUNTS,
    STARTING,
    DataAmounts,
    FunctionalUnit,
    Network,
    ObjectNode,
    Source,
    UnitPrices,
    is_starting,
    network_at_level,
    pattern_at_level,
    starting_kitchen,
)
from foon_asp.resources import bundled_kitchen
from foon_asp.text.assumed_goals import LAST, MARKED, goal_entry, last_goals
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.formats import NEUTRAL
from foon_asp.text.node_names import NodeNames
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.plain_file import NEUTRAL_SUFFIXES, read_beginning_text, read_content
from foon_asp.text.reader import FoonReader
from foon_asp.text.repeated_node import RepeatedNode
from foon_asp.text.stated_amounts import StatedAmounts, apply_amount_table
from foon_asp.text.stated_prices import StatedPrices
from foon_asp.text.tables import RATES, read_utensils
from foon_asp.text.unit_amount_list import UNIT_AMOUNTS
from foon_asp.text.unit_price_list import UnitPriceList, read_unit_prices

_RATES, _UTENSILS, _UNIT_PRICES = "motion.txt", "utensils.txt", "unit_prices.txt"
_UNIT_AMOUNTS, _STAND_INS = "unit_amounts.txt", "stand_ins.txt"
# In JSON or as FOON text, the first that exists.
_KITCHENS, _GOALS = ("kitchen.json", "kitchen.txt"), ("goal_nodes.json", "goal_nodes.txt")
_OBJECT_KEY = re.compile(rb'"(?:input_nodes|functional_units|object_label|label)"\s*:')
_FOR_SCHEDULES = {"durations.txt", "tools.txt"}
_TABLES = {_RATES, _UTENSILS, _UNIT_PRICES, _UNIT_AMOUNTS, _STAND_INS}
_SIDE_TABLES = {*_TABLES, *_KITCHENS, *_GOALS, *_FOR_SCHEDULES}


class DataFiles(NamedTuple):
    """The files of the network and of the data beside it; ``None`` for a file that does not exist.

    ``kitchen`` may be ``STARTING`` in place of a file. ``stand_ins`` is a table of items that replace others;
    only questions about stand-ins read it.
    """

    network: tuple[Path, ...]
    kitchen: Path | None = None
    rates: Path | None = None
    utensils: Path | None = None
    goals: Path | None = None
    unit_prices: Path | None = None
    unit_amounts: Path | None = None
    stand_ins: Path | None = None


class Data(NamedTuple):
    """All data read: the merged network and the data beside it.

    ``kitchen``: the ids of the nodes that match ``kitchen_items``; without items, of the starting kitchen.
    ``rates``: the success rates of motions; ``None`` without a rates file.
    ``warnings``: the assumptions made while reading.
    ``left_out``: the number of lines that were left out.
    ``unit_prices``: the prices of units; ``None`` without any price.
    ``starting``: true if the kitchen is the starting kitchen.
    ``goals_from``: where the goals come from; empty if a file lists them. ``marked`` means nodes marked with
    ``!`` in the network, and ``last`` means outputs of the last unit of each file.
    ``repeated``: the nodes that a unit lists twice.
    ``amounts``: how many copies of nodes units take and make, where this is not 1.
    """

    network: Network
    kitchen: frozenset[int]
    kitchen_items: tuple[ListedObject, ...]
    goals: tuple[ListedObject, ...]
    rates: dict[str, Fraction] | None
    utensils: frozenset[str]
    warnings: tuple[Diagnostic, ...]
    left_out: int
    unit_prices: UnitPrices | None = None
    starting: bool = False
    goals_from: str = ""
    repeated: tuple[RepeatedNode, ...] = ()
    amounts: DataAmounts = NO_AMOUNTS


def find_data(
    folder: Path | None = None,
    network: Sequence[Path] = (),
    kitchen: Path | None = None,
    rates: Path | None = None,
    utensils: Path | None = None,
    goals: Path | None = None,
    unit_prices: Path | None = None,
    unit_amounts: Path | None = None,
) -> DataFiles:
    """Return the files of a question; a named file takes precedence over the folder's file of its kind.

    Without a folder and a network, the files are those of the bundled kitchen. A network without a folder
    gets no bundled kitchen or rates, since these belong to the bundled network.

    A folder has its network in ``FOON.txt``, or else in all files that :func:`network_files` returns. A file
    that is named as a kitchen or as other data is no network. The folder may also have ``kitchen.json`` or
    ``kitchen.txt``, ``motion.txt``, ``utensils.txt``, ``unit_prices.txt``, ``unit_amounts.txt``,
    ``stand_ins.txt``, and ``goal_nodes.json`` or ``goal_nodes.txt``.

    Raises :class:`UserError` for a path that does not exist, and if there is no network file.
    """
    if folder is None and not network:
        folder = bundled_kitchen()
    own_files = (kitchen, rates, utensils, goals, unit_prices, unit_amounts)
    for path in (folder, *own_files, *network):
        if path is not None and path != STARTING and not path.exists():
            raise UserError(f"{path}: no such file or folder")
    if folder is not None and not folder.is_dir():
        raise UserError(f"{folder}: expected a folder; a single network is given with --network")
    network_paths = network or ([folder] if folder else [])
    own_paths = {path.resolve() for path in own_files if path is not None}
    files = tuple(
        file
        for source in network_paths
        for file in network_files(source)
        if not source.is_dir() or file.resolve() not in own_paths
    )
    if not files:
        raise UserError("no network: name a recipe, a folder or a store")

    def own_or_in_folder(file: Path | None, *names: str) -> Path | None:
        """Return the named ``file``, else the first of ``names`` in the folder; ``None`` without either."""
        if file is None and folder is not None:
            return next((folder / name for name in names if (folder / name).exists()), None)
        return file

    return DataFiles(
        files,
        own_or_in_folder(kitchen, *_KITCHENS),
        own_or_in_folder(rates, _RATES),
        own_or_in_folder(utensils, _UTENSILS),
        own_or_in_folder(goals, *_GOALS),
        own_or_in_folder(unit_prices, _UNIT_PRICES),
        own_or_in_folder(unit_amounts, _UNIT_AMOUNTS),
        own_or_in_folder(None, _STAND_INS),
    )


def kitchen_file(folder: Path) -> Path | None:
    """Return the kitchen file of a folder, ``kitchen.json`` before ``kitchen.txt``; ``None`` without one."""
    return next((folder / name for name in _KITCHENS if (folder / name).is_file()), None)


def network_files(path: Path) -> list[Path]:
    """Return the network files of a folder; for a path that is no folder, return the path itself.

    If the folder has a file ``FOON.txt``, only this file is returned. Otherwise all ``*.txt``, ``*.json`` and
    ``*.jsonl`` files that may be networks are returned, sorted by name. Kitchens, goals and tables are left
    out. Raises :class:`UserError` for a folder without a network.
    """
    if not path.is_dir():
        return [path]
    if (path / "FOON.txt").is_file():
        return [path / "FOON.txt"]
    files = sorted(file for file in path.iterdir() if file.name not in _SIDE_TABLES and _may_be_network(file))
    if not files:
        expected = "a folder with FOON.txt or other networks (*.txt, *.json, *.jsonl)"
        raise UserError(f"{path}: expected {expected}, found none")
    return files


def _may_be_network(file: Path) -> bool:
    """Whether a file of a folder may be a network, by its suffix and content; a hidden file is no network.

    A ``*.txt`` file may have any content. A JSON text has to name an object. A file with a suffix of neutral
    files has to be in the neutral form.
    """
    if file.name[0] == "." or not file.is_file():
        return False
    if file.suffix == ".json":
        return _OBJECT_KEY.search(read_content(file)) is not None
    if file.name.endswith(NEUTRAL_SUFFIXES):
        return NEUTRAL.recognises(read_beginning_text(file), "")
    return file.suffix == ".txt"


def read_data(files: DataFiles, lenient: bool = False, level: int = 3) -> Data:
    """Read the network and the data beside it, except ``stand_ins``.

    Without a kitchen file, the kitchen is the starting kitchen. Without a goals file, goals are assumed. If
    ``lenient``, the lines of a network that are not understood are left out with a warning.

    Below ``level`` 3, network, kitchen and goals are reduced to that level. An entry of the kitchen or of
    goals then matches all nodes that agree with it in what remains.

    Kitchen items, prices and amounts that match nothing in the network cause warnings. Raises
    :class:`InputError` for other input that is not understood.
    """
    with without_garbage_collection():
        reader = FoonReader(lenient)
        whole_network = reader.read_network(files.network)
    network = network_at_level(whole_network, level)
    warnings = reader.diagnostics
    starting = is_starting(files.kitchen)
    items = () if files.kitchen is None or starting else tuple(read_object_list(files.kitchen, warnings))
    kitchen = set(starting_kitchen(network).nodes) if starting else set()
    for item in items:
        matches = network.find(pattern_at_level(item.pattern, level))
        kitchen.update(matches)
        if not matches:
            warnings.append(kitchen_item_warning(item))
    if files.goals:
        listed_goals, goals_from = read_object_list(files.goals, warnings), ""
    else:
        listed_goals, goals_from = _assumed_goals(reader, whole_network)
    goals = tuple(entry._replace(pattern=pattern_at_level(entry.pattern, level)) for entry in listed_goals)
    price_list = read_unit_prices(files.unit_prices) if files.unit_prices else None
    if price_list:
        warnings += (
            unit_price_warning(*entry)
            for entry in price_list.sources.items()
            if whole_network.unit_id(entry[0]) is None
        )
    amounts = amounts_of_units(reader.amounts, files.unit_amounts, whole_network, warnings)
    return Data(
        network,
        frozenset(kitchen),
        items,
        goals,
        RATES.read(files.rates) if files.rates else None,
        read_utensils(files.utensils) if files.utensils else frozenset(),
        tuple(warnings),
        reader.left_out,
        unit_prices(reader.prices, price_list),
        starting,
        goals_from,
        tuple(reader.repeated),
        amounts,
    )


def _assumed_goals(reader: FoonReader, network: Network) -> tuple[list[ListedObject], str]:
    """Return the assumed goals of a network and their origin: marked nodes, or outputs of last units."""
    if reader.marked:
        return [goal_entry(node, source) for node, source in reader.marked.items()], MARKED
    return last_goals(network, reader.last_units), LAST


def kitchen_nodes(network: Network, items: Iterable[ListedObject]) -> frozenset[int]:
    """Return the ids of the object nodes that match kitchen items.

    Items are first reduced to the level of the network.
    """
    return frozenset(o for item in items for o in network.find(pattern_at_level(item.pattern, network.level)))


def amounts_of_items(names: NodeNames, items: Iterable[ListedObject]) -> dict[ObjectNode, int]:
    """Return the amount of each node that matches an item with an amount.

    Items without an amount are skipped. Items are first reduced to the level of ``names``. If several items
    match a node, the last item counts.
    """
    return {
        names.node(o): item.amount
        for item in items
        if item.amount is not None
        for o in names.find(pattern_at_level(item.pattern, names.level))
    }


def unit_prices(stated: StatedPrices, price_list: UnitPriceList | None) -> UnitPrices | None:
    """Return the prices of units; ``None`` if no file is given and no network states a price.

    ``price_list`` has the prices of a file; they take precedence over the prices ``stated`` in networks.
    Raises :class:`InputError` if copies of a unit state different prices and the file has none for the unit.
    """
    prices_of_file = price_list.units if price_list else {}
    price_by_unit = stated.price_by_unit(prices_of_file)
    if not (price_list or price_by_unit):
        return None
    return UnitPrices(price_list.motions if price_list else {}, price_by_unit | prices_of_file)


def amounts_of_units(
    stated: StatedAmounts, file: Path | None, network: Network, warnings: list[Diagnostic]
) -> DataAmounts:
    """Return the amounts that networks state for their units, overridden by the table in ``file``.

    ``file`` is ``None`` if there is no table. A warning for each row that matches no unit is added to
    ``warnings``.
    """
    stated_amounts = stated.amounts_by_unit(network)
    if file is None:
        return stated_amounts
    rows = UNIT_AMOUNTS.rows(file)
    motions = {row.name[0] for row in rows}
    units = (network.unit(unit) for unit, motion in enumerate(network.motions) if motion in motions)
    amounts, unmatched = apply_amount_table(stated_amounts, rows, units)
    warnings += unmatched
    return amounts


def unit_price_warning(unit: FunctionalUnit, source: Source) -> Diagnostic:
    """Return the warning about the price of a unit that is not in the network."""
    message = f"the unit {str(unit)!r} is not in the network"
    return Diagnostic(Severity.WARNING, "unit-price", message, source)


def kitchen_item_warning(item: ListedObject) -> Diagnostic:
    """Return the warning about a kitchen item that matches no object node."""
    message = f"the kitchen item {str(item.pattern)!r} matches no object node of the network"
    return Diagnostic(Severity.WARNING, "kitchen-item", message, item.source)
