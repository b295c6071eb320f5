"""The names in FOON units and lists of objects that are written in JSON."""

import json
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.errors import UserError
from foon_asp.text.json_layout import TOKEN
from foon_asp.text.json_object import is_none
from foon_asp.text.json_value import json_line
from foon_asp.text.line import LineError, Mention, NameKind, line_names
from foon_asp.text.line_parser import read_line

if TYPE_CHECKING:
    from foon_asp.text.renaming import Renaming

_LABELS = {"label", "object_label"}
_STATES = {"states", "object_states"}
_RELATED = {"relative_object", "related_object"}
_NAMED = {*_LABELS, "state_label", "motion_label"}  # by the id beside it
_CONTENTS = "contains"  # the word that listed ingredients are read under
_IDS = {NameKind.OBJECT: "object_id", NameKind.MOTION: "motion_id"}


def json_mentions(text: str) -> Iterator[Mention]:
    """Yield every mention of a name in a text that is JSON; a state may be written as a state line is."""
    for found in _json_names(text):
        state = read_line(f"S\t{found.name}") if _is_state_line(found) else None
        if state is None or isinstance(state, LineError):
            yield Mention(found.kind, found.name, found.id)
        else:
            yield from line_names(state)


def renamed_json(text: str, renaming: "Renaming") -> str:
    """Return a text that is JSON with the new name; everything else stays as it is written."""
    edits: list[tuple[int, int, str]] = []
    names = _json_names(text)
    word = renaming.rename
    if word.kind == NameKind.WORD and word.old == _CONTENTS and any(map(_is_word_of_list, names)):
        raise UserError(
            f"JSON lists ingredients under the word {_CONTENTS!r} alone, which cannot be renamed there; "
            "convert the file to text before"
        )
    for found in names:
        name = found.name
        if _is_state_line(found):
            spelt = renaming.line(f"S\t{name}").removeprefix("S\t").replace("\t", " ")
        else:
            spelt = renaming.name(found.kind, name)
        if spelt != name:
            edits.append((found.start, found.end, json_line(spelt + found.rest)))
            if found.id_span:
                start, end = found.id_span
                edits.append((start, end, text[start:end].replace(found.id, renaming.id(found.id))))
    parts: list[str] = []
    done = 0
    for start, end, spelt in sorted(edits):
        parts += text[done:start], spelt
        done = end
    return "".join((*parts, text[done:]))


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
    """A list or an object of JSON while it is read: its current key, and the key that it is the value of.

    ``first`` is how many names there were when it began.
    """

    def __init__(self, owner: str, is_list: bool, first: int = 0) -> None:
        self.owner, self.is_list, self.first = owner, is_list, first
        self.lists_ingredients = False
        self.key = owner if is_list else ""
        self.names: list[tuple[str, _JsonName]] = []
        self.ids: dict[str, tuple[str, tuple[int, int]]] = {}


def _json_names(text: str) -> list[_JsonName]:
    """Return the names of a text that is JSON, those of an object when it ends."""
    levels = [_Level("", True)]
    found: list[_JsonName] = []
    tokens = list(TOKEN.finditer(text))
    for match, after in zip(tokens, [*tokens[1:], None], strict=True):
        token, level = match[0], levels[-1]
        if token in {"{", "["}:
            levels.append(_Level(level.key, token == "[", len(found)))
        elif token in {"}", "]"}:
            levels.pop()
            found += _with_ids(level)
            if level.is_list and level.owner == "ingredients":
                levels[-1].lists_ingredients = any(not is_none(each.name) for each in found[level.first :])
            elif level.lists_ingredients:
                _name_contents(found, level.first)
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
    """Yield the names of an object of JSON; a label has the id beside it, a container has none."""
    related = any(key in _RELATED and not is_none(name.name) for key, name in level.names)
    for key, name in level.names:
        kind = NameKind.WORD if related and name.kind is NameKind.STATE else name.kind
        id_ = level.ids.get(_IDS.get(kind, "state_id")) if key in _NAMED else None
        yield name._replace(kind=kind, id=id_[0], id_span=id_[1]) if id_ else name._replace(kind=kind)


def _is_word_of_list(name: _JsonName) -> bool:
    return name.kind is NameKind.WORD and name.name == _CONTENTS


def _name_contents(names: list[_JsonName], first: int) -> None:
    """Make the state ``contains`` of an object that lists ingredients the word of its contents."""
    for index in range(first, len(names)):
        if names[index].kind is NameKind.STATE and names[index].name == _CONTENTS:
            names[index] = names[index]._replace(kind=NameKind.WORD)
            return


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
