"""JSON texts and plain values, and the names of what we write, with the version in them."""

import json
from collections.abc import Callable, Iterator
from typing import Any

Json = dict[str, Any]
"""An object as plain values, in the order in which JSON has them."""

_OURS = "foon-asp/"
_WIDTH = 110  # of a line of a text
_VERSION = 1  # of all that is written; what changes the meaning of a key, or takes one away, is another


def schema_name(kind: str) -> str:
    """Give the name of a kind of JSON, ``foon-asp/answer/1``; ``foon-asp schema`` says what is in it."""
    return f"{_OURS}{kind}/{_VERSION}"


def is_other_version(found: object, name: str) -> bool:
    """Whether this names something that we write, and not what ``name`` says."""
    return isinstance(found, str) and found.startswith(_OURS) and found != name


def json_text(value: object) -> str:
    """Write plain values as a JSON text of their own; a list or an object that fits stands on one line."""
    return "".join(_laid_out(value, "", 0)) + "\n"


def _laid_out(value: object, margin: str, before: int) -> Iterator[str]:
    """Give a value piece by piece; so many letters of its line stand before it."""
    line = json_line(value)
    if not isinstance(value, dict | list | tuple) or before + len(line) <= _WIDTH:
        yield line
        return
    named = isinstance(value, dict)
    between, inner = "{" if named else "[", f"\n{margin}  "
    for key, part in value.items() if isinstance(value, dict) else (("", part) for part in value):
        start = f"{json_line(str(key))}: " if named else ""
        yield f"{between}{inner}{start}"
        yield from _laid_out(part, f"{margin}  ", len(inner) + len(start))
        between = ","
    yield f"\n{margin}{'}' if named else ']'}"


def json_line(value: object, default: Callable[[Any], object] | None = None) -> str:
    """Write plain values as JSON on one line; ``default`` makes plain what is not."""
    line = json.dumps(value, ensure_ascii=False, default=default)
    try:
        line.encode()
    except UnicodeEncodeError:  # half a character, as in the name of a file that is no UTF-8
        return json.dumps(value, default=default)
    return line


def read_json(text: str | bytes, pairs: Callable[[list[tuple[str, Any]]], object] | None = None) -> Any:
    """Parse a JSON text; ``pairs`` makes the objects, as ``json.loads`` has it.

    Raises :class:`ValueError` for whatever is wrong with it: also for what is nested deeper than Python can
    read, and for a number with more digits than Python turns into one.
    """
    try:
        return json.loads(text, object_pairs_hook=pairs)
    except RecursionError:
        raise ValueError("found lists within lists without end") from None
