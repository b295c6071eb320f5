"""What clingo is given for constraints: files, rules, and ready-made constraints under names of their own."""

from collections.abc import Collection, Sequence
from typing import cast

from clingo.ast import AST, ASTType, Transformer, parse_string
from clingo.symbol import Function, SymbolType

from foon_asp.encoding.encoding import EXTENDED, PUBLIC, Signature, constant_value, read_encoding
from foon_asp.errors import UserError
from foon_asp.grounding.parsing import parse
from foon_asp.grounding.stated import Loaded, Stated
from foon_asp.rules.constraint import Constraint, LibraryUse, RuleText


def loaded(constraints: Sequence[Constraint]) -> dict[Constraint, Loaded]:
    """Return what is loaded for each of some constraints, found before.

    Rules are numbered in their order, and so are ready-made constraints with constants of their own. Raises
    :class:`UserError` for constants that such a constraint has not, and for values that do not fit.
    """
    found: dict[Constraint, Loaded] = {}
    rules = uses = 0
    for constraint in constraints:
        if constraint in found:
            continue
        if isinstance(constraint, RuleText):
            rules += 1
            found[constraint] = Stated(f"rule {rules}", constraint.text)
        elif isinstance(constraint, LibraryUse):
            uses += 1
            found[constraint] = _renamed(constraint, uses)
        else:
            found[constraint] = constraint
    return found


def _renamed(use: LibraryUse, number: int) -> Stated:
    """Return a ready-made constraint with its constants set, and names of its own for them and its helpers.

    Each statement is on the line on which it begins in the file.
    """
    encoding = read_encoding(use.file)
    given = use.constants
    for name in given:
        if name not in encoding.constants:
            known = ", ".join(encoding.constants) or "none"
            raise UserError(f"{use}: {use.file.stem} has no constant {name!r}; it has {known}")
    own = {*encoding.defined, *encoding.declared} - PUBLIC - EXTENDED
    renaming = _Renaming(own, encoding.constants, number)
    statements: list[AST] = []
    parse(use.file, statements.append, lambda *_: None)
    lines: dict[int, list[str]] = {}
    for statement in statements:
        if statement.ast_type in {ASTType.Comment, ASTType.Program}:
            continue
        if statement.ast_type == ASTType.Definition and statement.name in given:
            default, value = str(statement.value), given[statement.name]
            said = statement.update(value=_term(constant_value(statement.name, default, value)))
        else:
            said = statement
        lines.setdefault(statement.location.begin.line, []).append(str(renaming.visit(said)))
    text = "\n".join(" ".join(lines.get(line, ())) for line in range(1, max(lines, default=0) + 1))
    names = {renaming.name(name): name for name in encoding.constants}
    return Stated(f"use {number}", f"{text}\n", use.file, use.written, tuple(names.items()))


def _term(text: str) -> AST:
    statements: list[AST] = []
    parse_string(f"#const _value = {text}.", statements.append)
    return cast("AST", statements[-1].value)


class _Renaming(Transformer):
    """Gives predicates and constants other names, wherever they stand."""

    def __init__(self, predicates: Collection[Signature], constants: Collection[str], number: int) -> None:
        self._predicates, self._constants, self._number = predicates, constants, number

    def name(self, name: str) -> str:
        """Return the other name, which begins as all names do that are ours."""
        return f"_{name.lstrip('_')}_{self._number}"

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        return atom.update(symbol=self._symbol(atom.symbol))

    def _symbol(self, symbol: AST) -> AST:
        if symbol.ast_type == ASTType.UnaryOperation:  # classical negation
            return symbol.update(argument=self._symbol(symbol.argument))
        if symbol.ast_type == ASTType.Pool:
            return symbol.update(arguments=[self._symbol(each) for each in symbol.arguments])
        own = (symbol.name, len(symbol.arguments)) in self._predicates
        name = self.name(symbol.name) if own else symbol.name
        return symbol.update(name=name, arguments=self.visit_sequence(symbol.arguments))

    def visit_SymbolicTerm(self, term: AST) -> AST:  # noqa: N802
        symbol = term.symbol
        if symbol.type is SymbolType.Function and symbol.name in self._constants and not symbol.arguments:
            return term.update(symbol=Function(self.name(symbol.name)))
        return term

    def visit_Definition(self, definition: AST) -> AST:  # noqa: N802
        return definition.update(name=self.name(definition.name), value=self.visit(definition.value))

    def visit_Defined(self, defined: AST) -> AST:  # noqa: N802
        return self._signature(defined)

    def visit_ShowSignature(self, shown: AST) -> AST:  # noqa: N802
        return self._signature(shown)

    def _signature(self, statement: AST) -> AST:
        own = (statement.name, statement.arity) in self._predicates
        return statement.update(name=self.name(statement.name)) if own else statement
