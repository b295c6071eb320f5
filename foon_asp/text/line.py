"""One line of FOON text and what it says, through the Lark grammar ``foon.lark``."""

import re
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from typing import NamedTuple, cast

from lark import Lark, Token, Transformer
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken

from foon_asp.network import Contents, ObjectNode, Relation
from foon_asp.text.grammar import parser
from foon_asp.text.motion_times import MotionFields, is_time, mended_time


class Remark(NamedTuple):
    """A warning about one column (from 1) of a line that could be read all the same."""

    column: int
    code: str
    message: str


class ObjectLine(NamedTuple):
    """``O278⇥mixing bowl⇥1⇥15``: starts an object node.

    ``id`` is what stands behind the letter, or empty. ``fields`` are what follows the label, as written:
    the motion flag, and on a goal its recipe category or the mark ``!``. Neither is part of the node.
    """

    label: str
    id: str = ""
    fields: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()

    @property
    def motion_flag(self) -> str | None:
        """``1`` when the object is in motion, ``0`` when it is not, ``None`` when nothing is said."""
        first = self.fields[0] if self.fields else None
        return first if first in MOTION_FLAGS else None

    @property
    def is_goal(self) -> bool:
        """Whether the line is tagged as what the recipe makes: a category or the mark ``!``."""
        return self.category is not None or "!" in self.fields

    @property
    def category(self) -> str | None:
        """The recipe category of a goal, a number, where the line has one."""
        fields = self.fields if self.motion_flag is None else self.fields[1:]
        return next((field for field in fields if is_number(field) and field not in _SLIPPED_FLAGS), None)


class StateLine(NamedTuple):
    """``S41⇥empty``, ``S65⇥in⇥[bowl]`` or ``S23⇥contains⇥{salt}``: one attribute of the node above.

    ``listed`` are the ingredients of contents in the order written, which is no part of the node.
    """

    attribute: str | Relation | Contents
    id: str = ""
    listed: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()


class MotionLine(NamedTuple):
    """``M54⇥pour*⇥1:10⇥1:11``: the motion of a unit.

    ``composite`` tells of a ``*`` behind the motion: several motions annotated as one. ``fields`` are the
    times, and with success rates the entity and its rate, as written. None of it is part of the unit.
    """

    motion: str
    id: str = ""
    composite: bool = False
    fields: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()


Line = ObjectLine | StateLine | MotionLine


def name_of(line: Line) -> str:
    """Give what an id stands for: a label, a motion, a state, or the word of a relation or of contents."""
    if isinstance(line, ObjectLine):
        return line.label
    if isinstance(line, MotionLine):
        return line.motion
    return line.attribute if isinstance(line.attribute, str) else line.attribute.word


class LineError(Exception):
    """A line that the grammar does not accept: where (column from 1), what was found, what may be there."""

    def __init__(self, column: int, found: str, expected: tuple[str, ...]) -> None:
        wanted = ", ".join(expected[:-1]) + " or " + expected[-1] if len(expected) > 1 else "".join(expected)
        super().__init__(f"found {found}, expected {wanted}")
        self.column = column
        self.found = found
        self.expected = expected


MOTION_FLAGS = {"0", "1"}
_SLIPPED_FLAGS = {"00", "01"}
_BATCH = 500  # lines handed to the parser at once: one at fault sends only these back, one by one
# The terminals that are a whole line each: a line that matches one means the same to the parser, but slower.
_WHOLE_LINES = ("CLEAN_OBJECT", "CLEAN_PLAIN", "CLEAN_RELATED", "CLEAN_HOLDING", "CLEAN_MOTION")

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
    "PLACE": "[object]",
    "ITEMS": "{ingredient,ingredient}",
    "SEMICOLON": "a semicolon",
    "_NEWLINE": "the end of the line",
    "$END": "the end of the line",
}


def parse_line(text: str) -> Line:
    """Read an object, state or motion line, given without its line end.

    Raises :class:`LineError` when the grammar does not accept it.
    """
    return _clean_line(text) or cast(list[Line], _parse("lines", text + "\n"))[0]


def parse_lines(texts: Sequence[str]) -> list[Line | LineError]:
    """Read many lines, which is faster than one by one."""
    found: list[Line | LineError | None] = [_clean_line(text) for text in texts]
    others = [place for place, line in enumerate(found) if line is None]
    for start in range(0, len(others), _BATCH):
        batch = others[start : start + _BATCH]
        lines: list[Line | LineError] = []
        try:
            text = "".join(f"{texts[place]}\n" for place in batch)
            lines += cast(list[Line], _parser().parse(text, start="lines"))
        except UnexpectedInput:
            for place in batch:
                try:
                    lines.append(parse_line(texts[place]))
                except LineError as error:
                    lines.append(error)
        for place, line in zip(batch, lines, strict=True):
            found[place] = line
    return cast(list[Line | LineError], found)


def _clean_line(text: str) -> Line | None:
    """Read a line that is a single token of the grammar; ``None`` for any other."""
    match = _whole_lines()(f"{text}\n")
    if not match or not match.lastgroup:
        return None
    clean: Callable[[list[str]], Line] = getattr(_BUILDER, match.lastgroup.lower())
    return clean([match[0]])


def parse_node(notation: str) -> ObjectNode:
    """Read an object node in one-line notation.

    Parameters:
        notation: For example ``sweet potato; chopped; in [cutting board]``.

    Returns:
        The object node.

    Raises:
        LineError: for text that is not in the notation, with the column and what was expected.

    Example:
        >>> node = foon_asp.parse_node("sweet potato; chopped; in [cutting board]")
        >>> node.label, sorted(node.states)
        ('sweet potato', ['chopped'])
    """
    return cast(ObjectNode, _parse("node", notation.rstrip(" ")))


@lru_cache(10_000)  # a kitchen says "empty" hundreds of times
def read_state(text: str) -> StateLine:
    """Read what a state of a JSON file says, as on a state line: ``whole``, ``in [bowl]``, ``coated {a,b}``.

    Raises :class:`LineError`, with the column in ``text``, when the grammar does not accept it.
    """
    for column, letter in enumerate(text, 1):
        if letter in "\t\r\n":
            raise LineError(column, repr(letter), ("a name", "[object]", "{ingredient,ingredient}"))
    try:
        line = cast(StateLine, parse_line(f"S\t{text}"))
    except LineError as error:
        raise LineError(max(1, error.column - 2), error.found, error.expected) from None
    # between a word and its bracket, a JSON file has a blank where FOON text has a tab
    return line._replace(remarks=tuple(r for r in line.remarks if r.code != "space-for-tab"))


class _LineBuilder(Transformer[Token, object]):
    """Turns parsed lines into values; columns in remarks come from the tokens."""

    def lines(self, lines: list[Line]) -> list[Line]:
        return lines

    def clean_object(self, tokens: list[str]) -> ObjectLine:
        letter, label, *fields = tokens[0][:-1].split("\t")
        return ObjectLine(label, letter[1:], tuple(fields))

    def clean_plain(self, tokens: list[str]) -> StateLine:
        letter, state = tokens[0][:-1].split("\t")
        return StateLine(state, letter[1:])

    def clean_related(self, tokens: list[str]) -> StateLine:
        letter, word, bracket = tokens[0][:-1].split("\t")
        return StateLine(Relation(word, bracket[1:-1]), letter[1:])

    def clean_motion(self, tokens: list[str]) -> MotionLine:
        letter, motion, *fields = tokens[0][:-1].split("\t")
        return MotionLine(motion, letter[1:], fields=tuple(fields))

    def clean_holding(self, tokens: list[str]) -> StateLine:
        letter, word, bracket = tokens[0][:-1].split("\t")
        items = bracket[1:-1].split(",")
        if len(set(items)) == len(items) and all(item and item[0] != " " != item[-1] for item in items):
            return StateLine(Contents(word, tuple(sorted(items))), letter[1:], tuple(items))
        column = len(letter) + len(word) + 3
        return _bracketed(word, Token("LIST", bracket, column=column), letter[1:], [])

    def object(self, tokens: list[Token]) -> ObjectLine:
        remarks: list[Remark] = []
        id_ = _id(tokens[0], remarks)
        label = _name(tokens[1], remarks)
        fields = _fields(tokens[2:], remarks) if len(tokens) > 2 else ()
        if len(fields) > 1 or (fields and fields[0] not in MOTION_FLAGS):
            fields = _flag_and_tag(tokens, fields, remarks)
        return ObjectLine(label, id_, fields, tuple(remarks))

    def motion(self, tokens: list[Token]) -> MotionLine:
        remarks: list[Remark] = []
        id_ = _id(tokens[0], remarks)
        motion = _name(tokens[1], remarks)
        composite = motion[-1] == "*" and motion.strip("* ") != ""
        if composite:
            written, motion = motion, motion.rstrip("* ")
            if written != motion + "*":
                remarks.append(
                    _remark(tokens[1], "outer-space", f"{written!r} read as '{motion}*'", len(motion))
                )
        fields = _fields(tokens[2:], remarks)
        times = MotionFields.of(fields).times
        mended = tuple(map(mended_time, times))
        column = (tokens[2].column or 1) + 1 if times else 1
        for raw, time, token in zip(times, mended, tokens[2:], strict=False):
            if raw != time:
                remarks.append(Remark(column, "time", f"{raw!r} read as the time {time!r}"))
            elif not is_time(raw):
                remarks.append(Remark(column, "time", f"{raw!r} is not a time (m:ss or Assumed)"))
            column += len(token)
        return MotionLine(motion, id_, composite, mended + fields[len(times) :], tuple(remarks))

    def plain(self, tokens: list[Token]) -> StateLine:
        remarks: list[Remark] = []
        id_ = _id(tokens[0], remarks)
        _blank_end(tokens, remarks)
        word = _name(tokens[1], remarks)
        if len(tokens) == 2 or tokens[2].type != "BARE":
            return StateLine(word, id_, (), tuple(remarks))
        token = tokens[2]
        column = (token.column or 1) + len(token) - len(token.lstrip("\t "))
        name = token.strip("\t ")
        bracket, what = ("{%s}", "a list") if "," in name or word == "contains" else ("[%s]", "an object")
        shown = bracket % name.rstrip("]}")
        remarks.append(Remark(column, "bracket", f"{name!r} is not in brackets; read as {what}, {shown}"))
        # the first item stands where the remark says, behind a bracket that is not there
        return _bracketed(word, Token("BARE", shown, column=column - 1), id_, remarks)

    def related(self, tokens: list[Token]) -> StateLine:
        remarks: list[Remark] = []
        id_ = _id(tokens[0], remarks)
        _blank_end(tokens, remarks)
        return _bracketed(*_tabbed(tokens, remarks), id_, remarks)

    holding = related

    def node(self, parts: list[Token | str | Relation | Contents]) -> ObjectNode:
        label, *notes = (part for part in parts if not isinstance(part, Token) or part.type == "NAME")
        return ObjectNode(
            _unquoted(label),
            frozenset(note for note in notes if isinstance(note, str)),
            frozenset(note for note in notes if isinstance(note, Relation)),
            tuple(sorted(note for note in notes if isinstance(note, Contents))),
        )

    def note_plain(self, tokens: list[Token]) -> str:
        return _unquoted(tokens[0])

    def note_related(self, tokens: list[Token]) -> str | Relation | Contents:
        word, bracket = tokens
        return _bracketed(_unquoted(word), Token(bracket.type, bracket.strip("\t ")), "", []).attribute

    note_holding = note_related


def _unquoted(name: object) -> str:
    """Give a name as it is from how it is written in the notation."""
    return re.sub(r"\\([;\\])", r"\1", str(name).strip(" "))


def is_number(field: str) -> bool:
    """Whether a field is a number such as an id: digits, of the Latin script."""
    return field.isascii() and field.isdigit()


def _remark(token: Token, code: str, message: str, offset: int = 0) -> Remark:
    return Remark((token.column or 1) + offset, code, message)


def _id(letter: Token, remarks: list[Remark]) -> str:
    """Give the id behind the letter; one tab has to follow."""
    if letter[-1] == "\t" and letter[-2] not in "\t ":
        return letter[1:-1]
    id_ = letter[1:].rstrip("\t ")
    column = (letter.column or 1) + 1 + len(id_)
    if "\t" not in letter:
        remarks.append(
            Remark(column, "space-for-tab", f"no tab after {letter[0]}{id_}; read as if there were one")
        )
    else:
        remarks.append(Remark(column + 1, "outer-space", f"blanks after {letter[0]}{id_} left out"))
    return id_


def _fields(tokens: list[Token], remarks: list[Remark]) -> tuple[str, ...]:
    """Give the fields behind a name without blanks around them; empty ones are left out."""
    fields: list[str] = []
    for token in tokens:
        field = token[1:].strip(" ")
        if not field:
            remarks.append(_remark(token, "empty-field", "nothing after the tab; left out"))
        else:
            if field != token[1:]:
                remarks.append(_remark(token, "outer-space", f"spaces around {field!r} left out", 1))
            fields.append(field)
    return tuple(fields)


def _flag_and_tag(tokens: list[Token], fields: tuple[str, ...], remarks: list[Remark]) -> tuple[str, ...]:
    """Check what follows a label: a motion flag, then for a goal its category or ``!``."""
    places = [token for token in tokens[2:] if token.strip("\t ")]
    flag = fields[0]
    if flag in _SLIPPED_FLAGS:
        remarks.append(_remark(places[0], "motion-flag", f"motion flag {flag!r} read as {flag[1]!r}", 1))
        fields = (flag[1], *fields[1:])
    elif flag not in MOTION_FLAGS and flag != "!":
        remarks.append(_remark(places[0], "motion-flag", f"motion flag {flag!r} is not 0 or 1", 1))
    for field, place in zip(fields[1:], places[1:], strict=True):
        if not is_number(field) and field != "!":
            message = f"{field!r} is neither a category nor the goal mark !"
            remarks.append(_remark(place, "unknown-field", message, 1))
    return fields


def _blank_end(tokens: list[Token], remarks: list[Remark]) -> None:
    """Drop the blanks at the end of a state line."""
    if tokens[-1].type == "BLANK":
        remarks.append(_remark(tokens.pop(), "outer-space", "blanks at the end of the line left out"))


def _tabbed(tokens: list[Token], remarks: list[Remark]) -> tuple[str, Token]:
    """Give the word and the bracket without the tab that should stand between them."""
    _, word, bracket = tokens
    column = bracket.column or 1
    if bracket[0] == "\t" and bracket[1] in "[{":
        return _name(word, remarks), Token(bracket.type, bracket[1:], column=column + 1)
    bare = bracket.lstrip("\t ")
    column += len(bracket) - len(bare)
    if "\t" in bracket:
        remarks.append(Remark(column, "outer-space", f"blanks before {bare} left out"))
        return _name(word, remarks), Token(bracket.type, bare, column=column)
    gap = column - 1 if word[-1] == " " or bare != bracket else column
    remarks.append(Remark(gap, "space-for-tab", f"no tab before {bare}; read as if there were one"))
    return word.strip(" "), Token(bracket.type, bare, column=column)


def _name(token: Token, remarks: list[Remark]) -> str:
    name = token.rstrip(" ")
    if name != token:
        remarks.append(_remark(token, "outer-space", f"spaces after {name!r} left out", len(name)))
        return name
    return str(token)


def _bracketed(name: str, bracket: Token, id_: str, remarks: list[Remark]) -> StateLine:
    """``word [object]`` or ``word {list}``; a list, or the word ``contains``, in ``[]`` is still a list.

    Empty ``[]`` leave the word alone, which then is a state, as in ``on``.
    """
    closing = "]" if bracket[0] == "[" else "}"
    if bracket[-1] != closing or len(bracket) == 1:
        whole = bracket.rstrip("]}") + closing
        what = "closed by the wrong bracket" if bracket[-1] in "]}" else "not closed"
        remarks.append(_remark(bracket, "bracket", f"{bracket} is {what}; read as {whole}"))
        bracket = Token(bracket.type, whole, column=bracket.column)
    if closing == "]":
        if "," not in bracket and name != "contains":
            return _related(name, bracket, id_, remarks)
        items = _items(bracket, remarks)
        braces = "{" + ",".join(items) + "}"
        remarks.append(_remark(bracket, "contents-bracket", f"{bracket} read as contents {braces}"))
    else:
        items = _items(bracket, remarks)
    return StateLine(Contents(name, tuple(sorted(items))), id_, items, tuple(remarks))


def _related(name: str, bracket: Token, id_: str, remarks: list[Remark]) -> StateLine:
    related = bracket[1:-1].strip(" ")
    if not related:
        remarks.append(
            _remark(bracket, "empty-relation", f"nothing in {bracket}; read as the state {name!r}")
        )
        return StateLine(name, id_, (), tuple(remarks))
    if related != bracket[1:-1]:
        remarks.append(_remark(bracket, "outer-space", f"spaces around {related!r} left out"))
    return StateLine(Relation(name, related), id_, (), tuple(remarks))


def _items(bracket: Token, remarks: list[Remark]) -> tuple[str, ...]:
    """Split ``{a,b}`` at its commas; what is dropped or doubtful is remarked on, once for each kind."""
    items: list[str] = []
    seen: set[str] = set()
    said: set[str] = set()

    def remark(code: str, message: str) -> None:
        if code not in said:
            remarks.append(Remark(column, code, message))
            said.add(code)

    column = (bracket.column or 1) + 1
    for raw in bracket[1:-1].split(","):
        item = raw.strip(" ")
        if not item:
            remark("empty-ingredient", "empty ingredient left out")
        else:
            if item != raw:
                remark("outer-space", f"spaces around {item!r} left out")
            if item in seen:
                remark("repeated-ingredient", f"ingredient {item!r} is listed twice")
            items.append(item)
            seen.add(item)
        column += len(raw) + 1
    return tuple(items)


_BUILDER = _LineBuilder()


@cache
def _parser() -> Lark:
    return parser(_BUILDER)


@cache
def _whole_lines() -> Callable[[str], re.Match[str] | None]:
    terminals = (f"(?P<{name}>{_parser().get_terminal(name).pattern.to_regexp()})" for name in _WHOLE_LINES)
    return re.compile("|".join(terminals)).fullmatch


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
    rest = text[column - 1 :]
    if in_file:
        rest = rest.removesuffix("\n")
    found = "the end of the line"
    if rest:
        found = repr(rest if len(rest) <= 24 else rest[:24] + "...")
    if in_file and {"OBJECT", "STATE", "MOTION"} <= names:
        names.add("SEPARATOR")
    expected = tuple(dict.fromkeys(phrase for name, phrase in _TERMINALS.items() if name in names))
    return LineError(column, found, expected)
