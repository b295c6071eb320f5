"""Where the encodings and the bundled data are: in the installed package, or beside it in a checkout."""

from functools import cache
from pathlib import Path

from foon_asp.errors import BugError

_PACKAGE = Path(__file__).resolve().parent


@cache
def _folder(name: str, witness: str) -> Path:
    for parent in (_PACKAGE, _PACKAGE.parent):
        if (parent / name / witness).is_file():
            return parent / name
    raise BugError(f"the folder {name!r} is missing from this installation; please reinstall foon-asp")


def encodings_folder() -> Path:
    """Return the folder of the answer-set encodings."""
    return _folder("encodings", "task_tree.lp")


def published_table() -> Path:
    """Return the file with the published figures of the literature."""
    return _folder("data", "published/table1.json") / "published" / "table1.json"


def starter_recipe() -> Path:
    """Return the folder of the recipe that a new data folder begins with, and of its success rates."""
    return _folder("data", "starter/FOON.txt") / "starter"


def bundled_vocabulary() -> Path:
    """Return the file of the names that linting knows."""
    return _folder("data", "vocabulary.txt") / "vocabulary.txt"


def bundled_kitchen() -> Path:
    """Return the folder of the bundled universal FOON and its kitchen."""
    return _folder("data", "kitchen/FOON.txt") / "kitchen"
