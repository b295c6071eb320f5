"""Another process of the Python that runs this one, for work that cannot be interrupted in this one."""

import atexit
import contextlib
import os
import signal
import subprocess
import sys
import weakref
from collections.abc import Callable
from io import RawIOBase
from pathlib import Path
from typing import Any, cast

from foon_asp.aside import Aside
from foon_asp.deadline import uninterrupted
from foon_asp.errors import UserError

_PATIENCE = 5.0  # seconds until what follows from the end of a process has happened
_PACKAGES = str(Path(__file__).resolve().parents[2])

# A process group of its own: ctrl-C at a terminal is for this process, which ends the other.
_APART: dict[str, Any] = {"start_new_session": True}
if sys.platform == "win32":
    _APART = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP | subprocess.CREATE_NO_WINDOW}

_all: "weakref.WeakSet[PythonProcess]" = weakref.WeakSet()


class PythonProcess:
    """A process in which ``serve`` of a module reads from standard input and writes to standard output.

    It finds the modules that this process finds, and ends with it at the latest. Raises :class:`UserError`
    where it is not known where Python is; ``what`` is done there.
    """

    def __init__(self, module: str, what: str, *options: str, stderr: int | None = None) -> None:
        if not sys.executable:
            raise UserError(
                f"{what} by a Python of their own, and this program does not know where Python is: "
                "sys.executable is not set"
            )
        paths = [_PACKAGES, *(str(Path(path).resolve()) for path in sys.path)]
        serve = f"import sys; sys.path[:] = {paths!r}; from {module} import serve; serve()"
        self._process = subprocess.Popen(
            [sys.executable, *options, "-P", "-c", serve],
            bufsize=0,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=stderr,
            **_APART,
        )
        self._out = cast("RawIOBase", self._process.stdin)
        self._in = cast("RawIOBase", self._process.stdout)
        self._beside: list[Aside] = []
        _all.add(self)

    @property
    def alive(self) -> bool:
        """Whether it runs."""
        with uninterrupted():  # a process has a lock, and so in what follows
            return self._process.poll() is None

    def beside(self, target: Callable[..., None], *arguments: object) -> None:
        """Let a thread speak with the process, or listen to it, until it ends."""
        self._beside = [each for each in self._beside if not each.ended(0)]
        self._beside.append(Aside(target, *arguments))

    def end(self) -> int:
        """End it and the processes it has started, whatever they are at; give what it ended with."""
        with uninterrupted():
            if hasattr(os, "killpg"):
                with contextlib.suppress(OSError):
                    os.killpg(self._process.pid, signal.SIGKILL)
            self._process.kill()
            code = self._process.wait()
        for thread in self._beside:
            thread.ended(_PATIENCE)  # before another file gets the number that it reads from
        self._close()
        return code

    def died(self) -> int:
        """Wait a while for the end of a process that writes no more; give what it ended with."""
        with uninterrupted(), contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_PATIENCE)
        return self.end()

    def abandon(self) -> None:
        """Let go of a process that belongs to another: this one is a copy of that one."""
        self._process.returncode = 0
        self._close()

    def _close(self) -> None:
        for pipe in (self._out, self._in):
            with contextlib.suppress(OSError):
                pipe.close()


def _end_all() -> None:
    for process in list(_all):
        process.end()


def _forget_all() -> None:
    """Know of no process after a fork: those there are belong to the other."""
    for process in list(_all):
        process.abandon()


atexit.register(_end_all)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_all)
