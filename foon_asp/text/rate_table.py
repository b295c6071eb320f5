"""Success rates of motions: ``motion.txt``, a motion and its rate on each line."""

from fractions import Fraction
from pathlib import Path

from foon_asp.network import Source
from foon_asp.text.exact_price import read_decimal
from foon_asp.text.line import LineError
from foon_asp.text.table_rows import read_rows


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
        rate = read_decimal(value, column, "a success rate as a decimal such as 0.85")
        if not 0 < rate <= 1:
            raise LineError(column, f"the success rate {value}", ("a rate above 0 and at most 1",))
        if rates.setdefault(motion, rate) != rate:
            raise LineError(column, f"a second success rate for {motion!r}", ("one",))

    read_rows(file, "rate", "a success rate", read)
    return rates
