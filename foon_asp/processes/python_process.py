"""A child process of the same Python, for work that cannot be interrupted within this process."""

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

from foon_asp.daemon_thread import DaemonThread
from foon_asp.deadline import uninterrupted
from foon_asp.errors import UserError

_PACKAGES = str(Path(__file__).resolve().parents[2])

# A process group of its own: ctrl-C at a terminal reaches only this process, which ends the child.
_OWN_GROUP: dict[str, Any] = {"start_new_session": True}
if sys.platform == "win32":
    _OWN_GROUP = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP | subprocess.CREATE_NO_WINDOW}

_processes: "weakref.WeakSet[PythonProcess]" = weakref.WeakSet()


class PythonProcess:
    """A child process that runs the function ``serve`` of a module.

    The function reads standard input and writes standard output. The process has the module search path of
    this process, and never outlives it. Ctrl-C at a terminal does not reach it.

    ``module``: the name of the module.
    ``activity``: the beginning of the message if the path of Python is unknown, such as ``work is shared``.
    ``options``: options of Python.
    ``stderr``: passed to :class:`subprocess.Popen`.

    Raises :class:`UserError` if the path of Python is unknown.
    """

    def __init__(self, module: str, activity: str, *options: str, stderr: int | None = None) -> None:
        if not sys.executable:
            raise UserError(
                f"{activity} by a Python of their own, and this program does not know where Python is: "
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
            **_OWN_GROUP,
        )
        self._to_process = cast("RawIOBase", self._process.stdin)
        self._from_process = cast("RawIOBase", self._process.stdout)
        self._group_ended = False  # or not ours: its number may be that of others by now
        self._threads: list[DaemonThread] = []
        _processes.add(self)

    @property
    def is_alive(self) -> bool:
        """Whether the process runs."""
        with uninterrupted():  # Popen takes a lock, here and in what follows
            return self._process.poll() is None

    def start_thread(self, target: Callable[..., None], *arguments: object) -> None:
        """Start a thread that reads from or writes to the process; it has to end when the process ends."""
        self._threads = [thread for thread in self._threads if not thread.wait_for_end(0)]
        self._threads.append(DaemonThread(target, *arguments))

    def end(self) -> int:
        """Kill the process and the processes that it has started, and close the pipes; return its exit code.

        If a signal killed the process, the code is minus the number of the signal. Each thread of the process
        gets five seconds to end. Ctrl-C is deferred while the process is killed. A second call returns the
        same code.
        """
        with uninterrupted():
            if hasattr(os, "killpg") and not self._group_ended:
                with contextlib.suppress(OSError):
                    os.killpg(self._process.pid, signal.SIGKILL)
            self._group_ended = True
            self._process.kill()
            code = self._process.wait()
        for thread in self._threads:
            thread.wait_for_end(5.0)  # before another file gets the descriptor that it reads
        self._close_pipes()
        return code

    def wait_for_exit(self) -> int:
        """Wait for a process that has closed its output, and return its exit code.

        If it does not end within five seconds, it is killed. Processes that it has started are killed in any
        case.
        """
        with uninterrupted(), contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        return self.end()

    def abandon(self) -> None:
        """Close the pipes, but let the process run.

        A copy of this program made by fork calls this, since the process is a child of the original program.
        """
        self._process.returncode = 0
        self._group_ended = True
        self._threads = []  # which a copy does not have
        self._close_pipes()

    def _close_pipes(self) -> None:
        for pipe in (self._to_process, self._from_process):
            with contextlib.suppress(OSError):
                pipe.close()


def _end_all() -> None:
    """Kill all child processes, when this process ends."""
    for process in list(_processes):
        process.end()


def _abandon_all() -> None:
    """In a copy of this program made by fork, abandon all processes: they are children of the original."""
    for process in list(_processes):
        process.abandon()


atexit.register(_end_all)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_abandon_all)
