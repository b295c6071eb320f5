"""A text that was read and linted whole."""

from typing import NamedTuple

from foon_asp.editor.edited_text import EditedText
from foon_asp.errors import UserError
from foon_asp.linting.context import Context
from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.linter import lint_context
from foon_asp.linting.names import Names
from foon_asp.linting.settings import LintSettings, find_settings
from foon_asp.text.diagnostics import Diagnostic


class CheckedText(NamedTuple):
    """A text, the names and units in it, its findings with the lines that have them, and a complaint.

    The complaint says what is wrong with the settings of linting, which then do not count.
    """

    text: EditedText
    names: Names
    findings: list[tuple[int, Diagnostic]]
    complaint: str


def check(text: EditedText) -> CheckedText:
    """Read and lint a text by itself."""
    settings, complaint = LintSettings(), ""
    try:
        settings = find_settings([text.file])
    except UserError as error:
        complaint = str(error)
    context = Context(LintedFiles([text.file], {text.file: text.text.encode("utf-8", "replace")}))
    findings = [
        (min(max(1, finding.source.line), len(text.lines)) - 1, finding)
        for finding in settings.applied(lint_context(context))
    ]
    return CheckedText(text, context.names, findings, complaint)
