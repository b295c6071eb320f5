"""One line of FOON text and what it says, through the Lark grammar ``foon.lark``."""

import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple, cast

from lark import Lark, Token, Transformer
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken

from foon_asp.network import Contents, ObjectNode, Relation


class Remark(NamedTuple):
    """A warning about one column (from 1) of a line that could be read all the same."""

    column: int
    code: str
    message: str


class ObjectLine(NamedTuple):
    """``O278⇥mixing bowl⇥1``: starts an object node."""

    label: str
    remarks: tuple[Remark, ...]


class StateLine(NamedTuple):
    """``S41⇥empty``, ``S65⇥in⇥[bowl]`` or ``S23⇥contains⇥{salt}``: one attribute of the node above."""

    attribute: str | Relation | Contents
    remarks: tuple[Remark, ...]


class MotionLine(NamedTuple):
    """``M54⇥pour⇥1:10⇥1:11``: the motion of a unit."""

    motion: str
    remarks: tuple[Remark, ...]


Line = ObjectLine | StateLine | MotionLine


class LineError(Exception):
    """A line that the grammar does not accept: where (column from 1), what was found, what may be there."""

    def __init__(self, column: int, found: str, expected: tuple[str, ...]) -> None:
        wanted = ", ".join(expected[:-1]) + " or " + expected[-1] if len(expected) > 1 else "".join(expected)
        super().__init__(f"found {found}, expected {wanted}")
        self.column = column
        self.found = found
        self.expected = expected


_TERMINALS = {
    "OBJECT": "an object line (O, tab, label)",
    "STATE": "a state line (S, tab, state)",
    "MOTION": "a motion line (M, tab, motion)",
    "SEPARATOR": "a separator (//)",
    "TEXT": "a name",
    "NAME": "a name",
    "FIELD": "a tab and a flag or time",
    "RELATED": "[object]",
    "LIST": "{ingredient,ingredient}",
    "SEMICOLON": "a semicolon",
    "_NEWLINE": "the end of the line",
    "$END": "the end of the line",
}

_TIME = re.compile(r"assumed|\d+:\d\d(:\d\d)?|<.*>", re.IGNORECASE)
_FLAGS = {"\t0", "\t1"}


def parse_line(text: str) -> Line:
    """Read an object, state or motion line, given without its line end.

    Raises :class:`LineError` when the grammar does not accept it.
    """
    return cast(list[Line], _parse("lines", text + "\n"))[0]


def parse_lines(texts: Sequence[str]) -> list[Line] | None:
    """Read many lines at once, which is faster; ``None`` when there is one that is not accepted."""
    try:
        return cast(list[Line], _parser().parse("".join(f"{text}\n" for text in texts), start="lines"))
    except UnexpectedInput:
        return None


def parse_node(notation: str) -> ObjectNode:
    """Read the one-line notation of an object node: ``sweet potato; chopped; in [cutting board]``.

    Raises :class:`LineError` when the grammar does not accept it.
    """
    return cast(ObjectNode, _parse("node", re.sub(r"(?<=[\]}]) +(?=;|$)", "", notation).rstrip(" ")))


def normalize_state(state: str) -> str | Relation:
    """Tell a bare state from a relation written as one, ``under [cooking pan]`` (JSON files have both)."""
    match = "[" in state and re.fullmatch(r"([^\[\]{}]+?) *\[([^\[\]{}]+)\]", state)
    return Relation(match[1], match[2].strip(" ")) if match else state


class _LineBuilder(Transformer[Token, object]):
    """Turns parsed lines into values; columns in remarks come from the tokens."""

    def lines(self, lines: list[Line]) -> list[Line]:
        return lines

    def object(self, tokens: list[Token]) -> ObjectLine:
        remarks: list[Remark] = []
        label = _name(tokens[1], remarks)
        if len(tokens) > 2 and tokens[2] not in _FLAGS:
            flag = tokens[2][1:]
            remarks.append(_remark(tokens[2], "motion-flag", f"motion flag {flag!r} is not 0 or 1", 1))
        remarks += [
            _remark(token, "unknown-field", f"{token[1:]!r} left out", 1)
            for token in tokens[3:]
            if not token[1:].isdigit()
        ]
        return ObjectLine(label, tuple(remarks))

    def motion(self, tokens: list[Token]) -> MotionLine:
        remarks: list[Remark] = []
        motion = _name(tokens[1], remarks)
        for token in tokens[2:]:
            time = token[1:]
            if not _TIME.fullmatch(time):
                remarks.append(_remark(token, "time", f"{time!r} is not a time (m:ss or Assumed)", 1))
        return MotionLine(motion, tuple(remarks))

    def plain(self, tokens: list[Token]) -> StateLine:
        remarks: list[Remark] = []
        return StateLine(_name(tokens[1], remarks), tuple(remarks))

    def related(self, tokens: list[Token]) -> StateLine:
        remarks: list[Remark] = []
        word, bracket = _tabbed(tokens, remarks)
        return StateLine(_related(word, bracket, remarks), tuple(remarks))

    def holding(self, tokens: list[Token]) -> StateLine:
        remarks: list[Remark] = []
        word, bracket = _tabbed(tokens, remarks)
        return StateLine(Contents(word, _items(bracket, remarks)), tuple(remarks))

    def node(self, parts: list[Token | str | Relation | Contents]) -> ObjectNode:
        label, *notes = (part for part in parts if not isinstance(part, Token) or part.type == "NAME")
        return ObjectNode(
            str(label).strip(" "),
            frozenset(note for note in notes if isinstance(note, str)),
            frozenset(note for note in notes if isinstance(note, Relation)),
            tuple(sorted(note for note in notes if isinstance(note, Contents))),
        )

    def note_plain(self, tokens: list[Token]) -> str:
        return tokens[0].strip(" ")

    def note_related(self, tokens: list[Token]) -> str | Relation | Contents:
        return _related(tokens[0].strip(" "), tokens[1], [])

    def note_holding(self, tokens: list[Token]) -> Contents:
        return Contents(tokens[0].strip(" "), _items(tokens[1], []))


def _remark(token: Token, code: str, message: str, offset: int = 0) -> Remark:
    return Remark((token.column or 1) + offset, code, message)


def _tabbed(tokens: list[Token], remarks: list[Remark]) -> tuple[str, Token]:
    """Give the word and the bracket without the tab that should stand between them."""
    _, word, bracket = tokens
    column = bracket.column or 1
    if bracket[0] == "\t":
        return _name(word, remarks), Token(bracket.type, bracket[1:], column=column + 1)
    remarks.append(Remark(column - 1, "space-for-tab", f"no tab before {bracket}; read as if there were one"))
    return word.strip(" "), bracket


def _name(token: Token, remarks: list[Remark]) -> str:
    name = token.strip(" ")
    if name != token:
        remarks.append(_remark(token, "outer-space", f"spaces around {name!r} left out"))
    return name


def _related(name: str, bracket: Token, remarks: list[Remark]) -> str | Relation | Contents:
    """``word [object]``; a list, or the word ``contains``, can only be contents in the wrong bracket.

    Empty brackets leave the word alone, which then is a state, as in ``on``.
    """
    if "," in bracket or name == "contains":
        items = _items(bracket, remarks)
        braces = "{" + ",".join(items) + "}"
        remarks.append(_remark(bracket, "contents-bracket", f"{bracket} read as contents {braces}"))
        return Contents(name, items)
    related = bracket[1:-1].strip(" ")
    if not related:
        remarks.append(
            _remark(bracket, "empty-relation", f"nothing in {bracket}; read as the state {name!r}")
        )
        return name
    if related != bracket[1:-1]:
        remarks.append(_remark(bracket, "outer-space", f"spaces around {related!r} left out"))
    return Relation(name, related)


def _items(bracket: Token, remarks: list[Remark]) -> tuple[str, ...]:
    """Split ``{a,b}`` at its commas; what is dropped or doubtful is remarked on."""
    items: list[str] = []
    seen: set[str] = set()
    column = (bracket.column or 1) + 1
    for raw in bracket[1:-1].split(","):
        item = raw.strip(" ")
        if not item:
            remarks.append(Remark(column, "empty-ingredient", "empty ingredient left out"))
        else:
            if item != raw:
                remarks.append(Remark(column, "outer-space", f"spaces around {item!r} left out"))
            if item in seen:
                remarks.append(Remark(column, "repeated-ingredient", f"ingredient {item!r} is listed twice"))
            items.append(item)
            seen.add(item)
        column += len(raw) + 1
    return tuple(sorted(items))


@cache
def _parser() -> Lark:
    grammar = Path(__file__).with_name("foon.lark").read_text(encoding="utf-8")
    return Lark(
        grammar, start=["lines", "node"], parser="lalr", lexer="contextual", transformer=_LineBuilder()
    )


def _parse(start: str, text: str) -> object:
    try:
        return _parser().parse(text, start=start)
    except UnexpectedInput as error:
        raise _line_error(error, text, in_file=start == "lines") from None


def _line_error(error: UnexpectedInput, text: str, in_file: bool) -> LineError:
    column = len(text) + 1
    names: set[str] = set()
    if isinstance(error, UnexpectedCharacters):
        column, names = error.column, set(error.allowed or ())
    elif isinstance(error, UnexpectedToken):
        names = set(error.accepts or error.expected)
        if error.token.type != "$END":
            column = error.token.column or column
    elif isinstance(error, UnexpectedEOF):
        names = set(error.expected)
    if in_file:
        names.discard("$END")  # a line ends by its newline
    rest = text[column - 1 :].removesuffix("\n")
    found = "the end of the line"
    if rest:
        found = repr(rest if len(rest) <= 24 else rest[:24] + "...")
    if in_file and {"OBJECT", "STATE", "MOTION"} <= names:
        names.add("SEPARATOR")
    expected = tuple(dict.fromkeys(phrase for name, phrase in _TERMINALS.items() if name in names))
    return LineError(column, found, expected)
