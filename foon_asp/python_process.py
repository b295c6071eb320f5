"""Another process of the Python that runs this one, for work that cannot be interrupted in this one."""

import subprocess
import sys
from pathlib import Path
from typing import Any

from foon_asp.errors import UserError

_PACKAGES = str(Path(__file__).resolve().parents[1])

# A process group of its own: ctrl-C at a terminal is for this process, which ends the other.
_APART: dict[str, Any] = {"start_new_session": True}
if sys.platform == "win32":
    _APART = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP | subprocess.CREATE_NO_WINDOW}


def start_python(
    module: str, what: str, *options: str, stderr: int | None = None
) -> "subprocess.Popen[bytes]":
    """Start ``serve`` of a module, which reads from standard input and writes to standard output.

    It finds the modules that this process finds. Raises :class:`UserError` where it is not known where Python
    is; ``what`` is done there.
    """
    if not sys.executable:
        raise UserError(
            f"{what} by a Python of their own, and this program does not know where Python is: "
            "sys.executable is not set"
        )
    paths = [_PACKAGES, *(str(Path(path).resolve()) for path in sys.path)]
    serve = f"import sys; sys.path[:] = {paths!r}; from {module} import serve; serve()"
    return subprocess.Popen(
        [sys.executable, *options, "-P", "-c", serve],
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=stderr,
        **_APART,
    )
