"""What rules do to the trees of one question, and how far they see: read from clingo's syntax tree.

All rules of a question are looked at together, since a rule in another file may change what one does. Where
anything is in doubt, a rule is ``OTHER``; docs/writing-constraints.md says what that means for the user.
"""

from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence
from enum import StrEnum
from functools import cache
from typing import NamedTuple

from clingo import Number
from clingo.ast import AST, AggregateFunction, ASTType, parse_string
from clingo.symbol import SymbolType

from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Constants,
    Literal,
    Part,
    Signature,
    Test,
    clauses,
    compared,
    constant_values,
    literals,
    place,
    plain_value,
    value,
)
from foon_asp.rules.dependence import AVAILABLE, USE, Dependence, Depends, Doubt
from foon_asp.rules.fact_values import COLUMNS, misplaced
from foon_asp.rules.locality import Locality


class Kind(StrEnum):
    """What a rule does.

    ``FACT``: there is no decision in it: it holds for every tree, or for none. ``DELETING``: a tree keeps to
    it as long as it has none of some units. ``SHRINKING``: if a tree keeps to it, so does every tree whose
    units are a subset. ``REQUIRING``: if a tree keeps to it, so does every tree whose units are a superset.
    ``OTHER``: none of these is known. ``HELPER``: it derives what other rules look at, and rules nothing out
    by itself.
    """

    FACT = "fact"
    DELETING = "deleting"
    SHRINKING = "shrinking"
    REQUIRING = "requiring"
    OTHER = "other"
    HELPER = "helper"


# Statements that are no rules, and change nothing in which trees there are.
_WITHOUT_EFFECT = {
    ASTType.Comment,
    ASTType.Defined,
    ASTType.Definition,
    ASTType.Program,
    ASTType.ShowSignature,
}


_NEVER = "a condition in it never holds"

# What our encoding of a tree says of a predicate that rules may look at, where items do not run out.
_IMPLIED = "times(U,1) :- use(U)."


class Rule(NamedTuple):
    """A rule of one question, and what it does.

    ``reason`` says why nothing more is known where its kind is ``OTHER``, and why it has no effect where it
    has none; ``reason_source`` where that stands. ``further`` says what it sees beyond the tree, at
    ``further_source``: if that is empty, the rule is local, and what it says of a tree stays the same when
    facts of units outside the tree, and of object nodes that only those have, are left out. A ``HELPER`` is
    always local: what it sees counts for the rules that use it. ``one_of`` says that a requiring rule asks
    for one unit of a set, or of each of several sets.
    """

    source: Source
    kind: Kind
    reason: str = ""
    reason_source: Source | None = None
    further: str = ""
    further_source: Source | None = None
    one_of: bool = False

    @property
    def local(self) -> bool:
        """Whether it sees no further than the tree."""
        return not self.further

    @property
    def without_effect(self) -> bool:
        """Whether it says nothing of any tree, since a condition in it never holds."""
        return bool(self.reason) and self.kind is not Kind.OTHER


class Analysis:
    """The rules of one question, taken apart, with what each does.

    ``rules`` are in the order of the files, ``live`` the clauses that can have an effect: those with a
    condition that never holds are not among them. ``of_rule`` has the live clauses of each rule, by its place
    in ``rules``. ``lifted`` are the predicates of which one unit of the tree, or none, decides each atom.
    """

    def __init__(
        self, statements: Iterable[AST], settings: Sequence[str], varied: Collection[Signature] = ()
    ) -> None:
        """Look at parsed statements.

        ``settings`` are the constants that are set, as ``name=value`` for clingo.
        """
        statements = tuple(statements)
        self.definitions = [each for each in statements if each.ast_type == ASTType.Definition]
        self.constants: Constants = constant_values(self.definitions, settings)
        self.statements = [each for each in statements if each.ast_type not in _WITHOUT_EFFECT]
        taken = [
            list(clauses(each, number, self.constants)) if each.ast_type == ASTType.Rule else []
            for number, each in enumerate(self.statements)
        ]
        self.of_rule = [[clause for clause in each if self._why_never(clause.body) is None] for each in taken]
        self.live = [clause for each in (*self.of_rule, _implied()) for clause in each]
        self.dependence = Dependence(self.live, self.constants, varied)
        self.lifted = self._find_lifted()
        self._locality = Locality(self.live, self.dependence)
        self.rules = tuple(
            self._rule(statement, live) for statement, live in zip(self.statements, self.of_rule, strict=True)
        )

    def kind(self, clause: Clause) -> tuple[Kind, Doubt | None]:
        """Say what a clause does, and why nothing more is known."""
        dependence = self.dependence
        doubt: Doubt | None
        if not clause.plain:
            doubt = Doubt("its head leaves a choice, or is negated", clause.source)
        elif clause.head is not None:
            name = clause.head.signature
            doubt = dependence.doubts[name] if name in dependence.loops else None
        else:
            doubt = dependence.doubt(clause.body)
        if doubt:
            return Kind.OTHER, doubt
        if clause.head is not None:
            return Kind.HELPER, None
        kinds = {
            Depends.NOT: Kind.FACT,
            Depends.GROWS: Kind.DELETING if self.lifts(clause) else Kind.SHRINKING,
            Depends.SHRINKS: Kind.REQUIRING,
            Depends.BOTH: Kind.OTHER,
        }
        kind = kinds[dependence.of_parts(clause.body)]
        return kind, self._why_both(clause) if kind is Kind.OTHER else None

    def reads(self, signature: Signature) -> bool:
        """Whether some rule looks at a predicate."""
        return any(each.signature == signature for clause in self.live for each in literals(clause.body))

    def is_closed(self, signature: Signature) -> bool:
        """Whether a helper has the same atoms for every tree, and whatever is beyond it."""
        free = self.dependence.of(signature) is Depends.NOT and signature not in self.dependence.doubts
        return free and self._locality.closed(signature)

    def deciding(self, body: Iterable[Part]) -> list[Part]:
        """Give the parts of a body that depend on the tree."""
        return [part for part in body if self.dependence.of_part(part) is not Depends.NOT]

    def lifts(self, clause: Clause) -> bool:
        """Whether all that a body says of the tree is one atom that a single unit of it decides."""
        deciding = self.deciding(clause.body)
        return len(deciding) <= 1 and all(map(self._is_lifted, deciding))

    def _counts_none(self, aggregate: Aggregate) -> bool:
        """Whether an aggregate says no more than that nothing is counted."""
        if aggregate.function is not AggregateFunction.Count or len(aggregate.guards) != 1:
            return False
        bound = value(aggregate.guards[0].term, self.constants)
        if bound is None or bound.type is not SymbolType.Number:
            return False
        compares = [compared(Number(n), aggregate.guards[0].comparison, bound) for n in (0, 1, 2**31 - 1)]
        says = [not each for each in compares] if aggregate.negations == 1 else compares
        return says == [True, False, False]

    def asks_for_one(self, part: Part) -> bool:
        """Whether a part of a body holds as long as the tree has no unit of a set."""
        if isinstance(part, Literal):
            return part.negations == 1 and part.signature in self.lifted and part.single
        if isinstance(part, Conditional):
            literal = part.literal
            return (
                isinstance(literal, Literal)
                and self.asks_for_one(literal)
                and not self.deciding(part.condition)
            )
        return (
            isinstance(part, Aggregate)
            and self._counts_none(part)
            and all(
                len(found := self.deciding(element.condition)) == 1 and self._is_lifted(found[0])
                for element in part.elements
            )
        )

    def _is_lifted(self, part: Part) -> bool:
        return isinstance(part, Literal) and part.positive and part.signature in self.lifted

    def _find_lifted(self) -> frozenset[Signature]:
        """Find the predicates of which each atom is derived with the help of at most one unit of the tree."""
        rules: defaultdict[Signature, list[Clause]] = defaultdict(list)
        for clause in self.live:
            for head in clause.heads:
                rules[head.signature].append(clause)
        self.lifted = frozenset({USE, AVAILABLE}).union(
            signature
            for signature in rules
            if self.dependence.of(signature) is Depends.GROWS and signature not in self.dependence.doubts
        )
        while True:
            wrong = {s for s in self.lifted if not all(map(self.lifts, rules[s]))}
            if not wrong:
                return self.lifted
            self.lifted -= wrong

    def _why_never(self, body: Iterable[Part]) -> str | None:
        """Say why a body cannot hold, whatever the facts are; ``None`` where it may."""
        for part in body:
            if isinstance(part, Test | Aggregate) and part.holds is False:
                return _NEVER
            if isinstance(part, Literal) and part.positive and part.signature in COLUMNS:
                known = {place: value(each, self.constants) for place, each in enumerate(part.arguments)}
                values = {place: plain_value(each) for place, each in known.items() if each is not None}
                wrong = misplaced(COLUMNS[part.signature], values)
                if wrong is not None:
                    texts = wrong in COLUMNS[part.signature].texts
                    kind = (
                        f"{part.arguments[wrong]} is no text in quotes"
                        if texts
                        else f"{part.arguments[wrong]} is no number"
                    )
                    return f"{part.text} never holds, since {kind}"
        return None

    def _why_both(self, clause: Clause) -> Doubt:
        """Say why units may break a rule and mend it."""
        for part in clause.body:
            if self.dependence.of_part(part) is Depends.BOTH:
                return Doubt(f"more units may make `{part.text}` true or false", clause.source)
        return Doubt("more units may break it, and others may mend it", clause.source)

    def _rule(self, statement: AST, live: Sequence[Clause]) -> Rule:
        source = place(statement)
        if statement.ast_type != ASTType.Rule:
            reason = f"{str(statement).split(maxsplit=1)[0]} is nothing that is looked into"
            return Rule(source, Kind.OTHER, reason, source, reason, source)
        if not live:
            idle = list(clauses(statement, 0, self.constants))
            off = next((why for each in idle if (why := self._why_never(each.body))), _NEVER)
            kind = Kind.FACT if any(clause.constraint for clause in idle) else Kind.HELPER
            return Rule(source, kind, f"{off}, so it has no effect", source)
        found = [self.kind(clause) for clause in live]
        kind = _together(kind for kind, _ in found)
        doubt = next((doubt for _, doubt in found if doubt), None)
        if kind is Kind.OTHER and doubt is None:
            doubt = Doubt("read in one way it rules units out, in another it requires some", source)
        further = None
        for clause in live if kind is not Kind.HELPER else ():
            further = further or self._locality.further(clause)
        return Rule(
            source,
            kind,
            doubt.reason if doubt else "",
            (doubt.source or source) if doubt else None,
            further.reason if further else "",
            further.source if further else None,
            kind is Kind.REQUIRING
            and all(self.asks_for_one(part) for clause in live for part in self.deciding(clause.body)),
        )


def _together(kinds: Iterable[Kind]) -> Kind:
    """Give what rules of several kinds do together."""
    found = set(kinds)
    if len(found) > 1:
        found.discard(Kind.FACT)
    if found == {Kind.DELETING, Kind.SHRINKING}:
        return Kind.SHRINKING
    return found.pop() if len(found) == 1 else Kind.OTHER


@cache
def _implied() -> list[Clause]:
    """Give the rules of our encoding that a user's rules can look at."""
    statements: list[AST] = []
    parse_string(_IMPLIED, statements.append)
    return list(clauses(statements[-1], -1, {}))
