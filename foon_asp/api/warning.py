"""Warnings of a search in Python's own way."""

from foon_asp.asp import Reporter
from foon_asp.warning import warn


class Warner(Reporter):
    """Hears of warnings alone, and passes them on."""

    def warning(self, message: str) -> None:
        """Warn at the line of the caller."""
        warn(message)
