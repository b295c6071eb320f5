"""Lint rules, and the decorator that registers them."""

import inspect
from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from foon_asp.linting.context import Context
from foon_asp.text.diagnostics import Diagnostic, Severity

ERROR, WARNING, NOTE = Severity.ERROR, Severity.WARNING, Severity.NOTE
Finder = Callable[[Context], Iterable[Diagnostic]]


class Rule(NamedTuple):
    """A lint rule.

    ``meaning`` is one line for users. ``find`` yields the findings; their code and severity are those of the
    rule.
    """

    code: str
    severity: Severity
    meaning: str
    find: Finder

    @property
    def explanation(self) -> str:
        """The explanation of the rule for users, in paragraphs; it is the docstring of the function."""
        return inspect.cleandoc(self.find.__doc__ or "")

    def findings(self, context: Context) -> Iterator[Diagnostic]:
        """Yield the findings of the rule in the files of a context, with its code and severity."""
        for finding in self.find(context):
            yield finding._replace(code=self.code, severity=self.severity)


RULES: dict[str, Rule] = {}
"""The rules of the modules that are imported; :mod:`foon_asp.linting.catalog` imports all that have some."""


def rule(code: str, severity: Severity, meaning: str) -> Callable[[Finder], Finder]:
    """Return a decorator that registers a function as the lint rule with this code.

    The docstring of the function explains the code to users: ``lint --explain`` and ``docs/lint.md`` show it.
    """

    def register(find: Finder) -> Finder:
        """Add the rule to :data:`RULES`."""
        RULES[code] = Rule(code, severity, meaning, find)
        return find

    return register
