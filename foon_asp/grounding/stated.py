"""Rules without a file."""

from pathlib import Path
from typing import NamedTuple


class Stated(NamedTuple):
    """The text of rules, and their name in messages.

    ``place`` stands for the name of a file: ``rule 1``. For a ready-made constraint with constants of its
    own, ``file`` is that constraint, with the same lines, ``written`` is the text of its option, and
    ``renamed`` has pairs of the new and the original names of its constants.
    """

    place: str
    text: str
    file: Path | None = None
    written: str = ""
    renamed: tuple[tuple[str, str], ...] = ()


Loaded = Path | Stated
"""A part of a program: a file, or rules that are in none."""
