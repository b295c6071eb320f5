"""Results as JSON Lines: written as they come, read back to go on after an interruption."""

import contextlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, Generic, Self, TypeVar

from foon_asp.errors import UserError
from foon_asp.text.json_value import Json, json_line, read_json, schema_name

Row = TypeVar("Row")


class RowsFile(Generic[Row]):
    """A file of rows under construction.

    Its first line is the question (data and settings). Every line says its ``kind`` and version. Rows are
    written whole and at once; a last one that an interruption cut short is dropped. ``found`` are the rows
    that were there, as ``read`` makes them of plain values.

    Raises :class:`UserError`, and leaves the file as it is, where it was begun for another question, where
    its lines are of another version, and where anything in it is nothing that this class wrote: nobody's file
    is taken for one of ours. ``read`` refuses a row by raising a :class:`ValueError`, :class:`KeyError`,
    :class:`TypeError`, :class:`AttributeError` or :class:`ArithmeticError`.
    """

    def __init__(self, path: Path, kind: str, question: Json, read: Callable[[Any], Row]) -> None:
        self.path = path
        self.schema = schema_name(kind)
        self.question = read_json(json_line(question))
        self._read = read
        self.found: list[Row] = []
        kept, missing = self._look_at(self._content())
        try:
            self._file: IO[bytes] = path.open("r+b" if path.exists() else "xb")
            self._file.truncate(kept)
            self._file.seek(kept)
        except OSError as error:
            raise self._fault("written", error) from None
        try:
            self._put(missing)
        except UserError:
            with contextlib.suppress(OSError):  # half a first line would not be known as ours
                os.ftruncate(self._file.fileno(), kept)
            self.__exit__()
            raise

    def write(self, row: Json) -> None:
        """Write one row; it is on the disk when this returns."""
        self._put(self._line(row))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):  # all rows are on the disk already, or their fault was said
            self._file.close()

    def _content(self) -> bytes:
        try:
            if not self.path.exists():
                return b""
            if not self.path.is_file():
                raise UserError(f"{self.path}: is not a file in which results can be kept")
            return self.path.read_bytes()
        except OSError as error:
            raise self._fault("read", error) from None

    def _look_at(self, content: bytes) -> tuple[int, bytes]:
        """Read what was there; say how many bytes of it are kept, and which are missing behind them."""
        if not content:
            return 0, self._line({"question": self.question})
        first, newline, rows = content.partition(b"\n")
        begun = self._value(first, 1) if newline else None
        if begun is None or begun.keys() != {"question"}:
            raise UserError(
                f"{self.path}: contains something other than results of foon-asp, and was not changed; "
                "name another file"
            )
        if begun["question"] != self.question:
            raise UserError(
                f"{self.path}: was started for another question; name another file, or remove this one\n"
                f"  there: {json_line(begun['question'])}\n  now:   {json_line(self.question)}"
            )
        *whole, last = rows.split(b"\n")
        for number, line in enumerate(whole, 2):
            self.found.append(self._row(line, number))
        if not last:
            return len(content), b""
        try:
            read_json(last)
        except ValueError:  # cut short
            return len(content) - len(last), b""
        self.found.append(self._row(last, len(whole) + 2))  # whole, but for its end
        return len(content), b"\n"

    def _row(self, line: bytes, number: int) -> Row:
        value = self._value(line, number)
        try:
            return self._read(value)
        except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError):
            raise self._foreign(number) from None

    def _value(self, line: bytes, number: int) -> Json:
        """Parse a line, and take the version from it."""
        try:
            value: Json = read_json(line)
            found = value.pop("schema")
        except (ValueError, KeyError, TypeError, AttributeError):
            raise self._foreign(number) from None
        if found != self.schema:
            raise UserError(
                f"{self.path}:{number}: error: found results of foon-asp in the version {found!r}, expected "
                f"{self.schema!r}; name another file, or remove this one"
            )
        return value

    def _foreign(self, number: int) -> UserError:
        return UserError(
            f"{self.path}:{number}: error: not a line of results of foon-asp; the file is left as it is: "
            "name another"
        )

    def _put(self, content: bytes) -> None:
        try:
            self._file.write(content)
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise self._fault("written", error) from None

    def _fault(self, done: str, error: OSError) -> UserError:
        return UserError(f"{self.path}: cannot be {done}: {error.strerror or error}")

    def _line(self, row: Json) -> bytes:
        return json_line({"schema": self.schema, **row}).encode() + b"\n"
