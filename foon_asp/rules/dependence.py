"""Monotonicity of predicates in the units of the tree: monotone, antimonotone, both or neither.

``available(O)`` holds if O is in the kitchen or a unit of the tree makes O. All units of a tree execute, so
``available`` is monotone. A predicate with neither rules nor facts never holds.
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
    Conjunct,
    Constants,
    Guard,
    Literal,
    Signature,
    UnknownConjunct,
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

_ArgumentPosition = tuple[Signature, int]


class Monotonicity(Flag):
    """How the truth of an atom depends on the units of the tree.

    ``GROWS``: more units can make it true, never false.
    ``SHRINKS``: more units can make it false, never true.
    ``BOTH``: more units can make it true or false.
    ``NOT``: it does not depend on them.
    """

    NOT = 0
    GROWS = 1
    SHRINKS = 2
    BOTH = 3

    def negated(self) -> "Monotonicity":
        """Return the monotonicity of the negation: ``GROWS`` and ``SHRINKS`` are swapped."""
        swapped = {Monotonicity.GROWS: Monotonicity.SHRINKS, Monotonicity.SHRINKS: Monotonicity.GROWS}
        return swapped.get(self, self)


class Doubt(NamedTuple):
    """The reason why the monotonicity of a predicate is unknown.

    ``source`` is the place of the rule that causes it; ``None`` if no rule does.
    """

    reason: str
    source: Source | None = None


class Dependence:
    """Monotonicity of each predicate of a program, computed as a fixpoint over its rules.

    ``varied`` are predicates whose atoms the question itself changes, such as ``available/1`` in the search
    for a shopping list; their monotonicity is unknown.

    ``doubts``: for each predicate in a head whose monotonicity is unknown, the reason.
    ``loops``: the predicates that depend on themselves through ``not``, an aggregate, a condition or a
    choice. The value is the place of a rule of this cycle.
    """

    def __init__(
        self, program: Sequence[Clause], constants: Constants, varied: Collection[Signature] = ()
    ) -> None:
        """Compute the monotonicity of all predicates, and the reasons why it is unknown for some."""
        self._constants = constants
        self._varied = frozenset(varied)
        self._depends: dict[Signature, Monotonicity] = {
            USE: Monotonicity.GROWS,
            AVAILABLE: Monotonicity.GROWS,
        }
        self.doubts: dict[Signature, Doubt] = {}
        self.loops: dict[Signature, Source] = {}  # predicates with recursion through negation or an aggregate
        self._nonnegative: set[_ArgumentPosition] = set()
        self._defined = {atom.signature for clause in program for atom in clause.heads}
        self._find_nonnegative(program)
        self._find_doubts(program)
        changed = True
        while changed:
            changed = False
            for clause in program:
                if clause.head is not None:
                    before = self.of_predicate(clause.head.signature)
                    after = before | self.of_body(clause.body)
                    changed |= after != before
                    self._depends[clause.head.signature] = after

    def of_predicate(self, signature: Signature) -> Monotonicity:
        """Return the monotonicity of a predicate.

        It is ``NOT`` for a predicate of facts, and for one that nothing defines.
        """
        return self._depends.get(signature, Monotonicity.NOT)

    def of_body(self, conjuncts: Iterable[Conjunct]) -> Monotonicity:
        """Return the monotonicity of a conjunction."""
        dependence = Monotonicity.NOT
        for conjunct in conjuncts:
            dependence |= self.of_conjunct(conjunct)
        return dependence

    def of_conjunct(self, conjunct: Conjunct) -> Monotonicity:
        """Return the monotonicity of one conjunct of a body.

        A comparison does not depend on units (``NOT``). A conjunct of unknown kind may depend on them in both
        directions (``BOTH``).
        """
        if isinstance(conjunct, Literal):
            depends = self.of_predicate(conjunct.signature)
            return depends.negated() if conjunct.negations == 1 else depends
        if isinstance(conjunct, Conditional):
            return self.of_conjunct(conjunct.literal) | self.of_body(conjunct.condition).negated()
        if isinstance(conjunct, Aggregate):
            return self._of_aggregate(conjunct)
        return Monotonicity.BOTH if isinstance(conjunct, UnknownConjunct) else Monotonicity.NOT

    def doubt(self, conjuncts: Iterable[Conjunct]) -> Doubt | None:
        """Return the first reason why the monotonicity of conjuncts is unknown; ``None`` if it is known."""
        conjuncts = tuple(conjuncts)
        for literal in literals(conjuncts):
            reason = self.doubts.get(literal.signature) or self._doubt_of_predicate(literal.signature)
            if reason:
                return reason
        unknown = next((conjunct for conjunct in conjuncts if isinstance(conjunct, UnknownConjunct)), None)
        return Doubt(f"{unknown.text} is nothing that is looked into") if unknown else None

    def _doubt_of_predicate(self, signature: Signature) -> Doubt | None:
        """Return why a predicate's monotonicity is unknown whatever its rules are, else ``None``.

        It is unknown for a predicate with a minus, and for one whose atoms the question changes. It is
        unknown for a predicate of the question's own encoding, with a reserved name. It is also unknown for a
        few facts that differ from search to search.
        """
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
        """Fill ``loops``, and fill ``doubts`` as a fixpoint.

        At first, the predicates in the head of a choice and those in ``loops`` have a doubt. Then a doubt
        about the body of a rule passes to the predicates in its head.
        """
        for clause in program:
            if not clause.plain:
                for atom in clause.heads:
                    reason = f"{predicate_text(atom.signature)} is left open by a rule whose head is a choice"
                    self.doubts.setdefault(atom.signature, Doubt(reason, clause.source))
        self._find_loops(program)
        changed = True
        while changed:
            changed = False
            for clause in program:
                doubt = self.doubt(clause.body)
                for atom in clause.heads if doubt else ():
                    if atom.signature not in self.doubts:
                        assert doubt
                        self.doubts[atom.signature] = Doubt(doubt.reason, doubt.source or clause.source)
                        changed = True

    def _find_loops(self, program: Sequence[Clause]) -> None:
        """Fill ``loops``; each predicate in ``loops`` gets a doubt, unless it already has one."""
        reads: defaultdict[Signature, set[Signature]] = defaultdict(set)
        nonpositive: list[tuple[Signature, Signature, Source]] = []
        for clause in program:
            for head in clause.heads:
                for read, is_positive in _predicates_read(clause.body, clause.plain):
                    reads[head.signature].add(read)
                    if not is_positive:
                        nonpositive.append((head.signature, read, clause.source))
        sources_of = {signature: _closure(signature, reads) for signature in reads}
        for head_signature, read, source in nonpositive:
            if head_signature not in sources_of.get(read, ()):
                continue
            for looped in sources_of[read]:
                if head_signature in sources_of.get(looped, ()):
                    self.loops.setdefault(looped, source)
                    reason = f"{predicate_text(looped)} is derived from itself through `not` or an aggregate"
                    self.doubts.setdefault(looped, Doubt(reason, source))

    def _find_nonnegative(self, program: Sequence[Clause]) -> None:
        """Set ``_nonnegative`` to the predicate arguments that are always numbers from 0.

        This is a greatest fixpoint: an argument is dropped as soon as some rule may derive anything else for
        it. Rules with a choice or disjunction as head are ignored: their predicates are in ``doubts`` anyway.
        """
        facts = {
            (signature, position) for signature, subjects in SUBJECTS.items() for position in subjects.numbers
        }
        derived = {
            (head.signature, position)
            for clause in program
            for head in clause.heads
            for position in range(head.signature[1])
        }
        self._nonnegative = facts | derived
        changed = True
        while changed:
            maybe_negative = {
                (clause.head.signature, position)
                for clause in program
                if clause.head is not None
                for position, term in enumerate(clause.head.arguments)
                if not self._is_nonnegative(term, clause.body)
            }
            changed = not maybe_negative.isdisjoint(self._nonnegative)
            self._nonnegative -= maybe_negative

    def _is_nonnegative(self, term: AST, condition: Iterable[Conjunct]) -> bool:
        """Whether a term is known to be a number from 0 where the condition holds.

        Among operations, only some products are recognised. One factor must be a number of executions, as
        ``N`` in ``times(U,N)``. The other factor must be known to be a number from 0.
        """
        condition = tuple(condition)
        product = factors(term)
        if len(product) > 1:
            counts = [str(literal.arguments[1]) for literal in condition if _is_times_atom(literal)]
            return any(
                str(count) in counts and self._is_nonnegative(weight, condition)
                for count, weight in (product, product[::-1])
            )
        symbol = value(term, self._constants)
        if symbol is not None:
            return symbol.type is SymbolType.Number and symbol.number >= 0
        return term.ast_type == ASTType.Variable and any(
            isinstance(conjunct, Literal)
            and conjunct.positive
            and any(
                (conjunct.signature, position) in self._nonnegative and str(argument) == str(term)
                for position, argument in enumerate(conjunct.arguments)
            )
            for conjunct in condition
        )

    def _of_aggregate(self, aggregate: Aggregate) -> Monotonicity:
        """Return the monotonicity of an aggregate.

        It is ``NOT`` if its conditions do not depend on the tree, or if its guards alone decide it.
        """
        conditions = Monotonicity.NOT
        for element in aggregate.elements:
            conditions |= self.of_body(element.condition)
        if conditions is Monotonicity.NOT or aggregate.holds is not None:
            return Monotonicity.NOT
        dependence = Monotonicity.NOT
        for guard in aggregate.guards:
            dependence |= self._of_guard(aggregate, guard, conditions)
        return dependence.negated() if aggregate.negations == 1 else dependence

    def _of_guard(self, aggregate: Aggregate, guard: Guard, conditions: Monotonicity) -> Monotonicity:
        """Return the monotonicity that an aggregate would have with only the given guard.

        ``conditions`` is the monotonicity of the conditions of the aggregate's elements. With ``>`` and
        ``>=``, the result is ``conditions``. With ``<`` and ``<=``, and for a count that equals 0, it is the
        negation of ``conditions``. For ``#min``, the directions are swapped. For any other ``=``, for ``!=``,
        and for a sum whose weights may be negative, the result is ``BOTH``.
        """
        operator, function = guard.comparison, aggregate.function
        if operator in {ComparisonOperator.Equal, ComparisonOperator.NotEqual}:
            if operator is ComparisonOperator.Equal and self._is_count_of_zero(aggregate, guard):
                return conditions.negated()
            return Monotonicity.BOTH
        if function is AggregateFunction.Sum and not all(
            self._is_nonnegative(element.terms[0], element.condition)
            for element in aggregate.elements
            if element.terms
        ):
            return Monotonicity.BOTH
        upwards = operator in {ComparisonOperator.GreaterThan, ComparisonOperator.GreaterEqual}
        if function is AggregateFunction.Min:
            upwards = not upwards
        return conditions if upwards else conditions.negated()

    def _is_count_of_zero(self, aggregate: Aggregate, guard: Guard) -> bool:
        """Whether an aggregate is a ``#count`` and the bound in its guard is 0."""
        bound = value(guard.term, self._constants)
        return (
            aggregate.function is AggregateFunction.Count
            and bound is not None
            and bound.type is SymbolType.Number
            and bound.number == 0
        )


def _is_times_atom(conjunct: Conjunct) -> TypeGuard[Literal]:
    """Whether a conjunct is an atom ``times(U,N)`` without ``not``."""
    return isinstance(conjunct, Literal) and conjunct.positive and conjunct.signature == TIMES


def predicate_text(signature: Signature) -> str:
    """Return a predicate with its arity, such as ``use/1``."""
    return f"{signature[0]}/{signature[1]}"


def _predicates_read(conjuncts: Iterable[Conjunct], is_positive: bool) -> Iterator[tuple[Signature, bool]]:
    """Yield the predicates that conjuncts read, each with whether it is read positively.

    A predicate is read positively if it is not negated, and stands in no aggregate or condition. With
    ``is_positive=False``, no predicate counts as read positively.
    """
    for conjunct in conjuncts:
        if isinstance(conjunct, Literal):
            yield conjunct.signature, is_positive and conjunct.positive
        elif isinstance(conjunct, Conditional):
            yield from _predicates_read((conjunct.literal,), is_positive)
            yield from _predicates_read(conjunct.condition, is_positive=False)
        elif isinstance(conjunct, Aggregate):
            for element in conjunct.elements:
                yield from _predicates_read(element.condition, is_positive=False)


def _closure(start: Signature, reads: Mapping[Signature, set[Signature]]) -> set[Signature]:
    """Return a predicate and all predicates that it is derived from, directly or through others.

    ``reads`` has the predicates in the bodies of the rules for a predicate.
    """
    closure, stack = {start}, [start]
    while stack:
        for source in reads.get(stack.pop(), ()):
            if source not in closure:
                closure.add(source)
                stack.append(source)
    return closure
