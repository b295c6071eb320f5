"""Suspension of Python's garbage collection while many objects are made that stay: it would free none."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

_MANY_OBJECTS = 1_000_000  # new ones, of which a collection takes a tenth of a second or more
_MAX_FROZEN = 10_000  # objects that may be unfrozen at no cost: Python 3.12 itself starts with some hundreds


@contextmanager
def uncollected() -> Iterator[None]:
    """Disable garbage collection in a ``with`` block, which should create little cyclic garbage.

    If the block made very many objects, they are moved to the oldest generation, so that the next collection
    does not traverse them, which would take seconds.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            if gc.get_count()[0] > _MANY_OBJECTS and gc.get_freeze_count() < _MAX_FROZEN:
                gc.freeze()
                gc.unfreeze()  # moves all objects to the oldest generation
            gc.enable()
