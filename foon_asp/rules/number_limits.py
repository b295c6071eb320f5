"""Where numbers that rules calculate leave clingo's 32 bits, which it does not say: as rules that find it."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import count

from clingo.ast import (
    AST,
    AggregateFunction,
    ASTType,
    BinaryOperator,
    ComparisonOperator,
    Sign,
    Transformer,
    UnaryOperator,
)
from clingo.symbol import SymbolType

from foon_asp.encoding.facts import quote
from foon_asp.grounding.exact import LARGEST, is_beyond
from foon_asp.grounding.number_checks import BEYOND
from foon_asp.grounding.parsing import nodes
from foon_asp.rules.clause import variables

_BINARY = {
    BinaryOperator.Plus: "+",
    BinaryOperator.Minus: "-",
    BinaryOperator.Multiplication: "*",
    BinaryOperator.Division: "/",
    BinaryOperator.Modulo: "\\",
    BinaryOperator.Power: "**",
    BinaryOperator.And: "&",
    BinaryOperator.Or: "?",
    BinaryOperator.XOr: "^",
}
_UNARY = {UnaryOperator.Minus: "neg", UnaryOperator.Absolute: "abs", UnaryOperator.Negation: "~"}
_LINEAR = {BinaryOperator.Plus, BinaryOperator.Minus, BinaryOperator.Multiplication}
_SUMS = {AggregateFunction.Sum, AggregateFunction.SumPlus}
_AGGREGATES = {ASTType.BodyAggregate, ASTType.HeadAggregate}
_CALCULATES = re.compile(r"[+*/\\^&?~|]|(?<!:)-|#sum")  # what every rule has that calculates, and others

Head = Callable[[AST], str]
"""Gives the head of a rule that holds where a term leaves clingo's numbers."""


def number_checks(statements: Iterable[AST]) -> str:
    """Return rules that derive ``_beyond`` for terms that leave clingo's numbers; nothing where none can."""
    return "".join(f"{text}\n" for _, text in beyond(statements, _placed))


def _placed(term: AST) -> str:
    begin = term.location.begin
    said = "the sum" if term.ast_type in _AGGREGATES else str(term).removeprefix("(").removesuffix(")")
    return f"{BEYOND[0]}({quote(begin.filename)},{begin.line},{begin.column},{quote(said)})"


def beyond(statements: Iterable[AST], head: Head) -> Iterator[tuple[AST, str]]:
    """Give rules that hold where something is calculated beyond clingo's numbers, by the statement it is in.

    In the bodies is what binds the variables, and all conditions that calculate nothing. Terms are only
    calculated again where a value in them is so large that it may matter.
    """
    for statement in statements:
        if not _CALCULATES.search(str(statement)):
            continue
        if statement.ast_type == ASTType.Definition:
            yield from ((statement, text) for text in _checks(statement.value, [], head))
        elif statement.ast_type in {ASTType.Rule, ASTType.Minimize}:
            for each in statement.unpool(condition=True):
                named = _Naming().visit(each)
                for place, known in _places(named):
                    yield from ((statement, text) for text in _checks(place, known, head))
                for aggregate, elements in _sums(named):
                    total = f"#sum {{ {'; '.join(elements)} }} > {LARGEST}"
                    yield statement, f"{head(aggregate)} :- {_joined([*_known(named.body), total])}."


def _checks(place: AST, known: Sequence[AST], head: Head) -> Iterator[str]:
    for term in _terms(place):
        leaves: dict[str, AST] = {}
        text = " ".join(_postfix(term, leaves))
        call = f"1 = @_exact({','.join([quote(text), *leaves])})"
        most = _harmless(term)
        if most < 0 or any(_has_interval(leaf) for leaf in leaves.values()):
            yield f"{head(term)} :- {_joined([*known, call])}."
            continue
        numbers = [_number(leaf) for leaf in leaves.values()]
        if None not in numbers and not is_beyond(text, [n for n in numbers if n is not None]):
            continue
        for leaf, node in leaves.items():
            if _number(node) is None:
                yield f"{head(term)} :- {_joined([*known, f'not -{most} <= {leaf} <= {most}', call])}."


def _postfix(term: AST, leaves: dict[str, AST]) -> Iterator[str]:
    if term.ast_type == ASTType.BinaryOperation:
        yield from _postfix(term.left, leaves)
        yield from _postfix(term.right, leaves)
        yield _BINARY[term.operator_type]
    elif term.ast_type == ASTType.UnaryOperation:
        yield from _postfix(term.argument, leaves)
        yield _UNARY[term.operator_type]
    else:
        leaves.setdefault(str(term), term)
        yield str(list(leaves).index(str(term)))


def _harmless(term: AST) -> int:
    """Return a number up to which values may be, above and below 0, and nothing leaves clingo's numbers."""
    return next((most for most in (LARGEST >> n for n in range(32)) if _size(term, most) <= LARGEST), -1)


def _size(term: AST, most: int) -> int:
    """Say how far from 0 a term can be, and what is in it, where no value in it is farther than ``most``."""
    if term.ast_type == ASTType.UnaryOperation:
        return _size(term.argument, most) + int(term.operator_type == UnaryOperator.Negation)
    if term.ast_type != ASTType.BinaryOperation:
        number = _number(term)
        return most if number is None else abs(number)
    a, b = _size(term.left, most), _size(term.right, most)
    kind = term.operator_type
    if kind == BinaryOperator.Power:
        power = _number(term.right)
        return LARGEST + 1 if power is None or power > 31 else int(max(a, 1) ** power)
    if kind == BinaryOperator.Multiplication:
        return max(a * b, a, b)
    return a + b if kind in {BinaryOperator.Plus, BinaryOperator.Minus} else 2 * max(a, b) + 1


def _number(term: AST) -> int | None:
    if term.ast_type == ASTType.SymbolicTerm and term.symbol.type is SymbolType.Number:
        return int(term.symbol.number)
    return None


def _has_interval(term: AST) -> bool:
    return any(node.ast_type == ASTType.Interval for node in nodes(term))


def _sums(rule: AST) -> Iterator[tuple[AST, list[str]]]:
    """Return the sums of a rule, each with its elements, which count above 0 whatever they add."""
    for part in rule.body if rule.ast_type == ASTType.Minimize else [rule.head, *rule.body]:
        aggregate = part.atom if part.ast_type == ASTType.Literal else part
        if aggregate.ast_type not in _AGGREGATES:
            continue
        if aggregate.function in _SUMS and any(_number(each.terms[0]) != 1 for each in aggregate.elements):
            yield aggregate, [text for element in aggregate.elements for text in _sizes(element)]


def _sizes(element: AST) -> Iterator[str]:
    """Return an element that adds how far a weight is from 0; nothing for what is no number."""
    inner = element.condition
    condition = list(inner.condition) if isinstance(inner, AST) else list(inner)
    weight = "_Weight"
    terms = ",".join([weight, *map(str, element.terms[1:])])
    for sign, within in (("", f"0 < {weight} <= {LARGEST}"), ("-", f"-{LARGEST} <= {weight} < 0")):
        known = ", ".join(map(str, [*condition, f"{weight} = {element.terms[0]}", within]))
        yield f"{sign}{weight},{terms} : {known}"


def _places(statement: AST) -> Iterator[tuple[AST, Sequence[AST]]]:
    """Return the parts of a statement, each with the conditions that its variables are bound by."""
    known = _known(statement.body)
    if statement.ast_type == ASTType.Minimize:
        yield from ((term, known) for term in (statement.weight, statement.priority, *statement.terms))
        outer = list(statement.body)
    else:
        outer = [statement.head, *statement.body]
    for part in outer:
        atom = part.atom if part.ast_type == ASTType.Literal else part
        if atom.ast_type in {ASTType.Aggregate, ASTType.BodyAggregate, ASTType.HeadAggregate}:
            guards = (atom.left_guard, atom.right_guard)
            yield from ((guard.term, known) for guard in guards if guard is not None)
            # in a body, what is counted by itself is a condition, too
            counted = part.ast_type == ASTType.Literal and atom.ast_type == ASTType.Aggregate
            for element in atom.elements:
                yield from _inner_places(element, known, counted)
        elif atom.ast_type == ASTType.Disjunction:
            for element in atom.elements:
                yield from _inner_places(element, known)
        elif atom.ast_type == ASTType.ConditionalLiteral:
            yield from _inner_places(atom, known)
        else:
            yield part, _without(part, known)


def _inner_places(
    element: AST, known: Sequence[AST], counted: bool = False
) -> Iterator[tuple[AST, Sequence[AST]]]:
    """Return the parts of an element of an aggregate, of a choice, or of what holds under a condition."""
    terms: list[AST] = list(getattr(element, "terms", ()))
    conditional = element if element.ast_type == ASTType.ConditionalLiteral else element.condition
    if isinstance(conditional, AST) and conditional.ast_type == ASTType.ConditionalLiteral:
        terms.append(conditional.literal)
        conditional = [*conditional.condition, *([conditional.literal] if counted else ())]
    inner = [*known, *_known(conditional)]
    yield from ((each, _without(each, inner)) for each in dict.fromkeys((*terms, *conditional)))


def _terms(place: AST) -> Iterator[AST]:
    """Return the terms of a place that calculate, without those that are part of one."""
    if place.ast_type == ASTType.SymbolicAtom:
        symbol = place.symbol
        while symbol.ast_type == ASTType.UnaryOperation:  # p with a minus before it
            symbol = symbol.argument
        for argument in symbol.arguments:
            yield from _terms(argument)
        return
    if place.ast_type in {ASTType.BinaryOperation, ASTType.UnaryOperation}:
        leaves: dict[str, AST] = {}
        if any(word in _BINARY.values() for word in _postfix(place, leaves)):
            yield place
        for leaf in leaves.values():
            yield from _terms(leaf)
        return
    for key in place.child_keys:
        child = getattr(place, key)
        for part in [child] if isinstance(child, AST) else child or ():
            yield from _terms(part)


def _known(body: Iterable[AST]) -> list[AST]:
    """Return what binds variables, and what calculates nothing and counts nothing."""
    return [each for each in body if _binds(each) or not any(map(_calculates, nodes(each)))]


def _without(part: AST, known: Sequence[AST]) -> Sequence[AST]:
    """Leave out a condition where what it calculates is looked at, unless only it gives a variable its value.

    Clingo drops an instance in which an equality leaves its numbers, and with it what would find that.
    """
    others = [each for each in known if each != part]
    bound = _bound(others)
    inside = {name for term in _terms(part) for name in variables(term)}
    return [each for each in others if bound.issuperset(variables(each))] if inside <= bound else known


def _bound(conditions: Sequence[AST]) -> set[str]:
    """Return the variables that get a value: from positive atoms, and from equalities to what has one."""
    bound: set[str] = set()
    comparisons: list[tuple[AST, AST]] = []
    for each in filter(_binds, conditions):
        if each.atom.ast_type != ASTType.Comparison:
            bound.update(variables(each))
            continue
        terms = [each.atom.term, *(guard.term for guard in each.atom.guards)]
        for guard, left, right in zip(each.atom.guards, terms, terms[1:], strict=False):
            if guard.comparison == ComparisonOperator.Equal:
                comparisons += [(left, right), (right, left)]
    before = -1
    while before < len(bound):
        before = len(bound)
        bound.update(
            name
            for one, other in comparisons
            if bound.issuperset(variables(other))
            for name in _solved_for(one)
        )
    return bound


def _solved_for(term: AST) -> Iterator[str]:
    """Return the variable for which clingo solves an equality: of ``X``, ``X+1``, ``2*X`` and the like."""
    if term.ast_type == ASTType.Variable:
        yield term.name
    elif term.ast_type == ASTType.BinaryOperation and term.operator_type in _LINEAR:
        sides = (term.left, term.right)
        if any(_number(side) is not None for side in sides):
            yield from (name for side in sides for name in _solved_for(side))


def _calculates(node: AST) -> bool:
    return node.ast_type in {ASTType.BinaryOperation, ASTType.Aggregate, ASTType.BodyAggregate}


def _binds(part: AST) -> bool:
    """Whether a condition may give a variable its value."""
    if part.ast_type != ASTType.Literal or part.sign != Sign.NoSign:
        return False
    atom, guards = part.atom, []
    if atom.ast_type == ASTType.Comparison:
        guards = [*atom.guards]
    elif atom.ast_type in {ASTType.BodyAggregate, ASTType.Aggregate}:
        sides = [guard for guard in (atom.left_guard, atom.right_guard) if guard is not None]
        guards = [guard for guard in sides if any(variables(guard.term))]
    equal = any(guard.comparison == ComparisonOperator.Equal for guard in guards)
    return equal or bool(atom.ast_type == ASTType.SymbolicAtom)


def _joined(parts: Sequence[AST | str]) -> str:
    return "; ".join(map(str, parts)) or "#true"


class _Naming(Transformer):
    """Gives a name to each ``_`` in a term that calculates, so that it can be asked for."""

    def __init__(self) -> None:
        self._number = count(1)
        self._within = False

    def visit_BinaryOperation(self, term: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        before, self._within = self._within, True
        changed = term.update(**self.visit_children(term))
        self._within = before
        return changed

    def visit_Variable(self, variable: AST) -> AST:  # noqa: N802
        if self._within and variable.name == "_":
            return variable.update(name=f"_Any{next(self._number)}")
        return variable
