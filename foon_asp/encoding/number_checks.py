"""Overflow checks: rules that find arithmetic beyond clingo's numbers, which wraps silently.

These rules derive ``_beyond(File,Line,Column,Term)``. They call ``@_exact(Text,...)`` with a term, in the
notation of :func:`foon_asp.encoding.exact.is_beyond`, and the values in the term.
"""

from collections.abc import Callable, Iterator
from typing import Final

from clingo import Control
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.encoding.exact import LARGEST, is_beyond

CHECKS_FILE: Final = "_numbers"  # the name of the overflow checks, in place of a file name
BEYOND: Final = "_beyond", 4


class Exact:
    """The functions that rules may call while clingo grounds them: ``@_exact`` alone."""

    def __getattribute__(self, name: str) -> Callable[..., Symbol]:
        """Return the function ``@_exact``; raise ``RuntimeError`` for any other name."""
        if name != "_exact":
            # the text has been checked for calls
            raise RuntimeError(f"no function is called, and {name!r} is one")
        return _exact


def _exact(text: Symbol, *values: Symbol) -> Symbol:
    """Return 1 if a term is beyond clingo's numbers, else 0.

    ``text`` is the term in postfix notation, and ``values`` are the values in it. Return 0 also if a value is
    no number, which clingo reports itself.
    """
    if any(value.type is not SymbolType.Number for value in values):
        return Number(0)  # reported by clingo
    return Number(is_beyond(text.string, [value.number for value in values]))


def overflow_messages(control: Control) -> Iterator[str]:
    """Yield a message in clingo's format about each overflow in a ground program, an atom ``_beyond/4``."""
    for atom in control.symbolic_atoms.by_signature(*BEYOND):
        file, line, column, term = atom.symbol.arguments
        yield (
            f"{file.string}:{line.number}:{column.number}: error: {term.string} leaves the whole numbers "
            f"that clingo has, from -{LARGEST} to {LARGEST}; clingo would go on with another number "
            "silently: calculate with smaller ones"
        )
