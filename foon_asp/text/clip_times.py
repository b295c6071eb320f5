"""Durations of the clips of annotated videos, by motion."""

import re
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from statistics import median

from foon_asp.text.motion_times import MotionFields
from foon_asp.text.reader import FoonReader

_CLOCK = re.compile(r"\d+:\d\d(?::\d\d)?", re.ASCII)


def median_clips(files: Iterable[Path], lenient: bool = False) -> dict[str, Fraction]:
    """Return the median of the clip times of each motion that has any, in seconds.

    Units without two times, such as assumed ones, and clips that do not end after they begin are skipped.
    Lines that are not understood are skipped if ``lenient``, else :class:`InputError` is raised.
    """
    clips: dict[str, list[Fraction]] = {}
    for file in files:
        reader = FoonReader(lenient)
        for unit in reader.listed_units(reader.text(file), str(file)):
            total = sum(_clips(MotionFields.of(unit.motion.fields).times))
            if total:
                clips.setdefault(unit.motion.motion, []).append(Fraction(total))
        reader.raise_errors()
    return {motion: median(seconds) for motion, seconds in clips.items()}


def _clips(times: tuple[str, ...]) -> Iterator[int]:
    """Yield the seconds of each clip of a unit: from one time to the next."""
    clocks = [_seconds(clock) for clock in _CLOCK.findall(" ".join(times))]
    for begin, end in zip(clocks[::2], clocks[1::2], strict=False):
        if end > begin:
            yield end - begin


def _seconds(clock: str) -> int:
    seconds = 0
    for number in clock.split(":"):
        seconds = 60 * seconds + int(number)
    return seconds
