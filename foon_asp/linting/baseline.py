"""Baselines: known findings, which are not reported again even if their line has moved in its file."""

import os
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from msgspec import Struct, ValidationError, convert

from foon_asp.errors import UserError
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.json_value import read_json, schema_name
from foon_asp.text.plain_file import read_content


class KnownFinding(Struct, frozen=True):
    """A finding in a baseline, and how often it is known.

    ``file`` is relative to the folder of the baseline. ``text`` is the line, or the message of a finding
    without a line: line numbers do not count.
    """

    file: str
    code: str
    text: str
    count: int


class Baseline(Struct, frozen=True, tag_field="schema", tag=schema_name("lint-baseline")):
    """The findings that are known."""

    known: tuple[KnownFinding, ...]

    @classmethod
    def of(cls, file: Path, findings: Iterable[Diagnostic]) -> "Baseline":
        """Return the baseline of the findings, to be written to a file."""
        counts = Counter(_key(file, finding) for finding in findings)
        return cls(tuple(KnownFinding(*key, count) for key, count in sorted(counts.items())))

    def compared(self, file: Path, findings: Iterable[Diagnostic]) -> tuple[list[Diagnostic], int]:
        """Return the new findings, and the number of findings in the baseline that no longer occur.

        ``file`` is the file of the baseline. If a line has more findings of a code than the baseline lists,
        the last of them are new.
        """
        remaining = Counter[tuple[str, str, str]]()
        for known_finding in self.known:
            remaining[known_finding.file, known_finding.code, known_finding.text] += known_finding.count
        new = []
        for finding in findings:
            key = _key(file, finding)
            if remaining[key] > 0:
                remaining[key] -= 1
            else:
                new.append(finding)
        return new, remaining.total()


def read_baseline(file: Path) -> Baseline:
    """Read a baseline; raises :class:`UserError` for another file."""
    expected = f"expected a baseline; foon-asp lint --baseline {file} --write-baseline FILE|DIR... writes one"
    if not file.exists():
        raise UserError(f"{file}: there is no such file, {expected}")
    try:
        return convert(read_json(read_content(file)), Baseline)
    except (ValueError, ValidationError):
        raise UserError(f"{file}: {expected}") from None


def check_replaceable(file: Path) -> None:
    """Raise :class:`UserError` if a file is neither empty nor a baseline."""
    if file.is_file() and read_content(file):
        try:
            read_baseline(file)
        except UserError:
            raise UserError(
                f"{file}: is no baseline, and is not replaced by one; name another file, or remove it first"
            ) from None


def _key(file: Path, finding: Diagnostic) -> tuple[str, str, str]:
    relative_path = Path(os.path.relpath(finding.source.file, file.parent)).as_posix()
    return relative_path, finding.code, finding.excerpt or finding.message
