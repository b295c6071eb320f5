"""Schedules as Gantt charts of text: a line for each step, as wide as there is room."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple

from rich.console import Console, ConsoleOptions, RenderResult
from rich.text import Text

from foon_asp.escapes import escaped

_HANDS = "123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
_NOBODY = "~"
_BAR, _ROOM = 20, 40  # letters of the bars: at least, and with the names of things
_WIDTH = 79


class GanttRow(NamedTuple):
    """A step: its ``number``, ``motion``, what it makes, when it starts and ends, and who does it."""

    number: int
    motion: str
    thing: str
    start: Fraction
    end: Fraction
    agent: int | None

    @property
    def name(self) -> str:
        """The motion, and what it is done to."""
        return f"{self.motion} ({self.thing})" if self.thing else self.motion


class Gantt(NamedTuple):
    """The steps of a schedule under a title, and how long it takes, in seconds."""

    title: str
    rows: tuple[GanttRow, ...]
    makespan: Fraction

    @property
    def in_order(self) -> list[GanttRow]:
        """The steps as they start."""
        return sorted(self.rows, key=lambda row: (row.start, row.end, row.number))


def gantt_lines(gantt: Gantt, width: int = _WIDTH) -> Iterator[str]:
    """Draw a line for each step: a digit is an agent at work, ``~`` a step that goes on by itself."""
    rows = gantt.in_order
    if not rows:
        return
    digits = max(4, *(len(str(row.number)) for row in rows))
    starts = max(5, *(len(time_text(row.start)) for row in rows))
    names = [row.name for row in rows]
    rest = width - digits - starts - 6
    if rest - max(map(len, names)) < _ROOM:
        names = [row.motion for row in rows]
    longest = max(map(len, names))
    bar = max(_BAR, rest - longest)
    end = time_text(gantt.makespan)
    yield f"{'step':>{digits}}  {'':<{longest}}  {'start':>{starts}}  0{end:>{bar - 1}}"
    for row, name in zip(rows, names, strict=True):
        place = f"{row.number:>{digits}}  {name:<{longest}}  {time_text(row.start):>{starts}}  "
        yield (place + _bar(row, gantt.makespan, bar)).rstrip()


def _bar(row: GanttRow, makespan: Fraction, width: int) -> str:
    begin = min(int(row.start * width / makespan), width - 1)
    end = max(begin + 1, int(row.end * width / makespan))
    hand = _NOBODY if row.agent is None else _HANDS[(row.agent - 1) % len(_HANDS)]
    return "." * begin + hand * (end - begin) + "." * (width - end)


def time_text(seconds: Fraction) -> str:
    """Write a time as minutes and seconds, or with hours before them; of fractions three places."""
    thousandths = round(seconds * 1000)
    whole, part = divmod(thousandths, 1000)
    minutes, rest = divmod(whole, 60)
    hours, minutes_left = divmod(minutes, 60)
    text = f"{hours}:{minutes_left:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"
    return text + (f".{part:03d}".rstrip("0") if part else "")


class ShownGantt:
    """A chart between lines of text, as wide as the console."""

    def __init__(self, head: Sequence[str], gantt: Gantt, foot: Sequence[str]) -> None:
        self._head, self._gantt, self._foot = head, gantt, foot

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        width = options.max_width if console.is_terminal else _WIDTH
        for line in (*self._head, *gantt_lines(self._gantt, width), *self._foot):
            yield Text(escaped(line), no_wrap=not console.is_terminal, overflow="ignore")
