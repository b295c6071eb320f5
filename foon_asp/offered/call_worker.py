"""The process that calls the functions of another package, until the process that started it ends."""

import json
import pickle
import traceback
from collections.abc import Callable
from importlib.metadata import EntryPoint
from typing import Any

from foon_asp.offered.offer import Offer
from foon_asp.processes.pipe import become_worker, receive_pickled, write


def serve() -> None:
    """Call the functions that requests on standard input name, and write their replies to standard output.

    A request is a pickled offer with arguments; a reply is a line of JSON (:func:`_call`). Never returns.
    """
    received, answers = become_worker(receive_pickled)
    functions: dict[Offer, Callable[..., object]] = {}
    while True:
        offer, arguments = pickle.loads(received.get())
        write(answers, _call(offer, arguments, functions))


def _call(
    offer: Offer, arguments: tuple[object, ...], functions: dict[Offer, Callable[..., object]]
) -> bytes:
    """Call the function of an offer, and return a line of JSON with a kind and a value.

    The kind ``reply`` has the value that the function returned. ``raised`` has the parts of :class:`Raised`,
    if the function raised an exception, also ``SystemExit``. ``fault`` has a complaint and a traceback, if
    the function or its reply cannot be used; the traceback may be empty. ``functions`` are those imported so
    far; a new one is added.
    """
    if offer not in functions:
        try:
            function: Any = EntryPoint(offer.name, offer.function, offer.group).load()
        except BaseException as error:
            return _message_line(
                "fault", [f"cannot be imported: {_error_text(error)}", traceback.format_exc()]
            )
        if not callable(function):
            return _message_line("fault", [f"expected a function, found {_shortened_repr(function)}", ""])
        functions[offer] = function
    try:
        reply = functions[offer](*arguments)
    except BaseException as error:
        classes = [f"{kind.__module__}.{kind.__qualname__}" for kind in type(error).__mro__]
        raised_at = next(
            (
                f"{frame.filename}:{frame.lineno}"
                for frame in reversed(traceback.extract_tb(error.__traceback__))
                if frame.filename != __file__ and not frame.filename.startswith("<")
            ),
            "",
        )
        return _message_line("raised", [classes, _error_message(error), raised_at, traceback.format_exc()])
    try:
        return _message_line("reply", reply)
    except Exception:
        return _message_line("fault", [f"gave {_shortened_repr(reply)}, which is no answer", ""])


def _message_line(kind: str, value: object) -> bytes:
    """Return a kind and a value as a line of JSON."""
    return json.dumps([kind, value], allow_nan=False).encode("ascii") + b"\n"


def _error_text(error: BaseException) -> str:
    """Return the class of an exception and the beginning of its message, with a colon between them."""
    return f"{type(error).__name__}: {_error_message(error)}"


def _error_message(error: BaseException) -> str:
    """Return the beginning of the message of an exception; empty if its ``__str__`` raises, too."""
    try:
        return _first_letters(str(error))
    except Exception:
        return ""


def _shortened_repr(value: object) -> str:
    """Return the beginning of the ``repr`` of a value; if ``repr`` raises, return the value's class."""
    try:
        return _first_letters(repr(value))
    except Exception:
        return f"a {type(value).__name__}"


def _first_letters(message: str, max_letters: int = 1000) -> str:
    """Return the first ``max_letters`` letters of a message, since some messages contain all data."""
    return message[:max_letters]
