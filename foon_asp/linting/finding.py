"""Findings of lint as values: printed as text, or written as JSON."""

from foon_asp.escapes import escaped
from foon_asp.linting.mending import is_mendable
from foon_asp.results.values import Value
from foon_asp.text.diagnostics import Diagnostic, Severity, excerpt_with_caret


class SeverityCounts(Value, frozen=True):
    """How many findings there are of each severity."""

    error: int
    warning: int
    note: int


class Finding(Value, frozen=True):
    """Something that is wrong or doubtful at one place.

    Attributes:
        line: From 1; 0 where the file as a whole is meant.
        column: From 1.
        severity: error: the file certainly does not say what is meant; warning: it probably does not; note:
            it may be intended.
        text: The line; null where no line can be shown, or in JSON where it is longer than a thousand
            letters.
        fix: The line as it should be, where it can be mended.
        mendable: Whether --fix mends it.
        unsafe: Whether only --fix --unsafe-fixes mends it, which changes what is read.
    """

    file: str
    line: int
    column: int
    severity: Severity
    code: str
    message: str
    text: str | None
    fix: str | None
    mendable: bool
    unsafe: bool

    @classmethod
    def of(cls, diagnostic: Diagnostic) -> "Finding":
        """Return the value of a finding; ``diagnostic`` is what a rule yielded."""
        mendable = is_mendable(diagnostic)
        return cls(
            diagnostic.source.file,
            diagnostic.source.line,
            diagnostic.source.column,
            diagnostic.severity,
            diagnostic.code,
            diagnostic.message,
            diagnostic.excerpt,
            diagnostic.fix,
            mendable,
            is_mendable(diagnostic, unsafe=True) and not mendable,
        )

    def __str__(self) -> str:
        """Return ``file:line:column: severity: message [code]``, and below it the line and a caret.

        Without a text of the line, return the first line only.
        """
        head = f"{escaped(self.file)}:{self.line}:{self.column}: {self.severity}: {escaped(self.message)}"
        excerpt = f"\n{excerpt_with_caret(self.text, self.column)}" if self.text else ""
        return f"{head} [{self.code}]{excerpt}"
