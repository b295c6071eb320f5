"""The reductions by name, and which optimal trees they keep."""

from enum import StrEnum

from foon_asp.errors import UserError


class Reduction(StrEnum):
    """A reduction of the search, beyond relevance and reachability.

    ``forced``: excludes units made irrelevant by action landmarks.
    ``dear``: excludes units above the cutoff, all of whose trees cost more than the incumbent.
    ``dominated``: excludes units that another unit dominates.
    ``bounds``: only trees better than the incumbent are searched for, and none where the bounds meet.

    The first two keep every optimal tree, the others at least one.
    """

    FORCED = "forced"
    DEAR = "dear"
    DOMINATED = "dominated"
    BOUNDS = "bounds"


SAFE = frozenset({Reduction.FORCED, Reduction.DEAR})
ALL = frozenset(Reduction)
NONE: frozenset[Reduction] = frozenset()


def parse_reductions(text: str) -> frozenset[Reduction]:
    """Return the reductions named by ``all``, ``safe``, ``none`` or names separated by commas.

    Raises :class:`UserError` for other names.
    """
    named = {"all": ALL, "safe": SAFE, "none": NONE}
    if text in named:
        return named[text]
    return frozenset(map(_parse_name, text.split(",")))


def _parse_name(name: str) -> Reduction:
    """Return the reduction of this name; raises :class:`UserError` for another name."""
    try:
        return Reduction(name.strip())
    except ValueError:
        expected = ", ".join(Reduction)
        raise UserError(
            f"found the reduction {name!r}, expected all, safe, none or some of {expected}"
        ) from None
