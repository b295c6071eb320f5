"""A text of the editor with its names and the findings of lint."""

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
    """A text of the editor after a check.

    ``names``: the names in the text, with its units.
    ``findings``: the findings of lint, each after the index of its line.
    ``settings_error``: what is wrong in the settings of lint, which are then ignored; empty if nothing is.
    """

    text: EditedText
    names: Names
    findings: list[tuple[int, Diagnostic]]
    settings_error: str


def check_text(text: EditedText) -> CheckedText:
    """Lint a text by itself, under the settings of the folder of its file.

    Settings with errors are replaced by the defaults, and reported as ``settings_error``.
    """
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
