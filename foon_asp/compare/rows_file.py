"""Results as JSON Lines: written as they come, read back to go on after an interruption."""

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, Self

from foon_asp.errors import UserError


class RowsFile:
    """A file of rows under construction.

    Its first line is the question (data and settings): a file that was begun for another question is
    refused. Lines are written whole and at once; a last line that an interruption cut short is dropped.
    ``found`` are the rows that were there.
    """

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        self.path = path
        self.question = json.loads(json.dumps(question))
        self.found: list[dict[str, Any]] = []
        kept = 0
        if path.exists():
            for row, end in _rows(path):
                if not kept:
                    self._check(row)
                else:
                    self.found.append(row)
                kept = end
        try:
            self._file: IO[bytes] = path.open("r+b" if path.exists() else "w+b")
        except OSError as error:
            raise UserError(f"{path}: cannot be written: {error.strerror or error}") from None
        self._file.truncate(kept)
        self._file.seek(kept)
        if not kept:
            self.write({"question": self.question})

    def _check(self, row: dict[str, Any]) -> None:
        begun = row.get("question") if isinstance(row, dict) else None
        if begun != self.question:
            raise UserError(
                f"{self.path}: was begun for another question; name another file, or remove this one\n"
                f"  there: {begun}\n  now:   {self.question}"
            )

    def write(self, row: dict[str, object]) -> None:
        """Write one row; it is on the disk when this returns."""
        self._file.write(json.dumps(row, ensure_ascii=False).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def _rows(path: Path) -> Iterator[tuple[dict[str, Any], int]]:
    """Give the whole lines of a file, decoded, each with the offset of its end."""
    end = 0
    try:
        lines = path.read_bytes().splitlines(keepends=True)
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {error.strerror or error}") from None
    for number, line in enumerate(lines, 1):
        if not line.endswith(b"\n"):
            return
        end += len(line)
        try:
            yield json.loads(line), end
        except ValueError:
            raise UserError(f"{path}:{number}: error: not a line of results; name another file") from None
