"""The units of a question as counted actions: bounds on their counts, proofs, and orders that run."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from heapq import heappop, heappush

from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Settings
from foon_asp.encoding.own_encodings import ENCODING_FILES, question_encoding
from foon_asp.encoding.rate_scale import RateScale, rate_scale
from foon_asp.encoding.run import Run
from foon_asp.errors import UserError
from foon_asp.plans.clingo_order import order_executions
from foon_asp.plans.conditions import Counts, Level, Measure
from foon_asp.plans.count_bound import BetterError, CountBound
from foon_asp.plans.execution_order import bulk_order, least_copies, plan_of
from foon_asp.plans.flows import flows_of
from foon_asp.plans.plan_question import Plan, PlanQuestion
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import Stopped
from foon_asp.problem import LinearRow, Objective, Problem, multiplies
from foon_asp.problem.costs import Costs


class _ManyError(Exception):
    """Raised when too many vectors of counts were searched for an order that runs.

    Then clingo searches for counts and an order together.
    """


class Counting:
    """The counts of executions of the units of a question, and the search for their order.

    Counts are by action: action ``a`` is the unit ``units[a]``. ``bound`` is the branch and bound over
    counts. The incumbent is the one of the question.
    """

    def __init__(self, question: PlanQuestion, units: list[int]) -> None:
        """Build the flows of units, given by id, and the bound on their counts under the question's rules.

        The question may exclude plans. Those that have units not in ``units`` are ignored.
        """
        self._question, self._problem, self.units = question, question.problem, units
        self._measures: dict[Objective, Measure] = {}
        self._known_unit_costs: dict[Objective, list[Fraction]] = {}
        self._step = Fraction(1)  # step of the counted costs of the first objective
        self._orders_sought = -math.inf  # searches for an order since the proof began
        problem = question.problem
        positions = {unit: a for a, unit in enumerate(units)}
        self._flows = flows_of(problem, units)
        self.bound = CountBound(
            self._flows,
            [
                [a for a, unit in enumerate(units) if unit in required_set]
                for required_set in question.required
            ],
            [
                LinearRow(
                    {a: limit.weights[u] for a, u in enumerate(units) if limit.weights.get(u)}, *limit[1:]
                )
                for limit in question.limits
            ],
            [a for a, unit in enumerate(units) if unit in question.tree],
            [self._level_below(objective, cost) for objective, cost in question.below],
            [
                {positions[u]: n for u, n in plan.items()}
                for plan in question.incomparable
                if positions.keys() >= plan.keys()
            ],
            expired=lambda: question.deadline.passed,
        )

    def measure(self, objective: Objective) -> Measure:
        """Return the measure of an objective over the units; cached.

        Raises :class:`UserError` if the objective multiplies rates and a rate is 0.
        """
        if objective not in self._measures:
            self._measures[objective] = self._compute_measure(objective)
        return self._measures[objective]

    def _compute_measure(self, objective: Objective) -> Measure:
        """Return the measure of an objective over the units.

        Costs are multiplied by a common factor. If they are then not whole, they are rounded down, items cost
        nothing, and the measure also has exact costs. If the objective multiplies rates, costs are rounded
        logarithms, and the exact cost is the negative product of the rates.
        """
        row, unit_costs = objective.row, self._unit_costs(objective)
        if multiplies(objective):
            classes = _cost_classes(unit_costs, Fraction(1))

            def product(counts: Mapping[int, int]) -> Fraction:
                """Return the negative product of the rates of executions."""
                return -math.prod((unit_costs[a] ** n for a, n in counts.items()), start=Fraction(1))

            return Measure([self._rate_scale.weights[rate] for rate in unit_costs], 0, product, classes)
        scale = self._cost_scale(objective)
        costs = [math.floor(scale * unit_cost) for unit_cost in unit_costs]
        if all(cost == scale * unit_cost for cost, unit_cost in zip(costs, unit_costs, strict=True)):
            return Measure(costs, row.item)

        def total(counts: Mapping[int, int]) -> Fraction:
            """Return the sum of the exact costs of executions."""
            return sum((unit_costs[a] * n for a, n in counts.items()), start=Fraction(0))

        return Measure(costs, 0, total, _cost_classes(unit_costs, Fraction(0)))

    def _unit_costs(self, objective: Objective) -> list[Fraction]:
        """Return the exact cost of each action by an objective, or its rate for ``success``; cached."""
        if objective not in self._known_unit_costs:
            self._known_unit_costs[objective] = [
                Fraction(self._problem.figure(objective, unit)) for unit in self.units
            ]
        return self._known_unit_costs[objective]

    @cached_property
    def _rate_scale(self) -> RateScale:
        """The scale by which logarithms of the rates of units become whole numbers.

        Raises :class:`UserError` if a rate is 0.
        """
        try:
            return rate_scale(self._problem.different_rates(self.units))
        except ValueError:
            raise UserError(
                "a success rate is 0, for which plans with items that are used up cannot be compared"
            ) from None

    def _cost_scale(self, objective: Objective) -> Fraction:
        """Return the factor by which costs are multiplied before they are rounded down.

        If possible, the factor makes all costs whole, and the greatest cost at most ``exact_cost``.
        Otherwise, it makes the greatest cost ``cost_steps``.
        """
        unit_costs = self._unit_costs(objective)
        common = math.lcm(*(unit_cost.denominator for unit_cost in unit_costs))
        greatest = max(unit_costs, default=Fraction(0))
        return Fraction(common) if common * greatest <= PLANS.exact_cost else PLANS.cost_steps / greatest

    def level(self, objective: Objective, costs: Costs) -> Level:
        """Return the condition that a plan is at least as good as these costs by an objective."""
        return self._level_at(objective, Fraction(costs.measure(objective)))

    def _level_below(self, objective: Objective, cost: int | Fraction) -> Level:
        """Return the condition that a plan costs less than ``cost`` by an objective.

        For ``success``, ``cost`` is a rate, and the rate of the plan has to be above it.
        """
        level = self._level_at(objective, Fraction(cost))
        if level.measure.exact is not None:
            return level._replace(strict=True)
        return level._replace(max_cost=math.ceil(level.cost) - 1)

    def _level_at(self, objective: Objective, cost: Fraction) -> Level:
        """Return the condition that a plan costs at most ``cost`` by an objective.

        For ``success``, ``cost`` is a rate, and the plan has to have at least this rate.
        """
        measure = self.measure(objective)
        if multiplies(objective):
            return Level(measure, -cost, self._rate_scale.weigh(cost))
        scale = self._cost_scale(objective)
        if measure.exact is not None:
            return Level(measure, cost, math.floor(scale * cost))
        return Level(measure, scale * cost, int(scale * cost))

    def prove(self) -> None:
        """Prove that no plan is better than the incumbent.

        After many counts without a better plan, clingo searches all counts at once, if counts have small
        bounds. If a plan is better, make it the incumbent and raise :class:`BetterError`. Raises
        :class:`Stopped` if nothing is proved.
        """
        assert self._question.best is not None
        plan, costs = self._question.best
        levels: list[Level] = []
        self._step = 1 / self._cost_scale(self._question.levels[0])
        for objective in self._question.levels:
            split = self._split_costs(objective, plan)
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
            if not self._prove_with_clingo(levels[0]):
                self._orders_sought = -math.inf
                self.bound.prove(levels, self._is_better)

    def _split_costs(self, objective: Objective, plan: Plan) -> tuple[Fraction, list[Level]] | None:
        """Split costs that are too large for exact counting into two levels: the large costs and all others.

        The first level has the large costs, as multiples of the *step*, their greatest common divisor. All
        other costs of ``plan`` add up to less than a step, so the first level decides first. Return the step
        and the levels. Return ``None`` if costs need no such levels, or cannot be split in this way.
        """
        if multiplies(objective) or objective.row.item or self.measure(objective).exact is None:
            return None
        unit_costs = self._unit_costs(objective)
        common = math.lcm(*(unit_cost.denominator for unit_cost in unit_costs))
        costs = [int(common * unit_cost) for unit_cost in unit_costs]
        step = math.gcd(*(cost for cost in costs if cost > PLANS.exact_cost))
        counts_by_unit = Counter(plan)
        executed = [counts_by_unit[unit] for unit in self.units]
        levels = []
        for is_large in (True, False):
            level_costs = [
                (cost // step if is_large else cost) * ((cost > PLANS.exact_cost) is is_large)
                for cost in costs
            ]
            total = sum(cost * n for cost, n in zip(level_costs, executed, strict=True))
            if max(level_costs) > PLANS.exact_cost or (not is_large and total >= step):
                return None
            levels.append(Level(Measure(level_costs), Fraction(total), total))
        return Fraction(step, common), levels

    def prove_infeasible(self) -> bool:
        """Try all counts to prove that there is no plan; return whether it is proved.

        If a plan is found, make it the incumbent and return ``False``. Raises :class:`Stopped` if nothing is
        decided.
        """
        try:
            self.bound.prove_infeasible(self.measure(Objective.UNITS), self._is_better)
        except BetterError:
            return False
        return True

    def proved_bounds(self) -> dict[Objective, int | Fraction]:
        """Return the proved lower bound of the first objective, as a dictionary with this objective only.

        If nothing is proved, or if the objective multiplies rates, return an empty dictionary. Costs are
        rounded down, so a bound on rounded costs is valid.
        """
        objective = self._question.levels[0]
        if self.bound.proved <= 0 or multiplies(objective):
            return {}
        least = math.ceil(self.bound.proved) * self._step
        return {objective: int(least) if objective.row.whole else least}

    def _prove_with_clingo(self, level: Level) -> bool:
        """Try to prove with clingo that no plan is better; return whether it is proved.

        Return ``False`` without a search in two cases: counts of plans that satisfy ``level`` have no small
        bounds, or an objective has costs that are not whole. If a plan is better, make it the incumbent and
        raise :class:`BetterError`.
        """
        caps = [cap for cap in self.bound.max_counts(level) if cap is not None]
        if len(caps) < len(self.units) or sum(caps) > PLANS.clingo_executions:
            return False
        if not all(objective.row.whole for objective in self._question.levels):
            return False
        run = self._run_clingo({a: (0, cap) for a, cap in enumerate(caps)}, True)
        if run.units is not None and self._question.try_incumbent(self._plan_of_run(run)):
            raise BetterError({})
        return run.exhausted and run.units is not None

    def _is_better(self, counts: Counts) -> bool:
        """Return whether some order of counts is a better plan; if so, make it the incumbent.

        Raises :class:`_ManyError` if too many orders were sought since the proof began, unless amounts count.
        """
        self._orders_sought += 1
        if self._orders_sought > PLANS.unordered_counts and not self._problem.counts_amounts:
            raise _ManyError
        plan = self.find_order(counts)
        return plan is not None and self._question.try_incumbent(plan)

    def find_order(self, counts: Counts) -> Plan | None:
        """Return a plan that executes each action as often as counted; ``None`` if no such plan exists.

        The plan keeps to the user's rules. If amounts count, only a search over runs is tried
        (:func:`bulk_order`). With the objective ``kitchen``, clingo searches for the plan. Otherwise, clingo
        searches if the search over runs decides nothing. Raises :class:`Stopped` if nothing is decided.
        """
        if self._problem.counts_amounts:
            return self._bulk_plan(counts)
        if Objective.KITCHEN not in self._question.levels:
            try:
                return self._bulk_plan(counts)
            except Stopped:
                if self._question.deadline.passed:
                    raise
        return self._find_plan({a: (n, n) for a, n in counts.items()})

    def find_plan_beyond(self, counts: Counts) -> Plan | None:
        """Search with clingo for the best plan that executes actions up to a few times more than counted.

        First, each action may be executed once more than counted. This number is doubled up to
        ``extra_executions``. Return ``None`` if there is no such plan. Also return ``None`` if amounts count,
        since clingo does not count copies. Raises :class:`Stopped` if clingo decides nothing.
        """
        if self._problem.counts_amounts:
            return None
        extra = 1
        while extra <= PLANS.extra_executions:
            plan = self._find_plan({a: (0, counts.get(a, 0) + extra) for a in range(len(self.units))}, True)
            if plan is not None:
                return plan
            extra *= 2
        return None

    def _bulk_plan(self, counts: Counts) -> Plan | None:
        """Return a plan with these counts, built from runs of one action each; ``None`` if none exists.

        The plan keeps to the user's rules. With the objective ``kitchen``, it takes as few initial copies as
        possible. Raises :class:`Stopped` if nothing is decided.
        """
        flows, question = self._flows, self._question
        if not self._keeps_to_rules(counts):
            return None
        if Objective.KITCHEN not in question.levels:
            runs = bulk_order(flows, counts, flows.start, lambda: question.deadline.passed)
            return None if runs is None else plan_of(self.units, runs)
        least_stock = tuple(sorted(least_copies(flows, counts).items()))
        waiting, known_stocks = [(sum(n for _, n in least_stock), least_stock)], {least_stock}
        for _ in range(PLANS.stocks):
            if not waiting:
                return None
            total, stock = heappop(waiting)
            if any(n > flows.start[o] for o, n in stock):
                continue
            runs = bulk_order(flows, counts, dict(stock), lambda: question.deadline.passed)
            if runs is not None:
                return plan_of(self.units, runs)
            for index, (o, n) in enumerate(stock):
                larger = (*stock[:index], (o, n + 1), *stock[index + 1 :])
                if larger not in known_stocks:
                    known_stocks.add(larger)
                    heappush(waiting, (total + 1, larger))
        raise Stopped

    def _keeps_to_rules(self, counts: Counts) -> bool:
        """Return whether counts satisfy the user's rules, by asking clingo; ``True`` without such rules.

        Raises :class:`Stopped` if clingo does not decide it.
        """
        program, problem = self._question.program, self._problem
        if program.is_built_in:
            return True
        from foon_asp.encoding import clingo_run, fact_writer  # noqa: PLC0415 (takes clingo along)
        from foon_asp.encoding.cost_scales import Scales  # noqa: PLC0415

        units = [self.units[a] for a in counts]
        text = fact_writer.write_facts(problem, units, Scales(problem, units), program.looked_at)
        text += "".join(
            f"use({number}). times({number},{n}).\n"
            for a, n in counts.items()
            if (number := problem.network.unit_number(self.units[a])) is not None
        )
        user_files = program.files[len(ENCODING_FILES) :]
        run = clingo_run.run(
            user_files, text, program.arguments, self._question.deadline, "ignore", endless=program.endless
        )
        if not run.exhausted and run.units is None:
            raise Stopped
        return run.units is not None

    def _find_plan(self, times: Mapping[int, tuple[int, int]], best: bool = False) -> Plan | None:
        """Return a plan with counts within ``times``, found by clingo; ``None`` if no such plan exists.

        ``times`` has the least and greatest count of each action. With ``best``, the plan is the best one.
        Raises :class:`Stopped` if clingo does not decide it.
        """
        run = self._run_clingo(times, best)
        if run.units is None:
            if not run.exhausted:
                raise Stopped
            return None
        return self._plan_of_run(run)

    def _plan_of_run(self, run: Run) -> Plan:
        """Return the plan that a run of clingo found."""
        return order_executions(self._problem, run.rows["times"], run.rows["_after"])

    def _run_clingo(self, times: Mapping[int, tuple[int, int]], best: bool) -> Run:
        """Run clingo for a plan; return the run.

        ``times`` has for each action the fewest and the most executions. With ``best``, clingo searches for
        the best plan, within the bounds of the question. Otherwise, only the items taken are minimized, if
        ``kitchen`` is an objective. The seconds that clingo took are added to the question, and its
        statistics are reported.
        """
        from foon_asp.encoding import clingo_run, fact_writer  # noqa: PLC0415 (takes clingo along)
        from foon_asp.encoding.cost_scales import Scales  # noqa: PLC0415

        question, problem = self._question, self._problem
        units = [self.units[a] for a in times]
        unit_number = problem.network.unit_number
        # if counts are fixed, only the number of initial copies can be minimized
        minimized = question.levels if best else [o for o in question.levels if o is Objective.KITCHEN]
        looked_at = None if question.program.is_built_in else question.program.looked_at
        scales = Scales(problem, units, minimized) if best or looked_at is not None else None
        text = fact_writer.write_facts(problem, units, scales, looked_at)
        text += fact_writer.write_times({unit_number(self.units[a]): bounds for a, bounds in times.items()})
        text += fact_writer.write_objectives(minimized)
        files = question.program.files
        if best and scales is not None and (question.below or question.incomparable):
            # bounds by fractions are enforced by counts alone
            text += fact_writer.write_below([{o: cost} for o, cost in question.below if o.row.whole], scales)
            text += fact_writer.write_avoided_plans(
                [{unit_number(u): n for u, n in plan.items()} for plan in question.incomparable]
            )
            files = (*files, question_encoding("bounded_plans.lp"))
        run = clingo_run.run(
            files,
            text,
            question.program.arguments,
            question.deadline,
            "opt" if minimized else "ignore",
            predicates=[("times", 2), ("_after", 4)],
            endless=question.program.endless,
        )
        if run.statistics:
            question.searched = True
            question.reporter.statistics(run.statistics)
        question.seconds["ground"] = question.seconds.get("ground", 0.0) + run.ground_seconds
        question.seconds["solve"] = question.seconds.get("solve", 0.0) + run.solve_seconds
        return run


def _cost_classes(unit_costs: Sequence[Fraction], neutral: Fraction) -> list[int]:
    """Return the rank of each cost among the different costs, from 0; -1 for the cost ``neutral``."""
    ranks = {unit_cost: rank for rank, unit_cost in enumerate(sorted(set(unit_costs)))}
    return [-1 if unit_cost == neutral else ranks[unit_cost] for unit_cost in unit_costs]


def order_that_runs(problem: Problem, units: Sequence[int]) -> Plan | None:
    """Return units, repeats included, in an order that executes; ``None`` if no order does.

    Raises :class:`Stopped` if the search decides nothing.
    """
    question = PlanQuestion(problem, (Objective.UNITS,), Settings(), Reporter())
    counts_by_unit = Counter(units)
    return Counting(question, list(counts_by_unit)).find_order(dict(enumerate(counts_by_unit.values())))
