"""What changes in files, line by line, as ``patch`` and ``git apply -p0`` read it."""

import difflib
import re
from collections.abc import Iterator

_LINE = re.compile(r"[^\n]*\n|[^\n]+")


def line_diff(file: str, before: str, after: str) -> str:
    """Return a unified diff of the text of a file; empty where both are the same."""
    return "".join(_lines(file, _LINE.findall(before), _LINE.findall(after)))


def _lines(file: str, before: list[str], after: list[str]) -> Iterator[str]:
    for line in difflib.unified_diff(before, after, file, file):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
