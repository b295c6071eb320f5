"""Exit codes of the command line."""

from enum import IntEnum


class ExitCode(IntEnum):
    """The exit code of a command."""

    DONE = 0
    """Done, and where something was to be proved, proved."""
    NEGATIVE = 1
    """Proved that no tree exists, or a check failed."""
    USAGE = 2
    """Bad usage or input."""
    LIMIT = 3
    """Stopped at a limit without a proof; the best tree and its bound were printed."""
    BUG = 70
    """A bug of foon-asp."""
