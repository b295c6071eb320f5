"""Tables beside a network: a name, a tab and a number on each line."""

from collections.abc import Callable
from pathlib import Path

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import LineError
from foon_asp.text.plain_file import read_plain_text


def read_rows(file: Path, code: str, number: str, read: Callable[[str, str, Source], None]) -> None:
    """Hand every line to ``read``: what stands before the tab, the number behind it, and the place.

    Blank lines and ``#`` comments are passed over. Raises :class:`InputError`, under ``code``, with every
    line without a tab, where ``number`` says what is expected behind it, and with those for which ``read``
    raises :class:`LineError`.
    """
    errors: list[Diagnostic] = []
    for index, raw in enumerate(read_plain_text(file).split("\n"), 1):
        line = raw.removesuffix("\r")
        if not line.strip() or line.startswith("#"):
            continue
        name, tab, field = line.partition("\t")
        try:
            if not tab:
                raise LineError(len(line) + 1, "the end of the line", (f"a tab and {number}",))
            read(name, field.strip(), Source(str(file), index))
        except LineError as error:
            place = Source(str(file), index, error.column)
            errors.append(Diagnostic(Severity.ERROR, code, str(error), place, line))
    if errors:
        raise InputError(errors)
