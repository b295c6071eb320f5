"""The labels of a store: by how they begin, and by what they are like."""

import sqlite3
from collections.abc import Iterable

from foon_asp.network.spelling import near_labels
from foon_asp.store.columns import decoded_label, encoded_label
from foon_asp.store.schema import TRIGRAMS

_COMPARED = 300  # labels that share most letters with one, compared with it in full


def write_trigrams(database: sqlite3.Connection) -> None:
    """Fill the index of trigrams, where SQLite has it, with all labels and a blank before and after each."""
    if database.execute("SELECT 1 FROM sqlite_master WHERE sql = ?", (TRIGRAMS,)).fetchone():
        rows = database.execute("SELECT id, name FROM label")
        padded = ((number, f" {_searchable(decoded_label(name))} ") for number, name in rows)
        database.executemany("INSERT INTO label_trigram (rowid, name) VALUES (?, ?)", padded)


def labels_beginning(database: sqlite3.Connection, start: str, most: int) -> list[str]:
    """Return at most ``most`` labels that begin with ``start``, in alphabetical order."""
    statement = "SELECT name FROM label WHERE name >= ? ORDER BY name LIMIT ?"
    found = _labels(database.execute(statement, (encoded_label(start), most)))
    return [label for label in found if label.startswith(start)]


def similar_labels(database: sqlite3.Connection, label: str, most: int) -> list[str]:
    """Return labels similar to one, the most similar first, of those that share rare trigrams with it.

    Where SQLite has no trigrams, or the import had none, all labels are compared.
    """
    text = f" {_searchable(label).lower()} "
    trigrams = sorted({text[at : at + 3] for at in range(len(text) - 2)})
    wanted = " OR ".join('"' + trigram.replace('"', '""') + '"' for trigram in trigrams)
    ranked = "SELECT rowid FROM label_trigram WHERE label_trigram MATCH ? ORDER BY rank LIMIT ?"
    try:
        rows = database.execute(
            f"SELECT name FROM label WHERE id IN ({ranked}) ORDER BY name", (wanted or '""', _COMPARED)
        ).fetchall()
    except sqlite3.OperationalError:  # no such table, module or tokenizer
        rows = database.execute("SELECT name FROM label ORDER BY name").fetchall()
    return near_labels(label, _labels(rows), most)


def _labels(rows: Iterable[tuple[bytes]]) -> list[str]:
    return [decoded_label(name) for (name,) in rows]


def _searchable(label: str) -> str:
    """Return a label without halves of letters and the end of a text, which SQLite does not take."""
    return encoded_label(label).decode("utf-8", "replace").replace("\0", " ")
