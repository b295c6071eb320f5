"""Flat rule bodies: rules compiled to queries about one unit of the tree at a time, without clingo.

A body is flat if, once its auxiliary predicates are unfolded, it consists of facts, texts and whole numbers,
comparisons, counts of facts, and negated bodies. A rule with flat bodies removes units, asks for
one unit of a set, or bounds a sum over units. Everything else (arithmetic, intervals, sums within a body,
recursion, variables that nothing binds, two units that together break a rule) is left to the search.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from itertools import product
from typing import Final, NamedTuple

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.problem.number import INT32_MAX
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Conjunct,
    Constants,
    Element,
    Literal,
    Signature,
    Strange,
    Test,
    compared,
    factors,
    global_variables,
    value,
    variables,
)
from foon_asp.rules.dependence import AVAILABLE, TIMES, USE, Dependence, Depends
from foon_asp.rules.fact_subject import SUBJECTS, Subject, Subjects
from foon_asp.rules.locality import Locality

_SEVERAL_VALUES = {"input", "output", "needs", "gives", "state", "ingredient", "located", "source", "video"}
_READ = _SEVERAL_VALUES | {"motion", "label", "inputs", "ingredients", "rate", "price"}
_READ |= {"unit", "object", "kitchen", "utensil", "goal"}
_MAX_WAYS = 256  # disjuncts of one body; with more, the rule is left to the search
_ONE_EXECUTION = {USE, TIMES}
NUMBER: Final = ("_number", 2)  # of a unit: its public number, as in ``use(17)``
_SUBJECTS = {**SUBJECTS, NUMBER: Subjects({0: Subject.UNIT}, {})}

# By forbidden comparison: whether the bound that remains is a lower one, and its offset from the number.
_ALLOWED = {
    ComparisonOperator.GreaterThan: (False, 0),
    ComparisonOperator.GreaterEqual: (False, -1),
    ComparisonOperator.LessThan: (True, 0),
    ComparisonOperator.LessEqual: (True, 1),
}


class NotFlatError(Exception):
    """A rule whose body is not flat, so that it is left to the search."""


class Variable(int):
    """A variable, by number."""


class Constant(NamedTuple):
    """A constant of a rule: a text, a whole number, or any other symbol unchanged."""

    value: str | int | Symbol


Term = Variable | Constant


class Fact(NamedTuple):
    """A positive literal over a predicate of facts."""

    signature: Signature
    terms: tuple[Term, ...]


class Listed(NamedTuple):
    """A positive literal over an auxiliary predicate that is a :class:`Table`."""

    signature: Signature
    terms: tuple[Term, ...]


class Compare(NamedTuple):
    """A comparison of two terms."""

    comparison: ComparisonOperator
    first: Term
    second: Term


class Never(NamedTuple):
    """A negated disjunction: no disjunct holds, where the variables in ``bound`` already have values."""

    disjuncts: "tuple[Disjunct, ...]"
    bound: frozenset[Variable]


class Counted(NamedTuple):
    """A ``#count``: the number of different rows that the disjuncts derive, compared with each guard.

    ``negated`` inverts it. The variables in ``bound`` already have values when it is evaluated.
    """

    rows: "tuple[tuple[Disjunct, tuple[Term, ...]], ...]"
    guards: tuple[tuple[ComparisonOperator, Term], ...]
    negated: bool
    bound: frozenset[Variable]


Item = Fact | Listed | Compare | Never | Counted


class Disjunct(NamedTuple):
    """A conjunction of items under which a body holds.

    ``unit`` is the variable of its one ``use(U)``, ``None`` where it has none.
    """

    items: tuple[Item, ...]
    unit: Variable | None = None


class Table(NamedTuple):
    """An auxiliary predicate that is derived from goals and other tables alone.

    ``rows`` are the disjuncts of its rules, each with the terms of its head; ``subjects`` say what its
    arguments stand for.
    """

    rows: tuple[tuple[Disjunct, tuple[Term, ...]], ...]
    subjects: tuple[Subject, ...]


class AtLeastOne(NamedTuple):
    """An at-least-one constraint; wherever ``when`` holds, the tree has a unit of one of ``helpers``."""

    when: Disjunct
    helpers: tuple[Disjunct, ...]


class LinearBound(NamedTuple):
    """A linear bound of a rule: its ``terms`` sum up to at most ``bound``, or ``at_least``.

    A term is a disjunct with a unit and the weight of one execution of that unit; equal weights that several
    disjuncts give a unit count once. With ``used``, a unit counts once however often it is executed. With
    ``per_unit``, the bound holds for each unit by itself.
    """

    terms: tuple[tuple[Disjunct, Term], ...]
    bound: int
    at_least: bool = False
    used: bool = False
    per_unit: bool = False


_Subjects = dict[Variable, Subject]  # LABEL stands for everything that is no id
_OPPOSITE = {
    ComparisonOperator.Equal: ComparisonOperator.NotEqual,
    ComparisonOperator.NotEqual: ComparisonOperator.Equal,
    ComparisonOperator.LessThan: ComparisonOperator.GreaterEqual,
    ComparisonOperator.GreaterEqual: ComparisonOperator.LessThan,
    ComparisonOperator.GreaterThan: ComparisonOperator.LessEqual,
    ComparisonOperator.LessEqual: ComparisonOperator.GreaterThan,
}


class FlatBodies:
    """Compiler of rule bodies to flat ones; raises :class:`NotFlatError` for bodies left to the search.

    The items of a disjunct are in an order in which each variable has its value before it is read. ``tables``
    are the auxiliary predicates that they read, ``size`` is the number of variables.
    """

    def __init__(
        self, program: Iterable[Clause], constants: Constants, dependence: Dependence, locality: Locality
    ) -> None:
        self.constants, self._dependence, self._locality = constants, dependence, locality
        self._rules: dict[Signature, list[Clause]] = {}
        for clause in program:
            if clause.head is not None:
                self._rules.setdefault(clause.head.signature, []).append(clause)
        self.tables: dict[Signature, Table] = {}
        self._unfolding: list[Signature] = []  # predicates that are being unfolded, to find recursion
        self.size = 0

    def disjuncts(self, clause: Clause) -> tuple[Disjunct, ...]:
        """Return the body of a rule as a disjunction."""
        return tuple(
            self._sorted(disjunct, frozenset(), {})
            for disjunct in _Scope(self, clause).disjuncts(clause.body)
        )

    def at_least_ones(self, clause: Clause) -> tuple[AtLeastOne, ...]:
        """Return the at-least-one constraints that a requiring rule stands for."""
        scope = _Scope(self, clause)
        deciding = [
            conjunct for conjunct in clause.body if self._dependence.of_conjunct(conjunct) is not Depends.NOT
        ]
        at_least_ones = []
        for disjunct in scope.disjuncts([conjunct for conjunct in clause.body if conjunct not in deciding]):
            subjects: _Subjects = {}
            when = self._sorted(disjunct, frozenset(), subjects)
            bound = frozenset(subjects)
            helpers = [
                self._sorted(alternative, bound, dict(subjects))
                for conjunct in deciding
                for alternative in scope.helpers(conjunct)
            ]
            at_least_ones.append(AtLeastOne(when, tuple(helpers)))
        return tuple(at_least_ones)

    def linear_bound(self, clause: Clause) -> LinearBound:
        """Return the linear bound of a rule such as ``:- #sum { N,U : times(U,N) } > 9``."""
        scope = _Scope(self, clause)
        aggregates = [conjunct for conjunct in clause.body if isinstance(conjunct, Aggregate)]
        if not aggregates:
            return self._unit_bound(scope, clause.body)
        if len(clause.body) > 1 or aggregates[0].negations or len(aggregates[0].guards) != 1:
            raise NotFlatError
        at_least, bound = self._allowed(aggregates[0].guards[0].comparison, aggregates[0].guards[0].term)
        terms = tuple(
            term for element in aggregates[0].elements for term in self._terms(scope, aggregates[0], element)
        )
        deciding = {
            literal.signature
            for element in aggregates[0].elements
            for literal in element.condition
            if isinstance(literal, Literal) and literal.signature in _ONE_EXECUTION
        }
        if len(deciding) != 1:
            raise NotFlatError
        return LinearBound(terms, bound, at_least, deciding == {USE})

    def _unit_bound(self, scope: "_Scope", body: Sequence[Conjunct]) -> LinearBound:
        """Return the bound per unit of ``:- times(U,N), N > 2, ...``."""
        for conjunct in body:
            if (
                not isinstance(conjunct, Test)
                or conjunct.ast.sign
                or conjunct.ast.atom.ast_type != ASTType.Comparison
            ):
                continue
            count, guards = conjunct.ast.atom.term, conjunct.ast.atom.guards
            condition = tuple(other for other in body if other is not conjunct)
            times = [other for other in condition if isinstance(other, Literal) and other.signature == TIMES]
            if len(guards) != 1 or len(times) != 1 or times[0].arguments[1] != count:
                continue
            at_least, bound = self._allowed(guards[0].comparison, guards[0].term)
            if not at_least:
                element = Element((count, times[0].arguments[0]), condition)
                return LinearBound(tuple(self._terms(scope, None, element)), bound, per_unit=True)
        raise NotFlatError

    def _allowed(self, comparison: int, term: AST) -> tuple[bool, int]:
        """Return the bound that forbids a comparison: whether it is a lower one, and its number."""
        number, allowed = value(term, self.constants), _ALLOWED.get(ComparisonOperator(comparison))
        if number is None or number.type is not SymbolType.Number or allowed is None:
            raise NotFlatError
        return allowed[0], number.number + allowed[1]

    def _terms(
        self, scope: "_Scope", counts: Aggregate | None, element: Element
    ) -> list[tuple[Disjunct, Term]]:
        """Return the terms, each with its weight, that one element of a sum or a count stands for."""
        is_count = counts is not None and counts.function is AggregateFunction.Count
        is_sum = counts is None or counts.function is AggregateFunction.Sum
        if not (is_count and len(element.terms) == 1) and not (is_sum and len(element.terms) == 2):
            raise NotFlatError
        terms = []
        for disjunct, weight in scope.summands(element):
            subjects: _Subjects = {}
            terms.append((self._sorted(disjunct, frozenset(), subjects), weight))
            if isinstance(weight, Variable) and subjects.get(weight) is not Subject.LABEL:
                raise NotFlatError
        return terms

    def variable(self) -> Variable:
        """Return a fresh variable."""
        self.size += 1
        return Variable(self.size - 1)

    def of_atom(self, signature: Signature, terms: tuple[Term, ...]) -> list[Disjunct]:
        """Return an atom as a disjunction, with the items in any order."""
        if signature == USE:
            if isinstance(terms[0], Variable):
                return [Disjunct((), terms[0])]
            unit = self.variable()
            return [Disjunct((Fact(NUMBER, (unit, *terms)),), unit)]
        if signature == AVAILABLE:
            unit = self.variable()
            return [
                Disjunct((Fact(("kitchen", 1), terms),)),
                Disjunct((Fact(("gives", 2), (unit, *terms)),), unit),
            ]
        if signature in SUBJECTS:
            if signature[0] not in _READ:
                raise NotFlatError
            return [Disjunct((Fact(signature, terms),))]
        if signature in self._unfolding:
            raise NotFlatError
        self._unfolding.append(signature)
        try:
            if self._is_table(signature):
                return [Disjunct((Listed(signature, terms),))]
            disjuncts: list[Disjunct] = []
            for clause in self._rules.get(signature, ()):
                scope = _Scope(self, clause)
                assert clause.head is not None
                equations = scope.unified(terms, clause.head.arguments)
                disjuncts += [
                    disjunct._replace(items=(*equations, *disjunct.items))
                    for disjunct in scope.disjuncts(clause.body)
                ]
            return disjuncts
        finally:
            self._unfolding.pop()

    def _is_table(self, signature: Signature) -> bool:
        """Whether a predicate is a table; adds it to ``tables`` at its first use."""
        if signature not in self.tables:
            depends_on_tree = self._dependence.of(signature) is not Depends.NOT
            doubtful = depends_on_tree or signature in self._dependence.doubts
            if signature not in self._rules or doubtful or not self._locality.closed(signature):
                return False
            rows = []
            kinds = set()
            for clause in self._rules[signature]:
                assert clause.head is not None
                scope = _Scope(self, clause)
                head = tuple(map(scope.term, clause.head.arguments))
                for disjunct in scope.disjuncts(clause.body):
                    subjects: _Subjects = {}
                    rows.append((self._sorted(disjunct, frozenset(), subjects), head))
                    if not subjects.keys() >= set(_variables(head)):
                        raise NotFlatError
                    kinds.add(tuple(_subject(term, subjects) for term in head))
            if len(kinds) > 1:
                raise NotFlatError
            any_ = (Subject.LABEL,) * signature[1]
            self.tables[signature] = Table(tuple(rows), kinds.pop() if kinds else any_)
        return True

    def _sorted(self, disjunct: Disjunct, bound_before: frozenset[Variable], subjects: _Subjects) -> Disjunct:
        """Return a disjunct with its items in the order of evaluation; adds its variables to ``subjects``."""
        bound = set(bound_before)
        if disjunct.unit is not None:
            if disjunct.unit in bound:
                raise NotFlatError  # a unit that another literal determines, by its number
            bound.add(disjunct.unit)
            subjects[disjunct.unit] = Subject.UNIT
        self._find_subjects(disjunct.items, subjects)
        remaining, items = list(disjunct.items), list[Item]()
        while remaining:
            ready = [
                (cost, position)
                for position, item in enumerate(remaining)
                if (cost := self._cost(item, bound)) >= 0
            ]
            if not ready:
                raise NotFlatError
            item = remaining.pop(min(ready)[1])
            if isinstance(item, Never):
                inner = (self._sorted(inner_way, item.bound, dict(subjects)) for inner_way in item.disjuncts)
                item = item._replace(disjuncts=tuple(inner))
            elif isinstance(item, Counted):
                rows = (
                    (self._sorted(inner_way, item.bound, dict(subjects)), row) for inner_way, row in item.rows
                )
                item = item._replace(rows=tuple(rows))
            else:
                bound.update(_variables(_terms(item)))
            items.append(item)
        return disjunct._replace(items=tuple(items))

    def _cost(self, item: Item, bound: set[Variable]) -> int:
        """Return the rank of an item in the order of evaluation, negative while its inputs are unbound."""
        if isinstance(item, Never | Counted):
            return 3 if item.bound <= bound else -1
        free = [variable not in bound for variable in _variables(_terms(item))]
        if isinstance(item, Compare):
            binds = sum(free) == 1 and item.comparison is ComparisonOperator.Equal
            return 0 if not any(free) else 1 if binds else -1
        if isinstance(item, Listed):
            return 10 if any(free) else 1
        about = _SUBJECTS[item.signature].about
        if not bound.issuperset(_variables(item.terms[position] for position in about)):
            return -1
        if item.signature == ("goal", 1):
            return 20 if any(free) else 0
        return (5 if any(free) else 1) if item.signature[0] in _SEVERAL_VALUES else 0

    def _find_subjects(self, items: Iterable[Item], subjects: _Subjects) -> None:
        """Add the subjects that variables stand for to ``subjects``; raises where these are of two kinds."""
        before = -1
        while before != len(subjects):
            before = len(subjects)
            for item in items:
                if isinstance(item, Fact):
                    facts = _SUBJECTS[item.signature]
                    of = {**facts.about, **facts.leads_to}
                    for position, term in enumerate(item.terms):
                        _set_subject(term, of.get(position, Subject.LABEL), subjects)
                elif isinstance(item, Listed):
                    for term, subject in zip(item.terms, self.tables[item.signature].subjects, strict=True):
                        _set_subject(term, subject, subjects)
                elif isinstance(item, Compare):
                    for one, other in ((item.first, item.second), (item.second, item.first)):
                        if isinstance(one, Constant) or one in subjects:
                            _set_subject(other, _subject(one, subjects), subjects)
        if any(
            isinstance(item, Compare)
            and item.comparison not in {ComparisonOperator.Equal, ComparisonOperator.NotEqual}
            and any(_subject(term, subjects) is not Subject.LABEL for term in (item.first, item.second))
            for item in items
        ):
            raise NotFlatError


class _Scope:
    """The variables of one rule."""

    def __init__(self, bodies: FlatBodies, clause: Clause) -> None:
        self._bodies, self._constants = bodies, bodies.constants
        self._named: dict[str, Term] = {}
        # global variables; all others are local to their condition
        self._whole = {
            name
            for conjunct in (clause.head, *clause.body)
            if conjunct is not None
            for name in global_variables(conjunct)
        }
        if not self._is_safe(clause.body):
            raise NotFlatError  # clingo says which variable nothing binds

    def _is_safe(self, body: Sequence[Conjunct]) -> bool:
        """Whether the rule is safe: positive atoms or equations bind each of its variables."""
        bound = {
            name
            for conjunct in body
            if isinstance(conjunct, Literal) and conjunct.positive
            for name in global_variables(conjunct)
        }
        before = -1
        while before != len(bound):
            before = len(bound)
            for conjunct in body:
                if isinstance(conjunct, Test) and (names := _equal(conjunct)) and len(names - bound) == 1:
                    bound |= names
        inner: list[tuple[Iterable[str], tuple[Conjunct, ...]]] = []  # names that conditions have to bind
        for conjunct in body:
            if isinstance(conjunct, Conditional):
                inner.append((global_variables(conjunct.literal), conjunct.condition))
            elif isinstance(conjunct, Aggregate):
                inner += [(variables(*element.terms), element.condition) for element in conjunct.elements]
        return bound >= self._whole and all(
            self._whole.union(
                name
                for conjunct in condition
                if isinstance(conjunct, Literal) and conjunct.positive
                for name in global_variables(conjunct)
            ).issuperset((*names, *(name for conjunct in condition for name in global_variables(conjunct))))
            for names, condition in inner
        )

    def unified(self, terms: Sequence[Term], head: Sequence[AST]) -> list[Item]:
        """Unify the head of a rule with the terms of an atom; return the equations that remain."""
        equations: list[Item] = []
        for term, argument in zip(terms, head, strict=True):
            if argument.ast_type == ASTType.Variable and argument.name not in self._named:
                self._named[argument.name] = term
            else:
                equations.append(Compare(ComparisonOperator.Equal, self.term(argument), term))
        return equations

    def term(self, node: AST) -> Term:
        """Return a term of clingo as a variable or a constant."""
        if node.ast_type == ASTType.Variable:
            if node.name == "_":
                return self._bodies.variable()
            if node.name not in self._named:
                self._named[node.name] = self._bodies.variable()
            return self._named[node.name]
        symbol = value(node, self._constants)
        if symbol is None:
            raise NotFlatError
        if symbol.type is SymbolType.Number:
            return Constant(symbol.number)
        return Constant(symbol.string if symbol.type is SymbolType.String else symbol)

    def disjuncts(self, conjuncts: Iterable[Conjunct]) -> list[Disjunct]:
        """Return a conjunction as a disjunction of conjunctions (disjunctive normal form)."""
        alternatives = [self._of_conjunct(conjunct) for conjunct in conjuncts]
        bodies: list[Disjunct] = []
        for combination in product(*alternatives):
            units = [disjunct.unit for disjunct in combination if disjunct.unit is not None]
            if len(units) > 1 or len(bodies) == _MAX_WAYS:
                raise NotFlatError
            items = tuple(item for disjunct in combination for item in disjunct.items)
            bodies.append(Disjunct(items, units[0] if units else None))
        return bodies

    def helpers(self, conjunct: Conjunct) -> list[Disjunct]:
        """Return the disjuncts whose units make a conjunct of a requiring rule false."""
        if isinstance(conjunct, Aggregate):
            if not _counts_none(conjunct, self._constants):
                raise NotFlatError
            return [
                disjunct
                for element in conjunct.elements
                for disjunct in self._inner_scope().disjuncts(element.condition)
            ]
        literal, condition = (
            (conjunct.literal, conjunct.condition) if isinstance(conjunct, Conditional) else (conjunct, ())
        )
        if not isinstance(literal, Literal) or literal.negations != 1:
            raise NotFlatError
        return self._inner_scope().disjuncts((literal._replace(negations=0), *condition))

    def summands(self, element: Element) -> list[tuple[Disjunct, Term]]:
        """Return the disjuncts of an element of a sum, each with the weight of one execution of its unit.

        The weight of several executions is a multiple of it, since nothing else in the condition reads
        their number.
        """
        scope = self._inner_scope()
        executions = [
            conjunct
            for conjunct in element.condition
            if isinstance(conjunct, Literal) and conjunct.positive and conjunct.signature in _ONE_EXECUTION
        ]
        if len(executions) != 1:
            raise NotFlatError
        unit, *count = map(scope.term, executions[0].arguments)
        *product, last = (scope.term(factor) for term in element.terms for factor in factors(term))
        for factor in count:
            if factor not in product or product.count(factor) > 1:
                raise NotFlatError
            product.remove(factor)
        if len(product) > 1 or last != unit:
            raise NotFlatError
        disjuncts = scope.disjuncts(element.condition)
        for disjunct in disjuncts:
            uses = [item for item in disjunct.items for factor in count if factor in set(_mentioned(item))]
            if disjunct.unit != unit or len(uses) != len(count):
                raise NotFlatError
        return [(disjunct, product[0] if product else Constant(1)) for disjunct in disjuncts]

    def _of_conjunct(self, conjunct: Conjunct) -> list[Disjunct]:
        """Return a conjunct as a disjunction."""
        if isinstance(conjunct, Literal):
            disjuncts = self._atom(conjunct)
            for _ in range(conjunct.negations):
                disjuncts = [_never(disjuncts, self._literal_variables(conjunct))]
            return disjuncts
        if isinstance(conjunct, Test):
            return self._test(conjunct, against=False)
        if isinstance(conjunct, Conditional) and not isinstance(conjunct.literal, Strange):
            # the negation: somewhere the condition holds, and the literal does not
            scope = self._inner_scope()
            if isinstance(conjunct.literal, Test):
                against = scope._test(conjunct.literal, against=True)
            elif conjunct.literal.negations == 1:
                against = scope._atom(conjunct.literal)
            else:
                against = [_never(scope._atom(conjunct.literal), scope._literal_variables(conjunct.literal))]
            inner = [
                Disjunct((*one.items, *other.items))
                for one in scope.disjuncts(conjunct.condition)
                for other in against
                if one.unit is None and other.unit is None
            ]
            return [_never(inner, self._outer_variables((conjunct.literal, *conjunct.condition)))]
        if isinstance(conjunct, Aggregate) and conjunct.function is AggregateFunction.Count:
            return [Disjunct((self._counted(conjunct),))]
        raise NotFlatError

    def _counted(self, aggregate: Aggregate) -> Counted:
        """Return a ``#count`` as an item, with its elements as disjuncts."""
        rows = []
        for element in aggregate.elements:
            scope = self._inner_scope()
            terms = tuple(map(scope.term, element.terms))
            for disjunct in scope.disjuncts(element.condition):
                if disjunct.unit is not None or not terms:  # without terms it counts atoms
                    raise NotFlatError
                rows.append((disjunct, terms))
        guards = tuple((guard.comparison, self.term(guard.term)) for guard in aggregate.guards)
        outer = self._outer_variables(
            (aggregate, *(inner for element in aggregate.elements for inner in element.condition))
        )
        return Counted(tuple(rows), guards, aggregate.negations == 1, outer)

    def _atom(self, literal: Literal) -> list[Disjunct]:
        if literal.signature[0].startswith("-"):
            raise NotFlatError
        return self._bodies.of_atom(literal.signature, tuple(map(self.term, literal.arguments)))

    def _test(self, test: Test, against: bool) -> list[Disjunct]:
        """Return a comparison as a disjunction; ``against`` returns its negation."""
        if test.holds is not None:
            return [Disjunct(())] if test.holds != against else []
        comparison = test.ast.atom
        terms = [self.term(term) for term in (comparison.term, *(g.term for g in comparison.guards))]
        operators = [ComparisonOperator(guard.comparison) for guard in comparison.guards]
        if against != (test.ast.sign == 1):
            if len(operators) > 1:
                raise NotFlatError
            operators = [_OPPOSITE[operators[0]]]
        pairs = zip(operators, terms, terms[1:], strict=False)
        return [Disjunct(tuple(Compare(*pair) for pair in pairs))]

    def _inner_scope(self) -> "_Scope":
        """Return the scope of a condition: the global variables of the rule, and fresh local ones."""
        for name in self._whole - self._named.keys():
            self._named[name] = self._bodies.variable()
        scope = copy(self)
        scope._named = {name: self._named[name] for name in self._named.keys() & self._whole}
        return scope

    def _literal_variables(self, literal: Literal) -> frozenset[Variable]:
        """Return the variables of a negated literal, which binds none of them."""
        return frozenset(_variables(self._named[name] for name in global_variables(literal)))

    def _outer_variables(self, conjuncts: Iterable[Conjunct]) -> frozenset[Variable]:
        """Return the global variables of the rule that occur in conjuncts."""
        names = (
            {name for conjunct in conjuncts for name in global_variables(conjunct)}
            & self._named.keys()
            & self._whole
        )
        return frozenset(_variables(self._named[name] for name in names))


def bound_by(items: Iterable[Item]) -> set[Variable]:
    """Return the variables that items bind."""
    return {variable for item in items for variable in _variables(_terms(item))}


def _equal(test: Test) -> set[str]:
    """Return the variables of an equation; none for another comparison."""
    if test.ast.sign or test.ast.atom.ast_type != ASTType.Comparison or len(test.ast.atom.guards) != 1:
        return set()
    is_equal = test.ast.atom.guards[0].comparison == ComparisonOperator.Equal
    return set(global_variables(test)) if is_equal else set()


def _mentioned(item: Item) -> Iterable[Variable]:
    """Return the variables that an item shares with other items."""
    return item.bound if isinstance(item, Never | Counted) else _variables(_terms(item))


def _counts_none(aggregate: Aggregate, constants: Constants) -> bool:
    """Whether a ``#count`` holds exactly where its count is 0."""
    if aggregate.function is not AggregateFunction.Count or len(aggregate.guards) != 1:
        return False
    bound = value(aggregate.guards[0].term, constants)
    if bound is None or bound.type is not SymbolType.Number:
        return False
    compares = [compared(Number(n), aggregate.guards[0].comparison, bound) for n in (0, 1, INT32_MAX)]
    expected = [not holds for holds in compares] if aggregate.negations == 1 else compares
    return expected == [True, False, False]


def _terms(item: Item) -> tuple[Term, ...]:
    if isinstance(item, Fact | Listed):
        return item.terms
    return (item.first, item.second) if isinstance(item, Compare) else ()


def _variables(terms: Iterable[Term]) -> list[Variable]:
    return [term for term in terms if isinstance(term, Variable)]


def _subject(term: Term, subjects: _Subjects) -> Subject:
    return subjects.get(term, Subject.LABEL) if isinstance(term, Variable) else Subject.LABEL


def _set_subject(term: Term, subject: Subject, subjects: _Subjects) -> None:
    """Set the subject of a variable; raises where it has another subject already."""
    if isinstance(term, Variable):
        if subjects.setdefault(term, subject) is not subject:
            raise NotFlatError
    elif subject is not Subject.LABEL:
        raise NotFlatError


def _never(disjuncts: Iterable[Disjunct], bound: frozenset[Variable]) -> Disjunct:
    disjuncts = tuple(disjuncts)
    if any(disjunct.unit is not None for disjunct in disjuncts):
        raise NotFlatError
    return Disjunct((Never(disjuncts, bound),))
