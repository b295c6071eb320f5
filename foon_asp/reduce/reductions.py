"""The reductions by name, and which of them keep what."""

from enum import StrEnum

from foon_asp.errors import UserError


class Reduction(StrEnum):
    """One way to leave less to search, beyond what can be made and what the goals can need.

    ``forced``: units beside those that every tree has. ``dear``: units of which every tree costs more than
    one in hand. Both keep every optimal tree. ``dominated``: units that another one can always stand in for.
    ``bounds``: only what is better than the tree in hand is searched for, and nothing where bounds meet.
    These two keep one optimal tree at least.
    """

    FORCED = "forced"
    DEAR = "dear"
    DOMINATED = "dominated"
    BOUNDS = "bounds"


SAFE = frozenset({Reduction.FORCED, Reduction.DEAR})
ALL = frozenset(Reduction)
NONE: frozenset[Reduction] = frozenset()


def parse_reductions(text: str) -> frozenset[Reduction]:
    """Read ``all``, ``safe``, ``none`` or names separated by commas; raises :class:`UserError` for others."""
    named = {"all": ALL, "safe": SAFE, "none": NONE}
    if text in named:
        return named[text]
    return frozenset(map(_parse, text.split(",")))


def _parse(name: str) -> Reduction:
    try:
        return Reduction(name.strip())
    except ValueError:
        expected = ", ".join(Reduction)
        raise UserError(
            f"found the reduction {name!r}, expected all, safe, none or some of {expected}"
        ) from None
