"""The times of a motion in the form of one dialect or the other."""

import re

from foon_asp.text.motion_times import is_time

_SPAN = re.compile(r"<(\d[\d:]*) ?[,-] ?(\d[\d:]*)>")
_ASSUMED = re.compile(r"<(assumed)(?:, ?(assumed))?>", re.IGNORECASE)


def in_two_fields(times: tuple[str, ...]) -> tuple[str, ...]:
    """Write ``<0:14,0:20>`` as ``0:14`` and ``0:20``; times that are no single span stay as they are."""
    if len(times) == 1:
        span = _SPAN.fullmatch(times[0]) or _ASSUMED.fullmatch(times[0])
        if span and is_time(times[0]):
            return span[1], span[2] or span[1]
    return times


def in_one_field(times: tuple[str, ...]) -> tuple[str, ...]:
    """Write ``0:14`` and ``0:20`` as ``<0:14,0:20>``; what would be no time stays as it is."""
    if len(times) == 2 and not any(time[:1] == "<" for time in times):
        begin, end = times
        field = f"<{begin}>" if begin == end and begin[:1] in {"A", "a"} else f"<{begin},{end}>"
        if in_two_fields((field,)) == times:
            return (field,)
    return times
