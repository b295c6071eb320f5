"""The other process: it calls functions of another package, until no more requests come."""

import json
import pickle
import traceback
from collections.abc import Callable
from importlib.metadata import EntryPoint
from typing import Any

from foon_asp.offered.offer import Offer
from foon_asp.processes.pipe import receive_packed, requests, write

_LONGEST = 1000  # letters of a message


def serve() -> None:
    """Call what standard input asks for, and answer on what was standard output, which is now stderr."""
    asked, answers = requests(receive_packed)
    functions: dict[Offer, Callable[..., object]] = {}
    while True:
        offer, arguments = pickle.loads(asked.get())
        write(answers, _answer(offer, arguments, functions))


def _answer(
    offer: Offer, arguments: tuple[object, ...], functions: dict[Offer, Callable[..., object]]
) -> bytes:
    """Call the function, and give a line of JSON: what it gave, what it raised, or what is wrong with it."""
    if offer not in functions:
        try:
            function: Any = EntryPoint(offer.name, offer.function, offer.group).load()
        except BaseException as error:
            return _line("fault", [f"cannot be imported: {_in_words(error)}", traceback.format_exc()])
        if not callable(function):
            return _line("fault", [f"expected a function, found {_shown(function)}", ""])
        functions[offer] = function
    try:
        given = functions[offer](*arguments)
    except BaseException as error:
        kinds = [f"{kind.__module__}.{kind.__qualname__}" for kind in type(error).__mro__]
        place = next(
            (
                f"{frame.filename}:{frame.lineno}"
                for frame in reversed(traceback.extract_tb(error.__traceback__))
                if frame.filename != __file__ and not frame.filename.startswith("<")
            ),
            "",
        )
        return _line("raised", [kinds, _message(error), place, traceback.format_exc()])
    try:
        return _line("given", given)
    except Exception:
        return _line("fault", [f"gave {_shown(given)}, which is no answer", ""])


def _line(kind: str, value: object) -> bytes:
    return json.dumps([kind, value], allow_nan=False).encode("ascii") + b"\n"


def _in_words(error: BaseException) -> str:
    return f"{type(error).__name__}: {_message(error)}"


def _message(error: BaseException) -> str:
    try:
        return str(error)[:_LONGEST]
    except Exception:
        return ""


def _shown(value: object) -> str:
    try:
        return repr(value)[:_LONGEST]
    except Exception:
        return f"a {type(value).__name__}"
