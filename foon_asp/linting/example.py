"""Examples of lint rules: small files with the slip that the rule finds."""

from pathlib import Path
from typing import NamedTuple

from foon_asp.linting.finding import Finding
from foon_asp.linting.linter import lint

_EXAMPLES = Path(__file__).parent / "examples"


class Example(NamedTuple):
    """The example of a rule: the bytes of its files by name, and the findings of the rule in these files."""

    files: dict[Path, bytes]
    findings: list[Finding]


def read_example(code: str) -> Example:
    """Read the example files of the rule with a code, and lint them."""
    files = {Path(file.name): file.read_bytes() for file in sorted((_EXAMPLES / code).iterdir())}
    return Example(files, [Finding.of(finding) for finding in lint(files, files) if finding.code == code])
