"""Tables beside a network: on each line a name, a tab and what is said of it."""

from collections.abc import Callable
from pathlib import Path
from typing import Generic, NamedTuple, TypeVar

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import LineError, NameKind
from foon_asp.text.plain_file import read_plain_text, split_lines

K = TypeVar("K")
V = TypeVar("V")


class Row(NamedTuple, Generic[K, V]):
    """A name, what is said of it, and where that stands."""

    name: K
    value: V
    source: Source


class Table(NamedTuple, Generic[K, V]):
    """The description of a kind of table.

    ``code`` is that of its faults, ``names`` says of what kind the names in the first column are, and
    ``expected`` what stands behind the tab; it is empty for a table of one column. ``row`` reads the name
    before the tab and the text behind it, which begins in a column; it raises :class:`LineError`. ``second``
    is the fault of a name of which two things are said.
    """

    code: str
    names: NameKind
    expected: str
    row: Callable[[str, str, int], tuple[K, V]]
    second: str = ""

    def rows(self, file: Path, text: str | None = None) -> list[Row[K, V]]:
        """Read the rows of a file, or of its text where that is known, each name once.

        Blank lines and ``#`` comments are passed over. Raises :class:`InputError` with every line of another
        form, and with each that says another thing of a name than one above.
        """
        found: dict[K, Row[K, V]] = {}

        def read(name: str, value: str, source: Source) -> None:
            row = Row(*self.row(name.strip(), value, len(name) + 2), source)
            if found.setdefault(row.name, row).value != row.value:
                second = self.second.format(name=str(row.name), value=value)
                raise LineError(len(name) + 2 + value.rfind("\t") + 1, second, ("one",))

        read_rows(file, self.code, self.expected, read, text)
        return list(found.values())

    def read(self, file: Path) -> dict[K, V]:
        """Read what a file says, by name; raises as :meth:`rows` does."""
        return {row.name: row.value for row in self.rows(file)}


def read_rows(
    file: Path,
    code: str,
    expected: str,
    read: Callable[[str, str, Source], None],
    text: str | None = None,
) -> None:
    """Hand every line of a file to ``read``: what stands before the tab, what behind it, and the place.

    The file is not read where its ``text`` is known.

    Blank lines and ``#`` comments are passed over. Raises :class:`InputError`, under ``code``, with every
    line without a tab, unless nothing is ``expected`` behind it, and with those for which ``read`` raises
    :class:`LineError`.
    """
    errors: list[Diagnostic] = []
    lines = split_lines(read_plain_text(file) if text is None else text)
    for index, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        name, tab, field = line.partition("\t") if expected else (line, "", "")
        try:
            if expected and not tab:
                raise LineError(len(line) + 1, "the end of the line", (f"a tab and {expected}",))
            read(name, field.strip(), Source(str(file), index))
        except LineError as error:
            place = Source(str(file), index, error.column)
            errors.append(Diagnostic(Severity.ERROR, code, str(error), place, line))
    if errors:
        raise InputError(errors)
