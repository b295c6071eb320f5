"""The fields of motion lines: times in the source video, the moving entity and its success rate."""

import re
from typing import NamedTuple

_CLOCK = r"\d+:\d\d(?::\d\d)?"
_SPAN = rf"{_CLOCK}(?: ?- ?{_CLOCK})?"
_SPAN_OF_TWO = re.compile(r"<(\d[\d:]*) ?[,-] ?(\d[\d:]*)>")
_ASSUMED = re.compile(r"<(assumed)(?:, ?(assumed))?>", re.IGNORECASE)
_TIME = re.compile(
    rf"assumed|{_CLOCK}|<assumed(?:, ?assumed)?>|<{_SPAN}(?:, ?{_SPAN})*>", re.IGNORECASE | re.ASCII
)


def is_time(field: str) -> bool:
    """Whether a field is a time: ``1:10``, ``0:02:50``, ``Assumed``, ``<0:12-0:34,0:40-0:44>``."""
    return _TIME.fullmatch(field) is not None


def mended_time(field: str) -> str:
    """Return the time that a field with an obvious slip means, and any other field as it is.

    Obvious slips are a letter missing in ``Assumed`` and a bracket too many or too few.
    """
    if _TIME.fullmatch(field):
        return field
    bare = field.strip("<>[]{}() ")
    if bare.lower() in {"assume", "asumed", "assumed"}:
        bare = "Assumed"
    mended = f"<{bare}>" if field.startswith("<") else bare
    return mended if _TIME.fullmatch(mended) else field


def is_rate(field: str) -> bool:
    """Whether a field of a motion line is a success rate: a decimal from 0 to 1, such as ``0.85``."""
    return re.fullmatch(r"0(\.[0-9]*)?|\.[0-9]+|1(\.0*)?", field) is not None


class MotionFields(NamedTuple):
    """The fields of a motion line: its times, and where stated the moving entity and its success rate."""

    times: tuple[str, ...]
    entity: str | None = None
    rate: str | None = None

    @classmethod
    def of(cls, fields: tuple[str, ...]) -> "MotionFields":
        """Return the fields of a motion line by their meaning.

        If the last field can be a success rate and the one before it is no time, they are success rate and
        entity. All other fields are times.
        """
        if len(fields) > 1 and is_rate(fields[-1]) and not is_time(fields[-2]):
            return cls(fields[:-2], fields[-2], fields[-1])
        return cls(fields)

    @property
    def fields(self) -> tuple[str, ...]:
        """The fields in the order of the line: times, then entity and rate if there are both."""
        return (
            self.times if self.entity is None or self.rate is None else (*self.times, self.entity, self.rate)
        )


def in_two_fields(times: tuple[str, ...]) -> tuple[str, ...]:
    """Return the time ``<0:14,0:20>`` as two fields, ``0:14`` and ``0:20``.

    ``<Assumed>`` becomes two fields ``Assumed``. All other times are returned as they are.
    """
    if len(times) == 1:
        span = _SPAN_OF_TWO.fullmatch(times[0]) or _ASSUMED.fullmatch(times[0])
        if span and is_time(times[0]):
            return span[1], span[2] or span[1]
    return times


def in_one_field(times: tuple[str, ...]) -> tuple[str, ...]:
    """Return the two fields ``0:14`` and ``0:20`` as one, ``<0:14,0:20>``.

    Two fields ``Assumed`` become ``<Assumed>``. All other times are returned as they are.
    """
    if len(times) == 2 and not any(time[:1] == "<" for time in times):
        begin, end = times
        field = f"<{begin}>" if begin == end and begin[:1] in {"A", "a"} else f"<{begin},{end}>"
        if in_two_fields((field,)) == times:
            return (field,)
    return times
