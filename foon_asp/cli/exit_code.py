"""Exit codes of the command line, for the ending of a question and for errors."""

import os
from enum import IntEnum
from typing import TYPE_CHECKING

import click

from foon_asp.deadline import LimitError
from foon_asp.errors import UserError
from foon_asp.escapes import escaped

if TYPE_CHECKING:
    from foon_asp.questions.ending import Ending


class ExitCode(IntEnum):
    """The exit code of a command."""

    DONE = 0
    """Done; if something was to be proved, it is proved."""
    NEGATIVE = 1
    """Proved that no tree exists, or a check failed."""
    USAGE = 2
    """Bad usage or input."""
    LIMIT = 3
    """Stopped at a limit without a proof; the best tree and its bound were printed."""
    BUG = 70
    """A bug of foon-asp."""


def exit_code_of(ending: "Ending") -> ExitCode:
    """Return the exit code with the same name as the ending of a question."""
    return ExitCode[ending.name]


def code_and_message(error: BaseException) -> tuple[ExitCode, str]:
    """Return the exit code and the message of an error.

    Limits, ctrl-C and a lack of memory have the code ``LIMIT``. Wrong input and failures of the system have
    ``USAGE``. Any other error is reported as a bug. The error must not be one that click shows itself.
    """
    match error:
        case LimitError() | click.Abort(__cause__=LimitError()):
            limit = error.__cause__ if isinstance(error, click.Abort) else error
            assert isinstance(limit, LimitError)
            text = (
                f"unknown: stopped at {limit.stopped}, before there was an answer\nwhat to do: {limit.advice}"
            )
            return ExitCode.LIMIT, text
        case click.Abort() | KeyboardInterrupt():
            return ExitCode.LIMIT, "interrupted before there was an answer"
        case MemoryError():
            return ExitCode.LIMIT, "unknown: out of memory; --memory-limit stops before that"
        case UserError():
            text = str(error)
            return ExitCode.USAGE, text if ": error: " in text else f"error: {text}"
        case OSError():  # of the system: a full disk, no permission, a folder in place of a file
            name = "" if error.filename is None else f"{escaped(os.fsdecode(error.filename))}: "
            return ExitCode.USAGE, f"error: {name}{error.strerror or error}"
    return ExitCode.BUG, (
        f"foon-asp has a bug: {type(error).__name__}: {error}\n"
        "please report it with the command and its input; --debug shows where it happened"
    )
