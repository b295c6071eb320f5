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
"""All formats, in the order in which they are tried on a file."""


def format_of(text: str, file: str = "") -> Format:
    """Return the first format that recognises a text, by its beginning or by the name of its ``file``."""
    return next(format_ for format_ in FORMATS if format_.recognises(text, file))


def format_with(dialect: Dialect) -> Format:
    """Return the format that has a dialect."""
    return next(format_ for format_ in FORMATS if dialect in format_.dialects)
