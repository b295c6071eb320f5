"""A process that answers one command: when it began, and its end, at which memory is not taken apart."""

import atexit
import contextlib
import os
import sys
import time
from typing import NoReturn

BEGAN = time.monotonic()
"""When the command line was imported, which is near enough to the beginning of the process."""

_kept: list[object] = []


def keep(*things: object) -> None:
    """Keep what a command has found until the next one, instead of giving its memory back piece by piece.

    Of a network of a million units, that takes seconds after the answer is there.
    """
    _kept[:] = things


def leave(code: int) -> NoReturn:
    """End the process as it would end by itself, but the system takes back its memory as a whole."""
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
    os._exit(code)
