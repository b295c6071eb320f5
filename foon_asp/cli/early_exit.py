"""Handlers of ctrl-C in a process that answers one command: before and after it, ctrl-C exits at once.

While modules are imported, and after the command, Python may ignore or misreport a ``KeyboardInterrupt``. So
this module is imported first, and imports as little as possible.
"""

import _signal as signal  # type: ignore[import-not-found]  # needs no other module, as signal does
import os

_MESSAGE = b"interrupted before there was an answer\n"


def end_at_ctrl_c() -> None:
    """Make ctrl-C exit the process at once; a handler other than Python's default one stays."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _exit_at_once)


def raise_at_ctrl_c() -> None:
    """Undo :func:`end_at_ctrl_c`: ctrl-C raises ``KeyboardInterrupt`` again; any other handler stays."""
    if signal.getsignal(signal.SIGINT) is _exit_at_once:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _exit_at_once(*_: object) -> None:
    """Print that the process was interrupted, and exit with code 3 without any cleaning up."""
    try:
        os.write(2, _MESSAGE)
    finally:
        os._exit(3)  # ``ExitCode.LIMIT``, which is imported later
