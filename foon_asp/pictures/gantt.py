"""A schedule as rows of a Gantt chart, and times as text."""

from fractions import Fraction
from typing import NamedTuple

from foon_asp.results.timed_step import TimedStep


class Gantt(NamedTuple):
    """A schedule under a title: its steps as ``rows``, and its makespan in seconds."""

    title: str
    rows: tuple[TimedStep, ...]
    makespan: Fraction

    @property
    def sorted_rows(self) -> list[TimedStep]:
        """The rows, by start, then by end, then by step."""
        return sorted(self.rows, key=lambda row: (row.start, row.end, row.step))


def time_text(seconds: Fraction) -> str:
    """Return seconds as ``M:SS``, or ``H:MM:SS`` from an hour on, rounded to three decimals.

    Zeros at the end of the decimals are left out: ``1:30.5``.
    """
    whole_seconds, milliseconds = divmod(round(seconds * 1000), 1000)
    total_minutes, second = divmod(whole_seconds, 60)
    hour, minute = divmod(total_minutes, 60)
    text = f"{hour}:{minute:02d}:{second:02d}" if hour else f"{minute}:{second:02d}"
    return text + (f".{milliseconds:03d}".rstrip("0") if milliseconds else "")
