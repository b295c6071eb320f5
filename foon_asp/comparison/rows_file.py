"""Files of rows: results as JSON Lines, appended one by one, and read back to continue a run."""

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import IO, Generic, NamedTuple, Self, TypeVar

from foon_asp.errors import UserError
from foon_asp.json_layout import Json, json_line, read_json, schema_name

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

Row = TypeVar("Row")
Value = TypeVar("Value")


class RowForm(NamedTuple, Generic[Row]):
    """The format of rows of a ``kind``: how they are written, read and identified.

    ``plain`` returns a row as plain values, and ``read`` is its inverse. For other values, ``read`` raises a
    :class:`ValueError`, :class:`KeyError`, :class:`TypeError`, :class:`AttributeError` or
    :class:`ArithmeticError`. ``key`` returns the question that a row answers.
    """

    kind: str
    plain: Callable[[Row], Json]
    read: Callable[[Json], Row]
    key: Callable[[Row], object]


class RowsFile(Generic[Row]):
    """A file to which one process at a time appends rows.

    The first line is the question (data and settings); every line states its kind and version. Each row is
    written to the disk at once. The file is locked until it is closed or the process ends. An existing file
    is continued: its rows are read, and an incomplete last line, from an interruption, is dropped.

    ``done``: the rows by key; the last one of rows that share a key.
    ``duplicate_warnings``: a warning for each row that was read and has the key of an earlier row.

    Raises :class:`UserError` if another run writes the file, or if the file has another question, lines of
    another version, or other contents. The file is then unchanged.
    """

    def __init__(self, path: Path, form: RowForm[Row], question: Json) -> None:
        """Open and lock the file, read its rows into ``done``, and write the first line of a new file."""
        self.path, self._form, self._schema = path, form, schema_name(form.kind)
        self.done: dict[object, Row] = {}
        self.duplicate_warnings: list[str] = []
        with self._report_errors("written"):
            self._file = self._open_locked()
        try:
            with self._report_errors("read"):
                content = self._file.read()
            first_line = self._encoded_line({"question": question})
            is_new = first_line.startswith(content)  # empty, or cut short
            end = 0 if is_new else self._read_rows(content, question)
            with self._report_errors("written"):
                self._file.truncate(end)
                self._file.seek(end)
                self._write(first_line if is_new else b"")
        except BaseException:
            self.__exit__()
            raise

    def add(self, row: Row) -> None:
        """Append a row, and add it to ``done``; when this returns, the row is on the disk."""
        with self._report_errors("written"):
            self._write(self._encoded_line(self._form.plain(row)))
        self.done[self._form.key(row)] = row

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):  # all rows are on the disk, or an error was reported
            self._file.close()

    def _open_locked(self) -> IO[bytes]:
        """Open and lock the file, which is made if it does not exist, and return it.

        Raises :class:`UserError` for a folder, and if another run has locked the file.
        """
        if self.path.exists() and not self.path.is_file():
            raise UserError(f"{self.path}: is not a file in which results can be kept")
        file = open(self.path, "r+b", opener=lambda name, flags: os.open(name, flags | os.O_CREAT, 0o666))  # noqa: SIM115 (closed at the end)
        if _try_lock(file):
            file.seek(0)
            return file
        file.close()
        raise UserError(
            f"{self.path}: another run is writing it, and it is left to that one: wait until it has ended, "
            "or name another file"
        )

    def _read_rows(self, content: bytes, question: Json) -> int:
        """Read the rows of an existing file into ``done``; return the length of its complete lines, in bytes.

        A row with the key of an earlier row adds to ``duplicate_warnings``. Raises :class:`UserError` for
        other contents, and for a file that was begun for another question.
        """
        first_line, newline, rows = content.partition(b"\n")
        header = self._read_line(first_line, 1, dict) if newline else {}
        if header.keys() != {"question"}:
            raise UserError(
                f"{self.path}: contains something other than results of foon-asp, and was not changed; "
                "name another file"
            )
        old, new = json_line(header["question"]), json_line(question)
        if read_json(old) != read_json(new):
            raise UserError(
                f"{self.path}: was started for another question; name another file, or remove this one\n"
                f"  there: {old}\n  now:   {new}"
            )
        *lines, incomplete = rows.split(b"\n")
        numbers: dict[object, int] = {}
        for number, line in enumerate(lines, 2):
            row = self._read_line(line, number, self._form.read)
            key = self._form.key(row)
            self.done[key] = row
            if numbers.setdefault(key, number) != number:
                self.duplicate_warnings.append(
                    f"{self.path}:{number}: warning: a row of the same question as line {numbers[key]}; "
                    "whoever reads them counts both: remove one"
                )
        return len(content) - len(incomplete)

    def _read_line(self, line: bytes, number: int, read: Callable[[Json], Value]) -> Value:
        """Return what ``read`` makes of a line without its schema; ``number`` is that of the line, from 1.

        Raises :class:`UserError` for an invalid line, and for one of another version.
        """
        try:
            value: Json = read_json(line)
            version = value.pop("schema")
            if version == self._schema:
                return read(value)
        except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError):
            raise UserError(
                f"{self.path}:{number}: error: not a line of results of foon-asp; the file is left as it is: "
                "name another"
            ) from None
        raise UserError(
            f"{self.path}:{number}: error: found results of foon-asp in the version {version!r}, expected "
            f"{self._schema!r}; name another file, or remove this one"
        )

    def _encoded_line(self, row: Json) -> bytes:
        """Return a row as a line of the file, with its schema first."""
        return json_line({"schema": self._schema, **row}).encode() + b"\n"

    def _write(self, content: bytes) -> None:
        """Write bytes at the end of the file, and wait until they are on the disk."""
        self._file.write(content)
        self._file.flush()
        os.fsync(self._file.fileno())

    @contextlib.contextmanager
    def _report_errors(self, action: str) -> Iterator[None]:
        """Turn an ``OSError`` in the context into a :class:`UserError`; ``action`` is read or written."""
        try:
            yield
        except OSError as error:
            raise UserError(f"{self.path}: cannot be {action}: {error.strerror or error}") from None


def _try_lock(file: IO[bytes]) -> bool:
    """Lock an open file until it is closed; return ``False`` where another process has locked it.

    Return ``True``, without a lock, on a file system that has no locks.
    """
    try:
        if sys.platform == "win32":
            # a byte beyond the end of any file, since no other process could read a locked one
            os.lseek(file.fileno(), 1 << 40, os.SEEK_SET)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:
        return True
    return True
