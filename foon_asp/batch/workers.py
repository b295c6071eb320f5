"""Questions of a batch answered by local processes."""

from collections.abc import Iterable, Iterator
from functools import partial

from foon_asp.asp import Settings
from foon_asp.batch.answer_row import AnswerRow, answer_row, failed_row
from foon_asp.batch.batch_question import BatchQuestion, Opener
from foon_asp.errors import UserError
from foon_asp.processes.pool import LostError, run_in_processes


def answer_all(
    opener: Opener,
    questions: Iterable[BatchQuestion],
    jobs: int,
    memory_limit: int | None = None,
    settings: Settings | None = None,
    grace: float = 10.0,
) -> Iterator[AnswerRow]:
    """Answer questions in ``jobs`` processes; yield the rows in the order in which they come.

    Each process opens the data for itself. ``memory_limit`` is in bytes for each process. A process is
    replaced if it dies, or if it has not answered ``grace`` seconds after the time limit of its question. The
    row of the question then says so. If the data cannot be opened, each row has the message of the
    :class:`UserError`; so the caller should open the data once in advance. Raises other errors of a process.
    """

    def seconds(question: BatchQuestion) -> float | None:
        """Return the seconds after which a process counts as late; ``None`` without a time limit."""
        return None if question.time_limit is None else question.time_limit + grace

    start_worker = partial(_answer_function, opener, memory_limit, settings)
    for question, row, error in run_in_processes(start_worker, questions, jobs, seconds):
        if isinstance(error, LostError) and error.is_late:
            yield failed_row(question, f"no answer within the time limit and {grace:g} seconds more")
        elif isinstance(error, LostError | UserError):
            yield failed_row(question, str(error))
        elif row is None:
            raise error or AssertionError("neither an answer nor an error")
        else:
            yield row


def _answer_function(
    opener: Opener, memory_limit: int | None, settings: Settings | None
) -> "partial[AnswerRow]":
    """Open the data in a worker, and return the function from a question to its row."""
    return partial(answer_row, opener(), memory_limit=memory_limit, settings=settings)
