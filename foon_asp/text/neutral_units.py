"""Networks in the neutral form: a unit on each line, as JSON with plain names.

``{"id": "drive a b", "inputs": ["at a"], "outputs": ["at b"], "price": 3}``: the id is the motion, and a name
is the label of an object node without states, to the letter; nothing in it is notation.
"""

import json
from collections.abc import Iterable, Iterator
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.exact_number import LONGEST, read_price
from foon_asp.text.json_fault import json_fault
from foon_asp.text.json_list import DECODER, JsonFaultError, JsonNumber
from foon_asp.text.json_object import check_keys, shown
from foon_asp.text.json_value import json_line
from foon_asp.text.line import LineError
from foon_asp.text.plain_file import not_utf_8, opened
from foon_asp.text.reading import told

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


def lines_of(file: Path) -> Iterator[str]:
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


def read_neutral_units(
    lines: Iterable[str], file: str, diagnostics: list[Diagnostic], lenient: bool
) -> Iterator[NeutralUnit]:
    """Give the units in order; what is wrong goes to ``diagnostics``, under ``lenient`` as warnings."""
    severity, ending = (Severity.WARNING, "; left out") if lenient else (Severity.ERROR, "")
    known: set[str] = set()  # names that are as they should be
    prices: dict[str, str] = {}  # without an exponent, by how they are written
    for number, line in enumerate(lines, 1):
        line = line.rstrip("\r\n")  # noqa: PLW2901 (a fault at the end is on this line)
        if line.isspace() or not line:
            continue
        try:
            unit = _unit(line, Source(file, number), known, prices)
        except _LineError as fault:
            place = Source(file, number, fault.column)
            message = f"{fault}{ending}"
            diagnostics.append(Diagnostic(severity, "json", message, place, line))
            continue
        if not unit.outputs:
            message = f"the unit {unit.id!r} has no output objects"
            diagnostics.append(Diagnostic(Severity.WARNING, "no-outputs", message, unit.source))
        yield unit


def write_neutral_unit(id_: str, inputs: Iterable[str], outputs: Iterable[str], price: str) -> str:
    """Write a unit as one line."""
    needs, gives = (", ".join(map(json_line, side)) for side in (inputs, outputs))
    last = f', "price": {Decimal(price):f}' if price else ""
    return f'{{"id": {json_line(id_)}, "inputs": [{needs}], "outputs": [{gives}]{last}}}\n'


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
            return NeutralUnit(name, inputs, outputs, "" if price is None else _price(price), source)
        if price.text not in prices:
            prices[price.text] = _price(price)
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


def _price(value: object) -> str:
    """Give a price without an exponent; a number in JSON may have one."""
    written = value.text if isinstance(value, JsonNumber) else value
    if not isinstance(written, str):
        raise ValueError('found no number as "price", expected a price from 0, as a decimal such as 1.99')
    if isinstance(value, JsonNumber) and "e" in written.lower():
        number = Decimal(written)
        if abs(number.adjusted()) + len(written) >= LONGEST:
            raise ValueError(f'found {written[:40]!r} as "price", expected one of at most {LONGEST} letters')
        written = f"{number:f}"
    try:
        read_price(written)
    except LineError as error:
        raise ValueError(f'in "price": {error}') from None
    return written
