"""Client of a worker process, which can be killed: clingo cannot be interrupted while it grounds."""

import os
import signal
import subprocess
import sys
import weakref
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from foon_asp.deadline import Deadline, LimitError
from foon_asp.encoding.derived import Value
from foon_asp.encoding.run import Ended, FoundAnswer, ProgramError
from foon_asp.encoding.stated import Stated
from foon_asp.errors import BugError, UserError
from foon_asp.processes.pipe import OUT_OF_MEMORY, pack_message
from foon_asp.processes.worker import DiedError, Worker, give_back_worker, take_worker

_KEY = "foon_asp.encoding.program_worker"
_OF_MEMORY = {OUT_OF_MEMORY, -signal.SIGABRT, -9}
_Handlers = Mapping[str, Callable[[Any], None]]


class WorkerProgram:
    """A :class:`foon_asp.encoding.ground_program.GroundProgram` in another process.

    At a limit or ctrl-C, the process is killed, :class:`LimitError` is raised, and the program cannot be used
    any more.
    """

    def __init__(
        self,
        files: Sequence[str | Stated],
        text: str,
        arguments: Sequence[str],
        products: int,
        deadline: Deadline,
    ) -> None:
        """Take a worker process, and wait until it has grounded the files and the text.

        ``products`` is the number of products of rates in the text.
        """
        self._worker = take_worker(_KEY, _start_worker)
        self._give_back = weakref.finalize(self, _release_worker, self._worker)
        self.deadline = deadline
        parameters = list(files), text, list(arguments), products, _memory_left(deadline)
        _ask(self._worker, deadline, "ground", _current_folder(), *parameters)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Return the arguments of all atoms of each predicate, given by name and arity.

        The result has a list for each predicate; all arguments have to be numbers.
        """
        numbers: list[list[tuple[int, ...]]] = _ask(
            self._worker, self.deadline, "consequences", list(predicates)
        )
        return numbers

    def search(
        self,
        opt_mode: str,
        predicates: Sequence[tuple[str, int]],
        on_tree: Callable[[FoundAnswer], None],
        on_bound: Callable[[list[int]], None],
    ) -> Ended:
        """Search for the best answer, and return how the search ended; trees are reported in this process.

        The parameters are those of :meth:`foon_asp.encoding.ground_program.GroundProgram.search`.
        """
        handlers: _Handlers = {"tree": on_tree, "bound": on_bound}
        return Ended(
            *_ask(self._worker, self.deadline, "search", opt_mode, list(predicates), handlers=handlers)
        )

    def close(self) -> None:
        """Release the process for another program."""
        self._give_back()


def derive(text: str, name: str, arity: int, deadline: Deadline) -> list[tuple[Value, ...]]:
    """Run :func:`foon_asp.encoding.derived.derive` in another process.

    The process is killed at the limits and at ctrl-C; then :class:`LimitError` is raised.
    """
    worker = take_worker(_KEY, _start_worker)
    try:
        rows: list[tuple[Value, ...]] = _ask(
            worker, deadline, "derive", text, name, arity, _memory_left(deadline)
        )
        return rows
    finally:
        _release_worker(worker)


def _memory_left(deadline: Deadline) -> int | None:
    """Return how many bytes another process may use, at least 1; ``None`` if memory is not limited."""
    return None if deadline.memory is None else max(1, deadline.memory - deadline.memory_in_use())


def _current_folder() -> str | None:
    """Return the current folder, which may change between programs; ``None`` if it was removed."""
    try:
        return os.getcwd()
    except OSError:  # it was removed
        return None


def start_in_advance() -> None:
    """Start a worker process for a later program, unless one is waiting."""
    give_back_worker(_KEY, take_worker(_KEY, _start_worker))


def _start_worker() -> Worker:
    """Start a worker process."""
    return Worker(_KEY, "rules of yours are grounded", "-S", stderr=subprocess.DEVNULL)


def _release_worker(worker: Worker) -> None:
    """Return a worker process to the pool; a process that is not busy or dead first drops its program."""
    if worker.is_ready:
        worker.tell(pack_message(("forget",)))
    give_back_worker(_KEY, worker)


def _ask(worker: Worker, deadline: Deadline, *command: object, handlers: _Handlers | None = None) -> Any:
    """Send a command to a worker, and return its answer.

    Reports that arrive before the answer are passed to ``handlers``, by their kind (``tree`` or ``bound``).

    Raises the :class:`ProgramError` or :class:`UserError` that the worker reports, and :class:`BugError` for
    any other error that it reports. Raises :class:`LimitError` at a limit. If the worker dies, raises the
    error of :func:`_error_of_death`.
    """
    try:
        kind, value = worker.ask(pack_message(command), deadline, handlers)
    except DiedError as died:
        raise _error_of_death(died.code, worker.has_spoken, deadline) from None
    if kind == "refused":
        raise ProgramError(*value)
    if kind == "fault":
        raise UserError(value)
    if kind == "bug":
        raise BugError(f"in the process of clingo: {value}")
    return value


def _error_of_death(code: int, has_spoken: bool, deadline: Deadline) -> UserError | LimitError:
    """Return the error for a process that died with an exit code.

    If memory ran out, it is :class:`LimitError`, and the deadline records the lack of memory. Otherwise it is
    a :class:`UserError` that blames a division, the start of Python, or the rules.
    """
    if code in _OF_MEMORY or (deadline.memory is not None and code == -signal.SIGSEGV):
        deadline.stop_out_of_memory()
        return LimitError(deadline)
    if code == -signal.SIGFPE:
        return UserError(
            "clingo broke down at a division in the rules that were added: -2147483648 / -1 is none of "
            "its numbers; calculate with smaller ones"
        )
    if not has_spoken:
        return UserError(
            f"{sys.executable} does not start as another process (it ended with {code}), "
            "where rules that were added are grounded"
        )
    return UserError(
        f"clingo broke down while {deadline.doing} (its process ended with {code}); check the rules that "
        "were added: terms nested too deeply, for example, are more than it can take"
    )
