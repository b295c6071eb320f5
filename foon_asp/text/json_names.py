"""The names in FOON units and lists of objects in JSON, and their renaming."""

import json
import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.errors import UserError
from foon_asp.json_layout import json_line
from foon_asp.text.foon_json_indent import TOKEN
from foon_asp.text.json_object import LISTED_UNDER, is_none
from foon_asp.text.line import LineError, Mention, NameKind, line_names
from foon_asp.text.line_parser import read_line

if TYPE_CHECKING:
    from foon_asp.text.renaming import Renaming

_LABELS = {"label", "object_label"}
_STATES = {"states", "object_states"}
_RELATED = {"relative_object", "related_object"}
_NAMED = {*_LABELS, "state_label", "motion_label"}  # by the id beside it
_IDS = {NameKind.OBJECT: "object_id", NameKind.MOTION: "motion_id"}


def json_mentions(text: str) -> Iterator[Mention]:
    """Yield every mention of a name in a JSON text.

    A state with brackets, ``in [bowl]``, has several mentions: of its word, and of each object in the
    brackets.
    """
    for json_name in _json_names(text):
        state = read_line(f"S\t{json_name.name}") if _is_state_line(json_name) else None
        if state is None or isinstance(state, LineError):
            yield Mention(json_name.kind, json_name.name, json_name.id)
        else:
            yield from line_names(state)


def rename_in_json(text: str, renaming: "Renaming") -> str:
    """Return a JSON text in which ``renaming`` has replaced the name and, beside it, its id.

    Everything else stays as it is written. Raises :class:`UserError` if the word ``contains`` is to be
    renamed in a text that lists ingredients. Listed ingredients are always read under this word.
    """
    edits: list[tuple[int, int, str]] = []
    names = _json_names(text)
    rename = renaming.rename
    if rename.kind == NameKind.WORD and rename.old == LISTED_UNDER and any(map(_is_contains_word, names)):
        raise UserError(
            f"JSON lists ingredients under the word {LISTED_UNDER!r} alone, which cannot be renamed there; "
            "convert the file to text before"
        )
    for json_name in names:
        name = json_name.name
        if _is_state_line(json_name):
            new_name = renaming.line(f"S\t{name}").removeprefix("S\t").replace("\t", " ")
        else:
            new_name = renaming.name(json_name.kind, name)
        if new_name != name:
            edits.append((json_name.start, json_name.end, json_line(new_name + json_name.suffix)))
            if json_name.id_span:
                start, end = json_name.id_span
                edits.append((start, end, text[start:end].replace(json_name.id, renaming.id(json_name.id))))
    parts: list[str] = []
    copied = 0
    for start, end, new_text in sorted(edits):
        parts += text[copied:start], new_text
        copied = end
    return "".join((*parts, text[copied:]))


class _JsonName(NamedTuple):
    """A name in a JSON text, with its position, and with its id if it has one.

    ``start``, ``end``: the position of the name with its quotes.
    ``suffix``: the text behind the name that is no part of it: the ``*`` of a composite motion.
    ``id_span``: the position of the id.
    """

    kind: NameKind
    name: str
    start: int
    end: int
    suffix: str = ""
    id: str = ""
    id_span: tuple[int, int] | None = None


class _Level:
    """A list or an object while JSON is read.

    ``owner``: the key whose value it is.
    ``key``: the key whose value is being read; in a list, the ``owner``.
    ``names_before``: the number of names that were read before it.
    ``lists_ingredients``: true for an object with ingredients.
    ``names``, ``ids``: the names and the ids directly in it, each with its key.
    """

    def __init__(self, owner: str, is_list: bool, names_before: int = 0) -> None:
        self.owner, self.is_list, self.names_before = owner, is_list, names_before
        self.lists_ingredients = False
        self.key = owner if is_list else ""
        self.names: list[tuple[str, _JsonName]] = []
        self.ids: dict[str, tuple[str, tuple[int, int]]] = {}


def _json_names(text: str) -> list[_JsonName]:
    """Return the names of a JSON text, with their kinds, positions and ids.

    Names directly in an object come after names that are nested deeper in it. Blanks around a name and the
    ``*`` of a composite motion are no part of it. The text has to be JSON.
    """
    levels = [_Level("", True)]
    names: list[_JsonName] = []
    tokens = list(TOKEN.finditer(text))
    for match, next_token in zip(tokens, [*tokens[1:], None], strict=True):
        token, level = match[0], levels[-1]
        if token in {"{", "["}:
            levels.append(_Level(level.key, token == "[", len(names)))
        elif token in {"}", "]"}:
            levels.pop()
            names += _names_with_ids(level)
            if level.is_list and level.owner == "ingredients":
                levels[-1].lists_ingredients = any(
                    not is_none(each.name) for each in names[level.names_before :]
                )
            elif level.lists_ingredients:
                _mark_word_of_contents(names, level.names_before)
        elif token in {":", ","}:
            continue
        elif not level.is_list and next_token is not None and next_token[0] == ":":
            level.key = str(json.loads(token))
        elif level.key.endswith("_id"):
            level.ids[level.key] = token.strip('"'), match.span()
        elif token[0] == '"' and (kind := _json_kind(level)):
            written = str(json.loads(token, strict=False))
            composite = kind is NameKind.MOTION and level.key != "id" and written.rstrip(" ").endswith("*")
            plain_name = written.strip(" ").rstrip("* ") if composite else written.strip(" ")
            suffix = "*" if composite else ""
            level.names.append((level.key, _JsonName(kind, plain_name, *match.span(), suffix)))
    return names


def _names_with_ids(level: _Level) -> Iterator[_JsonName]:
    """Yield the names directly in an object or a list, with the ids that stand beside them.

    The label of an object node, a state and a motion may have an id. Containers, related objects and
    ingredients have none. A state beside a related object becomes the word of a relation.
    """
    related = any(key in _RELATED and not is_none(name.name) for key, name in level.names)
    for key, name in level.names:
        kind = NameKind.WORD if related and name.kind is NameKind.STATE else name.kind
        id_ = level.ids.get(_IDS.get(kind, "state_id")) if key in _NAMED else None
        yield name._replace(kind=kind, id=id_[0], id_span=id_[1]) if id_ else name._replace(kind=kind)


def _is_contains_word(name: _JsonName) -> bool:
    """Whether a name is the word ``contains`` of contents."""
    return name.kind is NameKind.WORD and name.name == LISTED_UNDER


def _mark_word_of_contents(names: list[_JsonName], first: int) -> None:
    """Make the first state ``contains`` of an object a word of contents, since the object lists ingredients.

    ``first`` is the index of the object's first name in ``names``. The list is changed in place.
    """
    for index in range(first, len(names)):
        if names[index].kind is NameKind.STATE and names[index].name == LISTED_UNDER:
            names[index] = names[index]._replace(kind=NameKind.WORD)
            return


def _is_state_line(json_name: _JsonName) -> bool:
    """Whether a state has brackets, and so may be a relation or contents: ``in [bowl]``."""
    return json_name.kind is NameKind.STATE and re.search(r"[\[{]", json_name.name) is not None


def _json_kind(level: _Level) -> NameKind | None:
    """Return the kind of a name that is read directly in ``level``, by its key; ``None`` if it is no name."""
    key = level.key
    if key in {"motion_label", "motion_node", "id"}:
        return NameKind.MOTION
    if key in _STATES or key == "state_label" or (key == "label" and level.owner in _STATES):
        return NameKind.STATE
    if key in _LABELS or key in {"container", "ingredients", "inputs", "outputs", *_RELATED}:
        return NameKind.OBJECT
    return None
