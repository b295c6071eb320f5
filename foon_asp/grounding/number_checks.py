"""Rules that find what a program calculates beyond clingo's numbers, where it takes others silently.

They are in a part of their own, derive ``_beyond(File,Line,Column,Term)``, and call ``@_exact(Text,...)``
with a term as :func:`foon_asp.grounding.exact.is_beyond` has it, and the values in it.
"""

from collections.abc import Callable, Iterator
from typing import Final

from clingo import Control
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.grounding.exact import LARGEST, is_beyond

PLACE: Final = "_numbers"  # stands for the name of a file that these rules are in
BEYOND: Final = "_beyond", 4


class Exact:
    """The functions that rules may call: ``@_exact`` alone."""

    def __getattribute__(self, name: str) -> Callable[..., Symbol]:
        if name != "_exact":
            raise RuntimeError(f"no function is called, and {name!r} is one")  # nor is it read before
        return _exact


def _exact(text: Symbol, *values: Symbol) -> Symbol:
    if any(value.type is not SymbolType.Number for value in values):
        return Number(0)  # clingo says so
    return Number(is_beyond(text.string, [value.number for value in values]))


def numbers_beyond(control: Control) -> Iterator[str]:
    """Return messages, as clingo would, for what a ground program calculates beyond its numbers."""
    for atom in control.symbolic_atoms.by_signature(*BEYOND):
        file, line, column, term = atom.symbol.arguments
        yield (
            f"{file.string}:{line.number}:{column.number}: error: {term.string} leaves the whole numbers "
            f"that clingo has, from -{LARGEST} to {LARGEST}; clingo would go on with another number "
            "silently: calculate with smaller ones"
        )
