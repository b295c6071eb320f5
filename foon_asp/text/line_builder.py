"""Parsing of lines of FOON text and of one-line notation with the Lark grammar ``foon.lark``."""

import re
from functools import cache
from pathlib import Path

from lark import Lark, Token, Transformer
from lark.exceptions import UnexpectedCharacters, UnexpectedEOF, UnexpectedInput, UnexpectedToken

from foon_asp.network import Contents, ObjectNode, Relation, unquoted
from foon_asp.text.clean_line import no_tab_remark, split_ingredients
from foon_asp.text.line import (
    MOTION_FLAGS,
    SLIPPED_FLAGS,
    LineError,
    MotionLine,
    ObjectLine,
    Remark,
    StateLine,
    is_number,
)
from foon_asp.text.motion_times import MotionFields, is_time, mended_time
from foon_asp.text.plain_file import FENCE

_GRAMMAR = Path(__file__).with_name("foon.lark")
_ITEM = re.compile(r' *"(?:\\.|[^"\\])*" *|[^,]+')  # between commas, which quotes may hold too
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


class _LineBuilder(Transformer[Token, object]):
    """A transformer of parse trees into lines and nodes, with a method for each rule of the grammar.

    Remarks on slips get their columns from the tokens.
    """

    def object(self, tokens: list[Token]) -> ObjectLine:
        """Return the object line of its tokens: a letter with id, a label, and fields."""
        remarks: list[Remark] = []
        id_ = _id_after_letter(tokens[0], remarks)
        label = _without_end_spaces(tokens[1], remarks)
        fields = _nonempty_fields(tokens[2:], remarks) if len(tokens) > 2 else ()
        if len(fields) > 1 or (fields and fields[0] not in MOTION_FLAGS):
            fields = _checked_flag_and_tag(tokens, fields, remarks)
        return ObjectLine(label, id_, fields, tuple(remarks))

    def motion(self, tokens: list[Token]) -> MotionLine:
        """Return the motion line of its tokens: a letter with id, a motion, and fields.

        Times with an obvious slip are mended. Other faults in times are remarked on.
        """
        remarks: list[Remark] = []
        id_ = _id_after_letter(tokens[0], remarks)
        motion = _without_end_spaces(tokens[1], remarks)
        composite = motion[-1] == "*" and motion.strip("* ") != ""
        if composite:
            written, motion = motion, motion.rstrip("* ")
            if written != motion + "*":
                remarks.append(
                    _remark_at(tokens[1], "outer-space", f"{written!r} read as '{motion}*'", len(motion))
                )
        fields = _nonempty_fields(tokens[2:], remarks)
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
        """Return the state line of a name alone, or of a name and a text that is not in brackets.

        The text is read as contents if it has a comma or follows ``contains``. Otherwise it is read as the
        object of a relation.
        """
        remarks: list[Remark] = []
        id_ = _id_after_letter(tokens[0], remarks)
        _drop_end_blanks(tokens, remarks)
        word = _without_end_spaces(tokens[1], remarks)
        if len(tokens) == 2 or tokens[2].type != "BARE":
            return StateLine(word, id_, (), tuple(remarks))
        token = tokens[2]
        column = (token.column or 1) + len(token) - len(token.lstrip("\t "))
        name = token.strip("\t ")
        bracket, assumption = (
            ("{%s}", "a list") if "," in name or word == "contains" else ("[%s]", "an object")
        )
        shown = bracket % name.rstrip("]}")
        remarks.append(
            Remark(column, "bracket", f"{name!r} is not in brackets; read as {assumption}, {shown}")
        )
        # the column of the first item is that of the remark, without a bracket before it
        return _bracketed_line(word, Token("BARE", shown, column=column - 1), id_, remarks)

    def related(self, tokens: list[Token]) -> StateLine:
        """Return the line of a relation or of contents, with brackets."""
        remarks: list[Remark] = []
        id_ = _id_after_letter(tokens[0], remarks)
        _drop_end_blanks(tokens, remarks)
        return _bracketed_line(*_word_and_bracket(tokens, remarks), id_, remarks)

    holding = related

    def node(self, parts: list[Token | str | Relation | Contents]) -> ObjectNode:
        """Return the object node of one-line notation."""
        label, *notes = (token for token in parts if not isinstance(token, Token) or token.type == "NAME")
        return ObjectNode(
            unquoted(str(label)),
            frozenset(note for note in notes if isinstance(note, str)),
            frozenset(note for note in notes if isinstance(note, Relation)),
            tuple(sorted(note for note in notes if isinstance(note, Contents))),
        )

    def note_plain(self, tokens: list[Token]) -> str:
        """Return a state of one-line notation."""
        return unquoted(tokens[0])

    def note_related(self, tokens: list[Token]) -> str | Relation | Contents:
        """Return a relation or contents of one-line notation; with empty ``[]``, the word is a state."""
        word, bracket = tokens
        return _bracketed_part(unquoted(word), bracket.strip("\t "))

    note_holding = note_related


def _bracketed_part(word: str, bracket: str) -> str | Relation | Contents:
    """Return the relation, contents or state that a word and a bracket mean in one-line notation.

    A name in quotes is taken literally. If no name is in quotes, the bracket is read as on a state line.
    """
    written = [item.strip(" ") for item in _ITEM.findall(bracket[1:-1])]
    if not any(item.startswith('"') for item in written):
        return _bracketed_line(word, Token("PLACE", bracket), "", []).attribute
    if bracket[0] == "[" and len(written) == 1:
        return Relation(word, unquoted(written[0]))
    return Contents(word, tuple(sorted(unquoted(item) for item in written if item)))


def _remark_at(token: Token, code: str, message: str, offset: int = 0) -> Remark:
    """Return a remark at the column that is ``offset`` letters behind the begin of a token."""
    return Remark((token.column or 1) + offset, code, message)


def _id_after_letter(letter: Token, remarks: list[Remark]) -> str:
    """Return the id behind the letter of a line; adds a remark unless exactly one tab follows."""
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


def _nonempty_fields(tokens: list[Token], remarks: list[Remark]) -> tuple[str, ...]:
    """Return fields without blanks around them, and without empty ones; adds a remark on each slip."""
    fields: list[str] = []
    for token in tokens:
        field = token[1:].strip(" ")
        if not field:
            remarks.append(_remark_at(token, "empty-field", "nothing after the tab; left out"))
        else:
            if field != token[1:]:
                remarks.append(_remark_at(token, "outer-space", f"spaces around {field!r} left out", 1))
            fields.append(field)
    return tuple(fields)


def _checked_flag_and_tag(
    tokens: list[Token], fields: tuple[str, ...], remarks: list[Remark]
) -> tuple[str, ...]:
    """Return the fields after a label: a motion flag, then the category or the ``!`` of a goal.

    The slips ``00`` and ``01`` of a flag are mended. Adds a remark for each slip. Also adds a remark for each
    field that is no flag, category or ``!``.
    """
    field_tokens = [token for token in tokens[2:] if token.strip("\t ")]
    flag = fields[0]
    if flag in SLIPPED_FLAGS:
        remarks.append(
            _remark_at(field_tokens[0], "motion-flag", f"motion flag {flag!r} read as {flag[1]!r}", 1)
        )
        fields = (flag[1], *fields[1:])
    elif flag not in MOTION_FLAGS and flag != "!":
        remarks.append(_remark_at(field_tokens[0], "motion-flag", f"motion flag {flag!r} is not 0 or 1", 1))
    for field, token in zip(fields[1:], field_tokens[1:], strict=True):
        if not is_number(field) and field != "!":
            message = f"{field!r} is neither a category nor the goal mark !"
            remarks.append(_remark_at(token, "unknown-field", message, 1))
    return fields


def _drop_end_blanks(tokens: list[Token], remarks: list[Remark]) -> None:
    """Remove the token of blanks at the end of a state line, if there is one, and add a remark."""
    if tokens[-1].type == "BLANK":
        remarks.append(_remark_at(tokens.pop(), "outer-space", "blanks at the end of the line left out"))


def _word_and_bracket(tokens: list[Token], remarks: list[Remark]) -> tuple[str, Token]:
    """Return the word and the bracket of a state line; adds a remark unless exactly one tab parts them."""
    _, word, bracket = tokens
    column = bracket.column or 1
    if bracket[0] == "\t" and bracket[1] in "[{":
        return _without_end_spaces(word, remarks), Token(bracket.type, bracket[1:], column=column + 1)
    bare = bracket.lstrip("\t ")
    column += len(bracket) - len(bare)
    if "\t" in bracket:
        remarks.append(Remark(column, "outer-space", f"blanks before {bare} left out"))
        return _without_end_spaces(word, remarks), Token(bracket.type, bare, column=column)
    gap = column - 1 if word[-1] == " " or bare != bracket else column
    remarks.append(no_tab_remark(bare, gap))
    return word.strip(" "), Token(bracket.type, bare, column=column)


def _without_end_spaces(token: Token, remarks: list[Remark]) -> str:
    """Return a name without the spaces after it; if there were any, add a remark."""
    name = token.rstrip(" ")
    if name != token:
        remarks.append(_remark_at(token, "outer-space", f"spaces after {name!r} left out", len(name)))
        return name
    return str(token)


def _bracketed_line(name: str, bracket: Token, id_: str, remarks: list[Remark]) -> StateLine:
    """Return the state line of ``word [object]`` or ``word {list}``.

    After the word ``contains``, ``[]`` is read as ``{}``, and so is ``[]`` around a list. With empty ``[]``,
    the word alone is a state, such as ``on``. A bracket without an end, or with the wrong end, is read as if
    it were closed. Adds a remark for each slip.
    """
    closing = "]" if bracket[0] == "[" else "}"
    if bracket[-1] != closing or len(bracket) == 1:
        closed = bracket.rstrip("]}") + closing
        fault = "closed by the wrong bracket" if bracket[-1] in "]}" else "not closed"
        remarks.append(_remark_at(bracket, "bracket", f"{bracket} is {fault}; read as {closed}"))
        bracket = Token(bracket.type, closed, column=bracket.column)
    if closing == "]":
        if "," not in bracket and name != "contains":
            return _relation_line(name, bracket, id_, remarks)
        listed = split_ingredients(bracket[1:-1], (bracket.column or 1) + 1, remarks)
        braces = "{" + ",".join(listed) + "}"
        remarks.append(_remark_at(bracket, "contents-bracket", f"{bracket} read as contents {braces}"))
    else:
        listed = split_ingredients(bracket[1:-1], (bracket.column or 1) + 1, remarks)
    return StateLine(Contents(name, tuple(sorted(listed))), id_, listed, tuple(remarks))


def _relation_line(name: str, bracket: Token, id_: str, remarks: list[Remark]) -> StateLine:
    """Return the line of a relation; with empty brackets, the word alone is a state.

    Adds a remark on empty brackets and on spaces in them.
    """
    related = bracket[1:-1].strip(" ")
    if not related:
        remarks.append(
            _remark_at(bracket, "empty-relation", f"nothing in {bracket}; read as the state {name!r}")
        )
        return StateLine(name, id_, (), tuple(remarks))
    if related != bracket[1:-1]:
        remarks.append(_remark_at(bracket, "outer-space", f"spaces around {related!r} left out"))
    return StateLine(Relation(name, related), id_, (), tuple(remarks))


@cache
def _parser() -> Lark:
    """Return the parser of ``foon.lark``, which is built on the first call."""
    grammar = _GRAMMAR.read_text(encoding="utf-8")
    return Lark(grammar, start=["line", "node"], parser="lalr", transformer=_LineBuilder())


def parse_by_grammar(start: str, text: str) -> object:
    """Return the parsed line of a text for ``start="line"``, or the node of a notation for ``start="node"``.

    A line is given with its line end. Raises :class:`LineError` for a text that the grammar does not accept.
    """
    try:
        return _parser().parse(text, start=start)
    except UnexpectedInput as error:
        fault = _line_error(error, text, in_file=start == "line")
    raise fault  # raised here, so that it has no context of the parser


def _line_error(error: UnexpectedInput, text: str, in_file: bool) -> LineError:
    """Return an error of Lark in words: what was found at which column, and what is expected.

    ``in_file`` is true for a line of a file, false for one-line notation. A line that does not begin with
    ``O``, ``S``, ``M`` or ``//`` may get advice.
    """
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
    remaining = text[column - 1 :]
    if in_file:
        remaining = remaining.removesuffix("\n")
    shown = "the end of the line"
    if remaining:
        shown = repr(remaining if len(remaining) <= 24 else remaining[:24] + "...")
    advice = ""
    if in_file and {"OBJECT", "STATE", "MOTION"} <= names:
        names.add("SEPARATOR")
        advice = _advice(remaining)
    expected = tuple(dict.fromkeys(phrase for name, phrase in _TERMINALS.items() if name in names))
    return LineError(column, shown, expected, advice)


def _advice(line: str) -> str:
    """Return advice on a line that does not begin with ``O``, ``S`` or ``M``, or an empty text.

    There is advice on a code fence, on a small letter in place of a capital one, and on a name alone.
    """
    if not line.replace("\t", " ").isprintable():
        return ""
    if line.startswith(FENCE):
        return "remove this line: a code fence is no part of FOON text"
    if match := re.match(r"([osm]\d*)[ \t]+(\S.*)", line):
        return f"write {match[1].upper()}, a tab, and {match[2]}"
    if re.fullmatch(r"[^\W\d_][^\t\[\]{};:]{,39}", line):
        return f"an object is written O, a tab, and {line}"
    return ""
