"""The reductions by name, and which optimal trees they keep."""

from enum import StrEnum

from foon_asp.errors import UserError


class Reduction(StrEnum):
    """A reduction of the search, beyond relevance and reachability.

    ``forced``: excludes units that action landmarks make irrelevant.
    ``dear``: excludes units if all trees with them cost more than the incumbent.
    ``dominated``: excludes units that another unit dominates.
    ``bounds``: looks only for trees better than the incumbent. If a lower bound proves that there are none,
    no search follows.

    ``forced`` and ``dear`` keep every optimal tree. ``dominated`` and ``bounds`` keep at least one.
    """

    FORCED = "forced"
    DEAR = "dear"
    DOMINATED = "dominated"
    BOUNDS = "bounds"


SAFE = frozenset({Reduction.FORCED, Reduction.DEAR})
ALL = frozenset(Reduction)
NONE: frozenset[Reduction] = frozenset()


def parse_reductions(text: str) -> frozenset[Reduction]:
    """Return the reductions of ``all``, ``safe``, ``none`` or a list of names as in ``forced,dear``.

    Spaces around the names of a list are ignored. Raises :class:`UserError` for an unknown name.
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
