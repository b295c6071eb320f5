"""Which files are changed: where a fault would make a proof or an optimum wrong, or others by place."""

import subprocess
from collections import defaultdict
from collections.abc import Sequence
from itertools import zip_longest
from pathlib import Path

from tests.mutation.mutant import SEED, Mutant
from tests.mutation.operators import mutants

ROOT = Path(__file__).resolve().parents[2]
PROVING = (
    "foon_asp/proof",
    "foon_asp/plans",
    "foon_asp/hypergraph",
    "foon_asp/certificate",
    "foon_asp/asp/prepared.py",
    "foon_asp/asp/solver.py",
    "foon_asp/asp/ranking.py",
    "foon_asp/encoding/rate_scale.py",
    "foon_asp/encoding/cost_scales.py",
)


def texts(places: Sequence[str] = ("foon_asp",)) -> dict[str, str]:
    """Return the text of every file in these folders, or of these names, by its path in the repository."""
    paths = (ROOT / place for place in places)
    files = (file for path in paths for file in (sorted(path.rglob("*.py")) if path.is_dir() else [path]))
    return {file.relative_to(ROOT).as_posix(): file.read_text(encoding="utf-8") for file in files}


def all_mutants(seed: str = SEED, places: Sequence[str] = PROVING) -> list[Mutant]:
    """Return the mutants in the order in which they are tried: arbitrary, and the same for the same seed.

    Rooms take turns, so that a sample, which is a beginning, has as many of each.
    """
    found = (mutant for file, text in texts(places).items() for mutant in mutants(file, text))
    rooms: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in sorted(found, key=lambda mutant: mutant.rank(seed)):
        rooms[mutant.room].append(mutant)
    return [mutant for turn in zip_longest(*rooms.values()) for mutant in turn if mutant is not None]


def changed_since(revision: str) -> list[str]:
    """Return the files of the package that differ from a revision, and are there now.

    Raises:
        subprocess.CalledProcessError: Git is not there, or does not know the revision.
    """
    words = ["git", "diff", "--name-only", "--diff-filter=d", revision, "--", "foon_asp/*.py"]
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()


def tests_of(places: Sequence[str]) -> list[str]:
    """Return the folders of tests that are named like the rooms of these places."""
    rooms = sorted({place.split("/")[1] for place in places if place.count("/")})
    return [f"tests/{room}" for room in rooms if (ROOT / "tests" / room).is_dir()]
