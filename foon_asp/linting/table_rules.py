"""Lint rules about the tables beside a network: rates, utensils, durations, tools, prices, amounts."""

from collections.abc import Collection, Iterator
from pathlib import Path

from foon_asp.linting.context import Context
from foon_asp.linting.names import Kind, is_of_another_network
from foon_asp.linting.rule import ERROR, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.network import NO_AMOUNTS, counted
from foon_asp.network.spelling import near_labels
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.side_table import TABLES
from foon_asp.text.stated_amounts import apply_amount_table
from foon_asp.text.unit_amount_list import UNIT_AMOUNTS

_RATES = "motion.txt"


@rule("table", ERROR, "a row of a table beside the network that cannot be read")
def find_unreadable_rows(context: Context) -> Iterator[Diagnostic]:
    """A row of rates (`motion.txt`), durations, numbers of tools or prices of units is not understood."""
    for sheet in context.files.tables:
        yield from _table_errors(sheet)


def _table_errors(sheet: Sheet) -> Iterator[Diagnostic]:
    """Yield the errors because of which a table cannot be read; none for a table that can be read."""
    file = Path(sheet.file)
    try:
        TABLES[file.name].rows(file, "\n".join(sheet.lines))
    except InputError as error:
        yield from error.diagnostics


@rule("unknown-row", WARNING, "a row of a table for a name that the network has not")
def find_unknown_rows(context: Context) -> Iterator[Diagnostic]:
    """The name of the row is probably misspelt, in the table or in a network.

    The tables are those of rates, durations, prices, amounts, utensils and tools. A row of amounts is also
    reported if no unit with its motion takes, or makes, its node. Utensils that the vocabulary has are not
    reported. If most names of a table are unknown, a single finding reports them all.
    """
    for sheet in context.files.tables if len(context.network) else ():
        kind = TABLES[Path(sheet.file).name].names
        network_names = context.names.counts[kind].keys()
        known_names = context.vocabulary.names[kind] if kind is Kind.OBJECT else set()
        rows = _first_rows(sheet)
        unknown = [name for name in rows if name not in network_names and name not in known_names]
        if is_of_another_network(len(unknown), len(rows)):
            message = (
                f"{len(unknown)} of the {len(rows)} names are no {kind} of the network, {unknown[0]!r} "
                "first; is the table for another network?"
            )
            yield sheet.finding(message, rows[unknown[0]])
            continue
        if Path(sheet.file).name == "unit_amounts.txt":
            yield from _amounts_without_unit(sheet, context, set(unknown))
        for name in unknown:
            similar_names = near_labels(name, network_names, 1)
            hint = f"; is it {similar_names[0]!r}?" if similar_names else ""
            yield sheet.finding(f"{name!r} is no {kind} of the network{hint}", rows[name])


def _amounts_without_unit(sheet: Sheet, context: Context, unknown: Collection[str]) -> Iterator[Diagnostic]:
    """Yield a finding for each row of amounts that fits no unit.

    A row fits a unit that has its motion and, on the side that it is about, its node. Motions in ``unknown``
    are skipped. Yields nothing for a table that cannot be read.
    """
    if any(_table_errors(sheet)):
        return
    rows = UNIT_AMOUNTS.rows(Path(sheet.file), "\n".join(sheet.lines))
    units = map(context.network.unit, range(len(context.network)))
    for finding in apply_amount_table(NO_AMOUNTS, rows, units)[1]:
        index = finding.source.line - 1
        if sheet.lines[index].partition("\t")[0].strip() not in unknown:
            yield sheet.finding(finding.message, index)


@rule("missing-rate", WARNING, "motions of the network without a success rate")
def find_missing_rates(context: Context) -> Iterator[Diagnostic]:
    """Each motion of the network needs a rate in `motion.txt`.

    If one is missing, no success rate of a tree can be computed, and a question about it is an error. A
    single finding for each table names the first three.
    """
    for sheet in context.files.tables:
        rows = _first_rows(sheet)
        missing = [motion for motion in dict.fromkeys(context.network.motions) if motion not in rows]
        if missing and Path(sheet.file).name == _RATES:
            shown = ", ".join(map(repr, missing[:3])) + (", ..." if len(missing) > 3 else "")
            message = f"{counted(len(missing), 'motion')} of the network without a rate: {shown}"
            yield sheet.finding(message, max(rows.values(), default=0))


def _first_rows(sheet: Sheet) -> dict[str, int]:
    """Return, by name, the index of the first row with the name; rows that cannot be read are left out."""
    bad = {fault.source.line for fault in _table_errors(sheet)}
    rows: dict[str, int] = {}
    for index, line in enumerate(sheet.lines):
        name = line.partition("\t")[0].partition(";")[0].strip()
        if name and not name.startswith("#") and index + 1 not in bad:
            rows.setdefault(name, index)
    return rows
