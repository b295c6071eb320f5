"""Limits by antimonotone user rules: sums over units, and minimal sets of units that break a rule."""

from collections.abc import Iterable
from fractions import Fraction

from foon_asp.asp import Settings
from foon_asp.asp.assembly import assemble
from foon_asp.asp.integrity import relax
from foon_asp.asp.prepared import Prepared
from foon_asp.encoding.fact_writer import write_given, write_soft
from foon_asp.encoding.own_encodings import ENCODING_FILES, question_encoding
from foon_asp.hypergraph.exact_optimum import Limit
from foon_asp.problem import Objective, Problem, reach
from foon_asp.rules.passed_constraint import Constraint
from foon_asp.rules.rule_analysis import Kind
from foon_asp.rules.rules import Rules


class OwnLimits:
    """Search for limits that follow from antimonotone user rules; ``found_limits`` are those found so far.

    An antimonotone rule that holds of a tree also holds of smaller ones. At first, the limits found are the
    sums that rules limit. Each minimal set of units that breaks a rule gives another limit: a tree lacks at
    least one unit of the set.
    """

    def __init__(
        self,
        problem: Problem,
        settings: Settings,
        rules: Rules,
        user_constraints: frozenset[Constraint],
        covered: Iterable[Limit],
    ) -> None:
        """Prepare the search, and find the limits that the rules state as sums.

        ``rules`` are all rules of the question, analysed, and ``user_constraints`` those constraints that are
        user rules. Sums that follow from the limits ``covered`` are left out.
        """
        self._problem, self._deadline = problem, settings.effective_deadline
        numbered, relaxed = relax(
            settings.constraints, settings.constants, soft=True, deadline=settings.effective_deadline
        )
        shrinking = {rule.source for rule in rules.unsettled if rule.kind in {Kind.FACT, Kind.SHRINKING}}
        weights = {
            c.number: 1 for c in numbered if c.constraint in user_constraints and c.source in shrinking
        }
        relaxed = relaxed._replace(rules=relaxed.rules + write_soft(weights))
        self._settings = settings._replace(constraints=(), relaxed=relaxed)
        program = assemble(self._settings, lambda _: None)
        other_files = program.files[len(ENCODING_FILES) :]
        self._program = program._replace(files=(question_encoding("breaking_units.lp"), *other_files))
        self._has_user_rules = bool(weights)
        self._all_local = all(rule.local for rule in rules.rules if rule.source in shrinking)
        self.found_limits: list[Limit] = []
        if self._has_user_rules:
            sums = (
                sum_limit
                for sum_limit in rules.limits(problem, settings.effective_deadline)
                if not sum_limit.at_least
            )
            limits = [
                ({u: Fraction(n) for u, n in sum_limit.weights.items() if n}, sum_limit.bound)
                for sum_limit in sums
            ]
            covered_limits = [*covered]
            self.found_limits = [
                (amounts, Fraction(max_sum))
                for amounts, max_sum in limits
                if not any(
                    m <= max_sum and all(a.get(u, 0) >= n for u, n in amounts.items())
                    for a, m in covered_limits
                )
            ]

    def exceeded_limit(self, units: frozenset[int]) -> Limit | None:
        """Search with clingo for a set among ``units`` that breaks a rule; return it as a limit.

        The limit says that a tree lacks at least one unit of the set. It is appended to ``found_limits``.
        Return ``None`` if the units keep to the rules. Raises ``KeyboardInterrupt`` if time is up.
        """
        if not self._has_user_rules:
            return None
        network = self._problem.network
        considered_units = units if self._all_local else units.union(reach(self._problem).units)
        question = Prepared(
            self._problem,
            (Objective.UNITS,),
            self._settings,
            self._deadline,
            self._program,
            tuple(sorted(considered_units)),
        )
        result = question.run(write_given(list(map(network.unit_number, sorted(units)))))
        if result.units is None:
            if not result.exhausted:
                self._deadline.check()
                raise KeyboardInterrupt
            return None
        breaking_units = {network.unit_of_number(number) for number in result.units}
        limit: Limit = (
            {unit: Fraction(1) for unit in sorted(units & breaking_units)},
            Fraction(len(breaking_units) - 1),
        )
        self.found_limits.append(limit)
        return limit
