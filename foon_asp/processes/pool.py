"""Process pool: tasks shared among child processes, with a time limit for each task."""

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
from foon_asp.processes.pipe import (
    become_worker,
    pack_message,
    receive,
    receive_pickled,
    send,
    write,
    write_if_open,
)
from foon_asp.processes.python_process import PythonProcess

Task = TypeVar("Task")
Answer = TypeVar("Answer")

TaskFunctionMaker = Callable[[], Callable[[Task], Answer]]
"""Called once in each process, it returns the function that does tasks there; it has to pickle."""


class LostError(Exception):
    """The process of a task died, or was killed at the time limit of the task.

    ``code`` is the exit code of the process, or minus the number of the signal that killed it. At the time
    limit, it is ``None``, and ``is_late`` is true.
    """

    def __init__(self, code: int | None) -> None:
        if code is None:
            reason = "the process that worked on it gave no answer in time"
        elif code < 0:
            reason = f"the process that worked on it was killed by {signal.Signals(-code).name}"
        else:
            reason = f"the process that worked on it ended with exit code {code}"
        super().__init__(reason)
        self.is_late = code is None


class FinishedTask(NamedTuple, Generic[Task, Answer]):
    """A finished task with its answer, or with the exception that was raised instead.

    The exception is one that the function for tasks raised, or a :class:`LostError`.
    """

    task: Task
    answer: Answer | None
    error: Exception | None

    def get(self) -> Answer:
        """Return the answer, or raise the exception in its place."""
        if self.error is not None:
            raise self.error
        return self.answer  # type: ignore[return-value]  # not None without an error


def run_in_processes(
    make_task_function: "TaskFunctionMaker[Task, Answer]",
    tasks: Iterable[Task],
    jobs: int,
    seconds: Callable[[Task], float | None] = lambda _: None,
) -> "Iterator[FinishedTask[Task, Answer]]":
    """Run tasks in up to ``jobs`` child processes; yield each task when it is finished, in any order.

    Processes start at the first ``next``. Each later task is taken from ``tasks`` when a process is free.

    ``make_task_function``: called once in each process; it returns the function that does the tasks.
    ``seconds``: a function that returns the time limit of a task, or ``None`` for no limit. The time of the
    first task of a process begins when ``make_task_function`` has returned.

    An exception that a task raises is not raised here; it is in :attr:`FinishedTask.error`. If a process dies
    or exceeds the time, the error of its task is a :class:`LostError`. The next task then gets a new process.
    All processes are ended when the iterator is closed.
    """
    packed_maker, remaining_tasks, messages = pack_message(make_task_function), iter(tasks), _Messages()
    workers: dict[int, _Worker[Task]] = {}
    start_count = 0
    try:
        for task in islice(remaining_tasks, jobs):
            workers[start_count] = _Worker(packed_maker, task, start_count, messages)
            start_count += 1
        while workers:
            number, (kind, value) = _next_message(workers, messages)
            worker = workers.get(number)
            if worker is None:  # it was killed before its message was read
                continue
            current_task = worker.task
            if kind == "ready":
                worker.start_timer(seconds(current_task))
                continue
            if kind == "lost":
                exit_code = worker.end() if worker.is_late else worker.wait_for_exit()
                value = LostError(None if worker.is_late else exit_code)
            for task in islice(remaining_tasks, 1):
                if kind == "lost":
                    del workers[number]
                    workers[start_count] = _Worker(packed_maker, task, start_count, messages)
                    start_count += 1
                else:
                    worker.ask(task, seconds(task))
                break
            else:
                del workers[number]
                worker.end()
            yield (
                FinishedTask(current_task, None, value)
                if kind != "done"
                else FinishedTask(current_task, value, None)
            )
    finally:
        for worker in workers.values():
            worker.end()


_Message = tuple[str, Any]  # its kind (ready, done, raised, lost) and value
_Messages = SimpleQueue[tuple[int, _Message]]  # with the number of the process that sent it


def _next_message(workers: "dict[int, _Worker[Any]]", messages: _Messages) -> tuple[int, _Message]:
    """Wait for a message of any worker, and return it with the number of the worker.

    If a worker exceeds the time of its task first, it is marked as late; the message returned for it is
    ``lost``. If a worker dies, its thread sends ``lost``.
    """
    while True:
        worker_by_end = {
            worker.end_by: number for number, worker in workers.items() if worker.end_by is not None
        }
        first_end = min(worker_by_end, default=None)
        with contextlib.suppress(Empty):
            return messages.get(timeout=None if first_end is None else max(0.0, first_end - time.monotonic()))
        if first_end is not None and time.monotonic() >= first_end:
            workers[worker_by_end[first_end]].is_late = True
            return worker_by_end[first_end], ("lost", None)


class _Worker(PythonProcess, Generic[Task]):
    """A process that does tasks, and its current ``task``, which has to be finished by ``end_by``.

    The constructor starts the process, and sends it the function and the first task.

    ``packed_maker``: the message with the function that makes the task function.
    ``number``: the number of the process, which identifies it in ``messages``.
    ``messages``: the queue of the messages of all processes.
    ``end_by``: a time of the monotonic clock; ``None`` for no limit.
    ``is_late``: whether ``end_by`` has passed before the end of the task.
    """

    def __init__(self, packed_maker: bytes, task: Task, number: int, messages: _Messages) -> None:
        super().__init__("foon_asp.processes.pool", "work is shared")
        self.task = task
        self.is_late = False
        self.end_by: float | None = None
        self.start_thread(
            write_if_open, self._to_process, packed_maker + pack_message(task)
        )  # waits until the process has started
        self.start_thread(_queue_messages, self._from_process, number, messages)

    def start_timer(self, seconds: float | None) -> None:
        """Start the time of the current task, which may take ``seconds``; ``None`` for no limit."""
        self.end_by = None if seconds is None else time.monotonic() + seconds

    def ask(self, task: Task, seconds: float | None) -> None:
        """Send the process another task, and start the time of this task.

        ``seconds`` is the time limit; ``None`` for no limit. If the process has died, its thread puts
        ``lost`` into the queue of messages.
        """
        self.task = task
        self.start_timer(seconds)
        write_if_open(self._to_process, pack_message(task))


def _queue_messages(pipe: RawIOBase, number: int, messages: _Messages) -> None:
    """Put each message of a worker and its number into the queue; at the end of its output, put ``lost``."""
    with contextlib.suppress(EOFError):
        while True:
            messages.put((number, receive(pipe)))
    messages.put((number, ("lost", None)))


def serve() -> None:
    """Run in a child process of a pool: do the tasks on standard input, until the parent process ends.

    The first message is ``make_task_function``. When it has returned, a message ``ready`` is sent. Each later
    message is a task, which is answered by a message.
    """
    received, answers = become_worker(receive_pickled)
    do_task = _make_task_function(received.get())
    with contextlib.suppress(BrokenPipeError):  # the parent has ended
        send(answers, ("ready", None))
        while True:
            write(answers, _answer_message(do_task, received.get()))


def _make_task_function(pickled_maker: bytes) -> Callable[[Any], Any]:
    """Unpickle ``make_task_function`` and call it; return the function that does tasks.

    If the call raises an exception, return a function that raises the exception for every task.
    """
    try:
        do_task: Callable[[Any], Any] = pickle.loads(pickled_maker)()
    except Exception as error:
        failure = error

        def do_task(_: object) -> Any:
            raise failure

    return do_task


def _answer_message(do_task: Callable[[Any], Any], task: bytes) -> bytes:
    """Do a pickled task; return the message ``done`` with its answer.

    If the task raises an exception, return the message ``raised`` with the exception.
    """
    try:
        return pack_message(("done", do_task(pickle.loads(task))))
    except Exception as error:
        return pack_message(("raised", _picklable_error(error)))


def _picklable_error(error: Exception) -> Exception:
    """Return ``error``; if it cannot be pickled and unpickled, a :class:`BugError` with its type and text."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        return BugError(f"{type(error).__name__}: {error}")
    return error
