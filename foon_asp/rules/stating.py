"""Texts of constraints for clingo: files, rules, and ready-made constraints with renamed predicates."""

from collections.abc import Collection, Sequence
from typing import cast

from clingo.ast import AST, ASTType, Transformer, parse_string
from clingo.symbol import Function, SymbolType

from foon_asp.encoding.encoding import EXTENDED, PUBLIC, Signature, constant_value, read_encoding
from foon_asp.encoding.parsing import parse
from foon_asp.encoding.stated import Loaded, Stated
from foon_asp.errors import UserError
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, RuleText


def load_constraints(constraints: Sequence[Constraint]) -> dict[Constraint, Loaded]:
    """Return what clingo loads for each constraint: a file or a text.

    A path is returned as it is. Rules given as text are called ``rule 1``, ``rule 2`` and so on; ready-made
    constraints with constants of their own are called ``use 1``, ``use 2``. Raises :class:`UserError` for
    constants that a ready-made constraint does not have, and for wrong values.
    """
    loaded_by_constraint: dict[Constraint, Loaded] = {}
    rules = uses = 0
    for constraint in constraints:
        if constraint in loaded_by_constraint:
            continue
        if isinstance(constraint, RuleText):
            rules += 1
            loaded_by_constraint[constraint] = Stated(f"rule {rules}", constraint.text)
        elif isinstance(constraint, LibraryUse):
            uses += 1
            loaded_by_constraint[constraint] = _renamed_constraint(constraint, uses)
        else:
            loaded_by_constraint[constraint] = constraint
    return loaded_by_constraint


def _renamed_constraint(use: LibraryUse, number: int) -> Stated:
    """Return a ready-made constraint with its constants set, as text in which names end in a number.

    The constraint's own constants and predicates are renamed, so that it can be used twice. ``number`` is the
    number at the end of the new names. Each statement is on the line where it begins in the file. Raises
    :class:`UserError` for an unknown constant or a wrong value.
    """
    encoding = read_encoding(use.file)
    values = use.constants
    for name in values:
        if name not in encoding.constants:
            names_known = ", ".join(encoding.constants) or "none"
            raise UserError(f"{use}: {use.file.stem} has no constant {name!r}; it has {names_known}")
    own = {*encoding.defined, *encoding.declared} - PUBLIC - EXTENDED
    renamer = _Renamer(own, encoding.constants, number)
    statements: list[AST] = []
    parse(use.file, statements.append, lambda *_: None)
    lines: dict[int, list[str]] = {}
    for statement in statements:
        if statement.ast_type in {ASTType.Comment, ASTType.Program}:
            continue
        if statement.ast_type == ASTType.Definition and statement.name in values:
            default, value = str(statement.value), values[statement.name]
            changed = statement.update(value=_parse_term(constant_value(statement.name, default, value)))
        else:
            changed = statement
        lines.setdefault(statement.location.begin.line, []).append(str(renamer.visit(changed)))
    text = "\n".join(" ".join(lines.get(line, ())) for line in range(1, max(lines, default=0) + 1))
    names = {renamer.new_name(name): name for name in encoding.constants}
    return Stated(f"use {number}", f"{text}\n", use.file, use.written, tuple(names.items()))


def _parse_term(text: str) -> AST:
    """Return a term as syntax tree."""
    statements: list[AST] = []
    parse_string(f"#const _value = {text}.", statements.append)
    return cast("AST", statements[-1].value)


class _Renamer(Transformer):
    """Rewriter that renames some predicates and constants: ``tainted`` becomes ``_tainted_1``.

    ``predicates`` and ``constants`` are those to rename. ``number`` is the number at the end of new names.
    """

    def __init__(self, predicates: Collection[Signature], constants: Collection[str], number: int) -> None:
        """Keep the predicates and constants to rename."""
        self._predicates, self._constants, self._number = predicates, constants, number

    def new_name(self, name: str) -> str:
        """Return the new name, which begins with ``_`` as all reserved names do."""
        return f"_{name.lstrip('_')}_{self._number}"

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        """Return an atom, with the new name of its predicate if it has one."""
        return atom.update(symbol=self._rename_symbol(atom.symbol))

    def _rename_symbol(self, symbol: AST) -> AST:
        """Return the symbol of an atom, with the new name of its predicate if it has one."""
        if symbol.ast_type == ASTType.UnaryOperation:  # classical negation
            return symbol.update(argument=self._rename_symbol(symbol.argument))
        if symbol.ast_type == ASTType.Pool:
            return symbol.update(arguments=[self._rename_symbol(argument) for argument in symbol.arguments])
        own = (symbol.name, len(symbol.arguments)) in self._predicates
        name = self.new_name(symbol.name) if own else symbol.name
        return symbol.update(name=name, arguments=self.visit_sequence(symbol.arguments))

    def visit_SymbolicTerm(self, term: AST) -> AST:  # noqa: N802
        """Return a constant under its new name if it has one; any other term unchanged."""
        symbol = term.symbol
        if symbol.type is SymbolType.Function and symbol.name in self._constants and not symbol.arguments:
            return term.update(symbol=Function(self.new_name(symbol.name)))
        return term

    def visit_Definition(self, definition: AST) -> AST:  # noqa: N802
        """Return a ``#const`` statement with new names."""
        return definition.update(name=self.new_name(definition.name), value=self.visit(definition.value))

    def visit_Defined(self, defined: AST) -> AST:  # noqa: N802
        """Return ``#defined``, with the new name of its predicate if it has one."""
        return self._rename_signature(defined)

    def visit_ShowSignature(self, shown: AST) -> AST:  # noqa: N802
        """Return ``#show``, with the new name of its predicate if it has one."""
        return self._rename_signature(shown)

    def _rename_signature(self, statement: AST) -> AST:
        """Return ``#defined`` or ``#show``, with the new name of its predicate if it has one."""
        own = (statement.name, statement.arity) in self._predicates
        return statement.update(name=self.new_name(statement.name)) if own else statement
