"""Clips of annotated videos: when a unit happens, and how long motions take."""

import re
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from statistics import median
from typing import NamedTuple

from foon_asp.network import Source
from foon_asp.text.motion_times import MotionFields
from foon_asp.text.reader import FoonReader

_CLOCK = re.compile(r"\d+:\d\d(?::\d\d)?", re.ASCII)


class ListedClips(NamedTuple):
    """The clips of a unit, each as its begin and its end in seconds, and where the unit was read."""

    motion: str
    sources: tuple[Source, ...]
    clips: tuple[tuple[int, int], ...]

    @property
    def seconds(self) -> int:
        """The length of all clips."""
        return sum(end - begin for begin, end in self.clips)


def listed_clips(files: Iterable[Path], lenient: bool = False) -> Iterator[ListedClips]:
    """Yield the clips of each unit that has any.

    Units without two times, such as assumed ones, and clips that do not end after they begin are skipped.
    Lines that are not understood are skipped if ``lenient``, else :class:`InputError` is raised.
    """
    for file in files:
        reader = FoonReader(lenient)
        for unit in reader.listed_units(reader.text(file), str(file)):
            clips = tuple(_clips(MotionFields.of(unit.motion.fields).times))
            if clips:
                yield ListedClips(unit.motion.motion, unit.sources, clips)
        reader.raise_errors()


def median_clips(files: Iterable[Path], lenient: bool = False) -> dict[str, Fraction]:
    """Return the median of the clip times of each motion that has any, in seconds."""
    seconds: dict[str, list[Fraction]] = {}
    for listed in listed_clips(files, lenient):
        seconds.setdefault(listed.motion, []).append(Fraction(listed.seconds))
    return {motion: median(times) for motion, times in seconds.items()}


def _clips(times: tuple[str, ...]) -> Iterator[tuple[int, int]]:
    """Yield the begin and the end of each clip of a unit in seconds: from one time to the next."""
    clocks = [_seconds(clock) for clock in _CLOCK.findall(" ".join(times))]
    for begin, end in zip(clocks[::2], clocks[1::2], strict=False):
        if end > begin:
            yield begin, end


def _seconds(clock: str) -> int:
    seconds = 0
    for number in clock.split(":"):
        seconds = 60 * seconds + int(number)
    return seconds
