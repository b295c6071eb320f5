"""What is said of items that are used up: which of them stay, and of which there is a stock."""

import re
from pathlib import Path

from foon_asp.network import ObjectNode, Source
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name, parse_node
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.table_rows import read_rows

_FOON = re.compile(r"^(?:\ufeff)?O\d*[\t ]", re.MULTILINE)
_COUNT = re.compile(r"\d+", re.ASCII)
_STAYS = {"stays": True, "used-up": False}
_MOST = 1_000_000  # copies of a node: clingo's numbers are not without end


def read_stays(file: Path) -> dict[str | ObjectNode, bool]:
    """Read ``NAME⇥stays`` and ``NAME⇥used-up`` lines.

    A name is a label, which stands for all of its nodes, or a node in one-line notation; a semicolon behind
    it makes a name alone the node that has nothing but this label. Raises :class:`InputError` for a line of
    another form, and for a name of which both are said.
    """
    found: dict[str | ObjectNode, bool] = {}

    def read(name: str, value: str, _: Source) -> None:
        column = len(name) + 2
        if value not in _STAYS:
            raise LineError(column, repr(value), tuple(_STAYS))
        key = stated_name(name)
        if found.setdefault(key, _STAYS[value]) != _STAYS[value]:
            raise LineError(column, f"{value}, and the opposite above", ("one of them",))

    read_rows(file, "stays", "stays or used-up", read)
    return found


def read_stock(file: Path) -> dict[ObjectNode, int]:
    """Read ``NODE⇥count`` lines; or FOON text, in which each object block is one copy.

    Raises :class:`InputError` for a line of another form, and for a node with two different counts.
    """
    text = read_plain_text(file)
    found: dict[ObjectNode, int] = {}
    if _FOON.search(text):
        reader = FoonReader()
        blocks = reader.object_blocks(text, str(file))
        reader.raise_errors()
        for block in blocks:
            found[block.node] = found.get(block.node, 0) + 1
        return found

    def read(name: str, value: str, _: Source) -> None:
        column = len(name) + 2
        if not _COUNT.fullmatch(value) or len(value) > len(str(_MOST)) or int(value) > _MOST:
            raise LineError(column, repr(value), (f"a number of copies, from 0 to {_MOST}",))
        node = _node(name)
        if found.setdefault(node, int(value)) != int(value):
            raise LineError(column, f"a second count for {str(node)!r}", ("one",))

    read_rows(file, "stock", "a number of copies", read)
    return found


def stated_name(name: str) -> str | ObjectNode:
    """Read what somebody says stays or goes: a label, or a node; raises :class:`LineError`."""
    name = name.strip()
    if not name:
        raise LineError(1, "nothing", ("a label or an object node",))
    try:
        return parse_name(name)
    except LineError:
        if ";" in name or name.startswith('"'):
            raise
        return name  # a label as it is


def _node(name: str) -> ObjectNode:
    """Read a node in one-line notation."""
    return parse_node(name.strip())
