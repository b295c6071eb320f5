"""A hundred findings of the linter on FOON files, drawn with a seed that was fixed before anybody looked.

Every path is linted by itself. The findings, by path, file, line, column and code, are drawn from without
regard to code or file. Each is printed with the lines around it, as a list for somebody who judges whether it
is right.

    python benchmarks/drawn_findings.py PATH ... > list.md
"""

import argparse
import random
from pathlib import Path

from foon_asp.linting.linted_files import with_tables
from foon_asp.linting.linter import lint
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.folder_files import foon_files

SEED = 20211021
DRAWN = 100
AROUND = 9  # lines before and behind


def drawn(paths: list[Path]) -> list[tuple[Path, Diagnostic]]:
    """Give the findings that are judged, in the order of the files."""
    found = [
        (path, finding)
        for path in paths
        for finding in lint(with_tables([path], (file for file, _ in foon_files([path]))))
    ]
    places = sorted(random.Random(SEED).sample(range(len(found)), min(DRAWN, len(found))))
    return [found[place] for place in places]


def shown(number: int, path: Path, finding: Diagnostic) -> str:
    """Write one finding and the lines around it."""
    source = finding.source
    lines = Path(source.file).read_text(encoding="utf-8-sig", errors="replace").splitlines()
    first, last = max(1, source.line - AROUND), min(len(lines), source.line + AROUND)
    around = [
        f"{'>' if at == source.line else ' '}{at:6} {lines[at - 1].replace(chr(9), '→')}"
        for at in range(first, last + 1)
    ]
    file = Path(source.file).relative_to(path.parent) if path.is_dir() else Path(source.file).name
    severity = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "note"}[finding.severity]
    head = f"## {number}. {file}:{source.line}:{source.column}: {severity} [{finding.code}]"
    return "\n".join([head, "", finding.message, "", "```", *around, "```", ""])


def main() -> None:
    """Draw and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0] if __doc__ else None)
    parser.add_argument("paths", nargs="+", type=Path)
    for number, (path, finding) in enumerate(drawn(parser.parse_args().paths), 1):
        print(shown(number, path, finding))


if __name__ == "__main__":
    main()
