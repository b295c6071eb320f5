"""Blocks: the rows of a store, each with a checksum of its own, so that no damage goes unseen."""

import json
from enum import StrEnum
from zlib import crc32

from foon_asp.text.json_value import read_json

APPLICATION_ID = 0x464F4F4E  # "FOON", in SQLite's header
VERSION = 7  # of what is in the tables; SQLite's user_version

_CHECKSUM = 4  # bytes in front of every block


class Table(StrEnum):
    """The tables of a store. Each has the columns ``number`` (from 0) and ``content``, a block.

    ``about``: counts, and what stands beside the network. ``unit``, ``node``, ``producers``, ``motion``,
    ``origin``, ``kitchen``, ``price``, ``starting``, ``file``: what belongs to the
    ids from ``number`` times :data:`SIZES` on.
    ``node_hash``: node ids by hash. ``label``: the labels in alphabetical order, with their first nodes.
    ``trigram``: places of labels by three letters of them. ``outline``: columns of bare numbers, see
    :class:`~foon_asp.store.outline.Column`.
    """

    ABOUT = "about"
    UNIT = "unit"
    NODE = "node"
    PRODUCERS = "producers"
    NODE_HASH = "node_hash"
    LABEL = "label"
    TRIGRAM = "trigram"
    MOTION = "motion"
    ORIGIN = "origin"
    KITCHEN = "kitchen"
    PRICE = "price"
    STARTING = "starting"
    FILE = "file"
    OUTLINE = "outline"


# How many values share a block: all of them are read to get one, and each block costs a row.
SIZES = {
    Table.UNIT: 16,
    Table.NODE: 16,
    Table.PRODUCERS: 64,
    Table.NODE_HASH: 64,  # on average
    Table.LABEL: 32,
    Table.TRIGRAM: 16,  # on average
    Table.MOTION: 64,
    Table.ORIGIN: 64,
    Table.KITCHEN: 64,
    Table.PRICE: 64,
    Table.STARTING: 256,
    Table.FILE: 16,
}

_encode = json.JSONEncoder(separators=(",", ":"), check_circular=False).encode


def seal(table: Table, number: int, value: object) -> bytes:
    """Write plain values (lists, dictionaries, strings, integers) as a block of a table."""
    return sealed(table, number, plain_text(value))


def sealed(table: Table, number: int, content: bytes) -> bytes:
    """Make a block of its content: values that are written as JSON without blanks, or a column of numbers."""
    return _checksum(table, number, content) + content


def plain_text(value: object) -> bytes:
    """Write plain values as JSON without blanks."""
    return _encode(value).encode("ascii")


def unseal(table: Table, number: int, block: object) -> object:
    """Give back what :func:`seal` wrote; raises :class:`ValueError` when this is not it."""
    return read_json(unsealed(table, number, block).decode("ascii"))


def unsealed(table: Table, number: int, block: object) -> bytes:
    """Give back what :func:`sealed` was given; raises :class:`ValueError` when this is not it."""
    if not isinstance(block, bytes) or block[:_CHECKSUM] != _checksum(table, number, block[_CHECKSUM:]):
        raise ValueError(f"block {number} of {table} does not agree with its checksum")
    return block[_CHECKSUM:]


def _checksum(table: Table, number: int, content: bytes) -> bytes:
    # The place is in it, so that a block which turns up elsewhere is none.
    return crc32(content, crc32(f"{table} {number}".encode("ascii"))).to_bytes(_CHECKSUM, "little")


def table_statement(table: Table) -> str:
    """Give the statement that makes a table, to the letter."""
    return f"CREATE TABLE {table} (number INTEGER PRIMARY KEY, content BLOB NOT NULL)"
