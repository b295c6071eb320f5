"""Where units come from: the comment lines of a FOON file that say so.

``# Source:⇥ADDRESS`` at the top of a file names a video that was annotated. ``# From:⇥FILE:LINE⇥ADDRESS``
above a unit of a merged file names one copy that the unit was merged from, and the videos of that copy.
"""

import re
from collections.abc import Iterable

from foon_asp.network import Source

_VIDEO = "# Source:"
_COPY = "# From:"
_COPY_LINE = re.compile(r"# From:[\t ]*([^\t]+?):(\d{1,9})((?:\t[^\t]*)*)", re.ASCII)


def read_video(comment: str) -> str | None:
    """Give the video that a comment line names; ``None`` for another comment, or one that names none."""
    if not comment.startswith(_VIDEO):
        return None
    return re.sub(r"\s*\t\s*", " ", comment[len(_VIDEO) :].strip()) or None  # a tab ends it in a # From: line


def is_video(comment: str) -> bool:
    """Whether a comment line is meant to name a video, which it may leave empty."""
    return comment.startswith(_VIDEO)


def read_copy(comment: str) -> Source | None:
    """Give the place that a comment line above a merged unit names; ``None`` for another comment."""
    match = comment.startswith(_COPY) and _COPY_LINE.fullmatch(comment.rstrip())
    if not match:
        return None
    videos = tuple(video.strip() for video in match[3].split("\t") if video.strip())
    return Source(match[1], int(match[2]), 1, videos)


def write_copies(sources: Iterable[Source]) -> str:
    """Give the comment lines, each with its line end, that :func:`read_copy` reads."""
    lines = ("\t".join((f"{_COPY}\t{s.file}:{s.line}", *s.videos)) for s in sources)
    return "".join(f"{line}\n" for line in lines)
