"""Optimal plans with consumable items: integer counts of executions, their order, and the outcome."""

import math
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from graphlib import TopologicalSorter
from pathlib import Path

from foon_asp.asp.assembly import assemble
from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.program import Program
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.asp.solver import NOT_ASKED
from foon_asp.asp.solver import solve as solve_lasting
from foon_asp.bounds.counts import BetterError, CountBound, Counts, Flows, Level, Measure
from foon_asp.bounds.whole_program import Stopped
from foon_asp.encoding.exact_success import RateScale, rate_scale
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError, UserError
from foon_asp.grounding.run import Run
from foon_asp.problem import (
    Costs,
    Objective,
    Problem,
    Restriction,
    first_tree,
    levels,
    multiplies,
    reach,
    relevant_to_plans,
)
from foon_asp.proof.replay import replay_for
from foon_asp.rules.dependence import TIMES
from foon_asp.rules.limit import Limit

Plan = tuple[int, ...]
"""Units by id in the order of execution, with repeats."""

_MAX_EXACT_COST = 10**12  # largest cost that is counted unrounded
_COST_STEPS = 10**6  # steps of the greatest cost, where costs are rounded
# Ready-made constraints about order, or that count units and not executions, and predicates about order.
_NOT_BUILT = ("before", "require_intermediate")
_NOT_READ = frozenset({"available", "executes", "taken", "makes"})
_MAX_UNORDERED = 10  # counts without an order, after which clingo searches all remaining ones at once
_MAX_EXECUTIONS = 500  # executions in one such search
_MAX_EXTRA_COPIES = 4  # executions of a unit beyond its count in the search for a first plan


def solve_used_up(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
) -> Outcome:
    """Find the best plan under a lexicographic list of objectives, and prove it.

    Raises :class:`UserError` naming a feature that is not built for items that are used up.
    """
    solver = _solver(problem, tuple(objectives), settings or Settings(), reporter or Reporter())
    outcome = solver.solve()
    if solver.settings.asks_for_statistics and not solver.searched:
        solver.reporter.statistics(NOT_ASKED)
    return outcome


def _solver(
    problem: Problem, objectives: tuple[Objective, ...], settings: Settings, reporter: Reporter
) -> "_Solver":
    require_built_for_plans(settings)
    by_levels = levels(objectives)
    problem.require_known_for(by_levels)
    return _Solver(problem, objectives, by_levels, settings, reporter)


def most_executions(
    problem: Problem, objectives: Sequence[Objective], settings: Settings
) -> dict[int, tuple[int, int]]:
    """Return the least and greatest number of executions in any best plan, by unit that can matter.

    Where no plan exists, every unit has at most one execution. Raises
    :class:`UserError` where neither is proved.
    """
    solver = _solver(problem, tuple(objectives), settings, Reporter())
    outcome = solver.solve()
    if outcome.status is Status.INFEASIBLE:
        return dict.fromkeys(range(len(problem.network)), (0, 1))
    if outcome.status is not Status.OPTIMAL or outcome.costs is None:
        raise UserError("no plan is proved the best, so nothing bounds how often units are executed")
    units = solver._cut() or []
    counting = _Counting(solver, units)
    caps = counting.bound.caps(counting.level(Objective.UNITS, outcome.costs))
    return {u: (0, outcome.costs.units if cap is None else cap) for u, cap in zip(units, caps, strict=True)}


def executions_as_good(outcome: Outcome, settings: Settings) -> dict[int, int] | None:
    """Return the most executions of each unit in plans as good as an outcome by its first objective.

    ``None`` where some unit has no bound.
    """
    solver = _solver(outcome.problem, outcome.objectives, settings, Reporter())
    if outcome.costs is None or not solver._apply_rules():
        return None
    units = solver._cut() or []
    counting = _Counting(solver, units)
    caps = counting.bound.caps(counting.level(solver.levels[0], outcome.costs)) if units else []
    caps_by_unit = {unit: cap for unit, cap in zip(units, caps, strict=True) if cap is not None}
    return caps_by_unit if len(caps_by_unit) == len(units) else None


def best_plans(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    reporter: Reporter,
    max_plans: int,
) -> tuple[list[tuple[Plan, Costs]], bool, bool]:
    """Return at most ``max_plans`` best plans with different counts of executions, each with its costs.

    Also returns whether the first is proved optimal, and whether there are no others.
    """
    solver = _solver(problem, tuple(objectives), settings, reporter)
    outcome = solver.solve()
    if outcome.units is None or outcome.costs is None or outcome.status is not Status.OPTIMAL:
        incumbents = (
            [] if outcome.units is None or outcome.costs is None else [(outcome.units, outcome.costs)]
        )
        return incumbents, False, outcome.status is Status.INFEASIBLE
    units, best = solver._cut() or [], outcome.costs
    counting = _Counting(solver, units)
    counting.bound.derivation = [a for a, unit in enumerate(units) if unit in outcome.units]
    plans_by_counts = {frozenset(Counter(outcome.units).items()): outcome.units}

    def ask(counts: Counts) -> None:
        plan = counting.order(counts)
        if plan is not None and problem.costs(plan).key(solver.levels) == best.key(solver.levels):
            plans_by_counts.setdefault(frozenset(Counter(plan).items()), plan)
            if len(plans_by_counts) > max_plans:
                raise Stopped

    complete = True
    try:
        if units:
            counting.bound.every([counting.level(objective, best) for objective in solver.levels], ask)
    except (Stopped, KeyboardInterrupt) as stop:
        complete = False
        if isinstance(stop, KeyboardInterrupt):
            solver.deadline.interrupt()
    return (
        [(plan, problem.costs(plan)) for plan in list(plans_by_counts.values())[:max_plans]],
        True,
        complete,
    )


def order_that_runs(problem: Problem, units: Sequence[int]) -> Plan | None:
    """Return units, repeats included, in an executable order; ``None`` where there is none."""
    solver = _solver(problem, (Objective.UNITS,), Settings(), Reporter())
    counted = Counter(units)
    return _Counting(solver, list(counted)).order(dict(enumerate(counted.values())))


def require_built_for_plans(settings: Settings) -> None:
    """Raise :class:`UserError` naming a feature that is not built for items that are used up."""
    for constraint in settings.constraints:
        name = Path(constraint.name.partition(":")[0]).stem
        if name in _NOT_BUILT:
            raise UserError(f"the constraint {name} is not built for items that are used up")
    for setting, feature in (
        (settings.encodings, "other encodings (--encodings)"),
        (settings.relaxed, "soft constraints"),
        (settings.bounded and settings.bounded.rules, "bounds on objectives by rules"),
    ):
        if setting:
            raise UserError(f"{feature} are not built for items that are used up")


def require_rules_of_plans(program: Program) -> None:
    """Raise :class:`UserError` for user rules that read more than the executions of a plan."""
    for name, arity in sorted(program.looked_at):
        if name.lstrip("_") in _NOT_READ:
            raise UserError(f"rules over {name}/{arity} are not built for items that are used up")
    rules = program.understood
    if rules is not None and not rules.local:
        rule = next(rule for rule in rules.rules if not rule.local)
        raise UserError(
            f"{rule.source}: this rule looks at more than the units of a plan ({rule.further}), which is "
            "not built for items that are used up"
        )


def flows_of(problem: Problem, units: Sequence[int]) -> Flows:
    """Return the preconditions, consumption and add effects of units, by their index in ``units``.

    Object nodes that only other units need are excluded.
    """
    needed = {o for unit in units for o in problem.flows[unit].asks}.union(problem.goals)

    def finite(ids: Sequence[int]) -> list[int]:
        return [o for o in ids if o not in problem.endless and o in needed]

    flows = [problem.flows[unit] for unit in units]
    return Flows(
        [finite(flow.asks) for flow in flows],
        [finite(flow.uses) for flow in flows],
        [finite(flow.adds) for flow in flows],
        [[o for o in flow.asks if o in problem.endless] for flow in flows],
        {o: problem.stock_of(o) or 0 for o in needed & problem.kitchen - problem.endless},
        [goal for goal in problem.goals if goal not in problem.endless],
    )


class _ManyError(Exception):
    """Too many counts have no order: clingo has to search all of them at once."""


class _Solver:
    """Solver of one question."""

    def __init__(
        self,
        problem: Problem,
        objectives: tuple[Objective, ...],
        by_levels: tuple[Objective, ...],
        settings: Settings,
        reporter: Reporter,
    ) -> None:
        self.problem, self.objectives, self.levels = problem, objectives, by_levels
        self.settings, self.deadline, self.reporter = settings, settings.begun, reporter
        self.program = assemble(settings, reporter.warning, used_up=True, problem=problem)
        self.program.require_facts(problem, by_levels)
        require_rules_of_plans(self.program)
        self.removed: Callable[[int], bool] = lambda _: False
        self.required: tuple[frozenset[int], ...] = ()
        self.limits: Sequence[Limit] = ()
        bounded = settings.bounded or Bounded()
        self.below = [(objective, cost) for costs in bounded.below for objective, cost in costs.items()]
        self.incomparable = bounded.incomparable
        if not {objective for objective, _ in self.below} <= set(by_levels):
            raise BugError("a bound is on an objective that is not asked for")
        self.tree: frozenset[int] = frozenset()  # some tree that makes the goals if nothing is used up
        self.seconds: dict[str, float] = {}
        self.best: tuple[Plan, Costs] | None = None
        self.searched = False  # whether clingo ran, so that there are statistics
        self.bounds: dict[Objective, int | Fraction] = {}

    def solve(self) -> Outcome:
        try:
            with self.deadline.watched("cutting the network", late=True):
                return self._solve()
        except (Stopped, KeyboardInterrupt) as stop:
            if isinstance(stop, KeyboardInterrupt):
                self.deadline.interrupt()
            return self._outcome(Status.UNKNOWN if self.best is None else Status.FEASIBLE, None)

    def _solve(self) -> Outcome:
        began = time.perf_counter()
        if not self._apply_rules():
            return self._outcome(Status.INFEASIBLE, Proof.SOLVER)
        self.deadline.doing = "cutting the network"
        units = self._cut()
        self._spent("cut", began)
        return self._outcome(Status.INFEASIBLE, Proof.CUTS) if units is None else self._search(units)

    def _apply_rules(self) -> bool:
        """Apply rules that remove units, require sets or limit sums; return whether they allow a plan.

        Other rules about executions are left to the search, since their analysis assumes items that last,
        where every unit is executed once.
        """
        rules = self.program.understood
        if rules is None:
            return True
        self.limits = rules.limits(self.problem)
        restriction = rules.varying({TIMES}).applied(self.problem)
        if isinstance(restriction, Restriction):
            self.removed, self.required = restriction.removed, restriction.required
        return isinstance(restriction, Restriction)

    @property
    def _keeps_redundant(self) -> bool:
        """Whether a rule may require redundant units, which lead to no goal."""
        rules = self.program.understood
        return rules is not None and not (rules.shrinking and rules.only_limits)

    def _cut(self) -> list[int] | None:
        """Return the units that can matter, ascending; ``None`` if a goal is unreachable even if items last.

        These are the achievers of goals and of preconditions of each other; with rules that may require
        redundant units, all units that can execute.
        """
        problem = self.problem
        stocked = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        restriction = Restriction(self.removed, self.required)
        lasting = replace(problem, kitchen=stocked, restriction=restriction)
        reached = reach(lasting)
        if not all(reached.available[goal] for goal in problem.goals):
            return None
        if not all(required_set & set(reached.units) for required_set in self.required):
            return None
        self.tree = frozenset(first_tree(lasting, reached) or ())
        if self._keeps_redundant:
            return sorted(reached.units)
        return sorted(relevant_to_plans(problem, reached))

    def _search(self, units: list[int]) -> Outcome:
        counting = _Counting(self, units)
        if not units:  # every goal is available: only the empty plan is irredundant
            if not self.program.own and counting.order({}) is None:
                return self._outcome(Status.INFEASIBLE, Proof.SOLVER)
            return self._outcome(Status.OPTIMAL if self._take(()) else Status.INFEASIBLE, Proof.CUTS)
        began = time.perf_counter()
        with self.deadline.watched("counting executions"):
            counts = counting.bound.counts([counting.measure(objective) for objective in self.levels])
        self._spent("bound", began)
        plan = None
        if counts is not None:
            plan = counting.order(counts)
            if plan is None or not self._allows(plan):
                plan = counting.any_order(counts)
        elif counting.bound.none():
            return self._outcome(Status.INFEASIBLE, Proof.COUNTS)
        if plan is not None and self._take(plan):
            counting.bound.derivation = [a for a, unit in enumerate(units) if unit in plan]
            counting = self._below_cutoff(counting, plan)
        elif self._no_lasting_tree():
            return self._outcome(Status.INFEASIBLE, Proof.SOLVER)
        elif counting.none_is_left():
            return self._outcome(Status.INFEASIBLE, Proof.COUNTS)
        while True:
            try:
                began = time.perf_counter()
                with self.deadline.watched("counting executions"):
                    counting.prove()
                return self._outcome(Status.OPTIMAL, Proof.COUNTS)
            except BetterError:
                continue
            finally:
                self.bounds = counting.proved()
                self._spent("bound", began)

    def _below_cutoff(self, counting: "_Counting", plan: Plan) -> "_Counting":
        """Exclude units that alone cost more than a plan, where costs are too large to count unrounded."""
        objective = self.levels[0]
        if multiplies(objective) or counting.measure(objective).exact is None:
            return counting
        cutoff = self.problem.costs(plan).measure(objective)
        units = [unit for unit in counting.units if self.problem.figure(objective, unit) <= cutoff]
        if not units or len(units) == len(counting.units):
            return counting
        fewer = _Counting(self, units)
        fewer.bound.derivation = [a for a, unit in enumerate(units) if unit in plan]
        return fewer

    def _no_lasting_tree(self) -> bool:
        """Whether it is proved that rules allow no tree even if items last, and so no plan."""
        rules, problem = self.program.understood, self.problem
        if rules is None or not rules.only_limits:
            return False
        kitchen = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        lasting = replace(problem, kitchen=kitchen, items=None)
        settings = self.settings._replace(bounded=None)
        return solve_lasting(lasting, (Objective.UNITS,), settings).status is Status.INFEASIBLE

    def _take(self, plan: Plan) -> bool:
        """Make a plan the incumbent if it is allowed and better; return whether it is."""
        costs = self.problem.costs(plan)
        if not self._allows(plan):
            return False
        if self.best is not None and costs.key(self.levels) >= self.best[1].key(self.levels):
            return False
        self.best = plan, costs
        self.reporter.tree(costs)
        return True

    def _allows(self, plan: Plan) -> bool:
        """Whether a plan keeps exactly to limits and bounds, and contains none of the incomparable plans."""
        counts, costs = Counter(plan), self.problem.costs(plan)
        for limit in self.limits:
            total = sum(
                weight * (counts[u] > 0 if limit.used else counts[u]) for u, weight in limit.weights.items()
            )
            if (total < limit.bound) if limit.at_least else (total > limit.bound):
                return False
        better = all(costs.key([o]) < (-cost if multiplies(o) else cost,) for o, cost in self.below)
        return better and not any(counts >= Counter(other) for other in self.incomparable)

    def _outcome(self, status: Status, proof: Proof | None) -> Outcome:
        plan, costs = self.best or (None, None)
        if plan is not None and costs is not None:
            self._require_runs(plan, costs)
            if status is Status.OPTIMAL:
                self.bounds = {objective: costs.measure(objective) for objective in self.levels}
        return Outcome(
            self.problem,
            self.objectives,
            status,
            plan,
            costs,
            self.bounds if plan is not None else {},
            self.seconds,
            proof=proof,
            stopped=None if proof else self.deadline.stopped or "counts that have no order",
        )

    def _require_runs(self, plan: Plan, costs: Costs) -> None:
        """Require that a plan executes and has the stated costs, by an independent replay."""
        replay = replay_for(self.problem, self.problem.tree(plan))
        if replay.shortage is not None:
            raise BugError(f"the plan {list(plan)} lacks {replay.shortage.node}")
        if self.problem.costs(plan) != costs:
            raise BugError(f"the plan {list(plan)} does not cost {costs}")
        objects = self.problem.network.objects
        copies = {objects[o]: count for o, count in self.problem.copies_taken(plan).items()}
        if copies != replay.stock:
            raise BugError(f"the plan {list(plan)} takes {replay.stock} of the stock and not {copies}")

    def _spent(self, phase: str, began: float) -> None:
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - began


class _Counting:
    """Counts of executions of the units of a question, by index, and the search for their order."""

    def __init__(self, solver: _Solver, units: list[int]) -> None:
        self._solver, self._problem, self.units = solver, solver.problem, units
        self._measures: dict[Objective, Measure] = {}
        self._step = Fraction(1)  # step of the counted costs of the first objective
        self._orders_sought = -math.inf  # searches for an order since the proof began
        problem = solver.problem
        positions = {unit: a for a, unit in enumerate(units)}
        self.bound = CountBound(
            flows_of(problem, units),
            [[a for a, unit in enumerate(units) if unit in required_set] for required_set in solver.required],
            [
                Limit({a: limit.weights[u] for a, u in enumerate(units) if limit.weights.get(u)}, *limit[1:])
                for limit in solver.limits
            ],
            [a for a, unit in enumerate(units) if unit in solver.tree],
            [self._below(objective, cost) for objective, cost in solver.below],
            [
                {positions[u]: n for u, n in plan.items()}
                for plan in solver.incomparable
                if positions.keys() >= plan.keys()
            ],
            expired=lambda: solver.deadline.passed,
        )

    def measure(self, objective: Objective) -> Measure:
        """Return the measure of an objective over the units, cached."""
        if objective not in self._measures:
            self._measures[objective] = self._measured(objective)
        return self._measures[objective]

    def _measured(self, objective: Objective) -> Measure:
        row, figures = objective.row, self._figures(objective)
        if multiplies(objective):
            classes = _classes(figures, Fraction(1))

            def product(counts: Mapping[int, int]) -> Fraction:
                return -math.prod((figures[a] ** n for a, n in counts.items()), start=Fraction(1))

            return Measure([self._rates.weights[rate] for rate in figures], 0, product, classes)
        scale = self._scale(objective)
        costs = [math.floor(scale * figure) for figure in figures]
        if all(cost == scale * figure for cost, figure in zip(costs, figures, strict=True)):
            return Measure(costs, row.item)

        def total(counts: Mapping[int, int]) -> Fraction:
            return sum((figures[a] * n for a, n in counts.items()), start=Fraction(0))

        return Measure(costs, 0, total, _classes(figures, Fraction(0)))

    def _figures(self, objective: Objective) -> list[Fraction]:
        return [Fraction(self._problem.figure(objective, unit)) for unit in self.units]

    @cached_property
    def _rates(self) -> RateScale:
        try:
            return rate_scale(self._problem.different_rates(self.units))
        except ValueError:
            raise UserError(
                "a success rate is 0, for which plans with items that are used up cannot be compared"
            ) from None

    def _scale(self, objective: Objective) -> Fraction:
        """Return the factor by which costs are scaled: exact where costs stay small, else rounding."""
        figures = self._figures(objective)
        common = math.lcm(*(figure.denominator for figure in figures))
        greatest = max(figures, default=Fraction(0))
        return Fraction(common) if common * greatest <= _MAX_EXACT_COST else _COST_STEPS / greatest

    def level(self, objective: Objective, costs: Costs) -> Level:
        """Return the level of an objective with the cost of a plan."""
        return self._level(objective, Fraction(costs.measure(objective)))

    def _below(self, objective: Objective, cost: int | Fraction) -> Level:
        """Return the level of plans that cost less."""
        level = self._level(objective, Fraction(cost))
        if level.measure.exact is not None:
            return level._replace(strict=True)
        return level._replace(max_cost=math.ceil(level.cost) - 1)

    def _level(self, objective: Objective, cost: Fraction) -> Level:
        measure = self.measure(objective)
        if multiplies(objective):
            return Level(measure, -cost, self._rates.weigh(cost))
        scale = self._scale(objective)
        if measure.exact is not None:
            return Level(measure, cost, math.floor(scale * cost))
        return Level(measure, scale * cost, int(scale * cost))

    def prove(self) -> None:
        """Prove that no plan is better than the incumbent; raises :class:`BetterError` if one is."""
        assert self._solver.best is not None
        plan, costs = self._solver.best
        levels: list[Level] = []
        self._step = 1 / self._scale(self._solver.levels[0])
        for objective in self._solver.levels:
            split = self._split(objective, plan)
            if split is None:
                levels.append(self.level(objective, costs))
                continue
            if not levels:
                self._step = split[0]
            levels += split[1]
        self._orders_sought = 0
        try:
            self.bound.prove(levels, self._is_better)
        except _ManyError:
            if not self._best_within_caps(levels[0]):
                self._orders_sought = -math.inf
                self.bound.prove(levels, self._is_better)

    def _split(self, objective: Objective, plan: Plan) -> tuple[Fraction, list[Level]] | None:
        """Split costs too large to count unrounded into two levels: large ones in steps, and all others.

        Plans that differ in the large costs differ by a step at least. Where the small costs of the plan sum
        up to less, no plan that costs a step more is better. Returns the step and the levels; ``None`` where
        costs need no such levels, or cannot be split.
        """
        if multiplies(objective) or objective.row.item or self.measure(objective).exact is None:
            return None
        figures = self._figures(objective)
        common = math.lcm(*(figure.denominator for figure in figures))
        costs = [int(common * figure) for figure in figures]
        step = math.gcd(*(cost for cost in costs if cost > _MAX_EXACT_COST))
        counts = Counter(plan)
        executed = [counts[unit] for unit in self.units]
        levels = []
        for large in (True, False):
            of_level = [
                (cost // step if large else cost) * ((cost > _MAX_EXACT_COST) is large) for cost in costs
            ]
            total = sum(cost * n for cost, n in zip(of_level, executed, strict=True))
            if max(of_level) > _MAX_EXACT_COST or (not large and total >= step):
                return None
            levels.append(Level(Measure(of_level), Fraction(total), total))
        return Fraction(step, common), levels

    def none_is_left(self) -> bool:
        """Prove that no counts belong to a plan, where there are not too many; return whether it is proved.

        A plan found on the way becomes the incumbent. Raises :class:`Stopped` where nothing is proved.
        """
        try:
            self.bound.none_is_left(self.measure(Objective.UNITS), self._is_better)
        except BetterError:
            return False
        return True

    def proved(self) -> dict[Objective, int | Fraction]:
        """Return the proved lower bound of the first objective; empty where there is none or rates multiply.

        Costs are rounded down, so a bound on rounded costs is valid.
        """
        objective = self._solver.levels[0]
        if self.bound.proved <= 0 or multiplies(objective):
            return {}
        least = math.ceil(self.bound.proved) * self._step
        return {objective: int(least) if objective.row.whole else least}

    def _best_within_caps(self, level: Level) -> bool:
        """Prove with clingo that no plan is better, where all better plans have executions within caps.

        Returns whether it is proved. Raises :class:`BetterError` if a plan is better.
        """
        caps = [cap for cap in self.bound.caps(level) if cap is not None]
        if len(caps) < len(self.units) or sum(caps) > _MAX_EXECUTIONS:
            return False
        if not all(objective.row.whole for objective in self._solver.levels):
            return False
        ended = self._ended({a: (0, cap) for a, cap in enumerate(caps)}, True)
        if ended.units is not None and self._solver._take(self._sequence(ended)):
            raise BetterError({})
        return ended.exhausted and ended.units is not None

    def _is_better(self, counts: Counts) -> bool:
        self._orders_sought += 1
        if self._orders_sought > _MAX_UNORDERED:
            raise _ManyError
        plan = self.order(counts)
        return plan is not None and self._solver._take(plan)

    def order(self, counts: Counts) -> Plan | None:
        """Return an executable order of counts, found by clingo; ``None`` where there is none."""
        return self._plan({a: (n, n) for a, n in counts.items()})

    def any_order(self, counts: Counts) -> Plan | None:
        """Return a good plan with few executions beyond counts, found by clingo; ``None`` without one."""
        extra = 1
        while extra <= _MAX_EXTRA_COPIES:
            plan = self._plan({a: (0, counts.get(a, 0) + extra) for a in range(len(self.units))}, True)
            if plan is not None:
                return plan
            extra *= 2
        return None

    def _plan(self, times: Mapping[int, tuple[int, int]], best: bool = False) -> Plan | None:
        ended = self._ended(times, best)
        if ended.units is None:
            if not ended.exhausted:
                raise Stopped
            return None
        return self._sequence(ended)

    def _sequence(self, ended: Run) -> Plan:
        return _sequence(self._problem, ended.rows["times"], ended.rows["_after"])

    def _ended(self, times: Mapping[int, tuple[int, int]], best: bool) -> Run:
        from foon_asp.encoding import facts, search  # noqa: PLC0415 (clingo, which not every question needs)
        from foon_asp.encoding.scales import Scales  # noqa: PLC0415

        solver, problem = self._solver, self._problem
        units = [self.units[a] for a in times]
        number = problem.network.unit_number
        # with fixed counts only the copies taken of a stock are free
        wanted = solver.levels if best else [level for level in solver.levels if level is Objective.KITCHEN]
        looked_at = None if solver.program.own else solver.program.looked_at
        scales = Scales(problem, units, wanted) if best or looked_at is not None else None
        text = facts.write_facts(problem, units, scales, looked_at)
        text += facts.write_times({number(self.units[a]): bounds for a, bounds in times.items()})
        text += facts.write_objectives(wanted)
        files = solver.program.files
        if best and scales is not None and (solver.below or solver.incomparable):
            # bounds by fractions are enforced by counts alone
            text += facts.write_below([{o: cost} for o, cost in solver.below if o.row.whole], scales)
            text += facts.write_beside(
                [{number(u): n for u, n in plan.items()} for plan in solver.incomparable]
            )
            files = (*files, question_encoding("bounded_plans.lp"))
        ended = search.run(
            files,
            text,
            solver.program.arguments,
            solver.deadline,
            "opt" if wanted else "ignore",
            predicates=[("times", 2), ("_after", 4)],
            endless=solver.program.endless,
        )
        if ended.statistics:
            solver.searched = True
            solver.reporter.statistics(ended.statistics)
        solver.seconds["ground"] = solver.seconds.get("ground", 0.0) + ended.ground_seconds
        solver.seconds["solve"] = solver.seconds.get("solve", 0.0) + ended.solve_seconds
        return ended


def _classes(figures: Sequence[Fraction], idle: Fraction) -> list[int]:
    """Return the rank of each figure among the different figures, -1 for the neutral one."""
    numbers = {figure: number for number, figure in enumerate(sorted(set(figures)))}
    return [-1 if figure == idle else numbers[figure] for figure in figures]


def _sequence(problem: Problem, times: frozenset[tuple[int, ...]], after: frozenset[tuple[int, ...]]) -> Plan:
    """Return executions in topological order, the smallest units first among those that are ready."""
    before: dict[tuple[int, int], set[tuple[int, int]]] = {
        (unit, turn): set() for unit, count in times for turn in range(1, count + 1)
    }
    for unit, turn, other, earlier in after:
        before[unit, turn].add((other, earlier))
    plan: list[int] = []
    sorter = TopologicalSorter(before)
    sorter.prepare()
    while sorter.is_active():
        ready = sorted(sorter.get_ready())
        for unit, _ in ready:
            unit_id = problem.network.unit_of_number(unit)
            assert unit_id is not None
            plan.append(unit_id)
        sorter.done(*ready)
    return tuple(plan)
