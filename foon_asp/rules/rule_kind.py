"""What rules do to the trees of one question, and how far they see: read from clingo's syntax tree.

All rules of a question are looked at together, since a rule in another file may change what one does. Where
anything is in doubt, a rule is ``OTHER``; docs/writing-constraints.md says what that means for the user.
What is said here of a rule serves to cut the search: the search itself asks clingo for every rule that is not
known to remove units or to ask for one of a set.
"""

from collections.abc import Collection, Iterable, Sequence
from contextlib import suppress
from enum import StrEnum
from functools import cache
from typing import NamedTuple

from clingo.ast import AST, ASTType, parse_string

from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Constants,
    Literal,
    Part,
    Signature,
    Test,
    clauses,
    constant_values,
    literals,
    place,
    plain_value,
    value,
)
from foon_asp.rules.dependence import Dependence, Depends, Doubt
from foon_asp.rules.fact_values import COLUMNS, misplaced
from foon_asp.rules.flat_body import Asking, FlatBodies, NotFlatError, Row, Way
from foon_asp.rules.locality import Locality


class Kind(StrEnum):
    """What a rule does.

    ``FACT``: there is no decision in it: it holds for every tree, or for none. ``DELETING``: a tree keeps to
    it as long as it has none of some units, which are known without clingo. ``SHRINKING``: if a tree keeps to
    it, so does every tree whose units are a subset. ``REQUIRING``: if a tree keeps to it, so does every tree
    whose units are a superset. ``OTHER``: none of these is known. ``HELPER``: it derives what other rules
    look at, and rules nothing out by itself.
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
    for one unit of a set, or of each of several sets, which are known without clingo.
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
    condition that never holds are not among them. By the place of a rule in ``rules``, ``of_rule`` has its
    live clauses, ``removals`` the ways in which a unit breaks it, ``askings`` what it asks for one unit of,
    and ``rows`` the sum that it bounds. A rule with removals or askings says nothing else.
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
        self._locality = Locality(self.live, self.dependence)
        self.bodies = FlatBodies(self.live, self.constants, self.dependence, self._locality)
        self.removals: dict[int, tuple[Way, ...]] = {}
        self.askings: dict[int, tuple[Asking, ...]] = {}
        self.rows: dict[int, Row] = {}
        self.rules = tuple(
            self._understood(number, self._rule(statement, live))
            for number, (statement, live) in enumerate(zip(self.statements, self.of_rule, strict=True))
        )

    def kind(self, clause: Clause) -> tuple[Kind, Doubt | None]:
        """Return what a clause does, and why nothing more is known."""
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
            Depends.GROWS: Kind.SHRINKING,
            Depends.SHRINKS: Kind.REQUIRING,
            Depends.BOTH: Kind.OTHER,
        }
        kind = kinds[dependence.of_parts(clause.body)]
        return kind, self._why_both(clause) if kind is Kind.OTHER else None

    def reads(self, signature: Signature) -> bool:
        """Whether some rule looks at a predicate."""
        return any(each.signature == signature for clause in self.live for each in literals(clause.body))

    def _why_never(self, body: Iterable[Part]) -> str | None:
        """Return why a body cannot hold, whatever the facts are; ``None`` where it may."""
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
        """Return why units may break a rule and mend it."""
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
        )

    def _understood(self, number: int, rule: Rule) -> Rule:
        """Find what a rule says that needs no clingo, and return the rule with a kind that says so."""
        live = self.of_rule[number]
        if not rule.local or rule.kind in {Kind.HELPER, Kind.OTHER}:
            return rule
        if rule.kind is not Kind.FACT and len(live) == 1:
            with suppress(NotFlatError):
                self.rows[number] = self.bodies.row(live[0])
        with suppress(NotFlatError):
            if rule.kind is Kind.REQUIRING:
                self.askings[number] = tuple(each for clause in live for each in self.bodies.askings(clause))
                return rule._replace(one_of=True)
            self.removals[number] = tuple(way for clause in live for way in self.bodies.ways(clause))
            return rule._replace(kind=Kind.FACT if rule.kind is Kind.FACT else Kind.DELETING)
        return rule


def _together(kinds: Iterable[Kind]) -> Kind:
    """Return what rules of several kinds do together."""
    found = set(kinds)
    if len(found) > 1:
        found.discard(Kind.FACT)
    return found.pop() if len(found) == 1 else Kind.OTHER


@cache
def _implied() -> list[Clause]:
    """Return the rules of our encoding that a user's rules can look at."""
    statements: list[AST] = []
    parse_string(_IMPLIED, statements.append)
    return list(clauses(statements[-1], -1, {}))
