"""Networks in the neutral form: a unit on each line, as JSON with plain names.

``{"id": "drive a b", "inputs": ["at a"], "outputs": ["at b"], "price": 3}``: the id is the motion, and a name
is the label of an object node without states, to the letter; nothing in it is notation.
"""

import json
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.text.exact_number import read_price
from foon_asp.text.foon_json import FoonJson
from foon_asp.text.format import Dialect, Writer
from foon_asp.text.json_layout import on_one_line
from foon_asp.text.json_list import DECODER, JsonFaultError, JsonNumber, json_fault
from foon_asp.text.json_names import json_mentions
from foon_asp.text.json_object import check_keys, price_of, shown
from foon_asp.text.line import Mention, MotionLine, ObjectLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import NEUTRAL_SUFFIXES, not_utf_8, opened, split_lines, usual_line_end
from foon_asp.text.reading import Reading, told

if TYPE_CHECKING:
    from foon_asp.text.conversion_ids import Numbering

_NEEDED = {"id", "inputs", "outputs"}
_KEYS = {*_NEEDED, "price"}
_TOLD = 65_536  # bytes from one report of progress to the next


class NeutralUnit(NamedTuple):
    """One unit as its line has it; ``price`` is an exact decimal, empty where it has none."""

    id: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    price: str
    source: Source


class NeutralLines(FoonJson):
    """Neutral units, read line by line."""

    dialects = (Dialect.NEUTRAL,)
    suffix = NEUTRAL_SUFFIXES[0]

    def recognises(self, text: str, file: str) -> bool:
        """Whether the file is named as neutral ones are, or its first line is one of their units."""
        if file.endswith(NEUTRAL_SUFFIXES):
            return True
        start = len(text[:1_000]) - len(text[:1_000].lstrip("\ufeff \t\r\n"))
        line = text[start:].split("\n", 1)[0] if text[start : start + 1] == "{" else ""
        if '"outputs"' not in line:
            return False
        try:
            unit = json.loads(line, parse_int=str, parse_float=str)
        except (ValueError, RecursionError):
            return False
        return isinstance(unit, dict) and unit.keys() >= {"inputs", "outputs"} and "schema" not in unit

    def dialect(self, text: str) -> Dialect:
        """Return the neutral form."""
        return Dialect.NEUTRAL

    def lists_objects(self, text: str) -> bool:
        """Return false."""
        return False

    def file_units(self, file: Path, reading: Reading) -> Iterator[ReadUnit]:
        """Give the units of a file in order, a line at a time."""
        return _read_units(_lines_of(file), str(file), reading)

    def units(self, text: str, file: str, reading: Reading) -> Iterator[ReadUnit]:
        """Give the units of a text in order."""
        return _read_units(split_lines(text), file, reading)

    def listed_units(self, text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
        """Give the units of a text in order, with the lines that they would have."""
        for id_, *sides, price, source in read_neutral_units(split_lines(text), file, reading):
            inputs, outputs = (
                tuple(ObjectBlock(ObjectLine(name), (), source) for name in side) for side in sides
            )
            yield ListedUnit(MotionLine(id_), inputs, outputs, (source,), source, price)

    def normalised(self, text: str, file: str, lenient: bool = False) -> str:
        """Return each line laid out anew; one that cannot be understood stays if ``lenient``."""
        lines = split_lines(text.removeprefix("\ufeff"))
        reading = Reading(lenient)
        understood = {unit.source.line for unit in read_neutral_units(lines, file, reading)}
        reading.raise_errors()
        new = [on_one_line(line) if number in understood else line for number, line in enumerate(lines, 1)]
        if new[-1]:
            new.append("")
        return usual_line_end(text).join(new)

    def names(self, text: str, file: str) -> Iterator[Mention]:
        """Give every mention of a name."""
        return json_mentions(text)

    def writer(self, target: Dialect, numbering: "Numbering") -> Writer:
        """Return what writes a network, or a list of its names."""
        from foon_asp.text.neutral_writer import NeutralWriter  # noqa: PLC0415 (for conversions alone)

        return NeutralWriter()


def _read_units(lines: Iterable[str], file: str, reading: Reading) -> Iterator[ReadUnit]:
    """Give units with their nodes; of copies with prices, the cheapest counts."""
    nodes: dict[str, ObjectNode] = {}
    prices: dict[str, Fraction] = {}
    for id_, *sides, price, source in read_neutral_units(lines, file, reading):
        inputs, outputs = (
            [nodes.get(name) or nodes.setdefault(name, ObjectNode(name)) for name in side] for side in sides
        )
        if price:
            if price not in prices:
                prices[price] = read_price(price)
            reading.prices.add_least(FunctionalUnit.of(id_, inputs, outputs), prices[price])
        yield ReadUnit(id_, inputs, outputs, (source,))


def _lines_of(file: Path) -> Iterator[str]:
    """Give the lines of a file as they are asked for.

    Raises :class:`InputError` with line and column of the first byte that is not UTF-8.
    """
    tell, untold = told(), 0
    with opened(file) as lines:
        for number, line in enumerate(lines, 1):
            untold += len(line)
            if tell and untold >= _TOLD:
                tell(untold)
                untold = 0
            try:
                yield line.decode("utf-8-sig" if number == 1 else "utf-8")
            except UnicodeDecodeError as error:
                raise not_utf_8(line, error, file, number) from None
    if tell:
        tell(untold)


def read_neutral_units(lines: Iterable[str], file: str, reading: Reading) -> Iterator[NeutralUnit]:
    """Give the units in order; what there is to say about them is noted in ``reading``."""
    known: set[str] = set()  # names that are as they should be
    prices: dict[str, str] = {}  # without an exponent, by how they are written
    for number, line in enumerate(lines, 1):
        line = line.rstrip("\r\n")  # noqa: PLW2901 (a fault at the end is on this line)
        if line.isspace() or not line:
            continue
        try:
            unit = _unit(line, Source(file, number), known, prices)
        except _LineError as fault:
            reading.reject("json", str(fault), Source(file, number, fault.column), line)
            continue
        if not unit.outputs:
            reading.warn("no-outputs", f"the unit {unit.id!r} has no output objects", unit.source)
        yield unit


class _LineError(Exception):
    def __init__(self, message: str, column: int) -> None:
        super().__init__(message)
        self.column = column


def _unit(line: str, source: Source, known: set[str], prices: dict[str, str]) -> NeutralUnit:
    try:
        value = DECODER.decode(line)
    except json.JSONDecodeError as problem:
        found = json_fault(problem)
        raise _LineError(found.message, found.column) from None
    except JsonFaultError as fault:
        raise _LineError(str(fault), 1) from None
    except RecursionError:
        raise _LineError("found lists nested too deeply, expected a unit", 1) from None
    key = ""
    try:
        if not isinstance(value, dict) or not value.keys() >= _NEEDED:
            raise ValueError(f"found no unit, expected an object with {', '.join(sorted(_NEEDED))}")
        check_keys(value, _KEYS)
        key = "id"
        name = value[key]
        name = _name(name.text if isinstance(name, JsonNumber) else name, key)
        key = "inputs"
        inputs = _names(value[key], key, known)
        key = "outputs"
        outputs = _names(value[key], key, known)
        key = "price"
        price = value.get(key)
        if not isinstance(price, JsonNumber):
            return NeutralUnit(name, inputs, outputs, price_of(price), source)
        if price.text not in prices:
            prices[price.text] = price_of(price, exponents=True)
        return NeutralUnit(name, inputs, outputs, prices[price.text], source)
    except ValueError as problem:
        raise _LineError(str(problem), line.find(f'"{key}"') + 1 if key else 1) from None


def _names(value: object, key: str, known: set[str]) -> tuple[str, ...]:
    if not isinstance(value, list):
        raise ValueError(f'found {shown(value)} as "{key}", expected a list of names')
    for name in value:
        if not isinstance(name, str) or name not in known:
            known.add(_name(name, key))
    return tuple(value)


def _name(value: object, key: str) -> str:
    if not isinstance(value, str) or not value or value != value.strip(" "):
        raise ValueError(f'found {shown(value)} in "{key}", expected a name, without blanks around it')
    return value
