"""Tables beside a network: on each line a name, a tab and a value."""

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
    """A row of a table: a name, its value, and its source."""

    name: K
    value: V
    source: Source


class Table(NamedTuple, Generic[K, V]):
    """A kind of table: how its rows are read, and the words for it in messages.

    ``code``: the code of diagnostics about the table.
    ``names``: the kind of the names in the first column.
    ``expected``: the noun for the value after the tab; empty for a table of one column.
    ``row``: a function that reads a row. Its parameters are the name, the text after the tab, and the column
    of this text. It returns name and value as read, or raises :class:`LineError`.
    ``second``: the message about a name with two values; ``{name}`` stands for the name, ``{value}`` for the
    later value.
    """

    code: str
    names: NameKind
    expected: str
    row: Callable[[str, str, int], tuple[K, V]]
    second: str = ""

    def rows(self, file: Path, text: str | None = None) -> list[Row[K, V]]:
        """Return the first row of each name in a file; if ``text`` is given, it is read in place of the file.

        Blank lines and ``#`` comments are skipped. Raises :class:`InputError` with every faulty line. A line
        is also faulty if it gives a name another value than an earlier line.
        """
        rows_by_name: dict[K, Row[K, V]] = {}

        def add_row(name: str, value: str, source: Source) -> None:
            """Record a row; raises :class:`LineError` if its name has another value already."""
            row = Row(*self.row(name.strip(), value, len(name) + 2), source)
            if rows_by_name.setdefault(row.name, row).value != row.value:
                second = self.second.format(name=str(row.name), value=value)
                raise LineError(len(name) + 2 + value.rfind("\t") + 1, second, ("one",))

        read_rows(file, self.code, self.expected, add_row, text)
        return list(rows_by_name.values())

    def read(self, file: Path) -> dict[K, V]:
        """Return the values of a file by name; raises as :meth:`rows` does."""
        return {row.name: row.value for row in self.rows(file)}


def read_rows(
    file: Path,
    code: str,
    expected: str,
    read: Callable[[str, str, Source], None],
    text: str | None = None,
) -> None:
    """Call ``read`` with each line of a file: the name before the tab, the value behind it, and the source.

    If ``text`` is given, it is read in place of the file. Blank lines and ``#`` comments are skipped. If
    ``expected`` is empty, a line is a name without a tab and a value.

    Raises :class:`InputError` with diagnostics whose code is ``code``. There is one for each line without a
    required tab, and for each line for which ``read`` raises :class:`LineError`.
    """
    errors: list[Diagnostic] = []
    lines = split_lines(read_plain_text(file) if text is None else text)
    for index, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        name, tab, value = line.partition("\t") if expected else (line, "", "")
        try:
            if expected and not tab:
                raise LineError(len(line) + 1, "the end of the line", (f"a tab and {expected}",))
            read(name, value.strip(), Source(str(file), index))
        except LineError as error:
            source = Source(str(file), index, error.column)
            errors.append(Diagnostic(Severity.ERROR, code, str(error), source, line))
    if errors:
        raise InputError(errors)
