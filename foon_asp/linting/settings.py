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
_TABLE = "tool.foon-asp.lint"
_PLACE = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
# a comment, a text on lines or on one line, or a bare key of TOML
_WORD = re.compile(r"""#[^\n]*|\"{3}.*?\"{3}|'{3}.*?'{3}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[\w-]+""", re.DOTALL)


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
        """Return the findings that are wanted, with the severities that are wanted."""
        return [
            finding._replace(severity=self.severity.get(finding.code, finding.severity))
            for finding in findings
            if finding.code in (self.select or CATALOG)
            and finding.code not in self.ignore
            and not self._is_ignored_in(finding.source.file, finding.code)
        ]

    def _is_ignored_in(self, file: str, code: str) -> bool:
        patterns = [pattern for pattern, codes in self.per_file.items() if code in codes]
        if not patterns or self.file is None:
            return False
        path = PurePosixPath(Path(os.path.relpath(file, self.file.parent)).as_posix())
        return any(_matches(path, pattern) for pattern in patterns)


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
    return _Reading(file).settings()


class _Reading:
    """A file of settings while it is read, and the errors in it."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.text = read_plain_text(file)
        self.errors: list[Diagnostic] = []
        self.codes: dict[str, tuple[str, ...]] = {"select": (), "ignore": ()}
        self.per_file: dict[str, tuple[str, ...]] = {}
        self.severity: dict[str, Severity] = {}

    def settings(self) -> LintSettings | None:
        document = self._document()
        if self.file.name == _FILES[0] and "lint" in document:
            self._wrong("lint", f"found the table [lint], expected [{_TABLE}]")
        table: object = document
        for key in _TABLE.split("."):
            table = table.get(key) if isinstance(table, dict) else None
        if isinstance(table, dict):
            for key, value in table.items():
                self._read(key, value)
        elif table is not None:
            self._wrong("lint", "expected a table of settings")
        if self.errors:
            raise InputError(sorted(self.errors, key=lambda error: error.source))
        if table is None:
            return None
        return LintSettings(**self.codes, per_file=self.per_file, severity=self.severity, file=self.file)

    def _document(self) -> dict[str, object]:
        try:
            return tomllib.loads(self.text)
        except tomllib.TOMLDecodeError as error:
            match = _PLACE.search(str(error))
            lines = split_lines(self.text)
            end = len(lines), len(lines[-1]) + 1
            place = (int(match[1]), int(match[2])) if match and match[1] else end
            self._error(f"the file is not TOML: {_PLACE.sub('', str(error))}", *place)
            raise InputError(self.errors) from None

    def _read(self, key: str, value: object) -> None:
        """Read one setting."""
        if key in self.codes:
            self.codes[key] = self._codes(value, key)
        elif key not in {"per-file", "severity"}:
            expected = ", ".join((*self.codes, "per-file", "severity"))
            self._wrong(key, f"found the setting {key!r}, expected one of {expected}")
        elif not isinstance(value, dict):
            self._wrong(key, f"expected a table [{_TABLE}.{key}]")
        elif key == "per-file":
            self.per_file = {pattern: self._codes(codes, key, pattern) for pattern, codes in value.items()}
        else:
            for code, severity in value.items():
                if code not in CATALOG:
                    self._wrong(key, code, unknown_code(code))
                elif severity in list(Severity):
                    self.severity[code] = Severity(str(severity))
                else:
                    expected = ", ".join(map(repr, map(str, Severity)))
                    self._wrong(key, code, f"found {severity!r}, expected one of {expected}")

    def _codes(self, value: object, *path: str) -> tuple[str, ...]:
        if not isinstance(value, list) or not all(isinstance(code, str) for code in value):
            self._wrong(*path, f'expected a list of codes such as {path[-1]} = ["near-name"]')
            return ()
        for code in value:
            if code not in CATALOG:
                self._wrong(*path, code, unknown_code(code))
        return tuple(value)

    def _wrong(self, *path_and_message: str) -> None:
        """Note an error about a key, or about a text in the list under it: the last but one of the words.

        Its place is where the words stand behind the name of the table, one after the other, and no comment.
        """
        *path, message = path_and_message
        words = [
            (match[0].strip("\"'"), match.start() + (match[0][0] in "\"'"))
            for match in _WORD.finditer(self.text)
            if match[0][0] != "#"
        ]
        names = [name for name, _ in words]
        _, *table = _TABLE.split(".")
        place = next((at for at in range(len(names)) if names[at : at + 2] == table), 0)
        for key in path:
            place = names.index(key, place) if key in names[place:] else place
        before = self.text[: words[place][1]].replace("\r\n", "\n")
        self._error(message, before.count("\n") + 1, len(before) - before.rfind("\n"))

    def _error(self, message: str, line: int, column: int) -> None:
        excerpt = split_lines(self.text)[line - 1]
        source = Source(str(self.file), line, column)
        self.errors.append(Diagnostic(Severity.ERROR, "settings", message, source, excerpt))
