"""The files that are changed: where a fault would make a proof or an optimum wrong."""

from pathlib import Path

from tests.mutation.mutant import Mutant
from tests.mutation.operators import mutants

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("proof", "reduce", "bounds", "certificate")
FILES = (
    "asp/prepared.py",
    "asp/solver.py",
    "asp/ranking.py",
    "encoding/exact_success.py",
    "encoding/scales.py",
)


def texts() -> dict[str, str]:
    """Give the text of every file that is changed, by its path in the repository."""
    package = ROOT / "foon_asp"
    paths = [path for folder in FOLDERS for path in sorted((package / folder).rglob("*.py"))]
    paths += [package / file for file in FILES]
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def all_mutants() -> list[Mutant]:
    """Give all mutants in the order in which they are tried, which is arbitrary and always the same."""
    found = (mutant for file, text in texts().items() for mutant in mutants(file, text))
    return sorted(found, key=lambda mutant: mutant.rank)
