"""Gantt: a schedule with a title, and the text of its times."""

from fractions import Fraction
from typing import NamedTuple

from foon_asp.results.timed_step import TimedStep


class Gantt(NamedTuple):
    """The steps of a schedule under a title, and its makespan in seconds."""

    title: str
    rows: tuple[TimedStep, ...]
    makespan: Fraction

    @property
    def in_order(self) -> list[TimedStep]:
        """The steps, ordered by their starts."""
        return sorted(self.rows, key=lambda row: (row.start, row.end, row.step))


def time_text(seconds: Fraction) -> str:
    """Return a time as ``M:SS``, or ``H:MM:SS`` from an hour on, with at most three decimals."""
    whole_seconds, milliseconds = divmod(round(seconds * 1000), 1000)
    total_minutes, second = divmod(whole_seconds, 60)
    hour, minute = divmod(total_minutes, 60)
    text = f"{hour}:{minute:02d}:{second:02d}" if hour else f"{minute}:{second:02d}"
    return text + (f".{milliseconds:03d}".rstrip("0") if milliseconds else "")
