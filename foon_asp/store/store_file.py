"""The file of a store, whose format and integrity are checked."""

import functools
import json
import os
import sqlite3
import weakref
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Concatenate, NoReturn, ParamSpec, Protocol, TypeVar

from foon_asp.errors import UserError
from foon_asp.store.columns import decode_json
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
    """Whether a file begins like a store of any version; the rest of the file is not read."""
    header = read_beginning(file, _HEADER)
    return header[: len(STORE_MAGIC)] == STORE_MAGIC and int.from_bytes(header[68:72]) == APPLICATION_ID


class StoreFile:
    """The opened file of a store, read only; any number of processes can have the same store open.

    The file is closed by :meth:`close`, or when nothing refers to the object any more. Opening and reading
    raise :class:`UserError` for a file that is no store, has another version of the format, is cut off or is
    damaged.
    """

    def __init__(self, file: Path) -> None:
        """Check the header of the file, open the file as a database, and check its tables."""
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
            self.raise_failure(error)

    def close(self) -> None:
        """Close the file; reading from it raises :class:`UserError` from then on."""
        self._closing()

    def rows(self, statement: str, ids: Iterable[int]) -> sqlite3.Cursor:
        """Run a statement, and return a cursor over its rows.

        In the statement, ``IN ids`` is true for the members of ``ids``.
        """
        in_list = "IN (SELECT value FROM json_each(?))"
        return self.database.execute(statement.replace("IN ids", in_list), (json.dumps([*ids]),))

    def about(self, name: str) -> Any:
        """Return the value with a name in the table ``about``, decoded from JSON.

        Raises :class:`TypeError` if the table does not have the name.
        """
        row = self.database.execute("SELECT value FROM about WHERE name = ?", (name,)).fetchone()
        return decode_json(row[0])

    def check_digest(self) -> None:
        """Read the whole file, and raise :class:`UserError` if it was changed after its import."""
        if not has_true_digest(self.file):
            (message,) = self.database.execute("PRAGMA quick_check(1)").fetchone()
            self.raise_damaged(
                "it was changed after the import" if message == "ok" else " ".join(message.split())
            )

    def raise_failure(self, error: BaseException) -> NoReturn:
        """Raise :class:`UserError` for an error while reading: the store was closed, or is damaged."""
        if not self._closing.alive:
            raise UserError(f"{self.file}: the store was closed; open it again to read from it") from None
        self.raise_damaged(str(error) or type(error).__name__)

    def raise_damaged(self, damage: str) -> NoReturn:
        """Raise :class:`UserError` for a damaged store; ``damage`` describes the damage."""
        raise UserError(f"{self.file}: the store is damaged ({damage}); import its source files again")

    def _check_header(self) -> None:
        """Raise :class:`UserError` for a file that is no store of this version, or is not of its stated size.

        This is checked before SQLite reads the file.
        """
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
            self.raise_damaged(f"it ends after {size} bytes")
        if int.from_bytes(header[68:72]) != APPLICATION_ID:
            raise UserError(f"{file}: is a database of another program, expected a store of foon-asp")
        version = int.from_bytes(header[60:64])
        if version < 1:
            self.raise_damaged(f"version {version} of the store format does not exist")
        if version != VERSION:
            newer = "use a newer foon-asp, or " if version > VERSION else ""
            raise UserError(
                f"{file}: has version {version} of the store format, this foon-asp reads version {VERSION}: "
                f"{newer}import its source files again"
            )
        page = int.from_bytes(header[16:18])
        expected = (65536 if page == 1 else page) * int.from_bytes(header[28:32]) + FILE_DIGEST
        if size != expected:
            self.raise_damaged(f"it has {size} bytes, expected {expected}")


class _Reading(Protocol):
    """A class that reads from the file of a store."""

    @property
    def file(self) -> StoreFile:
        """The file of the store."""


Reader = TypeVar("Reader", bound=_Reading)


def reporting_damage(
    read: Callable[Concatenate[Reader, Parameters], Value],
) -> Callable[Concatenate[Reader, Parameters], Value]:
    """Decorate a method so that it raises :class:`UserError` for a damaged store.

    Any error that comes from values of a wrong type, length or id counts as damage. A :class:`UserError` of
    the method stays as it is.
    """

    @functools.wraps(read)
    def guarded(reader: Reader, *positional: Parameters.args, **named: Parameters.kwargs) -> Value:
        """Call the method, and turn signs of damage into :class:`UserError`."""
        try:
            return read(reader, *positional, **named)
        except UserError:
            raise
        except _DAMAGE as error:
            reader.file.raise_failure(error)

    return guarded  # type: ignore[return-value]
