"""Parsed lines of FOON text."""

from collections.abc import Iterator
from enum import StrEnum
from typing import NamedTuple, Self

from foon_asp.network import Contents, Relation

MOTION_FLAGS = {"0", "1"}
SLIPPED_FLAGS = {"00", "01"}


class NameKind(StrEnum):
    """The kind of a name: an object's label, a state, a motion, or the word of a relation or of contents.

    Containers and ingredients are objects.
    """

    OBJECT = "object"
    STATE = "state"
    WORD = "relation"
    MOTION = "motion"


class Mention(NamedTuple):
    """A mention of a name in a file, with its id, which may be empty."""

    kind: NameKind
    name: str
    id: str = ""


class Remark(NamedTuple):
    """A slip in a line that could be read all the same: its column (from 1), its kind and a message."""

    column: int
    code: str
    message: str


class ObjectLine(NamedTuple):
    """A line ``O278⇥mixing bowl⇥1⇥15``, which starts an object node.

    ``id`` is the number after the letter, or empty. ``fields`` are the texts after the label: the motion
    flag, and for a goal its recipe category or the mark ``!``. Neither ``id`` nor ``fields`` are part of the
    node.
    """

    label: str
    id: str = ""
    fields: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()

    @property
    def motion_flag(self) -> str | None:
        """``1`` when the object is in motion, ``0`` when it is not, ``None`` without a flag."""
        first = self.fields[0] if self.fields else None
        return first if first in MOTION_FLAGS else None

    @property
    def is_goal(self) -> bool:
        """Whether the line marks a goal of the recipe, by a category or by ``!``."""
        return bool(self.fields) and (self.category is not None or "!" in self.fields)

    @property
    def category(self) -> str | None:
        """The recipe category of a goal, ``None`` without one.

        It is the first field behind the motion flag that is a number other than ``00`` and ``01``.
        """
        fields = self.fields if self.motion_flag is None else self.fields[1:]
        return next((field for field in fields if is_number(field) and field not in SLIPPED_FLAGS), None)


class StateLine(NamedTuple):
    """A line that states an attribute of the node above it: a state, a relation or contents.

    Examples are ``S41⇥empty``, ``S65⇥in⇥[bowl]`` and ``S23⇥contains⇥{salt}``. ``listed`` are the ingredients
    of contents in the order written; this order is no part of the node.
    """

    attribute: str | Relation | Contents
    id: str = ""
    listed: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()


class MotionLine(NamedTuple):
    """A line ``M54⇥pour*⇥1:10⇥1:11``: the motion of a unit.

    ``composite`` is true for a ``*`` after the motion, which stands for several motions annotated as one.
    ``fields`` are the times as written. If there is a success rate, the moving entity and the rate follow. No
    field is part of the unit.
    """

    motion: str
    id: str = ""
    composite: bool = False
    fields: tuple[str, ...] = ()
    remarks: tuple[Remark, ...] = ()


Line = ObjectLine | StateLine | MotionLine


def name_of(line: Line) -> str:
    """Return the name that the id of a line belongs to.

    It is a label, a motion, a state, or the word of a relation or of contents.
    """
    if isinstance(line, ObjectLine):
        return line.label
    if isinstance(line, MotionLine):
        return line.motion
    return line.attribute if isinstance(line.attribute, str) else line.attribute.word


def kind_of(line: Line) -> NameKind:
    """Return the kind of the name that :func:`name_of` returns."""
    if isinstance(line, StateLine):
        return NameKind.STATE if isinstance(line.attribute, str) else NameKind.WORD
    return NameKind.OBJECT if isinstance(line, ObjectLine) else NameKind.MOTION


def line_names(line: Line) -> Iterator[Mention]:
    """Yield a mention of each name in a line.

    The first is the name of :func:`name_of`, with the id of the line. All others are objects without an id.
    """
    yield Mention(kind_of(line), name_of(line), line.id)
    if isinstance(line, StateLine):
        if isinstance(line.attribute, Relation):
            yield Mention(NameKind.OBJECT, line.attribute.object)
        elif isinstance(line.attribute, Contents):
            yield from (Mention(NameKind.OBJECT, item) for item in line.attribute.ingredients)


class LineError(Exception):
    """A text that the grammar does not accept: the column (from 1), what was found, and what was expected.

    ``advice`` is a correction that is added to the message, or empty.
    """

    def __init__(self, column: int, found: str, expected: tuple[str, ...], advice: str = "") -> None:
        alternatives = (
            ", ".join(expected[:-1]) + " or " + expected[-1] if len(expected) > 1 else "".join(expected)
        )
        super().__init__(f"found {found}, expected {alternatives}" + (f"; {advice}" if advice else ""))
        self.column = column
        self.found = found
        self.expected = expected

    def without_traceback(self) -> Self:
        """Return the error itself, after its traceback and context are removed, so that it may be kept."""
        self.__context__ = None
        return self.with_traceback(None)


def is_number(field: str) -> bool:
    """Whether a field is a number such as an id: only digits of ASCII, at least one."""
    return field.isascii() and field.isdigit()
