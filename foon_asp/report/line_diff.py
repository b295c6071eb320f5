"""Unified diffs of files, for ``patch`` and ``git apply -p0``."""

import difflib
import re
from collections.abc import Iterator

_LINE_AND_END = re.compile(r"[^\n]*\n|[^\n]+")


def line_diff(file: str, before: str, after: str) -> str:
    """Return a unified diff of the text of a file before and after a change; empty if both are equal."""
    return "".join(_diff_lines(file, _LINE_AND_END.findall(before), _LINE_AND_END.findall(after)))


def _diff_lines(file: str, before: list[str], after: list[str]) -> Iterator[str]:
    """Yield the lines of a unified diff; a line without an end is marked as ``diff`` does."""
    for line in difflib.unified_diff(before, after, file, file):
        yield line if line.endswith("\n") else f"{line}\n\\ No newline at end of file\n"
