"""The parser of ``foon.lark``: of tables that were made of it beforehand, where this Lark can read them.

To make a parser of a grammar takes longer than to read some thousand lines with it.
"""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lark

GRAMMAR = Path(__file__).with_name("foon.lark")
TABLES = Path(__file__).with_name("foon.tables.json")  # `make tables`
OPTIONS: dict[str, Any] = {"start": ["lines", "node"], "parser": "lalr", "lexer": "contextual"}


def made_of() -> list[str]:
    """Say what tables are made of: which Lark, and which grammar."""
    return [lark.__version__, hashlib.sha256(GRAMMAR.read_bytes().replace(b"\r\n", b"\n")).hexdigest()]


def parser(transformer: lark.Transformer[lark.Token, object]) -> lark.Lark:
    """Give a parser of the grammar that hands what it reads to a transformer."""
    tables = json.loads(TABLES.read_text(encoding="ascii"), object_hook=_with_numbers)
    if tables["made_of"] == made_of():
        load: Callable[..., lark.Lark] = lark.Lark._load_from_dict
        return load(tables["data"], tables["memo"], transformer=transformer)
    return lark.Lark(GRAMMAR.read_text(encoding="utf-8"), transformer=transformer, **OPTIONS)


def _with_numbers(table: dict[str, Any]) -> dict[str | int, Any]:
    """Give a table with its numbers as keys again, which JSON has as text."""
    return {int(key) if key.isdecimal() else key: value for key, value in table.items()}
