"""Reading data: text files, or a store."""

import time

from foon_asp.dataset.dataset import Dataset, left_out_warning
from foon_asp.problem import first_sources, unrated_remarks
from foon_asp.text.data_folder import DataFiles, read_data
from foon_asp.text.diagnostics import brief_summary, summarize
from foon_asp.text.plain_file import is_store
from foon_asp.text.repeated_node import repeated_note


def read_dataset(files: DataFiles, lenient: bool = False, level: int = 3) -> Dataset:
    """Read text files, or open the store that is named as the network.

    With ``lenient``, lines of text that are not understood are skipped, and a remark says how many. For a
    store, it makes no difference. ``level`` is the level at which nodes are merged. The remarks of the
    dataset are the assumptions made. Raises :class:`UserError` for input that is not understood.
    """
    began = time.perf_counter()
    if any(map(is_store, files.network)):
        # imports SQLite, which text does without
        from foon_asp.dataset.reading_store import read_store  # noqa: PLC0415

        return read_store(files, level)
    data = read_data(files, lenient, level)
    remarks = [left_out_warning(data.left_out)] if data.left_out else []
    if data.rates is not None:
        remarks += unrated_remarks(first_sources(data.network), data.rates)
    remarks += repeated_note(data.repeated)
    dataset = Dataset.of(data, time.perf_counter() - began)
    has_kitchen = files.kitchen is not None
    return dataset.with_remarks(summarize(data.warnings), brief_summary(data.warnings), remarks, has_kitchen)
