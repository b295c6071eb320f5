"""All formats of files."""

from typing import Final

from foon_asp.text.foon_json import FoonJson
from foon_asp.text.foon_text import FoonText
from foon_asp.text.format import Dialect, Format
from foon_asp.text.neutral_lines import NeutralLines
from foon_asp.text.side_table import SideTable

NEUTRAL: Final = NeutralLines()
JSON: Final = FoonJson()
TEXT: Final = FoonText()
FORMATS: Final[tuple[Format, ...]] = (SideTable(), NEUTRAL, JSON, TEXT)
"""In the order in which they are asked whether a file is theirs."""


def format_of(text: str, file: str = "") -> Format:
    """Return the format of a text: the first that recognises it, by its beginning or the name of its file."""
    return next(each for each in FORMATS if each.recognises(text, file))


def format_with(dialect: Dialect) -> Format:
    """Return the format that has a dialect."""
    return next(each for each in FORMATS if dialect in each.dialects)
