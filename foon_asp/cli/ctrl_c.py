"""What ctrl-C does in a process that answers one command: it ends it at once where there is nothing to lose.

While modules are imported, and where a command has ended, an exception is not always heard of as it should
be. So this comes first, and needs as little as it can.
"""

import _signal as signal  # type: ignore[import-not-found]  # needs no other module, as signal does
import os

_WORDS = b"interrupted before there was an answer\n"
_LIMIT = 3  # the exit code, whose names are imported later


def end_at_ctrl_c() -> None:
    """Let ctrl-C end the process from now on."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _end)


def raise_at_ctrl_c() -> None:
    """Let ctrl-C raise ``KeyboardInterrupt`` again, in a process that it would end."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _end(*_: object) -> None:
    try:
        os.write(2, _WORDS)
    finally:
        os._exit(_LIMIT)
