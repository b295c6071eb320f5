"""Digests of a store: one of the whole file, and those of its contents, which certificates state."""

import hashlib
import sqlite3
from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import islice
from pathlib import Path

from foon_asp.store.columns import decode_label, encode_json, json_string
from foon_asp.store.tuning import STORE

FILE_DIGEST = hashlib.sha256().digest_size  # bytes behind the last page, which SQLite ignores


def append_digest(file: Path) -> None:
    """Append the SHA-256 digest of a database file to the file."""
    with file.open("rb+") as database:
        digest = hashlib.file_digest(database, "sha256").digest()
        database.seek(0, 2)
        database.write(digest)


def has_true_digest(file: Path) -> bool:
    """Whether the file of a store ends in the SHA-256 digest of all bytes before it."""
    digest, remaining, chunk_size = hashlib.sha256(), file.stat().st_size - FILE_DIGEST, 1 << 20
    with file.open("rb") as database:
        while remaining > 0 and (chunk := database.read(min(chunk_size, remaining))):
            digest.update(chunk)
            remaining -= len(chunk)
        return database.read() == digest.digest()


def content_digests(
    database: sqlite3.Connection,
    motions: Mapping[str, Fraction] | None,
    priced: Mapping[int, Fraction] | None,
) -> dict[str, str]:
    """Return the SHA-256 digests of ``network``, ``kitchen`` and ``prices`` in hexadecimal, by these names.

    They are equal to those of :meth:`foon_asp.proof.certificate_subject.Subject.digests`.

    ``motions``: the prices by motion, ``priced``: the prices of single units by id; ``None`` for prices that
    do not exist.
    """

    def column(statement: str) -> Iterable[str]:
        """Yield the values of the single column that a statement selects."""
        return (text for (text,) in database.execute(statement))

    labels = [
        json_string(decode_label(name)) for (name,) in database.execute("SELECT name FROM label ORDER BY id")
    ]
    rows = database.execute("SELECT label, states, relations, contents FROM node ORDER BY id")
    nodes = (
        f"[{labels[label]},{states},{relations},{contents}]" for label, states, relations, contents in rows
    )
    units = "FROM unit ORDER BY unit.id"
    network: tuple[Iterable[str], ...] = (
        nodes,
        column("SELECT name FROM unit JOIN motion ON motion.id = unit.motion ORDER BY unit.id"),
        column(f"SELECT inputs {units}"),
        column(f"SELECT outputs {units}"),
    )
    prices = "null"
    if motions is not None or priced is not None:
        sorted_unit_prices = ([unit, str(price)] for unit, price in sorted((priced or {}).items()))
        prices = encode_json(
            [sorted([motion, str(price)] for motion, price in (motions or {}).items()), [*sorted_unit_prices]]
        )
    return {
        "network": _digest_of_lists("3", *network),
        "kitchen": hashlib.sha256(
            f"[{','.join(map(str, column('SELECT id FROM node WHERE kitchen ORDER BY id')))}]".encode()
        ).hexdigest(),
        "prices": hashlib.sha256(prices.encode()).hexdigest(),
    }


def _digest_of_lists(level: str, *lists: Iterable[str]) -> str:
    """Return the SHA-256 digest of a list in JSON: a level, then one list for each of ``lists``.

    The members of ``lists`` are texts in JSON. They are joined in batches, so that a long list is never in
    memory as one text.
    """
    digest = hashlib.sha256(f"[{level}".encode())
    for members in lists:
        unread = iter(members)
        comma = ",["
        while batch := [*islice(unread, STORE.digest_texts)]:
            digest.update(f"{comma}{','.join(batch)}".encode("ascii"))
            comma = ","
        digest.update(b"]" if comma == "," else b",[]")
    digest.update(b"]")
    return digest.hexdigest()
