"""The delete relaxation of a planning task in finite-domain variables.

A fact is a value of a variable. In the relaxation, a fact that was reached is never deleted. Conditional
effects and axioms keep their meaning: an action adds the effects whose conditions hold when it is executed,
and an axiom derives its fact at no cost.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from graphlib import CycleError, TopologicalSorter
from itertools import chain
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.planning.sas_reader import SasAxiom, SasOperator, SasTask
from foon_asp.planning.strips_task import DERIVED, StripsAction, StripsTask


def delete_relaxation(task: SasTask) -> StripsTask:
    """Return the delete relaxation of a task, in STRIPS.

    Raises :class:`UserError` for an operator whose conditional effects have more than 1,000 combinations, and
    for a condition that negates a fact which axioms derive by recursion.
    """
    return _Relaxation(task).strips()


class _Relaxation:
    """The compilation of a task, without conditional effects and negated derived facts (Nebel 2000)."""

    def __init__(self, task: SasTask) -> None:
        """Find the default values of derived variables, and the axioms that change each default value."""
        self._task = task
        self._facts = list(task.facts)
        self._values = {fact: facts for facts in task.variables for fact in facts}
        derived = {fact for variable in task.derived for fact in task.variables[variable]}
        self._start = frozenset(task.start) - derived
        self._defaults = derived.intersection(task.start)
        self._rules: dict[int, list[SasAxiom]] = {default: [] for default in self._defaults}
        for axiom in task.axioms:
            default = self._defaults.intersection(self._values[axiom.head])
            self._rules[default.pop()].append(axiom)

    def strips(self) -> StripsTask:
        """Return the compiled task, with its facts numbered in order.

        A fact is left out if it is neither in the goal nor in a precondition. An action is left out if it
        adds no remaining fact.
        """
        task = self._task
        relevant = self._relevant_facts()
        actions = [action for operator in task.operators for action in self._variants(operator, relevant)]
        actions += [self._derivation(axiom.body, axiom.head, axiom.source) for axiom in task.axioms]
        conditions = chain(task.goal, *(action.preconditions for action in actions))
        actions += self._default_derivations(self._defaults.intersection(conditions))
        needed = {*task.goal, *chain(*(action.preconditions for action in actions))}
        numbers = {fact: number for number, fact in enumerate(sorted(needed))}

        def numbered(facts: Iterable[int]) -> list[int]:
            """Return the new numbers of the given facts; facts that the compiled task lacks are left out."""
            return [numbers[fact] for fact in facts if fact in numbers]

        return StripsTask(
            Path(task.file).name,
            [self._facts[fact] for fact in numbers],
            [
                action._replace(preconditions=numbered(action.preconditions), add_effects=add_effects)
                for action in actions
                if (add_effects := numbered(action.add_effects))
            ],
            frozenset(numbered(self._start)),
            tuple(numbered(task.goal)),
            self._deletes(needed),
        )

    def _relevant_facts(self) -> set[int]:
        """Return the facts of the goal and of the conditions of operators and axioms.

        If a variable occurs in the body of an axiom, all its values are included, since the axiom may be
        negated. If an effect adds an included fact, the condition of the effect is included as well.
        """
        task = self._task
        bodies = [axiom.body for axiom in task.axioms]
        facts = {*task.goal, *chain(*(operator.preconditions for operator in task.operators), *bodies)}
        facts.update(chain(*(self._values[fact] for body in bodies for fact in body)))  # for negated bodies
        return self._with_effect_conditions(facts)

    def _with_effect_conditions(self, facts: set[int]) -> set[int]:
        """Return some facts and, transitively, the conditions of all effects that add them."""
        effects = [effect for operator in self._task.operators for effect in operator.effects]
        while True:
            missing = set(chain(*(effect.condition for effect in effects if effect.fact in facts))) - facts
            if not missing:
                return facts
            facts = facts | missing

    def _deletes(self, needed: set[int]) -> bool:
        """Whether an operator may delete a fact of ``needed``, or a condition of an effect that adds one.

        An effect sets a variable to a value. It deletes the value that the variable had before, if that is
        another value.
        """
        needed = self._with_effect_conditions(needed)
        for operator in self._task.operators:
            for effect in operator.effects:
                values = self._values[effect.fact]
                possible_before = {*operator.preconditions, *effect.condition}.intersection(values) or {
                    *values
                }
                if not possible_before.difference([effect.fact]).isdisjoint(needed):
                    return True
        return False

    def _variants(
        self, operator: SasOperator, relevant: set[int], max_variants: int = 1000
    ) -> Iterator[StripsAction]:
        """Yield actions without conditional effects for an operator, one for each union of effect conditions.

        The conditions of the union become preconditions. The action adds all effects whose conditions are in
        the union. Facts that hold initially, and preconditions of the operator, hold always, since nothing is
        deleted. A conditional effect is left out if it adds no relevant fact, or only a fact that always
        holds. If the task does not count costs, the cost is 1. Raises :class:`UserError` for more than
        ``max_variants`` unions; their number may be exponential.
        """
        holding = self._start.union(operator.preconditions)
        always: dict[int, None] = {}
        conditional: dict[frozenset[int], list[int]] = {}
        for effect in operator.effects:
            condition = frozenset(effect.condition) - holding
            if not condition:
                always[effect.fact] = None
            elif effect.fact in relevant and effect.fact not in holding:
                conditional.setdefault(condition, []).append(effect.fact)
        triggers: dict[frozenset[int], None] = {frozenset(): None}
        for condition in conditional:
            triggers.update(dict.fromkeys([trigger | condition for trigger in triggers]))
            if len(triggers) > max_variants:
                raise UserError(
                    f"{self._task.file}: found the action {operator.name} with effects under "
                    f"{len(conditional)} conditions, in more than {max_variants} combinations, which is "
                    "beyond a delete relaxation here: make several actions of it"
                )
        cost = Fraction(operator.cost if self._task.costed else 1)
        for trigger in triggers:
            triggered = (facts for condition, facts in conditional.items() if condition <= trigger)
            effects = dict.fromkeys([*always, *chain(*triggered)])
            preconditions = [*operator.preconditions, *sorted(trigger)]
            yield StripsAction(operator.name, preconditions, list(effects), cost, operator.source)

    def _default_derivations(self, defaults: set[int]) -> Iterator[StripsAction]:
        """Yield actions that derive the default values of derived variables (Clark's completion).

        A variable has its default value if every axiom that sets the variable fails. An axiom fails if the
        variable of a fact in its body has another value. If several values make an axiom fail, a new fact of
        the task says that the axiom fails. Default values that these derivations need are derived as well.
        Raises :class:`UserError` if such a derivation is cyclic.
        """
        graph: dict[int, set[int]] = {}
        pending = sorted(defaults)
        while pending:
            default = pending.pop()
            if default in graph:
                continue
            failures = []
            for rule in self._rules[default]:
                failing = [value for fact in rule.body for value in self._values[fact] if value != fact]
                failures.append((failing, rule.source))
            graph[default] = self._defaults.intersection(fact for failing, _ in failures for fact in failing)
            pending += sorted(graph[default])
            preconditions = []
            for failing, source in failures:
                if len(failing) == 1:
                    preconditions += failing
                    continue
                fails = len(self._facts)
                self._facts.append(f"axiom {fails} fails")
                preconditions.append(fails)
                yield from (self._derivation((fact,), fails, source) for fact in failing)
            source = Source(self._task.file, 1)
            yield self._derivation(tuple(dict.fromkeys(preconditions)), default, source)
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            raise UserError(
                f"{self._task.file}: found the condition {self._facts[error.args[1][0]]} on a fact that is "
                "derived by recursion: its negation is beyond a delete relaxation here"
            ) from None

    def _derivation(self, body: tuple[int, ...], head: int, source: Source) -> StripsAction:
        """Return an action of no cost that derives ``head`` from the facts of ``body``."""
        return StripsAction(DERIVED, body, (head,), Fraction(0), source)
