"""Paths of the encodings and the bundled data: in the installed package, or next to it in a checkout."""

from functools import cache
from pathlib import Path

from foon_asp.errors import BugError

_PACKAGE = Path(__file__).resolve().parent


@cache
def _folder_with_file(name: str, expected_file: str) -> Path:
    """Return the folder ``name`` that has the expected file, in this package or else beside it.

    Raises :class:`BugError` if neither has it.
    """
    for parent in (_PACKAGE, _PACKAGE.parent):
        if (parent / name / expected_file).is_file():
            return parent / name
    raise BugError(f"the folder {name!r} is missing from this installation; please reinstall foon-asp")


def encodings_folder() -> Path:
    """Return the path of the folder of the answer-set encodings."""
    return _folder_with_file("encodings", "task_tree.lp")


def published_table() -> Path:
    """Return the path of the JSON file with the published figures of searches."""
    return _folder_with_file("data", "published/table1.json") / "published" / "table1.json"


def starter_recipe() -> Path:
    """Return the path of the folder with an example recipe and success rates for a new data folder."""
    return _folder_with_file("data", "starter/FOON.txt") / "starter"


def bundled_vocabulary() -> Path:
    """Return the path of the file with the names that lint knows."""
    return _folder_with_file("data", "vocabulary.txt") / "vocabulary.txt"


def bundled_kitchen() -> Path:
    """Return the path of the folder of the bundled universal FOON and its kitchen."""
    return _folder_with_file("data", "kitchen/FOON.txt") / "kitchen"
