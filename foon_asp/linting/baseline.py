"""Baselines: files of known findings, which lint does not report again even if their line has moved."""

import os
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from msgspec import Struct, ValidationError, convert

from foon_asp.errors import UserError
from foon_asp.json_layout import read_json, schema_name
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.plain_file import read_content


class KnownFinding(Struct, frozen=True):
    """A finding that a baseline lists, and how many times it occurs.

    ``file`` is the path relative to the folder of the baseline. ``text`` is the text of the line, or the
    message of a finding without a line. The number of the line is not compared.
    """

    file: str
    code: str
    text: str
    count: int


class Baseline(Struct, frozen=True, tag_field="schema", tag=schema_name("lint-baseline")):
    """The findings that are known, as the contents of a baseline file."""

    known: tuple[KnownFinding, ...]

    @classmethod
    def of(cls, file: Path, findings: Iterable[Diagnostic]) -> "Baseline":
        """Return a baseline of all these findings.

        ``file`` is the baseline file to be written; paths of findings become relative to its folder.
        """
        counts = Counter(_finding_key(file, finding) for finding in findings)
        return cls(tuple(KnownFinding(*key, count) for key, count in sorted(counts.items())))

    def compare_with(self, file: Path, findings: Iterable[Diagnostic]) -> tuple[list[Diagnostic], int]:
        """Return the findings that are not in the baseline, and how many in the baseline no longer occur.

        ``file`` is the file of the baseline. A text may have more findings of one code than the baseline
        lists. Then the last findings of the text are returned as new.
        """
        remaining = Counter[tuple[str, str, str]]()
        for known_finding in self.known:
            remaining[known_finding.file, known_finding.code, known_finding.text] += known_finding.count
        new = []
        for finding in findings:
            key = _finding_key(file, finding)
            if remaining[key] > 0:
                remaining[key] -= 1
            else:
                new.append(finding)
        return new, remaining.total()


def read_baseline(file: Path) -> Baseline:
    """Read a baseline from its file.

    Raises :class:`UserError` if the file does not exist or is no baseline.
    """
    expected = f"expected a baseline; foon-asp lint --baseline {file} --write-baseline FILE|DIR... writes one"
    if not file.exists():
        raise UserError(f"{file}: there is no such file, {expected}")
    try:
        return convert(read_json(read_content(file)), Baseline)
    except (ValueError, ValidationError):
        raise UserError(f"{file}: {expected}") from None


def check_replaceable(file: Path) -> None:
    """Raise :class:`UserError` for a file that is neither empty nor a baseline.

    A folder, or a file that does not exist, raises no error.
    """
    if file.is_file() and read_content(file):
        try:
            read_baseline(file)
        except UserError:
            raise UserError(
                f"{file}: is no baseline, and is not replaced by one; name another file, or remove it first"
            ) from None


def _finding_key(file: Path, finding: Diagnostic) -> tuple[str, str, str]:
    """Return the relative path, the code and the text by which a :class:`KnownFinding` is recognised."""
    relative_path = Path(os.path.relpath(finding.source.file, file.parent)).as_posix()
    return relative_path, finding.code, finding.excerpt or finding.message
