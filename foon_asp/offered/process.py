"""Asking what another package offers, in a process of its own: whatever it does, it does there.

It cannot change our data, nor keep us past a limit, nor print among our answers. What it gives is JSON, and
nothing of it is believed.
"""

import json
import sys
from io import RawIOBase
from typing import Any

from foon_asp.deadline import Deadline
from foon_asp.offered.offer import Offer, Raised
from foon_asp.processes.pipe import packed
from foon_asp.processes.worker import DiedError, Worker, give_back, take

_MOST = 64 * 2**20  # bytes of an answer


def ask_offered(offer: Offer, deadline: Deadline, *arguments: object) -> Any:
    """Call the function that is offered, and give what it gave as plain values; ``Raised`` if it raised.

    Raises :class:`~foon_asp.deadline.LimitError` at a limit, and :class:`UserError` where there is no such
    function, or none that ends with plain values.
    """
    key = (offer.package, *sys.path)  # and where it was found
    worker = take(key, _start)
    try:
        kind, line = worker.ask(packed((offer, arguments)), deadline)
    except DiedError as died:
        raise offer.fault(f"ended its process ({died.code})") from None
    if kind == "endless":
        worker.end()
        raise offer.fault("gave more than an answer can be")
    give_back(key, worker)
    try:
        kind, value = json.loads(line)
    except (ValueError, TypeError, RecursionError):
        raise offer.fault("gave what cannot be read") from None
    if kind == "fault":
        raise offer.fault(*value)
    return Raised(tuple(value[0]), *value[1:]) if kind == "raised" else value


def _start() -> Worker:
    return Worker("foon_asp.offered.worker", "what other packages offer is run", read=_line)


def _line(pipe: RawIOBase) -> tuple[str, bytes]:
    """Read a line, or as much as is too long for one; raises ``EOFError`` where it is cut off."""
    line = bytearray()
    while not line.endswith(b"\n"):
        if len(line) > _MOST:
            return "endless", b""
        try:
            part = pipe.read(1 << 20)
        except (OSError, ValueError):  # closed
            part = None
        if not part:
            raise EOFError
        line += part
    return "line", bytes(line)
