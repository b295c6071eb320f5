"""Fields of a line of FOON text, as they are while it is typed."""

import re
from typing import NamedTuple

from foon_asp.text.line import NameKind

_HEAD = re.compile(r"([OSM])(\d*)\t")
KINDS: dict[str, tuple[NameKind, ...]] = {
    "O": (NameKind.OBJECT,),
    "S": (NameKind.STATE, NameKind.WORD),
    "M": (NameKind.MOTION,),
}
"""The kinds of names that a line may be about, by its letter."""
_FIELD = re.compile(r"[^\t\[\]{},]*")


class Field(NamedTuple):
    """A field with a name, which may be empty, and the first and the end of its letters in the line.

    ``kinds`` are those that the name may have. ``letter`` and ``id`` are those of the line; ``id`` is
    ``None`` where it is the id of another name.
    """

    kinds: tuple[NameKind, ...]
    name: str
    start: int
    end: int
    letter: str
    id: str | None


def field_at(line: str, at: int) -> Field | None:
    """Return the field of a line at or before the letter ``at``; ``None`` where no name may be."""
    head = _HEAD.match(line)
    if head is None or at < head.end():
        return None
    letter, id_ = head.groups()
    kinds = KINDS[letter]
    fields = _FIELD.finditer(line, head.end())
    field = next(field for field in fields if field.start() <= at <= field.end())
    before = line[head.end() : field.start()]
    if letter == "S" and re.search(r"[\[{][^\]}]*$", before):
        kinds, id_ = (NameKind.OBJECT,), None
    elif "\t" in before or re.search(r"[\]}]", before):
        return None
    elif letter == "S" and re.search(r"[\[{]", line):
        kinds = (NameKind.WORD,)
    name = field[0].strip(" ")
    if letter == "M":
        name = name.rstrip("* ") or name
    start = field.end() - len(field[0].lstrip(" "))
    return Field(kinds, name, min(start, at), max(start + len(name), at), letter, id_)
