"""The settings of linting: ``[tool.foon-asp.lint]`` in ``foon-asp.toml`` or ``pyproject.toml``."""

import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from foon_asp.linting.catalog import CATALOG, unknown_code
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import read_plain_text, split_lines

_FILES = ("foon-asp.toml", "pyproject.toml")
_TABLE = "tool.foon-asp.lint"
_ERROR_POSITION = re.compile(r" \(at (?:line (\d+), column (\d+)|end of document)\)$")
# a comment, a text on lines or on one line, or a bare key of TOML
_WORD = re.compile(r"""#[^\n]*|\"{3}.*?\"{3}|'{3}.*?'{3}|"(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[\w-]+""", re.DOTALL)


@dataclass(frozen=True)
class LintSettings:
    """The settings of linting: the findings that are reported, and their severities.

    ``select`` are the codes that are reported, empty for all codes; ``ignore`` are the codes that are left
    out. ``per_file`` has codes that are left out in files under ``folder`` whose path matches a pattern.
    ``severity`` has severities by code that replace those of the catalog. ``file`` is the file of the
    settings, ``None`` for the defaults.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    per_file: Mapping[str, Sequence[str]] = field(default_factory=dict)
    severity: Mapping[str, Severity] = field(default_factory=dict)
    file: Path | None = None

    def applied(self, findings: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Return the findings that these settings report, with their severities."""
        return [
            finding._replace(severity=self.severity.get(finding.code, finding.severity))
            for finding in findings
            if finding.code in (self.select or CATALOG)
            and finding.code not in self.ignore
            and not self._is_ignored_in(finding.source.file, finding.code)
        ]

    def _is_ignored_in(self, file: str, code: str) -> bool:
        """Whether a pattern for single files ignores a code in this file."""
        patterns = [pattern for pattern, codes in self.per_file.items() if code in codes]
        if not patterns or self.file is None:
            return False
        path = PurePosixPath(Path(os.path.relpath(file, self.file.parent)).as_posix())
        return any(_matches(path, pattern) for pattern in patterns)


def _matches(path: PurePosixPath, pattern: str) -> bool:
    """Whether a path, or a folder that it is in, matches: ``old``, ``old/*.txt``, ``*.json``."""
    return any(candidate.match(pattern) for candidate in (path, *path.parents))


def find_settings(files: Sequence[Path]) -> LintSettings:
    """Read the settings nearest to the files: in the common folder of all files, or in one above it.

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
                shown_path = file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file
                if settings := read_settings(shown_path):
                    return settings
    return LintSettings()


def read_settings(file: Path) -> LintSettings | None:
    """Read the settings of a file; ``None`` if it has none.

    Raises :class:`InputError` with line and column of everything that is not understood.
    """
    text = read_plain_text(file)
    try:
        table: object = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        match = _ERROR_POSITION.search(str(error))
        position = (int(match[1]), int(match[2])) if match and match[1] else _line_and_column(text, len(text))
        message = f"the file is not TOML: {_ERROR_POSITION.sub('', str(error))}"
        raise InputError([_error(file, text, position, message)]) from None
    faults: list[_Fault] = []
    if file.name == _FILES[0] and isinstance(table, dict) and "lint" in table:
        faults.append((("lint",), f"found the table [lint], expected [{_TABLE}]"))
    for key in _TABLE.split("."):
        table = table.get(key) if isinstance(table, dict) else None
    faults += [] if table is None else _faults(table)
    if faults:
        errors = [_error(file, text, _position(text, path), message) for path, message in faults]
        raise InputError(sorted(errors, key=lambda error: error.source))
    if not isinstance(table, dict):
        return None
    select, ignore = (tuple(table.get(key, ())) for key in ("select", "ignore"))
    severity = {code: Severity(value) for code, value in table.get("severity", {}).items()}
    return LintSettings(select, ignore, table.get("per-file", {}), severity, file)


_Fault = tuple[tuple[str, ...], str]  # the keys that lead to the fault, and the message


def _faults(table: object) -> Iterator[_Fault]:
    """Yield the faults of the table of settings."""
    if not isinstance(table, dict):
        yield ("lint",), "expected a table of settings"
        return
    for key, value in table.items():
        if key in {"select", "ignore"}:
            yield from _faults_of_codes((key,), value)
        elif key not in {"per-file", "severity"}:
            expected = "select, ignore, per-file, severity"
            yield (key,), f"found the setting {key!r}, expected one of {expected}"
        elif not isinstance(value, dict):
            yield (key,), f"expected a table [{_TABLE}.{key}]"
        else:
            for name, setting in value.items():
                if key == "per-file":
                    yield from _faults_of_codes((key, name), setting)
                elif name not in CATALOG:
                    yield (key, name), unknown_code(name)
                elif setting not in list(Severity):
                    expected = ", ".join(repr(str(severity)) for severity in Severity)
                    yield (key, name), f"found {setting!r}, expected one of {expected}"


def _faults_of_codes(path: tuple[str, ...], value: object) -> Iterator[_Fault]:
    """Yield the faults of a list of codes of rules in the settings."""
    if not isinstance(value, list) or not all(isinstance(code, str) for code in value):
        yield path, f'expected a list of codes such as {path[-1]} = ["near-name"]'
        return
    for code in value:
        if code not in CATALOG:
            yield (*path, code), unknown_code(code)


def _position(text: str, path: tuple[str, ...]) -> tuple[int, int]:
    """Return the line and column of the last word of a path of keys, which begins below the table."""
    matches = [match for match in _WORD.finditer(text) if match[0][0] != "#"]
    words = [match[0].strip("\"'") for match in matches]
    table = _TABLE.split(".")[1:]
    index = next((index for index in range(len(words)) if words[index : index + 2] == table), 0)
    for word in path:
        index = words.index(word, index) if word in words[index:] else index
    return _line_and_column(text, matches[index].start() + (matches[index][0][0] in "\"'"))


def _line_and_column(text: str, offset: int) -> tuple[int, int]:
    before = text[:offset].replace("\r\n", "\n")
    return before.count("\n") + 1, len(before) - before.rfind("\n")


def _error(file: Path, text: str, position: tuple[int, int], message: str) -> Diagnostic:
    excerpt = split_lines(text)[position[0] - 1]
    return Diagnostic(Severity.ERROR, "settings", message, Source(str(file), *position), excerpt)
