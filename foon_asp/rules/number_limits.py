"""Where numbers that rules calculate leave clingo's 32 bits, which it does not say: as rules that find it."""

from collections.abc import Iterator, Sequence
from itertools import count

from clingo.ast import AST, AggregateFunction, ASTType, BinaryOperator, ComparisonOperator, Sign

from foon_asp.grounding.parsing import nodes

_MOST = 2**31 - 1
_PART = 4096  # sums are looked at in parts of this
# Two numbers of 32 bits that an operation takes out of them; by 1 in place of 0, which nothing is divided by.
_BEYOND = {
    BinaryOperator.Multiplication: [f"B != 0, |A| > {_MOST} / (|B|+0**|B|)"],
    BinaryOperator.Plus: [f"A > 0, B > 0, A > {_MOST} - B", f"A < 0, B < 0, A < -{_MOST} - B"],
    BinaryOperator.Minus: [f"A > 0, B < 0, A > {_MOST} + B", f"A < 0, B > 0, A < B - {_MOST}"],
    BinaryOperator.Power: ["B > 30, |A| > 1", "_root(B,R), |A| > R"],
}
ROOTS = " ".join(f"_root({power},{int(_MOST ** (1 / power))})." for power in range(2, 31))
"""The greatest numbers whose powers have 32 bits."""


def beyond(rules: Sequence[AST], head: str) -> Iterator[tuple[AST, str]]:
    """Give rules for a head, which holds where something is calculated beyond 32 bits, by where that is.

    In the bodies is what binds the variables, and all conditions that calculate nothing. What an operation is
    about is an atom ``_sides_N(A,B)``, so that it is only looked at where these hold.
    """
    number = count()
    for rule in rules:
        for place, known in _places(rule):
            for term in _terms(place):
                if term.operator_type in _BEYOND:
                    sides = f"_sides_{next(number)}"
                    yield rule, f"{sides}({term.left},{term.right}) :- {_joined(known)}."
                    for condition in _BEYOND[term.operator_type]:
                        yield rule, f"{head} :- {sides}(A,B), {condition}."
        for part in rule.body:
            aggregate = part.atom if part.ast_type == ASTType.Literal else part
            if aggregate.ast_type == ASTType.BodyAggregate and aggregate.function in {
                AggregateFunction.Sum,
                AggregateFunction.SumPlus,
            }:
                parts = "; ".join(map(_in_parts, aggregate.elements))
                total = f"#sum {{ {parts} }} > {_MOST // _PART}"
                yield rule, f"{head} :- {_joined([*_known(rule.body), total])}."


def _places(rule: AST) -> Iterator[tuple[AST, Sequence[AST]]]:
    """Give the parts of a rule, each with the conditions that its variables are bound by."""
    known = _known(rule.body)
    yield rule.head, known
    for part in rule.body:
        inner: list[tuple[Sequence[AST], Sequence[AST]]] = []
        if part.ast_type == ASTType.ConditionalLiteral:
            inner = [([part.literal], part.condition)]
        elif part.atom.ast_type == ASTType.BodyAggregate:
            guards = (part.atom.left_guard, part.atom.right_guard)
            yield from ((guard.term, known) for guard in guards if guard is not None)
            inner = [(element.terms, element.condition) for element in part.atom.elements]
        else:
            yield part, known
        for terms, condition in inner:
            yield from ((each, [*known, *_known(condition)]) for each in (*terms, *condition))


def _terms(place: AST) -> Iterator[AST]:
    return (node for node in nodes(place) if node.ast_type == ASTType.BinaryOperation)


def _known(body: Sequence[AST]) -> list[AST]:
    """Give what binds variables, and what calculates nothing."""
    return [each for each in body if _binds(each) or next(_terms(each), None) is None]


def _in_parts(element: AST) -> str:
    terms = ",".join(map(str, element.terms))
    return f"|{element.terms[0]}|/{_PART}+1,{terms} : {', '.join(map(str, element.condition))}"


def _binds(part: AST) -> bool:
    """Whether a condition may give a variable its value."""
    if part.ast_type != ASTType.Literal or part.sign != Sign.NoSign:
        return False
    atom, guards = part.atom, []
    if atom.ast_type == ASTType.Comparison:
        guards = [*atom.guards]
    elif atom.ast_type == ASTType.BodyAggregate:
        guards = [guard for guard in (atom.left_guard, atom.right_guard) if guard is not None]
    equal = any(guard.comparison == ComparisonOperator.Equal for guard in guards)
    return equal or bool(atom.ast_type == ASTType.SymbolicAtom)


def _joined(parts: Sequence[AST | str]) -> str:
    return "; ".join(map(str, parts)) or "#true"
