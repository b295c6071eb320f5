"""Kind and locality of the rules of one question, inferred from clingo's syntax tree.

All rules of a question are analysed together: a rule in one file may change the effect of a rule in another.
A rule whose effect is unknown is ``OTHER``; docs/writing-constraints.md explains the consequences. The kinds
serve to cut the search. Rules known to remove units or to require one of a set can be applied before the
search; clingo enforces all other rules.
"""

from collections.abc import Collection, Iterable, Sequence
from enum import StrEnum
from functools import cache
from typing import NamedTuple

from clingo.ast import AST, ASTType, parse_string

from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conjunct,
    Constants,
    Literal,
    Signature,
    Test,
    clauses,
    constant_values,
    literals,
    plain_value,
    source_of,
    value,
)
from foon_asp.rules.dependence import Dependence, Doubt, Monotonicity
from foon_asp.rules.fact_values import COLUMNS, position_of_wrong_type
from foon_asp.rules.locality import Locality
from foon_asp.rules.rule_translation import AtLeastOne, Removal, Row, Translator


class Kind(StrEnum):
    """The effect of a rule on the set of trees.

    ``FACT``: it is independent of the tree, and allows every tree or none.
    ``DELETING``: it excludes the trees that have one of certain units, which are found before the search.
    ``SHRINKING``: it is antimonotone: if it allows a tree, it allows every subset.
    ``REQUIRING``: it is monotone: if it allows a tree, it allows every superset.
    ``OTHER``: its kind is unknown.
    ``HELPER``: it derives an auxiliary predicate, and excludes nothing by itself.
    """

    FACT = "fact"
    DELETING = "deleting"
    SHRINKING = "shrinking"
    REQUIRING = "requiring"
    OTHER = "other"
    HELPER = "helper"


# Statements other than rules that do not change the set of trees.
_WITHOUT_EFFECT = {
    ASTType.Comment,
    ASTType.Defined,
    ASTType.Definition,
    ASTType.Program,
    ASTType.ShowSignature,
}


_NEVER = "a condition in it never holds"

# A rule of the built-in encoding whose predicate user rules may read, where items do not run out.
_IMPLIED = "times(U,1) :- use(U)."


class Rule(NamedTuple):
    """A rule of one question, with its kind and locality.

    ``source``: the place of the rule.
    ``reason``: why the kind is ``OTHER``, or why the rule has no effect; else empty.
    ``reason_source``: the place in the rules that ``reason`` is about.
    ``nonlocality``: the facts outside the tree that the rule reads; empty for a local rule
    (:mod:`foon_asp.rules.locality`). A ``HELPER`` is always local: its facts count for the rules that use it.
    ``nonlocality_source``: the place where the rule reads these facts.
    ``one_of``: whether the rule requires a unit of each of one or several sets, which are
    found before the search.
    """

    source: Source
    kind: Kind
    reason: str = ""
    reason_source: Source | None = None
    nonlocality: str = ""
    nonlocality_source: Source | None = None
    one_of: bool = False

    @property
    def local(self) -> bool:
        """Whether the rule reads facts about the tree alone."""
        return not self.nonlocality

    @property
    def without_effect(self) -> bool:
        """Whether the rule excludes no tree, and derives nothing, since a condition in it never holds."""
        return bool(self.reason) and self.kind is not Kind.OTHER


class Analysis:
    """The rules of one question as clauses, each with its kind.

    ``rules``: the rules, in the order of the files; statements that cannot change the set of trees, such as
    ``#show``, are left out.
    ``statements``: the syntax trees of ``rules``.
    ``live_clauses``: the clauses of rules and built-in rules, except those with a condition that never holds.
    ``clauses_of_rule``: the live clauses of each rule, by its index in ``rules``.
    ``removals``, ``at_least_ones``, ``rows``: the translations of rules that have one, by index in ``rules``.
    ``constant_texts``: ``#const`` statements for the constants in these translations.
    """

    def __init__(
        self, statements: Iterable[AST], settings: Sequence[str], varied: Collection[Signature] = ()
    ) -> None:
        """Analyse parsed statements.

        ``settings`` are the constants that are set, as ``name=value`` for clingo. ``varied`` are predicates
        whose atoms the question itself changes (:class:`Dependence`).
        """
        statements = tuple(statements)
        self.definitions = [statement for statement in statements if statement.ast_type == ASTType.Definition]
        self.constants: Constants = constant_values(self.definitions, settings)
        symbols = {name: symbol for name, symbol in self.constants.items() if symbol is not None}
        self.constant_texts = [f"#const {name} = {symbol}." for name, symbol in symbols.items()]
        self.statements = [statement for statement in statements if statement.ast_type not in _WITHOUT_EFFECT]
        clauses_by_rule = [
            list(clauses(statement, number, self.constants)) if statement.ast_type == ASTType.Rule else []
            for number, statement in enumerate(self.statements)
        ]
        self.clauses_of_rule = [
            [clause for clause in rule_clauses if self._why_never(clause.body) is None]
            for rule_clauses in clauses_by_rule
        ]
        self.live_clauses = [
            clause for rule_clauses in (*self.clauses_of_rule, _implied_clauses()) for clause in rule_clauses
        ]
        self.dependence = Dependence(self.live_clauses, self.constants, varied)
        self._locality = Locality(self.live_clauses, self.dependence)
        self.translator = Translator(self.live_clauses, self.constants, self.dependence)
        self.removals: dict[int, Removal] = {}
        self.at_least_ones: dict[int, tuple[AtLeastOne, ...]] = {}
        self.rows: dict[int, Row] = {}
        self.rules = tuple(
            self._translate_rule(number, self._classify_statement(statement, live_clauses))
            for number, (statement, live_clauses) in enumerate(
                zip(self.statements, self.clauses_of_rule, strict=True)
            )
        )

    def kind(self, clause: Clause) -> tuple[Kind, Doubt | None]:
        """Return the kind of a clause, and the reason if the kind is ``OTHER``.

        The reason is ``None`` for any other kind. A plain rule with a head is a ``HELPER``, unless its
        predicate is in the ``loops`` of :class:`Dependence`.
        """
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
            Monotonicity.NOT: Kind.FACT,
            Monotonicity.GROWS: Kind.SHRINKING,
            Monotonicity.SHRINKS: Kind.REQUIRING,
            Monotonicity.BOTH: Kind.OTHER,
        }
        kind = kinds[dependence.of_body(clause.body)]
        return kind, self._why_not_monotone(clause) if kind is Kind.OTHER else None

    def reads(self, signature: Signature) -> bool:
        """Whether the body of some live clause has the predicate ``signature``."""
        return any(
            literal.signature == signature
            for clause in self.live_clauses
            for literal in literals(clause.body)
        )

    def _why_never(self, body: Iterable[Conjunct]) -> str | None:
        """Return why a body cannot hold, whatever the facts are; ``None`` if no reason is found.

        One reason is a comparison or aggregate that is known to be false. Another one is an argument of the
        wrong type: a number where the facts have a text, for example.
        """
        for conjunct in body:
            if isinstance(conjunct, Test | Aggregate) and conjunct.holds is False:
                return _NEVER
            if isinstance(conjunct, Literal) and conjunct.positive and conjunct.signature in COLUMNS:
                symbols = {
                    position: value(argument, self.constants)
                    for position, argument in enumerate(conjunct.arguments)
                }
                values = {
                    position: plain_value(symbol)
                    for position, symbol in symbols.items()
                    if symbol is not None
                }
                misfit = position_of_wrong_type(COLUMNS[conjunct.signature], values)
                if misfit is not None:
                    wants_text = misfit in COLUMNS[conjunct.signature].texts
                    kind = (
                        f"{conjunct.arguments[misfit]} is no text in quotes"
                        if wants_text
                        else f"{conjunct.arguments[misfit]} is no number"
                    )
                    return f"{conjunct.text} never holds, since {kind}"
        return None

    def _why_not_monotone(self, clause: Clause) -> Doubt:
        """Return why a rule is neither monotone nor antimonotone."""
        for conjunct in clause.body:
            if self.dependence.of_conjunct(conjunct) is Monotonicity.BOTH:
                return Doubt(f"more units may make `{conjunct.text}` true or false", clause.source)
        return Doubt("more units may break it, and others may mend it", clause.source)

    def _classify_statement(self, statement: AST, live_clauses: Sequence[Clause]) -> Rule:
        """Return a statement as a rule with its kind and locality.

        ``live_clauses`` are its clauses that can have an effect. A rule without such clauses is a ``FACT`` or
        a ``HELPER``, and its reason says why it has no effect. A statement other than a rule is ``OTHER``,
        and not local.
        """
        source = source_of(statement)
        if statement.ast_type != ASTType.Rule:
            reason = f"{str(statement).split(maxsplit=1)[0]} is nothing that is looked into"
            return Rule(source, Kind.OTHER, reason, source, reason, source)
        if not live_clauses:
            idle_clauses = list(clauses(statement, 0, self.constants))
            reasons = map(self._why_never, (clause.body for clause in idle_clauses))
            why_never = next(filter(None, reasons), _NEVER)
            kind = Kind.FACT if any(clause.is_constraint for clause in idle_clauses) else Kind.HELPER
            return Rule(source, kind, f"{why_never}, so it has no effect", source)
        kinds = [self.kind(clause) for clause in live_clauses]
        kind = _conjunction_kind(kind for kind, _ in kinds)
        doubt = next((doubt for _, doubt in kinds if doubt), None)
        if kind is Kind.OTHER and doubt is None:
            doubt = Doubt("read in one way it rules units out, in another it requires some", source)
        nonlocality = None
        for clause in live_clauses if kind is not Kind.HELPER else ():
            nonlocality = nonlocality or self._locality.nonlocality(clause)
        return Rule(
            source,
            kind,
            doubt.reason if doubt else "",
            (doubt.source or source) if doubt else None,
            nonlocality.reason if nonlocality else "",
            nonlocality.source if nonlocality else None,
        )

    def _translate_rule(self, number: int, rule: Rule) -> Rule:
        """Return a rule with the kind that follows from its translations.

        The translations are added to ``removals``, ``at_least_ones`` and ``rows``, under the index of the
        rule (``number``). A rule that is not local, a ``HELPER`` or ``OTHER`` has no translation. A rule with
        a removal becomes ``DELETING``, unless it is a ``FACT``. A rule with at-least-one constraints has
        ``one_of`` set.
        """
        live_clauses = self.clauses_of_rule[number]
        if not rule.local or rule.kind in {Kind.HELPER, Kind.OTHER}:
            return rule
        if (
            rule.kind is not Kind.FACT
            and len(live_clauses) == 1
            and (row := self.translator.row(live_clauses[0]))
        ):
            self.rows[number] = row
        if rule.kind is Kind.REQUIRING:
            translations = [self.translator.at_least_one(clause) for clause in live_clauses]
            at_least_ones = tuple(translation for translation in translations if translation is not None)
            if len(at_least_ones) < len(translations):
                return rule
            self.at_least_ones[number] = at_least_ones
            return rule._replace(one_of=True)
        removal = self.translator.removal(live_clauses)
        if removal is None:
            return rule
        self.removals[number] = removal
        return rule._replace(kind=Kind.FACT if rule.kind is Kind.FACT else Kind.DELETING)


def _conjunction_kind(kinds: Iterable[Kind]) -> Kind:
    """Return the kind of a conjunction of rules, from their kinds.

    Rules of kind ``FACT`` are ignored, unless all have this kind. If the others have one kind, return this
    kind; otherwise, return ``OTHER``.
    """
    distinct = set(kinds)
    if len(distinct) > 1:
        distinct.discard(Kind.FACT)
    return distinct.pop() if len(distinct) == 1 else Kind.OTHER


@cache
def _implied_clauses() -> list[Clause]:
    """Return the clauses of the built-in rule for ``times/2``, which user rules can read; they are cached."""
    statements: list[AST] = []
    parse_string(_IMPLIED, statements.append)
    return list(clauses(statements[-1], -1, {}))
