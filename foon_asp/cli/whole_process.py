"""Start and end of a process that answers one command: the start time, and a fast exit."""

import atexit
import contextlib
import os
import sys
import time
from typing import NoReturn

BEGAN = time.monotonic()
"""The time, of the monotonic clock, when the command line was imported: shortly after the process started."""

_kept_objects: list[object] = []


def keep_until_exit(*objects: object) -> None:
    """Keep references to objects, so that Python does not free them before the process exits.

    They replace the objects of the previous call. Freeing a network of a million units would take seconds.
    """
    _kept_objects[:] = objects


def exit_process(code: int) -> NoReturn:
    """Run the exit handlers, flush the output, and exit the process without freeing its objects."""
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)
