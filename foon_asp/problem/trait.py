"""What rules may ask of a unit, as far as a word says it."""

from collections.abc import Sequence
from enum import Enum, auto
from typing import NamedTuple


class Having(Enum):
    """As what a unit has a word: as its motion, or as label or ingredient of one of its inputs or outputs.

    ``MADE`` stands for an input that is not in the kitchen.
    """

    MOTION = auto()
    INPUT = auto()
    MADE = auto()
    OUTPUT = auto()


class Trait(NamedTuple):
    """That a unit has a word in some way."""

    having: Having
    word: str


class Wanted(NamedTuple):
    """A unit that rules ask for: it has all traits of one of some rows.

    ``always`` says that they do so in every network.
    """

    rows: Sequence[Sequence[Trait]]
    always: bool
