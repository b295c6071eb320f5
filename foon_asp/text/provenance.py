"""The provenance of units: comment lines of FOON text that name videos and copies.

``# Source:⇥ADDRESS`` at the top of a file names a video that was annotated. ``# From:⇥FILE:LINE⇥ADDRESS``
above a unit of a merged file names one copy that the unit was merged from, and the videos of that copy.
"""

from foon_asp.network import Source

_VIDEO = "# Source:"
_COPY = "# From:"


def read_video(comment: str) -> str | None:
    """Return the video that a comment line ``# Source:`` names, with a blank for each tab in it.

    Return ``None`` for another comment, and for a comment that names no video.
    """
    if not comment.startswith(_VIDEO):
        return None
    return " ".join(_nonempty_fields(comment[len(_VIDEO) :])) or None  # a tab ends it in a # From: line


def is_video(comment: str) -> bool:
    """Whether a comment line begins with ``# Source:``, even if it names no video."""
    return comment.startswith(_VIDEO)


def read_copy(comment: str) -> Source | None:
    """Return the source that a comment line ``# From:`` names, with its videos and with column 1.

    Return ``None`` for any other comment.
    """
    if not comment.startswith(_COPY):
        return None
    position, *videos = comment[len(_COPY) :].lstrip("\t ").split("\t")
    file, colon, line = (position if videos else position.rstrip()).rpartition(":")
    if not (file and colon and line.isascii() and line.isdigit() and len(line) <= 9):
        return None
    return Source(file, int(line), 1, tuple(_nonempty_fields("\t".join(videos))))


def write_copy(source: Source) -> str:
    """Return the comment line ``# From:`` of a source, with its line end; its column is left out."""
    return "\t".join((f"{_COPY}\t{source.file}:{source.line}", *source.videos)) + "\n"


def _nonempty_fields(text: str) -> list[str]:
    """Return the texts between tabs, without blanks around them, without empty ones."""
    return [field.strip() for field in text.split("\t") if field.strip()]
