"""A program in a process of its own, which can be ended: clingo cannot be interrupted while it grounds.

A process that did its work waits for the next program, so that starting one is paid for once.
"""

import contextlib
import os
import queue
import signal
import subprocess
import sys
import threading
import weakref
from collections.abc import Callable, Mapping, Sequence
from io import RawIOBase
from typing import Any

from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import BugError, UserError
from foon_asp.grounding.derived import Value
from foon_asp.grounding.run import OUT_OF_MEMORY, Ended, Heard, ProgramError
from foon_asp.grounding.stated import Stated
from foon_asp.pipe import receive, send
from foon_asp.python_process import PythonProcess


class WorkerProgram:
    """Like :class:`foon_asp.grounding.ground_program.GroundProgram`, in another process.

    Where a limit is reached, or ctrl-C pressed, the process is ended, :class:`LimitError` is raised, and the
    program is of no more use.
    """

    def __init__(
        self,
        files: Sequence[str | Stated],
        text: str,
        arguments: Sequence[str],
        products: int,
        deadline: Deadline,
    ) -> None:
        self._worker = _take()
        self._give_back = weakref.finalize(self, _give_back, self._worker)
        command = "ground", _folder(), list(files), text, list(arguments), products, _memory(deadline)
        self.deadline = deadline
        self._worker.ask(deadline, *command)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Give for each predicate, by name and arity, the numbers of its atoms."""
        found: list[list[tuple[int, ...]]] = self._worker.ask(self.deadline, "consequences", list(predicates))
        return found

    def search(
        self,
        opt_mode: str,
        predicates: Sequence[tuple[str, int]],
        on_tree: Callable[[Heard], None],
        on_bound: Callable[[list[int]], None],
    ) -> Ended:
        """Search for the best answer, and say how the search ended; trees are reported here."""
        hear: dict[str, Callable[[Any], None]] = {"tree": on_tree, "bound": on_bound}
        return Ended(*self._worker.ask(self.deadline, "search", opt_mode, list(predicates), hear=hear))

    def close(self) -> None:
        """Let the process have another program."""
        self._give_back()


def derive(text: str, name: str, arity: int, deadline: Deadline) -> list[tuple[Value, ...]]:
    """Do what :func:`foon_asp.grounding.derived.derive` does in another process, which ends at the limits."""
    worker = _take()
    try:
        found: list[tuple[Value, ...]] = worker.ask(deadline, "derive", text, name, arity, _memory(deadline))
        return found
    finally:
        _give_back(worker)


def _memory(deadline: Deadline) -> int | None:
    """Give how many bytes another process may use."""
    return None if deadline.memory is None else max(1, deadline.memory - deadline.memory_in_use())


def _folder() -> str | None:
    """Give the folder that names of files are relative to: it may be another one than at the last program."""
    try:
        return os.getcwd()
    except OSError:  # it was removed
        return None


class _Worker(PythonProcess):
    def __init__(self) -> None:
        super().__init__(
            "foon_asp.grounding.worker", "rules of yours are grounded", "-S", stderr=subprocess.DEVNULL
        )
        self.lost = False  # ended, or in the middle of something
        self._answers: queue.SimpleQueue[tuple[str, Any]] = queue.SimpleQueue()
        self._unheard = 0  # answers that nobody waits for
        self._answered = False
        self.beside(_hear, self._in, self._answers)

    @property
    def ready(self) -> bool:
        return not self.lost and self.alive

    def ask(
        self, deadline: Deadline, *command: object, hear: Mapping[str, Callable[[Any], None]] | None = None
    ) -> Any:
        """Give a command, pass on what is heard on the way, and give the answer.

        Raises :class:`ProgramError` and :class:`UserError` as the program does, and :class:`LimitError`.
        """
        if self.lost:
            raise BugError("a process was asked that had been ended")
        self.lost = True
        deadline.count(self._process.pid)
        try:
            with contextlib.suppress(OSError):  # that it died is seen when the answer is waited for
                send(self._out, command)
            while True:
                kind, value = self._answer(deadline)
                if hear is None or kind not in hear:
                    break
                hear[kind](value)
        except BaseException as error:
            self.end()
            if isinstance(error, KeyboardInterrupt) and not isinstance(error, LimitError):
                deadline.interrupt()
                raise LimitError(deadline) from None
            raise
        finally:
            deadline.uncount(self._process.pid)
        self.lost = False
        if kind == "refused":
            raise ProgramError(*value)
        if kind == "fault":
            raise UserError(value)
        if kind == "bug":
            raise BugError(f"in the process of clingo: {value}")
        return value

    def _answer(self, deadline: Deadline) -> tuple[str, Any]:
        while True:
            try:
                answer = self._answers.get(timeout=max(0.001, deadline.slice()))
            except queue.Empty:
                deadline.check()
                continue
            if answer[0] == "ended":
                self._died(deadline)
            self._answered = True
            if not self._unheard:
                return answer
            self._unheard -= 1

    def _died(self, deadline: Deadline) -> None:
        """Say why the process ended by itself: memory in most cases, or else clingo cannot take the rules."""
        code = self.died()
        if code in _OF_MEMORY or (deadline.memory is not None and code == -signal.SIGSEGV):
            deadline.out_of_memory()
            raise LimitError(deadline)
        if code == -signal.SIGFPE:
            raise UserError(
                "clingo broke down at a division in the rules that were added: -2147483648 / -1 is none of "
                "its numbers; calculate with smaller ones"
            )
        if not self._answered:
            raise UserError(
                f"{sys.executable} does not start as another process (it ended with {code}), "
                "where rules that were added are grounded"
            )
        raise UserError(
            f"clingo broke down while {deadline.doing} (its process ended with {code}); check the rules that "
            "were added: terms nested too deeply, for example, are more than it can take"
        )

    def end(self) -> int:
        """End the process, whatever it is at; give what it ended with."""
        self.lost = True
        return super().end()

    def abandon(self) -> None:
        """Let go of a process that belongs to another: this one is a copy of that one."""
        self.lost = True
        super().abandon()

    def forget(self) -> None:
        """Let the process drop its program, and do not wait for that."""
        try:
            send(self._out, ("forget",))
            self._unheard += 1
        except OSError:
            self.lost = True


def _hear(pipe: RawIOBase, answers: "queue.SimpleQueue[tuple[str, Any]]") -> None:
    with contextlib.suppress(EOFError):
        while True:
            answers.put(receive(pipe))
    answers.put(("ended", None))


_OF_MEMORY = {OUT_OF_MEMORY, -signal.SIGABRT, -9}
_MOST_IDLE = 1
_idle: list[_Worker] = []
_lock = threading.RLock()  # a program that is dropped gives its process back in the middle of anything


def prepare() -> None:
    """Start a process, if none waits: it gets ready while other things are done."""
    with _lock:
        if not any(worker.ready for worker in _idle):
            _idle.append(_Worker())


def _take() -> _Worker:
    with _lock:
        while _idle:
            worker = _idle.pop()
            if worker.ready:
                return worker
            worker.end()
        return _Worker()


def _give_back(worker: _Worker) -> None:
    """Keep a process for the next program, or end it."""
    with _lock:
        keep = worker.ready and len(_idle) < _MOST_IDLE
        if keep:
            worker.forget()
            _idle.append(worker)
    if not keep:
        worker.end()


def _forget_idle() -> None:
    """Know of no process after a fork: those there are belong to the other."""
    global _lock  # noqa: PLW0603 (another thread may have held it)
    _lock = threading.RLock()
    _idle.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_idle)
