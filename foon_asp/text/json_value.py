"""One JSON text as plain values, whatever somebody wrote into it."""

import json
from collections.abc import Callable
from typing import Any


def read_json(text: str | bytes, pairs: Callable[[list[tuple[str, Any]]], object] | None = None) -> Any:
    """Parse a JSON text; ``pairs`` makes the objects, as ``json.loads`` has it.

    Raises :class:`ValueError` for whatever is wrong with it: also for what is nested deeper than Python can
    read, and for a number with more digits than Python turns into one.
    """
    try:
        return json.loads(text, object_pairs_hook=pairs)
    except RecursionError:
        raise ValueError("found lists within lists without end") from None
