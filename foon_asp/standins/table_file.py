"""Files of stand-ins: prices of edits, and of pairs of labels or object nodes."""

import re
from collections.abc import Collection, Iterable, Sequence
from fractions import Fraction
from pathlib import Path

from foon_asp.network import Edit, ObjectNode, StandInTable
from foon_asp.text.line import LineError, NameKind
from foon_asp.text.tables import stated_name
from foon_asp.text.value_table import Row, Table

_NEVER = "never"
_NUMBER = re.compile(r"\d{1,6}(\.\d{1,3})?", re.ASCII)
_NAMED = (Edit.MORE_STATE, Edit.FEWER_STATE, Edit.MORE_INGREDIENT, Edit.FEWER_INGREDIENT)
_KINDS = (Edit.SPELLING, Edit.WORD, Edit.CONTAINER, *_NAMED, Edit.CONTENTS)

# a pair of serving and served names, an edit, or an edit of one state or ingredient
Entry = tuple[str | ObjectNode, str | ObjectNode] | Edit | tuple[Edit, str]


def read_stand_ins(
    files: Iterable[Path], similar: Iterable[Path] = (), utensils: Collection[str] = ()
) -> StandInTable:
    """Return the default table of prices, changed by files; a later file takes precedence.

    The files ``similar`` are lexicons, and are read before ``files``. Only their pairs are read. Pairs with a
    label in ``utensils`` are ignored, so a tool or vessel stands in only if one of ``files`` lists it. Raises
    :class:`InputError` if a file is malformed.
    """
    table = StandInTable.usual()
    for file in similar:
        pairs = (row for row in STAND_INS.rows(file) if isinstance(row.name, tuple))
        table = _update_table(table, [row for row in pairs if not _names_utensil(row.name, utensils)])
    for file in files:
        table = _update_table(table, STAND_INS.rows(file))
    return table


def _names_utensil(entry: Entry, utensils: Collection[str]) -> bool:
    """Return whether a pair of labels or nodes has a label in ``utensils``."""
    labels = {name.label if isinstance(name, ObjectNode) else name for name in entry}
    return not labels.isdisjoint(utensils)


def _update_table(table: StandInTable, rows: Sequence[Row[Entry, Fraction | None]]) -> StandInTable:
    """Return a copy of a table with the prices of rows; later rows take precedence."""
    edits, words, pairs = dict(table.edits), dict(table.words), dict(table.pairs)
    for name, price, _ in rows:
        if isinstance(name, Edit):
            edits[name] = price
        elif isinstance(name[0], Edit):
            words[name[0], str(name[1])] = price
        else:
            pairs[name[0], name[1]] = price
    return StandInTable(edits, words, pairs)


def _read_row(name: str, value: str, column: int) -> tuple[Entry, Fraction | None]:
    """Return the edit or pair of a row, and its price; the price is ``None`` for the word ``never``.

    ``name`` is the first column of the row. ``value`` is the text after it, which begins at ``column``. For a
    pair, ``value`` has the served name, a tab and the price. Raises :class:`LineError` if the row is
    malformed.
    """
    served, tab, written = value.rpartition("\t")
    price = _read_price(written.strip(), column + len(value) - len(written))
    if not tab:
        return _read_edit(name), price
    serving_name, served_name = stated_name(name), stated_name(served)
    if isinstance(serving_name, str) is not isinstance(served_name, str):
        raise LineError(column, "a label and an object node", ("two labels", "two object nodes"))
    if serving_name == served_name:
        raise LineError(column, "one name twice", ("the name of what it is used for",))
    return (serving_name, served_name), price


def _read_edit(name: str) -> Edit | tuple[Edit, str]:
    """Return the edit of a name such as ``word``; for ``more state: dirty``, a pair of edit and word.

    The word is the state or ingredient after the colon. Raises :class:`LineError` for other names.
    """
    edit_name, colon, word = (text.strip() for text in name.partition(":"))
    if edit_name not in (_NAMED if colon else _KINDS) or (colon and not word):
        known_edits = ", ".join(_KINDS)
        raise LineError(
            1, repr(name), (f"two names and a price between tabs, or a kind of edit ({known_edits})",)
        )
    return (Edit(edit_name), word) if colon else Edit(edit_name)


def _read_price(written: str, column: int) -> Fraction | None:
    """Return the price above 0 of a text, or ``None`` for ``never``; raise :class:`LineError` for others.

    A price has at most six digits before the point and three after it. ``column`` is where the text begins.
    """
    if written == _NEVER:
        return None
    price = Fraction(written) if _NUMBER.fullmatch(written) else Fraction(0)
    if not price:
        raise LineError(column, repr(written[:40]), ("a number above 0, such as 2 or 0.5", _NEVER))
    return price


STAND_INS: Table[Entry, Fraction | None] = Table(
    "stand-in", NameKind.OBJECT, "a number or never", _read_row, "a second price for {name!r}"
)
"""The format of rows: ``serving⇥served⇥2``, ``word⇥1`` or ``more state: dirty⇥never`` (⇥ is a tab)."""
