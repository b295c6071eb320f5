"""Flat bodies, answered for the units of one problem: only those units are looked at that are asked about."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from operator import itemgetter
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
)

_Values = list[Any]  # of variables, by number: ids, texts, numbers, symbols
_Step = Callable[[_Values], bool]
_Answer = tuple[Any, ...]


class FlatAnswers:
    """Answers flat bodies for a problem."""

    def __init__(
        self,
        problem: Problem,
        tables: Mapping[Signature, Table],
        size: int,
        prices: Mapping[int, int],
    ) -> None:
        """Look at a problem, with the tables that bodies look at and the number of their variables.

        ``prices`` are those of units, in hundredths.
        """
        self._problem = problem
        self._said = _said(problem, prices)
        self._values: _Values = [None] * size
        self._tables: dict[Signature, frozenset[_Answer]] = {}
        for signature, table in tables.items():
            self._tables[signature] = frozenset(self._table(table))

    def any_holds(self, ways: Iterable[Way]) -> bool:
        """Whether some way holds that takes no unit."""
        return any(self._step(way.items, (), _yes)(self._values) for way in ways)

    def removed(self, ways: Iterable[Way]) -> Callable[[int], bool]:
        """Return a test of units: whether some way holds that takes the unit."""
        tests = [(way.unit, self._step(way.items, (way.unit,), _yes)) for way in ways if way.unit is not None]
        values = self._values

        def is_removed(unit: int) -> bool:
            for variable, test in tests:
                values[variable] = unit
                if test(values):
                    return True
            return False

        return is_removed

    def weight(self, row: Row) -> Callable[[int], int]:
        """Return a function for how much one execution of a unit adds to the sum of a row."""
        values, found = self._values, set[_Answer]()
        steps = [
            (way.unit, self._step(way.items, (way.unit,), self._noting([term], found)))
            for way, term in row.terms
            if way.unit is not None
        ]

        def weight(unit: int) -> int:
            found.clear()
            for variable, step in steps:
                values[variable] = unit
                step(values)
            return sum(number for (number,) in found if isinstance(number, int))

        return weight

    def asked(self, asking: Asking) -> Iterator[frozenset[int] | None]:
        """Return the sets of units that a rule asks for one of; ``None`` for those that it has without."""
        values = self._values
        found: list[_Values] = []
        bound = bound_by(asking.when.items)

        def note(values: _Values) -> bool:
            found.append(list(values))
            return False

        self._step(asking.when.items, (), note)(values)
        for each in found:
            values[:] = each
            if any(self._step(way.items, bound, _yes)(values) for way in asking.helping if way.unit is None):
                yield None
            else:
                helping = (self._units(way, bound) for way in asking.helping if way.unit is not None)
                yield frozenset().union(*helping)

    def _units(self, way: Way, bound: Collection[Variable]) -> set[int]:
        """Return the units of which a way holds."""
        assert way.unit is not None
        return self._true_of(way.unit, self._candidates(way, bound), way.items, bound)

    def _candidates(self, way: Way, bound: Collection[Variable]) -> Iterable[int]:
        """Return some units, among them all of which a way holds, faster than by a look at each."""
        network = self._problem.network
        sides: dict[str, Sequence[tuple[int, ...]]] = {
            "input": network.inputs,
            "needs": self._problem.needs,
            "output": network.outputs,
            "gives": self._problem.gives,
        }
        known = set(bound) if way.unit is None else {*bound, way.unit}
        for place, item in enumerate(way.items):
            if not isinstance(item, Fact) or item.terms[0] != way.unit:
                known |= bound_by([item])
                continue
            name, term = item.signature[0], item.terms[-1]
            if item.signature == NUMBER and isinstance(term, Constant):
                unit = network.unit_of_number(term.value) if isinstance(term.value, int) else None
                return [] if unit is None else [unit]
            if name == "motion" and (isinstance(term, Constant) or term in bound):
                motion = self._read(term)(self._values)
                return [unit for unit, each in enumerate(network.motions) if each == motion]
            after = way.items[place + 1 :]
            if not isinstance(term, Variable) or term in known:
                continue
            if name in sides and _is_apart(after, known):
                objects = self._true_of(term, self._likely(term, after), after)
                if name in {"output", "gives"}:
                    return sorted({unit for o in objects for unit in network.producers[o]})
                return [unit for unit, side in enumerate(sides[name]) if not objects.isdisjoint(side)]
            known |= bound_by([item])
        return range(len(network))

    def _likely(self, variable: Variable, items: Sequence[Item]) -> Iterable[int]:
        """Give some object nodes, among them all of which items hold: by a label or ingredient they name."""
        network = self._problem.network
        for item in items:
            if isinstance(item, Fact) and item.terms[0] == variable:
                match item.signature[0], item.terms[-1]:
                    case "label", Constant(str(name)):
                        return network.by_label.get(name, ())
                    case "ingredient", Constant(str(name)):
                        return network.by_ingredient.get(name, ())
        return range(len(network.objects))

    def _true_of(
        self, variable: Variable, among: Iterable[int], items: Sequence[Item], bound: Iterable[Variable] = ()
    ) -> set[int]:
        """Return those of which items hold."""
        values, test = self._values, self._step(items, (*bound, variable), _yes)
        found = set()
        for each in among:
            values[variable] = each
            if test(values):
                found.add(each)
        return found

    def _table(self, table: Table) -> set[_Answer]:
        found: set[_Answer] = set()
        for way, head in table.rows:
            self._step(way.items, (), self._noting(head, found))(self._values)
        return found

    def _step(self, items: Sequence[Item], bound: Iterable[Variable], then: _Step) -> _Step:
        """Make a function that looks for values with which items hold, and ``then`` does."""
        known = set(bound)
        before = []
        for item in items:
            before.append(frozenset(known))
            known.update(bound_by([item]))
        pure = then is _yes
        for place, so_far in reversed(list(enumerate(before))):
            item = items[place]
            leads_to = item.terms[-1] if isinstance(item, Fact) and len(item.terms) > 1 else None
            if (
                pure
                and isinstance(leads_to, Variable)
                and bound_by([item]) - so_far == {leads_to}
                and _is_apart(items[place + 1 :], so_far)
            ):
                then = _remembered(leads_to, then)
            then = self._one(item, so_far, then)
        return then

    def _one(self, item: Item, bound: frozenset[Variable], then: _Step) -> _Step:
        if isinstance(item, Never):
            inner = [self._step(way.items, item.given, _yes) for way in item.ways]
            return lambda values: not any(each(values) for each in inner) and then(values)
        if isinstance(item, Counted):
            return self._counted(item, then)
        if isinstance(item, Compare):
            return self._compare(item, bound, then)
        if isinstance(item, Listed):
            return self._match(item.terms, bound, self._tables[item.signature], then)
        return self._fact(item, bound, then)

    def _counted(self, item: Counted, then: _Step) -> _Step:
        seen: set[_Answer] = set()
        steps = [self._step(way.items, item.given, self._noting(terms, seen)) for way, terms in item.rows]
        guards = [(operator, self._read(term)) for operator, term in item.guards]
        fixed = all(isinstance(term, Constant) for _, term in item.guards)
        known: dict[int, bool] = {}  # of counts, where nothing else decides

        def step(values: _Values) -> bool:
            seen.clear()
            for each in steps:
                each(values)
            holds = known.get(len(seen))
            if holds is None:
                number = Number(len(seen))
                holds = all(compared(number, operator, _symbol(read(values))) for operator, read in guards)
                if fixed:
                    known[len(seen)] = holds
            return holds is not item.negated and then(values)

        return step

    def _noting(self, terms: Sequence[Term], found: set[_Answer]) -> _Step:
        """Make a function that notes the values of terms, and goes on."""
        reads = list(map(self._read, terms))

        def note(values: _Values) -> bool:
            found.add(tuple(read(values) for read in reads))
            return False

        return note

    def _compare(self, item: Compare, bound: frozenset[Variable], then: _Step) -> _Step:
        for one, other in ((item.left, item.right), (item.right, item.left)):
            if isinstance(one, Variable) and one not in bound:
                return self._equal(one, bound, self._read(other), then)
        left, right = self._read(item.left), self._read(item.right)
        if item.comparison is ComparisonOperator.Equal:
            return lambda values: left(values) == right(values) and then(values)
        if item.comparison is ComparisonOperator.NotEqual:
            return lambda values: left(values) != right(values) and then(values)
        operator = item.comparison
        return lambda values: (
            compared(_symbol(left(values)), operator, _symbol(right(values))) and then(values)
        )

    def _fact(self, item: Fact, bound: frozenset[Variable], then: _Step) -> _Step:
        """Look for a fact: what is said of its first term."""
        name, of = item.signature[0], self._read(item.terms[0])
        if name == "goal":
            return self._match(item.terms, bound, [(goal,) for goal in self._problem.goals], then)
        if name in self._said.tests:
            holds = self._said.tests[name]
            return lambda values: holds(of(values)) and then(values)
        if name in self._said.once:
            said = self._said.once[name]
            return self._equal(item.terms[1], bound, lambda values: said(of(values)), then)
        said_often = self._said.often[name]
        term = item.terms[1]
        if len(item.terms) > 2:
            rows = item.terms[1:]
            return lambda values: self._match(rows, bound, said_often(of(values)), then)(values)
        if isinstance(term, Variable) and term not in bound:
            return _each(term, lambda values: said_often(of(values)), then)
        wanted = self._read(term)
        return lambda values: wanted(values) in said_often(of(values)) and then(values)

    def _equal(
        self, term: Term, bound: Collection[Variable], read: Callable[[_Values], Any], then: _Step
    ) -> _Step:
        """Hold a term against what is read, or give it that value."""
        if isinstance(term, Constant):
            constant = term.value
            return lambda values: read(values) == constant and then(values)
        if term in bound:
            return lambda values: read(values) == values[term] and then(values)

        def step(values: _Values) -> bool:
            values[term] = read(values)
            return then(values)

        return step

    def _match(
        self, terms: Sequence[Term], bound: Collection[Variable], rows: Collection[_Answer], then: _Step
    ) -> _Step:
        """Look for a row that terms agree with."""
        reads = list(map(self._read, terms))
        if all(isinstance(term, Constant) or term in bound for term in terms):
            if len(terms) == 1:
                read, single = reads[0], frozenset(row[0] for row in rows)
                return lambda values: read(values) in single and then(values)
            return lambda values: tuple(read(values) for read in reads) in rows and then(values)

        def step(values: _Values) -> bool:
            for row in rows:
                met: set[Term] = set()
                for place, (term, value) in enumerate(zip(terms, row, strict=True)):
                    if isinstance(term, Variable) and term not in bound and term not in met:
                        met.add(term)
                        values[term] = value
                    elif reads[place](values) != value:
                        break
                else:
                    if then(values):
                        return True
            return False

        return step

    def _read(self, term: Term) -> Callable[[_Values], Any]:
        """Make a function that gives the value of a term."""
        if isinstance(term, Constant):
            constant = term.value
            return lambda _: constant
        return itemgetter(term)


class _Said(NamedTuple):
    """What facts say of a unit, an object node or a label: once, often, or that it is so."""

    once: dict[str, Callable[[int], Any]]
    often: dict[str, Callable[[int], Collection[Any]]]
    tests: dict[str, Callable[[Any], bool]]


def _said(problem: Problem, prices: Mapping[int, int]) -> _Said:
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
        "ingredient": lambda o: [item for each in objects[o].contents for item in each.ingredients],
        "located": lambda o: [tuple(each) for each in objects[o].relations],
        "source": lambda unit: source_names(network.sources[unit]),
        "video": lambda unit: [written(each) for s in network.sources[unit] for each in s.videos],
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
    return _Said(once, often, tests)


def _each(variable: Variable, read: Callable[[_Values], Iterable[Any]], then: _Step) -> _Step:
    def step(values: _Values) -> bool:
        for value in read(values):
            values[variable] = value
            if then(values):
                return True
        return False

    return step


def _is_apart(items: Sequence[Item], known: Collection[Variable]) -> bool:
    """Whether items, one at least, are about no variable that is known before them."""
    used = bound_by(items).union(*(item.given for item in items if isinstance(item, Never | Counted)))
    return bool(items) and used.isdisjoint(known)


def _remembered(variable: Variable, then: _Step) -> _Step:
    """Do what comes next once for each value of a variable on which alone it depends."""
    known: dict[Any, bool] = {}

    def step(values: _Values) -> bool:
        value = values[variable]
        holds = known.get(value)
        if holds is None:
            holds = known[value] = then(values)
        return holds

    return step


def _yes(_: _Values) -> bool:
    return True


def _symbol(value: Any) -> Symbol:
    """Return a value as clingo compares it; raises :class:`UserError` for a name that it does not take."""
    if isinstance(value, Symbol):
        return value
    if isinstance(value, str):
        quote(value)  # clingo cannot be given half a character
        return String(value)
    return Number(value)
