"""The format of the tables beside a network, recognised by file name."""

from collections.abc import Iterator
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any

from foon_asp.errors import UserError
from foon_asp.text.foon_text import FoonText
from foon_asp.text.line import Mention
from foon_asp.text.plain_file import map_lines, split_lines
from foon_asp.text.tables import DURATIONS, RATES, TOOLS, UTENSILS
from foon_asp.text.unit_amount_list import UNIT_AMOUNTS
from foon_asp.text.unit_price_list import UNIT_PRICES
from foon_asp.text.value_table import Table

if TYPE_CHECKING:
    from foon_asp.text.renaming import Renaming

TABLES: dict[str, Table[Any, Any]] = {
    "motion.txt": RATES,
    "durations.txt": DURATIONS,
    "unit_prices.txt": UNIT_PRICES,
    "unit_amounts.txt": UNIT_AMOUNTS,
    "utensils.txt": UTENSILS,
    "tools.txt": TOOLS,
}
"""The tables by file name."""


class SideTable(FoonText):
    """The format of a table beside a network, which has names to rename and no units."""

    dialects = ()

    def recognises(self, text: str, file: str) -> bool:
        """Whether the file has the name of a table, such as ``motion.txt``."""
        return PurePath(file).name in TABLES

    def canonical_text(self, text: str, file: str, lenient: bool = False) -> str:
        """Return a table as it is.

        Raises :class:`InputError` with the rows that cannot be understood, unless ``lenient``.
        """
        if not lenient:
            TABLES[PurePath(file).name].rows(Path(file), text)
        return text

    def mentions(self, text: str, file: str) -> Iterator[Mention]:
        """Yield a mention of each name in the first column; rows need not be well-formed."""
        for line in split_lines(text):
            if line.lstrip()[:1] not in {"", "#"}:
                yield Mention(TABLES[PurePath(file).name].names, line.partition("\t")[0].strip())

    def renamed_text(self, text: str, file: str, renaming: "Renaming") -> str:
        """Return the text of a table in which the old name is replaced by the new one.

        Raises :class:`UserError` if the table would then have two different rows for the new name.
        """
        new_text = map_lines(text, lambda line: _renamed_row(line, PurePath(file).name, renaming))
        rows = (line.split("\t") for line in split_lines(new_text))
        name = renaming.rename.new
        if len({"\t".join(row) for row in rows if len(row) == 2 and row[0].strip() == name}) > 1:
            raise UserError(f"{file} would have two different rows for {name!r}; take one of them out before")
        return new_text


def _renamed_row(line: str, table: str, renaming: "Renaming") -> str:
    """Return a line of the table file ``table`` with the new name; blank lines and comments stay.

    In the tables of tools, prices and amounts, the name is also replaced in nodes in one-line notation.
    """
    if line.lstrip()[:1] in {"", "#"}:
        return line
    first, *fields = line.split("\t")
    if table == "tools.txt" and ";" in first:
        first = renaming.node(first)
    elif renaming.name(TABLES[table].names, first.strip()) != first.strip():
        first = first.replace(renaming.rename.old, renaming.rename.new)
    if table in {"unit_prices.txt", "unit_amounts.txt"}:
        fields = [*map(renaming.node, fields[:-1]), *fields[-1:]]
    return "\t".join((first, *fields))
