"""Lint rules about times: steps that end before they begin, or come before what they use is made."""

import re
from bisect import bisect_right
from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

from foon_asp.linting.context import Context
from foon_asp.linting.linted_files import Copy
from foon_asp.linting.rule import WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import MotionLine

_CLOCK_TIME = re.compile(r"\d+:\d\d(?::\d\d)?")
_SPAN = re.compile(rf"({_CLOCK_TIME.pattern}) ?- ?({_CLOCK_TIME.pattern})")
_HOUR, _LONG, _MINUTE = 3600, 1200, 60  # seconds
_LATER, _MUCH_LATER = 2, 4  # times as late as the latest time of another form, and as the median


class _Clock(NamedTuple):
    """A time: its seconds from 0:00, its column from 1, and its text, such as ``1:05``."""

    seconds: int
    column: int
    text: str

    @classmethod
    def of(cls, match: re.Match[str], group: int = 0) -> "_Clock":
        """Return the time in a group of a match, which is written ``m:ss`` or ``h:mm:ss``."""
        seconds = 0
        for number in match[group].split(":"):
            seconds = 60 * seconds + int(number)
        return cls(seconds, match.start(group) + 1, match[group])


class _Step(NamedTuple):
    """A unit with times in one sheet.

    ``unit``: the id of the unit.
    ``motion_index``: the index of its motion line.
    ``spans``: pairs of a start and an end.
    """

    unit: int
    motion_index: int
    spans: list[tuple[_Clock, _Clock]]

    @property
    def earliest_start(self) -> _Clock:
        """The earliest of the starts."""
        return min(start for start, _ in self.spans)

    @property
    def latest_end(self) -> _Clock:
        """The latest of the ends."""
        return max(end for _, end in self.spans)


def _timed_sheets(context: Context) -> Iterator[tuple[Sheet, list[_Step], dict[int, tuple[str, int]]]]:
    """Yield each sheet with times, its steps with times, and its unlikely times (see :func:`_odd_times`)."""
    for sheet, copies in zip(context.sheets, context.files.copies_by_sheet, strict=True):
        steps = list(_timed_steps(sheet, copies))
        if steps:
            yield sheet, steps, _odd_times(steps)


def _timed_steps(sheet: Sheet, copies: list[tuple[Copy, int]]) -> Iterator[_Step]:
    """Yield the units of a sheet that have times, in the order of the sheet.

    ``copies`` are the copies of units in the sheet, each with the id of its unit.
    """
    starts = [copy.first_index for copy, _ in copies]
    for index, text in enumerate(sheet.lines):
        if text[:1] == "M" and ":" in text and isinstance(sheet.reader.parse(text), MotionLine):
            spans = _spans(text)
            position = bisect_right(starts, index) - 1
            if spans and position >= 0:
                yield _Step(copies[position][1], index, spans)


def _spans(text: str) -> list[tuple[_Clock, _Clock]]:
    """Return the spans of time on a motion line, as pairs of a start and an end.

    They are two fields, such as ``0:12`` and ``0:34``, or one field, such as ``<0:12-0:34,0:40-0:44>``.
    Without a dash, the line has to have exactly two times.
    """
    start = text.find("\t", text.find("\t") + 1)
    spans = [(_Clock.of(match, 1), _Clock.of(match, 2)) for match in _SPAN.finditer(text, start)]
    clocks = [_Clock.of(match) for match in _CLOCK_TIME.finditer(text, start)]
    return spans or ([(clocks[0], clocks[1])] if len(clocks) == 2 else [])


@rule("time-value", WARNING, "a time that is hardly meant: too many seconds, hours, an end before its start")
def find_unlikely_times(context: Context) -> Iterator[Diagnostic]:
    """A step ends before it begins or lasts much longer than others, or a time has more than 59 seconds.

    Also reported is a time of hours where most times of the file are minutes. Where other times are `m:ss`, a
    time such as `1:38:50` is reported as well. It is read as hours, but its last number is usually a fraction
    of a second.
    """
    for sheet, _, odd in _timed_sheets(context):
        for motion_index, (message, column) in odd.items():
            yield sheet.finding(message, motion_index, column=column)


def _odd_times(steps: list[_Step]) -> dict[int, tuple[str, int]]:
    """Return the unlikely times by the index of their motion line: a message and a column from 1.

    Of several unlikely times on a line, the first is returned.
    """
    clocks = [clock for step in steps for span in step.spans for clock in span]
    usual = median(clock.seconds for clock in clocks)
    has_hours = 4 * sum(clock.text.count(":") == 2 for clock in clocks) > len(clocks)
    latest = max((clock.seconds for clock in clocks if clock.text.count(":") == 1), default=0)
    length = median(max(0, end.seconds - start.seconds) for step in steps for start, end in step.spans)

    def clock_fault(clock: _Clock) -> str:
        """Return the message about an unlikely time, compared with all times; empty for a likely one."""
        parts = clock.text.split(":")
        if any(int(number) >= _MINUTE for number in parts[1:]):
            return f"{clock.text!r} has more than 59 seconds or minutes"
        if len(parts) == 3 and not has_hours and clock.seconds > _LATER * latest:
            minutes, seconds, fraction = parts
            return (
                f"{clock.text!r} is h:mm:ss, long after other times here; if {fraction} is a fraction of a "
                f"second, write {minutes}:{seconds}"
            )
        if clock.seconds >= _HOUR and clock.seconds > _MUCH_LATER * usual:
            return f"{clock.text!r} is after hours, most times here within minutes"
        return ""

    def span_fault(start: _Clock, end: _Clock) -> str:
        """Return the message about a span that ends before it begins or is too long; empty for a likely one.

        A span is too long if it lasts at least 20 minutes and at least 20 times the median of all spans.
        """
        if end.seconds < start.seconds:
            return f"the step ends at {end.text}, before it begins at {start.text}"
        if end.seconds - start.seconds >= max(_LONG, 20 * length):
            return f"the step lasts from {start.text} to {end.text}, much longer than others here"
        return ""

    odd_times: dict[int, tuple[str, int]] = {}
    for step in steps:
        for start, end in step.spans:
            faults = ((clock_fault(start), start), (clock_fault(end), end), (span_fault(start, end), end))
            for message, clock in faults:
                if message:
                    odd_times.setdefault(step.motion_index, (message, clock.column))
    return odd_times


@rule("time-order", WARNING, "a step before the one that makes what it uses")
def find_steps_out_of_order(context: Context) -> Iterator[Diagnostic]:
    """A step uses what a step above it makes, but ends before that step begins.

    One of the times is wrong, or the order of the steps.
    """
    network = context.network
    for sheet, steps, odd in _timed_sheets(context):
        makers: dict[int, _Step] = {}
        for step in (step for step in steps if step.motion_index not in odd):
            inputs = network.inputs[step.unit]
            seconds, node = max(
                ((makers[node].earliest_start.seconds, node) for node in inputs if node in makers),
                default=(0, 0),
            )
            if seconds > step.latest_end.seconds:
                maker = makers[node]
                line = sheet.line_name(maker.motion_index, sheet)
                message = (
                    f"the step ends at {step.latest_end.text}, and uses {str(network.objects[node])!r}, "
                    f"which {network.motions[maker.unit]!r} ({line}) begins to make at "
                    f"{maker.earliest_start.text}; is one of the times wrong?"
                )
                yield sheet.finding(message, step.motion_index, column=step.earliest_start.column)
            for node in set(network.outputs[step.unit]).difference(inputs):
                makers[node] = min(makers.get(node, step), step, key=lambda maker: maker.earliest_start)
