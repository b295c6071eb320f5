"""Networks in the neutral form: a unit on each line, as JSON with plain names.

An example is ``{"id": "drive a b", "inputs": ["at a"], "outputs": ["at b"], "price": 3}``. The id is the
motion. A name is the label of an object node without states, and is never read as notation. A side may also
be an object of amounts by name, ``{"plank": 2}``. A name that is listed twice means two copies.
"""

import json
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.network import FunctionalUnit, ObjectNode, Source, UnitAmounts
from foon_asp.text.exact_number import read_price
from foon_asp.text.foon_json import FoonJson
from foon_asp.text.foon_json_indent import on_one_line
from foon_asp.text.format import Dialect, Writer
from foon_asp.text.json_list import DECODER, JsonFaultError, JsonNumber, json_fault
from foon_asp.text.json_names import json_mentions
from foon_asp.text.json_object import amount_from_json, check_keys, excerpt_of, price_from_json
from foon_asp.text.line import Mention, MotionLine, ObjectLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock, ReadUnit
from foon_asp.text.plain_file import NEUTRAL_SUFFIXES, not_utf_8, open_bytes, split_lines, usual_line_end
from foon_asp.text.reading import REPORT_BYTES, Reading, progress_report

if TYPE_CHECKING:
    from foon_asp.text.conversion_ids import Numbering

_NEEDED = {"id", "inputs", "outputs"}
_KEYS = {*_NEEDED, "price"}


class NeutralLines(FoonJson):
    """The neutral form, in which each line is a unit and is read on its own."""

    dialects = (Dialect.NEUTRAL,)
    suffix = NEUTRAL_SUFFIXES[0]

    def recognises(self, text: str, file: str) -> bool:
        """Whether the file has a suffix of neutral files, or the first line of the text is a neutral unit.

        A line with a key ``schema`` is a document of foon-asp, and no unit.
        """
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
        """Return ``NEUTRAL``, the only dialect."""
        return Dialect.NEUTRAL

    def lists_objects(self, text: str) -> bool:
        """Return false, since neutral files have units only."""
        return False

    def file_units(self, file: Path, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a file in order, read line by line; prices are recorded in ``reading``."""
        return _record_prices(_units_and_prices(_read_lines(file), str(file), reading), reading)

    def units(self, text: str, file: str, reading: Reading) -> Iterator[ReadUnit]:
        """Yield the units of a text in order; prices are recorded in ``reading``."""
        return _record_prices(_units_and_prices(split_lines(text), file, reading), reading)

    def listed_units(self, text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
        """Yield the units of a text in order, with the lines that they would have in FOON text.

        Prices are in the units alone, and are not recorded in ``reading``.
        """
        for unit, price in _units_and_prices(split_lines(text), file, reading):
            inputs, outputs = (
                tuple(
                    ObjectBlock(ObjectLine(node.label), (), unit.source, amounts.get(node, 1))
                    for node in nodes
                )
                for nodes, amounts in zip((unit.inputs, unit.outputs), unit.amounts, strict=True)
            )
            yield ListedUnit(MotionLine(unit.motion), inputs, outputs, unit.sources, unit.source, price)

    def canonical_text(self, text: str, file: str, lenient: bool = False) -> str:
        """Return the text with each unit laid out anew, with a blank behind each comma and colon.

        All lines get the most frequent line end, also the last one. A byte order mark is removed. Raises
        :class:`InputError` for lines that cannot be understood; if ``lenient``, they stay unchanged.
        """
        lines = split_lines(text.removeprefix("\ufeff"))
        reading = Reading(lenient)
        understood_lines = {unit.source.line for unit, _ in _units_and_prices(lines, file, reading)}
        reading.raise_errors()
        new_lines = [
            on_one_line(line) if number in understood_lines else line for number, line in enumerate(lines, 1)
        ]
        if new_lines[-1]:
            new_lines.append("")
        return usual_line_end(text).join(new_lines)

    def mentions(self, text: str, file: str) -> Iterator[Mention]:
        """Yield every mention of a name; faulty lines are not noticed."""
        return json_mentions(text)

    def writer(self, target: Dialect, numbering: "Numbering") -> Writer:
        """Return a writer of networks and of lists of objects; ``numbering`` is not used."""
        from foon_asp.text.neutral_writer import NeutralWriter  # noqa: PLC0415 (only for conversions)

        return NeutralWriter()


def _record_prices(units: Iterable[tuple[ReadUnit, str]], reading: Reading) -> Iterator[ReadUnit]:
    """Yield the units, and record their prices in ``reading``; if units are equal, the least price counts."""
    cached_read_price = cache(read_price)
    for unit, price in units:
        if price:
            copy = FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs)
            reading.prices.add_least(copy, cached_read_price(price))
        yield unit


def _read_lines(file: Path) -> Iterator[str]:
    """Yield the lines of a file with their line ends, lazily; progress is reported.

    Raises :class:`InputError` with line and column of the first byte that is not UTF-8.
    """
    report, unreported = progress_report(), 0
    with open_bytes(file) as lines:
        for number, line in enumerate(lines, 1):
            unreported += len(line)
            if report and unreported >= REPORT_BYTES:
                report(unreported)
                unreported = 0
            try:
                yield line.decode("utf-8-sig" if number == 1 else "utf-8")
            except UnicodeDecodeError as error:
                raise not_utf_8(line, error, file, number) from None
    if report:
        report(unreported)


def _units_and_prices(lines: Iterable[str], file: str, reading: Reading) -> Iterator[tuple[ReadUnit, str]]:
    """Yield the units in order, each with its price: an exact decimal text, or an empty text.

    Faulty lines are recorded in ``reading`` and left out. Blank lines are skipped. A unit without outputs
    causes a warning.
    """
    nodes: dict[str, ObjectNode] = {}
    for number, line in enumerate(lines, 1):
        line = line.rstrip("\r\n")  # noqa: PLW2901 (a fault at the end is on this line)
        if line.isspace() or not line:
            continue
        try:
            unit, price = _unit_and_price(line, Source(file, number), nodes)
        except _NeutralFaultError as fault:
            reading.reject("json", str(fault), Source(file, number, fault.column), line)
            continue
        if not unit.outputs:
            reading.warn("no-outputs", f"the unit {unit.motion!r} has no output objects", unit.source)
        yield unit, price


class _NeutralFaultError(Exception):
    """A fault of a neutral line, and its column, from 1."""

    def __init__(self, message: str, column: int) -> None:
        super().__init__(message)
        self.column = column


def _unit_and_price(line: str, source: Source, nodes: dict[str, ObjectNode]) -> tuple[ReadUnit, str]:
    """Return the unit of a line, and its price: an exact decimal text, or an empty text.

    ``nodes`` has the nodes read so far, by name; new nodes are added. Raises :class:`_NeutralFaultError` for
    a line of another form.
    """
    try:
        value = DECODER.decode(line)
    except json.JSONDecodeError as error:
        syntax_fault = json_fault(error)
        raise _NeutralFaultError(syntax_fault.message, syntax_fault.column) from None
    except JsonFaultError as fault:
        raise _NeutralFaultError(str(fault), 1) from None
    except RecursionError:
        raise _NeutralFaultError("found lists nested too deeply, expected a unit", 1) from None
    key = ""
    try:
        if not isinstance(value, dict) or not value.keys() >= _NEEDED:
            raise ValueError(f"found no unit, expected an object with {', '.join(sorted(_NEEDED))}")
        check_keys(value, _KEYS)
        key = "id"
        name = value[key]
        name = _checked_name(name.text if isinstance(name, JsonNumber) else name, key)
        key = "inputs"
        inputs, input_amounts = _nodes_and_amounts(value[key], key, nodes)
        key = "outputs"
        outputs, output_amounts = _nodes_and_amounts(value[key], key, nodes)
        key = "price"
        price = value.get(key)
        written = _price_of_number(price.text) if isinstance(price, JsonNumber) else price_from_json(price)
        return ReadUnit(name, inputs, outputs, (source,), UnitAmounts(input_amounts, output_amounts)), written
    except ValueError as error:
        raise _NeutralFaultError(str(error), line.find(f'"{key}"') + 1 if key else 1) from None


@lru_cache(10_000)
def _price_of_number(written: str) -> str:
    """Return the price that a JSON number states, as a decimal without exponent.

    Raises :class:`ValueError` for a number that is no price. Results are cached.
    """
    return price_from_json(JsonNumber(written), exponents=True)


def _nodes_and_amounts(
    value: object, key: str, nodes: dict[str, ObjectNode]
) -> tuple[list[ObjectNode], dict[ObjectNode, int]]:
    """Return the nodes of a side of a unit, each once, and the amounts above 1.

    The side is a list of names, or an object of amounts by name. A name that is listed n times has the amount
    n. ``nodes`` has the nodes read so far, by name; new nodes are added. Raises :class:`ValueError`, which
    names ``key``, for a side of another form.
    """
    if not isinstance(value, list | dict):
        raise ValueError(
            f'found {excerpt_of(value)} as "{key}", expected a list of names, or amounts by name'
        )
    amounts: dict[ObjectNode, int] = {}
    for name in value:
        if not isinstance(name, str) or name not in nodes:
            nodes[name] = ObjectNode(_checked_name(name, key))
        amount = amount_from_json(value[name]) if isinstance(value, dict) else 1
        amounts[nodes[name]] = amounts.get(nodes[name], 0) + amount
    return list(amounts), {node: amount for node, amount in amounts.items() if amount > 1}


def _checked_name(value: object, key: str) -> str:
    """Return a value that is a name without blanks around it.

    Raises :class:`ValueError`, which names ``key``, for any other value.
    """
    if not isinstance(value, str) or not value or value != value.strip(" "):
        raise ValueError(f'found {excerpt_of(value)} in "{key}", expected a name, without blanks around it')
    return value
