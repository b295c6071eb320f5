"""Rules that are given as text, without a file."""

from pathlib import Path
from typing import NamedTuple


class Stated(NamedTuple):
    """The text of rules, and their name in messages.

    ``place``: the name that replaces the file name in messages, as in ``rule 1``.
    The other fields are for a ready-made constraint whose constants were set for this use.
    ``file``: its file, with the same lines as the text.
    ``written``: the text of the option.
    ``renamed``: pairs of the new and the original name of each constant.
    """

    place: str
    text: str
    file: Path | None = None
    written: str = ""
    renamed: tuple[tuple[str, str], ...] = ()


Loaded = Path | Stated
"""A part of a program: a file, or rules that are in none."""
