"""How these tests read FOON text: when the readers change, this module does."""

from foon_asp.network import FunctionalUnit
from foon_asp.text.listed_unit import ReadUnit
from foon_asp.text.reader import FoonReader

MIX = "O\ta\nM\tmix\nO\tb\n//\n"


def read(text: str, lenient: bool = False) -> tuple[list[ReadUnit], FoonReader]:
    """Read a text under the name ``f.txt``; the reader comes along with what it remarked on."""
    reader = FoonReader(lenient)
    return list(reader.units(text, "f.txt")), reader


def units_of(found: list[ReadUnit]) -> list[FunctionalUnit]:
    """Return what identifies each unit."""
    return [FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs) for unit in found]


def places(reader: FoonReader) -> list[tuple[str, int, int]]:
    """Return code, line and column of everything that a reader remarked on."""
    return [(d.code, d.source.line, d.source.column) for d in reader.diagnostics]
