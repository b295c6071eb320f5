"""Success rates of motions: ``motion.txt``, a motion and its rate on each line."""

import re
from fractions import Fraction
from pathlib import Path

from foon_asp.network import Source
from foon_asp.text.line import LineError
from foon_asp.text.table_rows import read_rows

_DECIMAL = re.compile(r"\d+(\.\d*)?|\.\d+", re.ASCII)

_LONGEST = 1000  # letters of a rate: no table means more


def read_rates(file: Path) -> dict[str, Fraction]:
    """Read ``motion⇥rate`` lines; rates are decimals in (0, 1], kept exactly.

    Raises :class:`InputError` for a line of another form, a rate outside (0, 1] and a motion with two
    different rates.
    """
    rates: dict[str, Fraction] = {}

    def read(name: str, value: str, _: Source) -> None:
        motion, column = name.strip(), len(name) + 2
        if not motion:
            raise LineError(1, "a success rate", ("the motion before it",))
        if len(value) > _LONGEST:
            raise LineError(column, f"a number of {len(value)} letters", (f"at most {_LONGEST}",))
        if not _DECIMAL.fullmatch(value):
            raise LineError(column, repr(value), ("a success rate as a decimal such as 0.85",))
        if not 0 < Fraction(value) <= 1:
            raise LineError(column, f"the success rate {value}", ("a rate above 0 and at most 1",))
        if rates.setdefault(motion, Fraction(value)) != Fraction(value):
            raise LineError(column, f"a second success rate for {motion!r}", ("one",))

    read_rows(file, "rate", "a success rate", read)
    return rates
