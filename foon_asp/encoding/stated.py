"""Rules without a file."""

from pathlib import Path
from typing import NamedTuple


class Stated(NamedTuple):
    """The text of rules, and their name in messages.

    ``place`` replaces the file name in messages, as in ``rule 1``. A ready-made constraint with constants
    of its own has the same lines as its ``file``; ``written`` is the text of its option, and ``renamed``
    has pairs of the new and the original names of its constants.
    """

    place: str
    text: str
    file: Path | None = None
    written: str = ""
    renamed: tuple[tuple[str, str], ...] = ()


Loaded = Path | Stated
"""A part of a program: a file, or rules that are in none."""
