"""The tables beside a network: rates, utensils, durations, tools, prices."""

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
def table(context: Context) -> Iterator[Diagnostic]:
    """Rates (`motion.txt`), durations, numbers of tools and prices of units are read as questions do."""
    for sheet in context.files.tables:
        yield from _faults(sheet)


def _faults(sheet: Sheet) -> Iterator[Diagnostic]:
    """Yield the errors with which a table cannot be read."""
    file = Path(sheet.file)
    try:
        TABLES[file.name].rows(file, "\n".join(sheet.lines))
    except InputError as error:
        yield from error.diagnostics


@rule("unknown-row", WARNING, "a row of a table for a name that the network has not")
def unknown_row(context: Context) -> Iterator[Diagnostic]:
    """The name is probably misspelt, in the table or in a network.

    The tables are those of rates, durations, prices, amounts, utensils and tools. A row of amounts is also
    reported where no unit of the motion takes, or makes, the node. Utensils that the vocabulary has are not
    reported.
    """
    for sheet in context.files.tables if len(context.network) else ():
        kind = TABLES[Path(sheet.file).name].names
        network_names = context.names.counts[kind].keys()
        known_names = context.vocabulary.names[kind] if kind is Kind.OBJECT else set()
        rows = _rows(sheet)
        unknown = [name for name in rows if name not in network_names and name not in known_names]
        if is_of_another_network(len(unknown), len(rows)):
            message = (
                f"{len(unknown)} of the {len(rows)} names are no {kind} of the network, {unknown[0]!r} "
                "first; is the table for another network?"
            )
            yield sheet.finding(message, rows[unknown[0]])
            continue
        if Path(sheet.file).name == "unit_amounts.txt":
            yield from _without_unit(sheet, context, set(unknown))
        for name in unknown:
            similar_names = near_labels(name, network_names, 1)
            hint = f"; is it {similar_names[0]!r}?" if similar_names else ""
            yield sheet.finding(f"{name!r} is no {kind} of the network{hint}", rows[name])


def _without_unit(sheet: Sheet, context: Context, unknown: Collection[str]) -> Iterator[Diagnostic]:
    """Yield a finding for each amount of a node that no unit of its motion, a known one, takes or makes."""
    if _any_fault(sheet):
        return
    rows = UNIT_AMOUNTS.rows(Path(sheet.file), "\n".join(sheet.lines))
    units = map(context.network.unit, range(len(context.network)))
    for finding in apply_amount_table(NO_AMOUNTS, rows, units)[1]:
        index = finding.source.line - 1
        if sheet.lines[index].partition("\t")[0].strip() not in unknown:
            yield sheet.finding(finding.message, index)


def _any_fault(sheet: Sheet) -> bool:
    return next(_faults(sheet), None) is not None


@rule("missing-rate", WARNING, "motions of the network without a success rate")
def missing_rate(context: Context) -> Iterator[Diagnostic]:
    """Without a rate for each motion there is no success, and asking for it is an error."""
    for sheet in context.files.tables:
        rows = _rows(sheet)
        missing = [motion for motion in dict.fromkeys(context.network.motions) if motion not in rows]
        if missing and Path(sheet.file).name == _RATES:
            shown = ", ".join(map(repr, missing[:3])) + (", ..." if len(missing) > 3 else "")
            message = f"{counted(len(missing), 'motion')} of the network without a rate: {shown}"
            yield sheet.finding(message, max(rows.values(), default=0))


def _rows(sheet: Sheet) -> dict[str, int]:
    """Return the first row of each name, without rows that cannot be read."""
    bad = {fault.source.line for fault in _faults(sheet)}
    rows: dict[str, int] = {}
    for index, line in enumerate(sheet.lines):
        name = line.partition("\t")[0].partition(";")[0].strip()
        if name and not name.startswith("#") and index + 1 not in bad:
            rows.setdefault(name, index)
    return rows
