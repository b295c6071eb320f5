"""Flat bodies: rules that are understood, as questions about one unit of the tree at a time.

A body is flat if auxiliary predicates are unfolded, and what is left are facts, texts and whole numbers,
comparisons, counts of facts, and bodies that must not hold. A rule with flat bodies removes units, asks for
one unit of a set, or bounds a sum over units. Everything else (arithmetic, intervals, sums within a body,
recursion, variables that nothing binds, two units that together break a rule) is left to the search.
"""

from collections.abc import Iterable, Sequence
from copy import copy
from itertools import product
from typing import Final, NamedTuple

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Constants,
    Element,
    Literal,
    Part,
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

_OFTEN = {"input", "output", "needs", "gives", "state", "ingredient", "located", "source", "video"}
_READ = _OFTEN | {"motion", "label", "inputs", "ingredients", "rate", "price"}
_READ |= {"unit", "object", "kitchen", "utensil", "goal"}
_MOST = 256  # ways in which a body can hold that are followed
_ONE_EXECUTION = {USE, TIMES}
NUMBER: Final = ("_number", 2)  # of a unit: what ``use(17)`` says
_SUBJECTS = {**SUBJECTS, NUMBER: Subjects({0: Subject.UNIT}, {})}

# What a forbidden comparison leaves: whether that is at least or at most the number, and how far from it.
_ALLOWED = {
    ComparisonOperator.GreaterThan: (False, 0),
    ComparisonOperator.GreaterEqual: (False, -1),
    ComparisonOperator.LessThan: (True, 0),
    ComparisonOperator.LessEqual: (True, 1),
}


class NotFlatError(Exception):
    """A rule is not understood, and left to the search."""


class Variable(int):
    """A variable, by number."""


class Constant(NamedTuple):
    """A value that stands in a rule: a text, a whole number, or any other symbol as it is."""

    value: str | int | Symbol


Term = Variable | Constant


class Fact(NamedTuple):
    """That a fact is there."""

    signature: Signature
    terms: tuple[Term, ...]


class Listed(NamedTuple):
    """That a row is in the table of a helper predicate."""

    signature: Signature
    terms: tuple[Term, ...]


class Compare(NamedTuple):
    """That two terms compare in a way."""

    comparison: ComparisonOperator
    left: Term
    right: Term


class Never(NamedTuple):
    """That none of some ways holds; the variables ``given`` have their values before."""

    ways: "tuple[Way, ...]"
    given: frozenset[Variable]


class Counted(NamedTuple):
    """That as many rows as some ways give to their terms compare with all of some terms, or do not."""

    rows: "tuple[tuple[Way, tuple[Term, ...]], ...]"
    guards: tuple[tuple[ComparisonOperator, Term], ...]
    negated: bool
    given: frozenset[Variable]


Item = Fact | Listed | Compare | Never | Counted


class Way(NamedTuple):
    """A way in which a body can hold, and the variable of the unit of the tree that it takes, if any."""

    items: tuple[Item, ...]
    unit: Variable | None = None


class Table(NamedTuple):
    """A helper predicate that is derived from goals and other tables alone.

    ``rows`` are the ways in which it holds, each with the terms of its head; ``subjects`` say what its
    arguments stand for.
    """

    rows: tuple[tuple[Way, tuple[Term, ...]], ...]
    subjects: tuple[Subject, ...]


class Asking(NamedTuple):
    """A requiring rule: wherever ``when`` holds, it asks for a unit that one of ``helping`` is true of."""

    when: Way
    helping: tuple[Way, ...]


class Row(NamedTuple):
    """A rule that bounds a sum over units: its ``terms`` are at most ``bound`` together, or ``at_least``.

    A term is a way that takes a unit, with what one execution of that unit counts; equal numbers that several
    ways give a unit count once. If it says what is ``used``, a unit counts once however often it is executed.
    ``each`` says that the bound is for each unit by itself.
    """

    terms: tuple[tuple[Way, Term], ...]
    bound: int
    at_least: bool = False
    used: bool = False
    each: bool = False


_Subjects = dict[Variable, Subject]  # LABEL for whatever is no id
_OPPOSITE = {
    ComparisonOperator.Equal: ComparisonOperator.NotEqual,
    ComparisonOperator.NotEqual: ComparisonOperator.Equal,
    ComparisonOperator.LessThan: ComparisonOperator.GreaterEqual,
    ComparisonOperator.GreaterEqual: ComparisonOperator.LessThan,
    ComparisonOperator.GreaterThan: ComparisonOperator.LessEqual,
    ComparisonOperator.LessEqual: ComparisonOperator.GreaterThan,
}


class FlatBodies:
    """Makes bodies of a program flat; raises :class:`NotFlatError` for those that are left to the search.

    The items of a way are in an order in which each variable has its value before it is needed. ``tables``
    are the auxiliary predicates that they look at, ``size`` is above the number of each variable.
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
        self._open: list[Signature] = []  # that are being looked into
        self.size = 0

    def ways(self, clause: Clause) -> tuple[Way, ...]:
        """Return the ways in which the body of a rule holds."""
        return tuple(self._sorted(way, frozenset(), {}) for way in _Scope(self, clause).ways(clause.body))

    def askings(self, clause: Clause) -> tuple[Asking, ...]:
        """Return what a rule asks for that requires one unit of a set, or of each of several sets."""
        scope = _Scope(self, clause)
        deciding = [part for part in clause.body if self._dependence.of_part(part) is not Depends.NOT]
        askings = []
        for way in scope.ways([part for part in clause.body if part not in deciding]):
            subjects: _Subjects = {}
            when = self._sorted(way, frozenset(), subjects)
            known = frozenset(subjects)
            helping = [
                self._sorted(each, known, dict(subjects)) for part in deciding for each in scope.helping(part)
            ]
            askings.append(Asking(when, tuple(helping)))
        return tuple(askings)

    def row(self, clause: Clause) -> Row:
        """Return the sum over units that a rule bounds: ``#sum { N,U : times(U,N) } > 9`` and the like."""
        scope = _Scope(self, clause)
        counts = [part for part in clause.body if isinstance(part, Aggregate)]
        if not counts:
            return self._row_of_each(scope, clause.body)
        if len(clause.body) > 1 or counts[0].negations or len(counts[0].guards) != 1:
            raise NotFlatError
        at_least, bound = self._allowed(counts[0].guards[0].comparison, counts[0].guards[0].term)
        terms = tuple(term for each in counts[0].elements for term in self._terms(scope, counts[0], each))
        deciding = {
            literal.signature
            for element in counts[0].elements
            for literal in element.condition
            if isinstance(literal, Literal) and literal.signature in _ONE_EXECUTION
        }
        if len(deciding) != 1:
            raise NotFlatError
        return Row(terms, bound, at_least, deciding == {USE})

    def _row_of_each(self, scope: "_Scope", body: Sequence[Part]) -> Row:
        """Return the row of ``:- times(U,N), N > 2, ...``."""
        for part in body:
            if not isinstance(part, Test) or part.ast.sign or part.ast.atom.ast_type != ASTType.Comparison:
                continue
            count, guards = part.ast.atom.term, part.ast.atom.guards
            condition = tuple(each for each in body if each is not part)
            times = [each for each in condition if isinstance(each, Literal) and each.signature == TIMES]
            if len(guards) != 1 or len(times) != 1 or times[0].arguments[1] != count:
                continue
            at_least, bound = self._allowed(guards[0].comparison, guards[0].term)
            if not at_least:
                element = Element((count, times[0].arguments[0]), condition)
                return Row(tuple(self._terms(scope, None, element)), bound, each=True)
        raise NotFlatError

    def _allowed(self, comparison: int, term: AST) -> tuple[bool, int]:
        """Return what is left if a comparison with a number is forbidden: whether at least, and how much."""
        number, sides = value(term, self.constants), _ALLOWED.get(ComparisonOperator(comparison))
        if number is None or number.type is not SymbolType.Number or sides is None:
            raise NotFlatError
        return sides[0], number.number + sides[1]

    def _terms(self, scope: "_Scope", counts: Aggregate | None, element: Element) -> list[tuple[Way, Term]]:
        """Return the terms of a row that one element of a sum or a count stands for."""
        is_count = counts is not None and counts.function is AggregateFunction.Count
        is_sum = counts is None or counts.function is AggregateFunction.Sum
        if not (is_count and len(element.terms) == 1) and not (is_sum and len(element.terms) == 2):
            raise NotFlatError
        found = []
        for way, weight in scope.summands(element):
            subjects: _Subjects = {}
            found.append((self._sorted(way, frozenset(), subjects), weight))
            if isinstance(weight, Variable) and subjects.get(weight) is not Subject.LABEL:
                raise NotFlatError
        return found

    def variable(self) -> Variable:
        """Return a variable that is nowhere yet."""
        self.size += 1
        return Variable(self.size - 1)

    def of_atom(self, signature: Signature, terms: tuple[Term, ...]) -> list[Way]:
        """Return the ways in which an atom holds, their items in any order."""
        if signature == USE:
            if isinstance(terms[0], Variable):
                return [Way((), terms[0])]
            unit = self.variable()
            return [Way((Fact(NUMBER, (unit, *terms)),), unit)]
        if signature == AVAILABLE:
            unit = self.variable()
            return [Way((Fact(("kitchen", 1), terms),)), Way((Fact(("gives", 2), (unit, *terms)),), unit)]
        if signature in SUBJECTS:
            if signature[0] not in _READ:
                raise NotFlatError
            return [Way((Fact(signature, terms),))]
        if signature in self._open:
            raise NotFlatError
        self._open.append(signature)
        try:
            if self._is_table(signature):
                return [Way((Listed(signature, terms),))]
            ways: list[Way] = []
            for clause in self._rules.get(signature, ()):
                scope = _Scope(self, clause)
                assert clause.head is not None
                equal = scope.called(terms, clause.head.arguments)
                ways += [way._replace(items=(*equal, *way.items)) for way in scope.ways(clause.body)]
            return ways
        finally:
            self._open.pop()

    def _is_table(self, signature: Signature) -> bool:
        """Whether a predicate is a table; makes it one if it is met first."""
        if signature not in self.tables:
            depends = self._dependence.of(signature) is not Depends.NOT
            doubtful = depends or signature in self._dependence.doubts
            if signature not in self._rules or doubtful or not self._locality.closed(signature):
                return False
            rows = []
            kinds = set()
            for clause in self._rules[signature]:
                assert clause.head is not None
                scope = _Scope(self, clause)
                head = tuple(map(scope.term, clause.head.arguments))
                for way in scope.ways(clause.body):
                    subjects: _Subjects = {}
                    rows.append((self._sorted(way, frozenset(), subjects), head))
                    if not subjects.keys() >= set(_variables(head)):
                        raise NotFlatError
                    kinds.add(tuple(_subject(term, subjects) for term in head))
            if len(kinds) > 1:
                raise NotFlatError
            any_ = (Subject.LABEL,) * signature[1]
            self.tables[signature] = Table(tuple(rows), kinds.pop() if kinds else any_)
        return True

    def _sorted(self, way: Way, known: frozenset[Variable], subjects: _Subjects) -> Way:
        """Put the items of a way in order; ``subjects`` are filled with those of its variables."""
        bound = set(known)
        if way.unit is not None:
            if way.unit in bound:
                raise NotFlatError  # one unit that something else says, by its number
            bound.add(way.unit)
            subjects[way.unit] = Subject.UNIT
        self._find_subjects(way.items, subjects)
        left, items = list(way.items), list[Item]()
        while left:
            ready = [
                (cost, place) for place, item in enumerate(left) if (cost := self._cost(item, bound)) >= 0
            ]
            if not ready:
                raise NotFlatError
            item = left.pop(min(ready)[1])
            if isinstance(item, Never):
                inner = (self._sorted(each, item.given, dict(subjects)) for each in item.ways)
                item = item._replace(ways=tuple(inner))
            elif isinstance(item, Counted):
                rows = ((self._sorted(each, item.given, dict(subjects)), row) for each, row in item.rows)
                item = item._replace(rows=tuple(rows))
            else:
                bound.update(_variables(_terms(item)))
            items.append(item)
        return way._replace(items=tuple(items))

    def _cost(self, item: Item, bound: set[Variable]) -> int:
        """Say how soon an item should be looked at, negative where values that it needs are not there yet."""
        if isinstance(item, Never | Counted):
            return 3 if item.given <= bound else -1
        free = [variable not in bound for variable in _variables(_terms(item))]
        if isinstance(item, Compare):
            binds = sum(free) == 1 and item.comparison is ComparisonOperator.Equal
            return 0 if not any(free) else 1 if binds else -1
        if isinstance(item, Listed):
            return 10 if any(free) else 1
        about = _SUBJECTS[item.signature].about
        if not bound.issuperset(_variables(item.terms[place] for place in about)):
            return -1
        if item.signature == ("goal", 1):
            return 20 if any(free) else 0
        return (5 if any(free) else 1) if item.signature[0] in _OFTEN else 0

    def _find_subjects(self, items: Iterable[Item], subjects: _Subjects) -> None:
        """Find out what variables stand for; raises where one stands for two things."""
        before = -1
        while before != len(subjects):
            before = len(subjects)
            for item in items:
                if isinstance(item, Fact):
                    facts = _SUBJECTS[item.signature]
                    of = {**facts.about, **facts.leads_to}
                    for place, term in enumerate(item.terms):
                        _set_subject(term, of.get(place, Subject.LABEL), subjects)
                elif isinstance(item, Listed):
                    for term, subject in zip(item.terms, self.tables[item.signature].subjects, strict=True):
                        _set_subject(term, subject, subjects)
                elif isinstance(item, Compare):
                    for one, other in ((item.left, item.right), (item.right, item.left)):
                        if isinstance(one, Constant) or one in subjects:
                            _set_subject(other, _subject(one, subjects), subjects)
        if any(
            isinstance(item, Compare)
            and item.comparison not in {ComparisonOperator.Equal, ComparisonOperator.NotEqual}
            and any(_subject(term, subjects) is not Subject.LABEL for term in (item.left, item.right))
            for item in items
        ):
            raise NotFlatError


class _Scope:
    """The variables of one rule."""

    def __init__(self, bodies: FlatBodies, clause: Clause) -> None:
        self._bodies, self._constants = bodies, bodies.constants
        self._named: dict[str, Term] = {}
        # those that a rule has as a whole; others are of their condition alone
        self._whole = {
            name
            for part in (clause.head, *clause.body)
            if part is not None
            for name in global_variables(part)
        }
        if not self._is_safe(clause.body):
            raise NotFlatError  # clingo says which variable nothing binds

    def _is_safe(self, body: Sequence[Part]) -> bool:
        """Whether all variables are surely bound: by atoms that are not negated, or by what they equal."""
        bound = {
            name
            for part in body
            if isinstance(part, Literal) and part.positive
            for name in global_variables(part)
        }
        before = -1
        while before != len(bound):
            before = len(bound)
            for part in body:
                if isinstance(part, Test) and (names := _equal(part)) and len(names - bound) == 1:
                    bound |= names
        inner: list[tuple[Iterable[str], tuple[Part, ...]]] = []  # names that conditions have to bind
        for part in body:
            if isinstance(part, Conditional):
                inner.append((global_variables(part.literal), part.condition))
            elif isinstance(part, Aggregate):
                inner += [(variables(*element.terms), element.condition) for element in part.elements]
        return bound >= self._whole and all(
            self._whole.union(
                name
                for each in condition
                if isinstance(each, Literal) and each.positive
                for name in global_variables(each)
            ).issuperset((*names, *(name for each in condition for name in global_variables(each))))
            for names, condition in inner
        )

    def called(self, terms: Sequence[Term], head: Sequence[AST]) -> list[Item]:
        """Return the variables of a head the terms of an atom; gives what has to be equal besides."""
        equal: list[Item] = []
        for term, argument in zip(terms, head, strict=True):
            if argument.ast_type == ASTType.Variable and argument.name not in self._named:
                self._named[argument.name] = term
            else:
                equal.append(Compare(ComparisonOperator.Equal, self.term(argument), term))
        return equal

    def term(self, node: AST) -> Term:
        """Return a variable or a value."""
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

    def ways(self, parts: Iterable[Part]) -> list[Way]:
        """Return the ways in which parts of a body hold together."""
        each = [self._of_part(part) for part in parts]
        found: list[Way] = []
        for chosen in product(*each):
            units = [way.unit for way in chosen if way.unit is not None]
            if len(units) > 1 or len(found) == _MOST:
                raise NotFlatError
            items = tuple(item for way in chosen for item in way.items)
            found.append(Way(items, units[0] if units else None))
        return found

    def helping(self, part: Part) -> list[Way]:
        """Return the ways in which a unit keeps a part of a requiring rule from holding."""
        if isinstance(part, Aggregate):
            if not _counts_none(part, self._constants):
                raise NotFlatError
            return [way for each in part.elements for way in self._within().ways(each.condition)]
        literal, condition = (part.literal, part.condition) if isinstance(part, Conditional) else (part, ())
        if not isinstance(literal, Literal) or literal.negations != 1:
            raise NotFlatError
        return self._within().ways((literal._replace(negations=0), *condition))

    def summands(self, element: Element) -> list[tuple[Way, Term]]:
        """Return the ways in which units count in an element of a sum, each with what one execution counts.

        That is as many times as much for several executions: how many there are stands nowhere else.
        """
        within = self._within()
        executions = [
            part
            for part in element.condition
            if isinstance(part, Literal) and part.positive and part.signature in _ONE_EXECUTION
        ]
        if len(executions) != 1:
            raise NotFlatError
        unit, *count = map(within.term, executions[0].arguments)
        *product, last = (within.term(each) for term in element.terms for each in factors(term))
        for each in count:
            if each not in product or product.count(each) > 1:
                raise NotFlatError
            product.remove(each)
        if len(product) > 1 or last != unit:
            raise NotFlatError
        ways = within.ways(element.condition)
        for way in ways:
            uses = [item for item in way.items for each in count if each in set(_mentioned(item))]
            if way.unit != unit or len(uses) != len(count):
                raise NotFlatError
        return [(way, product[0] if product else Constant(1)) for way in ways]

    def _of_part(self, part: Part) -> list[Way]:
        if isinstance(part, Literal):
            ways = self._atom(part)
            for _ in range(part.negations):
                ways = [_never(ways, self._having(part))]
            return ways
        if isinstance(part, Test):
            return self._test(part, against=False)
        if isinstance(part, Conditional) and not isinstance(part.literal, Strange):
            # nowhere does the condition hold without the literal
            within = self._within()
            if isinstance(part.literal, Test):
                against = within._test(part.literal, against=True)
            elif part.literal.negations == 1:
                against = within._atom(part.literal)
            else:
                against = [_never(within._atom(part.literal), within._having(part.literal))]
            inner = [
                Way((*one.items, *other.items))
                for one in within.ways(part.condition)
                for other in against
                if one.unit is None and other.unit is None
            ]
            return [_never(inner, self._given((part.literal, *part.condition)))]
        if isinstance(part, Aggregate) and part.function is AggregateFunction.Count:
            return [Way((self._counted(part),))]
        raise NotFlatError

    def _counted(self, part: Aggregate) -> Counted:
        rows = []
        for element in part.elements:
            within = self._within()
            terms = tuple(map(within.term, element.terms))
            for way in within.ways(element.condition):
                if way.unit is not None or not terms:  # without terms it counts atoms
                    raise NotFlatError
                rows.append((way, terms))
        guards = tuple((guard.comparison, self.term(guard.term)) for guard in part.guards)
        given = self._given((part, *(each for element in part.elements for each in element.condition)))
        return Counted(tuple(rows), guards, part.negations == 1, given)

    def _atom(self, literal: Literal) -> list[Way]:
        if literal.signature[0].startswith("-"):
            raise NotFlatError
        return self._bodies.of_atom(literal.signature, tuple(map(self.term, literal.arguments)))

    def _test(self, test: Test, against: bool) -> list[Way]:
        """Return the ways in which a comparison holds, or does not."""
        if test.holds is not None:
            return [Way(())] if test.holds != against else []
        comparison = test.ast.atom
        terms = [self.term(term) for term in (comparison.term, *(g.term for g in comparison.guards))]
        operators = [ComparisonOperator(guard.comparison) for guard in comparison.guards]
        if against != (test.ast.sign == 1):
            if len(operators) > 1:
                raise NotFlatError
            operators = [_OPPOSITE[operators[0]]]
        pairs = zip(operators, terms, terms[1:], strict=False)
        return [Way(tuple(Compare(*each) for each in pairs))]

    def _within(self) -> "_Scope":
        """Return the variables within a condition: those of the whole rule, and others of its own."""
        for name in self._whole - self._named.keys():
            self._named[name] = self._bodies.variable()
        scope = copy(self)
        scope._named = {name: self._named[name] for name in self._named.keys() & self._whole}
        return scope

    def _having(self, literal: Literal) -> frozenset[Variable]:
        """Return the variables of a literal that gives none of them a value."""
        return frozenset(_variables(self._named[name] for name in global_variables(literal)))

    def _given(self, parts: Iterable[Part]) -> frozenset[Variable]:
        """Return the variables of the whole rule that parts of it have."""
        names = {name for part in parts for name in global_variables(part)} & self._named.keys() & self._whole
        return frozenset(_variables(self._named[name] for name in names))


def bound_by(items: Iterable[Item]) -> set[Variable]:
    """Return the variables that have their values once items hold."""
    return {variable for item in items for variable in _variables(_terms(item))}


def _equal(test: Test) -> set[str]:
    """Return the variables of a comparison that gives a variable the value of another, or of a constant."""
    if test.ast.sign or test.ast.atom.ast_type != ASTType.Comparison or len(test.ast.atom.guards) != 1:
        return set()
    is_equal = test.ast.atom.guards[0].comparison == ComparisonOperator.Equal
    return set(global_variables(test)) if is_equal else set()


def _mentioned(item: Item) -> Iterable[Variable]:
    """Return the variables of an item whose values it shares with others."""
    return item.given if isinstance(item, Never | Counted) else _variables(_terms(item))


def _counts_none(aggregate: Aggregate, constants: Constants) -> bool:
    """Whether an aggregate says no more than that nothing is counted."""
    if aggregate.function is not AggregateFunction.Count or len(aggregate.guards) != 1:
        return False
    bound = value(aggregate.guards[0].term, constants)
    if bound is None or bound.type is not SymbolType.Number:
        return False
    compares = [compared(Number(n), aggregate.guards[0].comparison, bound) for n in (0, 1, 2**31 - 1)]
    says = [not each for each in compares] if aggregate.negations == 1 else compares
    return says == [True, False, False]


def _terms(item: Item) -> tuple[Term, ...]:
    if isinstance(item, Fact | Listed):
        return item.terms
    return (item.left, item.right) if isinstance(item, Compare) else ()


def _variables(terms: Iterable[Term]) -> list[Variable]:
    return [term for term in terms if isinstance(term, Variable)]


def _subject(term: Term, subjects: _Subjects) -> Subject:
    return subjects.get(term, Subject.LABEL) if isinstance(term, Variable) else Subject.LABEL


def _set_subject(term: Term, subject: Subject, subjects: _Subjects) -> None:
    if isinstance(term, Variable):
        if subjects.setdefault(term, subject) is not subject:
            raise NotFlatError
    elif subject is not Subject.LABEL:
        raise NotFlatError


def _never(ways: Iterable[Way], given: frozenset[Variable]) -> Way:
    ways = tuple(ways)
    if any(way.unit is not None for way in ways):
        raise NotFlatError
    return Way((Never(ways, given),))
