"""Rows of results on disk, written as they come, so that a run that was killed can be resumed."""

import contextlib
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Self

from foon_asp.asp import Status
from foon_asp.batch.answer_row import Row
from foon_asp.batch.asked import Asked
from foon_asp.compare.rows_file import RowsFile
from foon_asp.errors import UserError
from foon_asp.text.json_value import schema_name

if TYPE_CHECKING:
    import pyarrow

_ROWS_IN_PART = 1000
_ASKED = ("goal", "objective", "containers", "items", "kitchen", "stock", "stays", "time_limit")
_ANSWERED = ("status", "error", "proof", "costs", "lower_bound", "units", "seconds")
KIND = "batch-row"
_QUESTION, _WAITING = "_question.jsonl", "_waiting.jsonl"
_PART = re.compile(r"part-(\d{6,18})\.parquet", re.ASCII)


def open_results(path: Path, question: dict[str, object]) -> "Results":
    """Open results to be gone on with, or begin new ones: a folder for ``.parquet``, else JSON Lines.

    ``question`` says what all rows have in common. Raises :class:`UserError` where the results were begun
    for another question, or cannot be written.
    """
    return ParquetFolder(path, question) if path.suffix == ".parquet" else JsonLines(path, question)


class _Kept(NamedTuple):
    """A row that was there: the key of the question that it answers, its status, and all of it."""

    key: str
    status: str
    row: dict[str, Any]


def _kept(row: dict[str, Any]) -> _Kept:
    """Look at a row that was there; raises an error that :class:`RowsFile` knows for what is none of ours."""
    goal, limit, status = row["goal"], row["time_limit"], row["status"]
    goals = (goal,) if isinstance(goal, str) else tuple(goal)
    files = (row[key] for key in ("kitchen", "stock", "stays"))
    kitchen, stock, stays = (None if file is None else Path(file) for file in files)
    asked = Asked(goals, row["objective"], row["containers"], kitchen, limit, row["items"], stock, stays)
    names = (*goals, asked.objective, asked.containers, asked.items)
    is_limit = limit is None or (type(limit) in {int, float} and limit >= 0)
    known = status == "failed" or status in set(Status)
    is_ours = goals and row.keys() == {*_ASKED, *_ANSWERED} and all(isinstance(name, str) for name in names)
    if not (is_ours and is_limit and known) or asked.shown() != {key: row[key] for key in _ASKED}:
        raise ValueError("not a row of results")
    return _Kept(asked.key, status, row)


class JsonLines(RowsFile[_Kept]):
    """A file with a row on each line, under one that says what is asked."""

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        super().__init__(path, KIND, question, _kept)
        self.done = {kept.key: kept.status for kept in self.found}

    def add(self, asked: Asked, row: Row) -> None:
        """Keep a row; it is on the disk when this returns."""
        self.write(row)
        self.done[asked.key] = str(row["status"])


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
        self.done: dict[str, str] = {}
        self._parts = 0
        for number, part in _parts(path):
            self._parts = number + 1
            self.done |= _statuses(part)
        try:
            path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UserError(f"{path}: cannot be written: {error.strerror or error}") from None
        self._begun = RowsFile(path / _QUESTION, KIND, question, _kept)  # refuses parts of another question
        self._waiting_file = path / _WAITING
        self._open()
        # a part was written, and the rows waiting for it were not yet taken away
        self._waiting = [kept.row for kept in self._rows.found if kept.key not in self.done]
        self.done |= {kept.key: kept.status for kept in self._rows.found}

    def add(self, asked: Asked, row: Row) -> None:
        """Keep a row; it is on the disk when this returns."""
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
        self._rows = RowsFile(self._waiting_file, KIND, self._question, _kept)

    def _write_part(self) -> None:
        from pyarrow import ArrowException, parquet  # noqa: PLC0415 (an extra)

        final = self._folder / f"part-{self._parts:06d}.parquet"
        partial = self._folder / f"_part.{os.getpid()}"
        try:
            parquet.write_table(_table(self._waiting), partial)
            partial.replace(final)
            self._rows.__exit__()
            self._waiting_file.unlink()
        except (OSError, ArrowException) as error:
            with contextlib.suppress(OSError):
                partial.unlink(missing_ok=True)
            why = getattr(error, "strerror", None) or error
            raise UserError(f"{final}: cannot be written: {why}") from None
        self._parts += 1
        self._waiting = []
        self._open()


Results = JsonLines | ParquetFolder
"""Where rows go. ``done`` has the keys of the questions that have one, with the status in it."""


def _parts(folder: Path) -> list[tuple[int, Path]]:
    """List the parts of a folder of results by number; raises :class:`UserError` for any other folder."""
    try:
        if not folder.exists():
            return []
        if not folder.is_dir():
            raise UserError(f"{folder}: is a file, expected a folder of results of foon-asp; name another")
        names = sorted(file.name for file in folder.iterdir())
    except OSError as error:
        raise UserError(f"{folder}: cannot be read: {error.strerror or error}") from None
    parts = sorted((int(match[1]), folder / match[0]) for match in map(_PART.fullmatch, names) if match)
    ours = {_QUESTION, _WAITING, *(part.name for _, part in parts)}
    other = next((name for name in names if name not in ours and not name.startswith("_part.")), None)
    if other is not None or (names and _QUESTION not in names):
        raise UserError(
            f"{folder}: contains something other than results of foon-asp ({other or names[0]}), and was not "
            "changed; name another folder"
        )
    return parts


def _statuses(part: Path) -> dict[str, str]:
    """Give the statuses in a part by the keys of their questions."""
    from pyarrow import ArrowException, parquet  # noqa: PLC0415 (an extra)

    try:
        # a part by itself: the name of its folder says nothing of what is in it
        rows = parquet.read_table(part, columns=["schema", *_ASKED, "status"], partitioning=None).to_pylist()
    except (OSError, ArrowException) as error:
        raise UserError(f"{part}: cannot be read: {error}") from None
    try:
        found = [_kept(_of_part(row)) for row in rows]
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError):
        raise UserError(f"{part}: error: not a part of results of foon-asp; name another folder") from None
    return {kept.key: kept.status for kept in found}


def _of_part(row: dict[str, Any]) -> dict[str, Any]:
    """Give the row of a part, of which what was asked is read, as it is on a line."""
    goal = row["goal"][0] if len(row["goal"]) == 1 else row["goal"]
    if row.pop("schema") != schema_name(KIND):
        raise ValueError("a row of another version")
    return dict.fromkeys(_ANSWERED) | row | {"goal": goal}


def _table(rows: list[dict[str, Any]]) -> "pyarrow.Table":
    """Give rows as a table; exact numbers are text, and goals always a list."""
    import pyarrow  # noqa: PLC0415 (an extra)

    texts, whole = pyarrow.string(), pyarrow.int64()
    schema = pyarrow.schema(
        {
            "schema": texts,
            "goal": pyarrow.list_(texts),
            "objective": texts,
            "containers": texts,
            "items": texts,
            "kitchen": texts,
            "stock": texts,
            "stays": texts,
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
        "schema": schema_name(KIND),
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
