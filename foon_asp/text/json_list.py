"""A JSON list that is read element by element, with the place of each."""

import json
import re
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Final, NamedTuple

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.plain_file import FENCE

_SPACE = re.compile(r"[ \t\r\n]*")
_COMMA_BEFORE_END = re.compile(r",[ \t\r\n]*([\]}])")
_BLANKS = " \t\r\n"
_JSON_LINE = re.compile(r"^[ \t]*[\[{]", re.MULTILINE)
_FOON_LINE = re.compile(r"[OSM]\d*[ \t]|//|#")


class JsonElement(NamedTuple):
    """An element of a list, and the place where it begins."""

    value: object
    source: Source


class JsonList:
    """The elements of a list in a JSON text; iterating reads them one by one.

    Without ``key``, the whole text has to be the list. With ``key``, the text may also be an object that has
    the list under this key. Once all elements have been read, ``others`` has the other values of the object.
    ``errors`` has the faults found so far; their sources name the ``file``.
    """

    def __init__(self, text: str, file: Path, key: str | None = None) -> None:
        self.errors: list[Diagnostic] = []
        self.others: dict[str, object] = {}
        self._text = text
        self._file = str(file)
        self._key = key
        self._line, self._counted = 1, 0  # the line at the last offset, so that lines are counted once

    def __iter__(self) -> Iterator[JsonElement]:
        """Yield the elements in order; a fault is added to ``errors`` and ends the list."""
        try:
            for offset, value in self._elements():
                yield JsonElement(value, self.position_of(offset))
        except json.JSONDecodeError as error:
            syntax_fault = json_fault(error)
            self.add_error(self.position_of(syntax_fault.offset), syntax_fault.message)
        except JsonFaultError as fault:
            self.add_error(self.position_of(fault.position), str(fault))
        except RecursionError:
            self.add_error(self.position_of(0), "found lists nested too deeply, expected a list of objects")

    def add_error(self, source: Source, message: str) -> None:
        """Add an error at a line and column of the file to ``errors``, with the text of the line."""
        excerpt = self._text.split("\n", source.line)[source.line - 1].rstrip("\r")
        self.errors.append(Diagnostic(Severity.ERROR, "json", message, source, excerpt))

    def position_of(self, offset: int) -> Source:
        """Return the source of an offset in the text, with line and column; fastest for ascending offsets."""
        if offset < self._counted:
            self._line, self._counted = 1, 0
        self._line += self._text.count("\n", self._counted, offset)
        self._counted = offset
        return Source(self._file, self._line, offset - self._text.rfind("\n", 0, offset))

    def _elements(self) -> Iterator[tuple[int, object]]:
        """Yield each element of the list with its offset in the text."""
        start = self._skip_blanks(0)
        if self._key is not None and self._text[start : start + 1] == "{":
            yield from self._elements_under_key(start + 1)
            return
        end = yield from self._list_elements(start)
        self._expect_end(end)

    def _elements_under_key(self, position: int) -> Iterator[tuple[int, object]]:
        """Yield the elements of the list under the key, with offsets; other values go to ``others``.

        ``position`` is that behind the opening bracket of the object. Raises :class:`JsonFaultError` for a
        fault, and for an object without the key.
        """
        seen: set[str] = set()
        position = self._skip_blanks(position)
        while self._text[position : position + 1] != "}":
            start = position
            key, position = self._value_at(position)
            if not isinstance(key, str):
                raise self._unexpected("a key in quotes", start)
            if key in seen:
                raise _repeated_key(key, start)
            seen.add(key)
            position = self._expect(":", self._skip_blanks(position))
            if key == self._key:
                position = yield from self._list_elements(position)
            else:
                self.others[key], position = self._value_at(position)
            position = self._skip_blanks(position)
            if self._text[position : position + 1] != "}":
                position = self._expect(",", position, "a comma or }")
                if self._text[position : position + 1] == "}":
                    raise self._unexpected("a key in quotes", position)
        if self._key not in seen:
            raise self._unexpected(f"a list, or an object with the key {self._key!r}", 0)
        self._expect_end(position + 1)

    def _list_elements(self, position: int) -> Generator[tuple[int, object], None, int]:
        """Yield the elements of the list at a position, with offsets; return the position after the list."""
        position = self._expect("[", position, "a list, [ ... ]")
        is_first = True
        while self._text[position : position + 1] != "]":
            if not is_first:
                position = self._expect(",", position, "a comma or ]")
            is_first = False
            value, end = self._value_at(position)
            yield position, value
            position = self._skip_blanks(end)
        return position + 1

    def _value_at(self, position: int) -> tuple[object, int]:
        """Return the JSON value at a position, and the position after it; numbers are :class:`JsonNumber`.

        Raises :class:`JsonFaultError` for a repeated key, with the position of the value. Raises
        :class:`json.JSONDecodeError` for any other fault.
        """
        try:
            return DECODER.raw_decode(self._text, position)
        except JsonFaultError as fault:
            fault.position = position
            raise

    def _expect(self, character: str, position: int, description: str = "") -> int:
        """Return the position behind ``character`` at ``position``, and behind the blanks after it.

        Raises :class:`JsonFaultError` if another character stands there; ``description`` is what was
        expected.
        """
        if self._text[position : position + 1] != character:
            raise self._unexpected(description or character, position)
        return self._skip_blanks(position + 1)

    def _expect_end(self, end: int) -> None:
        """Raise :class:`JsonFaultError` where anything but blanks follows a position."""
        position = self._skip_blanks(end)
        if position != len(self._text):
            raise self._unexpected(
                "the end of the file after the list: remove what stands behind it", position
            )

    def _unexpected(self, expected: str, position: int) -> "JsonFaultError":
        """Return the error that something else than ``expected`` stands at a position.

        At the beginning of the text, the error has the message of :func:`fault_before_json`, if there is one.
        """
        if position == self._skip_blanks(0) and (message := fault_before_json(self._text)):
            return JsonFaultError(message, position)
        text = self._text[position:].split("\n", 1)[0].rstrip("\r")
        text = text if len(text) <= 24 else text[:24] + "..."
        shown = repr(text) if text else "the end of the line"
        return JsonFaultError(f"found {shown}, expected {expected}", position)

    def _skip_blanks(self, position: int) -> int:
        """Return the position of the first character from ``position`` that is no blank."""
        match = _SPACE.match(self._text, position)
        return match.end() if match else position


class JsonNumber:
    """A number as it is written, so that ids and rates keep their digits."""

    def __init__(self, text: str) -> None:
        self.text = text


class JsonFaultError(Exception):
    """A fault of a JSON text that the decoder of Python does not report, and its offset in the text."""

    def __init__(self, message: str, position: int) -> None:
        super().__init__(message)
        self.position = position


def _repeated_key(key: str, position: int) -> JsonFaultError:
    """Return the error that an object has a key twice."""
    return JsonFaultError(f"found the key {key!r} twice in one object", position)


def _object_without_repeats(pairs: list[tuple[str, object]]) -> dict[str, object]:
    """Return an object of JSON from its pairs.

    Raises :class:`JsonFaultError` for a repeated key, with position 0, since the position is not known here.
    """
    value = dict(pairs)
    if len(value) < len(pairs):
        keys = [key for key, _ in pairs]
        raise _repeated_key(next(key for key in value if keys.count(key) > 1), 0)
    return value


DECODER: Final = json.JSONDecoder(
    object_pairs_hook=_object_without_repeats,
    parse_int=JsonNumber,
    parse_float=JsonNumber,
    parse_constant=JsonNumber,
)


def begins_json(text: str) -> bool:
    """Whether a text begins with a bracket, as JSON does; no line of FOON text does."""
    return text[:1_000].lstrip(_BLANKS)[:1] in {"{", "["}


def fault_before_json(text: str) -> str:
    """Return an error message if a text is JSON with other text before it; empty for any other text.

    JSON is searched for in the first 2,000 letters. A text that begins with a line of FOON is no JSON.
    """
    beginning = text[:2_000].lstrip(_BLANKS)
    first_line = beginning.split("\n", 1)[0].rstrip()
    if not _JSON_LINE.search(beginning) or begins_json(beginning) or _FOON_LINE.match(first_line):
        return ""
    if first_line.startswith(FENCE):
        return (
            f"found a code fence around JSON, expected JSON alone: remove the lines that begin with {FENCE}"
        )
    return f"found the text {first_line[:40]!r} before JSON, expected JSON alone: remove it"


class JsonFault(NamedTuple):
    """A syntax fault: its message, its offset, and its line and column, counted from 1."""

    message: str
    offset: int
    line: int
    column: int


def json_fault(error: json.JSONDecodeError) -> JsonFault:
    """Return the fault that the standard library found in a JSON text.

    A comma before the end of a list or an object is always reported at the place of the comma. Python
    versions differ in the place that they report.
    """
    text, offset, message = error.doc, error.pos, error.msg
    start = offset
    if text[offset : offset + 1] in {"]", "}"}:
        start = len(text[:offset].rstrip(_BLANKS)) - 1
    comma = _COMMA_BEFORE_END.match(text, start) if start >= 0 else None
    if comma:
        offset, message = start, f"found a comma before {comma[1]}, expected none"
    line = text.count("\n", 0, offset) + 1
    return JsonFault(f"not JSON: {message}", offset, line, offset - text.rfind("\n", 0, offset))
