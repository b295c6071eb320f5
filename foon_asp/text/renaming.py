"""Renaming of a name everywhere in a file: in FOON text, JSON, and the tables beside a network."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping

from foon_asp.network import Contents, ObjectNode, Relation
from foon_asp.text.diagnostics import Rename
from foon_asp.text.line import (
    Line,
    LineError,
    Mention,
    MotionLine,
    NameKind,
    ObjectLine,
    kind_of,
    line_names,
    name_of,
)
from foon_asp.text.line_parser import parse_line, parse_node, read_line
from foon_asp.text.writer import write_line

_FIELD = re.compile(r"[^\t\[\]{},]+")


class Renaming:
    """A renaming of one name, to be applied after :meth:`learn` has read all mentions in all files.

    If the new name already has an id, lines with the old name get this id. Otherwise they keep their ids.
    ``mentions`` counts the mentions of the old name, ``new_mentions`` the mentions of the new name.
    """

    def __init__(self, rename: Rename) -> None:
        self.rename = rename
        self.mentions = self.new_mentions = 0
        self._ids: Counter[str] = Counter()

    def learn(self, mentions: Iterable[Mention]) -> None:
        """Count mentions of the old and of the new name, and record the ids of the new name."""
        kind, old, new = self.rename
        for name_kind, name, id_ in mentions:
            if name_kind == kind and name == new:
                self.new_mentions += 1
                self._ids[id_] += bool(id_)
            self.mentions += name_kind == kind and name == old

    def learn_ids(self, ids: Mapping[str, int]) -> None:
        """Record ids of the new name; ``ids`` maps each id to the number of lines that have it."""
        self._ids.update(ids)

    def line(self, line: str) -> str:
        """Return a line of FOON text with the new name; all else stays as written where that is possible.

        An id of the old name is replaced, too, as :meth:`id` says. Lines without the old name, and lines that
        cannot be understood, are returned as they are.
        """
        if self.rename.old not in line or line[:1] not in {"O", "S", "M"}:
            return line
        parsed = read_line(line)
        if isinstance(parsed, LineError):
            return line
        renamed = self._rename_in_line(parsed)
        if renamed == parsed:
            return line
        if self._id_belongs_to_old_name(parsed):
            renamed = renamed._replace(id=self.id(parsed.id))
        letter_and_id = line.partition("\t")[0]
        fields = line[len(letter_and_id) :]
        new_letter_and_id = (
            f"{line[:1]}{renamed.id}" if letter_and_id == f"{line[:1]}{parsed.id}" else letter_and_id
        )
        _, old, new = self.rename
        text = new_letter_and_id + _FIELD.sub(
            lambda match: match[0].replace(old, new) if match[0].strip(" *") == old else match[0], fields
        )
        parsed_back = read_line(text)
        # the spelling of the line stays, unless the old name is in it with another meaning
        is_same = not isinstance(parsed_back, LineError) and parsed_back._replace(
            remarks=()
        ) == renamed._replace(remarks=())
        return text if is_same else write_line(renamed)

    def _id_belongs_to_old_name(self, line: Line) -> bool:
        """Whether the id of a line belongs to the old name."""
        return name_of(line) == self.rename.old and self.rename.kind == kind_of(line)

    def id(self, old_id: str) -> str:
        """Return the id to write in place of ``old_id``: the most frequent one of the new name.

        Returns ``old_id`` itself if it is empty, or if the new name has no id.
        """
        return self._ids.most_common(1)[0][0] if old_id and self._ids else old_id

    def name(self, kind: NameKind, name: str) -> str:
        """Return a name of a kind: the new name in place of the old one, any other name as it is."""
        return self.rename.new if (kind, name) == self.rename[:2] else name

    def _rename_in_line(self, line: Line) -> Line:
        """Return a parsed line with the new name in place of the old one; its id stays."""
        if isinstance(line, ObjectLine):
            return line._replace(label=self.name(NameKind.OBJECT, line.label))
        if isinstance(line, MotionLine):
            return line._replace(motion=self.name(NameKind.MOTION, line.motion))
        return line._replace(
            attribute=self._rename_in_attribute(line.attribute), listed=self._rename_ingredients(line.listed)
        )

    def _rename_in_attribute(self, attribute: str | Relation | Contents) -> str | Relation | Contents:
        """Return a state, relation or contents with the new name in place of the old one."""
        if isinstance(attribute, str):
            return self.name(NameKind.STATE, attribute)
        word = self.name(NameKind.WORD, attribute.word)
        if isinstance(attribute, Relation):
            return Relation(word, self.name(NameKind.OBJECT, attribute.object))
        return Contents(word, tuple(sorted(self._rename_ingredients(attribute.ingredients))))

    def _rename_ingredients(self, items: tuple[str, ...]) -> tuple[str, ...]:
        """Return ingredients with the new name in place of the old one.

        If the new name is among them already, the old one is removed.
        """
        kind, old, new = self.rename
        if kind == NameKind.OBJECT and new in items:
            return tuple(item for item in items if item != old)
        return tuple(self.name(NameKind.OBJECT, item) for item in items)

    def node(self, field: str) -> str:
        """Return a node in one-line notation with the new name.

        A text that is no notation, and a node without the old name, are returned as they are written.
        """
        try:
            node = parse_node(field.strip())
        except LineError:
            return field
        renamed = ObjectNode.of(
            self.name(NameKind.OBJECT, node.label),
            (self.name(NameKind.STATE, state) for state in node.states),
            (self._rename_in_attribute(relation) for relation in node.relations),  # type: ignore[misc]
            (self._rename_in_attribute(contents) for contents in node.contents),  # type: ignore[misc]
        )
        return field if renamed == node else str(renamed) + ";" * field.rstrip().endswith(";")


def is_name(kind: str, name: str) -> bool:
    """Whether a text can be a name of a kind wherever FOON text may have such a name."""
    if not name or any(letter in name for letter in "\r\n"):
        return False
    letter, brackets = {"object": ("O", ("[", "]", "{", "}")), "motion": ("M", ())}.get(kind, ("S", ()))
    written = f"{letter}\t{name}" + "\t[x]" * (kind == NameKind.WORD)
    lines = [written, *(f"S\tin\t{o}{name}{c}" for o, c in zip(brackets[::2], brackets[1::2], strict=True))]
    try:
        names = [
            name_ for line in map(parse_line, lines) if not line.remarks for _, name_, _ in line_names(line)
        ]
    except LineError:
        return False
    return names == (
        [name, "in", name, "in", name] if brackets else [name, "x"] if len(names) == 2 else [name]
    )
