"""Warnings of Python, attributed to the line of the caller."""

import inspect
import warnings

from foon_asp.errors import FoonWarning


def warn(message: str) -> None:
    """Issue a :class:`FoonWarning`, attributed to the first frame outside the package."""
    frame = inspect.currentframe()
    level = 0
    while frame is not None and frame.f_globals.get("__name__", "").split(".")[0] == "foon_asp":
        frame = frame.f_back
        level += 1
    warnings.warn(message, FoonWarning, stacklevel=level + 1)
