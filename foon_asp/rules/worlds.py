"""Worlds: rules about one unit at a time, rewritten so that clingo derives them for all units at once."""

from collections.abc import Collection

from clingo.ast import AST, ASTType, Transformer, Variable

from foon_asp.rules.clause import Signature


class Worlds(Transformer):
    """Rewriter that adds a world as first argument to predicates that differ from world to world.

    A world stands for one unit, and rules in it see no other unit. ``dependent`` are the predicates to
    change; their names get a ``prefix``. ``world`` is a variable that no rule has. Atoms with a minus are not
    changed.
    """

    def __init__(self, dependent: Collection[Signature], world: str, prefix: str = "_") -> None:
        """Keep the predicates, the variable and the prefix."""
        self._dependent, self._world, self._prefix = dependent, world, prefix

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        """Return an atom, with a world if its predicate differs from world to world."""
        return atom.update(symbol=self._add_world(atom.symbol))

    def _add_world(self, symbol: AST) -> AST:
        """Return the symbol of an atom with the world variable, if its predicate differs between worlds.

        The variable becomes the first argument, and the name gets the prefix. In a pool, each atom is
        changed. Symbols of other predicates are returned unchanged.
        """
        if symbol.ast_type is ASTType.Pool:
            return symbol.update(arguments=[self._add_world(argument) for argument in symbol.arguments])
        if symbol.ast_type is ASTType.UnaryOperation:
            return symbol
        if (symbol.name, len(symbol.arguments)) not in self._dependent:
            return symbol
        arguments = [Variable(symbol.location, self._world), *symbol.arguments]
        return symbol.update(name=f"{self._prefix}{symbol.name}", arguments=arguments)


def unused_variable(text: str, name: str) -> str:
    """Return a variable that a text of rules does not have: ``name``, with ``_`` added as often as needed."""
    while name in text:
        name += "_"
    return name
