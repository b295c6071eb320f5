"""The durations of motions as users state them."""

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.problem.number import Number, exact_number
from foon_asp.text.tables import DURATIONS, Duration

Durations = str | PathLike[str] | Mapping[str, Number | Duration]
"""The path of a table, or seconds or a :class:`Duration` by motion."""


def stated_durations(durations: Durations | None) -> dict[str, Duration]:
    """Return durations by motion, read from a table or converted from a mapping.

    For ``None``, the result is empty. Raises :class:`UserError` for a duration that is not above 0.
    """
    if isinstance(durations, str | PathLike):
        return dict(DURATIONS.read(Path(durations)))
    return {motion: duration_of(duration, motion) for motion, duration in (durations or {}).items()}


def duration_of(duration: Number | Duration, motion: str) -> Duration:
    """Return the duration of a motion with exact seconds; a plain number is a duration that is not passive.

    Raises :class:`UserError` if the duration is not above 0.
    """
    stated_seconds, passive = duration if isinstance(duration, Duration) else (duration, False)
    seconds = exact_number(stated_seconds, f"the duration of {motion!r}")
    if seconds <= 0:
        raise UserError(f"found the duration {duration} of {motion!r}, expected one above 0")
    return Duration(seconds, passive)
