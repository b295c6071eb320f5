"""The delete relaxation of a PDDL task, grounded by clingo.

Without deletes, what can ever hold is the least model of a program without choice: an action is there once
its condition can hold, and then its effects can. So grounding that program is grounding the task.
"""

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.grounding.grounded import Grounded
from foon_asp.network import Source
from foon_asp.planning.formula import (
    All,
    AnyOf,
    Atom,
    Equal,
    Formula,
    Literal,
    Terms,
    Variable,
    expanded,
    literals,
)
from foon_asp.planning.pddl_task import Effect, PddlTask, Schema
from foon_asp.planning.strips_task import REACHED, StripsAction, StripsTask

_DOING = "grounding the task"
_MOST_WAYS = 1000  # of one condition to hold

Fact = tuple[str, bool, tuple[int, ...]]
"""A predicate, whether it holds or not, and its objects by number."""

Ways = list[tuple[Fact, ...]]
"""Sets of facts, each of which makes a condition hold; one that is empty is always there."""


def relaxed(task: PddlTask, deadline: Deadline) -> StripsTask:
    """Ground the delete relaxation of a task.

    A condition that something does not hold becomes a fact of its own, which what deletes it gives. Raises
    :class:`InputError` for effects under conditions that change, and for conditions with more than a
    thousand ways to hold; :class:`LimitError` at the deadline.
    """
    return _Relaxation(task).ground(deadline)


def deletes_matter(task: PddlTask) -> bool:
    """Whether a task may differ from its relaxation: something that is asked for can be lost again."""
    effects = [effect for schema in task.domain.schemas for effect in schema.effects]
    lost = {(effect.atom.predicate, effect.adds) for effect in effects}
    conditions = [task.goal, *(schema.condition for schema in task.domain.schemas)]
    conditions += [effect.condition for effect in effects]
    return any((each.atom.predicate, not each.holds) in lost for c in conditions for each in literals(c))


class _Prepared(NamedTuple):
    """An action as it is grounded: with no quantifiers, but more parameters than those that name it."""

    schema: Schema
    parameters: tuple[Variable, ...]
    condition: Formula
    effects: tuple[Effect, ...]


class _Relaxation:
    def __init__(self, task: PddlTask) -> None:
        self.task, self.domain = task, task.domain
        self.numbers = {name: number for number, name in enumerate(task.objects)}
        self.of_types = _OfTypes(task.objects)
        effects = [effect for schema in self.domain.schemas for effect in schema.effects]
        self.changing = {effect.atom.predicate for effect in effects}
        self.deleted = {effect.atom.predicate for effect in effects if not effect.adds}
        self.start = {self._fact(atom, {}) for atom in task.start}
        self.goal, self.goal_variables = expanded(task.goal, self.of_types)
        conditions = [self.task.goal, *(schema.condition for schema in self.domain.schemas)]
        self.negative = {
            each.atom.predicate
            for condition in conditions
            for each in literals(condition)
            if not each.holds and each.atom.predicate in self.changing
        }
        self.schemas = [self._prepared(schema) for schema in self.domain.schemas]
        self.program = _Program(self)

    def _fact(self, atom: Atom, binding: Mapping[str, int], holds: bool = True) -> Fact:
        numbers = self.numbers
        terms = tuple([binding[t] if t in binding else numbers[t] for t in atom.terms])
        return atom.predicate, holds, terms

    def _prepared(self, schema: Schema) -> _Prepared:
        condition, more = expanded(schema.condition, self.of_types)
        effects = []
        for effect in filter(self._counts, map(_where_it_changes, schema.effects)):
            asked, others = expanded(effect.condition, self.of_types)
            effects.append(effect._replace(variables=(*effect.variables, *others), condition=asked))
        return _Prepared(schema, (*schema.parameters, *more), condition, tuple(effects))

    def _counts(self, effect: Effect) -> bool:
        """Whether an effect is one in the relaxation; what it asks for has to be settled from the start."""
        if not (effect.adds or effect.atom.predicate in self.negative):
            return False
        changing = [each.atom for each in literals(effect.condition) if each.atom.predicate in self.changing]
        if changing:
            self.domain.text.fault(
                effect.at,
                f"found an effect under the condition {changing[0]}, which actions change: conditional "
                "effects are beyond a delete relaxation here; make two actions of it",
            )
        return True

    def ground(self, deadline: Deadline) -> StripsTask:
        text, predicates = self.program.text(), self.program.actions
        program = Grounded([], text, ["--warn=none"], 0, deadline, endless=True, doing=_DOING)
        try:
            found = program.consequences(predicates)
        finally:
            program.close()
        facts = _Facts(self)
        with deadline.watched(_DOING):
            actions = [
                action
                for prepared, bindings in zip(self.schemas, found, strict=True)
                for action in self._actions(prepared, bindings, facts)
            ]
            goals = self._goals(facts, actions)
        return StripsTask(Path(self.task.text.file).name, facts.names, actions, frozenset(facts.start), goals)

    def _goals(self, facts: "_Facts", actions: list[StripsAction]) -> tuple[int, ...]:
        bindings: Iterable[dict[str, int]] = self.of_types.bindings(self.goal_variables, self.numbers)
        ways = list(dict.fromkeys(way for each in bindings for way in self.ways(self.goal, each, 0)))
        if len(ways) == 1 and ways[0]:
            return tuple(map(facts.number, ways[0]))
        goal = facts.named(REACHED)
        place = Source(self.task.text.file, 1)
        for way in ways:
            needs = [facts.number(fact) for fact in way]
            actions.append(StripsAction(REACHED, needs, [goal], Fraction(0), place))
        return (goal,)

    def _actions(
        self, prepared: _Prepared, found: list[tuple[int, ...]], facts: "_Facts"
    ) -> Iterator[StripsAction]:
        schema, names = prepared.schema, [each.name for each in prepared.parameters]
        place = self._place(schema)
        named, objects = len(schema.parameters), list(self.numbers)
        for terms in found:
            binding = dict(zip(names, terms, strict=True))
            ways = self.ways(prepared.condition, binding, schema.at)
            if not ways:
                continue
            gives = [facts.number(fact) for fact in self._given(prepared, binding)]
            name = f"({' '.join((schema.name, *(objects[term] for term in terms[:named])))})"
            cost = self._cost(schema, binding)
            for way in ways:
                yield StripsAction(name, [facts.number(fact) for fact in way], gives, cost, place)

    def _place(self, schema: Schema) -> Source:
        text = self.domain.text
        return Source(text.file, text.text.count("\n", 0, schema.at) + 1)

    def _given(self, prepared: _Prepared, binding: dict[str, int]) -> Iterable[Fact]:
        given: dict[Fact, None] = {}
        lost: dict[Fact, None] = {}
        for effect in prepared.effects:
            for each in self.of_types.bindings(effect.variables, self.numbers, binding):
                if not self.ways(effect.condition, each, effect.at):
                    continue
                if effect.adds:
                    given[self._fact(effect.atom, each)] = None
                else:
                    lost[self._fact(effect.atom, each, holds=False)] = None
        for predicate, holds, terms in lost:
            if (predicate, True, terms) not in given:  # what is deleted and added is added
                given[predicate, holds, terms] = None
        return given

    def _cost(self, schema: Schema, binding: Mapping[str, int]) -> Fraction:
        if not self.task.costed:
            return Fraction(1)
        total = Fraction(0)
        objects = list(self.task.objects)
        for cost in schema.costs:
            if isinstance(cost, Atom):
                terms: Terms = tuple(objects[binding[t]] if t in binding else t for t in cost.terms)
                value = self.task.values.get((cost.predicate, terms))
                if value is None:
                    shown = Atom(cost.predicate, terms)
                    self.domain.text.fault(
                        schema.at, f"the cost {shown} of this action has no value in {self.task.text.file}"
                    )
                total += value
            else:
                total += cost
        return total

    def ways(self, formula: Formula, binding: Mapping[str, int], at: int) -> Ways:
        """Give the sets of changing facts that make a condition hold, smallest conditions only."""
        if isinstance(formula, Literal):
            return self._ways_of(formula, binding)
        if isinstance(formula, Equal):
            left, right = (
                binding[t] if t in binding else self.numbers[t] for t in (formula.left, formula.right)
            )
            return [()] if (left == right) == formula.holds else []
        if isinstance(formula, AnyOf):
            found = dict.fromkeys(way for part in formula.parts for way in self.ways(part, binding, at))
            return [()] if () in found else list(found)
        assert isinstance(formula, All)
        ways: Ways = [()]
        for part in formula.parts:
            more = self.ways(part, binding, at)
            if len(ways) * len(more) > _MOST_WAYS:
                self.domain.text.fault(
                    at, f"found a condition with more than {_MOST_WAYS} ways to hold, which is beyond this"
                )
            if len(ways) == len(more) == 1:
                ways = [ways[0] + more[0]]
            else:
                ways = list(dict.fromkeys(tuple(dict.fromkeys(a + b)) for a in ways for b in more))
        return ways

    def _ways_of(self, literal: Literal, binding: Mapping[str, int]) -> Ways:
        """Give the facts that make a literal hold: none are needed where it always does."""
        fact = self._fact(literal.atom, binding)
        predicate, _, terms = fact
        changes = predicate in (self.changing if literal.holds else self.deleted)
        if changes:
            return [((predicate, literal.holds, terms),)]
        return [()] if (fact in self.start) == literal.holds else []


def _where_it_changes(effect: Effect) -> Effect:
    """Leave out of a condition what is only asked so that the effect changes anything: ``when (not p) p``."""
    same = Literal(effect.atom, holds=not effect.adds)

    def kept(formula: Formula) -> Formula:
        if isinstance(formula, All):
            return All(tuple(kept(part) for part in formula.parts if part != same))
        return formula

    return effect._replace(condition=kept(All((effect.condition,))))


class _Facts:
    """The facts that were met, numbered, and those among them that hold at the start."""

    def __init__(self, relaxation: _Relaxation) -> None:
        self._relaxation = relaxation
        self._objects = list(relaxation.numbers)
        self._numbers: dict[Fact, int] = {}
        self.names: list[str] = []
        self.start: set[int] = set()

    def number(self, fact: Fact) -> int:
        number = self._numbers.get(fact)
        if number is None:
            predicate, holds, terms = fact
            atom = f"({' '.join((predicate, *(self._objects[term] for term in terms)))})"
            number = self._numbers[fact] = self.named(atom if holds else f"(not {atom})")
            if ((predicate, True, terms) in self._relaxation.start) == holds:
                self.start.add(number)
        return number

    def named(self, name: str) -> int:
        self.names.append(name)
        return len(self.names) - 1


class _OfTypes(dict[tuple[str, ...], list[str]]):
    """The objects of each list of types, found when first asked for."""

    def __init__(self, objects: Mapping[str, set[str]]) -> None:
        super().__init__()
        self._objects = objects

    def __missing__(self, types: tuple[str, ...]) -> list[str]:
        self[types] = found = [name for name, of in self._objects.items() if not of.isdisjoint(types)]
        return found

    def bindings(
        self, variables: Sequence[Variable], numbers: Mapping[str, int], within: Mapping[str, int] = {}
    ) -> Iterator[dict[str, int]]:
        """Give every way to put objects, by number, in the place of variables."""
        for objects in itertools.product(*(self[each.types] for each in variables)):
            more = {each.name: numbers[o] for each, o in zip(variables, objects, strict=True)}
            yield {**within, **more}


class _Program:
    """The rules for clingo, in which everything has a number, so that no name can mean anything else.

    ``actions`` are the predicates of the actions, by name and arity: their atoms are all that can ever run.
    """

    def __init__(self, relaxation: _Relaxation) -> None:
        self._relaxation = relaxation
        self._predicates = {name: number for number, name in enumerate(relaxation.domain.predicates)}
        self._types: dict[tuple[str, ...], str] = {}
        self._rules: list[str] = []
        self._helpers = 0
        self.actions = [
            (f"a{number}", len(prepared.parameters)) for number, prepared in enumerate(relaxation.schemas)
        ]

    def text(self) -> str:
        relaxation = self._relaxation
        for predicate, _, terms in sorted(relaxation.start):
            listed = ",".join(map(str, terms))
            self._rules.append(f"f{self._predicates[predicate]}({listed}).")
            if predicate in relaxation.negative:
                self._rules.append(f"s{self._predicates[predicate]}({listed}).")
        for number, prepared in enumerate(relaxation.schemas):
            self._action(number, prepared)
        return "\n".join(self._rules) + "\n"

    def _action(self, number: int, prepared: _Prepared) -> None:
        types = {each.name: each.types for each in prepared.parameters}
        write = self._writer(prepared.parameters)
        head = f"a{number}({','.join(write(name) for name in types)})"
        self._rule(head, [*self._typed(types, write), *self._body(prepared.condition, types, write)])
        for effect in prepared.effects:
            own = self._writer((*prepared.parameters, *effect.variables))
            body = [head, *self._typed({each.name: each.types for each in effect.variables}, own)]
            kind = "f" if effect.adds else "n"
            listed = ",".join(own(term) for term in effect.atom.terms)
            self._rule(f"{kind}{self._predicates[effect.atom.predicate]}({listed})", body)

    def _rule(self, head: str, body: Iterable[str]) -> None:
        listed = ",".join(body)
        self._rules.append(f"{head} :- {listed}." if listed else f"{head}.")

    def _writer(self, variables: Sequence[Variable]) -> Callable[[str], str]:
        places = {each.name: f"X{place}" for place, each in enumerate(variables)}
        numbers = self._relaxation.numbers
        return lambda term: places[term] if term in places else str(numbers[term])

    def _typed(self, types: Mapping[str, tuple[str, ...]], write: Callable[[str], str]) -> Iterator[str]:
        for name, kinds in types.items():
            if kinds not in self._types:
                self._types[kinds] = f"t{len(self._types)}"
                numbers = self._relaxation.numbers
                of = [numbers[each] for each in self._relaxation.of_types[kinds]]
                self._rules += [f"{self._types[kinds]}({each})." for each in of]
            yield f"{self._types[kinds]}({write(name)})"

    def _body(
        self, formula: Formula, types: Mapping[str, tuple[str, ...]], write: Callable[[str], str]
    ) -> Iterator[str]:
        """Write a condition as a body: alternatives become a predicate of their own."""
        if isinstance(formula, All):
            for part in formula.parts:
                yield from self._body(part, types, write)
        elif isinstance(formula, Equal):
            sign = "=" if formula.holds else "!="
            yield f"{write(formula.left)}{sign}{write(formula.right)}"
        elif isinstance(formula, AnyOf):
            terms = sorted({t for part in formula.parts for t in _variables(part)} & types.keys())
            yield self._helper(
                terms, types, write, [list(self._body(p, types, write)) for p in formula.parts]
            )
        elif isinstance(formula, Literal):
            relaxation, predicate = self._relaxation, formula.atom.predicate
            number, listed = self._predicates[predicate], ",".join(map(write, formula.atom.terms))
            if formula.holds:
                yield f"f{number}({listed})"
            elif predicate not in relaxation.changing:
                yield f"not f{number}({listed})"
            elif predicate not in relaxation.deleted:
                yield f"not s{number}({listed})"
            else:
                terms = sorted({*formula.atom.terms} & types.keys())
                ways = [[f"not s{number}({listed})"], [f"n{number}({listed})"]]
                yield self._helper(terms, types, write, ways)

    def _helper(
        self,
        terms: Sequence[str],
        types: Mapping[str, tuple[str, ...]],
        write: Callable[[str], str],
        ways: Iterable[Iterable[str]],
    ) -> str:
        self._helpers += 1
        head = f"h{self._helpers}({','.join(map(write, terms))})"
        typed = list(self._typed({term: types[term] for term in terms}, write))
        for way in ways:
            self._rule(head, [*typed, *way])
        return head


def _variables(formula: Formula) -> Iterator[str]:
    if isinstance(formula, Literal):
        yield from formula.atom.terms
    elif isinstance(formula, Equal):
        yield from (formula.left, formula.right)
    elif isinstance(formula, All | AnyOf):
        for part in formula.parts:
            yield from _variables(part)
