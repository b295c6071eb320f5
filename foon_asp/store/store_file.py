"""The file of a store, checked for its format and for damage."""

import functools
import json
import os
import sqlite3
import weakref
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Concatenate, NoReturn, ParamSpec, Protocol, TypeVar

from foon_asp.errors import UserError
from foon_asp.store.columns import decoded
from foon_asp.store.digests import FILE_DIGEST, has_true_digest
from foon_asp.store.store_tables import APPLICATION_ID, VERSION, check_tables
from foon_asp.text.plain_file import STORE_MAGIC, read_beginning

_HEADER = 100  # bytes; https://www.sqlite.org/fileformat2.html says what is where

# Raised for values whose type, length or id is not that of a store.
_DAMAGE = (
    sqlite3.Error,
    ValueError,
    TypeError,
    LookupError,
    AttributeError,
    ArithmeticError,
    MemoryError,
    RecursionError,
)

Parameters = ParamSpec("Parameters")
Value = TypeVar("Value")


def is_store_database(file: Path) -> bool:
    """Whether a file begins like a store of any version, complete or not."""
    header = read_beginning(file, _HEADER)
    return header[: len(STORE_MAGIC)] == STORE_MAGIC and int.from_bytes(header[68:72]) == APPLICATION_ID


class StoreFile:
    """An opened store, read only; any number of processes can have the same store open.

    The store is closed by :meth:`close`, or when nothing refers to it any more. Opening and reading raise
    :class:`UserError` for a file that is no store, was made by a newer program, is cut off or damaged.
    """

    def __init__(self, file: Path) -> None:
        """Check the header of the file, open it as a database, and check its tables."""
        self.file = file
        self._check_header()
        try:
            # immutable: no locks, no files beside it. Who holds it open keeps what an import replaces.
            uri = f"{file.absolute().as_uri()}?mode=ro&immutable=1"
            self.database = sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)
        except sqlite3.Error as error:
            raise UserError(f"{file}: cannot be read: {error}") from None
        self._closing = weakref.finalize(self, self.database.close)
        try:
            check_tables(self.database)
        except (sqlite3.Error, ValueError) as error:
            self.failed(error)

    def close(self) -> None:
        """Close the file; to read more of it raises :class:`UserError`."""
        self._closing()

    def rows(self, statement: str, ids: Iterable[int]) -> sqlite3.Cursor:
        """Run a statement that may have the condition ``IN ids`` about the ``ids``, and return its rows."""
        listed = "IN (SELECT value FROM json_each(?))"
        return self.database.execute(statement.replace("IN ids", listed), (json.dumps([*ids]),))

    def about(self, name: str) -> Any:
        """Return the value of a name in the table ``about``."""
        row = self.database.execute("SELECT value FROM about WHERE name = ?", (name,)).fetchone()
        return decoded(row[0])

    def check_digest(self) -> None:
        """Raise :class:`UserError` if the file was changed after its import; all of it is read."""
        if not has_true_digest(self.file):
            (message,) = self.database.execute("PRAGMA quick_check(1)").fetchone()
            self.damaged("it was changed after the import" if message == "ok" else " ".join(message.split()))

    def failed(self, error: BaseException) -> NoReturn:
        """Raise :class:`UserError` for an error while reading: the store was closed or is damaged."""
        if not self._closing.alive:
            raise UserError(f"{self.file}: the store was closed; open it again to read from it") from None
        self.damaged(str(error) or type(error).__name__)

    def damaged(self, what: str) -> NoReturn:
        """Raise :class:`UserError` for a damaged store; ``what`` is the damage."""
        raise UserError(f"{self.file}: the store is damaged ({what}); import its source files again")

    def _check_header(self) -> None:
        """Raise :class:`UserError` for a file that is no store of this version, before SQLite reads it."""
        file = self.file
        if file.exists() and not file.is_file():  # a pipe would be waited for
            raise UserError(f"{file}: not a file, expected a store")
        try:
            with file.open("rb") as opened:
                header = opened.read(_HEADER)
                size = opened.seek(0, os.SEEK_END)
        except OSError as error:
            raise UserError(f"{file}: cannot be read: {error.strerror or error}") from None
        if header[: len(STORE_MAGIC)] != STORE_MAGIC:
            what = "is empty" if not size else "is no store"
            raise UserError(f"{file}: {what}; foon-asp merge FILES --store {file.name} makes one")
        if len(header) < _HEADER:
            self.damaged(f"it ends after {size} bytes")
        if int.from_bytes(header[68:72]) != APPLICATION_ID:
            raise UserError(f"{file}: is a database of another program, expected a store of foon-asp")
        version = int.from_bytes(header[60:64])
        if version < 1:
            self.damaged(f"version {version} of the store format does not exist")
        if version != VERSION:
            newer = "use a newer foon-asp, or " if version > VERSION else ""
            raise UserError(
                f"{file}: has version {version} of the store format, this foon-asp reads version {VERSION}: "
                f"{newer}import its source files again"
            )
        page = int.from_bytes(header[16:18])
        expected = (65536 if page == 1 else page) * int.from_bytes(header[28:32]) + FILE_DIGEST
        if size != expected:
            self.damaged(f"it has {size} bytes, expected {expected}")


class _Reading(Protocol):
    """A class that reads from a store."""

    @property
    def file(self) -> StoreFile:
        """The file of the store."""


Reader = TypeVar("Reader", bound=_Reading)


def reporting_damage(
    read: Callable[Concatenate[Reader, Parameters], Value],
) -> Callable[Concatenate[Reader, Parameters], Value]:
    """Decorate a method to raise :class:`UserError` where the values that it reads are damaged."""

    @functools.wraps(read)
    def guarded(reader: Reader, *positional: Parameters.args, **named: Parameters.kwargs) -> Value:
        try:
            return read(reader, *positional, **named)
        except UserError:
            raise
        except _DAMAGE as error:
            reader.file.failed(error)

    return guarded  # type: ignore[return-value]
