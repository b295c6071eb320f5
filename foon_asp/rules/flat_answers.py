"""Flat bodies, answered for the units of one problem: only those units are looked at that are asked about."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from clingo.ast import ComparisonOperator
from clingo.symbol import Number, String, Symbol

from foon_asp.encoding.facts import millionths, quote, source_names
from foon_asp.escapes import encodable
from foon_asp.problem import Problem
from foon_asp.rules.clause import Signature, compared
from foon_asp.rules.flat_body import (
    NUMBER,
    Asking,
    Compare,
    Constant,
    Counted,
    Fact,
    Item,
    Listed,
    Never,
    Row,
    Table,
    Term,
    Variable,
    Way,
    bound_by,
    variables_of,
)

_Values = dict[
    Variable, Any
]  # ids, texts, numbers, symbols; of tables and of ``located``, tuples are matched
_Facts = Callable[[Any], Collection[Any]]  # what facts of a predicate say of their first argument


class _Step(NamedTuple):
    """An item, with the steps of the ways within it and the terms that these count.

    Where this item and all after it depend on one variable alone that has its value before, ``alone`` is that
    and ``known`` remembers for which of its values they hold.
    """

    item: Item
    inner: "tuple[tuple[_Steps, tuple[Term, ...]], ...]"
    alone: Variable | None
    known: dict[Any, bool]


_Steps = tuple[_Step, ...]


class FlatAnswers:
    """Answers flat bodies for a problem."""

    def __init__(
        self, problem: Problem, tables: Mapping[Signature, Table], prices: Mapping[int, int]
    ) -> None:
        """Look at a problem, with the tables that bodies look at, and prices of units in hundredths."""
        self._problem = problem
        self._facts = _facts(problem, prices)
        self._tables: dict[Signature, frozenset[tuple[Any, ...]]] = {}
        for signature, table in tables.items():
            rows = (self._rows(_steps(way.items, ()), head, {}) for way, head in table.rows)
            self._tables[signature] = frozenset().union(*rows)

    def any_holds(self, ways: Iterable[Way]) -> bool:
        """Whether some way holds that takes no unit."""
        return any(self._holds(_steps(way.items, ()), {}) for way in ways)

    def removed(self, ways: Iterable[Way]) -> Callable[[int], bool]:
        """Return a test of units: whether some way holds that takes the unit."""
        tests = [(way.unit, _steps(way.items, (way.unit,))) for way in ways if way.unit is not None]
        return lambda unit: any(self._holds(steps, {variable: unit}) for variable, steps in tests)

    def weight(self, row: Row) -> Callable[[int], int]:
        """Return a function for how much one execution of a unit adds to the sum of a row."""
        terms = [
            (way.unit, _steps(way.items, (way.unit,)), (term,))
            for way, term in row.terms
            if way.unit is not None
        ]

        def weight(unit: int) -> int:
            numbers = {
                number for each, steps, term in terms for (number,) in self._rows(steps, term, {each: unit})
            }
            return sum(number for number in numbers if isinstance(number, int))

        return weight

    def asked(self, asking: Asking) -> Iterator[frozenset[int] | None]:
        """Return the sets of units that a rule asks for one of; ``None`` for those that it has without."""
        bound = bound_by(asking.when.items)
        for values in self._solutions(_steps(asking.when.items, ()), 0, {}):
            without = (way for way in asking.helping if way.unit is None)
            if any(self._holds(_steps(way.items, bound), values) for way in without):
                yield None
            else:
                helping = (way for way in asking.helping if way.unit is not None)
                yield frozenset().union(*(self._units(way, values) for way in helping))

    def _units(self, way: Way, values: _Values) -> set[int]:
        """Return the units for which a way holds."""
        assert way.unit is not None
        return self._satisfying(way.unit, self._candidates(way, values), way.items, values)

    def _satisfying(
        self, variable: Variable, among: Iterable[int], items: Sequence[Item], values: _Values
    ) -> set[int]:
        """Return the values of a variable, among some, for which items hold."""
        steps = _steps(items, (*values, variable))
        return {each for each in among if self._holds(steps, {**values, variable: each})}

    def _candidates(self, way: Way, values: _Values) -> Iterable[int]:
        """Return some units, among them all for which a way holds, faster than by a look at each."""
        network = self._problem.network
        sides: dict[str, Sequence[tuple[int, ...]]] = {
            "input": network.inputs,
            "needs": self._problem.needs,
            "output": network.outputs,
            "gives": self._problem.gives,
        }
        known = values.keys() | {way.unit}
        for place, item in enumerate(way.items):
            if not isinstance(item, Fact) or item.terms[0] != way.unit:
                known |= bound_by([item])
                continue
            (name, _), term = item.signature, item.terms[-1]
            if item.signature == NUMBER and isinstance(term, Constant):
                unit = network.unit_of_number(term.value) if isinstance(term.value, int) else None
                return [] if unit is None else [unit]
            if name == "motion" and (isinstance(term, Constant) or term in values):
                motion = _value(term, values)
                return [unit for unit, each in enumerate(network.motions) if each == motion]
            after = way.items[place + 1 :]
            if not isinstance(term, Variable) or term in known:
                continue
            if name in sides and after and known.isdisjoint(variables_of(after)):
                objects = self._satisfying(term, self._likely(term, after), after, values)
                if name in {"output", "gives"}:
                    return sorted({unit for o in objects for unit in network.producers[o]})
                return [unit for unit, side in enumerate(sides[name]) if not objects.isdisjoint(side)]
            known |= bound_by([item])
        return range(len(network))

    def _likely(self, variable: Variable, items: Sequence[Item]) -> Iterable[int]:
        """Return some object nodes, among them all for which items hold: by a label or ingredient."""
        network = self._problem.network
        for item in items:
            if isinstance(item, Fact) and item.terms[0] == variable:
                match item.signature[0], item.terms[-1]:
                    case "label", Constant(str(name)):
                        return network.by_label.get(name, ())
                    case "ingredient", Constant(str(name)):
                        return network.by_ingredient.get(name, ())
        return range(len(network.objects))

    def _holds(self, steps: _Steps, values: _Values, place: int = 0) -> bool:
        """Whether there are values, beside some, with which steps from a place on hold."""
        if place == len(steps):
            return True
        step = steps[place]
        if step.alone is not None:
            known = step.known.get(values[step.alone])
            if known is not None:
                return known
        found = any(self._holds(steps, each, place + 1) for each in self._matches(step, values))
        if step.alone is not None:
            step.known[values[step.alone]] = found
        return found

    def _solutions(self, steps: _Steps, place: int, values: _Values) -> Iterator[_Values]:
        """Return all values, beside some, with which steps from a place on hold."""
        if place == len(steps):
            yield values
        else:
            for each in self._matches(steps[place], values):
                yield from self._solutions(steps, place + 1, each)

    def _rows(self, steps: _Steps, terms: Sequence[Term], values: _Values) -> set[tuple[Any, ...]]:
        """Return what terms are wherever steps hold."""
        return {tuple(_value(term, each) for term in terms) for each in self._solutions(steps, 0, values)}

    def _matches(self, step: _Step, values: _Values) -> Collection[_Values]:
        """Return the values with which one item holds: some that are known, and those that it binds."""
        item = step.item
        if isinstance(item, Fact):
            name, arity = item.signature
            if name == "goal":
                return _agreeing(item.terms[0], self._problem.goals, values)
            said = self._facts[name](_value(item.terms[0], values))
            if arity == 1:
                return (values,) if said else ()
            return _agreeing(item.terms[1] if arity == 2 else item.terms[1:], said, values)
        if isinstance(item, Listed):
            return _agreeing(item.terms, self._tables[item.signature], values)
        if isinstance(item, Compare):
            return _comparing(item, values)
        return (values,) if self._holds_within(step, values) else ()

    def _holds_within(self, step: _Step, values: _Values) -> bool:
        """Whether what an item says of ways within it holds: that none does, or how many rows they have."""
        item = step.item
        if not isinstance(item, Counted):
            return not any(self._holds(steps, values) for steps, _ in step.inner)
        rows = set[tuple[Any, ...]]().union(*(self._rows(*inner, values) for inner in step.inner))
        number = Number(len(rows))
        holds = all(compared(number, how, _symbol(_value(term, values))) for how, term in item.guards)
        return holds is not item.negated


def _steps(items: Sequence[Item], bound: Iterable[Variable]) -> _Steps:
    """Return items as steps, where some variables have their values before."""
    known, found = set(bound), list[_Step]()
    for place, item in enumerate(items):
        inner: tuple[tuple[_Steps, tuple[Term, ...]], ...] = ()
        if isinstance(item, Never):
            inner = tuple((_steps(way.items, item.given), ()) for way in item.ways)
        elif isinstance(item, Counted):
            inner = tuple((_steps(way.items, item.given), terms) for way, terms in item.rows)
        before = known & variables_of(items[place:])
        found.append(_Step(item, inner, before.pop() if len(before) == 1 else None, {}))
        known |= bound_by([item])
    return tuple(found)


def _agreeing(terms: Term | Sequence[Term], rows: Collection[Any], values: _Values) -> Collection[_Values]:
    """Return the values with which terms are a row; those of one term are no tuples."""
    if isinstance(terms, Variable) and terms not in values:
        return [{**values, terms: row} for row in rows]
    if isinstance(terms, Variable | Constant):
        return (values,) if _value(terms, values) in rows else ()
    if all(isinstance(term, Constant) or term in values for term in terms):
        return (values,) if tuple(_value(term, values) for term in terms) in rows else ()
    found = []
    for row in rows:
        bound = values
        for term, value in zip(terms, row, strict=True):
            if isinstance(term, Variable) and term not in bound:
                bound = {**bound, term: value}
            elif _value(term, bound) != value:
                break
        else:
            found.append(bound)
    return found


def _comparing(item: Compare, values: _Values) -> Collection[_Values]:
    for one, other in ((item.left, item.right), (item.right, item.left)):
        if isinstance(one, Variable) and one not in values:
            return ({**values, one: _value(other, values)},)
    left, right = _value(item.left, values), _value(item.right, values)
    if item.comparison is ComparisonOperator.Equal:
        holds = left == right
    elif item.comparison is ComparisonOperator.NotEqual:
        holds = left != right
    else:
        holds = compared(_symbol(left), item.comparison, _symbol(right))
    return (values,) if holds else ()


def _value(term: Term, values: _Values) -> Any:
    return term.value if isinstance(term, Constant) else values[term]


def _facts(problem: Problem, prices: Mapping[int, int]) -> dict[str, _Facts]:
    """Return what facts say of a unit, an object node or a label, by the name of their predicate."""
    network, objects, inputs = problem.network, problem.network.objects, problem.network.inputs
    seen = problem.as_seen or problem
    written = lru_cache(maxsize=1000)(encodable)  # many units are of one video
    return {
        "unit": lambda unit: (unit,),
        "object": lambda o: (o,),
        "kitchen": lambda o: (o,) if o in problem.kitchen_seen else (),
        "utensil": lambda label: (label,) if label in problem.utensils else (),
        NUMBER[0]: lambda unit: (network.unit_number(unit),),
        "motion": lambda unit: (network.motions[unit],),
        "label": lambda o: (objects[o].label,),
        "inputs": lambda unit: (len(inputs[unit]),),
        "ingredients": lambda unit: (sum(len(objects[o].ingredients) for o in inputs[unit]),),
        "input": inputs.__getitem__,
        "output": network.outputs.__getitem__,
        "needs": problem.needs.__getitem__,
        "gives": problem.gives.__getitem__,
        "state": lambda o: objects[o].states,
        "ingredient": lambda o: [item for each in objects[o].contents for item in each.ingredients],
        "located": lambda o: [tuple(each) for each in objects[o].relations],
        "source": lambda unit: source_names(network.sources[unit]),
        "video": lambda unit: [written(each) for s in network.sources[unit] for each in s.videos],
        "rate": lambda unit: () if problem.rates is None else (millionths(seen.rate(unit)),),
        "price": lambda unit: (prices[unit],) if unit in prices else (),
    }


def _symbol(value: Any) -> Symbol:
    """Return a value as clingo compares it; raises :class:`UserError` for a name that it does not take."""
    if isinstance(value, Symbol):
        return value
    if isinstance(value, str):
        quote(value)  # clingo cannot be given half a character
        return String(value)
    return Number(value)
