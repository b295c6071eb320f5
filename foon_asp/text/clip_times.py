"""Clips of annotated videos: when a unit happens in its video, and how long motions take."""

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
    """The clips of a unit, each as its begin and end in seconds, with the motion and sources of the unit."""

    motion: str
    sources: tuple[Source, ...]
    clips: tuple[tuple[int, int], ...]

    @property
    def seconds(self) -> int:
        """The total length of the clips, in seconds."""
        return sum(end - begin for begin, end in self.clips)


def listed_clips(files: Iterable[Path], lenient: bool = False) -> Iterator[ListedClips]:
    """Yield the clips of each unit that has any.

    Units without two times, such as assumed units, are skipped. Clips that do not end after their begin are
    skipped, too. If ``lenient``, lines that are not understood are skipped. Otherwise they raise
    :class:`InputError` after all units of their file have been yielded.
    """
    for file in files:
        reader = FoonReader(lenient)
        for unit in reader.listed_units(reader.text(file), str(file)):
            clips = tuple(_paired_clips(MotionFields.of(unit.motion.fields).times))
            if clips:
                yield ListedClips(unit.motion.motion, unit.sources, clips)
        reader.raise_errors()


def median_clips(files: Iterable[Path], lenient: bool = False) -> dict[str, Fraction]:
    """Return the usual duration of each motion with clips: the median over its units, in seconds.

    The duration of a unit is the total length of its clips. Raises as :func:`listed_clips` does.
    """
    seconds: dict[str, list[Fraction]] = {}
    for unit_clips in listed_clips(files, lenient):
        seconds.setdefault(unit_clips.motion, []).append(Fraction(unit_clips.seconds))
    return {motion: median(times) for motion, times in seconds.items()}


def _paired_clips(times: tuple[str, ...]) -> Iterator[tuple[int, int]]:
    """Yield the begin and the end of each clip in seconds: the first two times, then the next two.

    A clip whose end is not after its begin is skipped.
    """
    clocks = [_seconds(clock) for clock in _CLOCK.findall(" ".join(times))]
    for begin, end in zip(clocks[::2], clocks[1::2], strict=False):
        if end > begin:
            yield begin, end


def _seconds(clock: str) -> int:
    """Return the seconds of a time of a video: 70 for ``1:10``, 170 for ``0:02:50``."""
    seconds = 0
    for number in clock.split(":"):
        seconds = 60 * seconds + int(number)
    return seconds
