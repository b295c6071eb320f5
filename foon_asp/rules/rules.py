"""The rules added to one question, from the user and the library, analysed without clingo where possible."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from functools import cache, cached_property
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.encoding.encoding import Encoding, read_encoding
from foon_asp.encoding.fact_writer import hundredths
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.problem import Contradiction, Having, Problem, Restriction, Trait, Wanted, reach
from foon_asp.rules.clause import Signature, literals, written
from foon_asp.rules.dependence import TIMES
from foon_asp.rules.flat_answers import FlatAnswers
from foon_asp.rules.flat_body import AtLeastOne, Constant, Disjunct, Fact, Item, Never, Term
from foon_asp.rules.limit import Limit
from foon_asp.rules.rule_kind import Analysis, Kind, Rule

_SHRINKING = {Kind.HELPER, Kind.FACT, Kind.DELETING, Kind.SHRINKING}
_KITCHEN = ("kitchen", 1)
_HAVING = {
    "motion": Having.MOTION,
    **dict.fromkeys(("input", "needs"), Having.INPUT),
    **dict.fromkeys(("output", "gives"), Having.OUTPUT),
}


class ShownRule(NamedTuple):
    """A rule as it is shown: its text, and places in files.

    ``use`` is the option text of a ready-made constraint with constants of its own, else empty.
    """

    rule: Rule
    text: str
    source: Source
    use: str
    reason_source: Source | None
    nonlocality_source: Source | None


class Together(StrEnum):
    """The reductions that stay valid under rules.

    ``REDUCED``: all, since the rules only remove units. ``REQUIRED``: all, with the required sets as further
    goals. ``CUT``: exclusion of units that cannot matter for the goals, or that bounds exclude. ``BOUNDED``:
    only exclusion by bounds. ``PLAIN``: none.
    """

    REDUCED = "reduced"
    REQUIRED = "required"
    CUT = "cut"
    BOUNDED = "bounded"
    PLAIN = "plain"


class Rules:
    """All rules that are added to one question, taken together.

    ``rules`` has each of them with its kind, in the order of the files. The kinds hold for questions with
    the facts of the network, the kitchen and the goals; where a question derives or varies a predicate of
    facts, :meth:`varying` returns the rules with the kinds for that.
    """

    def __init__(
        self,
        encodings: Sequence[Encoding],
        constants: Sequence[str],
        varied: Collection[Signature] = (),
    ) -> None:
        """Analyse encodings, under constants that are set as ``name=value`` for clingo."""
        self._encodings, self._constants = tuple(encodings), tuple(constants)
        statements = [statement for encoding in encodings for statement in encoding.statements]
        self._analysis = Analysis(statements, self._constants, varied)
        self.rules: tuple[Rule, ...] = self._analysis.rules

    def varying(self, varied: Collection[Signature]) -> "Rules":
        """Return the same rules for a question in which some predicates of facts are derived or varied."""
        return Rules(self._encodings, self._constants, varied)

    @cached_property
    def shown(self) -> tuple["ShownRule", ...]:
        """The rules as they are shown to users; those of a ready-made constraint as in its file."""
        texts: dict[int, str] = {}
        uses: dict[str, Stated] = {}
        for encoding in self._encodings:
            rules = encoding.rules
            file, originals = rules, encoding.statements
            if isinstance(rules, Stated) and rules.file is not None:
                uses[rules.place] = rules
                file, originals = rules.file, read_encoding(rules.file).statements
            pairs = zip(_rule_statements(encoding.statements), _rule_statements(originals), strict=True)
            texts.update((id(statement), written(original, file)) for statement, original in pairs)

        def source_in_file(source: Source | None) -> Source | None:
            use = None if source is None else uses.get(source.file)
            return source if source is None or use is None else source._replace(file=str(use.file))

        return tuple(
            ShownRule(
                rule,
                texts[id(statement)],
                source_in_file(rule.source) or rule.source,
                uses[rule.source.file].written if rule.source.file in uses else "",
                source_in_file(rule.reason_source),
                source_in_file(rule.nonlocality_source),
            )
            for rule, statement in zip(self.rules, self._analysis.statements, strict=True)
        )

    @property
    def shrinking(self) -> bool:
        """Whether all rules are antimonotone: every subtree of a tree that keeps to them does, too."""
        return all(rule.kind in _SHRINKING for rule in self.rules)

    @property
    def local(self) -> bool:
        """Whether every rule is local.

        Only then are rules valid for a part of the units.
        """
        return all(rule.local for rule in self.rules)

    @property
    def reductions_kept(self) -> Together:
        """The reductions that stay valid under these rules."""
        if not self.unsettled:
            return Together.REQUIRED if self._analysis.at_least_ones else Together.REDUCED
        if not self.local:
            return Together.PLAIN
        return Together.BOUNDED if self.redundant else Together.CUT

    @property
    def redundant(self) -> bool:
        """Whether a tree that keeps to all rules may need redundant units, which lead to no goal."""
        return any(rule.kind not in _SHRINKING for rule in self.unsettled)

    @cached_property
    def unsettled(self) -> tuple[Rule, ...]:
        """The rules that :meth:`applied` does not settle, so that clingo has to enforce them."""
        settled = self._analysis.removals.keys() | self._analysis.at_least_ones.keys()
        return tuple(
            rule
            for number, rule in enumerate(self.rules)
            if number not in settled and rule.kind is not Kind.HELPER
        )

    @property
    def wanted(self) -> list[Wanted] | None:
        """The traits of required units, by at-least-one constraint.

        ``None`` where rules are not local, or do more than to remove and require units.
        """
        if not self.local or self.unsettled:
            return None
        return [
            Wanted(
                [tuple(_traits(disjunct)) for disjunct in at_least_one.helpers if disjunct.unit is not None],
                _always(at_least_one),
            )
            for at_least_one in self._at_least_ones
        ]

    @property
    def _at_least_ones(self) -> list[AtLeastOne]:
        return [
            at_least_one
            for at_least_ones in self._analysis.at_least_ones.values()
            for at_least_one in at_least_ones
        ]

    @property
    def only_limits(self) -> bool:
        """Whether no rule reads the number of executions except to bound it from above."""
        at_most = {number for number, bound in self._analysis.linear_bounds.items() if not bound.at_least}
        others = (
            clause
            for number, rule_clauses in enumerate(self._analysis.of_rule)
            if number not in at_most
            for clause in rule_clauses
        )
        return all(literal.signature != TIMES for clause in others for literal in literals(clause.body))

    def limits(self, problem: Problem) -> list[Limit]:
        """Return the linear limits on executions that rules state.

        Raises :class:`UserError` as :meth:`applied` does.
        """
        if not self._analysis.linear_bounds:
            return []
        answers, units = self._answers(problem), sorted(reach(problem).units)
        limits: list[Limit] = []
        for bound in self._analysis.linear_bounds.values():
            weight = answers.weight(bound)
            weights = {unit: number for unit in units if (number := weight(unit))}
            if bound.per_unit:
                limits += [Limit({unit: 1}, bound.bound) for unit in weights]
            else:
                limits.append(Limit(weights, bound.bound, bound.at_least, bound.used))
        return limits

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        """Return the upper linear bounds that rules state: for each the unit weights and the greatest sum."""
        linear_bounds = [
            bound for bound in self._analysis.linear_bounds.values() if not (bound.per_unit or bound.at_least)
        ]
        if linear_bounds:
            answers = self._answers(problem)
            yield from ((cache(answers.weight(bound)), bound.bound) for bound in linear_bounds)

    def applied(self, problem: Problem) -> Restriction | Contradiction:
        """Return the restriction of a problem by the rules that remove units or require one of a set.

        A tree keeps to these if and only if it has no removed unit, and a unit of each required set. Whether
        a unit is removed is evaluated lazily. Raises :class:`UserError` for prices that rules read and that
        are no whole numbers of hundredths.
        """
        if problem.restriction is not None:
            problem = replace(problem, restriction=None)
        answers = self._answers(problem)
        disjuncts = [disjunct for removals in self._analysis.removals.values() for disjunct in removals]
        if answers.any_holds(disjunct for disjunct in disjuncts if disjunct.unit is None):
            return Contradiction()
        required = [
            units
            for at_least_one in self._at_least_ones
            for units in answers.required_sets(at_least_one)
            if units is not None
        ]
        if not all(required):
            return Contradiction()
        return Restriction(answers.removed(disjuncts), tuple(required))

    def _answers(self, problem: Problem) -> FlatAnswers:
        prices = self._prices(problem) if self._analysis.reads(("price", 2)) else {}
        bodies = self._analysis.bodies
        return FlatAnswers(problem, bodies.tables, bodies.size, prices)

    def _prices(self, problem: Problem) -> dict[int, int]:
        """Return the prices of units in hundredths; raises where units that can be made have none."""
        read = [("price", 2)]
        try:
            return hundredths(problem, range(len(problem.network)), read)
        except UserError:
            return hundredths(problem, reach(problem).units, read)


def _facts(disjunct: Disjunct) -> list[Fact]:
    return [item for item in disjunct.items if isinstance(item, Fact)]


def _always(at_least_one: AtLeastOne) -> bool:
    """Whether a unit is required whatever the facts are."""
    return not at_least_one.when.items and all(disjunct.unit is not None for disjunct in at_least_one.helpers)


def _traits(disjunct: Disjunct) -> Iterator[Trait]:
    """Return the traits of the units of a disjunct, as far as texts of the rule name them."""
    facts = _facts(disjunct)
    for (name, _), terms in facts:
        if terms[0] == disjunct.unit and name in _HAVING:
            having, of_node = _HAVING[name], [fact for fact in facts if fact.terms[0] == terms[-1]]
            if having is Having.INPUT and any(
                _is_never(item, Fact(_KITCHEN, terms[-1:])) for item in disjunct.items
            ):
                having = Having.MADE
            words = _text(terms[-1]) if name == "motion" else _named(of_node, {"label", "ingredient"})
            yield from (Trait(having, word) for word in words)


def _is_never(item: Item, fact: Fact) -> bool:
    """Whether an item is false where a fact holds."""
    return isinstance(item, Never) and any(disjunct.items == (fact,) for disjunct in item.disjuncts)


def _text(term: Term) -> list[str]:
    return [term.value] if isinstance(term, Constant) and isinstance(term.value, str) else []


def _named(facts: Iterable[Fact], predicates: Collection[str]) -> list[str]:
    """Return the constant texts of facts of some predicates."""
    return [word for fact in facts if fact.signature[0] in predicates for word in _text(fact.terms[-1])]


def _rule_statements(statements: Iterable[AST]) -> list[AST]:
    """Return statements without comments and ``#program``, which are lost when constants are renamed."""
    return [
        statement for statement in statements if statement.ast_type not in {ASTType.Program, ASTType.Comment}
    ]
