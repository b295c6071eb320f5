"""The delete relaxation of a planning task in finite-domain variables.

A value of a variable is a fact, and a fact that was reached is never lost. Effects under conditions and
axioms stay what they mean: an action gives the effects whose conditions hold when it is executed, and an
axiom derives its fact at no cost.
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

_MAX_VARIANTS = 1000  # of one action, by which of its effects under conditions it has


def relaxed(task: SasTask) -> StripsTask:
    """Return the delete relaxation of a task.

    Raises :class:`UserError` for an action whose effects under conditions come in more than a thousand
    combinations, and for a fact derived by recursion whose negation is a condition.
    """
    return _Relaxation(task).strips()


class _Relaxation:
    def __init__(self, task: SasTask) -> None:
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
        task = self._task
        useful = self._useful()
        actions = [action for operator in task.operators for action in self._variants(operator, useful)]
        actions += [self._derivation(axiom.body, axiom.head, axiom.place) for axiom in task.axioms]
        asked = chain(task.goal, *(action.needs for action in actions))
        actions += self._negations(self._defaults.intersection(asked))
        needed = {*task.goal, *chain(*(action.needs for action in actions))}
        numbers = {fact: number for number, fact in enumerate(sorted(needed))}

        def numbered(facts: Iterable[int]) -> list[int]:
            return [numbers[fact] for fact in facts if fact in numbers]

        return StripsTask(
            Path(task.file).name,
            [self._facts[fact] for fact in numbers],
            [
                action._replace(needs=numbered(action.needs), gives=gives)
                for action in actions
                if (gives := numbered(action.gives))
            ],
            frozenset(numbered(self._start)),
            tuple(numbered(task.goal)),
            self._loses(needed),
        )

    def _useful(self) -> set[int]:
        """Return all facts that can be of use: for the goal, or as a condition of what can be of use."""
        task = self._task
        bodies = [axiom.body for axiom in task.axioms]
        facts = {*task.goal, *chain(*(operator.preconditions for operator in task.operators), *bodies)}
        facts.update(chain(*(self._values[fact] for body in bodies for fact in body)))  # for negations
        return self._with_effect_conditions(facts)

    def _with_effect_conditions(self, facts: set[int]) -> set[int]:
        """Return facts with all that can be of use for them as conditions of effects."""
        effects = [effect for operator in self._task.operators for effect in operator.effects]
        while True:
            new = set(chain(*(effect.condition for effect in effects if effect.fact in facts))) - facts
            if not new:
                return facts
            facts = facts | new

    def _loses(self, needed: set[int]) -> bool:
        """Return whether an operator takes away one of the facts that are needed."""
        needed = self._with_effect_conditions(needed)
        for operator in self._task.operators:
            for effect in operator.effects:
                values = self._values[effect.fact]
                known = {*operator.preconditions, *effect.condition}.intersection(values)
                if not (known or {*values}).difference([effect.fact]).isdisjoint(needed):
                    return True
        return False

    def _variants(self, operator: SasOperator, useful: set[int]) -> Iterator[StripsAction]:
        """Return an operator as actions without effects under conditions: one for each set that can occur."""
        holding = self._start.union(operator.preconditions)
        always: dict[int, None] = {}
        conditional: dict[frozenset[int], list[int]] = {}
        for effect in operator.effects:
            condition = frozenset(effect.condition) - holding
            if not condition:
                always[effect.fact] = None
            elif effect.fact in useful and effect.fact not in holding:
                conditional.setdefault(condition, []).append(effect.fact)
        triggers: dict[frozenset[int], None] = {frozenset(): None}
        for condition in conditional:
            triggers.update(dict.fromkeys([trigger | condition for trigger in triggers]))
            if len(triggers) > _MAX_VARIANTS:
                raise UserError(
                    f"{self._task.file}: found the action {operator.name} with effects under "
                    f"{len(conditional)} conditions, in more than {_MAX_VARIANTS} combinations, which is "
                    "beyond a delete relaxation here: make several actions of it"
                )
        cost = Fraction(operator.cost if self._task.costed else 1)
        for trigger in triggers:
            triggered = (facts for condition, facts in conditional.items() if condition <= trigger)
            effects = dict.fromkeys([*always, *chain(*triggered)])
            needs = [*operator.preconditions, *sorted(trigger)]
            yield StripsAction(operator.name, needs, list(effects), cost, operator.place)

    def _negations(self, defaults: set[int]) -> Iterator[StripsAction]:
        """Return what derives that derived facts do not hold: in every rule for it, a condition fails."""
        graph: dict[int, set[int]] = {}
        pending = sorted(defaults)
        while pending:
            default = pending.pop()
            if default in graph:
                continue
            failures = []
            for rule in self._rules[default]:
                failing = [o for fact in rule.body for o in self._values[fact] if o != fact]
                failures.append((failing, rule.place))
            graph[default] = self._defaults.intersection(fact for failing, _ in failures for fact in failing)
            pending += sorted(graph[default])
            needs = []
            for failing, place in failures:
                if len(failing) == 1:
                    needs += failing
                    continue
                fails = len(self._facts)
                self._facts.append(f"axiom {fails} fails")
                needs.append(fails)
                yield from (self._derivation((fact,), fails, place) for fact in failing)
            place = Source(self._task.file, 1)
            yield self._derivation(tuple(dict.fromkeys(needs)), default, place)
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            raise UserError(
                f"{self._task.file}: found the condition {self._facts[error.args[1][0]]} on a fact that is "
                "derived by recursion: its negation is beyond a delete relaxation here"
            ) from None

    def _derivation(self, body: tuple[int, ...], head: int, place: Source) -> StripsAction:
        return StripsAction(DERIVED, body, (head,), Fraction(0), place)
