"""One change to one file, and the key by which it is known wherever its line has gone."""

import difflib
import hashlib
from typing import NamedTuple

SEED = "foon-asp"  # fixed before the first run: the order in which mutants are tried


class Mutant(NamedTuple):
    """A change to the text of a file of ours.

    ``function`` names the classes and functions around it. ``outermost`` is the qualified name of the first
    function of these, empty where the change counts before any function of the file is called. ``first`` and
    ``last`` are the lines that it touches; what is between the offsets ``start`` and ``end`` becomes ``new``.
    ``occurrence`` counts the mutants of one function with the same change.
    """

    file: str
    function: str
    outermost: str
    operator: str
    first: int
    last: int
    start: int
    end: int
    old: str
    new: str
    occurrence: int = 0

    @property
    def change(self) -> str:
        """The change in one line, blanks run together."""
        return f"{' '.join(self.old.split())} → {' '.join(self.new.split())}"

    @property
    def key(self) -> tuple[str, str, str, int]:
        """What is the same when lines have moved."""
        return (self.file, self.function, self.change, self.occurrence)

    def rank(self, seed: str = SEED) -> str:
        """Return where it comes in the order of trials: arbitrary, and the same for the same seed."""
        return hashlib.sha256("\0".join(map(str, (seed, *self.key))).encode()).hexdigest()

    @property
    def room(self) -> str:
        """The room of its file."""
        return "/".join(self.file.split("/")[:2]) if self.file.count("/") > 1 else "foon_asp"

    def applied(self, text: str) -> str:
        """Give the text of the file with the change."""
        assert text[self.start : self.end] == self.old, f"{self.file}:{self.first} has changed"
        return text[: self.start] + self.new + text[self.end :]

    def diff(self, text: str) -> str:
        """Give the lines that go and the lines that come, with - and +."""
        lines = difflib.unified_diff(text.split("\n"), self.applied(text).split("\n"), n=0, lineterm="")
        return "\n".join(line for line in lines if not line.startswith(("---", "+++", "@@")))
