"""Where names stand in a line of FOON text."""

import re
from typing import NamedTuple

from foon_asp.editor.piece import Name
from foon_asp.text.renaming import NameKind

_LINE = re.compile(r"([OSM])(\d*)\t")
_FIELD = re.compile(r"[^\t\[\]{},]+")


class NamePlace(NamedTuple):
    """A name, and the letters of the line that it takes, from and to before which."""

    name: Name
    start: int
    end: int


class Typed(NamedTuple):
    """What is being typed: names of some kinds, of which ``word`` is there, between two letters of the line.

    ``letter`` and ``id`` are those of the line; ``is_own`` says that the id is of the name that is typed.
    """

    kinds: tuple[NameKind, ...]
    word: str
    start: int
    end: int
    letter: str
    id: str
    is_own: bool


def names_in(line: str) -> list[NamePlace]:
    """Give the names in a line, as they stand in it, whether or not all of it is understood."""
    match = _LINE.match(line)
    if match is None:
        return []
    found: list[NamePlace] = []
    letter, start = match[1], match.end()
    bracket = re.search(r"[\[{]", line) if letter == "S" else None
    tab = line.find("\t", start)
    head = bracket.start() if bracket else tab if tab >= 0 and letter != "S" else len(line)
    kind = {"O": NameKind.OBJECT, "M": NameKind.MOTION}.get(
        letter, NameKind.WORD if bracket else NameKind.STATE
    )
    parts = [(kind, start, head)]
    if bracket:
        parts.append((NameKind.OBJECT, bracket.end(), len(line)))
    for kind, begin, end in parts:
        for field in _FIELD.finditer(line, begin, end):
            word = field[0].strip(" ")
            word = word.rstrip("* ") if kind is NameKind.MOTION and word.strip("* ") else word
            if word:
                at = field.start() + len(field[0]) - len(field[0].lstrip(" "))
                found.append(NamePlace(Name(kind, word), at, at + len(word)))
    return found


def name_at(line: str, column: int) -> NamePlace | None:
    """Give the name at a letter of a line, or right before it."""
    return next((place for place in names_in(line) if place.start <= column <= place.end), None)


def typed_at(line: str, column: int) -> Typed | None:
    """Say what is being typed in a line; ``None`` where no name may stand."""
    match = _LINE.match(line)
    if match is None or column < match.end():
        return None
    before = line[match.end() : column]
    start = match.end() + max((before.rfind(sign) + 1 for sign in "[{,\t"), default=0)
    start += len(line[start:column]) - len(line[start:column].lstrip(" "))
    in_brackets = re.search(r"[\[{][^\]}]*$", before) is not None
    rest = line[column:] if match[1] != "M" else line[column:].partition("*")[0]
    end = column + len(re.match(r"[^\t\[\]{},]*", rest)[0].rstrip(" "))  # type: ignore[index]
    word = line[start:column]
    letter, id_ = match[1], match[2]
    if letter == "S" and in_brackets:
        return Typed((NameKind.OBJECT,), word, start, end, letter, id_, False)
    if "\t" in before or re.search(r"[\]}]", before):
        return None
    kinds = {"O": (NameKind.OBJECT,), "M": (NameKind.MOTION,)}.get(letter, (NameKind.STATE, NameKind.WORD))
    return Typed(kinds, word, start, end, letter, id_, True)
