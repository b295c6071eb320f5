"""Questions shared among the workers of a Dask cluster."""

import functools
import time
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING

from foon_asp.asp import Settings
from foon_asp.batch.answer_row import Row, answer_row, failed_row
from foon_asp.batch.asked import Asked, Asker, Opener
from foon_asp.errors import UserError

if TYPE_CHECKING:
    from distributed import Client

_PATIENCE = "10s"  # until there has to be an answer from the scheduler
_AHEAD = 2  # tasks on their way for each thread of the cluster, so that none waits for the next
_SECONDS = 0.5  # after which a task begins with no further question; the others go into another task
_MOST = 256  # questions of a task


def answer_on_cluster(
    opener: Opener,
    questions: Iterable[Asked],
    address: str,
    memory_limit: int | None = None,
    how: Settings | None = None,
) -> Iterator[tuple[Asked, Row]]:
    """Answer questions on the workers of a scheduler, as ``how`` says, and give rows as they come.

    A worker opens the data once, and keeps them until others are asked for. The files have to be there under
    the same names as here. A task has as many questions as take half a second; where its worker dies, another
    one answers them. A question whose worker dies again and again is a row that says so. Raises
    :class:`UserError` where there is no scheduler, or Dask is not installed.
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
        chunks = _Chunks(questions)
        asked_of: dict[str, Sequence[Asked]] = {}
        alone: deque[Sequence[Asked]] = deque()  # asked again with nothing else on the cluster
        is_alone = False
        running = as_completed()

        def submit(some: Iterable[Sequence[Asked]]) -> None:
            for chunk in some:
                future = client.submit(_answer_some, opener, chunk, memory_limit, how, pure=False)
                asked_of[future.key] = chunk
                running.add(future)

        ahead = _AHEAD * max(1, _threads(client))
        submit(islice(chunks, ahead))
        for future in running:
            chunk = asked_of.pop(future.key)
            rows: list[Row] = []
            if future.status == "finished":
                rows, seconds = future.result()
                chunks.took(chunk, len(rows), seconds)
            elif len(chunk) > 1:  # one of them is at fault, and only that one fails
                chunks.again += ((asked,) for asked in chunk)
            elif isinstance(future.exception(), KilledWorker) and not is_alone:
                alone.append(chunk)  # what was beside it on the worker may be at fault
            else:
                rows = [failed_row(chunk[0], f"on the cluster: {future.exception()}")]
            submit(islice(chunks, ahead - len(asked_of)))
            is_alone = not asked_of
            if is_alone and alone:
                submit([alone.popleft()])
            yield from zip(chunk, rows, strict=False)


class _Chunks:
    """Questions for one task each: as many as take half a second, going by those answered before.

    ``again`` are those that come first, since a task has left them.
    """

    def __init__(self, questions: Iterable[Asked]) -> None:
        self.again: deque[Sequence[Asked]] = deque()
        self._waiting = iter(questions)
        self._size = 1

    def __iter__(self) -> Iterator[Sequence[Asked]]:
        while chunk := self.again.popleft() if self.again else tuple(islice(self._waiting, self._size)):
            yield chunk

    def took(self, chunk: Sequence[Asked], answered: int, seconds: float) -> None:
        """Learn how long a task took for the first questions of its chunk; the others are asked again."""
        if answered < len(chunk):
            self.again.append(chunk[answered:])
        fit = int(_SECONDS * answered / max(seconds, 1e-6))
        self._size = max(1, min(fit, 4 * self._size, _MOST))


def _threads(client: "Client") -> int:
    threads: dict[str, int] = client.nthreads()
    return sum(threads.values())


def _answer_some(
    opener: Opener, chunk: Sequence[Asked], memory_limit: int | None, how: Settings | None
) -> tuple[list[Row], float]:
    """Answer the first questions of a chunk, at least one, and give their rows and the seconds they took.

    So no row waits longer than half a second for others, but for the one after it.
    """
    asker = _open(opener)
    began = time.monotonic()
    rows: list[Row] = []
    for asked in chunk:
        rows.append(answer_row(asker, asked, memory_limit, how))
        if time.monotonic() - began >= _SECONDS:
            break
    return rows, time.monotonic() - began


@functools.lru_cache(maxsize=1)
def _open(opener: Opener) -> Asker:
    return opener()
