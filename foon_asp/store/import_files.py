"""The import of files into a store. The store is written as a whole or not at all."""

import contextlib
import os
import sqlite3
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.file_permissions import copy_permissions, warn_of_replaced
from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.network import STARTING, FunctionalUnit, Source
from foon_asp.problem import unrated_remarks
from foon_asp.store.builder import StoreBuilder
from foon_asp.store.digests import append_digest
from foon_asp.store.store_file import is_store_database
from foon_asp.text.assumed_goals import LAST, MARKED, goal_entry
from foon_asp.text.data_folder import DataFiles, kitchen_item_warning, unit_price_warning
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.plain_file import STORE_MAGIC, STORE_SUFFIX, is_store
from foon_asp.text.reader import FoonReader
from foon_asp.text.repeated_node import repeated_note
from foon_asp.text.stated_amounts import apply_amount_table
from foon_asp.text.tables import RATES, read_utensils
from foon_asp.text.unit_amount_list import UNIT_AMOUNTS
from foon_asp.text.unit_price_list import read_unit_prices


class Imported(NamedTuple):
    """The result of an import.

    ``copies``: the number of units read.
    ``units``, ``objects``: the numbers of distinct units and object nodes.
    ``warnings``: the warnings about the files.
    ``left_out``: the number of lines that were not understood.
    ``remarks``: notes on motions without a success rate, and on nodes that a unit lists twice.
    """

    copies: int
    units: int
    objects: int
    warnings: tuple[Diagnostic, ...]
    left_out: int
    remarks: tuple[str, ...] = ()


def import_files(files: DataFiles, store: Path, lenient: bool = False) -> Imported:
    """Read networks and the files beside them into a store, which replaces an older one at the end.

    With ``lenient``, lines that are not understood are left out. Without a goals file, the store gets assumed
    goals. Entries of the kitchen that match no node, and prices and amounts that fit no unit, are warnings.
    Raises :class:`InputError` for input that is not understood. Raises :class:`UserError` if one of the
    networks is a store, or if the store cannot be written. It cannot be written if its name does not end in
    ``.foon``, if another process is writing it, or if it would replace a file that is no store.
    """
    if store.suffix != STORE_SUFFIX:
        raise UserError(f"{store}: the name of a store ends in {STORE_SUFFIX}")
    if store.exists() and not is_store_database(store):
        raise UserError(f"{store}: another file has this name; remove it or choose another name")
    reader = FoonReader(lenient)
    warnings = reader.diagnostics
    kitchen_file = files.kitchen if files.kitchen != STARTING else None
    kitchen = read_object_list(kitchen_file, warnings) if kitchen_file else None
    goals = read_object_list(files.goals, warnings) if files.goals else []
    rates = RATES.read(files.rates) if files.rates else None
    utensils = read_utensils(files.utensils) if files.utensils else None
    amount_rows = UNIT_AMOUNTS.rows(files.unit_amounts) if files.unit_amounts else []
    counted_motions = {row.name[0] for row in amount_rows}
    counted_units: dict[FunctionalUnit, None] = {}  # those with a motion of the table
    prices = read_unit_prices(files.unit_prices) if files.unit_prices else None
    earlier_warning_count = len(warnings)
    last_units: dict[int, Source] = {}
    try:
        with _new_database(store) as database, without_garbage_collection():
            builder = StoreBuilder(database, kitchen)
            for file in files.network:
                if is_store(file):
                    raise UserError(f"{file}: is a store already; merge the files that it was made from")
                last_unit: tuple[int, Source] | None = None
                for motion, inputs, outputs, sources, _ in reader.file_units(file):
                    unit_id = builder.add(motion, inputs, outputs, sources)
                    last_unit = (unit_id, sources[0]) if outputs else last_unit
                    if motion in counted_motions:
                        counted_units[FunctionalUnit.of(motion, inputs, outputs)] = None
                if last_unit:
                    last_units.setdefault(*last_unit)
            reader.raise_errors(earlier_warning_count)
            goals_from = ""
            if files.goals is None:
                goals, goals_from = _assumed_goals(reader, builder, last_units)
            stated = reader.prices.price_by_unit(prices.units if prices else {})
            for unit, source in prices.sources.items() if prices else ():
                if builder.unit_id(unit) is None:
                    warnings.append(unit_price_warning(unit, source))
            amounts, unmatched = apply_amount_table(
                reader.amounts.amounts_by_unit(), amount_rows, counted_units
            )
            warnings += unmatched
            counts = builder.copy_count, builder.unit_count, builder.object_count
            builder.finish(
                goals, goals_from, rates, utensils, reader.left_out, reader.repeated, amounts, stated, prices
            )
    except sqlite3.Error as error:
        raise UserError(f"{store}: cannot be written: {error}") from None
    except OSError as error:
        raise UserError(f"{store}: cannot be written: {error.strerror or error}") from None
    for entry, matched in zip(kitchen or (), builder.matched, strict=True):
        if not matched:
            warnings.append(kitchen_item_warning(entry))
    remarks = [] if rates is None else [*unrated_remarks(builder.motion_sources(), rates)]
    remarks += repeated_note(reader.repeated)
    return Imported(*counts, tuple(warnings), reader.left_out, tuple(remarks))


def _assumed_goals(
    reader: FoonReader, builder: StoreBuilder, last_units: Mapping[int, Source]
) -> tuple[list[ListedObject], str]:
    """Return the goals that are assumed without a goals file, and the name of their origin.

    They are the marked goals. If no goal is marked, they are the final outputs of ``last_units``.
    """
    if reader.marked:
        return [goal_entry(node, source) for node, source in reader.marked.items()], MARKED
    return builder.final_outputs(last_units), LAST


@contextlib.contextmanager
def _new_database(store: Path) -> Iterator[sqlite3.Connection]:
    """Yield a new database in one transaction; at a normal end it becomes the store.

    At this end, the transaction is committed and the digest is appended. Then the file of the database
    replaces ``store`` and gets its permissions. After an error, the file is removed. If this process is
    killed, a later import removes the file. Raises :class:`UserError` if another import is writing the store.
    """
    store = Path(os.path.realpath(store))  # a link stays one
    partial = store.with_name(f".{store.name}.partial")
    if partial.exists():
        _remove_leftover(partial, store)
    database = sqlite3.connect(partial, timeout=0, isolation_level=None)
    locked = False
    try:
        # No journal: until the file is renamed, nobody needs it.
        for setting in (
            "page_size = 4096",
            "cache_size = -100000",  # kilobytes
            "journal_mode = OFF",
            "synchronous = OFF",
            "locking_mode = EXCLUSIVE",
        ):
            database.execute(f"PRAGMA {setting}")
        _begin_exclusively(database, store)
        locked = True
        yield database
        database.execute("COMMIT")
        database.close()
        append_digest(partial)
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        replaced = None
        if store.exists():
            with store.open("rb+"):  # may it be written? Renaming asks the folder alone
                replaced = store.stat()
            copy_permissions(replaced, partial)
        partial.replace(store)
        if replaced is not None:
            warn_of_replaced(store, replaced)
    finally:
        database.close()
        if locked:
            partial.unlink(missing_ok=True)


def _remove_leftover(partial: Path, store: Path) -> None:
    """Remove the partial file of an import that was killed.

    Raises :class:`UserError` if another import is writing the file, or if it is no file of an import.
    """
    with partial.open("rb") as file:
        first_bytes = file.read(len(STORE_MAGIC))
    if first_bytes.strip(b"\0") and first_bytes != STORE_MAGIC:
        raise UserError(f"{partial}: is in the way, and is not left over from an import; move or remove it")
    database = sqlite3.connect(partial, timeout=0, isolation_level=None)
    # Cut off in the middle, it may be no database any more.
    with contextlib.closing(database), contextlib.suppress(sqlite3.DatabaseError):
        _begin_exclusively(database, store)
    partial.unlink(missing_ok=True)


def _begin_exclusively(database: sqlite3.Connection, store: Path) -> None:
    """Begin a transaction that excludes other processes; raises :class:`UserError` if one is writing."""
    try:
        database.execute("BEGIN EXCLUSIVE")
    except sqlite3.OperationalError as error:
        if error.sqlite_errorcode == sqlite3.SQLITE_BUSY:
            raise UserError(f"{store}: another import is writing it") from None
        raise
