"""The times of a motion line: when in the source video a motion begins and ends."""

import re

_CLOCK = r"\d+:\d\d(?::\d\d)?"
_SPAN = rf"{_CLOCK}(?: ?- ?{_CLOCK})?"
_TIME = re.compile(
    rf"assumed|{_CLOCK}|<assumed(?:, ?assumed)?>|<{_SPAN}(?:, ?{_SPAN})*>", re.IGNORECASE | re.ASCII
)


def is_time(field: str) -> bool:
    """Whether a field says when: ``1:10``, ``0:02:50``, ``Assumed``, ``<0:12-0:34,0:40-0:44>``."""
    return _TIME.fullmatch(field) is not None


def mended_time(field: str) -> str:
    """Give the time that was meant where that is beyond doubt, and else the field as it is.

    Only a letter missing in ``Assumed`` and a bracket too many or too few are.
    """
    if _TIME.fullmatch(field):
        return field
    bare = field.strip("<>[]{}() ")
    if bare.lower() in {"assume", "asumed", "assumed"}:
        bare = "Assumed"
    mended = f"<{bare}>" if field.startswith("<") else bare
    return mended if _TIME.fullmatch(mended) else field
