"""Atoms of a stratified program, which grounding alone derives."""

from typing import NamedTuple

from clingo import Control
from clingo.symbol import Symbol, SymbolType

from foon_asp.encoding.messages import NO_LIMIT, listener, refuse_messages
from foon_asp.encoding.number_checks import Exact


class Term(NamedTuple):
    """A term that is neither a number nor a string, as text."""

    text: str


Value = int | str | Term
"""An argument of an atom: a number, a string, or another term."""


def derive(text: str, name: str, arity: int) -> list[tuple[Value, ...]]:
    """Ground a stratified program, and return the arguments of each atom of a predicate.

    ``text`` is the program; ``name`` and ``arity`` are those of the predicate. Raises :class:`ProgramError`
    if clingo refuses a statement, or would drop an instance of one.
    """
    messages: list[str] = []
    with refuse_messages(messages):
        control = Control(logger=listener(messages), message_limit=NO_LIMIT)
        control.add("base", [], text)
        control.ground([("base", [])], Exact())
    return [
        tuple(map(_value, atom.symbol.arguments)) for atom in control.symbolic_atoms.by_signature(name, arity)
    ]


def _value(symbol: Symbol) -> Value:
    """Return an argument of an atom as number, string or :class:`Term`."""
    if symbol.type is SymbolType.Number:
        return symbol.number
    return symbol.string if symbol.type is SymbolType.String else Term(str(symbol))
