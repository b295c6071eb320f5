"""The settings of linting: ``[tool.foon-asp.lint]`` in ``foon-asp.toml`` or ``pyproject.toml``."""

import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from foon_asp.linting.catalog import CATALOG, unknown_code_message
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
    """The settings of linting: which findings are reported, and with which severities.

    ``select``: the codes that are reported; empty for all codes.
    ``ignore``: the codes that are not reported.
    ``per_file``: by pattern of paths, further codes that are not reported in these files; paths are relative
    to the folder of ``file``.
    ``severity``: by code, the severity that replaces that of the rule.
    ``file``: the file that the settings are from; ``None`` for the defaults.
    """

    select: tuple[str, ...] = ()
    ignore: tuple[str, ...] = ()
    per_file: Mapping[str, Sequence[str]] = field(default_factory=dict)
    severity: Mapping[str, Severity] = field(default_factory=dict)
    file: Path | None = None

    def apply(self, findings: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Return the findings that these settings report, with the severities that they set."""
        return [
            finding._replace(severity=self.severity.get(finding.code, finding.severity))
            for finding in findings
            if finding.code in (self.select or CATALOG)
            and finding.code not in self.ignore
            and not self._is_ignored_in(finding.source.file, finding.code)
        ]

    def _is_ignored_in(self, file: str, code: str) -> bool:
        """Whether ``per_file`` ignores a code in this file."""
        patterns = [pattern for pattern, codes in self.per_file.items() if code in codes]
        if not patterns or self.file is None:
            return False
        path = PurePosixPath(Path(os.path.relpath(file, self.file.parent)).as_posix())
        return any(_path_matches(path, pattern) for pattern in patterns)


def _path_matches(path: PurePosixPath, pattern: str) -> bool:
    """Whether a pattern such as ``old``, ``old/*.txt`` or ``*.json`` matches a path or one of its folders."""
    return any(candidate.match(pattern) for candidate in (path, *path.parents))


def find_settings(files: Sequence[Path]) -> LintSettings:
    """Read the nearest settings: those in the common folder of all files, or in the nearest folder above.

    In a folder, ``foon-asp.toml`` comes before ``pyproject.toml``. Return the defaults if no folder has
    settings, or if the files have no common folder. Raises :class:`InputError`, with line and column, for
    settings that are not understood.
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
    """Read the settings in a TOML file; ``None`` if it has no table for them.

    Raises :class:`InputError` with line and column of everything that is not understood. In
    ``foon-asp.toml``, a table ``[lint]`` is such an error.
    """
    text = read_plain_text(file)
    try:
        table: object = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        match = _ERROR_POSITION.search(str(error))
        position = (int(match[1]), int(match[2])) if match and match[1] else _line_and_column(text, len(text))
        message = f"the file is not TOML: {_ERROR_POSITION.sub('', str(error))}"
        raise InputError([_settings_error(file, text, position, message)]) from None
    faults: list[_Fault] = []
    if file.name == _FILES[0] and isinstance(table, dict) and "lint" in table:
        faults.append((("lint",), f"found the table [lint], expected [{_TABLE}]"))
    for key in _TABLE.split("."):
        table = table.get(key) if isinstance(table, dict) else None
    faults += [] if table is None else _table_faults(table)
    if faults:
        errors = [_settings_error(file, text, _key_position(text, path), message) for path, message in faults]
        raise InputError(sorted(errors, key=lambda error: error.source))
    if not isinstance(table, dict):
        return None
    select, ignore = (tuple(table.get(key, ())) for key in ("select", "ignore"))
    severity = {code: Severity(value) for code, value in table.get("severity", {}).items()}
    return LintSettings(select, ignore, table.get("per-file", {}), severity, file)


_Fault = tuple[tuple[str, ...], str]  # the keys that lead to the fault, and the message


def _table_faults(table: object) -> Iterator[_Fault]:
    """Yield what is wrong in the table of settings: unknown settings, codes and severities, wrong types."""
    if not isinstance(table, dict):
        yield ("lint",), "expected a table of settings"
        return
    for key, value in table.items():
        if key in {"select", "ignore"}:
            yield from _code_list_faults((key,), value)
        elif key not in {"per-file", "severity"}:
            expected = "select, ignore, per-file, severity"
            yield (key,), f"found the setting {key!r}, expected one of {expected}"
        elif not isinstance(value, dict):
            yield (key,), f"expected a table [{_TABLE}.{key}]"
        else:
            for name, setting in value.items():
                if key == "per-file":
                    yield from _code_list_faults((key, name), setting)
                elif name not in CATALOG:
                    yield (key, name), unknown_code_message(name)
                elif setting not in list(Severity):
                    expected = ", ".join(repr(str(severity)) for severity in Severity)
                    yield (key, name), f"found {setting!r}, expected one of {expected}"


def _code_list_faults(path: tuple[str, ...], value: object) -> Iterator[_Fault]:
    """Yield what is wrong in a list of codes; ``path`` are the keys that lead to the list."""
    if not isinstance(value, list) or not all(isinstance(code, str) for code in value):
        yield path, f'expected a list of codes such as {path[-1]} = ["near-name"]'
        return
    for code in value:
        if code not in CATALOG:
            yield (*path, code), unknown_code_message(code)


def _key_position(text: str, path: tuple[str, ...]) -> tuple[int, int]:
    """Return line and column, from 1, of the last key of ``path`` in the text of a TOML file.

    ``path`` begins with the first key below the table of settings. Keys that are not found are passed over.
    """
    matches = [match for match in _WORD.finditer(text) if match[0][0] != "#"]
    words = [match[0].strip("\"'") for match in matches]
    table = _TABLE.split(".")[1:]
    index = next((index for index in range(len(words)) if words[index : index + 2] == table), 0)
    for word in path:
        index = words.index(word, index) if word in words[index:] else index
    return _line_and_column(text, matches[index].start() + (matches[index][0][0] in "\"'"))


def _line_and_column(text: str, offset: int) -> tuple[int, int]:
    """Return the line and column, from 1, of the character at an offset from 0."""
    before = text[:offset].replace("\r\n", "\n")
    return before.count("\n") + 1, len(before) - before.rfind("\n")


def _settings_error(file: Path, text: str, position: tuple[int, int], message: str) -> Diagnostic:
    """Return the error about a line and column of the settings file."""
    excerpt = split_lines(text)[position[0] - 1]
    return Diagnostic(Severity.ERROR, "settings", message, Source(str(file), *position), excerpt)
