"""The survivors that docs/dev/testing.md lists: they change nothing that anybody could notice."""

import re

from tests.mutation.mutant import Mutant
from tests.mutation.rooms import ROOT

PAGE = ROOT / "docs" / "dev" / "testing.md"
GREATEST_SHARE = 0.03  # of all mutants
_ROW = re.compile(r"^\| `(?P<file>[^`]+)` \| `(?P<function>[^`]*)` \| ``(?P<change>.+?)`` \| (?P<why>.+) \|$")


def equivalents() -> set[tuple[str, str, str]]:
    """Read the table of the page: file, function and change, the same for several in one function."""
    found = (_ROW.match(line) for line in PAGE.read_text(encoding="utf-8").splitlines())
    return {(row["file"], row["function"], row["change"]) for row in found if row}


def place(mutant: Mutant) -> tuple[str, str, str]:
    """Give what the table has of a mutant; a stroke in the change is written as the table needs it."""
    return mutant.file, mutant.function, mutant.change.replace("|", "\\|")
