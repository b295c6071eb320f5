"""Checked text: a text of the editor with its names and the findings of lint."""

from typing import NamedTuple

from foon_asp.editor.edited_text import EditedText
from foon_asp.errors import UserError
from foon_asp.linting.context import Context
from foon_asp.linting.lint_settings import LintSettings, find_settings
from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.linter import lint_context
from foon_asp.linting.names import Names
from foon_asp.text.diagnostics import Diagnostic


class CheckedText(NamedTuple):
    """A text, the names and units in it, and its findings, each with its line, from 0.

    ``settings_error`` says what is wrong with the settings of lint, which are then ignored; empty if nothing.
    """

    text: EditedText
    names: Names
    findings: list[tuple[int, Diagnostic]]
    settings_error: str


def check(text: EditedText) -> CheckedText:
    """Return a text read and linted by itself, under the settings of its folder."""
    settings, settings_error = LintSettings(), ""
    try:
        settings = find_settings([text.file])
    except UserError as error:
        settings_error = str(error)
    context = Context(LintedFiles([text.file], {text.file: text.text.encode("utf-8", "replace")}))
    findings = [
        (min(max(1, finding.source.line), len(text.lines)) - 1, finding)
        for finding in settings.apply(lint_context(context))
    ]
    return CheckedText(text, context.names, findings, settings_error)
