"""Rules of an encoding taken apart: the head of a rule, and the conjuncts of its body."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from operator import eq, ge, gt, le, lt, ne
from pathlib import Path
from typing import NamedTuple

from clingo import Infimum, Supremum, parse_term
from clingo.ast import (
    AST,
    AggregateFunction,
    ASTType,
    BinaryOperator,
    ComparisonOperator,
    Sign,
    UnaryOperator,
)
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.encoding.parsing import nodes
from foon_asp.encoding.stated import Loaded, Stated
from foon_asp.network import Source

Signature = tuple[str, int]
Constants = Mapping[str, Symbol | None]  # by name; None where the value is unknown

_FLIPPED = {
    ComparisonOperator.LessThan: ComparisonOperator.GreaterThan,
    ComparisonOperator.GreaterThan: ComparisonOperator.LessThan,
    ComparisonOperator.LessEqual: ComparisonOperator.GreaterEqual,
    ComparisonOperator.GreaterEqual: ComparisonOperator.LessEqual,
}
_OPERATORS = {
    ComparisonOperator.GreaterThan: gt,
    ComparisonOperator.LessThan: lt,
    ComparisonOperator.LessEqual: le,
    ComparisonOperator.GreaterEqual: ge,
    ComparisonOperator.NotEqual: ne,
    ComparisonOperator.Equal: eq,
}
_NUMBER_AGGREGATES = {AggregateFunction.Count, AggregateFunction.Sum, AggregateFunction.SumPlus}


class Literal(NamedTuple):
    """A literal: an atom as it is, negated once (``not p``) or negated twice (``not not p``).

    ``negations`` is 0, 1 or 2. The predicate name of a classically negated atom (``-p``) begins with a minus.
    ``text`` is the literal as clingo prints it.
    """

    signature: Signature
    arguments: tuple[AST, ...]
    negations: int
    text: str

    @property
    def positive(self) -> bool:
        """Whether the literal has no ``not``, so that it binds its variables."""
        return not self.negations


class Test(NamedTuple):
    """A comparison, ``#true`` or ``#false`` in a body, with or without ``not``.

    ``holds`` is the truth value. It is ``None`` if the comparison has a variable, or a term with an
    operation.
    """

    ast: AST
    holds: bool | None
    text: str


class Conditional(NamedTuple):
    """``literal : condition`` in a body: the literal has to hold wherever the condition does."""

    literal: "Literal | Test | UnknownConjunct"
    condition: "tuple[Conjunct, ...]"
    text: str


class Element(NamedTuple):
    """An element ``terms : condition`` of an aggregate.

    The aggregate counts or adds the terms where the condition holds.
    """

    terms: tuple[AST, ...]
    condition: "tuple[Conjunct, ...]"


class Guard(NamedTuple):
    """A guard of an aggregate, such as ``> 9``: the value of the aggregate is compared with a term."""

    comparison: ComparisonOperator
    term: AST


class Aggregate(NamedTuple):
    """An aggregate in a body.

    ``negations`` is the number of ``not`` before it: 0, 1 or 2. ``holds`` is the truth value, including any
    ``not``. It is ``None`` unless the guards alone decide it, as in ``#count { ... } < #sup``.
    """

    function: AggregateFunction
    elements: tuple[Element, ...]
    guards: tuple[Guard, ...]
    negations: int
    holds: bool | None
    text: str


class UnknownConjunct(NamedTuple):
    """A conjunct of any other kind, such as a theory atom; only its text is kept."""

    text: str


Conjunct = Literal | Test | Conditional | Aggregate | UnknownConjunct


class Clause(NamedTuple):
    """A rule without pools, taken apart.

    ``plain``: whether the rule is a constraint, or its head is one atom without negation, minus or choice.
    ``head``: the head atom of a plain rule; ``None`` for a constraint, and for a rule that is not plain.
    ``head_elements``: the head atoms of a rule that is not plain, each with its condition.
    ``number``: a number for the rule; the clauses of a rule with pools have the same number.
    ``ast``: the syntax tree of the clause; its body has one node for each conjunct of ``body``.
    """

    head: Literal | None
    head_elements: tuple[tuple[Literal, tuple[Conjunct, ...]], ...]
    plain: bool
    body: tuple[Conjunct, ...]
    source: Source
    number: int
    ast: AST

    @property
    def is_constraint(self) -> bool:
        """Whether the clause is a constraint, which has no head."""
        return self.plain and self.head is None

    @property
    def heads(self) -> list[Literal]:
        """All atoms in the head; empty for a constraint."""
        return [atom for atom in (self.head, *(atom for atom, _ in self.head_elements)) if atom is not None]


def clauses(rule: AST, number: int, constants: Constants) -> Iterator[Clause]:
    """Unpool a rule: yield one clause for each choice from its pools, such as ``p(1;2)``.

    ``number`` is stored in each clause, so that the rule of a clause can be found again. ``constants`` serve
    to evaluate comparisons.
    """
    source = source_of(rule)
    for clause in rule.unpool(condition=True):
        reader = _Reader(constants)
        body = reader.conjuncts(clause.body)
        head = clause.head
        if head.ast_type == ASTType.Literal and head.sign == Sign.NoSign:
            if head.atom.ast_type == ASTType.BooleanConstant and not head.atom.value:
                yield Clause(None, (), True, body, source, number, clause)
                continue
            atom = reader.literal(head)
            if isinstance(atom, Literal) and not atom.signature[0].startswith("-"):
                yield Clause(atom, (), True, body, source, number, clause)
                continue
        yield Clause(None, tuple(reader.head_atoms(head)), False, body, source, number, clause)


def source_of(statement: AST) -> Source:
    """Return the file, line and column where a statement begins."""
    begin = statement.location.begin
    return Source(begin.filename, begin.line, begin.column)


def statement_text(statement: AST, rules: Loaded | None = None) -> str:
    """Return a statement on one line, as it is written in its ``.lp`` file or in the text of ``rules``.

    A statement that is from neither is returned as clingo prints it.
    """
    begin, end = statement.location.begin, statement.location.end
    if isinstance(rules, Stated) and begin.filename == rules.place:
        content = rules.text.encode("utf-8")
    elif begin.filename.endswith(".lp") and Path(begin.filename).is_file():
        content = Path(begin.filename).read_bytes()
    else:
        return str(statement)
    lines = content.split(b"\n")[begin.line - 1 : end.line]
    lines[-1] = lines[-1][: end.column - 1]  # columns of clingo count bytes
    lines[0] = lines[0][begin.column - 1 :]
    return " ".join(b" ".join(lines).decode("utf-8", "replace").split())


def _has_no_operation(term: AST) -> bool:
    """Whether a term has no binary operation such as ``+``, so that its text is its value."""
    return all(node.ast_type != ASTType.BinaryOperation for node in nodes(term))


def value(term: AST, constants: Constants) -> Symbol | None:
    """Return the value of a number, text, word, ``#sup``, ``#inf`` or constant; ``None`` for any other term.

    A number may stand after a minus. If a constant's value is unknown, the result is ``None``.
    """
    if term.ast_type == ASTType.SymbolicTerm:
        symbol: Symbol = term.symbol
        if symbol.type is SymbolType.Function and not symbol.arguments and symbol.name in constants:
            return constants[symbol.name]
        return symbol if symbol.type is not SymbolType.Function or not symbol.arguments else None
    if term.ast_type == ASTType.UnaryOperation and term.operator_type == UnaryOperator.Minus:
        inner = value(term.argument, constants)
        return Number(-inner.number) if inner is not None and inner.type is SymbolType.Number else None
    return None


def plain_value(symbol: Symbol) -> str | int | None:
    """Return the value of a number or of a text in quotes, without the quotes; ``None`` for others.

    For example, it is ``None`` for a word without quotes, ``#sup`` and ``#inf``.
    """
    if symbol.type is SymbolType.Number:
        return symbol.number
    return symbol.string if symbol.type is SymbolType.String else None


def factors(term: AST) -> list[AST]:
    """Return the two factors of a product; any other term is returned as the only factor.

    A factor may be a product itself.
    """
    product = (ASTType.BinaryOperation, BinaryOperator.Multiplication)
    is_product = (term.ast_type, getattr(term, "operator_type", None)) == product
    return [term.left, term.right] if is_product else [term]


def constant_values(definitions: Iterable[AST], settings: Sequence[str]) -> dict[str, Symbol | None]:
    """Return the values of constants by name, from ``#const`` statements and settings ``name=value``.

    A setting replaces a default value; settings of other names are ignored. A value is ``None`` if only
    clingo can tell it. Examples are arithmetic, the name of another constant, and a constant with two
    statements.
    """
    texts: dict[str, str | None] = {}
    for definition in definitions:
        name = definition.name
        plain = definition.is_default and name not in texts and _has_no_operation(definition.value)
        texts[name] = str(definition.value) if plain else None
    for setting in settings:
        name, _, text = setting.partition("=")
        if texts.get(name) is not None:
            texts[name] = text
    values: dict[str, Symbol | None] = {}
    for name, value_text in texts.items():
        try:
            symbol = None if value_text is None else parse_term(value_text)
        except RuntimeError:
            symbol = None
        if symbol is not None and symbol.type is SymbolType.Function:
            # a word may be the name of another constant, and so may one within it
            symbol = None if symbol.arguments or symbol.name in texts else symbol
        values[name] = symbol
    return values


def variables(*syntax_nodes: AST) -> Iterator[str]:
    """Yield the names of the variables in nodes of a syntax tree, each as often as it occurs.

    The anonymous variable ``_`` is left out.
    """
    inner_nodes = (node for syntax_node in syntax_nodes for node in nodes(syntax_node))
    return (node.name for node in inner_nodes if node.ast_type == ASTType.Variable and node.name != "_")


def global_variables(conjunct: Conjunct) -> Iterator[str]:
    """Yield the names of the global variables of a conjunct, with repeats.

    They are the variables of a literal, a comparison or a guard. Variables in the elements of an aggregate
    and in a conditional literal may be local, and are left out.
    """
    if isinstance(conjunct, Literal):
        return variables(*conjunct.arguments)
    if isinstance(conjunct, Test):
        return variables(conjunct.ast)
    return (
        variables(*(guard.term for guard in conjunct.guards)) if isinstance(conjunct, Aggregate) else iter(())
    )


def literals(conjuncts: Iterable[Conjunct]) -> Iterator[Literal]:
    """Yield all literals in conjuncts, including those in conditions and aggregates."""
    for conjunct in conjuncts:
        if isinstance(conjunct, Literal):
            yield conjunct
        elif isinstance(conjunct, Conditional):
            yield from literals((conjunct.literal, *conjunct.condition))
        elif isinstance(conjunct, Aggregate):
            for element in conjunct.elements:
                yield from literals(element.condition)


class _Reader:
    """Reader that turns the syntax trees of bodies and heads into conjuncts and literals.

    ``constants`` are the values that it uses to evaluate comparisons.
    """

    def __init__(self, constants: Constants) -> None:
        """Keep the values of constants."""
        self._constants = constants

    def conjuncts(self, body: Iterable[AST]) -> tuple[Conjunct, ...]:
        """Return the conjuncts of a body or condition, in order."""
        return tuple(map(self.conjunct, body))

    def conjunct(self, node: AST) -> Conjunct:
        """Return a node of a body as a conjunct: an aggregate, a conditional literal, or another one."""
        if node.ast_type == ASTType.ConditionalLiteral:
            literal = self.literal(node.literal)
            return Conditional(literal, self.conjuncts(node.condition), str(node))
        if node.ast_type == ASTType.Literal and node.atom.ast_type in {
            ASTType.Aggregate,
            ASTType.BodyAggregate,
        }:
            return self._aggregate(node)
        return self.literal(node)

    def literal(self, node: AST) -> Literal | Test | UnknownConjunct:
        """Return a literal over a predicate, or a test; for any other node, ``UnknownConjunct``."""
        text = str(node)
        if node.ast_type != ASTType.Literal:
            return UnknownConjunct(text)
        atom, negations = node.atom, int(node.sign)
        if atom.ast_type == ASTType.SymbolicAtom:
            symbol, sign = atom.symbol, ""
            if symbol.ast_type == ASTType.UnaryOperation:
                symbol, sign = symbol.argument, "-"
            if symbol.ast_type == ASTType.Function:
                name = sign + symbol.name
                return Literal((name, len(symbol.arguments)), tuple(symbol.arguments), negations, text)
        elif atom.ast_type == ASTType.BooleanConstant:
            return Test(node, bool(atom.value) != (negations == 1), text)
        elif atom.ast_type == ASTType.Comparison:
            holds = self._compare(atom)
            return Test(node, None if holds is None else holds != (negations == 1), text)
        return UnknownConjunct(text)

    def _compare(self, comparison: AST) -> bool | None:
        """Return whether a chain of comparisons holds; ``None`` if the value of a term is unknown."""
        values = [
            value(term, self._constants) for term in (comparison.term, *(g.term for g in comparison.guards))
        ]
        if None in values:
            return None
        symbols = [symbol for symbol in values if symbol is not None]
        operators = [guard.comparison for guard in comparison.guards]
        return all(
            comparison_holds(first, operator, second)
            for first, operator, second in zip(symbols, operators, symbols[1:], strict=False)
        )

    def _aggregate(self, node: AST) -> Aggregate:
        """Return an aggregate of a body.

        A left guard is turned around, so that each guard stands on the right. ``{ a; b }`` becomes a count of
        elements without terms.
        """
        atom = node.atom
        guards = []
        if atom.left_guard is not None:
            operator = ComparisonOperator(atom.left_guard.comparison)
            guards.append(Guard(_FLIPPED.get(operator, operator), atom.left_guard.term))
        if atom.right_guard is not None:
            guards.append(Guard(ComparisonOperator(atom.right_guard.comparison), atom.right_guard.term))
        if atom.ast_type == ASTType.Aggregate:
            function = AggregateFunction.Count
            elements = tuple(
                Element((), (self.literal(element.literal), *self.conjuncts(element.condition)))
                for element in atom.elements
            )
        else:
            function = AggregateFunction(atom.function)
            elements = tuple(
                Element(tuple(element.terms), self.conjuncts(element.condition)) for element in atom.elements
            )
        guard_values = [self._holds_at_infinity(function, guard) for guard in guards]
        holds = False if False in guard_values else True if guard_values and all(guard_values) else None
        if holds is not None and node.sign == Sign.Negation:
            holds = not holds
        return Aggregate(function, elements, tuple(guards), int(node.sign), holds, str(node))

    def _holds_at_infinity(self, function: AggregateFunction, guard: Guard) -> bool | None:
        """Return whether a sum or count satisfies a guard ``#inf`` or ``#sup``.

        Return ``None`` for other guards and other aggregates.
        """
        bound = value(guard.term, self._constants)
        if function not in _NUMBER_AGGREGATES or bound not in (Infimum, Supremum):
            return None
        return comparison_holds(Number(0), guard.comparison, bound)

    def head_atoms(self, head: AST) -> Iterator[tuple[Literal, tuple[Conjunct, ...]]]:
        """Yield the atoms of a head that is not plain, each with its condition; ``not`` is dropped.

        Anything else in the head, such as a comparison, is left out.
        """
        if head.ast_type == ASTType.Literal:
            atom = self.literal(head)
            if isinstance(atom, Literal):
                yield atom._replace(negations=0), ()
        for element in getattr(head, "elements", ()):
            conditional = element if element.ast_type == ASTType.ConditionalLiteral else element.condition
            if isinstance(conditional, AST) and conditional.ast_type == ASTType.ConditionalLiteral:
                atom = self.literal(conditional.literal)
                if isinstance(atom, Literal):
                    yield atom._replace(negations=0), self.conjuncts(conditional.condition)


def comparison_holds(first: Symbol, comparison: int, second: Symbol) -> bool:
    """Return whether a comparison of two values holds, in clingo's order: numbers, then words, then texts."""
    return bool(_OPERATORS[ComparisonOperator(comparison)](first, second))
