"""What stands between two separators of a text that is edited: a unit, read by itself and once."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from foon_asp.lint.catalog import CATALOG
from foon_asp.lint.linted_files import mending_fix
from foon_asp.lint.noqa import unsilenced
from foon_asp.lint.sheet import Sheet
from foon_asp.network import Contents, ObjectNode, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.listed_unit import node_of
from foon_asp.text.reader import FoonReader
from foon_asp.text.renaming import NameKind, line_names

_UNIT = "O\tx\nM\tx\nO\tx\n//\n"  # stands before the last piece: that by itself could be a list of objects
_UNIT_LINES = _UNIT.count("\n")


class Name(NamedTuple):
    """A name with what it is for."""

    kind: NameKind
    name: str


class Told(NamedTuple):
    """A finding as an editor is told of it: a line of a piece, its start and end there, and more JSON."""

    line: int
    start: int
    end: int
    rest: str


class Block(NamedTuple):
    """An object node: from which line of a piece to before which, and whether the unit makes it."""

    start: int
    end: int
    node: ObjectNode
    is_output: bool


class Piece:
    """Lines up to a separator, which is the last of them, unless the text ends there.

    ``makes`` has the nodes that the unit makes: those among its outputs that it does not need.
    ``findings`` are those of the last linting, by index of the line, and ``told`` is how an editor is told of
    them; ``None`` where that is still to be put together.
    """

    __slots__ = (
        "blocks",
        "findings",
        "holding",
        "ids",
        "is_closed",
        "lines",
        "makes",
        "motion",
        "names",
        "told",
    )

    def __init__(self, lines: Sequence[str], is_closed: bool, reader: FoonReader) -> None:
        self.lines = tuple(lines)
        self.is_closed = is_closed
        self.findings: list[tuple[int, Diagnostic]] = []
        self.told: list[Told] | None = None
        self.motion: tuple[int, str] | None = None
        self.names: list[Name] = []
        self.ids: list[tuple[Name, str]] = []
        self.holding: list[str] = []  # words of contents
        blocks: list[Block] = []
        start, last, label = -1, -1, ""
        attributes: list[str | Relation | Contents] = []
        for index, line in enumerate((*self.lines, "//")):
            parsed = reader.parse(line) if line[:1] in {"O", "S", "M"} else None
            if parsed is not None and not isinstance(parsed, LineError):
                for kind, name, id_ in line_names(parsed):
                    self.names.append(Name(kind, name))
                    if id_:
                        self.ids.append((self.names[-1], id_))
            if isinstance(parsed, StateLine):
                attributes.append(parsed.attribute)
                if isinstance(parsed.attribute, Contents):
                    self.holding.append(parsed.attribute.word)
                last = index
                continue
            if line[:1] == "#" or (not line.strip() and index < len(self.lines)):
                continue
            if start >= 0:
                blocks.append(Block(start, last + 1, node_of(label, attributes), self.motion is not None))
                start = -1
            attributes = []
            if isinstance(parsed, ObjectLine):
                start, last, label = index, index, parsed.label
            elif isinstance(parsed, MotionLine) and self.motion is None:
                self.motion = index, parsed.motion
        self.blocks = tuple(blocks)
        needed = set(self.needs())
        self.makes = tuple(each.node for each in blocks if each.is_output and each.node not in needed)

    def needs(self) -> Iterator[ObjectNode]:
        """Give the nodes that the unit needs."""
        return (block.node for block in self.blocks if not block.is_output)

    def remarks(self, reader: FoonReader, is_list: bool) -> list[tuple[int, Diagnostic]]:
        """Give what the reader has to say of the piece alone, with the index of the line."""
        text = "\n".join(self.lines) + "\n" * self.is_closed
        if not text.strip():
            return []
        earlier = len(reader.diagnostics)
        if is_list:
            reader.object_blocks(text, "")
        elif self.is_closed:
            list(reader.listed_units(text, ""))
        else:
            list(reader.listed_units(_UNIT + text, ""))
        said = reader.diagnostics[earlier:]
        del reader.diagnostics[earlier:]
        before = 0 if is_list or self.is_closed else _UNIT_LINES
        findings = [
            each._replace(
                severity=CATALOG[each.code].severity,
                fix=mending_fix(each, reader),
                source=each.source._replace(line=each.source.line - before),
            )
            for each in said
            if each.code in CATALOG
        ]
        # whether a comment silences anything is known when all is linted
        heard = unsilenced(findings, [Sheet("", self.lines, reader)])
        return [(each.source.line - 1, each) for each in heard if each.code != "noqa"]
