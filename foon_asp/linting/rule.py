"""Rules of linting, and their registration by a decorator."""

import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from foon_asp.linting.context import Context
from foon_asp.text.diagnostics import Diagnostic, Severity

ERROR, WARNING, NOTE = Severity.ERROR, Severity.WARNING, Severity.NOTE
Finder = Callable[[Context], Iterable[Diagnostic]]


class Rule(NamedTuple):
    """A code, its severity, its meaning in one line, and the function that yields its findings."""

    code: str
    severity: Severity
    meaning: str
    find: Finder

    @property
    def explanation(self) -> str:
        """The explanation of the rule for users, in paragraphs: the docstring of the function."""
        return inspect.cleandoc(self.find.__doc__ or "")

    def findings(self, context: Context) -> Iterator[Diagnostic]:
        """Yield the findings of the rule, with its code and severity."""
        for finding in self.find(context):
            yield finding._replace(code=self.code, severity=self.severity)


RULES: dict[str, Rule] = {}
"""The rules of the modules that are imported; :mod:`foon_asp.linting.catalog` imports all that have some."""


def rule(code: str, severity: Severity, meaning: str) -> Callable[[Finder], Finder]:
    """Return a decorator that makes a function of a context the rule of a code.

    The docstring of the function explains the code to users: ``lint --explain`` and ``docs/lint.md`` show
    it.
    """

    def enter(find: Finder) -> Finder:
        RULES[code] = Rule(code, severity, meaning, find)
        return find

    return enter
