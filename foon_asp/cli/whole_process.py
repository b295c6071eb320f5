"""Start and end of a process that answers one command: its start time, and an exit that frees no objects."""

import atexit
import contextlib
import os
import sys
import time
from typing import NoReturn

BEGAN = time.monotonic()
"""The time, of the monotonic clock, when the command line was imported: shortly after the process started."""

_kept: list[object] = []


def keep(*objects: object) -> None:
    """Keep objects until the next command, so that their memory is not freed after the answer.

    Freeing a network of a million units would take seconds.
    """
    _kept[:] = objects


def leave(code: int) -> NoReturn:
    """Exit the process as at its normal end, but without freeing its objects one by one."""
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)
