"""Names in the one-line notation of object nodes: in quotes if they would be misread without.

A name in quotes is a string of JSON. ``docs/formats.md`` describes the notation.
"""

import json
import re
from json.encoder import encode_basestring_ascii
from typing import Final

from foon_asp.escapes import UNSAFE

_ANYWHERE = rf'\A["\s]|\s\Z|\A\Z|[;\[\]{{}}\t\n]|{UNSAFE.pattern}'
NAME: Final = re.compile(_ANYWHERE)
"""Matches names that need quotes: empty, with blanks around them, or with special letters."""
LISTED: Final = re.compile(rf"{_ANYWHERE}|,")
"""Matches names that need quotes in brackets, where a comma separates names."""
FIRST: Final = re.compile(rf"{_ANYWHERE}|\A[#@]|\A::")
"""Matches first names of a notation that need quotes: in files, ``#`` begins a comment, ``@`` a word."""
_ESCAPED = re.compile(rf'["\\\t\n]|{UNSAFE.pattern}')


def quoted(name: str, special: re.Pattern[str] = NAME) -> str:
    """Return a name as the one-line notation has it: in quotes if the pattern ``special`` is found in it."""
    return in_quotes(name) if special.search(name) else name


def in_quotes(name: str) -> str:
    """Return a name as a JSON string in quotes; characters that are unsafe in a terminal are escaped."""
    return '"' + _ESCAPED.sub(lambda letter: encode_basestring_ascii(letter[0])[1:-1], name) + '"'


def unquoted(written: str) -> str:
    """Return the name that a text of the notation stands for.

    Blanks around the text are removed. A text in quotes is read as a JSON string. Raises ``ValueError`` if
    it is not valid JSON.
    """
    written = written.strip(" ")
    return str(json.loads(written, strict=False)) if written.startswith('"') else written
