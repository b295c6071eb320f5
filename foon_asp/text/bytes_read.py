"""How far the reading of networks has come, for whoever shows it."""

import contextlib
from collections.abc import Callable, Iterator
from contextvars import ContextVar

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
