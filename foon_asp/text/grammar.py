"""The parser of ``foon.lark``: of tables that were made of it beforehand, where this Lark can read them.

To make a parser of a grammar takes longer than to read some thousand lines with it.
"""

import hashlib
import json
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:  # which often is not needed
    import lark

GRAMMAR = Path(__file__).with_name("foon.lark")
TABLES = Path(__file__).with_name("foon.tables.json")  # `make tables`
OPTIONS: dict[str, Any] = {"start": ["lines", "node"], "parser": "lalr", "lexer": "contextual"}


def made_of() -> list[str]:
    """Say what tables are made of: which Lark, and which grammar."""
    import lark  # noqa: PLC0415

    return [lark.__version__, _digest()]


def parser(transformer: "lark.Transformer[lark.Token, object] | None" = None) -> "lark.Lark":
    """Give a parser of the grammar that hands what it reads to a transformer."""
    import lark  # noqa: PLC0415

    tables = _tables()
    if tables["made_of"] == made_of():
        load: Callable[..., lark.Lark] = lark.Lark._load_from_dict
        return load(tables["data"], tables["memo"], transformer=transformer)
    return lark.Lark(GRAMMAR.read_text(encoding="utf-8"), transformer=transformer, **OPTIONS)


def patterns(names: Iterable[str]) -> dict[str, str]:
    """Give the regular expressions of tokens, by name: from the tables, if they are those of the grammar."""
    tables = _tables()
    if tables["made_of"][1] != _digest():
        made = parser()
        return {name: made.get_terminal(name).pattern.to_regexp() for name in names}
    values = {each["name"]: each["pattern"]["value"] for each in tables["memo"].values() if "pattern" in each}
    return {name: values[name] for name in names}


def _digest() -> str:
    return hashlib.sha256(GRAMMAR.read_bytes().replace(b"\r\n", b"\n")).hexdigest()


@cache
def _tables() -> dict[Any, Any]:
    found: dict[Any, Any] = json.loads(TABLES.read_text(encoding="ascii"), object_hook=_with_numbers)
    return found


def _with_numbers(table: dict[str, Any]) -> dict[str | int, Any]:
    """Give a table with its numbers as keys again, which JSON has as text."""
    return {int(key) if key.isdecimal() else key: value for key, value in table.items()}
