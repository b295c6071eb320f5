"""Calls of functions of other packages, each package in a process of its own.

So a package cannot change our data, exceed a limit, or print into our answers. Its reply is JSON, which
callers validate.
"""

import json
import sys
from io import RawIOBase
from typing import Any

from foon_asp.deadline import Deadline
from foon_asp.offered.offer import Offer, Raised
from foon_asp.processes.pipe import CHUNK_BYTES, pack_message
from foon_asp.processes.worker import DiedError, Worker, give_back_worker, take_worker


def ask_offered(offer: Offer, deadline: Deadline, *arguments: object) -> Any:
    """Call the function of an offer in the process of its package, and return the reply as values of JSON.

    The process is started unless it runs already, and kept for later calls. Returns :class:`Raised` if the
    function raised an exception. Raises :class:`~foon_asp.deadline.LimitError` at a limit and at ctrl-C,
    which end the process. Raises :class:`UserError` if the function cannot be imported, ends its process, or
    returns anything but values of JSON.
    """
    key = (offer.package, *sys.path)  # with the path, another version of the package may be found
    worker = take_worker(key, _start_worker)
    try:
        kind, line = worker.ask(pack_message((offer, arguments)), deadline)
    except DiedError as died:
        raise offer.fault(f"ended its process ({died.code})") from None
    if kind == "endless":
        worker.end()
        raise offer.fault("gave more than an answer can be")
    give_back_worker(key, worker)
    try:
        kind, value = json.loads(line)
    except (ValueError, TypeError, RecursionError):
        raise offer.fault("gave what cannot be read") from None
    if kind == "fault":
        raise offer.fault(*value)
    return Raised(tuple(value[0]), *value[1:]) if kind == "raised" else value


def _start_worker() -> Worker:
    """Start a process that calls the functions of one package."""
    return Worker("foon_asp.offered.call_worker", "what other packages offer is run", read=_read_message)


def _read_message(pipe: RawIOBase, max_bytes: int = 64 * 2**20) -> tuple[str, bytes]:
    """Read the next line of a pipe, and return ``"line"`` and its bytes.

    For a line of more than ``max_bytes``, which would fill the memory, return ``"endless"`` without bytes.
    Raises ``EOFError`` if the pipe ends before the line does.
    """
    line = bytearray()
    while not line.endswith(b"\n"):
        if len(line) > max_bytes:
            return "endless", b""
        try:
            chunk = pipe.read(CHUNK_BYTES)
        except (OSError, ValueError):  # closed
            chunk = None
        if not chunk:
            raise EOFError
        line += chunk
    return "line", bytes(line)
