"""Success rates of motions: ``motion.txt``, a motion and its rate on each line."""

import re
from fractions import Fraction
from pathlib import Path

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import read_plain_text

_DECIMAL = re.compile(r"\d+(\.\d*)?|\.\d+", re.ASCII)

_LONGEST = 1000  # letters of a rate: no table means more


def read_rates(file: Path) -> dict[str, Fraction]:
    """Read ``motion⇥rate`` lines; rates are decimals in (0, 1], kept exactly.

    Raises :class:`InputError` for a line of another form, a rate outside (0, 1] and a motion with two
    different rates.
    """
    rates: dict[str, Fraction] = {}
    errors: list[Diagnostic] = []
    for number, raw in enumerate(read_plain_text(file).split("\n"), 1):
        line = raw.removesuffix("\r")
        if not line.strip() or line.startswith("#"):
            continue

        def reject(column: int, message: str, number: int = number, line: str = line) -> None:
            source = Source(str(file), number, column)
            errors.append(Diagnostic(Severity.ERROR, "rate", message, source, line))

        motion, tab, field = line.partition("\t")
        value = field.strip()
        column = len(motion) + 2
        if not tab:
            reject(len(line) + 1, "found the end of the line, expected a tab and a success rate")
        elif not motion.strip():
            reject(1, "found a success rate, expected the motion before it")
        elif len(value) > _LONGEST:
            reject(column, f"found a number of {len(value)} letters, expected at most {_LONGEST}")
        elif not _DECIMAL.fullmatch(value):
            reject(column, f"found {value!r}, expected a success rate as a decimal such as 0.85")
        elif not 0 < Fraction(value) <= 1:
            reject(column, f"found the success rate {value}, expected a rate above 0 and at most 1")
        elif rates.setdefault(motion.strip(), Fraction(value)) != Fraction(value):
            reject(column, f"found a second success rate for {motion.strip()!r}, expected one")
    if errors:
        raise InputError(errors)
    return rates
