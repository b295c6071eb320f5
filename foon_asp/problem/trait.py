"""Traits of units that rules require: a name in a role, such as the motion or an input."""

from collections.abc import Sequence
from enum import Enum, auto
from typing import NamedTuple


class Role(Enum):
    """The role that a name can have in a unit.

    ``MOTION``: the name is its motion.
    ``INPUT``: the name is the label or an ingredient of one of its inputs.
    ``OUTPUT``: the name is the label or an ingredient of one of its outputs.
    ``MADE``: as ``INPUT``, for an input that is not in the kitchen.
    """

    MOTION = auto()
    INPUT = auto()
    MADE = auto()
    OUTPUT = auto()


class Trait(NamedTuple):
    """A property of a unit: the name ``word`` has the role ``role`` in it."""

    role: Role
    word: str


class RequiredUnit(NamedTuple):
    """The description of a unit that rules require, in disjunctive normal form.

    The unit has all traits of at least one of ``rows``. ``always`` says whether the rules require such a unit
    in every network, or only in some networks.
    """

    rows: Sequence[Sequence[Trait]]
    always: bool
