"""The user and ready-made rules of one question, analysed without clingo where possible."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from functools import cached_property
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.deadline import Deadline
from foon_asp.encoding.encoding import Encoding, read_encoding
from foon_asp.encoding.stated import Stated
from foon_asp.network import Source
from foon_asp.problem import Contradiction, LinearRow, Problem, RequiredUnit, Restriction, reach
from foon_asp.rules.clause import Signature, literals, statement_text
from foon_asp.rules.dependence import TIMES
from foon_asp.rules.rule_analysis import Analysis, Kind, Rule
from foon_asp.rules.rule_translation import AtLeastOne, Understood
from foon_asp.rules.tuning import TUNING
from foon_asp.rules.unit_answers import UnitAnswers, ask_units, candidate_units

_SHRINKING = {Kind.HELPER, Kind.FACT, Kind.DELETING, Kind.SHRINKING}


class ShownRule(NamedTuple):
    """A rule as users see it: its text, and places in files.

    ``use`` is the option text of a ready-made constraint with constants of its own, else empty. The places of
    ``rule`` may be in the text of such a constraint; use ``source`` and the other places here instead.
    """

    rule: Rule
    text: str
    source: Source
    use: str
    reason_source: Source | None
    nonlocality_source: Source | None


class Together(StrEnum):
    """The reductions that stay valid under rules.

    ``REDUCED``: all reductions, since the rules only remove units.
    ``REQUIRED``: all reductions, if the required sets are further goals.
    ``CUT``: only the exclusion of units that cannot matter for the goals, and of units by bounds.
    ``BOUNDED``: only the exclusion of units by bounds.
    ``PLAIN``: no reductions.
    """

    REDUCED = "reduced"
    REQUIRED = "required"
    CUT = "cut"
    BOUNDED = "bounded"
    PLAIN = "plain"


class Rules:
    """All rules that are added to one question, taken together.

    ``rules`` has each of them with its kind, in the order of the files. The kinds hold if all facts about the
    network, the kitchen and the goals are fixed. If a question derives or varies a predicate of facts,
    :meth:`varying` returns the rules with the kinds for this question.
    """

    def __init__(
        self,
        encodings: Sequence[Encoding],
        constants: Sequence[str],
        varied: Collection[Signature] = (),
        endless: bool = True,
    ) -> None:
        """Analyse encodings, under constants that are set as ``name=value`` for clingo.

        ``varied`` are predicates that the question itself derives or changes. ``endless`` says that grounding
        the rules may not terminate; then they are evaluated in another process.
        """
        self._encodings, self._constants, self._endless = tuple(encodings), tuple(constants), endless
        self._last: tuple[Problem, Collection[int] | None, UnitAnswers | None] | None = None
        statements = [statement for encoding in encodings for statement in encoding.statements]
        self._analysis = Analysis(statements, self._constants, varied)
        self.rules: tuple[Rule, ...] = self._analysis.rules

    def varying(self, varied: Collection[Signature]) -> "Rules":
        """Return these rules, analysed for a question in which the facts of some predicates may change.

        Facts in ``varied`` are derived by other rules, or differ from question to question.
        """
        return Rules(self._encodings, self._constants, varied, self._endless)

    @cached_property
    def shown_rules(self) -> tuple["ShownRule", ...]:
        """The rules as users see them; a rule of a ready-made constraint is shown as in its file."""
        texts: dict[int, str] = {}
        uses: dict[str, Stated] = {}
        for encoding in self._encodings:
            rules = encoding.rules
            file, originals = rules, encoding.statements
            if isinstance(rules, Stated) and rules.file is not None:
                uses[rules.place] = rules
                file, originals = rules.file, read_encoding(rules.file).statements
            pairs = zip(_rule_statements(encoding.statements), _rule_statements(originals), strict=True)
            texts.update((id(statement), statement_text(original, file)) for statement, original in pairs)

        def source_in_file(source: Source | None) -> Source | None:
            """Return a place; if it is in a use of a ready-made constraint, return the place in its file."""
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
        """Whether all rules are antimonotone: if a tree keeps to them, so does every subtree."""
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
        """The rules that clingo has to enforce, since :meth:`restriction_of` does not cover them."""
        settled = self._analysis.removals.keys() | self._analysis.at_least_ones.keys()
        return tuple(
            rule
            for number, rule in enumerate(self.rules)
            if number not in settled and rule.kind is not Kind.HELPER
        )

    @property
    def wanted(self) -> list[RequiredUnit] | None:
        """The traits of required units, for each at-least-one constraint; empty if rules only remove units.

        ``None`` if a rule is not local, or does more than to remove or require units.
        """
        if not self.local or self.unsettled:
            return None
        return [constraint.wanted for constraint in self._at_least_ones]

    @property
    def _at_least_ones(self) -> list[AtLeastOne]:
        """The at-least-one constraints of all rules."""
        return [constraint for of_rule in self._analysis.at_least_ones.values() for constraint in of_rule]

    @property
    def only_limits(self) -> bool:
        """Whether rules read numbers of executions only to bound these numbers from above."""
        upper_rows = {number for number, row in self._analysis.rows.items() if not row.at_least}
        others = (
            clause
            for number, rule_clauses in enumerate(self._analysis.clauses_of_rule)
            if number not in upper_rows
            for clause in rule_clauses
        )
        return all(literal.signature != TIMES for clause in others for literal in literals(clause.body))

    def limits(self, problem: Problem, deadline: Deadline) -> list[LinearRow]:
        """Return the linear limits on executions that rules state, over the units that can execute.

        The result is empty if clingo refuses a rule. A limit per unit becomes one row for each unit. Units of
        weight 0 are left out. Raises :class:`UserError` as :meth:`restriction_of` does.
        """
        answers = self._answers(problem, deadline) if self._analysis.rows else None
        limits: list[LinearRow] = []
        for row in self._analysis.rows.values() if answers else ():
            assert answers is not None
            weights = {u: n for u, n in sorted(answers.weights.get(row.number, {}).items()) if n}
            if row.per_unit:
                limits += [LinearRow({unit: 1}, row.bound) for unit in weights]
            else:
                limits.append(LinearRow(weights, row.bound, row.at_least, row.used))
        return limits

    def upper_limits(self, problem: Problem, deadline: Deadline) -> Iterator[LinearRow]:
        """Yield the upper bounds among :meth:`limits`; none if the rules are left to the search."""
        if not self.leave_to_search(problem):
            yield from (row for row in self.limits(problem, deadline) if not row.at_least)

    def restriction_of(
        self, problem: Problem, deadline: Deadline, units: Collection[int] | None = None
    ) -> Restriction | Contradiction | None:
        """Return the restriction of a problem by the rules that remove units or require a unit of a set.

        A tree keeps to these rules if and only if it has no removed unit, and a unit of each required set.
        Only ``units`` are considered, by default the units that can execute.

        Return :class:`Contradiction` if no tree keeps to these rules, and ``None`` if clingo refuses a rule.
        Raises :class:`UserError` if rules read a price that is not a whole number of hundredths.
        """
        answers = self._answers(problem, deadline, units)
        return None if answers is None else answers.restriction

    def leave_to_search(self, problem: Problem) -> bool:
        """Whether to leave the rules to the search: in a large network, if no rule requires a unit.

        A network is large if it has more than ``TUNING.evaluated_units`` units. There, the search evaluates
        the rules faster, since it looks only at units near the goals.
        """
        large = len(problem.network) > TUNING.evaluated_units
        return large and not self._analysis.at_least_ones

    def _answers(
        self, problem: Problem, deadline: Deadline, units: Collection[int] | None = None
    ) -> UnitAnswers | None:
        """Return the evaluation of the rules on single units; ``None`` if clingo refuses a rule.

        A restriction of the problem is ignored. The result for the last problem and units is cached.
        """
        analysis = self._analysis
        if self._last is None or self._last[0] is not problem or self._last[1] is not units:
            understood: list[Understood] = [*analysis.removals.values(), *self._at_least_ones]
            understood += analysis.rows.values()
            answers: UnitAnswers | None = UnitAnswers(Restriction(lambda _: False), {})
            if understood:
                numbers = analysis.removals.keys() | analysis.at_least_ones.keys() | analysis.rows.keys()
                clauses = [clause for number in numbers for clause in analysis.clauses_of_rule[number]]
                programs = [line for rule in understood for line in rule.program]
                rules, read = analysis.translator.complete_program(programs, clauses)
                unrestricted_problem = (
                    problem if problem.restriction is None else replace(problem, restriction=None)
                )
                evaluated_units = self._evaluated_units(unrestricted_problem) if units is None else units
                answers = ask_units(
                    unrestricted_problem,
                    evaluated_units,
                    [*analysis.constant_texts, *rules],
                    read,
                    deadline if self._endless else None,
                )
            self._last = problem, units, answers
        return self._last[2]

    def _evaluated_units(self, problem: Problem) -> Collection[int]:
        """Return the ids of the units to evaluate rules on: by default, all that can execute.

        In a large network whose only constraints are at-least-one constraints, only units with a trait that
        these constraints name are evaluated.
        """
        network = problem.network
        if len(network) > TUNING.evaluated_units and not (self._analysis.removals or self._analysis.rows):
            named_units = candidate_units(network, (constraint.wanted for constraint in self._at_least_ones))
            if named_units is not None:
                return named_units
        return reach(problem).units


def _rule_statements(statements: Iterable[AST]) -> list[AST]:
    """Return statements without comments and ``#program``, which are lost when constants are renamed."""
    return [
        statement for statement in statements if statement.ast_type not in {ASTType.Program, ASTType.Comment}
    ]
