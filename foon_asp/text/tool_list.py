"""How many there are of tools and vessels: a label or an object node, and a number, on each line."""

import re
from pathlib import Path

from foon_asp.network import ObjectNode, Source
from foon_asp.text.item_list import stated_name
from foon_asp.text.line import LineError
from foon_asp.text.table_rows import read_rows

_COUNT = re.compile(r"[1-9]\d{0,5}", re.ASCII)
_FREE = "free"


def read_tools(file: Path) -> dict[str | ObjectNode, int | None]:
    """Read ``NAME⇥count`` and ``NAME⇥free`` lines; ``None`` is for what is free.

    A name is a label, or a node in one-line notation, which a semicolon behind a name alone makes it. Raises
    :class:`InputError` for a line of another form, and for a name of which two things are said.
    """
    found: dict[str | ObjectNode, int | None] = {}

    def read(name: str, value: str, _: Source) -> None:
        column = len(name) + 2
        if value != _FREE and not _COUNT.fullmatch(value):
            raise LineError(column, repr(value), ("a number from 1", _FREE))
        count = None if value == _FREE else int(value)
        if found.setdefault(stated_name(name), count) != count:
            raise LineError(column, f"{value}, and something else above", ("one of them",))

    read_rows(file, "tool", f"a number from 1, or {_FREE},", read)
    return found
