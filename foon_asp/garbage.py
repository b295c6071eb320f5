"""Python's garbage collection where very many objects are made that stay: it walks over them in vain."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager

_VERY_MANY = 1_000_000  # new objects, to walk over which takes a tenth of a second or more
_FEW = 10_000  # frozen objects, to walk over which is nothing: Python 3.12 itself begins with some hundreds


@contextmanager
def uncollected() -> Iterator[None]:
    """Do without collecting; so nothing that is done there may leave circular garbage behind often.

    Where very many objects were made, they are old ones afterwards: the next collection does not begin with
    walking over them, which takes seconds, also where a limit ended the work.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            if gc.get_count()[0] > _VERY_MANY and gc.get_freeze_count() < _FEW:
                gc.freeze()
                gc.unfreeze()  # to the oldest generation
            gc.enable()
