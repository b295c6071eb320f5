"""Evaluation of flat rule bodies over the units of one problem, lazily: only for units that are queried."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
from typing import Any, NamedTuple

from clingo.ast import ComparisonOperator
from clingo.symbol import Number, String, Symbol

from foon_asp.encoding.fact_writer import millionths, quote, source_names
from foon_asp.escapes import encodable
from foon_asp.problem import Problem
from foon_asp.rules.clause import Signature, compared
from foon_asp.rules.flat_body import (
    NUMBER,
    AtLeastOne,
    Compare,
    Constant,
    Counted,
    Disjunct,
    Fact,
    Item,
    LinearBound,
    Listed,
    Never,
    Table,
    Term,
    Variable,
    bound_by,
)

_Values = list[Any]  # of variables, by number: ids, texts, numbers, symbols
_Step = Callable[[_Values], bool]
_Answer = tuple[Any, ...]


class FlatAnswers:
    """Evaluator of flat bodies over one problem, compiled to chains of Python functions."""

    def __init__(
        self,
        problem: Problem,
        tables: Mapping[Signature, Table],
        size: int,
        prices: Mapping[int, int],
    ) -> None:
        """Evaluate the tables that bodies read.

        ``size`` is the number of variables, ``prices`` are in hundredths, by unit.
        """
        self._problem = problem
        self._fact_readers = _fact_readers(problem, prices)
        self._values: _Values = [None] * size
        self._tables: dict[Signature, frozenset[_Answer]] = {}
        for signature, table in tables.items():
            self._tables[signature] = frozenset(self._table(table))

    def any_holds(self, disjuncts: Iterable[Disjunct]) -> bool:
        """Whether some disjunct without a unit holds."""
        return any(self._step(disjunct.items, (), _success)(self._values) for disjunct in disjuncts)

    def removed(self, disjuncts: Iterable[Disjunct]) -> Callable[[int], bool]:
        """Return a test of units: whether some disjunct holds of the unit."""
        tests = [
            (disjunct.unit, self._step(disjunct.items, (disjunct.unit,), _success))
            for disjunct in disjuncts
            if disjunct.unit is not None
        ]
        values = self._values

        def is_removed(unit: int) -> bool:
            for variable, test in tests:
                values[variable] = unit
                if test(values):
                    return True
            return False

        return is_removed

    def weight(self, bound: LinearBound) -> Callable[[int], int]:
        """Return the weight function of a linear bound: of a unit, for one execution."""
        values, contributions = self._values, set[_Answer]()
        steps = [
            (
                disjunct.unit,
                self._step(disjunct.items, (disjunct.unit,), self._collecting([term], contributions)),
            )
            for disjunct, term in bound.terms
            if disjunct.unit is not None
        ]

        def weight(unit: int) -> int:
            contributions.clear()
            for variable, step in steps:
                values[variable] = unit
                step(values)
            return sum(number for (number,) in contributions if isinstance(number, int))

        return weight

    def required_sets(self, at_least_one: AtLeastOne) -> Iterator[frozenset[int] | None]:
        """Return the sets of units from each of which a tree has to have one.

        ``None`` stands for a set that facts satisfy without a unit.
        """
        values = self._values
        matches: list[_Values] = []
        bound = bound_by(at_least_one.when.items)

        def collect(values: _Values) -> bool:
            matches.append(list(values))
            return False

        self._step(at_least_one.when.items, (), collect)(values)
        for match in matches:
            values[:] = match
            if any(
                self._step(disjunct.items, bound, _success)(values)
                for disjunct in at_least_one.helpers
                if disjunct.unit is None
            ):
                yield None
            else:
                unit_sets = (
                    self._units(disjunct, bound)
                    for disjunct in at_least_one.helpers
                    if disjunct.unit is not None
                )
                yield frozenset().union(*unit_sets)

    def _units(self, disjunct: Disjunct, bound: Collection[Variable]) -> set[int]:
        """Return the units of which a disjunct holds."""
        assert disjunct.unit is not None
        return self._satisfying(disjunct.unit, self._candidates(disjunct, bound), disjunct.items, bound)

    def _candidates(self, disjunct: Disjunct, bound: Collection[Variable]) -> Iterable[int]:
        """Return a superset of the units of which a disjunct holds, from an index where there is one."""
        network = self._problem.network
        objects_of: dict[str, Sequence[tuple[int, ...]]] = {
            "input": network.inputs,
            "needs": self._problem.needs,
            "output": network.outputs,
            "gives": self._problem.gives,
        }
        bound_so_far = set(bound) if disjunct.unit is None else {*bound, disjunct.unit}
        for position, item in enumerate(disjunct.items):
            if not isinstance(item, Fact) or item.terms[0] != disjunct.unit:
                bound_so_far |= bound_by([item])
                continue
            name, term = item.signature[0], item.terms[-1]
            if item.signature == NUMBER and isinstance(term, Constant):
                unit = network.unit_of_number(term.value) if isinstance(term.value, int) else None
                return [] if unit is None else [unit]
            if name == "motion" and (isinstance(term, Constant) or term in bound):
                motion = self._read(term)(self._values)
                return [unit for unit, name in enumerate(network.motions) if name == motion]
            after = disjunct.items[position + 1 :]
            if not isinstance(term, Variable) or term in bound_so_far:
                continue
            if name in objects_of and _is_apart(after, bound_so_far):
                objects = self._satisfying(term, self._indexed_nodes(term, after), after)
                if name in {"output", "gives"}:
                    return sorted({unit for o in objects for unit in network.producers[o]})
                return [
                    unit
                    for unit, unit_objects in enumerate(objects_of[name])
                    if not objects.isdisjoint(unit_objects)
                ]
            bound_so_far |= bound_by([item])
        return range(len(network))

    def _indexed_nodes(self, variable: Variable, items: Sequence[Item]) -> Iterable[int]:
        """Return a superset of the object nodes of which items hold, by the label or ingredient they name."""
        network = self._problem.network
        for item in items:
            if isinstance(item, Fact) and item.terms[0] == variable:
                match item.signature[0], item.terms[-1]:
                    case "label", Constant(str(name)):
                        return network.by_label.get(name, ())
                    case "ingredient", Constant(str(name)):
                        return network.by_ingredient.get(name, ())
        return range(len(network.objects))

    def _satisfying(
        self, variable: Variable, among: Iterable[int], items: Sequence[Item], bound: Iterable[Variable] = ()
    ) -> set[int]:
        """Return the candidates of which items hold."""
        values, test = self._values, self._step(items, (*bound, variable), _success)
        members = set()
        for candidate in among:
            values[variable] = candidate
            if test(values):
                members.add(candidate)
        return members

    def _table(self, table: Table) -> set[_Answer]:
        rows: set[_Answer] = set()
        for disjunct, head in table.rows:
            self._step(disjunct.items, (), self._collecting(head, rows))(self._values)
        return rows

    def _step(self, items: Sequence[Item], bound: Iterable[Variable], next_step: _Step) -> _Step:
        """Return a function that searches for values under which the items and ``next_step`` hold."""
        bound_so_far = set(bound)
        before = []
        for item in items:
            before.append(frozenset(bound_so_far))
            bound_so_far.update(bound_by([item]))
        pure = next_step is _success
        for position, so_far in reversed(list(enumerate(before))):
            item = items[position]
            leads_to = item.terms[-1] if isinstance(item, Fact) and len(item.terms) > 1 else None
            if (
                pure
                and isinstance(leads_to, Variable)
                and bound_by([item]) - so_far == {leads_to}
                and _is_apart(items[position + 1 :], so_far)
            ):
                next_step = _remembered(leads_to, next_step)
            next_step = self._item_step(item, so_far, next_step)
        return next_step

    def _item_step(self, item: Item, bound: frozenset[Variable], next_step: _Step) -> _Step:
        """Return a step that searches for values under which one item and ``next_step`` hold."""
        if isinstance(item, Never):
            inner = [self._step(disjunct.items, item.bound, _success) for disjunct in item.disjuncts]
            return lambda values: not any(step(values) for step in inner) and next_step(values)
        if isinstance(item, Counted):
            return self._counted(item, next_step)
        if isinstance(item, Compare):
            return self._compare(item, bound, next_step)
        if isinstance(item, Listed):
            return self._match(item.terms, bound, self._tables[item.signature], next_step)
        return self._fact(item, bound, next_step)

    def _counted(self, item: Counted, next_step: _Step) -> _Step:
        """Return a step that compares the number of different rows of a count with its guards."""
        seen: set[_Answer] = set()
        steps = [
            self._step(disjunct.items, item.bound, self._collecting(terms, seen))
            for disjunct, terms in item.rows
        ]
        guards = [(operator, self._read(term)) for operator, term in item.guards]
        fixed = all(isinstance(term, Constant) for _, term in item.guards)
        verdicts: dict[int, bool] = {}  # by count, where all guards are constants

        def step(values: _Values) -> bool:
            seen.clear()
            for row_step in steps:
                row_step(values)
            holds = verdicts.get(len(seen))
            if holds is None:
                number = Number(len(seen))
                holds = all(compared(number, operator, _symbol(read(values))) for operator, read in guards)
                if fixed:
                    verdicts[len(seen)] = holds
            return holds is not item.negated and next_step(values)

        return step

    def _collecting(self, terms: Sequence[Term], rows: set[_Answer]) -> _Step:
        """Return a step that adds the values of terms to ``rows`` and fails, so that all values are found."""
        reads = list(map(self._read, terms))

        def collect(values: _Values) -> bool:
            rows.add(tuple(read(values) for read in reads))
            return False

        return collect

    def _compare(self, item: Compare, bound: frozenset[Variable], next_step: _Step) -> _Step:
        """Return a step that compares two terms, or binds one to the value of the other."""
        for one, other in ((item.first, item.second), (item.second, item.first)):
            if isinstance(one, Variable) and one not in bound:
                return self._equal(one, bound, self._read(other), next_step)
        first, second = self._read(item.first), self._read(item.second)
        if item.comparison is ComparisonOperator.Equal:
            return lambda values: first(values) == second(values) and next_step(values)
        if item.comparison is ComparisonOperator.NotEqual:
            return lambda values: first(values) != second(values) and next_step(values)
        operator = item.comparison
        return lambda values: (
            compared(_symbol(first(values)), operator, _symbol(second(values))) and next_step(values)
        )

    def _fact(self, item: Fact, bound: frozenset[Variable], next_step: _Step) -> _Step:
        """Return a step that searches the facts about the first term of an item."""
        name, of = item.signature[0], self._read(item.terms[0])
        if name == "goal":
            return self._match(item.terms, bound, [(goal,) for goal in self._problem.goals], next_step)
        if name in self._fact_readers.tests:
            holds = self._fact_readers.tests[name]
            return lambda values: holds(of(values)) and next_step(values)
        if name in self._fact_readers.once:
            value_of = self._fact_readers.once[name]
            return self._equal(item.terms[1], bound, lambda values: value_of(of(values)), next_step)
        values_of = self._fact_readers.often[name]
        term = item.terms[1]
        if len(item.terms) > 2:
            rows = item.terms[1:]
            return lambda values: self._match(rows, bound, values_of(of(values)), next_step)(values)
        if isinstance(term, Variable) and term not in bound:
            return _for_each_value(term, lambda values: values_of(of(values)), next_step)
        wanted = self._read(term)
        return lambda values: wanted(values) in values_of(of(values)) and next_step(values)

    def _equal(
        self, term: Term, bound: Collection[Variable], read: Callable[[_Values], Any], next_step: _Step
    ) -> _Step:
        """Return a step that compares a term with what ``read`` returns, or binds the term to it."""
        if isinstance(term, Constant):
            constant = term.value
            return lambda values: read(values) == constant and next_step(values)
        if term in bound:
            return lambda values: read(values) == values[term] and next_step(values)

        def step(values: _Values) -> bool:
            values[term] = read(values)
            return next_step(values)

        return step

    def _match(
        self, terms: Sequence[Term], bound: Collection[Variable], rows: Collection[_Answer], next_step: _Step
    ) -> _Step:
        """Return a step that searches for a row that unifies with the terms."""
        reads = list(map(self._read, terms))
        if all(isinstance(term, Constant) or term in bound for term in terms):
            if len(terms) == 1:
                read, single = reads[0], frozenset(row[0] for row in rows)
                return lambda values: read(values) in single and next_step(values)
            return lambda values: tuple(read(values) for read in reads) in rows and next_step(values)

        def step(values: _Values) -> bool:
            for row in rows:
                met: set[Term] = set()
                for position, (term, value) in enumerate(zip(terms, row, strict=True)):
                    if isinstance(term, Variable) and term not in bound and term not in met:
                        met.add(term)
                        values[term] = value
                    elif reads[position](values) != value:
                        break
                else:
                    if next_step(values):
                        return True
            return False

        return step

    def _read(self, term: Term) -> Callable[[_Values], Any]:
        """Return a function that returns the value of a term."""
        if isinstance(term, Constant):
            constant = term.value
            return lambda _: constant
        return itemgetter(term)


class _FactReaders(NamedTuple):
    """Readers of facts about a unit, an object node or a label, by predicate.

    ``once`` return the one value, ``often`` several values, ``tests`` whether the fact exists.
    """

    once: dict[str, Callable[[int], Any]]
    often: dict[str, Callable[[int], Collection[Any]]]
    tests: dict[str, Callable[[Any], bool]]


def _fact_readers(problem: Problem, prices: Mapping[int, int]) -> _FactReaders:
    """Return the readers of all predicates of facts, over one problem."""
    network, kitchen, utensils = problem.network, problem.kitchen_seen, problem.utensils
    objects, inputs = network.objects, network.inputs
    seen = problem.as_seen or problem
    written = lru_cache(maxsize=1000)(encodable)  # many units are of one video
    once: dict[str, Callable[[int], Any]] = {
        "motion": network.motions.__getitem__,
        NUMBER[0]: network.unit_number,
        "label": lambda o: objects[o].label,
        "inputs": lambda unit: len(inputs[unit]),
        "ingredients": lambda unit: sum(len(objects[o].ingredients) for o in inputs[unit]),
    }
    often: dict[str, Callable[[int], Collection[Any]]] = {
        "input": inputs.__getitem__,
        "output": network.outputs.__getitem__,
        "needs": problem.needs.__getitem__,
        "gives": problem.gives.__getitem__,
        "state": lambda o: objects[o].states,
        "ingredient": lambda o: [item for content in objects[o].contents for item in content.ingredients],
        "located": lambda o: [tuple(relation) for relation in objects[o].relations],
        "source": lambda unit: source_names(network.sources[unit]),
        "video": lambda unit: [written(video) for s in network.sources[unit] for video in s.videos],
        "rate": lambda _: (),
        "price": lambda unit: (prices[unit],) if unit in prices else (),
    }
    if problem.rates is not None:
        once["rate"] = lambda unit: millionths(seen.rate(unit))
    tests: dict[str, Callable[[Any], bool]] = {
        "unit": lambda _: True,
        "object": lambda _: True,
        "kitchen": kitchen.__contains__,
        "utensil": utensils.__contains__,
    }
    return _FactReaders(once, often, tests)


def _for_each_value(variable: Variable, read: Callable[[_Values], Iterable[Any]], next_step: _Step) -> _Step:
    """Return a step that tries each value that ``read`` returns for a variable."""

    def step(values: _Values) -> bool:
        for value in read(values):
            values[variable] = value
            if next_step(values):
                return True
        return False

    return step


def _is_apart(items: Sequence[Item], bound: Collection[Variable]) -> bool:
    """Whether there are items, none of which shares a variable with ``bound``."""
    used = bound_by(items).union(*(item.bound for item in items if isinstance(item, Never | Counted)))
    return bool(items) and used.isdisjoint(bound)


def _remembered(variable: Variable, next_step: _Step) -> _Step:
    """Return ``next_step``, memoized by the value of the only variable that it depends on."""
    verdicts: dict[Any, bool] = {}

    def step(values: _Values) -> bool:
        value = values[variable]
        holds = verdicts.get(value)
        if holds is None:
            holds = verdicts[value] = next_step(values)
        return holds

    return step


def _success(_: _Values) -> bool:
    return True


def _symbol(value: Any) -> Symbol:
    """Return a value as a symbol; raises :class:`UserError` for a text that clingo does not take."""
    if isinstance(value, Symbol):
        return value
    if isinstance(value, str):
        quote(value)  # clingo cannot be given half a character
        return String(value)
    return Number(value)
