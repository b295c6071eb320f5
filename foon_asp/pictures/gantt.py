"""A schedule as a chart shows it."""

from fractions import Fraction
from typing import NamedTuple

from foon_asp.results.timed_step import TimedStep


class Gantt(NamedTuple):
    """The steps of a schedule under a title, and how long it takes, in seconds."""

    title: str
    rows: tuple[TimedStep, ...]
    makespan: Fraction

    @property
    def in_order(self) -> list[TimedStep]:
        """The steps as they start."""
        return sorted(self.rows, key=lambda row: (row.start, row.end, row.step))


def time_text(seconds: Fraction) -> str:
    """Write a time as minutes and seconds, or with hours before them; of fractions three places."""
    thousandths = round(seconds * 1000)
    whole, part = divmod(thousandths, 1000)
    minutes, rest = divmod(whole, 60)
    hours, minutes_left = divmod(minutes, 60)
    text = f"{hours}:{minutes_left:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
    return text + (f".{part:03d}".rstrip("0") if part else "")
