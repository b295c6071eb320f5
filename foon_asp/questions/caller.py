"""The caller of a question: Python, or a command, which shows progress and has a deadline."""

import contextlib
from collections.abc import Iterator
from contextvars import ContextVar
from typing import NamedTuple

from foon_asp.asp.reporter import Reporter
from foon_asp.deadline import Deadline
from foon_asp.warning import warn


class _Warner(Reporter):
    """A reporter that turns warnings into those of Python, and drops everything else."""

    def warning(self, message: str) -> None:
        """Issue a warning of Python at the line of the user who called foon_asp."""
        warn(message)


class Caller(NamedTuple):
    """The caller of a question: Python or a command.

    ``reporter``: receives warnings and progress.
    ``deadline``: the deadline of the caller; ``None`` without limits.
    ``read_seconds``: how long reading the data took; ``None`` if that is not shown.
    ``lenient``: whether lines of a tree that are not understood are skipped.
    ``form``: the format in which the result will be shown; ``None`` for the default format.
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
    """Make ``who`` the current caller inside a ``with`` block."""
    token = _CALLER.set(who)
    try:
        yield
    finally:
        _CALLER.reset(token)
