"""Subjects of facts: the arguments that stand for a unit, an object node or a label."""

from enum import StrEnum
from typing import NamedTuple

from foon_asp.rules.clause import Signature


class Subject(StrEnum):
    """The kind of thing that an argument of a fact stands for."""

    UNIT = "unit"
    OBJECT = "object node"
    LABEL = "label"


class Subjects(NamedTuple):
    """The arguments of a fact that stand for a unit, an object node or a label, by position from 0.

    ``about``: the subjects that the fact describes.
    ``leads_to``: the subjects that are in the tree whenever all subjects in ``about`` are.
    ``numbers``: the positions of numbers that are never negative.
    """

    about: dict[int, Subject]
    leads_to: dict[int, Subject]
    numbers: tuple[int, ...] = ()


_OF_UNIT = Subjects({0: Subject.UNIT}, {})
_UNIT_OBJECT = Subjects({0: Subject.UNIT}, {1: Subject.OBJECT})
_NUMBER_SUBJECTS = Subjects({0: Subject.UNIT}, {}, (1,))
_OF_OBJECT = Subjects({0: Subject.OBJECT}, {})

# Facts that are the same for a unit or a node whatever other facts there are. Facts not listed are not.
SUBJECTS: dict[Signature, Subjects] = {
    ("unit", 1): _OF_UNIT,
    ("motion", 2): _OF_UNIT,
    ("input", 2): _UNIT_OBJECT,
    ("output", 2): _UNIT_OBJECT,
    ("needs", 2): _UNIT_OBJECT,
    ("gives", 2): _UNIT_OBJECT,
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
    ("inputs", 2): _NUMBER_SUBJECTS,
    ("ingredients", 2): _NUMBER_SUBJECTS,
    ("rate", 2): _NUMBER_SUBJECTS,
    ("price", 2): _NUMBER_SUBJECTS,
}
# Predicates whose atoms depend on the tree.
DECISIONS: dict[Signature, Subjects] = {
    ("use", 1): Subjects({}, {0: Subject.UNIT}),
    ("available", 1): _OF_OBJECT,
}
