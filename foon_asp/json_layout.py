"""Writing and reading of JSON, and the schema names of foon-asp with their versions."""

import json
import re
from collections.abc import Callable
from typing import Any

Json = dict[str, Any]
"""An object as plain values, in the order in which JSON has them."""

_encode = json.JSONEncoder(ensure_ascii=False).encode
_FOLDER = re.compile(r'"/[^"]*/')  # of a file; its folder does not affect line breaks
_VERSIONS = {"verify": 2}  # 1 for all others; changing or removing a key needs a new version


def schema_name(kind: str) -> str:
    """Return the schema name of a kind of document: ``foon-asp/answer/1`` for ``answer``.

    The command ``foon-asp schema`` prints the schema.
    """
    return f"foon-asp/{kind}/{_VERSIONS.get(kind, 1)}"


def json_text(value: object) -> str:
    """Return plain values as JSON with indents and a line end.

    A list or an object that fits into about 95 letters stands on one line. Of an absolute path, only the last
    part counts for this width, so that line breaks do not depend on folders.
    """
    return _laid_out(value, "\n") + "\n"


def _laid_out(value: object, newline: str) -> str:
    """Return a value as JSON, on one line if it has at most about 95 letters.

    Otherwise each element has its own line. ``newline`` is a line feed and the indent of the value.
    """
    inner = f"{newline}  "
    if isinstance(value, dict):
        opening, closing = "{}"
        items = [f"{json_line(str(key))}: {_laid_out(item, inner)}" for key, item in value.items()]
    elif isinstance(value, list | tuple):
        opening, closing = "[]"
        items = [_laid_out(item, inner) for item in value]
    else:
        return json_line(value)
    line = f"{opening}{', '.join(items)}{closing}"
    if "\n" not in line and len(newline) + len(_FOLDER.sub('"', line)) <= 95:  # without the key before it
        return line
    return f"{opening}{inner}{f',{inner}'.join(items)}{newline}{closing}"


def json_line(value: object, default: Callable[[Any], object] | None = None) -> str:
    """Return plain values as JSON on one line; ``default`` converts values of types that JSON has not.

    If the text has half a character, which UTF-8 cannot hold, all letters beyond ASCII are escaped.
    """
    line = _encode(value) if default is None else json.dumps(value, ensure_ascii=False, default=default)
    try:
        line.encode()
    except UnicodeEncodeError:  # half a character, as in the name of a file that is no UTF-8
        return json.dumps(value, default=default)
    return line


def read_json(text: str | bytes, pairs: Callable[[list[tuple[str, Any]]], object] | None = None) -> Any:
    """Return the value of a JSON text.

    ``pairs`` is a function that makes each object from its pairs of key and value; ``None`` for plain
    dictionaries. Raises :class:`ValueError` for any fault. This includes lists nested too deeply and numbers
    too long for Python.
    """
    try:
        return json.loads(text, object_pairs_hook=pairs)
    except RecursionError:
        raise ValueError("found lists nested too deeply") from None
