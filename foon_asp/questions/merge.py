"""Merging of FOONs into one, with every functional unit once and the places that it comes from."""

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from foon_asp.argument_checks import typed
from foon_asp.dataset.paths import File, Files, as_path, as_paths
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import Amounts, Network, NetworkBuilder, counted
from foon_asp.network.near_units import units_with_one_difference
from foon_asp.questions.result import Result
from foon_asp.results.document import Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values_of import differences_of, listed_unit
from foon_asp.text.data_folder import DataFiles, amounts_of_units, find_data
from foon_asp.text.diagnostics import summarize
from foon_asp.text.merged_network import merged_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.unit_price_list import read_unit_prices
from foon_asp.whole_file import utf_8, write_whole


class Merged(Result, frozen=True, kw_only=True, tag=schema_name("merge")):
    """A universal FOON, and what it was merged from.

    Attributes:
        files: The files that were read.
        copies: How many functional units were read.
        units: How many of them are distinct.
        objects: How many object nodes there are.
        prices: How many units have a price, for which FOON text has no place.
        left_out: How many lines were skipped.

    Example:
        >>> merged = foon_asp.merge("data/kitchen/FOON.txt")
        >>> merged.units, merged.objects, merged.store
        (220, 418, None)
    """

    files: tuple[Path, ...]
    copies: int
    units: int
    objects: int
    prices: int = 0
    left_out: int

    network = Unserialized[Network | None](None)
    """The network; ``None`` where it was written into a store."""

    amounts = Unserialized[Amounts](MappingProxyType({}))
    """How many of an object node each unit takes and makes, where that is not one."""

    store = Unserialized[Path | None](None)
    """The store that it was written into, if it was."""

    warnings = Unserialized[tuple[str, ...]]()
    """Lines on what was skipped or assumed in reading."""

    def show(self) -> Iterator[Block]:
        """Yield one line with the counts; counts of prices and skipped lines are left out if they are 0."""
        source_text = str(self.store or counted(len(self.files), "file", ","))
        parts = [f"{source_text}: {counted(self.units, 'unit', ',')} of {self.copies:,} read"]
        parts.append(counted(self.objects, "object node", ","))
        if self.prices:
            parts.append(f"{counted(self.prices, 'price', ',')} of units not in the result")
        if self.left_out:
            parts.append(f"{counted(self.left_out, 'line', ',')} left out")
        yield ", ".join(parts)

    def foon(self) -> str:
        """Return the network as FOON text; lines above each unit have file, line and videos of every copy.

        Raises:
            UserError: for a network that is in a store.
        """
        if self.network is None:
            raise UserError("the network is in a store, not in memory: merge without a store")
        files = counted(len(self.files), "file", ",")
        comment = f"Universal FOON: {counted(self.units, 'functional unit', ',')} from {files}"
        return "".join(merged_text(self.network, comment, self.amounts))

    def kept_apart(self) -> Iterator[Block]:
        """Yield the pairs of units that differ in one thing alone, with the first place of each unit.

        Nothing is yielded for a network in a store.
        """
        if self.network is None:
            return
        pairs = units_with_one_difference(self.network)
        yield f"nearly the same, and kept apart: {counted(len(pairs), 'pair', ',')}"
        for pair in pairs:
            yield ""
            for letter, unit in (("A", pair.left), ("B", pair.right)):
                source = self.network.sources[self.network.unit_id(unit) or 0][0]
                first, *others = listed_unit(self.network, unit, source).lines()
                yield from (f"{letter}{first[1:]}", *others)
            yield from (f"    {difference}" for difference in differences_of(pair))
        yield ""

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the network into a file, as FOON text.

        Parameters:
            file: The path of the file.
            format_: ``foon`` or ``None``.

        Raises:
            UserError: for another format, and for a network that is in a store.
        """
        if format_ not in {None, "foon"}:
            raise UserError(f"found the format {format_!r}, expected 'foon'")
        write_whole(as_path(file), utf_8(self.foon()))


@typed
def merge(
    paths: Files,
    *,
    store: File | None = None,
    unit_prices: File | None = None,
    unit_amounts: File | None = None,
    lenient: bool = False,
) -> Merged:
    """Merge FOONs into a universal FOON, with every distinct functional unit once.

    Units are the same when they have the same motion, inputs and outputs.

    Parameters:
        paths: A file, a folder, or several of them.
        store: The store to write, for networks too large to read for each question. Of a single folder, it
            also keeps the kitchen, rates, utensils, goals and prices.
        unit_prices: The file with the prices of units, used when copies of a unit have different ones.
        unit_amounts: The file of amounts, by which units take and make several copies of an object node. It
            overrides what the networks state.
        lenient: Whether lines that are not understood are skipped instead of being errors.

    Returns:
        The network, or the store that was written, with counts.

    Raises:
        UserError: for a file that cannot be read or written, and copies of a unit with different prices or
            amounts.

    Example:
        >>> merged = foon_asp.merge(["data/kitchen/FOON.txt", "data/starter/FOON.txt"])
        >>> merged.copies - merged.units
        0
    """
    networks = as_paths(paths)
    if not networks:
        raise UserError("name the networks to merge")
    folder = networks[0] if isinstance(paths, str | PathLike) and networks[0].is_dir() else None
    prices, amounts = (None if file is None else as_path(file) for file in (unit_prices, unit_amounts))
    data_files = find_data(folder, () if folder else networks, unit_prices=prices, unit_amounts=amounts)
    return merge_files(data_files, None if store is None else as_path(store), lenient)


def merge_files(data_files: DataFiles, store: Path | None, lenient: bool) -> Merged:
    """Merge networks in memory; if ``store`` is a path, merge them into a store there.

    The store also keeps all other data files. A file named twice is read once. ``lenient`` skips lines that
    are not understood. Raises :class:`UserError` if there is no unit, or if copies of a unit have different
    prices or amounts.
    """
    network_files = tuple(dict.fromkeys(data_files.network))
    if store is not None:
        from foon_asp.store.import_files import import_files  # noqa: PLC0415 (slow to import)

        imported = import_files(data_files._replace(network=network_files), store, lenient)
        warnings = *summarize(imported.warnings), *imported.remarks
        merged = Merged(
            files=network_files,
            copies=imported.copies,
            units=imported.units,
            objects=imported.objects,
            left_out=imported.left_out,
        )
        return merged.set_unserialized(warnings=warnings, store=store)
    reader = FoonReader(lenient)
    builder = NetworkBuilder()
    copies = 0
    for file in network_files:
        for motion, inputs, outputs, sources, _ in reader.file_units(file):
            builder.add(motion, inputs, outputs, *sources)
            copies += 1
    reader.raise_errors()
    reader.prices.price_by_unit(
        read_unit_prices(data_files.unit_prices).units if data_files.unit_prices else {}
    )
    network = builder.build()
    if not len(network):
        raise UserError("there is no functional unit in these files")
    amounts = amounts_of_units(reader.amounts, data_files.unit_amounts, network, reader.diagnostics)
    if amounts.conflict:
        raise UserError(amounts.conflict)
    merged = Merged(
        files=network_files,
        copies=copies,
        units=len(network),
        objects=len(network.objects),
        prices=len(reader.prices),
        left_out=reader.left_out,
    )
    warnings = tuple(summarize(reader.diagnostics))
    return merged.set_unserialized(warnings=warnings, network=network, amounts=amounts.units)
