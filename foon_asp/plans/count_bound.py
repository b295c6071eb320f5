"""Operator counting with the state equation: lower bounds on the cost of plans that consume objects.

The counts of executions in a plan satisfy linear conditions (operator counting, Pommerening et al. 2014). No
more copies of an object are consumed than exist, and the copies of targets remain. If an action is executed,
each of its preconditions is initial or has an executed achiever. Landmarks of the delete relaxation hold as
well.

HiGHS solves the relaxations in floats. Bounds are recomputed in whole numbers, so that no float decides.
"""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from heapq import heappop, heappush

from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.plans.conditions import Counts, Landmark, Level, Measure, Remainder, Rounded, SumLimit, Supply
from foon_asp.plans.count_model import CountModel
from foon_asp.plans.flows import Flows
from foon_asp.plans.state_equation import StateEquation
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import INTEGRALITY, Bounds, Solved, Stopped, WholeProgram, most_fractional


class BetterError(Exception):
    """Raised if a plan better than the incumbent is found, or any plan where there is no incumbent.

    ``counts``: its counts of executions; empty if clingo found it.
    """

    def __init__(self, counts: Counts) -> None:
        """Keep the counts of the better plan."""
        super().__init__("a better plan was found")
        self.counts = counts


class CountBound:
    """Branch and bound over the counts of executions in plans for one question.

    *Columns* are those of a linear program. An *indicator* of an action is a column that is 1 if the action
    is executed at all, and else 0. Landmarks, supplies, remainders and rounded rows that a solution violates
    are added to the known conditions, and kept for later programs.

    ``flows``: the preconditions and effects of actions.
    ``required``: disjunctive action landmarks.
    ``limits``: limits on weighted sums, with weights from 0.
    ``derivation``: actions that reach the targets in the delete relaxation; landmarks are grown around them.
    ``levels``: plans that are worse than the incumbent by any level are excluded.
    ``excluded_counts``: a plan is excluded if it executes all actions at least as often as one entry says.
    ``expired``: a function that returns whether time is up; the methods then raise :class:`Stopped`.
    ``proved``: a lower bound on the cost of every plan by the first level; the methods increase it.
    """

    def __init__(
        self,
        flows: Flows,
        required: Sequence[Sequence[int]] = (),
        limits: Sequence[SumLimit] = (),
        derivation: Sequence[int] = (),
        levels: Sequence[Level] = (),
        excluded_counts: Sequence[Counts] = (),
        expired: Callable[[], bool] = lambda: False,
    ) -> None:
        """Keep the conditions; nothing is solved yet."""
        self._flows, self._limits, self._expired = flows, limits, expired
        self._action_count = len(flows.asks)
        self._levels, self._excluded_counts = tuple(levels), tuple(excluded_counts)
        self.derivation = derivation
        self._random = random.Random(0)
        self.proved: float | Fraction = 0  # lower bound on every plan by the first level
        self._landmarks = [Landmark(tuple(units)) for units in required]
        self._achievers = flows.achievers
        self._rounded_rows: list[tuple[Rounded, dict[int, int], int]] = []
        self._copies: list[Supply | Remainder] = []

    def cheapest_counts_by_equation(self, measures: Sequence[Measure]) -> Counts | None:
        """Return counts of least cost, as far as floats tell, the first measure most important.

        The counts are of a plan of the delete relaxation. The state equation finds them much faster than
        :meth:`cheapest_counts`, since few actions have indicators. Return ``None`` if no counts are found. If
        items have costs or counts are excluded, return ``None`` without a search. The rounded rows found for
        the first measure replace those known so far.
        """
        if self._excluded_counts or any(measure.item for measure in measures):
            return None
        assumed_cost: int | None = None
        while True:
            equation = self._state_equation(caps=self._assumed_caps(measures[0], assumed_cost))
            x: list[float] = []
            for number, measure in enumerate(measures):
                solution = equation.optimum(measure.costs)
                if solution is None:
                    return None
                x = solution
                total = sum(cost * round(x[a]) for a, cost in enumerate(measure.costs))
                if not number:
                    self._rounded_rows = list(equation.rounded_rows)
                    assumed_cost = 2 * total
                equation.add_level(Level(measure, Fraction(total), total))
            if not self._add_violated(x, equation):
                return {a: round(n) for a, n in enumerate(x[: self._action_count]) if round(n)}
            self._stop_if_expired()

    def _assumed_caps(self, measure: Measure, assumed_cost: int | None) -> Sequence[int | None]:
        """Return upper bounds on the counts of actions in plans that cost at most ``assumed_cost``.

        The bound of an action without cost is ``first_executions`` for each copy wanted. If no cost is
        assumed, return an empty list.
        """
        if assumed_cost is None:
            return ()
        cap_without_cost = PLANS.first_executions * max(self._flows.targets.values(), default=1)
        return [assumed_cost // cost if cost else cap_without_cost for cost in measure.costs]

    def _state_equation(self, levels: Sequence[Level] = (), caps: Sequence[int | None] = ()) -> StateEquation:
        """Return a new state equation with all known conditions, ``caps`` on counts and ``levels``."""
        equation = StateEquation(self._flows, self._limits, caps, self._expired)
        for condition, row, least in self._rounded_rows:
            equation.add((condition,), row, least)
        for level in (*self._levels, *levels):
            equation.add_level(level)
        for landmark in self._landmarks:
            equation.add_landmark(landmark)
        for copies in self._copies:
            equation.add_copies(copies)
        return equation

    def _add_violated(self, x: Sequence[float], equation: StateEquation) -> bool:
        """Add a condition that a solution violates and the equation lacks; return whether there is one.

        It is a landmark, a supply or a remainder.
        """
        used = {a for a in range(self._action_count) if x[a] > INTEGRALITY}
        landmark = self._violated_landmark(used, set(), {})
        if landmark is not None and landmark not in self._landmarks:
            self._landmarks.append(landmark)
            equation.add_landmark(landmark)
            return True
        conditions: list[Supply | Remainder] = [*self._flows.supplies, *self._flows.remainders]
        for condition in conditions:
            if condition.action in used and condition not in self._copies:
                copies = sum(n * x[a] for a, n in self._flows.copy_changes(condition).items())
                if copies + self._flows.start.get(condition.object, 0) < condition.copies - INTEGRALITY:
                    self._copies.append(condition)
                    equation.add_copies(condition)
                    return True
        return False

    def cheapest_counts(self, measures: Sequence[Measure], rounds: int = 30) -> Counts | None:
        """Return counts of least cost, as far as floats tell, the first measure most important.

        Return ``None`` if HiGHS finds no counts. The counts are of a plan of the delete relaxation. There may
        be no plan with these counts, and their optimality is not proved. The search is repeated up to
        ``rounds`` times, each time with a further landmark that the last counts violate. Each count is at
        most ``first_executions`` for each copy wanted. If a count is that large, ``last_executions`` is
        tried.
        """
        counts = None
        most_copies_wanted = max(self._flows.targets.values(), default=1)
        for assumed_cap in (
            PLANS.first_executions * most_copies_wanted,
            PLANS.last_executions * most_copies_wanted,
        ):
            counts = self._cheapest_counts_up_to(measures, rounds, assumed_cap)
            if counts is not None and max(counts.values(), default=0) < assumed_cap:
                break
        return counts

    def _cheapest_counts_up_to(
        self, measures: Sequence[Measure], rounds: int, assumed_cap: int
    ) -> Counts | None:
        """Return counts of least cost like :meth:`cheapest_counts`, with no count above an assumed cap.

        After the last round, the counts may still violate a landmark. Return ``None`` if HiGHS finds no
        counts.
        """
        counts: Counts | None = None
        for _ in range(rounds):
            model = self._new_model(measures, assumed_cap)
            x: list[float] = []
            for measure in measures:
                relaxed = self._solve_relaxed(model, model.objective(measure))
                solution = relaxed or model.program.whole_optimum(model.objective(measure))
                if solution is None:
                    return None
                x = solution
                for a in range(self._action_count):  # floats may leave indicators of large counts near 0
                    x[self._action_count + a] = float(x[a] > 0.5)
                model.limit_cost(measure, x)
                self._stop_if_expired()
            counts = {a: round(x[a]) for a in range(self._action_count) if x[a] > 0.5}
            if not self._add_landmark(x, model):
                break
        return counts

    def _solve_relaxed(self, model: CountModel, objective: Mapping[int, int]) -> list[float] | None:
        """Add violated landmarks to the relaxation; return its solution if that is whole, else ``None``.

        If no counts are excluded, indicators need not be whole.
        """
        while True:
            self._stop_if_expired()
            x = model.program.solve(objective).x
            if x is None or not self._separate(x, model, at_root=True):
                break
        columns = {*range(model.program.column_count)}
        if not self._excluded_counts:
            columns.difference_update(range(self._action_count, 2 * self._action_count))
        if x is None or any(abs(x[column] - round(x[column])) > INTEGRALITY for column in columns):
            return None
        return x

    def is_infeasible(self) -> bool:
        """Return whether the relaxation proves that no counts satisfy all conditions: no plan exists."""
        model = self._new_model(())
        while True:
            solved = model.program.solve({})
            if solved.x is None:
                return solved.bound == math.inf
            if not self._add_landmark(solved.x, model):
                return False
            self._stop_if_expired()

    def max_executions(self) -> int | None:
        """Return an upper bound on the number of executions in a plan; ``None`` if no bound is proved."""
        program = self._new_model(()).program
        bound = program.solve(dict.fromkeys(range(self._action_count), -1)).bound
        return None if abs(bound) == math.inf else math.floor(-bound)

    def max_counts(self, level: Level) -> list[int | None]:
        """Return an upper bound on the count of each action in all plans that satisfy a level.

        The entry of an action without a bound is ``None``.
        """
        model = self._new_model((level.measure,))
        model.add_level(level)
        caps: list[int | None] = []
        for action in range(self._action_count):
            self._stop_if_expired()
            solved = model.program.solve({action: -1})
            caps.append(None if solved.bound == -math.inf else math.floor(-solved.bound))
            model.program.upper[action] = caps[-1]
            model.tighten()
        return caps

    def prove(self, levels: Sequence[Level], is_better: Callable[[Counts], bool]) -> None:
        """Prove that no plan is better than the incumbent, the first level most important.

        ``is_better`` is called with counts that a better plan might have. It returns whether some order of
        them is a better plan. Raises :class:`BetterError` if it returns true, and :class:`Stopped` if time is
        up.
        """
        for i, level in enumerate(levels):
            earlier_levels, is_rounded = levels[:i], level.measure.exact is not None
            step = math.gcd(*level.measure.costs, level.measure.item) or 1
            max_cost = level.max_cost if is_rounded else (math.ceil(level.cost) - 1) // step * step
            self._search_counts(
                level.measure,
                max_cost,
                is_better,
                earlier_levels,
                [*earlier_levels, level._replace(strict=True)],
            )

    def visit_counts(self, levels: Sequence[Level], visit: Callable[[Counts], None]) -> None:
        """Call ``visit`` with all counts that plans as good as the incumbent by each level can have.

        Costs of the last level have to be whole. Raises :class:`Stopped` if time is up.
        """
        *earlier_levels, last_level = levels
        self._search_counts(last_level.measure, last_level.max_cost, visit, earlier_levels, earlier_levels)

    def prove_infeasible(self, measure: Measure, is_better: Callable[[Counts], bool]) -> None:
        """Prove that there is no plan at all; counts of low cost by ``measure`` are tried first.

        ``is_better`` is called with counts, and returns whether some order of them is a plan. Raises
        :class:`BetterError` if it returns true, and :class:`Stopped` if nothing is proved. ``proved`` does
        not change.
        """
        proved = self.proved
        try:
            self._search_counts(measure, self.max_executions(), is_better)
        finally:
            self.proved = proved  # costs by ``measure`` are no bound on the first level

    def _search_counts(
        self,
        measure: Measure,
        max_cost: int | None,
        is_better: Callable[[Counts], bool | None],
        earlier_levels: Sequence[Level] = (),
        levels: Sequence[Level] = (),
    ) -> None:
        """Call ``is_better`` with all counts of cost up to ``max_cost``, by branch and bound.

        If ``max_cost`` is ``None``, the cost has no limit. Counts are omitted if they are worse than the
        incumbent by the rounded costs of a level in ``earlier_levels``. They are also omitted if they are
        worse by the exact costs of a level in ``levels``. Without ``earlier_levels``, ``proved`` is
        increased. Raises :class:`BetterError` if ``is_better`` returns true, and :class:`Stopped` after too
        many nodes.
        """
        if (
            max_cost is not None
            and not measure.item
            and self._equation_exceeds(measure, max_cost, earlier_levels)
        ):
            return
        model = self._new_model([measure, *(level.measure for level in earlier_levels)])
        for level in earlier_levels:
            model.add_level(level)
        objective = model.objective(measure)
        if max_cost is not None:
            model.cap_counts(measure, max_cost)
            self._probe_actions(model, objective, max_cost)
        cutoff = math.inf if max_cost is None else max_cost
        lower, upper = list(model.program.lower), list(model.program.upper)
        number = 0
        waiting: list[tuple[float | Fraction, int, int, Bounds]] = [(0, sum(lower), number, (lower, upper))]
        while waiting:
            bound, _, _, (model.program.lower, model.program.upper) = heappop(waiting)
            if not earlier_levels:
                self.proved = max(self.proved, bound)
            solved = self._solve_node(model, objective, cutoff)
            if solved.x is None:
                continue
            for lower, upper in self._child_bounds(model, solved.x, levels, is_better):
                number += 1
                executions = sum(lower[: self._action_count])
                heappush(waiting, (max(bound, solved.bound), executions, -number, (lower, upper)))
            if number > (PLANS.uncapped_nodes if max_cost is None else PLANS.nodes):
                raise Stopped

    def _equation_exceeds(self, measure: Measure, max_cost: int, earlier_levels: Sequence[Level]) -> bool:
        """Return whether the state equation proves that plans cost more than ``max_cost`` by a measure.

        Plans that are worse than the incumbent by a level in ``earlier_levels`` are not considered. The
        search branches over counts, adds violated conditions, and gives up after ``equation_nodes`` nodes.
        Without ``earlier_levels``, the first node increases ``proved``, and its rounded rows replace those
        known so far.
        """
        costs = {a: cost for a, cost in enumerate(measure.costs) if cost}
        caps = [max(max_cost, 0) // cost if cost else None for cost in measure.costs]
        equation = self._state_equation(earlier_levels, caps)
        program = equation.program
        waiting = [(list(program.lower), list(program.upper))]
        for number in range(PLANS.equation_nodes):
            if not waiting:
                return True
            program.set_bounds(waiting.pop())
            solved = self._solve_equation_node(equation, costs, max_cost)
            if not earlier_levels and not number:
                self._rounded_rows = list(equation.rounded_rows)
                self.proved = max(self.proved, min(solved.bound, max_cost + 1))
            if solved.bound > max_cost:
                continue
            column = None if solved.x is None else most_fractional(solved.x[: self._action_count])
            if column is None or solved.x is None:
                return False
            waiting += program.split_bounds(column, solved.x[column])
        return False

    def _solve_equation_node(
        self, equation: StateEquation, costs: Mapping[int, int], max_cost: int
    ) -> Solved:
        """Add rounded rows and violated conditions to the state equation; return its last solution.

        This ends when nothing is violated, no solution is found, or the bound exceeds ``max_cost``.
        """
        while True:
            self._stop_if_expired()
            solved = equation.strengthen(costs, max_cost)
            if solved.bound > max_cost or solved.x is None or not self._add_violated(solved.x, equation):
                return solved

    def _solve_node(self, model: CountModel, objective: Mapping[int, int], cutoff: float) -> Solved:
        """Add violated landmarks at a node; return its relaxed solution.

        If the node is infeasible or its bound is above ``cutoff``, ``x`` of the result is ``None``. Raises
        :class:`Stopped` if the node is infeasible in floats, but not provably so.
        """
        while True:
            self._stop_if_expired()
            model.tighten()
            solved = model.program.solve(objective, cutoff)
            if solved.bound > cutoff or solved.bound == math.inf:
                return solved._replace(x=None)
            if solved.x is None:
                raise Stopped  # infeasible in floats, but not provably so
            if not self._add_landmark(solved.x, model) and not self._separate(solved.x, model, at_root=False):
                return solved

    def _new_model(self, measures: Sequence[Measure], assumed_cap: int | None = None) -> CountModel:
        """Return a new relaxation with all known conditions; ``assumed_cap`` is as in :class:`CountModel`."""
        all_measures = (*measures, *(level.measure for level in self._levels))
        different = {id(measure): measure for measure in all_measures}
        model = CountModel(
            self._flows,
            list(different.values()),
            self._landmarks,
            self._limits,
            self._excluded_counts,
            assumed_cap,
            self._expired,
        )
        for level in self._levels:
            model.add_level(level)
        for condition, row, least in self._rounded_rows:
            model.conditions[model.program.add_row(row, least)] = condition
        return model

    def _probe_actions(self, model: CountModel, objective: Mapping[int, int], cutoff: int) -> None:
        """Find actions that cannot be executed twice at costs up to ``cutoff``, and bound their counts by 1.

        At most ``probes`` actions are tried, and only those whose indicators are below 1 and below their
        counts in the relaxed solution. Violated landmarks are added first.
        """
        program, probed = model.program, set[int]()
        while len(probed) < PLANS.probes:
            self._stop_if_expired()
            solved = program.solve(objective, cutoff)
            if solved.x is None or solved.bound > cutoff:
                return
            if self._add_landmark(solved.x, model) or self._separate(solved.x, model, at_root=True):
                continue
            loose = [
                a
                for a in range(self._action_count)
                if solved.x[self._action_count + a] < min(1.0, solved.x[a]) - INTEGRALITY and a not in probed
            ]
            if not loose:
                return
            for action in loose[: PLANS.probes - len(probed)]:
                probed.add(action)
                self._stop_if_expired()
                lower = program.lower[action]
                program.lower[action] = 2
                if program.solve(objective, cutoff).bound > cutoff:
                    program.upper[action] = 1
                program.lower[action] = lower
            model.tighten()

    def _child_bounds(
        self,
        model: CountModel,
        x: Sequence[float],
        levels: Sequence[Level],
        is_better: Callable[[Counts], bool | None],
    ) -> Iterator[Bounds]:
        """Yield the bounds of the child nodes of a node with the relaxed solution ``x``.

        If ``x`` has whole counts that violate nothing, ``is_better`` is called with them first. The children
        then exclude only these counts. Raises :class:`BetterError` if ``is_better`` returns true. ``levels``
        are as for :meth:`_search_counts`.
        """
        program = model.program
        column = most_fractional(x)
        if column is not None:
            yield from program.split_bounds(column, x[column])
            return
        counts = {a: round(x[a]) for a in range(self._action_count) if round(x[a])}
        unforced_action = next((a for a in counts if not round(x[self._action_count + a])), None)
        if unforced_action is not None:  # unbounded, so that its indicator is not forced
            yield program.with_bounds(unforced_action, None, 0)
            lower, upper = program.with_bounds(unforced_action, 1, None)
            lower[self._action_count + unforced_action] = 1
            yield lower, upper
            return
        rounded_levels = [level for level in (*self._levels, *levels) if level.measure.exact is not None]
        violated_levels = [
            level
            for level in rounded_levels
            if (cost := _exact_cost(level, counts)) > level.cost or (cost == level.cost and level.strict)
        ]
        unforced = model.unforced_count(counts, x)
        if unforced is not None:  # its action is unbounded, so that the indicator is not forced
            action, count, column = unforced
            yield program.with_bounds(action, None, count - 1)
            lower, upper = program.with_bounds(action, count, None)
            lower[column] = 1
            yield lower, upper
            return
        if violated_levels:
            yield from _bounds_around(program, x, model.class_columns(violated_levels[0].measure))
            return
        if is_better(counts):
            raise BetterError(counts)
        yield from _bounds_around(program, x, range(self._action_count))

    def _add_landmark(self, x: Sequence[float], model: CountModel) -> bool:
        """Add a landmark that the solution ``x`` of the model violates; return whether there is one."""
        used = {a for a in range(self._action_count) if x[self._action_count + a] > INTEGRALITY}
        reached = {o for o, column in model.stock.items() if x[column] > INTEGRALITY}
        landmark = self._violated_landmark(used, reached, model.stock)
        if landmark is not None:
            self._landmarks.append(landmark)
            model.add_landmark(landmark)
        return landmark is not None

    def _violated_landmark(
        self, used: set[int], initial: set[int], stock: Mapping[int, int]
    ) -> Landmark | None:
        """Return a landmark that the executed actions ``used`` violate; ``None`` if they violate no landmark.

        The executed actions are applied to the initial objects in the delete relaxation. If a target or an
        executed action is not reached, some action that was not executed has to lead to it. The landmark is
        the set of such actions. If initial copies have a cost, ``stock`` has their columns, and ``initial``
        the objects of which copies are taken. Otherwise, both are empty.
        """
        flows = self._flows
        asks, targets = flows.lacking(bool(stock))
        reached, waiting = set(initial), set(used)
        grown = True
        while grown:
            ready = [a for a in waiting if reached.issuperset(asks[a])]
            grown = bool(ready)
            waiting.difference_update(ready)
            reached.update(o for a in ready for o in flows.adds[a])
        unreached: list[tuple[int, int | None]]
        unreached = [(target, None) for target in targets if target not in reached]
        unreached += [(next(o for o in asks[a] if o not in reached), a) for a in sorted(waiting)]
        for o, action in unreached[:1]:
            return self._grow_landmark(o, asks, reached, used, stock)._replace(action=action)
        return None

    @cached_property
    def _cutter(self) -> Cutter:
        """The :class:`Cutter` for the targets in the delete relaxation, where initial copies cost nothing."""
        flows = self._flows
        asks, targets = flows.lacking(priced=False)
        objects = {o for numbers in (*asks, *flows.adds, targets) for o in numbers}
        return Cutter(
            Hypergraph(max(objects, default=0) + 1, asks, list(map(tuple, flows.adds)), ()), targets
        )

    @cached_property
    def _cutter_of_stock(self) -> Cutter:
        """The :class:`Cutter` for the targets in the delete relaxation, where initial copies have a cost.

        Its cuts have no initial object.
        """
        flows = self._flows
        asks, targets = flows.lacking(priced=True)
        start = [o for o, count in flows.start.items() if count]
        objects = {o for numbers in (*asks, *flows.adds, targets, start) for o in numbers}
        adds = list(map(tuple, flows.adds))
        return Cutter(Hypergraph(max(objects, default=0) + 1, asks, adds, start), targets)

    def _separate(self, x: Sequence[float], model: CountModel, at_root: bool) -> bool:
        """Add landmarks of the targets that an LP solution violates; return whether there are any.

        Landmarks avoid actions whose indicators have large values in the solution. At the root, landmarks are
        also tried that contain at most one action of the derivation. Without a derivation, or if no actions
        reach the targets, no landmarks are sought.
        """
        derivation, action_count = self.derivation, self._action_count
        if not derivation:
            return False
        cutter = self._cutter_of_stock if model.stock else self._cutter
        if cutter.hopeless or not cutter.targets:
            return False
        cuts: dict[tuple[int, ...], tuple[int, ...]] = {}
        kept_sets = [[a for a in derivation if a != gone] for gone in derivation]
        for number in range(PLANS.landmark_orders):
            order = sorted(cutter.actions, key=lambda a: (-x[action_count + a], self._random.random()))
            for keep in ((), *(kept_sets if at_root and number == 0 else ())):
                cut = cutter.cut(keep, order)
                if cut is not None and sum(x[action_count + a] for a in cut.members) < 1 - INTEGRALITY:
                    cuts.setdefault(cut.members, cut.objects)
            if cuts:
                break
        for members in sorted(cuts):
            self._landmarks.append(Landmark(members, objects=cuts[members]))
            model.add_landmark(self._landmarks[-1])
        return bool(cuts)

    def _grow_landmark(
        self,
        o: int,
        asks: Sequence[Sequence[int]],
        reached: set[int],
        used: set[int],
        stock: Mapping[int, int],
    ) -> Landmark:
        """Return a landmark that no executed action satisfies, for an object ``o`` that is not reached.

        Its cut is a set of objects, at first only ``o``. As long as an executed action (``used``) would
        satisfy the landmark, a missing precondition of the action is added to the cut. ``asks`` has the
        preconditions of actions, ``reached`` the objects reached, and ``stock`` the columns of initial
        copies.
        """
        cut, stack, crossing = {o}, [o], dict[int, None]()
        while stack:
            for achiever in self._achievers.get(stack.pop(), ()):
                crossing[achiever] = None
                if achiever in used and cut.isdisjoint(asks[achiever]):
                    lacking = next(needed for needed in asks[achiever] if needed not in reached)
                    cut.add(lacking)
                    stack.append(lacking)
        members = tuple(achiever for achiever in crossing if cut.isdisjoint(asks[achiever]))
        return Landmark(members, tuple(sorted(cut & stock.keys())), objects=tuple(sorted(cut)))

    def _stop_if_expired(self) -> None:
        """Raise :class:`Stopped` if time is up."""
        if self._expired():
            raise Stopped


def _exact_cost(level: Level, counts: Mapping[int, int]) -> Fraction:
    """Return the exact cost of counts by a level whose costs are rounded."""
    assert level.measure.exact is not None
    return level.measure.exact(counts)


def _bounds_around(program: WholeProgram, x: Sequence[float], columns: Sequence[int]) -> Iterator[Bounds]:
    """Yield the bounds of child nodes that together exclude only the values of ``columns`` in ``x``.

    ``x`` is a whole solution. All other whole values of the columns within the bounds of the program are
    allowed.
    """
    lower, upper = list(program.lower), list(program.upper)
    for column in sorted(columns, key=lambda column: -x[column]):
        value = round(x[column])
        if lower[column] < value:
            lowered = list(upper)
            lowered[column] = value - 1
            yield list(lower), lowered
        cap = upper[column]
        if cap is None or cap > value:
            raised = list(lower)
            raised[column] = value + 1
            yield raised, list(upper)
        lower[column] = upper[column] = value
