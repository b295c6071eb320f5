"""Questions shared among the workers of a Dask cluster."""

import functools
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING, Any

from foon_asp.asp import Settings
from foon_asp.batch.answer_row import Row, answer_row, failed_row
from foon_asp.batch.asked import Asked, Asker, Opener
from foon_asp.errors import UserError

if TYPE_CHECKING:
    from distributed import Client

_PATIENCE = "10s"  # until there has to be an answer from the scheduler
_AHEAD = 4  # questions on their way for each thread of the cluster, so that none waits for the next


def answer_on_cluster(
    opener: Opener,
    questions: Iterable[Asked],
    address: str,
    memory_limit: int | None = None,
    how: Settings | None = None,
) -> Iterator[tuple[Asked, Row]]:
    """Answer questions on the workers of a scheduler, as ``how`` says, and give rows as they come.

    A worker opens the data once, and keeps them until others are asked for. The files have to be there under
    the same names as here. A question whose worker dies again and again is a row that says so. Raises
    :class:`UserError` where there is no scheduler, or Dask is not installed.
    """
    try:
        from distributed import Client, as_completed  # noqa: PLC0415 (an extra, and slow to import)
    except ImportError:
        raise UserError("--scheduler needs Dask; install it with: pip install 'foon-asp[cluster]'") from None
    try:
        client = Client(address, timeout=_PATIENCE)
    except (OSError, ValueError, TypeError) as error:  # TypeError: an address of TLS without certificates
        raise UserError(f"no scheduler at {address}: {error}") from None
    with client:
        waiting = iter(questions)
        asked_of: dict[str, Asked] = {}

        def submit(asked: Asked) -> Any:
            future = client.submit(_answer, opener, asked, memory_limit, how, pure=False)
            asked_of[future.key] = asked
            return future

        running = as_completed()
        for asked in islice(waiting, _AHEAD * max(1, _threads(client))):
            running.add(submit(asked))
        for future in running:
            asked = asked_of.pop(future.key)
            if future.status == "finished":
                row = future.result()
            else:
                row = failed_row(asked, f"on the cluster: {future.exception()}")
            for following in islice(waiting, 1):
                running.add(submit(following))
            yield asked, row


def _threads(client: "Client") -> int:
    threads: dict[str, int] = client.nthreads()
    return sum(threads.values())


def _answer(opener: Opener, asked: Asked, memory_limit: int | None, how: Settings | None) -> Row:
    return answer_row(_open(opener), asked, memory_limit, how)


@functools.lru_cache(maxsize=1)
def _open(opener: Opener) -> Asker:
    return opener()
