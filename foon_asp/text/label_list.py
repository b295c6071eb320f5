"""Lists of object labels, one on each line: ``utensils.txt``."""

import re
from pathlib import Path

from foon_asp.text.plain_file import read_plain_text


def read_labels(file: Path) -> frozenset[str]:
    """Read one label per line; blank lines and ``#`` comments are passed over."""
    lines = (line.strip() for line in re.split("[\r\n]", read_plain_text(file)))
    return frozenset(line for line in lines if line and not line.startswith("#"))
