"""What blocks of a store look like inside: one with a fitting checksum may still have been made up."""

import re
from collections.abc import Callable
from fractions import Fraction
from itertools import chain
from typing import Any

from foon_asp.store.block import SIZES, Table

Shape = Callable[[Any], bool]

_GREATEST = 2**53  # of numbers: no store has as many of anything


def check_block(table: Table, number: int, value: object) -> None:
    """Raise :class:`ValueError` for a block that holds something else than its table does."""
    shape = _ABOUT[number] if table is Table.ABOUT and number < len(_ABOUT) else _SHAPES.get(table)
    if shape is None or not shape(value):
        raise ValueError(f"block {number} of {table} has unexpected content")


def _text(value: Any) -> bool:
    return type(value) is str


def _number(value: Any) -> bool:
    return type(value) is int and 0 <= value < _GREATEST


def _positive(value: Any) -> bool:
    return _number(value) and value > 0


def _flag(value: Any) -> bool:
    return type(value) is int and value in {0, 1}


def _numbers(value: Any) -> bool:
    return type(value) is list and _all_numbers(value)


def _all_numbers(values: list[Any]) -> bool:
    return not values or ({*map(type, values)} == {int} and min(values) >= 0 and max(values) < _GREATEST)


def _maybe(shape: Shape) -> Shape:
    return lambda value: value is None or shape(value)


def _list(shape: Shape) -> Shape:
    return lambda value: type(value) is list and all(map(shape, value))


def _row(*shapes: Shape, least: int | None = None) -> Shape:
    few = len(shapes) if least is None else least
    return lambda value: (
        type(value) is list
        and few <= len(value) <= len(shapes)
        and all(shape(each) for shape, each in zip(shapes, value, strict=False))
    )


def _block(table: Table, shape: Shape) -> Shape:
    every = _list(shape)
    return lambda value: every(value) and len(value) <= SIZES[table]


def _pairs(value: Any) -> bool:
    return _numbers(value) and len(value) % 2 == 0


# Of these three there are many blocks, and each is read for a few of its rows: what is in their lists is
# looked at together.


def _units(rows: Any) -> bool:
    """Rows of a motion, the inputs, the outputs, and three numbers for each place, at least one."""
    if type(rows) is not list or len(rows) > SIZES[Table.UNIT]:
        return False
    numbers: list[Any] = []
    for row in rows:
        if type(row) is not list or len(row) != 4:
            return False
        motion, *lists = row
        if not all(type(each) is list for each in lists) or not lists[2] or len(lists[2]) % 3:
            return False
        numbers.append(motion)
        numbers += chain.from_iterable(lists)
    return _all_numbers(numbers)


def _producers(rows: Any) -> bool:
    """Rows of units."""
    return (
        type(rows) is list
        and len(rows) <= SIZES[Table.PRODUCERS]
        and all(type(each) is list for each in rows)
        and _all_numbers([*chain.from_iterable(rows)])
    )


def _nodes(rows: Any) -> bool:
    """Rows of whether it is at hand and the label; then states, relations, contents, if there are any."""
    if type(rows) is not list or len(rows) > SIZES[Table.NODE]:
        return False
    texts: list[Any] = []
    for row in rows:
        if type(row) is not list or not 2 <= len(row) <= 5 or not _flag(row[0]):
            return False
        if any(type(each) is not list for each in row[2:]):
            return False
        states, relations, contents = (*row[2:], [], [], [])[:3]
        if any(type(pair) is not list or len(pair) != 2 for pair in (*relations, *contents)):
            return False
        if any(type(items) is not list for _, items in contents):
            return False
        texts += (row[1], *states, *chain.from_iterable(relations))
        for word, items in contents:
            texts += (word, *items)
    return {*map(type, texts)} <= {str}


def _by_trigram(value: Any) -> bool:
    return type(value) is dict and all(_numbers(each) or _number(each) for each in value.values())


def _rates(value: Any) -> bool:
    return type(value) is dict and all(map(_rate, value.values()))


def _rate(value: Any) -> bool:
    """A fraction from 0 to 1, 0 excluded, in digits."""
    return _price(value) and 0 < Fraction(value) <= 1


def _prices(value: Any) -> bool:
    return type(value) is dict and all(map(_price, value.values()))


def _price(value: Any) -> bool:
    """A fraction from 0, in digits."""
    if type(value) is not str or len(value) >= _DIGITS:
        return False
    found = _FRACTION.fullmatch(value)
    return found is not None and int(found[2] or "1") > 0


def _digests(value: Any) -> bool:
    return (
        type(value) is dict
        and value.keys() == {"network", "kitchen", "prices"}
        and all(type(each) is str and _SHA_256.fullmatch(each) for each in value.values())
    )


def _counts(value: Any) -> bool:
    return (
        type(value) is dict
        and value.keys() == _COUNTS.keys()
        and all(shape(value[name]) for name, shape in _COUNTS.items())
    )


_DIGITS = 4000  # of a rate or price; Python turns no more than 4,300 into a number
_FRACTION = re.compile("([0-9]+)(?:/([0-9]+))?")
_SHA_256 = re.compile("[0-9a-f]{64}")
_COUNTS: dict[str, Shape] = {
    **dict.fromkeys(("units", "objects", "labels", "motions", "origins", "left_out", "prices"), _number),
    **dict.fromkeys(("hash_blocks", "trigram_blocks"), _positive),
    "kitchen": _maybe(_number),
    "goals_from": _text,
    "repeated": _list(_row(_text, _text, _number, _number, _flag)),
}

_texts = _list(_text)
_relations = _list(_row(_text, _text))
_by_word = _list(_row(_text, _texts))


def _held(value: Any) -> bool:
    """Ingredients, or contents by word."""
    return _texts(value) or _by_word(value)


_entry = _row(_text, _texts, _held, _maybe(_text), _relations, _text, _number, _number)

_ABOUT: tuple[Shape, ...] = (
    _counts,
    _maybe(_rates),
    _maybe(_texts),
    _list(_entry),
    _numbers,
    _maybe(_prices),
    _digests,
)
_SHAPES: dict[Table, Shape] = {
    Table.UNIT: _units,
    Table.NODE: _nodes,
    Table.PRODUCERS: _producers,
    Table.NODE_HASH: _pairs,
    Table.LABEL: _block(Table.LABEL, _row(_text, _number, _numbers)),
    Table.TRIGRAM: _by_trigram,
    Table.MOTION: _block(Table.MOTION, _row(_text, _text, _number, _number, *[_number] * 4)),
    Table.ORIGIN: _block(Table.ORIGIN, _row(_text, _texts)),
    Table.KITCHEN: _block(Table.KITCHEN, _entry),
    Table.STARTING: _block(Table.STARTING, lambda value: _flag(value) or (_numbers(value) and bool(value))),
    Table.FILE: _block(Table.FILE, lambda value: _number(value) or _numbers(value)),
    Table.PRICE: _block(Table.PRICE, _maybe(_row(_maybe(_price), _maybe(_price)))),
}
