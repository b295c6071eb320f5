"""The tables of a store, which is an SQLite database with a column for each value that is looked up."""

import contextlib
import sqlite3

APPLICATION_ID = 0x464F4F4E  # "FOON", in SQLite's header
VERSION = 10  # of the tables; SQLite's user_version

SCHEMA = (
    "CREATE TABLE about (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID",
    "CREATE TABLE label (id INTEGER PRIMARY KEY, name BLOB NOT NULL UNIQUE)",
    "CREATE TABLE node (id INTEGER PRIMARY KEY, label INTEGER NOT NULL, states TEXT NOT NULL, "
    "relations TEXT NOT NULL, contents TEXT NOT NULL, kitchen INTEGER NOT NULL, starting INTEGER NOT NULL)",
    "CREATE INDEX node_by_name ON node (label, states, relations)",
    "CREATE INDEX node_in_kitchen ON node (id) WHERE kitchen",
    "CREATE INDEX node_starting ON node (id) WHERE starting",
    "CREATE TABLE motion (id INTEGER PRIMARY KEY, name TEXT NOT NULL, first_unit INTEGER NOT NULL)",
    "CREATE TABLE unit (id INTEGER PRIMARY KEY, motion INTEGER NOT NULL, inputs TEXT NOT NULL, "
    "outputs TEXT NOT NULL)",
    "CREATE INDEX unit_without_outputs ON unit (motion) WHERE outputs = '[]'",
    "CREATE TABLE producer (node INTEGER, unit INTEGER, PRIMARY KEY (node, unit)) WITHOUT ROWID",
    "CREATE TABLE file (id INTEGER PRIMARY KEY, name TEXT NOT NULL)",
    "CREATE TABLE origin (id INTEGER PRIMARY KEY, file INTEGER NOT NULL, videos TEXT NOT NULL)",
    "CREATE TABLE source (unit INTEGER, copy INTEGER, origin INTEGER NOT NULL, line INTEGER NOT NULL, "
    '"column" INTEGER NOT NULL, PRIMARY KEY (unit, copy)) WITHOUT ROWID',
    'CREATE INDEX source_by_place ON source (origin, line, "column")',
    "CREATE TABLE granted (node INTEGER, file INTEGER, PRIMARY KEY (node, file)) WITHOUT ROWID",
    "CREATE TABLE kitchen_item (number INTEGER PRIMARY KEY, entry TEXT NOT NULL)",
    "CREATE TABLE price (unit INTEGER PRIMARY KEY, stated TEXT, listed TEXT)",
    "CREATE TABLE outline (name TEXT PRIMARY KEY, numbers BLOB NOT NULL)",
)
"""The statements that make the tables. Lists and names of any letters are JSON.

``about``: counts, and what stands beside the network, by name. ``label``: labels, in UTF-8. ``node``: object
nodes, and whether each is in the kitchen that was imported and in the starting kitchen. ``producer``: the
units that have a node among their outputs. ``origin``: a file with its videos; ``source``: where each copy of
a unit was read. ``granted``: the files by which a node is in the starting kitchen though a unit of the file
makes it. ``price``: what the networks state for a unit, and what the imported file of prices does.
``outline``: motions, inputs and outputs of all units once more, as 32-bit numbers, least byte first.
"""

TRIGRAMS = "CREATE VIRTUAL TABLE label_trigram USING fts5(name, content='', detail=none, tokenize='trigram')"
"""An index of labels by trigrams, three letters in a row; SQLite has it from 3.34 on, if built with FTS5."""

OUTLINE = ("motions", "input_counts", "inputs", "output_counts", "outputs")
"""The rows of the table ``outline``, each an array with the units in the order of ids.

``motions``: the motion of each unit. ``input_counts``, ``output_counts``: how many nodes each unit has.
``inputs``, ``outputs``: the nodes of all units, one unit after the other.
"""

UNITS_OF_FILE = (
    "SELECT unit.id, inputs, outputs FROM source JOIN origin ON origin.id = origin "
    'JOIN unit ON unit.id = unit WHERE file = ? ORDER BY line, "column", unit'
)
"""Selects id, inputs and outputs of the units of the file with a number, in its order, once for each copy."""

_SHADOWS = {f"label_trigram_{suffix}" for suffix in ("data", "idx", "docsize", "config")}  # FTS5's own tables


def create_tables(database: sqlite3.Connection) -> None:
    """Create the tables of a store in a new database, and its index of trigrams, but no other index.

    The index of trigrams is left out where SQLite lacks FTS5; then similar labels are found by a scan.
    """
    database.execute(f"PRAGMA application_id = {APPLICATION_ID}")
    database.execute(f"PRAGMA user_version = {VERSION}")
    for statement in SCHEMA:
        if not statement.startswith("CREATE INDEX"):
            database.execute(statement)
    if _has_trigrams():
        database.execute(TRIGRAMS)


def _has_trigrams() -> bool:
    """Whether this SQLite has FTS5 with trigrams; tried in a database in memory."""
    with contextlib.closing(sqlite3.connect(":memory:")) as database:
        try:
            database.execute(TRIGRAMS)
        except sqlite3.OperationalError:
            return False
    return True


def create_indexes(database: sqlite3.Connection) -> None:
    """Create the indexes of the filled tables, which is faster than updating them at each insertion."""
    for statement in SCHEMA:
        if statement.startswith("CREATE INDEX"):
            database.execute(statement)


def check_tables(database: sqlite3.Connection) -> None:
    """Raise :class:`ValueError` if the tables, indexes, views or triggers are not exactly those of a store.

    Any others could run code when the store is read.
    """
    database.execute("PRAGMA trusted_schema = OFF")
    rows = database.execute("SELECT type, name, sql FROM sqlite_master WHERE sql IS NOT NULL").fetchall()
    shadow_tables = [(kind, sql) for kind, name, sql in rows if name in _SHADOWS]
    statements = {sql for _, name, sql in rows if name not in _SHADOWS}
    computed = any(kind != "table" or " AS " in sql.upper() for kind, sql in shadow_tables)
    if (
        computed
        or statements - {TRIGRAMS} != set(SCHEMA)
        or len(rows) != len(statements) + len(shadow_tables)
    ):
        raise ValueError("its tables are not those of a store")
