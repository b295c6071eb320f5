"""The caller of a question: Python, or a command, which shows progress and has a deadline."""

import contextlib
from collections.abc import Iterator
from contextvars import ContextVar
from typing import NamedTuple

from foon_asp.asp.reporter import Reporter
from foon_asp.deadline import Deadline
from foon_asp.warning import warn


class _Warner(Reporter):
    """Receives only warnings, and passes them on as Python does."""

    def warning(self, message: str) -> None:
        """Warn at the line of the caller."""
        warn(message)


class Caller(NamedTuple):
    """The caller of a question: Python or a command.

    ``reporter`` receives warnings and progress. ``deadline`` is the deadline of the command. ``read_seconds``
    is the time of reading in seconds; ``None`` if it is not shown. ``lenient`` says whether lines of a tree
    that are not understood are skipped. ``form`` is the chosen format of the result, if any.
    """

    reporter: Reporter
    deadline: Deadline | None = None
    read_seconds: float | None = None
    lenient: bool = False
    form: str | None = None


_CALLER: ContextVar[Caller | None] = ContextVar("caller", default=None)


def caller() -> Caller:
    """Return the current caller; by default Python, which receives only warnings."""
    return _CALLER.get() or Caller(_Warner())


def is_python() -> bool:
    """Whether the caller is Python, and no command."""
    return _CALLER.get() is None


@contextlib.contextmanager
def asked_by(who: Caller) -> Iterator[None]:
    """Set the caller inside a ``with`` block."""
    token = _CALLER.set(who)
    try:
        yield
    finally:
        _CALLER.reset(token)
