"""One name written otherwise everywhere in a file: FOON text, JSON, and the tables beside them."""

import json
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from enum import StrEnum
from pathlib import PurePath
from typing import NamedTuple

from foon_asp.network import Contents, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, Rename, Severity
from foon_asp.text.json_layout import TOKEN, check_json
from foon_asp.text.json_object import is_none
from foon_asp.text.json_value import json_line
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine, name_of
from foon_asp.text.line_parser import parse_line, parse_node
from foon_asp.text.plain_file import is_json, is_neutral
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line


class NameKind(StrEnum):
    """What a name is for; an object is named by its label, as a container and as an ingredient."""

    OBJECT = "object"
    STATE = "state"
    WORD = "relation"
    MOTION = "motion"


# The tables of a data folder that have names: of what kind the first field is, and whether nodes may follow.
TABLES = {
    "motion.txt": NameKind.MOTION,
    "durations.txt": NameKind.MOTION,
    "unit_prices.txt": NameKind.MOTION,
    "utensils.txt": NameKind.OBJECT,
    "tools.txt": NameKind.OBJECT,
}
_LINE = re.compile(r"([^\r\n]*)(\r\n|\r|\n|\Z)")
_FIELD = re.compile(r"[^\t\[\]{},]+")
_KINDS = {ObjectLine: NameKind.OBJECT, MotionLine: NameKind.MOTION}
_LABELS = {"label", "object_label"}
_STATES = {"states", "object_states"}
_RELATED = {"relative_object", "related_object"}
_NAMED = {*_LABELS, "state_label", "motion_label"}  # by the id beside it
_IDS = {NameKind.OBJECT: "object_id", NameKind.MOTION: "motion_id"}


class Renaming:
    """Writes a name otherwise in any number of files, of which all are learnt before the first is written.

    Where the new name has an id already, the lines of the old one get it; else they keep theirs.
    ``mentions`` counts how often the old name stood, ``already`` how often the new one did.
    """

    def __init__(self, rename: Rename, reader: FoonReader | None = None) -> None:
        self.rename = rename
        self.reader = reader or FoonReader()
        self.mentions = self.already = 0
        self._ids: Counter[str] = Counter()

    def learn(self, text: str, file: str) -> None:
        """Count the names of a file and note their ids; raises :class:`InputError` for JSON that is none."""
        kind, old, new = self.rename
        if is_json(text) and not is_neutral(text):
            check_json(text, file)
        for name_kind, name, id_ in mentioned(text, file, self.reader):
            if name_kind == kind and name == new:
                self.already += 1
                self._ids[id_] += bool(id_)
            self.mentions += name_kind == kind and name == old

    def learn_ids(self, ids: Mapping[str, int]) -> None:
        """Note how often which ids stand with the new name, where that is known already."""
        self._ids.update(ids)

    def not_understood(self, text: str, file: str) -> list[Diagnostic]:
        """Give the errors of lines that have the old name in them, and stay, as they are not understood."""
        if PurePath(file).name in TABLES or is_json(text):
            return []
        return [
            Diagnostic(Severity.ERROR, "syntax", str(error), Source(file, number, error.column), line)
            for number, line in enumerate(_lines(text), 1)
            if self.rename.old in line
            and line[:1] not in {"#", "/"}
            and isinstance(error := self.reader.parse(line), LineError)
        ]

    def renamed(self, text: str, file: str) -> str:
        """Give the text of a file with the new name; everything else stays as it is."""
        if PurePath(file).name in TABLES:
            return _each_line(text, lambda line: self._row(line, PurePath(file).name))
        if is_json(text):
            return self._json(text)
        return _each_line(text, self.line)

    def rows_of_new_name(self, text: str, file: str) -> list[str]:
        """Give the different rows that a renamed table has for the new name, where it may have only one."""
        if PurePath(file).name not in TABLES:
            return []
        rows = (line.split("\t") for line in _lines(text))
        return list(
            dict.fromkeys(
                "\t".join(row) for row in rows if len(row) == 2 and row[0].strip() == self.rename.new
            )
        )

    def line(self, line: str) -> str:
        """Give a line of FOON text with the new name."""
        if self.rename.old not in line or line[:1] not in {"O", "S", "M"}:
            return line
        parsed = self.reader.parse(line)
        if isinstance(parsed, LineError):
            return line
        wanted = self._said(parsed)
        if wanted == parsed:
            return line
        if self._names_it(parsed):
            wanted = wanted._replace(id=self._id(parsed.id))
        letter = line.partition("\t")[0]
        fields = line[len(letter) :]
        head = f"{line[:1]}{wanted.id}" if letter == f"{line[:1]}{parsed.id}" else letter
        _, old, new = self.rename
        spelt = head + _FIELD.sub(
            lambda m: m[0].replace(old, new) if m[0].strip(" *") == old else m[0], fields
        )
        found = self.reader.parse(spelt)
        # what else stands in the line stays as it is written, unless the name stands in it for something else
        same = not isinstance(found, LineError) and found._replace(remarks=()) == wanted._replace(remarks=())
        return spelt if same else write_line(wanted)

    def _names_it(self, line: Line) -> bool:
        """Whether the id of a line is that of the old name."""
        return name_of(line) == self.rename.old and self.rename.kind == _kind(line)

    def _id(self, before: str) -> str:
        return self._ids.most_common(1)[0][0] if before and self._ids else before

    def _name(self, kind: NameKind, name: str) -> str:
        return self.rename.new if (kind, name) == self.rename[:2] else name

    def _said(self, line: Line) -> Line:
        if isinstance(line, ObjectLine):
            return line._replace(label=self._name(NameKind.OBJECT, line.label))
        if isinstance(line, MotionLine):
            return line._replace(motion=self._name(NameKind.MOTION, line.motion))
        return line._replace(attribute=self._attribute(line.attribute), listed=self._items(line.listed))

    def _attribute(self, attribute: str | Relation | Contents) -> str | Relation | Contents:
        if isinstance(attribute, str):
            return self._name(NameKind.STATE, attribute)
        word = self._name(NameKind.WORD, attribute.word)
        if isinstance(attribute, Relation):
            return Relation(word, self._name(NameKind.OBJECT, attribute.object))
        return Contents(word, tuple(sorted(self._items(attribute.ingredients))))

    def _items(self, items: tuple[str, ...]) -> tuple[str, ...]:
        """Give ingredients with the new name, once where it stands among them already."""
        kind, old, new = self.rename
        if kind == NameKind.OBJECT and new in items:
            return tuple(item for item in items if item != old)
        return tuple(self._name(NameKind.OBJECT, item) for item in items)

    def _node(self, field: str) -> str:
        """Give a node in one-line notation with the new name; what is none stays."""
        try:
            node = parse_node(field.strip())
        except LineError:
            return field
        wanted = ObjectNode.of(
            self._name(NameKind.OBJECT, node.label),
            (self._name(NameKind.STATE, state) for state in node.states),
            (self._attribute(relation) for relation in node.relations),  # type: ignore[misc]
            (self._attribute(contents) for contents in node.contents),  # type: ignore[misc]
        )
        return field if wanted == node else str(wanted) + ";" * field.rstrip().endswith(";")

    def _row(self, line: str, table: str) -> str:
        if not line.strip() or line[:1] == "#":
            return line
        first, *fields = line.split("\t")
        if table == "tools.txt" and ";" in first:
            first = self._node(first)
        elif self._name(TABLES[table], first.strip()) != first.strip():
            first = first.replace(self.rename.old, self.rename.new)
        if table == "unit_prices.txt":
            fields = [*map(self._node, fields[:-1]), *fields[-1:]]
        return "\t".join((first, *fields))

    def _json(self, text: str) -> str:
        edits: list[tuple[int, int, str]] = []
        for found in _json_names(text):
            name = found.name
            if _is_state_line(found):
                spelt = self.line(f"S\t{name}").removeprefix("S\t")
            else:
                spelt = self._name(found.kind, name)
            if spelt != name:
                edits.append((found.start, found.end, json_line(spelt + found.rest)))
                if found.id_span:
                    start, end = found.id_span
                    edits.append((start, end, text[start:end].replace(found.id, self._id(found.id))))
        parts: list[str] = []
        done = 0
        for start, end, spelt in sorted(edits):
            parts += text[done:start], spelt
            done = end
        return "".join((*parts, text[done:]))


def mentioned(text: str, file: str, reader: FoonReader) -> Iterator[tuple[NameKind, str, str]]:
    """Give every mention of a name in a file, with its kind and the id that stands with it, if any."""
    table = TABLES.get(PurePath(file).name)
    if table:
        for line in _lines(text):
            if line.strip() and line[:1] != "#":
                yield table, line.partition("\t")[0].strip(), ""
        return
    if is_json(text):
        for found in _json_names(text):
            state = reader.parse(f"S\t{found.name}") if _is_state_line(found) else None
            if state is None or isinstance(state, LineError):
                yield found.kind, found.name, found.id
            else:
                yield from line_names(state)
        return
    lines = _lines(text)
    for written in lines:
        if written[:1] in {"O", "S", "M"} and not isinstance(parsed := reader.parse(written), LineError):
            yield from line_names(parsed)


def is_name(kind: str, name: str) -> bool:
    """Whether a text can be a name of a kind, wherever names of that kind stand in FOON text."""
    if not name or any(letter in name for letter in "\r\n"):
        return False
    letter, brackets = {"object": ("O", ("[", "]", "{", "}")), "motion": ("M", ())}.get(kind, ("S", ()))
    written = f"{letter}\t{name}" + "\t[x]" * (kind == NameKind.WORD)
    lines = [written, *(f"S\tin\t{o}{name}{c}" for o, c in zip(brackets[::2], brackets[1::2], strict=True))]
    try:
        said = [
            name_ for line in map(parse_line, lines) if not line.remarks for _, name_, _ in line_names(line)
        ]
    except LineError:
        return False
    return said == ([name, "in", name, "in", name] if brackets else [name, "x"] if len(said) == 2 else [name])


def line_names(line: Line) -> Iterator[tuple[NameKind, str, str]]:
    """Give the names that a line mentions, each with its kind, and with the id of the line if it is its."""
    yield _kind(line), name_of(line), line.id
    if isinstance(line, StateLine):
        if isinstance(line.attribute, Relation):
            yield NameKind.OBJECT, line.attribute.object, ""
        elif isinstance(line.attribute, Contents):
            yield from ((NameKind.OBJECT, item, "") for item in line.attribute.ingredients)


def _kind(line: Line) -> NameKind:
    if isinstance(line, StateLine):
        return NameKind.STATE if isinstance(line.attribute, str) else NameKind.WORD
    return _KINDS[type(line)]


def _lines(text: str) -> list[str]:
    return [match[1] for match in _LINE.finditer(text)]


def _each_line(text: str, write: Callable[[str], str]) -> str:
    return _LINE.sub(lambda match: write(match[1]) + match[2], text)


class _JsonName(NamedTuple):
    """A name in JSON: where its quotes are, and the id beside it with its place, if there is one.

    ``rest`` is what stands behind the name and is no part of it: the ``*`` of a composite motion.
    """

    kind: NameKind
    name: str
    start: int
    end: int
    rest: str = ""
    id: str = ""
    id_span: tuple[int, int] | None = None


class _Level:
    """A list or an object of JSON while it is read: the key at hand, and the key that it is the value of."""

    def __init__(self, owner: str, is_list: bool) -> None:
        self.owner, self.is_list = owner, is_list
        self.key = owner if is_list else ""
        self.names: list[tuple[str, _JsonName]] = []
        self.ids: dict[str, tuple[str, tuple[int, int]]] = {}


def _json_names(text: str) -> list[_JsonName]:
    """Give the names of a text that is JSON, those of an object when it ends."""
    levels = [_Level("", True)]
    found: list[_JsonName] = []
    tokens = list(TOKEN.finditer(text))
    for match, after in zip(tokens, [*tokens[1:], None], strict=True):
        token, level = match[0], levels[-1]
        if token in {"{", "["}:
            levels.append(_Level(level.key, token == "["))
        elif token in {"}", "]"}:
            found += _with_ids(levels.pop())
        elif token in {":", ","}:
            continue
        elif not level.is_list and after is not None and after[0] == ":":
            level.key = str(json.loads(token))
        elif level.key.endswith("_id"):
            level.ids[level.key] = token.strip('"'), match.span()
        elif token[0] == '"' and (kind := _json_kind(level)):
            written = str(json.loads(token, strict=False))
            composite = kind is NameKind.MOTION and level.key != "id" and written.rstrip(" ").endswith("*")
            name = written.strip(" ").rstrip("* ") if composite else written.strip(" ")
            rest = "*" if composite else ""
            level.names.append((level.key, _JsonName(kind, name, *match.span(), rest)))
    return found


def _with_ids(level: _Level) -> Iterator[_JsonName]:
    """Give the names of an object of JSON; a label has the id beside it, a container has none."""
    related = any(key in _RELATED and not is_none(name.name) for key, name in level.names)
    for key, name in level.names:
        kind = NameKind.WORD if related and name.kind is NameKind.STATE else name.kind
        id_ = level.ids.get(_IDS.get(kind, "state_id")) if key in _NAMED else None
        yield name._replace(kind=kind, id=id_[0], id_span=id_[1]) if id_ else name._replace(kind=kind)


def _is_state_line(found: _JsonName) -> bool:
    return found.kind is NameKind.STATE and re.search(r"[\[{]", found.name) is not None


def _json_kind(level: _Level) -> NameKind | None:
    """Say of what kind a text is, by the keys over it."""
    key = level.key
    if key in {"motion_label", "motion_node", "id"}:
        return NameKind.MOTION
    if key in _STATES or key == "state_label" or (key == "label" and level.owner in _STATES):
        return NameKind.STATE
    if key in _LABELS or key in {"container", "ingredients", "inputs", "outputs", *_RELATED}:
        return NameKind.OBJECT
    return None
