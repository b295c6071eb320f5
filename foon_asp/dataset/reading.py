"""Reading data: text files, or a store."""

import time
from collections.abc import Sequence
from pathlib import Path

from foon_asp.dataset.dataset import Dataset
from foon_asp.resources import bundled_kitchen
from foon_asp.text import DataFiles, find_data, is_store, read_data, summarize


def dataset_files(
    folder: Path | None,
    network: Sequence[Path] = (),
    kitchen: Path | None = None,
    rates: Path | None = None,
    utensils: Path | None = None,
    goals: Path | None = None,
    unit_prices: Path | None = None,
) -> DataFiles:
    """Find the files of data as :func:`~foon_asp.text.find_data` does.

    Without folder and network it is the bundled kitchen. A network of its own does not get the bundled
    kitchen and rates, which are made for another one.
    """
    if folder is None and not network:
        folder = bundled_kitchen()
    return find_data(folder, network, kitchen, rates, utensils, goals, unit_prices)


def read_dataset(files: DataFiles, lenient: bool = False, level: int = 3) -> Dataset:
    """Read text files, or open the store that is named in their place.

    Raises :class:`UserError` for what is not understood; what was assumed is in ``remarks``.
    """
    began = time.perf_counter()
    if any(map(is_store, files.network)):
        # stores take SQLite along, which text does without
        from foon_asp.dataset.stored_dataset import read_stored  # noqa: PLC0415

        return read_stored(files, level)
    data = read_data(files, lenient, level)
    remarks = summarize(data.warnings)
    if data.left_out:
        lines = "1 line" if data.left_out == 1 else f"{data.left_out} lines"
        remarks.append(f"warning: {lines} left out")
    return Dataset(data, time.perf_counter() - began, tuple(remarks), files.kitchen is not None)
