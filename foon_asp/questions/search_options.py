"""The options of the published searches, and the searches and settings that they stand for."""

from collections.abc import Iterable

from foon_asp.errors import UserError
from foon_asp.questions.python_arguments import require_at_least
from foon_asp.questions.question import Kind, Option
from foon_asp.searches import Count, Search, SearchSettings, Ties, find_searches

TIES = Option(
    "ties",
    "Which of several equally good units to take, in the order of the files: first or last.",
    choices=tuple(map(str, Ties)),
)
COUNT = Option(
    "count",
    "What greedy-inputs counts: ingredients (input nodes and their ingredients) or nodes (without them).",
    choices=tuple(map(str, Count)),
)
DEPTH = Option(
    "depth_limit",
    "The greatest depth that ids tries before it gives up.",
    Kind.WHOLE,
    metavar="N",
    least=0,
)


def searches_named(names: Iterable[str]) -> list[Search]:
    """Return the searches with the given names, in the order of the names; without names, all searches.

    A repeated name counts once. Raises :class:`UserError` for an unknown name, and if two searches have one
    name.
    """
    searches = find_searches()
    names = list(dict.fromkeys(names)) or list(searches)
    unknown = [name for name in names if name not in searches]
    if unknown:
        raise UserError(f"found the search {unknown[0]!r}, expected one of {', '.join(searches)}")
    return [searches[name] for name in names]


def usable_searches(rated: bool) -> list[Search]:
    """Return all searches, except ``greedy-success`` if no success rates are known (``rated`` is false)."""
    return [search for search in searches_named(()) if rated or search.name != "greedy-success"]


def search_settings(
    ties: str,
    count: str,
    depth_limit: int | None,
    published: bool,
    time_limit: float | None,
    memory_limit: int | None,
) -> SearchSettings:
    """Return the settings of searches from options; raises :class:`UserError` for a wrong value.

    The limits are in seconds and bytes, and hold for each search by itself; ``None`` for no limit.
    """
    for name, value, choices in (("ties", ties, [*map(str, Ties)]), ("count", count, [*map(str, Count)])):
        if value not in choices:
            raise UserError(f"found {name}={value!r}, expected one of {', '.join(choices)}")
    if depth_limit is not None:
        require_at_least(depth_limit, 0, "depth_limit")
    return SearchSettings(Ties(ties), Count(count), published, depth_limit, time_limit, memory_limit)
