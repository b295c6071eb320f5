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
    """Answer questions in processes, each with its own copy of the data; return rows as they come.

    ``memory_limit`` is in bytes for each process. A process that dies, or that does not answer until
    ``grace`` seconds after its time limit, is replaced, and the row of its question says so. If the data
    cannot be opened, each row has the message of the :class:`UserError`; so the caller should open the data
    once before.
    """

    def seconds(question: BatchQuestion) -> float | None:
        return None if question.time_limit is None else question.time_limit + grace

    begin = partial(_begin, opener, memory_limit, settings)
    for question, row, error in run_in_processes(begin, questions, jobs, seconds):
        if isinstance(error, LostError) and error.is_late:
            yield failed_row(question, f"no answer within the time limit and {grace:g} seconds more")
        elif isinstance(error, LostError | UserError):
            yield failed_row(question, str(error))
        elif row is None:
            raise error or AssertionError("neither an answer nor an error")
        else:
            yield row


def _begin(opener: Opener, memory_limit: int | None, settings: Settings | None) -> "partial[AnswerRow]":
    """Open the data in a worker, and return the function that answers a question."""
    return partial(answer_row, opener(), memory_limit=memory_limit, settings=settings)
