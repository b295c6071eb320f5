"""Findings of linting as annotations that GitHub shows beside the lines of a change."""

from collections.abc import Sequence

from foon_asp.escapes import UNSAFE, escaped
from foon_asp.text.diagnostics import Diagnostic, Severity

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.NOTE: "notice"}


def lint_annotations(findings: Sequence[Diagnostic]) -> str:
    """Give a workflow command for each finding: ``::warning file=...,line=...,col=...,title=...::...``.

    The characters that would end a command or a property are escaped as GitHub's own toolkit does.
    """
    lines = []
    for severity, code, message, source, *_ in findings:
        place = f"file={_property(source.file)},line={source.line},col={source.column}"
        lines.append(f"::{_COMMANDS[severity]} {place},title={_property(code)}::{_data(message)}\n")
    return "".join(lines)


def _data(text: str) -> str:
    written = text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")
    return UNSAFE.sub(lambda found: escaped(found[0]), written)


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
