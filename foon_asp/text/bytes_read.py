"""How far the reading of networks has come, for whoever shows it."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from contextvars import ContextVar
from pathlib import Path

Tell = Callable[[int], None]
"""Is called with the number of bytes that were read since it was called last."""

_tell: ContextVar[Tell | None] = ContextVar("_tell", default=None)


@contextlib.contextmanager
def telling(tell: Tell) -> Iterator[None]:
    """Call a function now and then, as networks are read in a ``with`` block."""
    token = _tell.set(tell)
    try:
        yield
    finally:
        _tell.reset(token)


def told() -> Tell | None:
    """Give the function to call, if there is one."""
    return _tell.get()


def size_of(files: Iterable[Path]) -> int:
    """Give how many bytes there are to read."""
    return sum(file.stat().st_size for file in files if file.is_file())
