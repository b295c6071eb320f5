"""Many FOONs in one, every functional unit once and with its origins."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from foon_asp.dataset.paths import File, Files, as_path, files
from foon_asp.document.json_document import document
from foon_asp.errors import UserError
from foon_asp.network import Network, NetworkBuilder, counted
from foon_asp.questions.result import Result
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.data_folder import DataFiles, find_data
from foon_asp.text.diagnostics import summarize
from foon_asp.text.merged_network import merged_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.unit_price_list import read_unit_prices
from foon_asp.typed import typed


@dataclass(frozen=True, repr=False)
class Merged(Result):
    """A universal FOON: the ``network``, or the ``store`` that it was written into.

    ``files`` are those that were read, with ``copies`` of units, of which ``units`` are distinct, and
    ``objects`` object nodes. ``prices`` counts the units whose price FOON text has no place for, ``left_out``
    the lines that were skipped; ``warnings`` say what was assumed.

    Example:
        >>> merged = foon_asp.merge("data/kitchen/FOON.txt")
        >>> merged.units, merged.objects
        (220, 418)
    """

    files: tuple[Path, ...]
    copies: int
    units: int
    objects: int
    left_out: int
    warnings: tuple[str, ...]
    prices: int = 0
    network: Network | None = None
    store: Path | None = None

    def text(self) -> str:
        """Return the counts in one line."""
        read = str(self.store or counted(len(self.files), "file", ","))
        parts = [f"{read}: {counted(self.units, 'unit', ',')} of {self.copies:,} read"]
        parts.append(counted(self.objects, "object node", ","))
        if self.prices:
            parts.append(f"{counted(self.prices, 'price', ',')} of units not in the result")
        if self.left_out:
            parts.append(f"{counted(self.left_out, 'line', ',')} left out")
        return f"{', '.join(parts)}\n"

    def json_dict(self) -> object:
        """Return the counts as plain values."""
        names = ("copies", "units", "objects", "prices", "left_out")
        counts = {name: getattr(self, name) for name in names}
        return document("merge", files=list(map(str, self.files)), **counts)

    def foon(self) -> str:
        """Return the network as FOON text, with the file, line and videos of every copy above each unit.

        Raises:
            UserError: for a network that is in a store.
        """
        if self.network is None:
            raise UserError("the network is in a store, not in memory: merge without a store")
        of = counted(len(self.files), "file", ",")
        comment = f"Universal FOON: {counted(self.units, 'functional unit', ',')} from {of}"
        return "".join(merged_text(self.network, comment))

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the network into a file, as FOON text.

        Parameters:
            file: The path of the file.
            format_: ``foon``, or nothing.
        """
        if format_ not in {None, "foon"}:
            raise UserError(f"found the format {format_!r}, expected 'foon'")
        write_whole(as_path(file), utf_8(self.foon()))


@typed
def merge(
    paths: Files, *, store: File | None = None, unit_prices: File | None = None, lenient: bool = False
) -> Merged:
    """Merge FOONs into a universal FOON, with every distinct functional unit once.

    Units are the same when they have the same motion, inputs and outputs.

    Parameters:
        paths: A file, a folder, or several of them.
        store: The store to write, for networks too large to read for each question. Of a single folder, it
            also keeps the kitchen, rates, utensils, goals and prices.
        unit_prices: The file with the prices of units, used when copies of a unit have different ones.
        lenient: Whether lines that are not understood are skipped instead of being errors.

    Returns:
        The network, or the store that was written, with counts.

    Raises:
        UserError: for a file that cannot be read or written, and copies of a unit with different prices.

    Example:
        >>> merged = foon_asp.merge(["data/kitchen/FOON.txt", "data/starter/FOON.txt"])
        >>> merged.copies - merged.units
        0
    """
    named = files(paths)
    if not named:
        raise UserError("name the networks to merge")
    folder = named[0] if isinstance(paths, str | PathLike) and named[0].is_dir() else None
    prices = None if unit_prices is None else as_path(unit_prices)
    found = find_data(folder, () if folder else named, unit_prices=prices)
    return merge_files(found, None if store is None else as_path(store), lenient)


def merge_files(found: DataFiles, store: Path | None, lenient: bool) -> Merged:
    """Merge networks in memory, or with what stands beside them into a store."""
    network_files = tuple(dict.fromkeys(found.network))
    if store is not None:
        from foon_asp.store.import_files import import_files  # noqa: PLC0415 (slow to import)

        imported = import_files(found._replace(network=network_files), store, lenient)
        warnings = *summarize(imported.warnings), *imported.remarks
        counts = imported.copies, imported.units, imported.objects, imported.left_out
        return Merged(network_files, *counts, warnings, store=store)
    reader = FoonReader(lenient)
    builder = NetworkBuilder()
    copies = 0
    for file in network_files:
        for motion, inputs, outputs, sources in reader.file_units(file):
            builder.add(motion, inputs, outputs, *sources)
            copies += 1
    warnings = tuple(summarize(reader.diagnostics))
    reader.raise_errors()
    reader.prices.settled(read_unit_prices(found.unit_prices).units if found.unit_prices else {})
    network = builder.build()
    if not len(network):
        raise UserError("there is no functional unit in these files")
    counts = copies, len(network), len(network.objects), reader.left_out
    return Merged(network_files, *counts, warnings, len(reader.prices), network)
