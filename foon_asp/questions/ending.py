"""How a question ended, which decides the exit code of its command."""

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # takes the solver along
    from foon_asp.asp import Status


class Ending(StrEnum):
    """How a question ended; each ending has an exit code."""

    DONE = "done"
    """What was asked for was found, and proved where there is something to prove."""
    NEGATIVE = "negative"
    """It is proved that no answer exists, or a check failed."""
    LIMIT = "limit"
    """It was stopped at a limit, with what was known by then."""


def ending_of_status(status: "Status") -> Ending:
    """Return ``DONE`` for optimal, ``NEGATIVE`` for infeasible, and ``LIMIT`` for all other answers."""
    from foon_asp.asp import Status  # noqa: PLC0415 (loaded already by whoever has a status)

    return {
        Status.OPTIMAL: Ending.DONE,
        Status.INFEASIBLE: Ending.NEGATIVE,
        Status.FEASIBLE: Ending.LIMIT,
        Status.UNKNOWN: Ending.LIMIT,
    }[status]
