"""Rows of answers as a table, in CSV or Parquet, with a column for each field and each objective."""

import csv
import io
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import Any, Final

import msgspec

from foon_asp.batch.answer_row import AnswerRow, Exact, Figures
from foon_asp.batch.asked import Goals
from foon_asp.errors import UserError
from foon_asp.problem import Objective
from foon_asp.report.whole_file import write_whole
from foon_asp.results.plain import safe_cell

FORMATS: Final = (".csv", ".parquet")
_ARROW: Final = {
    Goals: "list<string>",
    bool | None: "bool",
    float | None: "double",
    int: "int64",
    tuple[int, ...] | None: "list<int64>",
}  # all else is text


def columns(objectives: Iterable[Objective]) -> Iterator[tuple[str, Any]]:
    """Return the columns by name and type: the fields of a row, and for figures one for each objective.

    A figure that need not be a whole number is a decimal, beside a column with the exact number as text.
    """
    objectives = tuple(objectives)
    for field in msgspec.structs.fields(AnswerRow):
        if field.type != Figures | None:
            yield field.name, field.type
            continue
        for each in objectives:
            name = f"{field.name}.{each}"
            yield from [(name, int)] if each.row.whole else [(name, float | None), (f"{name}_exact", str)]
        if field.name == "costs":
            yield "costs.ingredients", int


def flat_row(row: AnswerRow) -> dict[str, object]:
    """Return the values of a row by column."""
    flat: dict[str, object] = {}
    for name, value in msgspec.structs.asdict(row).items():
        if not isinstance(value, dict):
            flat[name] = value
            continue
        for objective, figure in value.items():
            column = f"{name}.{objective}"
            flat[column] = figure.approx if isinstance(figure, Exact) else figure
            if isinstance(figure, Exact):
                flat[f"{column}_exact"] = figure.exact
    return flat | {"goal": row.goals}


def check_table(file: Path, rows: Path) -> None:
    """Raise :class:`UserError` where a table cannot be written, or a file would be lost that is not ours."""
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


def write_table(file: Path, rows: Collection[AnswerRow], objectives: Iterable[Objective]) -> None:
    """Write rows to a file in the format that its suffix names."""
    flat, types = map(flat_row, rows), dict(columns(objectives))
    write_whole(file, (_csv if file.suffix == ".csv" else _parquet)(flat, types))


def _csv(rows: Iterable[dict[str, object]], types: dict[str, Any]) -> bytes:
    text = io.StringIO()
    writer = csv.DictWriter(text, list(types), extrasaction="ignore", lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: safe_cell(_cell(value)) for name, value in row.items()} for row in rows)
    return text.getvalue().encode("utf-8", "surrogatepass")


def _cell(value: object) -> str:
    if isinstance(value, tuple):
        return " + ".join(map(str, value))
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)


def _parquet(rows: Iterable[dict[str, object]], types: dict[str, Any]) -> bytes:
    import pyarrow  # noqa: PLC0415 (an extra)
    from pyarrow import parquet  # noqa: PLC0415

    lists = {"list<string>": pyarrow.list_(pyarrow.string()), "list<int64>": pyarrow.list_(pyarrow.int64())}
    names = {name: _ARROW.get(type_, "string") for name, type_ in types.items()}
    schema = pyarrow.schema({name: lists.get(arrow, arrow) for name, arrow in names.items()})
    sink = pyarrow.BufferOutputStream()
    parquet.write_table(pyarrow.Table.from_pylist(list(rows), schema), sink)
    return bytes(sink.getvalue())
