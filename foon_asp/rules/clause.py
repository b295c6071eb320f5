"""One rule of an encoding taken apart: its head, and the parts of its body."""

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

from foon_asp.grounding.parsing import nodes
from foon_asp.grounding.stated import Loaded, Stated
from foon_asp.network import Source

Signature = tuple[str, int]
Constants = Mapping[str, Symbol | None]  # by name; None where the value is not known

_FLIPPED = {
    ComparisonOperator.LessThan: ComparisonOperator.GreaterThan,
    ComparisonOperator.GreaterThan: ComparisonOperator.LessThan,
    ComparisonOperator.LessEqual: ComparisonOperator.GreaterEqual,
    ComparisonOperator.GreaterEqual: ComparisonOperator.LessEqual,
}
_COMPARING = {
    ComparisonOperator.GreaterThan: gt,
    ComparisonOperator.LessThan: lt,
    ComparisonOperator.LessEqual: le,
    ComparisonOperator.GreaterEqual: ge,
    ComparisonOperator.NotEqual: ne,
    ComparisonOperator.Equal: eq,
}
_NUMBERS = {AggregateFunction.Count, AggregateFunction.Sum, AggregateFunction.SumPlus}


class Literal(NamedTuple):
    """An atom in a body: as it is, negated once (``not p``) or twice (``not not p``).

    The name of an atom with ``-`` begins with a minus.
    """

    signature: Signature
    arguments: tuple[AST, ...]
    negations: int
    text: str

    @property
    def positive(self) -> bool:
        """Whether it has no ``not``, and so gives its variables their values."""
        return not self.negations

    @property
    def single(self) -> bool:
        """Whether it is one atom once its variables have values; an interval stands for any number."""
        within = (node for argument in self.arguments for node in nodes(argument))
        return all(node.ast_type != ASTType.Interval for node in within)


class Test(NamedTuple):
    """A comparison, or ``#true`` and ``#false``; ``holds`` says whether it does where that is known."""

    ast: AST
    holds: bool | None
    text: str


class Conditional(NamedTuple):
    """``literal : condition`` in a body: the literal has to hold wherever the condition does."""

    literal: "Literal | Test | Strange"
    condition: "tuple[Part, ...]"
    text: str


class Element(NamedTuple):
    """One element of an aggregate: the terms that it adds, and when."""

    terms: tuple[AST, ...]
    condition: "tuple[Part, ...]"


class Guard(NamedTuple):
    """What the value of an aggregate is compared with: the aggregate on the left, the term on the right."""

    comparison: ComparisonOperator
    term: AST


class Aggregate(NamedTuple):
    """An aggregate in a body; ``holds`` says whether it does where its guards alone tell."""

    function: AggregateFunction
    elements: tuple[Element, ...]
    guards: tuple[Guard, ...]
    negations: int
    holds: bool | None
    text: str


class Strange(NamedTuple):
    """Anything else."""

    text: str


Part = Literal | Test | Conditional | Aggregate | Strange


class Clause(NamedTuple):
    """A rule without pools, taken apart.

    ``head`` has the atom of a plain rule, is ``None`` where there is no head, and ``others`` has the atoms of
    a head that leaves a choice, each with its condition: a choice, a disjunction or a negated head.
    """

    head: Literal | None
    others: tuple[tuple[Literal, tuple[Part, ...]], ...]
    plain: bool
    body: tuple[Part, ...]
    source: Source
    number: int

    @property
    def constraint(self) -> bool:
        """Whether it has no head."""
        return self.plain and self.head is None

    @property
    def heads(self) -> list[Literal]:
        """The atoms of its head."""
        return [atom for atom in (self.head, *(atom for atom, _ in self.others)) if atom is not None]


def clauses(rule: AST, number: int, constants: Constants) -> Iterator[Clause]:
    """Take a rule apart: one clause for each way in which its pools can be read.

    ``number`` tells the clauses of one rule from those of another.
    """
    source = place(rule)
    for each in rule.unpool(condition=True):
        reader = _Reader(constants)
        body = reader.parts(each.body)
        head = each.head
        if head.ast_type == ASTType.Literal and head.sign == Sign.NoSign:
            if head.atom.ast_type == ASTType.BooleanConstant and not head.atom.value:
                yield Clause(None, (), True, body, source, number)
                continue
            atom = reader.literal(head)
            if isinstance(atom, Literal) and not atom.signature[0].startswith("-"):
                yield Clause(atom, (), True, body, source, number)
                continue
        yield Clause(None, tuple(reader.head_atoms(head)), False, body, source, number)


def place(statement: AST) -> Source:
    """Return where a statement begins."""
    begin = statement.location.begin
    return Source(begin.filename, begin.line, begin.column)


def written(statement: AST, rules: Loaded | None = None) -> str:
    """Return a statement on one line: as written, where it is in a file or in these rules."""
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


def _is_plain(term: AST) -> bool:
    """Whether a term calculates nothing, so that it is what clingo reads."""
    return all(node.ast_type != ASTType.BinaryOperation for node in nodes(term))


def value(term: AST, constants: Constants) -> Symbol | None:
    """Return the value of a term without variables and arithmetic, ``None`` where it is not so simple."""
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
    """Return a text or a number; ``None`` for anything else, such as a word without quotes."""
    if symbol.type is SymbolType.Number:
        return symbol.number
    return symbol.string if symbol.type is SymbolType.String else None


def factors(term: AST) -> list[AST]:
    """Return the two factors of a product, or a term itself."""
    product = (ASTType.BinaryOperation, BinaryOperator.Multiplication)
    is_product = (term.ast_type, getattr(term, "operator_type", None)) == product
    return [term.left, term.right] if is_product else [term]


def constant_values(definitions: Iterable[AST], settings: Sequence[str]) -> dict[str, Symbol | None]:
    """Give the constants of ``#const`` statements, as the settings ``name=value`` for clingo change them."""
    texts: dict[str, str | None] = {}
    for definition in definitions:
        name = definition.name
        plain = definition.is_default and name not in texts and _is_plain(definition.value)
        texts[name] = str(definition.value) if plain else None
    for setting in settings:
        name, _, text = setting.partition("=")
        if texts.get(name) is not None:
            texts[name] = text
    values: dict[str, Symbol | None] = {}
    for name, written in texts.items():
        try:
            symbol = None if written is None else parse_term(written)
        except RuntimeError:
            symbol = None
        if symbol is not None and symbol.type is SymbolType.Function:
            # a word may be the name of another constant, and so may one within it
            symbol = None if symbol.arguments or symbol.name in texts else symbol
        values[name] = symbol
    return values


def variables(*pieces: AST) -> Iterator[str]:
    """Give the names of the variables in pieces of a rule, but not ``_``, which is another one each time."""
    within = (node for piece in pieces for node in nodes(piece))
    return (node.name for node in within if node.ast_type == ASTType.Variable and node.name != "_")


def global_variables(part: Part) -> Iterator[str]:
    """Give the variables of a part that the rule has as a whole; those in conditions may be of their own."""
    if isinstance(part, Literal):
        return variables(*part.arguments)
    if isinstance(part, Test):
        return variables(part.ast)
    return variables(*(guard.term for guard in part.guards)) if isinstance(part, Aggregate) else iter(())


def literals(parts: Iterable[Part]) -> Iterator[Literal]:
    """Return all literals in parts of a body, those in conditions and aggregates, too."""
    for part in parts:
        if isinstance(part, Literal):
            yield part
        elif isinstance(part, Conditional):
            yield from literals((part.literal, *part.condition))
        elif isinstance(part, Aggregate):
            for element in part.elements:
                yield from literals(element.condition)


class _Reader:
    """Takes parts of a rule apart, with what is known of its constants."""

    def __init__(self, constants: Constants) -> None:
        self._constants = constants

    def parts(self, body: Iterable[AST]) -> tuple[Part, ...]:
        return tuple(map(self.part, body))

    def part(self, node: AST) -> Part:
        if node.ast_type == ASTType.ConditionalLiteral:
            literal = self.literal(node.literal)
            return Conditional(literal, self.parts(node.condition), str(node))
        if node.ast_type == ASTType.Literal and node.atom.ast_type in {
            ASTType.Aggregate,
            ASTType.BodyAggregate,
        }:
            return self._aggregate(node)
        return self.literal(node)

    def literal(self, node: AST) -> Literal | Test | Strange:
        text = str(node)
        if node.ast_type != ASTType.Literal:
            return Strange(text)
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
        return Strange(text)

    def _compare(self, comparison: AST) -> bool | None:
        """Return whether a comparison holds, if all its terms are known."""
        known = [
            value(term, self._constants) for term in (comparison.term, *(g.term for g in comparison.guards))
        ]
        if None in known:
            return None
        symbols = [symbol for symbol in known if symbol is not None]
        operators = [guard.comparison for guard in comparison.guards]
        return all(
            compared(left, operator, right)
            for left, operator, right in zip(symbols, operators, symbols[1:], strict=False)
        )

    def _aggregate(self, node: AST) -> Aggregate:
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
                Element((), (self.literal(each.literal), *self.parts(each.condition)))
                for each in atom.elements
            )
        else:
            function = AggregateFunction(atom.function)
            elements = tuple(Element(tuple(each.terms), self.parts(each.condition)) for each in atom.elements)
        holds = [self._beyond(function, guard) for guard in guards]
        sure = False if False in holds else True if holds and all(holds) else None
        if sure is not None and node.sign == Sign.Negation:
            sure = not sure
        return Aggregate(function, elements, tuple(guards), int(node.sign), sure, str(node))

    def _beyond(self, function: AggregateFunction, guard: Guard) -> bool | None:
        """Return whether a sum or a count keeps to a guard that is beyond all numbers."""
        bound = value(guard.term, self._constants)
        if function not in _NUMBERS or bound not in (Infimum, Supremum):
            return None
        return compared(Number(0), guard.comparison, bound)

    def head_atoms(self, head: AST) -> Iterator[tuple[Literal, tuple[Part, ...]]]:
        """Return the atoms of a head that is not plain, with their conditions."""
        if head.ast_type == ASTType.Literal:
            atom = self.literal(head)
            if isinstance(atom, Literal):
                yield atom._replace(negations=0), ()
        for each in getattr(head, "elements", ()):
            conditional = each if each.ast_type == ASTType.ConditionalLiteral else each.condition
            if isinstance(conditional, AST) and conditional.ast_type == ASTType.ConditionalLiteral:
                atom = self.literal(conditional.literal)
                if isinstance(atom, Literal):
                    yield atom._replace(negations=0), self.parts(conditional.condition)


def compared(left: Symbol, comparison: int, right: Symbol) -> bool:
    """Compare two values as clingo does: numbers before words before texts, and so on."""
    return bool(_COMPARING[ComparisonOperator(comparison)](left, right))
