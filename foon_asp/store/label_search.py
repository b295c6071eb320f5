"""Search of the labels of a store, by prefix and by similarity."""

import sqlite3
from collections.abc import Iterable

from foon_asp.network.spelling import near_labels
from foon_asp.store.columns import decoded_label, encoded_label
from foon_asp.store.store_tables import TRIGRAMS
from foon_asp.store.tuning import STORE


def write_trigrams(database: sqlite3.Connection) -> None:
    """Fill the index of trigrams, where SQLite has it, with all labels and a blank before and after each."""
    if database.execute("SELECT 1 FROM sqlite_master WHERE sql = ?", (TRIGRAMS,)).fetchone():
        rows = database.execute("SELECT id, name FROM label")
        padded = ((number, f" {_searchable(decoded_label(name))} ") for number, name in rows)
        database.executemany("INSERT INTO label_trigram (rowid, name) VALUES (?, ?)", padded)


def labels_beginning(database: sqlite3.Connection, start: str, max_labels: int) -> list[str]:
    """Return at most ``max_labels`` labels that begin with ``start``, in alphabetical order."""
    statement = "SELECT name FROM label WHERE name >= ? ORDER BY name LIMIT ?"
    labels = _labels(database.execute(statement, (encoded_label(start), max_labels)))
    return [label for label in labels if label.startswith(start)]


def similar_labels(database: sqlite3.Connection, label: str, max_labels: int) -> list[str]:
    """Return labels similar to one, the most similar first, among those that share rare trigrams with it.

    Where SQLite has no trigrams, or the import had none, all labels are compared.
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
    return near_labels(label, _labels(rows), max_labels)


def _labels(rows: Iterable[tuple[bytes]]) -> list[str]:
    return [decoded_label(name) for (name,) in rows]


def _searchable(label: str) -> str:
    """Return a label without surrogates and NUL, which SQLite does not store in a text."""
    return encoded_label(label).decode("utf-8", "replace").replace("\0", " ")
