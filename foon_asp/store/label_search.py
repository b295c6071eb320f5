"""Search for labels of a store, by their beginning and by similarity."""

import sqlite3
from collections.abc import Iterable

from foon_asp.network.spelling import near_labels
from foon_asp.store.columns import decode_label, encode_label
from foon_asp.store.store_tables import TRIGRAMS
from foon_asp.store.tuning import STORE


def write_trigrams(database: sqlite3.Connection) -> None:
    """Fill the index of trigrams with all labels, each with a blank before and after it.

    Does nothing if the database has no such index, which SQLite can make only with FTS5.
    """
    if database.execute("SELECT 1 FROM sqlite_master WHERE sql = ?", (TRIGRAMS,)).fetchone():
        rows = database.execute("SELECT id, name FROM label")
        padded = ((number, f" {_searchable(decode_label(name))} ") for number, name in rows)
        database.executemany("INSERT INTO label_trigram (rowid, name) VALUES (?, ?)", padded)


def labels_beginning(database: sqlite3.Connection, start: str, max_labels: int) -> list[str]:
    """Return at most ``max_labels`` labels that begin with ``start``, in order; capitals come first."""
    statement = "SELECT name FROM label WHERE name >= ? ORDER BY name LIMIT ?"
    labels = _decode_labels(database.execute(statement, (encode_label(start), max_labels)))
    return [label for label in labels if label.startswith(start)]


def similar_labels(database: sqlite3.Connection, label: str, max_labels: int) -> list[str]:
    """Return at most ``max_labels`` labels similar to ``label``, the most similar first.

    At most :attr:`.StoreTuning.compared_labels` labels are compared: labels that share rare trigrams with
    ``label``. Without an index of trigrams, all labels are compared.
    """
    text = f" {_searchable(label).lower()} "
    trigrams = sorted({text[start : start + 3] for start in range(len(text) - 2)})
    query = " OR ".join('"' + trigram.replace('"', '""') + '"' for trigram in trigrams)
    ranked = "SELECT rowid FROM label_trigram WHERE label_trigram MATCH ? ORDER BY rank LIMIT ?"
    try:
        rows = database.execute(
            f"SELECT name FROM label WHERE id IN ({ranked}) ORDER BY name",
            (query or '""', STORE.compared_labels),
        ).fetchall()
    except sqlite3.OperationalError:  # no such table, module or tokenizer
        rows = database.execute("SELECT name FROM label ORDER BY name").fetchall()
    return near_labels(label, _decode_labels(rows), max_labels)


def _decode_labels(rows: Iterable[tuple[bytes]]) -> list[str]:
    """Return the labels in rows of one column."""
    return [decode_label(name) for (name,) in rows]


def _searchable(label: str) -> str:
    """Return a label without surrogates and NUL, which SQLite does not store in a text."""
    return encode_label(label).decode("utf-8", "replace").replace("\0", " ")
