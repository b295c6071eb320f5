"""``FILE.lp=WEIGHT``: constraints with a weight."""

from collections.abc import Sequence

from foon_asp.asp.assembly import GREATEST_WEIGHT
from foon_asp.errors import UserError
from foon_asp.rules.constraint import Constraint, find_constraint, given_constraint


def weighted_files(settings: Sequence[str], option: str) -> dict[Constraint, int]:
    """Read ``FILE.lp=WEIGHT`` settings of an option; a weight is a whole number from 1 to a million.

    In place of the file there may be a rule, or a ready-made constraint. Raises :class:`UserError` for a
    setting of another form, and for a constraint with two weights.
    """
    found: dict[Constraint, int] = {}
    for setting in settings:
        file, equals, weight = setting.rpartition("=")
        if not equals or not file:
            raise UserError(f"found {option} {setting!r}, expected FILE.lp=WEIGHT")
        if not (weight.isascii() and weight.isdigit() and 1 <= int(weight) <= GREATEST_WEIGHT):
            raise UserError(
                f"found the weight {weight!r} in {option} {setting!r}, "
                f"expected a whole number from 1 to {GREATEST_WEIGHT}"
            )
        constraint = find_constraint(given_constraint(file))
        if found.setdefault(constraint, int(weight)) != int(weight):
            raise UserError(f"{option}: {file} has two weights")
    return found
