"""Fields of a line of FOON text, which may be incomplete while somebody types."""

import re
from typing import NamedTuple

from foon_asp.text.line import NameKind

_LINE_HEAD = re.compile(r"([OSM])(\d*)\t")
NAME_KINDS: dict[str, tuple[NameKind, ...]] = {
    "O": (NameKind.OBJECT,),
    "S": (NameKind.STATE, NameKind.WORD),
    "M": (NameKind.MOTION,),
}
"""The kinds of names that a line may have, by its first letter."""
_FIELD = re.compile(r"[^\t\[\]{},]*")


class Field(NamedTuple):
    """A field of a line that holds a name, which may be empty.

    ``kinds``: the kinds that the name may have.
    ``start``, ``end``: the index of the first letter of the name, and the index after the last.
    ``letter``: the letter of the line, O, S or M.
    ``id``: the id at the head of the line, if it is the id of this name; empty if the head has no id.
    ``None`` if the id at the head is that of another name.
    """

    kinds: tuple[NameKind, ...]
    name: str
    start: int
    end: int
    letter: str
    id: str | None


def field_at(line: str, position: int) -> Field | None:
    """Return the field of a line that contains the letter at ``position`` or ends before it.

    Return ``None`` if no name can be there. In the line of a state, a name in brackets is that of an object,
    and the text before brackets is a word of relations. Blanks around a name and asterisks after a motion are
    not part of it.
    """
    head = _LINE_HEAD.match(line)
    if head is None or position < head.end():
        return None
    letter, id_ = head.groups()
    kinds = NAME_KINDS[letter]
    fields = _FIELD.finditer(line, head.end())
    field = next(field for field in fields if field.start() <= position <= field.end())
    prefix = line[head.end() : field.start()]
    if letter == "S" and re.search(r"[\[{][^\]}]*$", prefix):
        kinds, id_ = (NameKind.OBJECT,), None
    elif "\t" in prefix or re.search(r"[\]}]", prefix):
        return None
    elif letter == "S" and re.search(r"[\[{]", line):
        kinds = (NameKind.WORD,)
    name = field[0].strip(" ")
    if letter == "M":
        name = name.rstrip("* ") or name
    start = field.end() - len(field[0].lstrip(" "))
    return Field(kinds, name, min(start, position), max(start + len(name), position), letter, id_)
