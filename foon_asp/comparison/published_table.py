"""The published figures of the searches, which those measured here are held against."""

from pathlib import Path

import msgspec

from foon_asp.results.values import Value


class PublishedTable(Value, frozen=True):
    """Published figures of the searches.

    Attributes:
        source: Where they were published.
        containers: The container rule that they were found under.
        columns: The heading of each search.
        goals: Functional units by the label of the goal, and by search.
    """

    source: str
    containers: str
    columns: dict[str, str]
    goals: dict[str, dict[str, int]]


def read_published(file: Path) -> PublishedTable:
    """Return the figures of a file, such as that which comes with the program."""
    return msgspec.json.decode(file.read_bytes(), type=PublishedTable)
