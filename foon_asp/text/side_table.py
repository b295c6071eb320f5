"""The tables beside a network as a format: they are known by the names of their files."""

from collections.abc import Iterator
from pathlib import PurePath
from typing import TYPE_CHECKING

from foon_asp.errors import UserError
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.foon_text import FoonText
from foon_asp.text.line import Mention, NameKind
from foon_asp.text.plain_file import each_line, split_lines

if TYPE_CHECKING:
    from foon_asp.text.renaming import Renaming

TABLES = {
    "motion.txt": NameKind.MOTION,
    "durations.txt": NameKind.MOTION,
    "unit_prices.txt": NameKind.MOTION,
    "utensils.txt": NameKind.OBJECT,
    "tools.txt": NameKind.OBJECT,
}
"""By the name of the file: of what kind the names in the first column are."""


class SideTable(FoonText):
    """A table, as the files of a folder are renamed together; as FOON text, it has no units."""

    dialects = ()

    def recognises(self, text: str, file: str) -> bool:
        """Whether the file has the name of a table."""
        return PurePath(file).name in TABLES

    def not_understood(self, text: str, file: str) -> list[Diagnostic]:
        """Return nothing: names are found in whatever stands before a tab."""
        return []

    def names(self, text: str, file: str) -> Iterator[Mention]:
        """Give the names in the first column."""
        for line in split_lines(text):
            if line.strip() and line[:1] != "#":
                yield Mention(TABLES[PurePath(file).name], line.partition("\t")[0].strip())

    def renamed(self, text: str, file: str, renaming: "Renaming") -> str:
        """Return a table with the new name; raises :class:`UserError` where that has two rows then."""
        new = each_line(text, lambda line: _renamed_row(line, PurePath(file).name, renaming))
        rows = (line.split("\t") for line in split_lines(new))
        name = renaming.rename.new
        if len({"\t".join(row) for row in rows if len(row) == 2 and row[0].strip() == name}) > 1:
            raise UserError(f"{file} would have two different rows for {name!r}; take one of them out before")
        return new


def _renamed_row(line: str, table: str, renaming: "Renaming") -> str:
    if not line.strip() or line[:1] == "#":
        return line
    first, *fields = line.split("\t")
    if table == "tools.txt" and ";" in first:
        first = renaming.node(first)
    elif renaming.name(TABLES[table], first.strip()) != first.strip():
        first = first.replace(renaming.rename.old, renaming.rename.new)
    if table == "unit_prices.txt":
        fields = [*map(renaming.node, fields[:-1]), *fields[-1:]]
    return "\t".join((first, *fields))
