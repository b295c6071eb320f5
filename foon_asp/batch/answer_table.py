"""Rows of answers as a table, in CSV or Parquet, with a column for each field and each objective."""

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import msgspec

from foon_asp.batch.answer_row import AnswerRow, Figures
from foon_asp.batch.batch_question import Amounts, Goals
from foon_asp.errors import UserError
from foon_asp.json_layout import Json
from foon_asp.problem import Objective
from foon_asp.results.plain_values import plain
from foon_asp.results.table_columns import csv_text, flat_row
from foon_asp.whole_file import write_whole

TABLE_SUFFIXES: Final = (".csv", ".parquet")
_ARROW_TYPES: Final = {
    Amounts | None: "list<int64>",
    Goals: "list<string>",
    bool | None: "bool",
    float | None: "double",
    int: "int64",
    tuple[int, ...] | None: "list<int64>",
}  # all else is text


def answer_columns(objectives: Iterable[Objective]) -> Iterator[tuple[str, Any]]:
    """Yield the name and type of each column: the fields of a row, with costs and bounds by objective.

    The costs by ``units`` are in the column ``costs.units``, for example. A number that may be a fraction is
    rounded to a decimal; another column ending in ``_exact`` has the exact number as text. A column
    ``costs.ingredients`` follows the other costs.
    """
    objectives = tuple(objectives)
    for field in msgspec.structs.fields(AnswerRow):
        if field.type != Figures | None:
            yield field.name, field.type
            continue
        for objective in objectives:
            name = f"{field.name}.{objective}"
            yield from (
                [(name, int)] if objective.row.whole else [(name, float | None), (f"{name}_exact", str)]
            )
        if field.name == "costs":
            yield "costs.ingredients", int


def check_table(file: Path, rows: Path) -> None:
    """Raise :class:`UserError` if a table cannot be written into ``file``, or would replace another file.

    Parquet needs pyarrow. An existing file may be replaced only if the file ``rows``, from which the table is
    made, exists as well.
    """
    if file.suffix == ".parquet":
        try:
            import pyarrow  # noqa: F401, PLC0415 (an extra)
        except ImportError:
            raise UserError(
                "results in Parquet need pyarrow; install it with: pip install 'foon-asp[parquet]'"
            ) from None
    if file.exists() and not (file.is_file() and rows.exists()):
        raise UserError(
            f"{file}: was not made from {rows.name}, which does not exist, and was not changed; name another "
            "file"
        )


def write_table(file: Path, rows: Iterable[AnswerRow], objectives: Iterable[Objective]) -> None:
    """Write rows into a file: CSV if its name ends in ``.csv``, else Parquet; an existing file is replaced.

    Goals and amounts are lists, also for a single goal.
    """
    flat_rows = [
        flat_row(plain(row)) | {"goal": list(row.goals), "amount": list(row.amounts) or None} for row in rows
    ]
    types = dict(answer_columns(objectives))
    if file.suffix == ".csv":
        write_whole(file, csv_text(flat_rows, list(types)).encode("utf-8", "surrogatepass"))
    else:
        write_whole(file, _parquet_bytes(flat_rows, types))


def _parquet_bytes(rows: list[Json], types: dict[str, Any]) -> bytes:
    """Return rows as the bytes of a Parquet file; ``types`` are the types of its columns by name."""
    import pyarrow  # noqa: PLC0415 (an extra)
    from pyarrow import parquet  # noqa: PLC0415

    lists = {"list<string>": pyarrow.list_(pyarrow.string()), "list<int64>": pyarrow.list_(pyarrow.int64())}
    names = {name: _ARROW_TYPES.get(type_, "string") for name, type_ in types.items()}
    schema = pyarrow.schema({name: lists.get(arrow, arrow) for name, arrow in names.items()})
    sink = pyarrow.BufferOutputStream()
    parquet.write_table(pyarrow.Table.from_pylist(rows, schema), sink)
    return bytes(sink.getvalue())
