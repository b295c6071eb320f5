"""What a project wants of linting: ``[tool.foon-asp.lint]`` in ``foon-asp.toml`` or ``pyproject.toml``."""

import os
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from foon_asp.linting.catalog import CATALOG, unknown_code
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import read_plain_text, split_lines

_FILES = ("foon-asp.toml", "pyproject.toml")
_TABLE = ("tool", "foon-asp", "lint")
_KEYS = ("select", "ignore", "per-file", "severity")
_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")


@dataclass(frozen=True)
class LintSettings:
    """Which findings are reported, and how bad they are.

    ``select`` are the codes that are looked for, all if there are none; ``ignore`` those that are left out,
    and ``per_file`` those that are left out in files under ``folder`` whose path matches a pattern.
    ``severity`` replaces that of the catalog. ``file`` is where they stand, ``None`` if nowhere.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    per_file: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    severity: Mapping[str, Severity] = field(default_factory=dict)
    file: Path | None = None

    def applied(self, findings: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Give the findings that are wanted, with the severities that are wanted."""
        wanted = {code for code in self.select or CATALOG if code not in self.ignore}
        left_out: dict[str, set[str]] = {}
        kept = []
        for finding in findings:
            file, code = finding.source.file, finding.code
            if file not in left_out:
                left_out[file] = self._left_out(file)
            if code in wanted and code not in left_out[file]:
                kept.append(finding._replace(severity=self.severity.get(code, finding.severity)))
        return kept

    def _left_out(self, file: str) -> set[str]:
        if self.file is None:
            return set()
        path = PurePosixPath(Path(os.path.relpath(file, self.file.parent)).as_posix())
        return {code for pattern, codes in self.per_file.items() if _matches(path, pattern) for code in codes}


def _matches(path: PurePosixPath, pattern: str) -> bool:
    """Whether a path, or a folder that it is in, matches: ``old``, ``old/*.txt``, ``*.json``."""
    return any(part.match(pattern) for part in (path, *path.parents))


def find_settings(files: Sequence[Path]) -> LintSettings:
    """Read the settings nearest to the files, in the folder that holds them all or in one above it.

    Raises :class:`InputError`, with the place, for settings that are not understood.
    """
    folders = [os.path.dirname(os.path.abspath(file)) for file in files]
    try:
        start = Path(os.path.commonpath(folders))
    except ValueError:  # on several drives, or no files
        return LintSettings()
    for folder in (start, *start.parents):
        for name in _FILES:
            file = folder / name
            if file.is_file():
                here = file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file
                if settings := read_settings(here):
                    return settings
    return LintSettings()


def read_settings(file: Path) -> LintSettings | None:
    """Read the settings of a file; ``None`` if it has none.

    Raises :class:`InputError` with line and column of everything that is not understood.
    """
    return _Table(file).settings()


class _Table:
    """A file of settings, and the places of what is wrong in it."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.text = read_plain_text(file)
        self.errors: list[Diagnostic] = []
        try:
            self.document = tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            match = _PLACE.search(str(error))
            lines = split_lines(self.text)
            line, column = (
                (int(match[1]), int(match[2])) if match and match[1] else (len(lines), len(lines[-1]) + 1)
            )
            self._error(f"the file is not TOML: {_PLACE.sub('', str(error))}", line, column)
            raise InputError(self.errors) from None

    def settings(self) -> LintSettings | None:
        if self.file.name == _FILES[0] and "lint" in self.document:
            self._wrong(("lint",), f"found the table [lint], expected [{'.'.join(_TABLE)}]")
        table = self._at(_TABLE)
        if isinstance(table, dict):
            for key in table.keys() - set(_KEYS):
                self._wrong((*_TABLE, key), f"found the setting {key!r}, expected one of {', '.join(_KEYS)}")
            select, ignore = (self._codes((*_TABLE, key), table.get(key, [])) for key in _KEYS[:2])
            per_file = {
                pattern: self._codes((*_TABLE, "per-file", pattern), codes)
                for pattern, codes in self._table("per-file", table).items()
            }
            severity = self._severities(self._table("severity", table))
        elif table is not None:
            self._wrong(_TABLE, "expected a table of settings")
        if self.errors:
            raise InputError(sorted(self.errors, key=lambda error: error.source))
        if table is None:
            return None
        return LintSettings(select, ignore, per_file, severity, self.file)

    def _table(self, key: str, table: dict[str, object]) -> dict[str, object]:
        value = table.get(key, {})
        if isinstance(value, dict):
            return value
        self._wrong((*_TABLE, key), f"expected a table [{'.'.join((*_TABLE, key))}]")
        return {}

    def _codes(self, path: tuple[str, ...], value: object) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(code, str) for code in value):
            self._wrong(path, f'expected a list of codes such as {path[-1]} = ["near-name"]')
            return ()
        for code in value:
            if code not in CATALOG:
                self._wrong(path, unknown_code(code), code)
        return tuple(value)

    def _severities(self, table: dict[str, object]) -> dict[str, Severity]:
        found = {}
        for code, value in table.items():
            path = (*_TABLE, "severity", code)
            if code not in CATALOG:
                self._wrong(path, unknown_code(code))
            elif value in list(Severity):
                found[code] = Severity(str(value))
            else:
                self._wrong(
                    path, f"found {value!r}, expected one of {', '.join(map(repr, map(str, Severity)))}"
                )
        return found

    def _wrong(self, path: tuple[str, ...], message: str, value: str = "") -> None:
        """Note what is wrong about a key, or about a text in the list that it has."""
        start = self._place(path, path[-1], 0)
        if value:
            start = self._place(path, value, start)
        before = self.text[:start].replace("\r\n", "\n")
        self._error(message, before.count("\n") + 1, len(before) - before.rfind("\n"))

    def _place(self, path: tuple[str, ...], word: str, start: int) -> int:
        """Give where a key or text stands: there, another word would make what stands under ``path`` another.

        So the places are those of TOML itself, whatever it is that stands in comments or in other tables.
        """
        value = self._at(path)
        for match in re.finditer(re.escape(word), self.text[start:]):
            place = start + match.start()
            changed = f"{self.text[:place]}{'x' * (len(word) + 1)}{self.text[start + match.end() :]}"
            try:
                if self._at(path, tomllib.loads(changed)) != value:
                    return place
            except tomllib.TOMLDecodeError:
                continue
        return start

    def _at(self, path: Iterable[str], document: object = None) -> object:
        found: object = self.document if document is None else document
        for key in path:
            found = found.get(key) if isinstance(found, dict) else None
        return found

    def _error(self, message: str, line: int, column: int) -> None:
        excerpt = split_lines(self.text)[line - 1]
        source = Source(str(self.file), line, column)
        self.errors.append(Diagnostic(Severity.ERROR, "settings", message, source, excerpt))
