"""The file of a store: what is a store, is it whole, and its blocks."""

import os
import sqlite3
import weakref
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from foon_asp.errors import UserError
from foon_asp.store.block import APPLICATION_ID, SIZES, VERSION, Table, table_statement, unseal, unsealed
from foon_asp.store.block_shape import check_block
from foon_asp.text.plain_file import STORE_MAGIC, read_beginning

_HEADER = 100  # bytes; https://www.sqlite.org/fileformat2.html says what is where

Value = TypeVar("Value")


def is_database_of_ours(file: Path) -> bool:
    """Whether a file begins like a store of any version, whole or not."""
    header = read_beginning(file, _HEADER)
    return header[: len(STORE_MAGIC)] == STORE_MAGIC and int.from_bytes(header[68:72]) == APPLICATION_ID


class StoreFile:
    """An opened store, read only. Any number of processes can have one open, and it is never written.

    It is closed by :meth:`close`, or when nothing refers to it any more. Raises :class:`UserError`, here and
    at every block, for a file that is no store, was made by a newer program, is cut off or damaged. Every
    block that is read is compared with its checksum.
    """

    def __init__(self, file: Path) -> None:
        self.file = file
        self._blocks: dict[Table, dict[int, Any]] = {table: {} for table in Table}
        self._check_header()
        try:
            # immutable: no locks, no files beside it. Who holds it open keeps what an import replaces.
            uri = f"{file.absolute().as_uri()}?mode=ro&immutable=1"
            self._database = sqlite3.connect(uri, uri=True, isolation_level=None, check_same_thread=False)
        except sqlite3.Error as error:
            raise UserError(f"{file}: cannot be read: {error}") from None
        self._closing = weakref.finalize(self, self._database.close)
        self._guarded(self._check_tables)

    def close(self) -> None:
        """Close the file; blocks that were read stay, and to read another raises :class:`UserError`."""
        self._closing()

    def block(self, table: Table, number: int) -> Any:
        """Give a block, which is not to be changed."""
        known = self._blocks[table]
        found = known.get(number)
        if found is None:
            content = self._content(table, number)
            found = known[number] = self._guarded(lambda: _opened(table, number, content))
        return found

    def column(self, number: int) -> bytes:
        """Read a column of the outline."""
        content = self._content(Table.OUTLINE, number)
        return self._guarded(lambda: unsealed(Table.OUTLINE, number, content))

    def values(self, table: Table) -> Callable[[int], Any]:
        """Make a function that gives what a table has under a number, among others in a block."""
        known, size = self._blocks[table], SIZES[table]

        def value(number: int) -> Any:
            values = known.get(number // size)
            if values is None:
                values = self.block(table, number // size)
            place = number % size
            if place >= len(values):
                self.damaged(f"number {number} of {table} is missing")
            return values[place]

        return value

    def blocks(self, table: Table) -> Iterator[Any]:
        """Give all blocks of a table in order, and keep none of them."""
        rows = self._guarded(lambda: self._database.execute(f"SELECT * FROM {table} ORDER BY number"))
        number = 0
        while (row := self._guarded(rows.fetchone)) is not None:
            if row[0] != number:
                self.damaged(f"block {number} of {table} is missing")
            yield self._guarded(lambda row=row: _opened(table, row[0], row[1]))  # type: ignore[misc]
            number += 1

    def damaged(self, what: str) -> NoReturn:
        """Say that the store is of no use."""
        raise UserError(f"{self.file}: the store is damaged ({what}); import its source files again")

    def _content(self, table: Table, number: int) -> object:
        statement = f"SELECT content FROM {table} WHERE number = ?"
        row = self._guarded(lambda: self._database.execute(statement, (number,)).fetchone())
        if row is None:
            self.damaged(f"block {number} of {table} is missing")
        found: object = row[0]
        return found

    def _guarded(self, read: Callable[[], Value]) -> Value:
        if not self._closing.alive:
            raise UserError(f"{self.file}: the store was closed; open it again to read from it")
        # MemoryError and OverflowError: lengths that are none; ValueError: names and checksums.
        try:
            return read()
        except (sqlite3.Error, MemoryError, OverflowError, ValueError) as error:
            self.damaged(str(error) or type(error).__name__)

    def _check_tables(self) -> None:
        """Refuse a database with anything in it but our tables: a view or trigger runs what it likes."""
        self._database.execute("PRAGMA trusted_schema = OFF")
        found = self._database.execute("SELECT type, name, tbl_name, sql FROM sqlite_master").fetchall()
        ours = {("table", table.value, table.value, table_statement(table)) for table in Table}
        if len(found) != len(ours) or set(found) != ours:
            raise ValueError("its tables are not those of a store")

    def _check_header(self) -> None:
        """Refuse what is no store of ours, before SQLite looks at it."""
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
        if version > VERSION:
            raise UserError(
                f"{file}: has version {version} of the store format, this foon-asp reads version {VERSION}: "
                "use a newer foon-asp, or import its source files again"
            )
        if version < 1:
            self.damaged(f"version {version} of the store format does not exist")
        if version != VERSION:
            raise UserError(
                f"{file}: has version {version} of the store format, this foon-asp reads version {VERSION}: "
                "import its source files again"
            )
        page = int.from_bytes(header[16:18])
        expected = (65536 if page == 1 else page) * int.from_bytes(header[28:32])
        if size != expected:
            self.damaged(f"it has {size} bytes, expected {expected}")


def _opened(table: Table, number: int, block: object) -> object:
    """Give what is in a block; raises :class:`ValueError` where it is not what its table holds."""
    value = unseal(table, number, block)
    check_block(table, number, value)
    return value
