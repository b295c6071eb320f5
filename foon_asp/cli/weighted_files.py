"""Soft constraints on the command line: ``FILE.lp=WEIGHT``."""

from collections.abc import Sequence

from foon_asp.asp.search_tuning import SEARCH
from foon_asp.errors import UserError
from foon_asp.rules.passed_constraint import Constraint, find_constraint, given_constraint


def parse_weights(settings: Sequence[str], option: str) -> dict[Constraint, int]:
    """Parse the values ``FILE.lp=WEIGHT`` of an option; return the weight of each constraint.

    A weight is a whole number from 1 to 1,000,000. In place of the file, there may be a rule or a ready-made
    constraint. ``option`` is the flag, for messages.

    Raises :class:`UserError` for a value of another form, and for a constraint with two different weights.
    """
    weights: dict[Constraint, int] = {}
    for setting in settings:
        file, equals, weight = setting.rpartition("=")
        if not equals or not file:
            raise UserError(f"found {option} {setting!r}, expected FILE.lp=WEIGHT")
        if not (weight.isascii() and weight.isdigit() and 1 <= int(weight) <= SEARCH.max_weight):
            raise UserError(
                f"found the weight {weight!r} in {option} {setting!r}, "
                f"expected a whole number from 1 to {SEARCH.max_weight}"
            )
        constraint = find_constraint(given_constraint(file))
        if weights.setdefault(constraint, int(weight)) != int(weight):
            raise UserError(f"{option}: {file} has two weights")
    return weights
