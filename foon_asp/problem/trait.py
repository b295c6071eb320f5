"""Traits of units that rules require: a name as motion, input or output."""

from collections.abc import Sequence
from enum import Enum, auto
from typing import NamedTuple


class Role(Enum):
    """The role of a name in a unit: its motion, or a label or ingredient of one of its inputs or outputs.

    ``MADE`` is an input that is not in the kitchen.
    """

    MOTION = auto()
    INPUT = auto()
    MADE = auto()
    OUTPUT = auto()


class Trait(NamedTuple):
    """The property of a unit to have a name in a role."""

    role: Role
    word: str


class RequiredUnit(NamedTuple):
    """A unit that rules require, described in disjunctive normal form: it has all traits of at least one row.

    ``always`` says that the rules require the unit whatever the network is.
    """

    rows: Sequence[Sequence[Trait]]
    always: bool
