"""The example of each rule: files with the slip that it finds."""

from pathlib import Path
from typing import NamedTuple

from foon_asp.linting.finding import Finding
from foon_asp.linting.linter import lint

_EXAMPLES = Path(__file__).parent / "examples"


class Example(NamedTuple):
    """Example files of a rule: their contents by name, and the findings of the rule in them."""

    files: dict[Path, bytes]
    findings: list[Finding]


def example(code: str) -> Example:
    """Return the example of the rule of a code."""
    files = {Path(file.name): file.read_bytes() for file in sorted((_EXAMPLES / code).iterdir())}
    return Example(files, [Finding.of(finding) for finding in lint(files, files) if finding.code == code])
