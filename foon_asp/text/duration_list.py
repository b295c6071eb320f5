"""How long motions take: a motion and a number of seconds on each line, and perhaps ``passive``."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.exact_price import decimal_text, read_decimal
from foon_asp.text.line import LineError
from foon_asp.text.table_rows import read_rows

_UNITS = {"": 1, "s": 1, "min": 60, "h": 3600}
_EXPECTED = "a number of seconds such as 90 or 1.5, or of minutes or hours such as 25 min"


class Duration(NamedTuple):
    """How many ``seconds`` a motion takes; a ``passive`` one needs nobody to stand by, as baking does.

    Example:
        >>> foon_asp.Duration(1500, passive=True).seconds
        1500
    """

    seconds: Fraction | int
    passive: bool = False


def read_durations(file: Path) -> dict[str, Duration]:
    """Read ``motion⇥90`` and ``motion⇥25 min⇥passive`` lines; durations are above 0, and kept exactly.

    Blank lines and ``#`` comments are passed over. Raises :class:`InputError` for a line of another form,
    and for a motion of which two things are said.
    """
    found: dict[str, Duration] = {}

    def read(name: str, value: str, _: Source) -> None:
        motion, column = name.strip(), len(name) + 2
        if not motion:
            raise LineError(1, "a duration", ("the motion before it",))
        written, tab, word = value.partition("\t")
        if tab and word.strip() != "passive":
            raise LineError(column + len(written) + 1, repr(word), ("passive", "the end of the line"))
        duration = Duration(_seconds(written.strip(), column), bool(tab))
        if found.setdefault(motion, duration) != duration:
            raise LineError(column, f"a second duration for {motion!r}", ("one",))

    read_rows(file, "duration", "a number of seconds", read)
    return found


def read_default(written: str) -> Fraction:
    """Read the default duration, as files have durations; raises :class:`UserError` for another form."""
    try:
        return _seconds(written.strip(), 1)
    except LineError as error:
        raise UserError(f"the default duration: {error}") from None


def template_text(motions: Mapping[str, Duration | None]) -> str:
    """Return a file of durations in which the word SECONDS stands for those that are not known."""
    lines = ["# motion, tab, seconds (or 25 min, 1.5 h); behind another tab passive, if nobody stands by"]
    for motion, known in motions.items():
        seconds = "SECONDS" if known is None else decimal_text(Fraction(known.seconds))
        lines.append(f"{motion}\t{seconds}" + ("\tpassive" if known is not None and known.passive else ""))
    return "\n".join(lines) + "\n"


def _seconds(written: str, column: int) -> Fraction:
    number, _, unit = written.partition(" ")
    unit = unit.strip()
    if unit not in _UNITS:
        raise LineError(column + len(number) + 1, repr(unit), tuple(filter(None, _UNITS)))
    seconds = read_decimal(number, column, _EXPECTED) * _UNITS[unit]
    if not seconds:
        raise LineError(column, f"the duration {written}", ("one above 0",))
    return seconds
