"""Questions of a batch answered by the workers of a Dask cluster."""

import functools
import time
from collections import deque
from collections.abc import Iterable, Iterator
from itertools import islice

from foon_asp.asp import Settings
from foon_asp.batch.answer_row import AnswerRow, answer_row, failed_row
from foon_asp.batch.batch_question import BatchQuestion, OpenData, Opener
from foon_asp.errors import UserError

_PATIENCE = "10s"  # time limit for an answer from the scheduler


def answer_on_cluster(
    opener: Opener,
    questions: Iterable[BatchQuestion],
    address: str,
    memory_limit: int | None = None,
    settings: Settings | None = None,
) -> Iterator[AnswerRow]:
    """Answer questions on the workers of a Dask scheduler; yield the rows in the order in which they come.

    ``address`` is that of the scheduler; ``settings`` have the user rules; ``memory_limit`` is in bytes. A
    worker keeps the data open until a question about other data comes. The files need the same names on every
    worker.

    A task has up to 32 questions. If it fails, each of its questions is asked again in a task of its own. If
    the workers of a question die repeatedly, another question on the same worker may be the cause. The
    question is then asked while no other one runs on the cluster; if its worker dies again, its row says so.
    Any other failure of a single question also becomes its row. Raises :class:`UserError` if there is no
    scheduler, or Dask is not installed.
    """
    try:
        from distributed import Client, KilledWorker, as_completed  # noqa: PLC0415 (an extra, slow to import)
    except ImportError:
        raise UserError("--scheduler needs Dask; install it with: pip install 'foon-asp[cluster]'") from None
    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError, TypeError) as error:  # TypeError: an address of TLS without certificates
        raise UserError(f"no scheduler at {address}: {error}") from None
    with client:
        waiting = iter(questions)
        retries: deque[tuple[BatchQuestion, ...]] = deque()
        suspects: deque[tuple[BatchQuestion, ...]] = deque()
        chunk_of: dict[str, tuple[BatchQuestion, ...]] = {}
        is_alone = False
        running = as_completed()

        def submit(chunk: tuple[BatchQuestion, ...]) -> None:
            """Submit a task with the questions of a chunk, and store the chunk by the key of the task."""
            future = client.submit(_answer_first_questions, opener, chunk, memory_limit, settings, pure=False)
            chunk_of[future.key] = chunk
            running.add(future)

        def submit_ahead() -> None:
            """Submit tasks until the cluster has two for each thread; those to be asked again come first."""
            while len(chunk_of) < max_submitted:
                # several in a task, for each of which Dask takes some milliseconds
                chunk = retries.popleft() if retries else tuple(islice(waiting, 32))
                if not chunk:
                    break
                submit(chunk)

        threads: dict[str, int] = client.nthreads()
        max_submitted = 2 * max(1, sum(threads.values()))  # so that no thread of the cluster waits
        submit_ahead()
        for future in running:
            chunk = chunk_of.pop(future.key)
            rows: list[AnswerRow] = future.result() if future.status == "finished" else []
            if rows or len(chunk) > 1:
                retries += ((question,) for question in chunk[len(rows) :])
            elif isinstance(future.exception(), KilledWorker) and not is_alone:
                suspects.append(chunk)
            else:
                rows = [failed_row(chunk[0], f"on the cluster: {future.exception()}")]
            submit_ahead()
            is_alone = not chunk_of
            if is_alone and suspects:
                submit(suspects.popleft())
            yield from rows


def _answer_first_questions(
    opener: Opener, chunk: tuple[BatchQuestion, ...], memory_limit: int | None, settings: Settings | None
) -> list[AnswerRow]:
    """Answer the questions of a chunk in order, and return the rows; after half a second, begin no other one.

    The first question is always answered. The caller asks again the questions that have no row.
    """
    data = _open_cached(opener)
    began = time.monotonic()
    rows = [answer_row(data, chunk[0], memory_limit, settings)]
    while len(rows) < len(chunk) and time.monotonic() - began < 0.5:
        rows.append(answer_row(data, chunk[len(rows)], memory_limit, settings))
    return rows


@functools.lru_cache(maxsize=1)
def _open_cached(opener: Opener) -> OpenData:
    """Return open data; the data opened last are kept, and returned again for an equal opener."""
    return opener()
