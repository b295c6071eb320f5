"""The state of reading files: diagnostics, prices, amounts and goal marks; and reports of progress."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from contextvars import ContextVar
from pathlib import Path

from foon_asp.network import ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.repeated_node import RepeatedNode
from foon_asp.text.stated_amounts import StatedAmounts
from foon_asp.text.stated_prices import StatedPrices

Report = Callable[[int], None]
"""A function that is called with the number of bytes read since its last call."""

REPORT_BYTES = 65_536
"""The least number of bytes that are read from one report to the next."""

_report: ContextVar[Report | None] = ContextVar("_report", default=None)


class Reading:
    """The findings while files are read: diagnostics, and prices, amounts and goal marks that files state.

    ``lenient``: whether parts that are not understood are left out with a warning; otherwise they are errors.
    ``diagnostics``: the findings in all files read so far.
    ``left_out``: the number of lines that were not understood or do not form a unit.
    ``prices``, ``amounts``: the prices and amounts that copies of units state.
    ``marked``: the nodes with the goal mark ``!``, each with its first place.
    ``repeated``: the nodes that a copy of a unit lists twice; such a node counts once.
    """

    def __init__(self, lenient: bool = False) -> None:
        self.lenient = lenient
        self.diagnostics: list[Diagnostic] = []
        self.left_out = 0
        self.prices = StatedPrices()
        self.marked: dict[ObjectNode, Source] = {}
        self.repeated: list[RepeatedNode] = []
        self.amounts = StatedAmounts()

    def reject(self, code: str, message: str, source: Source, excerpt: str = "") -> None:
        """Record a fault as an error; if ``lenient``, as a warning whose message ends in ``; left out``.

        ``left_out`` is not changed: the caller adds the number of lines.
        """
        severity = Severity.WARNING if self.lenient else Severity.ERROR
        message += "; left out" if self.lenient else ""
        self.diagnostics.append(Diagnostic(severity, code, message, source, excerpt))

    def warn(
        self, code: str, message: str, source: Source, excerpt: str = "", fix: str | None = None
    ) -> None:
        """Record a warning about an assumption; ``fix`` is the corrected line, ``None`` if none is known."""
        self.diagnostics.append(Diagnostic(Severity.WARNING, code, message, source, excerpt, fix))

    def raise_errors(self, earlier: int = 0) -> None:
        """Raise the errors among the diagnostics, if there are any.

        Parameters:
            earlier: How many diagnostics, from the first on, are ignored.

        Raises:
            InputError: if another diagnostic is an error.
        """
        errors = [d for d in self.diagnostics[earlier:] if d.severity is Severity.ERROR]
        if errors:
            raise InputError(errors)


@contextlib.contextmanager
def reporting_to(report: Report) -> Iterator[None]:
    """Return a context in which the reading of networks calls ``report`` with numbers of bytes."""
    token = _report.set(report)
    try:
        yield
    finally:
        _report.reset(token)


def progress_report() -> Report | None:
    """Return the function that receives reports of progress; ``None`` outside of :func:`reporting_to`."""
    return _report.get()


def size_of(files: Iterable[Path]) -> int:
    """Return the total size of files in bytes; a pipe or a missing file counts as empty."""
    return sum(file.stat().st_size for file in files if file.is_file())
