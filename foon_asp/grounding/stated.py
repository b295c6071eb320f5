"""Rules that are in no file."""

from pathlib import Path
from typing import NamedTuple


class Stated(NamedTuple):
    """The text of some rules, and what messages call it.

    ``place`` stands for the name of a file: ``rule 1``. Where the rules are those of a ready-made constraint
    under constants of their own, ``file`` is that constraint, with the same lines, ``written`` says how it
    was asked for, and ``renamed`` what its names stand for here.
    """

    place: str
    text: str
    file: Path | None = None
    written: str = ""
    renamed: tuple[tuple[str, str], ...] = ()


Loaded = Path | Stated
"""A part of a program: a file, or rules that are in none."""
