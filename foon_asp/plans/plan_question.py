"""A question about plans: its rules applied, the units that can matter, and the incumbent."""

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from foon_asp.asp.assembly import assemble
from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.asp.solver import solve as solve_lasting
from foon_asp.errors import BugError
from foon_asp.plans.built_for_plans import require_built_for_plans, require_rules_of_plans
from foon_asp.problem import (
    Contradiction,
    Costs,
    LinearRow,
    Objective,
    Problem,
    Restriction,
    first_tree,
    levels,
    multiplies,
    reach,
    units_relevant_to_plans,
    unrestricted_reach,
)
from foon_asp.proof.counted_run import counted_run
from foon_asp.rules.dependence import TIMES

Plan = tuple[int, ...]
"""Units by id in the order of execution, with repeats."""


class PlanQuestion:
    """A question about plans, with the incumbent and what is known of the search.

    ``best``: the incumbent and its costs; ``None`` without an incumbent.
    ``bounds``: proved lower bounds by objective.
    ``limits``, ``restriction``: the rules that :meth:`apply_rules` understood.
    ``below``: pairs of an objective and a cost; a plan has to cost less than each.
    ``incomparable``: a list of counts. A plan is excluded if it executes every unit at least as often as one
    entry says.
    ``tree``: the units of some tree that makes the goals if items last; empty if no such tree is known.
    ``seconds``: the time of each phase by name, in seconds.
    """

    def __init__(
        self,
        problem: Problem,
        objectives: Sequence[Objective],
        settings: Settings,
        reporter: Reporter,
    ) -> None:
        """Read the objectives, settings and rules of a question; rules are applied later.

        Raises :class:`UserError` naming a feature that plans do not support.
        """
        require_built_for_plans(settings)
        objectives = tuple(objectives)
        by_levels = levels(objectives)
        problem.require_known_for(by_levels)
        self.problem, self.objectives, self.levels = problem, objectives, by_levels
        self.settings, self.deadline, self.reporter = settings, settings.effective_deadline, reporter
        self.program = assemble(settings, reporter.warning, used_up=True, problem=problem)
        self.program.require_facts(problem, by_levels)
        require_rules_of_plans(self.program)
        self.restriction: Restriction | None = None  # which units rules remove and require
        self.limits: Sequence[LinearRow] = ()
        bounded = settings.bounded or Bounded()
        self.below = [(objective, cost) for costs in bounded.below for objective, cost in costs.items()]
        self.incomparable = bounded.incomparable
        if not {objective for objective, _ in self.below} <= set(by_levels):
            raise BugError("a bound is on an objective that is not asked for")
        self.tree: frozenset[int] = frozenset()
        self.seconds: dict[str, float] = {}
        self.best: tuple[Plan, Costs] | None = None
        self.searched = False  # whether clingo ran, so that there are statistics
        self.bounds: dict[Objective, int | Fraction] = {}

    def apply_rules(self) -> bool:
        """Apply rules that remove units, require sets or limit sums; return whether they allow a plan.

        The rules become ``limits`` and ``restriction``. Other rules are left to the search.
        """
        rules = self.program.understood
        if rules is None:
            return True
        self.limits = rules.limits(self.problem, self.deadline)
        restriction = rules.varying({TIMES}).restriction_of(self.problem, self.deadline)
        if isinstance(restriction, Restriction):
            self.restriction = restriction
        return not isinstance(restriction, Contradiction)

    @property
    def required(self) -> tuple[frozenset[int], ...]:
        """The sets of units that rules require: a plan has a unit of each."""
        return () if self.restriction is None else self.restriction.required

    @property
    def may_need_redundant(self) -> bool:
        """Whether a rule may require units that are redundant for the goals."""
        rules = self.program.understood
        return rules is not None and not (rules.shrinking and rules.only_limits)

    def relevant_units(self) -> list[int] | None:
        """Return the units that can matter, by id, ascending, and set ``tree`` to some tree of them.

        They are the achievers of goals and, recursively, of their preconditions. If rules may require
        redundant units, return all units that can execute. Return ``None`` if a goal cannot be reached even
        if items last. Also return ``None`` if rules require a set of which no unit can execute.
        """
        problem = self.problem
        initial_nodes = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        lasting_problem = replace(problem, kitchen=initial_nodes, restriction=self.restriction)
        if self.restriction is None:
            reachable = unrestricted_reach(
                problem.network, problem.containers, problem.utensils, initial_nodes
            )
        else:
            reachable = reach(lasting_problem)
        if not all(reachable.available[goal] for goal in problem.goals):
            return None
        if not all(required_set & set(reachable.units) for required_set in self.required):
            return None
        self.tree = frozenset(first_tree(lasting_problem, reachable) or ())
        if self.may_need_redundant:
            return sorted(reachable.units)
        return sorted(units_relevant_to_plans(problem, reachable))

    def has_no_lasting_tree(self) -> bool:
        """Return whether it is proved that rules allow no tree if items last, and so no plan.

        The solver for items that last searches for such a tree. Return ``False`` without a search if there
        are no rules. Do the same if rules use numbers of executions other than in upper bounds.
        """
        rules, problem = self.program.understood, self.problem
        if rules is None or not rules.only_limits:
            return False
        kitchen = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        lasting_problem = replace(problem, kitchen=kitchen, items=None)
        settings = self.settings._replace(bounded=None)
        return solve_lasting(lasting_problem, (Objective.UNITS,), settings).status is Status.INFEASIBLE

    def try_incumbent(self, plan: Plan) -> bool:
        """Make a plan the incumbent, and report it, if it is allowed and better; return whether it was."""
        costs = self.problem.costs(plan)
        if not self.allows(plan):
            return False
        if self.best is not None and costs.key(self.levels) >= self.best[1].key(self.levels):
            return False
        self.best = plan, costs
        self.reporter.tree(costs)
        return True

    def allows(self, plan: Plan) -> bool:
        """Return whether ``limits``, ``below`` and ``incomparable`` allow a plan."""
        counts, costs = Counter(plan), self.problem.costs(plan)
        if not all(row.holds(plan) for row in self.limits):
            return False
        is_below = all(costs.key([o]) < (-cost if multiplies(o) else cost,) for o, cost in self.below)
        return is_below and not any(counts >= Counter(excluded) for excluded in self.incomparable)

    def outcome(self, status: Status, proof: Proof | None) -> Outcome:
        """Replay the incumbent, and return the outcome with this status and kind of proof.

        If the status is optimal, the costs of the incumbent become the bounds. Without an incumbent, the
        outcome has no bounds. ``proof`` is ``None`` if the search was stopped; the outcome then says why.
        Raises :class:`BugError` if the replay fails.
        """
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
        """Raise :class:`BugError` unless an independent replay executes a plan.

        The plan also has to cost ``costs``, and to take as many initial copies as the problem says.
        """
        replay = counted_run(self.problem, plan)
        if replay.lacking is not None:
            raise BugError(f"the plan {list(plan)} lacks {replay.lacking}")
        if self.problem.costs(plan) != costs:
            raise BugError(f"the plan {list(plan)} does not cost {costs}")
        objects = self.problem.network.objects
        copies = {objects[o]: count for o, count in self.problem.copies_taken(plan).items()}
        if copies != replay.stock:
            raise BugError(f"the plan {list(plan)} takes {replay.stock} of the stock and not {copies}")

    def add_seconds(self, phase: str, start_time: float) -> None:
        """Add the time since ``start_time``, on the clock ``perf_counter``, to the seconds of a phase."""
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - start_time
