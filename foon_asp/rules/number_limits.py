"""Overflow checks: rules that derive an atom where arithmetic in other rules exceeds 32 bits."""

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

from foon_asp.encoding.exact import LARGEST, is_beyond
from foon_asp.encoding.fact_writer import quote
from foon_asp.encoding.number_checks import BEYOND
from foon_asp.encoding.parsing import nodes
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
_CALCULATES = re.compile(r"[+*/\\^&?~|]|(?<!:)-|#sum")  # matches every rule with arithmetic, and some others

Head = Callable[[AST], str]
"""A function that returns, for a term, the head of the rule that holds where the term overflows."""


def number_checks(statements: Iterable[AST]) -> str:
    """Return the text of rules that derive ``_beyond/4`` where a term of the statements overflows.

    The text is empty if no term can overflow.
    """
    return "".join(f"{text}\n" for _, text in overflow_checks(statements, _overflow_atom))


def _overflow_atom(term: AST) -> str:
    """Return the atom ``_beyond(File,Line,Column,Term)`` for a term or a sum, with its place."""
    begin = term.location.begin
    shown = "the sum" if term.ast_type in _AGGREGATES else str(term).removeprefix("(").removesuffix(")")
    return f"{BEYOND[0]}({quote(begin.filename)},{begin.line},{begin.column},{quote(shown)})"


def overflow_checks(statements: Iterable[AST], head: Head) -> Iterator[tuple[AST, str]]:
    """Yield pairs of a statement and a check rule, which derives its head where a term or sum overflows.

    ``head`` returns the head of the check rule for a term or sum. The body has the conditions of the
    statement that bind variables or have no arithmetic. A term is evaluated again only if a value in it is
    large enough for an overflow. Only rules, ``#const`` and ``#minimize`` have checks.
    """
    for statement in statements:
        if not _CALCULATES.search(str(statement)):
            continue
        if statement.ast_type == ASTType.Definition:
            yield from ((statement, text) for text in _term_checks(statement.value, [], head))
        elif statement.ast_type in {ASTType.Rule, ASTType.Minimize}:
            for variant in statement.unpool(condition=True):
                with_names = _AnonymousVariableNamer().visit(variant)
                for node, conditions in _terms_with_conditions(with_names):
                    yield from ((statement, text) for text in _term_checks(node, conditions, head))
                for aggregate, elements in _sum_aggregates(with_names):
                    total = f"#sum {{ {'; '.join(elements)} }} > {LARGEST}"
                    yield (
                        statement,
                        f"{head(aggregate)} :- {_body_text([*_check_conditions(with_names.body), total])}.",
                    )


def _term_checks(node: AST, conditions: Sequence[AST], head: Head) -> Iterator[str]:
    """Yield the check rules for the terms in a node that can overflow.

    ``head`` returns the head of the rule for a term. The body has ``conditions``, perhaps a test for a large
    value, and a call of ``@_exact``. A term of numbers alone has a rule only if it does overflow.
    """
    for term in _arithmetic_terms(node):
        leaves: dict[str, AST] = {}
        text = " ".join(_postfix(term, leaves))
        call = f"1 = @_exact({','.join([quote(text), *leaves])})"
        limit = _safe_magnitude(term)
        if limit < 0 or any(_has_interval(leaf) for leaf in leaves.values()):
            yield f"{head(term)} :- {_body_text([*conditions, call])}."
            continue
        numbers = [_number(leaf) for leaf in leaves.values()]
        if None not in numbers and not is_beyond(text, [n for n in numbers if n is not None]):
            continue
        for leaf, leaf_term in leaves.items():
            if _number(leaf_term) is None:
                large_test = f"not -{limit} <= {leaf} <= {limit}"
                yield f"{head(term)} :- {_body_text([*conditions, large_test, call])}."


def _postfix(term: AST, leaves: dict[str, AST]) -> Iterator[str]:
    """Yield a term in postfix notation: its operators, and its leaves as indices in ``leaves``.

    Leaves that are not yet in ``leaves`` are added.
    """
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


def _safe_magnitude(term: AST) -> int:
    """Return a bound: if no value in a term exceeds it in absolute value, the term cannot overflow.

    Only ``LARGEST``, its half, its quarter and so on down to 0 are tried. Return the greatest that is such a
    bound, or -1 if there is no such bound.
    """
    return next(
        (limit for limit in (LARGEST >> n for n in range(32)) if _max_magnitude(term, limit) <= LARGEST), -1
    )


def _max_magnitude(term: AST, limit: int) -> int:
    """Return an upper bound on the absolute values of a term and its subterms.

    The values in the term are assumed to be at most ``limit`` in absolute value.
    """
    if term.ast_type == ASTType.UnaryOperation:
        return _max_magnitude(term.argument, limit) + int(term.operator_type == UnaryOperator.Negation)
    if term.ast_type != ASTType.BinaryOperation:
        number = _number(term)
        return limit if number is None else abs(number)
    a, b = _max_magnitude(term.left, limit), _max_magnitude(term.right, limit)
    kind = term.operator_type
    if kind == BinaryOperator.Power:
        power = _number(term.right)
        return LARGEST + 1 if power is None or power > 31 else int(max(a, 1) ** power)
    if kind == BinaryOperator.Multiplication:
        return max(a * b, a, b)
    return a + b if kind in {BinaryOperator.Plus, BinaryOperator.Minus} else 2 * max(a, b) + 1


def _number(term: AST) -> int | None:
    """Return the number that a term is; ``None`` for any other term."""
    if term.ast_type == ASTType.SymbolicTerm and term.symbol.type is SymbolType.Number:
        return int(term.symbol.number)
    return None


def _has_interval(term: AST) -> bool:
    """Whether a term has an interval such as ``1..9``."""
    return any(node.ast_type == ASTType.Interval for node in nodes(term))


def _sum_aggregates(rule: AST) -> Iterator[tuple[AST, list[str]]]:
    """Yield each sum in a rule, with texts of its elements in which weights become absolute values.

    A sum whose weights are all 1 is left out. In ``#minimize``, only the body is searched for sums.
    """
    for body_part in rule.body if rule.ast_type == ASTType.Minimize else [rule.head, *rule.body]:
        aggregate = body_part.atom if body_part.ast_type == ASTType.Literal else body_part
        if aggregate.ast_type not in _AGGREGATES:
            continue
        if aggregate.function in _SUMS and any(
            _number(element.terms[0]) != 1 for element in aggregate.elements
        ):
            yield aggregate, [text for element in aggregate.elements for text in _magnitude_elements(element)]


def _magnitude_elements(element: AST) -> Iterator[str]:
    """Yield two elements as text, which together add the absolute value of an element's weight.

    The first is for positive weights, the second for negative weights.
    """
    inner = element.condition
    condition = list(inner.condition) if isinstance(inner, AST) else list(inner)
    weight = "_Weight"
    terms = ",".join([weight, *map(str, element.terms[1:])])
    for sign, sign_test in (("", f"0 < {weight} <= {LARGEST}"), ("-", f"-{LARGEST} <= {weight} < 0")):
        condition_text = ", ".join(map(str, [*condition, f"{weight} = {element.terms[0]}", sign_test]))
        yield f"{sign}{weight},{terms} : {condition_text}"


def _terms_with_conditions(statement: AST) -> Iterator[tuple[AST, Sequence[AST]]]:
    """Yield the terms and conjuncts of a statement, each with the conditions that bind its variables."""
    conditions = _check_conditions(statement.body)
    if statement.ast_type == ASTType.Minimize:
        yield from ((term, conditions) for term in (statement.weight, statement.priority, *statement.terms))
        outer = list(statement.body)
    else:
        outer = [statement.head, *statement.body]
    for conjunct in outer:
        atom = conjunct.atom if conjunct.ast_type == ASTType.Literal else conjunct
        if atom.ast_type in {ASTType.Aggregate, ASTType.BodyAggregate, ASTType.HeadAggregate}:
            guards = (atom.left_guard, atom.right_guard)
            yield from ((guard.term, conditions) for guard in guards if guard is not None)
            # in a body, the literals of a count without terms are conditions, too
            counted = conjunct.ast_type == ASTType.Literal and atom.ast_type == ASTType.Aggregate
            for element in atom.elements:
                yield from _element_terms(element, conditions, counted)
        elif atom.ast_type == ASTType.Disjunction:
            for element in atom.elements:
                yield from _element_terms(element, conditions)
        elif atom.ast_type == ASTType.ConditionalLiteral:
            yield from _element_terms(atom, conditions)
        else:
            yield conjunct, _conditions_without(conjunct, conditions)


def _element_terms(
    element: AST, conditions: Sequence[AST], counted: bool = False
) -> Iterator[tuple[AST, Sequence[AST]]]:
    """Yield the terms and literals of an element, each with the conditions that bind its variables.

    The element belongs to an aggregate, a choice or a disjunction, or it is a conditional literal. With
    ``counted``, the literal of the element counts as a condition.
    """
    terms: list[AST] = list(getattr(element, "terms", ()))
    conditional = element if element.ast_type == ASTType.ConditionalLiteral else element.condition
    if isinstance(conditional, AST) and conditional.ast_type == ASTType.ConditionalLiteral:
        terms.append(conditional.literal)
        conditional = [*conditional.condition, *([conditional.literal] if counted else ())]
    inner = [*conditions, *_check_conditions(conditional)]
    yield from ((node, _conditions_without(node, inner)) for node in dict.fromkeys((*terms, *conditional)))


def _arithmetic_terms(node: AST) -> Iterator[AST]:
    """Yield the maximal terms with an operation of two operands in a node of the syntax tree.

    The arguments of functions within such a term are searched, too.
    """
    if node.ast_type == ASTType.SymbolicAtom:
        symbol = node.symbol
        while symbol.ast_type == ASTType.UnaryOperation:  # p with a minus before it
            symbol = symbol.argument
        for argument in symbol.arguments:
            yield from _arithmetic_terms(argument)
        return
    if node.ast_type in {ASTType.BinaryOperation, ASTType.UnaryOperation}:
        leaves: dict[str, AST] = {}
        if any(word in _BINARY.values() for word in _postfix(node, leaves)):
            yield node
        for leaf in leaves.values():
            yield from _arithmetic_terms(leaf)
        return
    for key in node.child_keys:
        child = getattr(node, key)
        for child_node in [child] if isinstance(child, AST) else child or ():
            yield from _arithmetic_terms(child_node)


def _check_conditions(body: Iterable[AST]) -> list[AST]:
    """Return the conjuncts of a body that may bind variables, or have neither arithmetic nor aggregates."""
    return [
        condition
        for condition in body
        if _binds(condition) or not any(map(_is_calculation, nodes(condition)))
    ]


def _conditions_without(node: AST, conditions: Sequence[AST]) -> Sequence[AST]:
    """Return the conditions for the check of a node, without the node itself if others bind its variables.

    The reason is that clingo drops an instance in which an equation overflows, also in a check with this
    equation. Without the node, conditions with variables that nothing else binds are left out as well. If the
    other conditions do not bind the variables of the node's arithmetic, all conditions are returned.
    """
    other_conditions = [condition for condition in conditions if condition != node]
    bound = _bound_variables(other_conditions)
    calculated_names = {name for term in _arithmetic_terms(node) for name in variables(term)}
    return (
        [condition for condition in other_conditions if bound.issuperset(variables(condition))]
        if calculated_names <= bound
        else conditions
    )


def _bound_variables(conditions: Sequence[AST]) -> set[str]:
    """Return the variables bound by positive atoms, or by equations with terms of bound variables."""
    bound: set[str] = set()
    comparisons: list[tuple[AST, AST]] = []
    for condition in filter(_binds, conditions):
        if condition.atom.ast_type != ASTType.Comparison:
            bound.update(variables(condition))
            continue
        terms = [condition.atom.term, *(guard.term for guard in condition.atom.guards)]
        for guard, left_term, right_term in zip(condition.atom.guards, terms, terms[1:], strict=False):
            if guard.comparison == ComparisonOperator.Equal:
                comparisons += [(left_term, right_term), (right_term, left_term)]
    before = -1
    while before < len(bound):
        before = len(bound)
        bound.update(
            name
            for solved_term, value_term in comparisons
            if bound.issuperset(variables(value_term))
            for name in _solvable_variables(solved_term)
        )
    return bound


def _solvable_variables(term: AST) -> Iterator[str]:
    """Yield the variable of a linear term such as ``2*X+1``; nothing for any other term.

    Clingo solves an equation with such a term for the variable.
    """
    if term.ast_type == ASTType.Variable:
        yield term.name
    elif term.ast_type == ASTType.BinaryOperation and term.operator_type in _LINEAR:
        operands = (term.left, term.right)
        if any(_number(operand) is not None for operand in operands):
            yield from (name for operand in operands for name in _solvable_variables(operand))


def _is_calculation(node: AST) -> bool:
    """Whether a node is an operation with two operands or an aggregate."""
    return node.ast_type in {ASTType.BinaryOperation, ASTType.Aggregate, ASTType.BodyAggregate}


def _binds(condition: AST) -> bool:
    """Whether a condition may bind a variable: a positive atom, or an equation that is not negated."""
    if condition.ast_type != ASTType.Literal or condition.sign != Sign.NoSign:
        return False
    atom, guards = condition.atom, []
    if atom.ast_type == ASTType.Comparison:
        guards = [*atom.guards]
    elif atom.ast_type in {ASTType.BodyAggregate, ASTType.Aggregate}:
        sides = [guard for guard in (atom.left_guard, atom.right_guard) if guard is not None]
        guards = [guard for guard in sides if any(variables(guard.term))]
    has_equation = any(guard.comparison == ComparisonOperator.Equal for guard in guards)
    return has_equation or bool(atom.ast_type == ASTType.SymbolicAtom)


def _body_text(conditions: Sequence[AST | str]) -> str:
    """Return conditions as the body of a rule; ``#true`` without conditions."""
    return "; ".join(map(str, conditions)) or "#true"


class _AnonymousVariableNamer(Transformer):
    """Rewriter that names each ``_`` in a term with arithmetic, so that a check can refer to it."""

    def __init__(self) -> None:
        """Begin with the name ``_Any1``."""
        self._number = count(1)
        self._in_term = False

    def visit_BinaryOperation(self, term: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        """Return an operation in which each ``_`` has a new name."""
        before, self._in_term = self._in_term, True
        changed = term.update(**self.visit_children(term))
        self._in_term = before
        return changed

    def visit_Variable(self, variable: AST) -> AST:  # noqa: N802
        """Return a variable, under a new name such as ``_Any1`` if it is ``_`` within an operation."""
        if self._in_term and variable.name == "_":
            return variable.update(name=f"_Any{next(self._number)}")
        return variable
