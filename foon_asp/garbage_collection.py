"""Suspension of Python's garbage collection, which would free nothing while many lasting objects are made."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def without_garbage_collection() -> Iterator[None]:
    """Disable garbage collection in a ``with`` block, which should create little cyclic garbage.

    If it was disabled before, it stays so. If the block made more than a million objects, they are moved to
    the oldest generation. Otherwise the next collection would traverse them, which takes seconds.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            # collecting a million objects takes 0.1 s; Python 3.12 itself freezes some hundreds
            if gc.get_count()[0] > 1_000_000 and gc.get_freeze_count() < 10_000:
                gc.freeze()
                gc.unfreeze()  # moves all objects to the oldest generation
            gc.enable()
