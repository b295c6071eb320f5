"""What there is to say of the tables beside a network: rates, utensils, durations, tools, prices."""

import tempfile
from collections.abc import Callable, Collection, Iterator
from pathlib import Path

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.names import Kind, Names
from foon_asp.linting.sheet import Sheet
from foon_asp.linting.vocabulary import Vocabulary
from foon_asp.network import counted
from foon_asp.network.spelling import near_labels
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.tables import DURATIONS, RATES, TOOLS
from foon_asp.text.unit_price_list import read_unit_prices

# by the name of the file: what the names in it are, and how the numbers behind them are read
_TABLES: dict[str, tuple[Kind, Callable[[Path], object] | None]] = {
    "durations.txt": (Kind.MOTION, DURATIONS.read),
    "motion.txt": (Kind.MOTION, RATES.read),
    "tools.txt": (Kind.OBJECT, TOOLS.read),
    "unit_prices.txt": (Kind.MOTION, read_unit_prices),
    "utensils.txt": (Kind.OBJECT, None),
}
_RATES = "motion.txt"
_MANY = 10  # rows: if most of them are of no use, they are told together


def table_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give the rows that cannot be read, those of names that the network has not, and motions without a rate.

    Without units, nothing is said of names; nor of a name that the vocabulary has, but for a motion.
    """
    for sheet in names.files.tables:
        kind, read = _TABLES[Path(sheet.file).name]
        bad = set()
        for finding in _unread(sheet, read) if read else ():
            bad.add(finding.source.line)
            yield finding
        rows: dict[str, int] = {}
        for index, line in enumerate(sheet.lines):
            name = line.partition("\t")[0].partition(";")[0].strip()
            if name and name[0] != "#" and index + 1 not in bad:
                rows.setdefault(name, index)
        if not len(names.network):
            continue
        there = names.counts[kind].keys()
        unknown = [name for name in rows if name not in there]
        if kind is Kind.OBJECT:
            unknown = [name for name in unknown if name not in known.names[kind]]
        yield from _unknown(sheet, kind, {name: rows[name] for name in unknown}, len(rows), there)
        if Path(sheet.file).name == _RATES:
            missing = [motion for motion in dict.fromkeys(names.network.motions) if motion not in rows]
            if missing:
                shown = ", ".join(map(repr, missing[:3])) + (", ..." if len(missing) > 3 else "")
                message = f"{counted(len(missing), 'motion')} of the network without a rate: {shown}"
                yield sheet.finding("missing-rate", message, max(rows.values(), default=0))


def _unread(sheet: Sheet, read: Callable[[Path], object]) -> Iterator[Diagnostic]:
    """Read the rows as a question would, and give what is wrong with them."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "table.txt"
        copy.write_text("\n".join(sheet.lines), encoding="utf-8")
        try:
            read(copy)
        except InputError as error:
            for fault in error.diagnostics:
                yield fault._replace(
                    code="table",
                    severity=CATALOG["table"].severity,
                    source=fault.source._replace(file=sheet.file),
                )


def _unknown(
    sheet: Sheet, kind: Kind, rows: dict[str, int], total: int, there: Collection[str]
) -> Iterator[Diagnostic]:
    if len(rows) > _MANY and 2 * len(rows) > total:
        name, index = next(iter(rows.items()))
        message = (
            f"{len(rows)} of the {total} names are no {kind} of the network, {name!r} first; is the table "
            "for another network?"
        )
        yield sheet.finding("unknown-row", message, index, column=1)
        return
    for name, index in rows.items():
        near = near_labels(name, there, 1)
        message = f"{name!r} is no {kind} of the network"
        if near:
            message += f"; is it {near[0]!r}?"
        yield sheet.finding("unknown-row", message, index, column=1)
