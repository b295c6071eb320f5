"""Questions shared among processes of this machine."""

import contextlib
import multiprocessing
import signal
import time
from collections.abc import Iterable, Iterator
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import NamedTuple

from foon_asp.asp import Settings
from foon_asp.batch.answer_row import Row, answer_row, failed_row
from foon_asp.batch.asked import Asked, Opener

_GRACE = 10.0  # seconds beyond its time limit after which a process that does not answer is ended


class Work(NamedTuple):
    """What a worker does: open the data once, then answer as ``how`` says.

    ``memory_limit`` is in bytes, for each worker, ``grace`` in seconds beyond time limits.
    """

    opener: Opener
    memory_limit: int | None = None
    grace: float = _GRACE
    how: Settings = Settings()


def answer_all(work: Work, questions: Iterable[Asked], jobs: int) -> Iterator[tuple[Asked, Row]]:
    """Answer questions in processes, each with its own copy of the data, and give rows as they come.

    A process that dies, or does not keep its limit, costs the question that it was at a row that says so,
    and another process takes its place. Where data cannot be opened, what :class:`UserError` says of it is
    the row of every question: open them once yourself before.
    """
    waiting = iter(questions)
    workers: dict[Connection, _Worker] = {}
    try:
        for _ in range(jobs):
            _next(work, waiting, workers, None)
        while workers:
            for connection in _ready(workers):
                worker = workers.pop(connection)
                asked, row = worker.result()
                _next(work, waiting, workers, worker if worker.alive else None)
                yield asked, row
    finally:
        for worker in workers.values():
            worker.end()


def _next(
    work: Work, waiting: Iterator[Asked], workers: "dict[Connection, _Worker]", worker: "_Worker | None"
) -> None:
    """Give the next question to a worker, starting one if needed; without questions, end the worker."""
    asked = next(waiting, None)
    if asked is None:
        if worker:
            worker.end()
        return
    worker = worker or _Worker(work)
    worker.ask(asked)
    workers[worker.connection] = worker


def _ready(workers: "dict[Connection, _Worker]") -> list[Connection]:
    """Wait until some have answered, died or gone beyond their limit."""
    while True:
        ends = [worker.end_by for worker in workers.values() if worker.end_by is not None]
        patience = None if not ends else max(0.0, min(ends) - time.monotonic())
        answered = [c for c in wait(list(workers), patience) if isinstance(c, Connection)]
        opened = [c for c in answered if not workers[c].opened]
        for connection in opened:
            workers[connection].hear_of_opening()
        if not opened:
            break
    now = time.monotonic()
    return answered or [c for c, w in workers.items() if w.end_by is not None and now >= w.end_by]


class _Worker:
    def __init__(self, work: Work) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self._grace = work.grace
        self._process: BaseProcess = context.Process(target=_serve, args=(theirs, work), daemon=True)
        self._process.start()
        theirs.close()
        self.alive = True
        self.opened = False
        self.end_by: float | None = None
        self._asked: Asked | None = None

    def ask(self, asked: Asked) -> None:
        self._asked = asked
        self.end_by = None
        if self.opened:
            self._begin()
        with contextlib.suppress(OSError):  # if it died meanwhile, that is seen when its answer is waited for
            self.connection.send(asked)

    def hear_of_opening(self) -> None:
        """Take note that the data is open; the question at hand begins now. A death is seen later."""
        with contextlib.suppress(EOFError, OSError):
            self.connection.recv()
            self._begin()
        self.opened = True

    def _begin(self) -> None:
        if self._asked is not None and self._asked.time_limit is not None:
            self.end_by = time.monotonic() + self._asked.time_limit + self._grace

    def result(self) -> tuple[Asked, Row]:
        """Give the row of the question at hand; what did not answer is not alive any more."""
        assert self._asked is not None
        try:
            if self.connection.poll():
                return self._asked, self.connection.recv()
            error = f"no answer within the time limit and {self._grace:g} seconds more"
        except (EOFError, OSError):
            self._process.join(5)
            error = _death(self._process.exitcode)
        self.end()
        return self._asked, failed_row(self._asked, error)

    def end(self) -> None:
        self.alive = False
        self.connection.close()
        self._process.kill()
        self._process.join()


def _death(code: int | None) -> str:
    if code is not None and code < 0:
        return f"the process that worked on it was killed by {signal.Signals(-code).name}"
    return f"the process that worked on it ended with exit code {code}"


def _serve(connection: Connection, work: Work) -> None:
    """Answer questions until there are no more; ctrl-C is for the process that asks them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asker = work.opener()
    connection.send(None)  # from now on the time counts
    while True:
        try:
            asked = connection.recv()
        except EOFError:
            return
        connection.send(answer_row(asker, asked, work.memory_limit, work.how))
