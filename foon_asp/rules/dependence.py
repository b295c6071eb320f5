"""How what rules derive depends on the tree: what grows with it, what shrinks, and what nobody can say.

``available(O)`` is at hand or made by a unit of the tree, all of which execute, so it grows with the tree.
Where rules say nothing of a predicate, and it is no fact, it never holds.
"""

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from enum import Flag
from typing import NamedTuple, TypeGuard

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator
from clingo.symbol import SymbolType

from foon_asp.encoding.encoding import PUBLIC
from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Constants,
    Guard,
    Literal,
    Part,
    Signature,
    Strange,
    factors,
    literals,
    value,
)
from foon_asp.rules.fact_subject import SUBJECTS

USE, AVAILABLE, TIMES = ("use", 1), ("available", 1), ("times", 2)

# Predicates of facts whose numbers depend on more than the unit they are about, and why.
_UNSURE = {
    ("risk", 2): "its numbers depend on which units there are",
    ("cost", 3): "its numbers depend on which units there are",
    ("optimize", 2): "it differs from one search of a question to the next",
}

_Place = tuple[Signature, int]


class Depends(Flag):
    """What becomes of something when units come to a tree: it may come to hold, or cease to hold."""

    NOT = 0
    GROWS = 1
    SHRINKS = 2
    BOTH = 3

    def negated(self) -> "Depends":
        """Return what becomes of its negation."""
        swapped = {Depends.GROWS: Depends.SHRINKS, Depends.SHRINKS: Depends.GROWS}
        return swapped.get(self, self)


class Doubt(NamedTuple):
    """Why nothing is known of a predicate, and where the reason stands, if in a rule."""

    reason: str
    source: Source | None = None


class Dependence:
    """What becomes of each predicate of a program when units come to a tree.

    ``varied`` are predicates that the question says otherwise, or more of.
    """

    def __init__(
        self, program: Sequence[Clause], constants: Constants, varied: Collection[Signature] = ()
    ) -> None:
        self._constants = constants
        self._varied = frozenset(varied)
        self._depends: dict[Signature, Depends] = {USE: Depends.GROWS, AVAILABLE: Depends.GROWS}
        self.doubts: dict[Signature, Doubt] = {}
        self.loops: dict[Signature, Source] = {}  # those derived from themselves in an unclear way
        self._at_least_0: set[_Place] = set()
        self._defined = {atom.signature for clause in program for atom in clause.heads}
        self._find_numbers(program)
        self._find_doubts(program)
        changed = True
        while changed:
            changed = False
            for clause in program:
                if clause.head is not None:
                    before = self.of(clause.head.signature)
                    after = before | self.of_parts(clause.body)
                    changed |= after != before
                    self._depends[clause.head.signature] = after

    def of(self, signature: Signature) -> Depends:
        """Return what becomes of the atoms of a predicate."""
        return self._depends.get(signature, Depends.NOT)

    def of_parts(self, parts: Iterable[Part]) -> Depends:
        """Return what becomes of parts of a body, all of which have to hold."""
        together = Depends.NOT
        for part in parts:
            together |= self.of_part(part)
        return together

    def of_part(self, part: Part) -> Depends:
        """Return what becomes of one part of a body."""
        if isinstance(part, Literal):
            depends = self.of(part.signature)
            return depends.negated() if part.negations == 1 else depends
        if isinstance(part, Conditional):
            return self.of_part(part.literal) | self.of_parts(part.condition).negated()
        if isinstance(part, Aggregate):
            return self._of_aggregate(part)
        return Depends.BOTH if isinstance(part, Strange) else Depends.NOT

    def doubt(self, parts: Iterable[Part]) -> Doubt | None:
        """Return why nothing is known of parts of a body, ``None`` where enough is."""
        parts = tuple(parts)
        for literal in literals(parts):
            found = self.doubts.get(literal.signature) or self._doubt_of(literal.signature)
            if found:
                return found
        strange = next((part for part in parts if isinstance(part, Strange)), None)
        return Doubt(f"{strange.text} is nothing that is looked into") if strange else None

    def _doubt_of(self, signature: Signature) -> Doubt | None:
        """Return why nothing is known of a predicate that has no rules here."""
        name, arity = signature
        if name.startswith("-"):
            return Doubt(f"{name}/{arity} is negated with a minus")
        if signature in self._varied:
            return Doubt(f"{name}/{arity} varies within this question")
        if signature in _UNSURE:
            return Doubt(f"of {name}/{arity}, {_UNSURE[signature]}")
        if name.startswith("_") and signature not in self._defined:
            return Doubt(f"{name}/{arity} belongs to a question, and not to its facts")
        if signature in PUBLIC - {USE, AVAILABLE} - SUBJECTS.keys() - self._defined:
            return Doubt(f"nothing is known here of {name}/{arity}")
        return None

    def _find_doubts(self, program: Sequence[Clause]) -> None:
        for clause in program:
            if not clause.plain:
                for atom in clause.heads:
                    reason = f"{named(atom.signature)} is left open by a rule whose head is a choice"
                    self.doubts.setdefault(atom.signature, Doubt(reason, clause.source))
        self._find_loops(program)
        changed = True
        while changed:
            changed = False
            for clause in program:
                found = self.doubt(clause.body)
                for atom in clause.heads if found else ():
                    if atom.signature not in self.doubts:
                        assert found
                        self.doubts[atom.signature] = Doubt(found.reason, found.source or clause.source)
                        changed = True

    def _find_loops(self, program: Sequence[Clause]) -> None:
        """Record the predicates that are derived from themselves through ``not`` or an aggregate."""
        reads: defaultdict[Signature, set[Signature]] = defaultdict(set)
        unclear: list[tuple[Signature, Signature, Source]] = []
        for clause in program:
            for head in clause.heads:
                for read, plainly in _reads(clause.body, clause.plain):
                    reads[head.signature].add(read)
                    if not plainly:
                        unclear.append((head.signature, read, clause.source))
        behind = {signature: _closure(signature, reads) for signature in reads}
        for head_signature, read, source in unclear:
            if head_signature not in behind.get(read, ()):
                continue
            for each in behind[read]:
                if head_signature in behind.get(each, ()):
                    self.loops.setdefault(each, source)
                    reason = f"{named(each)} is derived from itself through `not` or an aggregate"
                    self.doubts.setdefault(each, Doubt(reason, source))

    def _find_numbers(self, program: Sequence[Clause]) -> None:
        """Find the arguments of predicates that are never negative numbers."""
        facts = {(signature, place) for signature, each in SUBJECTS.items() for place in each.numbers}
        derived = {
            (head.signature, place)
            for clause in program
            for head in clause.heads
            for place in range(head.signature[1])
        }
        self._at_least_0 = facts | derived
        changed = True
        while changed:
            wrong = {
                (clause.head.signature, place)
                for clause in program
                if clause.head is not None
                for place, term in enumerate(clause.head.arguments)
                if not self._is_at_least_0(term, clause.body)
            }
            changed = not wrong.isdisjoint(self._at_least_0)
            self._at_least_0 -= wrong

    def _is_at_least_0(self, term: AST, condition: Iterable[Part]) -> bool:
        """Whether a term is a number from 0 wherever it is one and a condition holds.

        So is such a number times how often a unit is executed, which is once where items last.
        """
        condition = tuple(condition)
        product = factors(term)
        if len(product) > 1:
            counts = [str(each.arguments[1]) for each in condition if _counts_executions(each)]
            return any(
                str(count) in counts and self._is_at_least_0(other, condition)
                for count, other in (product, product[::-1])
            )
        known = value(term, self._constants)
        if known is not None:
            return known.type is SymbolType.Number and known.number >= 0
        return term.ast_type == ASTType.Variable and any(
            isinstance(part, Literal)
            and part.positive
            and any(
                (part.signature, place) in self._at_least_0 and str(argument) == str(term)
                for place, argument in enumerate(part.arguments)
            )
            for part in condition
        )

    def _of_aggregate(self, aggregate: Aggregate) -> Depends:
        conditions = Depends.NOT
        for element in aggregate.elements:
            conditions |= self.of_parts(element.condition)
        if conditions is Depends.NOT or aggregate.holds is not None:
            return Depends.NOT
        found = Depends.NOT
        for guard in aggregate.guards:
            found |= self._of_guard(aggregate, guard, conditions)
        return found.negated() if aggregate.negations == 1 else found

    def _of_guard(self, aggregate: Aggregate, guard: Guard, conditions: Depends) -> Depends:
        """Return what becomes of a comparison of an aggregate whose elements come and go in a known way."""
        operator, function = guard.comparison, aggregate.function
        if operator in {ComparisonOperator.Equal, ComparisonOperator.NotEqual}:
            if operator is ComparisonOperator.Equal and self._is_zero(aggregate, guard):
                return conditions.negated()
            return Depends.BOTH
        if function is AggregateFunction.Sum and not all(
            self._is_at_least_0(element.terms[0], element.condition)
            for element in aggregate.elements
            if element.terms
        ):
            return Depends.BOTH
        upwards = operator in {ComparisonOperator.GreaterThan, ComparisonOperator.GreaterEqual}
        if function is AggregateFunction.Min:
            upwards = not upwards
        return conditions if upwards else conditions.negated()

    def _is_zero(self, aggregate: Aggregate, guard: Guard) -> bool:
        """Whether a guard says that nothing is counted."""
        bound = value(guard.term, self._constants)
        return (
            aggregate.function is AggregateFunction.Count
            and bound is not None
            and bound.type is SymbolType.Number
            and bound.number == 0
        )


def _counts_executions(part: Part) -> TypeGuard[Literal]:
    return isinstance(part, Literal) and part.positive and part.signature == TIMES


def named(signature: Signature) -> str:
    """Write a predicate with its arity."""
    return f"{signature[0]}/{signature[1]}"


def _reads(parts: Iterable[Part], plainly: bool) -> Iterator[tuple[Signature, bool]]:
    """Return the predicates that a body reads, and whether as they are: not negated, and in no aggregate."""
    for part in parts:
        if isinstance(part, Literal):
            yield part.signature, plainly and part.positive
        elif isinstance(part, Conditional):
            yield from _reads((part.literal,), plainly)
            yield from _reads(part.condition, plainly=False)
        elif isinstance(part, Aggregate):
            for element in part.elements:
                yield from _reads(element.condition, plainly=False)


def _closure(start: Signature, reads: Mapping[Signature, set[Signature]]) -> set[Signature]:
    """Return a predicate and all that it is derived from."""
    found, stack = {start}, [start]
    while stack:
        for read in reads.get(stack.pop(), ()):
            if read not in found:
                found.add(read)
                stack.append(read)
    return found
