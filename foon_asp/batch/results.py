"""Rows of results on disk, as they come, so that a run that was killed goes on where it was."""

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, Self

from foon_asp.batch.answer_row import Row
from foon_asp.batch.asked import Asked
from foon_asp.compare import RowsFile
from foon_asp.errors import UserError

if TYPE_CHECKING:
    import pyarrow

_ROWS_IN_PART = 1000
_ASKED = ("goal", "objective", "containers", "kitchen", "time_limit")


class Results(Protocol):
    """Where rows go. ``done`` has the keys of the questions that have one, with the status in it."""

    done: dict[str, str]

    def add(self, asked: Asked, row: Row) -> None:
        """Keep a row; it is on the disk when this returns."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *_: object) -> None: ...


def open_results(path: Path, question: dict[str, object]) -> Results:
    """Open results to be gone on with, or begin new ones: a folder for ``.parquet``, else JSON Lines.

    ``question`` says what all rows have in common. Raises :class:`UserError` where the results were begun
    for another question, or cannot be written.
    """
    return ParquetFolder(path, question) if path.suffix == ".parquet" else JsonLines(path, question)


def _key(row: dict[str, Any]) -> str:
    """Give the key of the question that a row answers."""
    goal = row["goal"]
    kitchen = row["kitchen"]
    return Asked(
        (goal,) if isinstance(goal, str) else tuple(goal),
        row["objective"],
        row["containers"],
        None if kitchen is None else Path(kitchen),
        row["time_limit"],
    ).key


class JsonLines:
    """A file with a row on each line, under one that says what is asked."""

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        self._rows = RowsFile(path, question)
        self.done = {_key(row): row["status"] for row in self._rows.found}

    def add(self, asked: Asked, row: Row) -> None:
        """Keep a row."""
        self._rows.write(row)
        self.done[asked.key] = str(row["status"])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._rows.__exit__()


class ParquetFolder:
    """A folder of Parquet files, which readers take for one table.

    A Parquet file cannot grow: rows wait in a file of JSON Lines, whose name readers pass over, until there
    are enough for the next part, and at the end.
    """

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        try:
            import pyarrow  # noqa: F401, PLC0415 (an extra)
        except ImportError:
            raise UserError(
                "results in Parquet need pyarrow; install it with: pip install 'foon-asp[parquet]'"
            ) from None
        self._folder = path
        self._question = question
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UserError(f"{path}: cannot be written: {error.strerror or error}") from None
        self._begun = RowsFile(path / "_question.jsonl", question)  # refuses parts of another question
        self.done: dict[str, str] = {}
        self._parts = 0
        for part in sorted(path.glob("part-*.parquet")):
            self._parts = 1 + int(re.sub(r"\D", "", part.stem))
            self.done |= _statuses(part)
        self._waiting_file = path / "_waiting.jsonl"
        self._open()
        # a part was written, and the rows waiting for it were not yet taken away
        self._waiting = [row for row in self._rows.found if _key(row) not in self.done]
        self.done |= {_key(row): row["status"] for row in self._waiting}

    def add(self, asked: Asked, row: Row) -> None:
        """Keep a row."""
        self._rows.write(row)
        self._waiting.append(dict(row))
        self.done[asked.key] = str(row["status"])
        if len(self._waiting) >= _ROWS_IN_PART:
            self._write_part()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._waiting:
            self._write_part()
        self._rows.__exit__()
        self._begun.__exit__()

    def _open(self) -> None:
        self._rows = RowsFile(self._waiting_file, self._question)

    def _write_part(self) -> None:
        from pyarrow import parquet  # noqa: PLC0415 (an extra)

        final = self._folder / f"part-{self._parts:06d}.parquet"
        partial = self._folder / f"_part.{os.getpid()}"
        try:
            parquet.write_table(_table(self._waiting), partial)
            partial.replace(final)
        except OSError as error:
            partial.unlink(missing_ok=True)
            raise UserError(f"{final}: cannot be written: {error.strerror or error}") from None
        self._parts += 1
        self._waiting = []
        self._rows.__exit__()
        self._waiting_file.unlink()
        self._open()


def _statuses(part: Path) -> dict[str, str]:
    """Give the statuses in a part by the keys of their questions."""
    from pyarrow import ArrowException, parquet  # noqa: PLC0415 (an extra)

    try:
        rows = parquet.read_table(part, columns=[*_ASKED, "status"]).to_pylist()
    except (OSError, ArrowException) as error:
        raise UserError(f"{part}: cannot be read: {error}") from None
    for row in rows:
        if len(row["goal"]) == 1:
            row["goal"] = row["goal"][0]
    return {_key(row): row["status"] for row in rows}


def _table(rows: list[dict[str, Any]]) -> "pyarrow.Table":
    """Give rows as a table; exact numbers are text, and goals always a list."""
    import pyarrow  # noqa: PLC0415 (an extra)

    texts, whole = pyarrow.string(), pyarrow.int64()
    schema = pyarrow.schema(
        {
            "goal": pyarrow.list_(texts),
            "objective": texts,
            "containers": texts,
            "kitchen": texts,
            "time_limit": pyarrow.float64(),
            "status": texts,
            "error": texts,
            "proof": texts,
            "cost_units": whole,
            "cost_inputs": whole,
            "cost_ingredients": whole,
            "cost_kitchen": whole,
            "cost_success": texts,
            "lower_bound": pyarrow.map_(texts, texts),
            "units": pyarrow.list_(whole),
            "seconds": pyarrow.float64(),
        }
    )
    return pyarrow.Table.from_pylist([_flat(row) for row in rows], schema)


def _flat(row: dict[str, Any]) -> dict[str, Any]:
    costs = row["costs"] or {}
    return {
        **row,
        "goal": [row["goal"]] if isinstance(row["goal"], str) else row["goal"],
        **{
            f"cost_{measure}": costs.get(measure) for measure in ("units", "inputs", "ingredients", "kitchen")
        },
        "cost_success": (costs.get("success") or {}).get("exact"),
        "lower_bound": None
        if row["lower_bound"] is None
        else [
            (name, bound["exact"] if isinstance(bound, dict) else str(bound))
            for name, bound in row["lower_bound"].items()
        ],
    }
