"""Layout of JSON texts: four spaces for each level, as in published FOON files."""

import json
import re

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_list import json_fault

STEP = "    "
TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[\[\]{}:,]|[^\s\[\]{}:,"]+')
"""Strings, brackets and everything else that is no blank."""


def lay_out(text: str, level: int = 0) -> str:
    """Return a JSON text with one value a line; only the blanks between its tokens change.

    Strings and numbers stay as they are written. ``level`` is the depth at which the text will be nested: all
    lines but the first are indented by it. The text has to be JSON: see :func:`check_json`.
    """
    parts: list[str] = []
    previous = ""
    for token in TOKEN.findall(text):
        if token in {"]", "}"}:
            level -= 1
            if previous not in {"[", "{"}:
                parts.append("\n" + STEP * level)
        elif previous in {"[", "{", ","}:
            parts.append("\n" + STEP * level)
        parts.append(": " if token == ":" else token)
        level += token in {"[", "{"}
        previous = token
    return "".join(parts)


def on_one_line(text: str) -> str:
    """Return a JSON text on one line, with a blank behind each comma and colon.

    Strings and numbers stay as they are written.
    """
    return "".join(token + " " if token in {",", ":"} else token for token in TOKEN.findall(text))


def check_json(text: str, file: str) -> None:
    """Raise :class:`InputError` with the place of the first fault if a text is not JSON."""
    try:
        json.loads(text, parse_int=str, parse_float=str)
    except json.JSONDecodeError as error:
        fault = json_fault(error)
        line = text.split("\n")[fault.line - 1].rstrip("\r")
        message, source = fault.message, Source(file, fault.line, fault.column)
    except RecursionError:
        line, message, source = "", "found lists nested too deeply", Source(file, 1)
    else:
        return
    raise InputError([Diagnostic(Severity.ERROR, "json", message, source, line)])
