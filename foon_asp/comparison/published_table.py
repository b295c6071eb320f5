"""Published figures of the searches, for comparison with the measured ones."""

from pathlib import Path

import msgspec

from foon_asp.results.values import Value


class PublishedTable(Value, frozen=True):
    """Published figures of the searches.

    Attributes:
        source: Where they were published.
        containers: The container rule under which they were measured.
        columns: The heading of each search, by its name.
        goals: The number of functional units, by the label of the goal and by the name of the search.
    """

    source: str
    containers: str
    columns: dict[str, str]
    goals: dict[str, dict[str, int]]


def read_published(file: Path) -> PublishedTable:
    """Return the figures of a JSON file, such as the one in the bundled data."""
    return msgspec.json.decode(file.read_bytes(), type=PublishedTable)
