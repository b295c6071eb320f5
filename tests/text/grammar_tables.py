"""Makes ``foon_asp/text/foon.tables.json``, which has to be made anew after each change of the grammar.

``make tables``, or ``PYTHONHASHSEED=0 python -m tests.text.grammar_tables``: states are numbered by chance.
"""

import json

from lark import Lark
from lark.grammar import Rule
from lark.lexer import TerminalDef

from foon_asp.text.grammar import GRAMMAR, OPTIONS, TABLES, made_of


def tables() -> str:
    """Give the text of the file, made as Lark's own tool for parsers without a grammar does."""
    made = Lark(GRAMMAR.read_text(encoding="utf-8"), **OPTIONS)
    data, memo = made.memo_serialize([TerminalDef, Rule])
    return json.dumps({"made_of": made_of(), "data": data, "memo": memo}, separators=(",", ":")) + "\n"


if __name__ == "__main__":
    TABLES.write_text(tables(), encoding="ascii")
