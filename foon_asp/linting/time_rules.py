"""What there is to say of times: steps that end before they begin, or come before what they use is made."""

import re
from bisect import bisect_right
from collections.abc import Generator, Iterator
from statistics import median
from typing import NamedTuple

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import MotionLine
from foon_asp.text.motion_times import MotionFields

_CLOCK = re.compile(r"\d+:\d\d(?::\d\d)?")
_HOUR, _LONG, _MINUTE = 3600, 1200, 60
_LATER, _MUCH_LATER = 2, 4  # times as late as the latest one of another form, and as most
_MUCH_LONGER = 20  # times as long as most steps


class _Clock(NamedTuple):
    """A time as it is written, its column, and its seconds."""

    text: str
    column: int
    seconds: int


class _Step(NamedTuple):
    """A unit with its times: the line of its motion, and pairs of a beginning and an end."""

    unit: int
    motion: int
    spans: list[tuple[_Clock, _Clock]]

    @property
    def first(self) -> _Clock:
        return min((start for start, _ in self.spans), key=lambda clock: clock.seconds)

    @property
    def last(self) -> _Clock:
        return max((end for _, end in self.spans), key=lambda clock: clock.seconds)


def time_findings(files: LintedFiles) -> Iterator[Diagnostic]:
    """Give the findings about times of each network, in linear time."""
    by_sheet: dict[int, list[tuple[int, int]]] = {}
    for unit, copies in enumerate(files.copies):
        for copy in copies:
            by_sheet.setdefault(copy.sheet, []).append((copy.at, unit))
    for number, units in by_sheet.items():
        sheet = files.sheets[number]
        steps = list(_steps(sheet, sorted(units)))
        odd = yield from _values(sheet, steps)
        yield from _order(files, sheet, [step for step in steps if step.motion not in odd])


def _steps(sheet: Sheet, units: list[tuple[int, int]]) -> Iterator[_Step]:
    starts = [at for at, _ in units]
    for index, text in enumerate(sheet.lines):
        if text[:1] != "M" or ":" not in text:
            continue
        line = sheet.reader.parse(text)
        if not isinstance(line, MotionLine):
            continue
        spans = _spans(text, MotionFields.of(line.fields).times)
        place = bisect_right(starts, index) - 1
        if spans and place >= 0:
            yield _Step(units[place][1], index, spans)


def _spans(text: str, fields: tuple[str, ...]) -> list[tuple[_Clock, _Clock]]:
    """Give the beginnings and ends in two fields, or in one, where ``-`` or else a comma stands between."""
    start = text.find("\t", text.find("\t") + 1)
    clocks = [_clock(match) for match in _CLOCK.finditer(text, start)]
    joined = " ".join(fields)
    if "," in joined and "-" in joined:
        spans, at = [], 0
        for part in joined.split(","):
            found = clocks[at : at + len(_CLOCK.findall(part))]
            at += len(found)
            if len(found) == 2:
                spans.append((found[0], found[1]))
        return spans
    return [(clocks[0], clocks[1])] if len(clocks) == 2 else []


def _clock(match: re.Match[str]) -> _Clock:
    seconds = 0
    for part in match[0].split(":"):
        seconds = 60 * seconds + int(part)
    return _Clock(match[0], match.start() + 1, seconds)


def _values(sheet: Sheet, steps: list[_Step]) -> Generator[Diagnostic, None, set[int]]:
    """Give the findings about single times, and return the lines that they are on."""
    if not steps:
        return set()
    clocks = [clock for step in steps for span in step.spans for clock in span]
    usual = median(clock.seconds for clock in clocks)
    in_three = 4 * sum(clock.text.count(":") == 2 for clock in clocks) > len(clocks)
    latest = max((clock.seconds for clock in clocks if clock.text.count(":") == 1), default=0)
    length = median(max(0, end.seconds - start.seconds) for step in steps for start, end in step.spans)
    odd = set()
    for step in steps:
        for start, end in step.spans:
            message, at = "", end
            for clock in (start, end):
                if any(int(part) >= _MINUTE for part in clock.text.split(":")[1:]):
                    message, at = f"{clock.text!r} has more than 59 seconds or minutes", clock
                elif clock.text.count(":") == 2 and not in_three and clock.seconds > _LATER * latest:
                    minutes, seconds, rest = clock.text.split(":")
                    message, at = f"{clock.text!r} is h:mm:ss, long after other times here", clock
                    message += f"; if {rest} is a fraction of a second, write {minutes}:{seconds}"
                elif clock.seconds >= _HOUR and clock.seconds > _MUCH_LATER * usual:
                    message, at = f"{clock.text!r} is after hours, most times here within minutes", clock
                if message:
                    break
            if not message and end.seconds < start.seconds:
                message = f"the step ends at {end.text}, before it begins at {start.text}"
            elif not message and end.seconds - start.seconds >= max(_LONG, _MUCH_LONGER * length):
                message = f"the step lasts from {start.text} to {end.text}, much longer than others here"
            if message:
                odd.add(step.motion)
                yield sheet.finding("time-value", message, step.motion, column=at.column)
                break
    return odd


def _order(files: LintedFiles, sheet: Sheet, steps: list[_Step]) -> Iterator[Diagnostic]:
    """Give the steps that end before the one begins that stands before them and makes what they use."""
    network = files.network
    makers: dict[int, _Step] = {}
    for step in steps:
        inputs = network.inputs[step.unit]
        late = [(makers[node].first.seconds, node) for node in inputs if node in makers]
        if late and max(late)[0] > step.last.seconds:
            node = max(late)[1]
            maker = makers[node]
            message = (
                f"the step ends at {step.last.text}, and uses {str(network.objects[node])!r}, which "
                f"{network.motions[maker.unit]!r} ({sheet.where(maker.motion, sheet)}) begins to make at "
                f"{maker.first.text}; is one of the times wrong?"
            )
            yield sheet.finding("time-order", message, step.motion, column=step.first.column)
        for node in set(network.outputs[step.unit]).difference(inputs):
            known = makers.setdefault(node, step)
            makers[node] = min(known, step, key=lambda maker: maker.first.seconds)
