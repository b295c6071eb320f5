"""Search for rules that name a unit by its number, such as ``:- use(7).``"""

from collections.abc import Iterable
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.encoding.parsing import nodes
from foon_asp.network import Source
from foon_asp.rules.clause import Clause, Conjunct, Test, clauses, literals, source_of, variables
from foon_asp.rules.fact_values import COLUMNS, Columns


class NumberedUnit(NamedTuple):
    """An atom or comparison that names a unit by its number: its text, and the place of its rule."""

    text: str
    source: Source


def numbered_unit(statements: Iterable[AST]) -> NumberedUnit | None:
    """Return the first atom or comparison in rules that names a unit by its number, as ``use(7)`` does.

    Only bodies and conditions are searched. A number that is matched with a unit only through a user
    predicate is not found. Return ``None`` if there is no such atom or comparison.
    """
    for statement in statements:
        if statement.ast_type == ASTType.Rule:
            for clause in clauses(statement, 0, {}):
                text = _numbered_unit_text(clause)
                if text:
                    return NumberedUnit(text, source_of(statement))
    return None


def _numbered_unit_text(clause: Clause) -> str:
    """Return the atom or comparison of a clause that names a unit by its number; empty without one.

    A comparison names a unit if it has a constant, and a variable that stands for a unit in an atom.
    """
    conditions: list[Conjunct] = [conjunct for _, condition in clause.head_elements for conjunct in condition]
    conjuncts = [*clause.body, *conditions]
    units: set[str] = set()
    for literal in literals(conjuncts):
        for position in COLUMNS.get(literal.signature, Columns()).units:
            argument = literal.arguments[position]
            units.update(variables(argument))
            if _has_constant(argument):
                return literal.text
    tests = (conjunct for conjunct in conjuncts if isinstance(conjunct, Test))
    return next(
        (
            test.text
            for test in tests
            if _has_constant(test.ast) and not units.isdisjoint(variables(test.ast))
        ),
        "",
    )


def _has_constant(syntax_node: AST) -> bool:
    """Whether a node of the syntax tree has a number, text or word in it."""
    return any(node.ast_type == ASTType.SymbolicTerm for node in nodes(syntax_node))
