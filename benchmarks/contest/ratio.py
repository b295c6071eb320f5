"""Medians of figures of which some are known from one side only."""

from collections.abc import Sequence
from typing import NamedTuple


class Figure(NamedTuple):
    """A figure, or with ``beyond`` one that is larger than it."""

    value: float
    beyond: bool = False

    def __str__(self) -> str:
        """Give two or three digits, after ``>`` where it is larger."""
        value = self.value
        digits = 0 if value >= 99.5 else 1 if value >= 9.95 else 2 if value >= 0.0995 else 4
        return f"{'> ' * self.beyond}{value:,.{digits}f}"


def median(figures: Sequence[Figure]) -> Figure:
    """Give the median; it is a lower bound where one that is known from below could move it upwards."""
    ordered = sorted(figure.value for figure in figures)
    middle = ordered[(len(ordered) - 1) // 2], ordered[len(ordered) // 2]
    return Figure(sum(middle) / 2, any(figure.beyond and figure.value <= middle[1] for figure in figures))


def ratio(theirs: Figure, ours: Figure) -> Figure:
    """Divide; ``ours`` has to be known."""
    if ours.beyond:
        raise ValueError("a ratio to a time that is not known")
    return Figure(theirs.value / ours.value, theirs.beyond)
