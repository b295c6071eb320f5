"""Whole counts of executions where what actions need is used up: lower bounds on what every plan costs.

How often a plan executes each action satisfies a few linear conditions: of every object no more copies are
used up than there are, one of every target is left, and for each action that is used, another makes what it
reads, if nothing else provides it. Landmarks of plans in which nothing is used up hold as well. HiGHS solves
the relaxations in floats; what it proves is weighed again in whole numbers, so that no float decides.
"""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from heapq import heappop, heappush
from typing import NamedTuple

from foon_asp.bounds.cut import Cutter
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.whole_program import Solved, Stopped, WholeProgram

Counts = dict[int, int]
"""How often each action is executed; those that are not are left out."""

_Bounds = tuple[list[int], list[int | None]]

_HIT = 0.999999  # a landmark of which a greater part is executed is taken to be hit
_NEAR = 1e-6  # what differs less from a whole number is one, for choosing where to branch
_PROBES = 60  # actions that a root looks at to see whether they can be executed twice
_MOST_PARTS = 20_000  # that are looked at before a proof is given up
_MOST_UNCAPPED = 1_000  # where nothing says how many executions there can be
_ORDERS = 3  # in how many orders landmarks are looked for before there are taken to be no more
_FAR = 1000  # executions of an action that HiGHS takes to be many when it looks for counts
_FEWER = 8  # those that it takes to be many at first, which is much faster


class Flows(NamedTuple):
    """Actions over objects, both by number.

    An action can be executed while there is a copy of each object that it ``asks`` for. Then one copy of
    each that it ``uses`` is gone, and there is one more of each that it ``adds``. ``start`` says how many
    copies there are at first, where there are any. What never runs out is in none of these; ``items`` are
    the objects of that kind that an action asks for. One copy of each of the ``targets`` is to be left.
    """

    asks: Sequence[Sequence[int]]
    uses: Sequence[Sequence[int]]
    adds: Sequence[Sequence[int]]
    items: Sequence[Sequence[int]]
    start: Mapping[int, int]
    targets: Sequence[int]


class Measure(NamedTuple):
    """What executions cost by one objective, of which less is better.

    ``costs`` are those of each action, whole numbers from 0, and ``item`` what each distinct one of its
    ``items`` costs and each copy that is taken of what is there at first. Where ``exact`` is not ``None``,
    costs are rounded down: it gives the exact cost of counts, which depends on how many executions there are
    of each of the ``classes`` of actions; those of class -1 do not change it.
    """

    costs: Sequence[int]
    item: int = 0
    exact: Callable[[Mapping[int, int]], Fraction] | None = None
    classes: Sequence[int] = ()


class Landmark(NamedTuple):
    """That one of the ``members`` is executed, or a copy of one of ``stock`` is taken.

    With an ``action``, only if that is executed. ``objects`` are the cut that shows it.
    """

    members: tuple[int, ...]
    stock: tuple[int, ...] = ()
    action: int | None = None
    objects: tuple[int, ...] = ()


class Balance(NamedTuple):
    """That no more copies of an object are used up than there are."""

    object: int


class Sum(NamedTuple):
    """That a sum keeps to a limit, by its place among them."""

    limit: int


SumLimit = tuple[Mapping[int, int], int, bool, bool]
"""Weights by action, their greatest sum or, if the next is true, their least, and whether use counts."""


class Level(NamedTuple):
    """An objective, and what the plan in hand costs by it.

    ``most`` is the greatest sum of costs, rounded down as they are, that a plan can have which is as good.
    If it is ``strict``, what costs as much is not as good.
    """

    measure: Measure
    cost: Fraction
    most: int
    strict: bool = False


Condition = Landmark | Balance | Sum | Level
"""What a row of a program says of the counts of every plan."""


class BetterError(Exception):
    """Counts were found that may belong to a better plan, and do."""

    def __init__(self, counts: Counts) -> None:
        super().__init__("a better plan was found")
        self.counts = counts


class CountBound:
    """The counts of plans for one question.

    ``expired`` says when to give up, and ``left`` in how many seconds, if time is limited: methods then raise
    :class:`Stopped`. ``required`` are sets of actions of each of which one has to be executed. ``limits`` say
    of sums with a weight from 0 for each action how large they are, at most or at least: over executions, or
    over the actions that are used. ``derivation`` are actions that reach the targets if nothing is used up:
    landmarks are looked for around these. Plans are as good by each level of ``within``, and do not execute
    all that one of ``beside`` does, as often.
    """

    def __init__(
        self,
        flows: Flows,
        required: Sequence[Sequence[int]] = (),
        limits: Sequence[SumLimit] = (),
        derivation: Sequence[int] = (),
        within: Sequence[Level] = (),
        beside: Sequence[Counts] = (),
        expired: Callable[[], bool] = lambda: False,
    ) -> None:
        self._flows, self._limits, self._expired = flows, limits, expired
        self._size = len(flows.asks)
        self._within, self._beside = tuple(within), tuple(beside)
        self.derivation = derivation
        self._random, self._many = random.Random(0), _FAR
        self.proved: float | Fraction = 0  # what every plan costs at least by the first level, so far
        self._landmarks = [Landmark(tuple(units)) for units in required]
        self._makers: dict[int, list[int]] = {}
        for action, added in enumerate(flows.adds):
            for o in added:
                self._makers.setdefault(o, []).append(action)

    def counts(self, measures: Sequence[Measure], rounds: int = 30) -> Counts | None:
        """Find counts that cost least by HiGHS' word, the first measure most important; ``None`` if none.

        They are those of a plan in which nothing is used up, at least; whether a plan has them is left open,
        and nothing is proved.
        """
        for self._many in (_FEWER, _FAR):
            found = self._counts(measures, rounds)
            if found is not None and max(found.values(), default=0) < self._many:
                break
        return found

    def _counts(self, measures: Sequence[Measure], rounds: int) -> Counts | None:
        found: Counts | None = None
        for _ in range(rounds):
            model = self._model(measures, far=True)
            x: list[float] = []
            for measure in measures:
                relaxed = self._relaxed(model, model.objective(measure))
                whole = relaxed or model.program.whole_optimum(model.objective(measure))
                if whole is None:
                    return None
                x = whole
                model.keep(measure, x)
                self._check()
            found = {a: round(x[a]) for a in range(self._size) if x[a] > 0.5}
            if not self._add_landmark(x, model):
                break
        return found

    def _relaxed(self, model: "_Model", objective: Mapping[int, int]) -> list[float] | None:
        """Add landmarks that the relaxation misses; give its counts where they are whole."""
        while True:
            self._check()
            x = model.program.solve(objective).x
            if x is None or not self._separate(x, model, at_root=True):
                break
        columns = {*range(model.program.columns)}
        if not self._beside:
            columns.difference_update(range(self._size, 2 * self._size))
        if x is None or any(abs(x[column] - round(x[column])) > _NEAR for column in columns):
            return None
        for a in range(self._size):
            x[self._size + a] = float(x[a] > 0.5)
        return x

    def none(self) -> bool:
        """Whether it is proved that no counts satisfy the conditions, so that there is no plan."""
        model = self._model(())
        while True:
            solved = model.program.solve({})
            if solved.x is None:
                return solved.bound == math.inf
            if not self._add_landmark(solved.x, model):
                return False
            self._check()

    def most_executions(self) -> int | None:
        """Return how many executions a plan can have in all; ``None`` if not known."""
        program = self._model(()).program
        bound = program.solve(dict.fromkeys(range(self._size), -1)).bound
        return None if abs(bound) == math.inf else math.floor(-bound)

    def caps(self, level: Level) -> list[int | None]:
        """Return for each action how often a plan that is as good can execute it; ``None`` if not known."""
        model = self._model((level.measure,))
        model.limit(level)
        caps: list[int | None] = []
        for action in range(self._size):
            self._check()
            solved = model.program.solve({action: -1})
            caps.append(None if solved.bound == -math.inf else math.floor(-solved.bound))
            model.program.upper[action] = caps[-1]
            model.tighten()
        return caps

    def prove(self, levels: Sequence[Level], is_better: Callable[[Counts], bool]) -> None:
        """Prove that no plan is better than the one in hand, the first level most important.

        ``is_better`` is asked of counts that would be: whether there is an order to execute them in that is.
        Raises :class:`BetterError` with them, and :class:`Stopped`.
        """
        for place, level in enumerate(levels):
            before, rounded = levels[:place], level.measure.exact is not None
            most = level.most if rounded else math.ceil(level.cost) - 1
            self._prove(level.measure, most, is_better, before, [*before, level._replace(strict=True)])

    def every(self, levels: Sequence[Level], ask: Callable[[Counts], None]) -> None:
        """Ask about all counts that may be those of a plan as good as the one in hand, by each level.

        Costs of the last level are whole numbers. Raises :class:`Stopped`.
        """
        *before, last = levels
        self._prove(last.measure, last.most, ask, before, before)

    def none_is_left(self, measure: Measure, is_better: Callable[[Counts], bool]) -> None:
        """Prove that there is no plan at all; counts of few executions, by their measure, are asked first.

        ``is_better`` says whether some are those of a plan: then raises :class:`BetterError`. Raises
        :class:`Stopped` where nothing is proved.
        """
        proved = self.proved
        try:
            self._prove(measure, self.most_executions(), is_better)
        finally:
            self.proved = proved  # by another measure, maybe

    def _prove(
        self,
        measure: Measure,
        most: int | None,
        is_better: Callable[[Counts], bool | None],
        before: Sequence[Level] = (),
        levels: Sequence[Level] = (),
    ) -> None:
        """Ask about all counts that cost ``most`` at most, rounded down, if that is known.

        They are as good by each level ``before``, by sums. Where these are rounded, ``levels`` say what they
        cost exactly.
        """
        model = self._model([measure, *(level.measure for level in before)])
        for level in before:
            model.limit(level)
        objective = model.objective(measure)
        if most is not None:
            model.cap(measure, most)
            self._tighten_root(model, objective, most)
        cutoff = math.inf if most is None else most
        lower, upper = list(model.program.lower), list(model.program.upper)
        number = 0
        waiting: list[tuple[float | Fraction, int, int, _Bounds]] = [(0, sum(lower), number, (lower, upper))]
        while waiting:
            bound, _, _, (model.program.lower, model.program.upper) = heappop(waiting)
            if not before:
                self.proved = max(self.proved, bound)
            solved = self._solved(model, objective, cutoff)
            if solved.x is None:
                continue
            for lower, upper in self._branches(model, solved.x, levels, is_better):
                number += 1
                executions = sum(lower[: self._size])
                heappush(waiting, (max(bound, solved.bound), executions, -number, (lower, upper)))
            if number > (_MOST_UNCAPPED if most is None else _MOST_PARTS):
                raise Stopped

    def _solved(self, model: "_Model", objective: Mapping[int, int], cutoff: float) -> Solved:
        """Solve the relaxation of a part with all landmarks that it misses; no ``x`` where it has no plan."""
        while True:
            self._check()
            model.tighten()
            solved = model.program.solve(objective, cutoff)
            if solved.bound > cutoff or solved.bound == math.inf:
                return solved._replace(x=None)
            if solved.x is None:
                raise Stopped  # floats say that there is nothing, and no whole numbers do
            if not self._add_landmark(solved.x, model) and not self._separate(solved.x, model, at_root=False):
                return solved

    def _model(self, measures: Sequence[Measure], far: bool = False) -> "_Model":
        every = (*measures, *(level.measure for level in self._within))
        different = {id(measure): measure for measure in every}
        model = _Model(self, list(different.values()), far)
        for level in self._within:
            model.limit(level)
        return model

    def _tighten_root(self, model: "_Model", objective: Mapping[int, int], cutoff: int) -> None:
        """Look which actions cannot be executed twice: others need not be told what they read so loosely."""
        program, probed = model.program, set[int]()
        while len(probed) < _PROBES:
            self._check()
            solved = program.solve(objective, cutoff)
            if solved.x is None or solved.bound > cutoff:
                return
            if self._add_landmark(solved.x, model) or self._separate(solved.x, model, at_root=True):
                continue
            loose = [
                a
                for a in range(self._size)
                if solved.x[self._size + a] < min(1.0, solved.x[a]) - _NEAR and a not in probed
            ]
            if not loose:
                return
            for action in loose[: _PROBES - len(probed)]:
                probed.add(action)
                self._check()
                lower = program.lower[action]
                program.lower[action] = 2
                if program.solve(objective, cutoff).bound > cutoff:
                    program.upper[action] = 1
                program.lower[action] = lower
            model.tighten()

    def _branches(
        self,
        model: "_Model",
        x: Sequence[float],
        levels: Sequence[Level],
        is_better: Callable[[Counts], bool | None],
    ) -> Iterator[_Bounds]:
        """Return the parts into which what is left is divided, after a look at what was found."""
        program = model.program
        halves = [(abs(value - math.floor(value) - 0.5), column) for column, value in enumerate(x)]
        half = min((h for h in halves if h[0] < 0.5 - _NEAR), default=None)
        if half is not None:
            column = half[1]
            below = math.floor(x[column])
            yield program.with_bounds(column, None, below)
            yield program.with_bounds(column, below + 1, None)
            return
        counts = {a: round(x[a]) for a in range(self._size) if round(x[a])}
        idle = next((a for a in counts if not round(x[self._size + a])), None)
        if idle is not None:  # nothing says how often it may be executed, and so that it is
            yield program.with_bounds(idle, None, 0)
            lower, upper = program.with_bounds(idle, 1, None)
            lower[self._size + idle] = 1
            yield lower, upper
            return
        rounded = [each for each in (*self._within, *levels) if each.measure.exact is not None]
        worse = [
            each
            for each in rounded
            if (cost := _exact(each, counts)) > each.cost or (cost == each.cost and each.strict)
        ]
        held = model.held(counts, x)
        if held is not None:  # nothing says how often its action may be executed, and so that it holds
            action, count, column = held
            yield program.with_bounds(action, None, count - 1)
            lower, upper = program.with_bounds(action, count, None)
            lower[column] = 1
            yield lower, upper
            return
        if worse:
            yield from _around(program, x, model.class_columns(worse[0].measure))
            return
        if is_better(counts):
            raise BetterError(counts)
        yield from _around(program, x, range(self._size))

    def _add_landmark(self, x: Sequence[float], model: "_Model") -> bool:
        """Add a landmark that what is found misses; whether there is one.

        What can be made by the actions it executes, if nothing is used up, is closed. A target or an action
        that is not reached needs something that makes what is not reached from what is.
        """
        flows = self._flows
        used = {a for a in range(self._size) if x[self._size + a] > _NEAR}
        reached = {o for o, column in model.stock.items() if x[column] > _NEAR}
        if not model.stock:
            reached = {o for o, n in flows.start.items() if n}
        waiting = set(used)
        grown = True
        while grown:
            ready = [a for a in waiting if reached.issuperset(flows.asks[a])]
            grown = bool(ready)
            waiting.difference_update(ready)
            reached.update(o for a in ready for o in flows.adds[a])
        missed: list[tuple[int, int | None]]
        missed = [(target, None) for target in flows.targets if target not in reached]
        missed += [(next(o for o in flows.asks[a] if o not in reached), a) for a in sorted(waiting)]
        for o, action in missed[:1]:
            landmark = self._landmark(o, reached, used, model)._replace(action=action)
            self._landmarks.append(landmark)
            model.add_landmark(landmark)
        return bool(missed)

    @cached_property
    def _cutter(self) -> Cutter:
        flows = self._flows
        objects = {o for side in (*flows.asks, *flows.adds, flows.targets, flows.start) for o in side}
        start = [o for o, count in flows.start.items() if count]
        return Cutter(Hypergraph(max(objects, default=0) + 1, flows.asks, flows.adds, start), flows.targets)

    def _separate(self, x: Sequence[float], model: "_Model", at_root: bool) -> bool:
        """Add landmarks of the targets that what is found hits in part only; whether there are any.

        Actions that are executed more are next to the start, and at the root all but one of the derivation.
        Without a derivation none are looked for.
        """
        derivation, size = self.derivation, self._size
        if not derivation or self._cutter.hopeless or not self._cutter.targets:
            return False
        cutter, found = self._cutter, dict[tuple[int, ...], tuple[int, ...]]()
        keeps = [[a for a in derivation if a != gone] for gone in derivation]
        for number in range(_ORDERS):
            order = sorted(cutter.actions, key=lambda a: (-x[size + a], self._random.random()))
            for keep in ((), *(keeps if at_root and number == 0 else ())):
                cut = cutter.cut(keep, order)
                if cut is not None and sum(x[size + a] for a in cut.members) < _HIT:
                    found.setdefault(cut.members, cut.objects)
            if found:
                break
        for members in sorted(found):
            self._landmarks.append(Landmark(members, objects=found[members]))
            model.add_landmark(self._landmarks[-1])
        return bool(found)

    def _landmark(self, o: int, reached: set[int], used: set[int], model: "_Model") -> Landmark:
        """Grow a cut backwards from an object that is not reached, as small as it can be."""
        asks = self._flows.asks
        zone, stack, edge = {o}, [o], dict[int, None]()
        while stack:
            for maker in self._makers.get(stack.pop(), ()):
                edge[maker] = None
                if maker in used and zone.isdisjoint(asks[maker]):
                    lacking = next(each for each in asks[maker] if each not in reached)
                    zone.add(lacking)
                    stack.append(lacking)
        members = tuple(maker for maker in edge if zone.isdisjoint(asks[maker]))
        return Landmark(members, tuple(sorted(zone & model.stock.keys())), objects=tuple(sorted(zone)))

    def _check(self) -> None:
        if self._expired():
            raise Stopped


class _Model:
    """The conditions as rows over columns: first how often each action is executed, then helpers."""

    def __init__(self, bound: CountBound, measures: Sequence[Measure], far: bool = False) -> None:
        flows, size = bound._flows, bound._size
        self._flows = flows
        self.program = program = WholeProgram(size, bound._expired)
        self._far, self._size, self._many = far, size, bound._many
        self.conditions: dict[int, Condition] = {}  # by row: what it says of every plan
        for _ in range(size):
            program.column(0, 1)  # whether an action is executed at all
        self._loose = [program.open_row((size + a, a), 0) for a in range(size)]
        for a in range(size):
            program.row({a: 1, size + a: -1}, 0)
        self._classes: dict[int, list[int]] = {}
        priced = any(measure.item for measure in measures)
        self.stock: dict[int, int] = {}
        if priced:
            self.stock = {o: program.column(0, count) for o, count in flows.start.items() if count}
        change: dict[int, dict[int, int]] = {o: {} for o in (*bound._makers, *flows.targets)}
        for action in range(size):
            for o in flows.adds[action]:
                change[o][action] = change[o].get(action, 0) + 1
            for o in flows.uses[action]:
                row = change.setdefault(o, {})
                row[action] = row.get(action, 0) - 1
        wanted = set(flows.targets)
        for o, row in change.items():
            if any(part < 0 for part in row.values()) or o in wanted:
                self.conditions[program.row(*self._with_stock(o, row, int(o in wanted)))] = Balance(o)
        items = self.items = dict[int, int]()
        for action in range(size):
            y = size + action
            for o in (each for each in flows.asks[action] if each not in flows.uses[action]):
                makers = {size + maker: 1 for maker in bound._makers.get(o, ())}
                read = program.row(*self._with_stock(o, {**makers, y: -1}, 0))
                if o in self.stock or not flows.start.get(o):  # else it says nothing
                    self.conditions[read] = Landmark((), (), action, (o,))
            for o in flows.items[action] if priced else ():
                if o not in items:
                    items[o] = program.column(0, 1)
                self.conditions[program.row({items[o]: 1, y: -1}, 0)] = Landmark((), (), action, (o,))
        for landmark in bound._landmarks:
            self.add_landmark(landmark)
        for place, (weights, limit, at_least, used) in enumerate(bound._limits):
            first, sign = size if used else 0, 1 if at_least else -1
            row = {first + a: sign * weight for a, weight in weights.items()}
            self.conditions[program.row(row, sign * limit)] = Sum(place)
            for a, weight in weights.items() if not at_least and not used else ():
                program.cap(a, max(limit, 0) // weight)
        for measure in measures:
            if measure.exact is not None and not far:
                self._add_classes(measure)
        self._often: dict[tuple[int, int], tuple[int, int]] = {}
        for counts in bound._beside:
            columns = [self._as_often(a, n) for a, n in counts.items()]
            program.row(dict.fromkeys(columns, -1), 1 - len(columns))
        self.tighten()

    def _as_often(self, action: int, count: int) -> int:
        """Return the column that says whether an action is executed so often."""
        if count == 1:
            return self._size + action
        if (action, count) not in self._often:
            column = self.program.column(0, 1)
            self.program.row({action: 1, column: -count}, 0)
            self._often[action, count] = column, self.program.open_row((column, action), 1 - count)
        return self._often[action, count][0]

    def held(self, counts: Counts, x: Sequence[float]) -> tuple[int, int, int] | None:
        """Give an action that is executed as often as its column does not say, how often, and the column."""
        for (action, count), (column, _) in self._often.items():
            if action in counts and counts[action] >= count and not round(x[column]):
                return action, count, column
        return None

    def _with_stock(self, o: int, row: dict[int, int], least: int) -> tuple[dict[int, int], int]:
        if o in self.stock:
            return {**row, self.stock[o]: 1}, least
        return row, least - self._flows.start.get(o, 0)

    def _add_classes(self, measure: Measure) -> None:
        columns = []
        for number in sorted(set(measure.classes) - {-1}):
            members = [a for a, each in enumerate(measure.classes) if each == number]
            column = self.program.column(0, None)
            self.program.row({column: 1, **dict.fromkeys(members, -1)}, 0)
            self.program.row({column: -1, **dict.fromkeys(members, 1)}, 0)
            columns.append(column)
        self._classes[id(measure)] = columns

    def class_columns(self, measure: Measure) -> list[int]:
        """Return the columns that count the executions of each class."""
        return self._classes[id(measure)]

    def add_landmark(self, landmark: Landmark) -> None:
        """Add what a landmark says, unless what is there at first is not counted here and may fulfil it."""
        members, stock, action, _ = landmark
        if not self.stock.keys() >= set(stock):
            return
        row = {self._size + member: 1 for member in members} | {self.stock[o]: 1 for o in stock}
        if action is None:
            number = self.program.row(row, 1)
        else:
            number = self.program.row({**row, self._size + action: -1}, 0)
        self.conditions[number] = landmark

    def tighten(self) -> None:
        """Tie each indicator to its action by the greatest count that it can have."""
        program = self.program
        for action, row in enumerate(self._loose):
            most = self._most(action)
            program.change(row, {} if most is None else {self._size + action: most, action: -1})
        for (action, count), (column, row) in self._often.items():
            most = self._most(action)
            program.change(row, {} if most is None else {column: most - count + 1, action: -1})

    def _most(self, action: int) -> int | None:
        most = self.program.upper[action]
        return self._many if most is None and self._far else most

    def cap(self, measure: Measure, most: int) -> None:
        """Bound counts of actions by what all of them may cost together."""
        for action, cost in enumerate(measure.costs):
            if cost:
                self.program.cap(action, max(most, 0) // cost)
        self.tighten()

    def objective(self, measure: Measure) -> dict[int, int]:
        """Return what each column costs."""
        costs = {a: cost for a, cost in enumerate(measure.costs) if cost}
        if measure.item:
            costs |= dict.fromkeys((*self.items.values(), *self.stock.values()), measure.item)
        return costs

    def limit(self, level: Level) -> None:
        """Require that counts are as good by a level as the plan in hand."""
        costs = self.objective(level.measure)
        row = self.program.row({column: -cost for column, cost in costs.items()}, -level.most)
        self.conditions[row] = level
        self.cap(level.measure, level.most)

    def keep(self, measure: Measure, found: Sequence[float]) -> None:
        """Require that counts cost no more than those found."""
        costs = self.objective(measure)
        most = sum(cost * round(found[column]) for column, cost in costs.items())
        self.program.row({column: -cost for column, cost in costs.items()}, -most)


def _exact(level: Level, counts: Mapping[int, int]) -> Fraction:
    assert level.measure.exact is not None
    return level.measure.exact(counts)


def _around(program: WholeProgram, x: Sequence[float], columns: Sequence[int]) -> Iterator[_Bounds]:
    """Return all that differs from what was found in one of the columns, which are whole, in parts."""
    lower, upper = list(program.lower), list(program.upper)
    for column in sorted(columns, key=lambda column: -x[column]):
        found = round(x[column])
        if lower[column] < found:
            less = list(upper)
            less[column] = found - 1
            yield list(lower), less
        most = upper[column]
        if most is None or most > found:
            more = list(lower)
            more[column] = found + 1
            yield more, list(upper)
        lower[column] = upper[column] = found
