"""Findings that are known: they are not reported again, wherever in its file their line stands by now."""

import os
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from foon_asp.errors import UserError
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.json_value import Json, read_json, schema_name
from foon_asp.text.plain_file import read_content

_KIND = "lint-baseline"
_Key = tuple[str, str, str]  # file as seen from the baseline, code, and the line or, without one, the message


class Baseline:
    """The known findings, as often as each is known."""

    def __init__(self, file: Path, known: Counter[_Key]) -> None:
        self._file, self._known = file, known

    def new(self, findings: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Give the findings that are not known; where a line has more of a code than known, the last ones."""
        left = self._known.copy()
        new = []
        for finding in findings:
            key = _key(self._file, finding)
            if left[key]:
                left[key] -= 1
            else:
                new.append(finding)
        return new

    def gone(self, findings: Iterable[Diagnostic]) -> int:
        """Count what is known and not found any more."""
        return (self._known - Counter(_key(self._file, finding) for finding in findings)).total()


def read_baseline(file: Path) -> Baseline:
    """Read a baseline; raises :class:`UserError` for another file."""
    expected = f"expected a baseline; foon-asp lint --baseline {file} --write-baseline FILE|DIR... writes one"
    if not file.exists():
        raise UserError(f"{file}: there is no such file, {expected}")
    try:
        read: Any = read_json(read_content(file))
        if read["schema"] != schema_name(_KIND):
            raise ValueError
        known: Counter[_Key] = Counter()
        for entry in read["known"]:
            name, code, text, count = (entry[key] for key in ("file", "code", "text", "count"))
            if not (isinstance(count, int) and all(isinstance(each, str) for each in (name, code, text))):
                raise ValueError
            known[name, code, text] += count
    except (ValueError, LookupError, TypeError):
        raise UserError(f"{file}: {expected}") from None
    return Baseline(file, known)


def check_replaceable(file: Path) -> None:
    """Raise :class:`UserError` where a baseline would replace neither an empty file nor a baseline."""
    if file.is_file() and read_content(file):
        try:
            read_baseline(file)
        except UserError:
            raise UserError(
                f"{file}: is no baseline, and is not replaced by one; name another file, or remove it first"
            ) from None


def baseline_json(file: Path, findings: Sequence[Diagnostic]) -> Json:
    """Give what to write into a baseline file, so that these findings are known."""
    counts = Counter(_key(file, finding) for finding in findings)
    keys = ("file", "code", "text", "count")
    known = [dict(zip(keys, (*key, n), strict=True)) for key, n in sorted(counts.items())]
    return {"schema": schema_name(_KIND), "known": known}


def _key(file: Path, finding: Diagnostic) -> _Key:
    within = Path(os.path.relpath(finding.source.file, file.parent)).as_posix()
    return within, finding.code, finding.excerpt or finding.message
