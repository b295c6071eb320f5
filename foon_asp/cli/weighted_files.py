"""``FILE.lp=WEIGHT``: constraint files with a weight."""

from collections.abc import Sequence
from pathlib import Path

from foon_asp.asp.assembly import GREATEST_WEIGHT, find_constraint
from foon_asp.errors import UserError


def weighted_files(settings: Sequence[str], option: str) -> dict[Path, int]:
    """Read ``FILE.lp=WEIGHT`` settings of an option; a weight is a whole number from 1 to a million.

    Raises :class:`UserError` for one of another form, and for a file with two weights.
    """
    found: dict[Path, int] = {}
    for setting in settings:
        file, equals, weight = setting.rpartition("=")
        if not equals or not file:
            raise UserError(f"found {option} {setting!r}, expected FILE.lp=WEIGHT")
        if not (weight.isascii() and weight.isdigit() and 1 <= int(weight) <= GREATEST_WEIGHT):
            raise UserError(
                f"found the weight {weight!r} in {option} {setting!r}, "
                f"expected a whole number from 1 to {GREATEST_WEIGHT}"
            )
        path = find_constraint(Path(file))
        if found.setdefault(path, int(weight)) != int(weight):
            raise UserError(f"{option}: {file} has two weights")
    return found
