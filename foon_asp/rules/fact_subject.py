"""What facts are about: a unit, an object node or a label, and which others they lead to from there."""

from enum import StrEnum
from typing import NamedTuple

from foon_asp.rules.clause import Signature


class Subject(StrEnum):
    """What an argument stands for."""

    UNIT = "unit"
    OBJECT = "object node"
    LABEL = "label"


class Subjects(NamedTuple):
    """Of the arguments of a fact, by place: what it is about, and what can be reached from that.

    If it is about a unit of the tree, or an object node of one, so is what it leads to. The rest are names
    and numbers, which ``numbers`` says are never negative.
    """

    about: dict[int, Subject]
    leads_to: dict[int, Subject]
    numbers: tuple[int, ...] = ()


_OF_UNIT = Subjects({0: Subject.UNIT}, {})
_SIDE = Subjects({0: Subject.UNIT}, {1: Subject.OBJECT})
_NUMBER = Subjects({0: Subject.UNIT}, {}, (1,))
_OF_OBJECT = Subjects({0: Subject.OBJECT}, {})

# Facts that say the same of a unit or a node whatever else is in the facts. Those left out do not.
SUBJECTS: dict[Signature, Subjects] = {
    ("unit", 1): _OF_UNIT,
    ("motion", 2): _OF_UNIT,
    ("input", 2): _SIDE,
    ("output", 2): _SIDE,
    ("needs", 2): _SIDE,
    ("gives", 2): _SIDE,
    ("object", 1): _OF_OBJECT,
    ("label", 2): Subjects({0: Subject.OBJECT}, {1: Subject.LABEL}),
    ("state", 2): _OF_OBJECT,
    ("ingredient", 2): _OF_OBJECT,
    ("located", 3): _OF_OBJECT,
    ("kitchen", 1): _OF_OBJECT,
    ("goal", 1): Subjects({}, {0: Subject.OBJECT}),
    ("utensil", 1): Subjects({0: Subject.LABEL}, {}),
    ("source", 2): _OF_UNIT,
    ("video", 2): _OF_UNIT,
    ("inputs", 2): _NUMBER,
    ("ingredients", 2): _NUMBER,
    ("rate", 2): _NUMBER,
    ("price", 2): _NUMBER,
}
DECISIONS: dict[Signature, Subjects] = {
    ("use", 1): Subjects({}, {0: Subject.UNIT}),
    ("available", 1): _OF_OBJECT,
}
