"""Tasks shared among processes of this machine, which end with this one, whatever they are at."""

import contextlib
import pickle
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from io import RawIOBase
from itertools import islice
from queue import Empty, SimpleQueue
from typing import Any, Generic, NamedTuple, TypeVar

from foon_asp.errors import BugError
from foon_asp.processes.pipe import packed, receive, receive_packed, requests, send, write
from foon_asp.processes.python_process import PythonProcess

Task = TypeVar("Task")
Answer = TypeVar("Answer")

Begin = Callable[[], Callable[[Task], Answer]]
"""Begins the work in a process, and returns what does a task there; it has to pickle."""


class LostError(Exception):
    """A task whose process died of it, or was ended since it was late."""

    def __init__(self, code: int | None) -> None:
        if code is None:
            why = "the process that worked on it gave no answer in time"
        elif code < 0:
            why = f"the process that worked on it was killed by {signal.Signals(-code).name}"
        else:
            why = f"the process that worked on it ended with exit code {code}"
        super().__init__(why)
        self.is_late = code is None


class Done(NamedTuple, Generic[Task, Answer]):
    """A task and its answer, or what was raised in its place: by the work, or :class:`LostError`."""

    task: Task
    answer: Answer | None
    error: Exception | None

    def get(self) -> Answer:
        """Return the answer; raise what was raised in its place."""
        if self.error is not None:
            raise self.error
        return self.answer  # type: ignore[return-value]  # there is one


def share(
    begin: "Begin[Task, Answer]",
    tasks: Iterable[Task],
    jobs: int,
    seconds: Callable[[Task], float | None] = lambda _: None,
) -> "Iterator[Done[Task, Answer]]":
    """Do tasks in processes, each of which begins the work once, and give the answers as they come.

    Where a process dies, or is at a task for more than its ``seconds``, which begin when the work has begun
    in it, another one takes its place.
    """
    first, waiting, heard = packed(begin), iter(tasks), _Heard()
    workers: dict[int, _Worker[Task]] = {}
    started = 0
    try:
        for task in islice(waiting, jobs):
            workers[started] = _Worker(first, task, started, heard)
            started += 1
        while workers:
            number, said = _next(workers, heard)
            worker = workers.get(number)
            if worker is None:  # it was ended meanwhile
                continue
            done, (kind, value) = worker.task, said
            if kind == "ready":
                worker.begins(seconds(done))
                continue
            if kind == "lost":
                code = worker.end() if worker.is_late else worker.died()
                value = LostError(None if worker.is_late else code)
            for task in islice(waiting, 1):
                if kind == "lost":
                    del workers[number]
                    workers[started] = _Worker(first, task, started, heard)
                    started += 1
                else:
                    worker.ask(task, seconds(task))
                break
            else:
                del workers[number]
                worker.end()
            yield Done(done, None, value) if kind != "done" else Done(done, value, None)
    finally:
        for worker in workers.values():
            worker.end()


_Said = tuple[str, Any]
_Heard = SimpleQueue[tuple[int, _Said]]


def _next(workers: "dict[int, _Worker[Any]]", heard: _Heard) -> tuple[int, _Said]:
    """Wait until a process says something, or has died or is late, of which it is said that it is lost."""
    while True:
        ends = {worker.end_by: number for number, worker in workers.items() if worker.end_by is not None}
        end = min(ends, default=None)
        with contextlib.suppress(Empty):
            return heard.get(timeout=None if end is None else max(0.0, end - time.monotonic()))
        if end is not None and time.monotonic() >= end:
            workers[ends[end]].is_late = True
            return ends[end], ("lost", None)


class _Worker(PythonProcess, Generic[Task]):
    """A process that does tasks, and the one that it is at."""

    def __init__(self, first: bytes, task: Task, number: int, heard: _Heard) -> None:
        super().__init__("foon_asp.processes.pool", "work is shared")
        self.task = task
        self.is_late = False
        self.end_by: float | None = None
        self.beside(_write, self._out, first + packed(task))  # which it reads when it has started
        self.beside(_listen, self._in, number, heard)

    def begins(self, seconds: float | None) -> None:
        """Count the seconds from now on."""
        self.end_by = None if seconds is None else time.monotonic() + seconds

    def ask(self, task: Task, seconds: float | None) -> None:
        """Give it another task; if it has died meanwhile, that is heard."""
        self.task = task
        self.begins(seconds)
        _write(self._out, packed(task))


def _write(pipe: RawIOBase, content: bytes) -> None:
    with contextlib.suppress(OSError, ValueError):
        write(pipe, content)


def _listen(pipe: RawIOBase, number: int, heard: _Heard) -> None:
    with contextlib.suppress(EOFError):
        while True:
            heard.put((number, receive(pipe)))
    heard.put((number, ("lost", None)))


def serve() -> None:
    """Do the tasks on standard input, after what begins the work, until there are no more."""
    asked, answers = requests(receive_packed)
    do = _begun(asked.get())
    with contextlib.suppress(BrokenPipeError):  # nobody reads any more
        send(answers, ("ready", None))
        while True:
            write(answers, _answer(do, asked.get()))


def _begun(begin: bytes) -> Callable[[Any], Any]:
    """Begin the work; where that fails, each task is answered with why."""
    try:
        do: Callable[[Any], Any] = pickle.loads(begin)()
    except Exception as error:
        refused = error

        def do(_: object) -> Any:
            raise refused

    return do


def _answer(do: Callable[[Any], Any], task: bytes) -> bytes:
    try:
        return packed(("done", do(pickle.loads(task))))
    except Exception as error:
        return packed(("raised", _portable(error)))


def _portable(error: Exception) -> Exception:
    """Return an error as it can be given to another process; some do not pickle."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return BugError(f"{type(error).__name__}: {error}")
    return error
