"""Where a text stops being JSON and why, the same under every Python."""

import json
import re
from typing import NamedTuple

_COMMA_BEFORE_END = re.compile(r",[ \t\r\n]*([\]}])")
_BLANKS = " \t\r\n"


class JsonFault(NamedTuple):
    """What is wrong, at which offset of the text, and which line and column that is, counted from 1."""

    message: str
    offset: int
    line: int
    column: int


def json_fault(error: json.JSONDecodeError) -> JsonFault:
    """Say in our words what the standard library found.

    A comma before the end of a list or an object is where the Pythons differ: some name the comma, some
    what stands behind it. Here it is the comma.
    """
    text, offset, message = error.doc, error.pos, error.msg
    start = offset
    if text[offset : offset + 1] in {"]", "}"}:
        start = len(text[:offset].rstrip(_BLANKS)) - 1
    comma = _COMMA_BEFORE_END.match(text, start) if start >= 0 else None
    if comma:
        offset, message = start, f"found a comma before {comma[1]}, expected none"
    line = text.count("\n", 0, offset) + 1
    return JsonFault(f"not JSON: {message}", offset, line, offset - text.rfind("\n", 0, offset))
