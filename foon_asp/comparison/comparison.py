"""Comparison for one goal: the tree of each search, whether it executes, and its distance to the optimum."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from msgspec import UNSET, UnsetType, field

from foon_asp.asp import Settings, Status, solve
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError
from foon_asp.network import TaskTree
from foon_asp.plans.counting import order_that_runs
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict, simulate_for
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.results.values import Figure, Node, Step, Value
from foon_asp.results.values_of import goals_of, named_node, node_of
from foon_asp.searches import Ending, Search, SearchSettings

if TYPE_CHECKING:
    from foon_asp.asp.user_rule_check import UserRuleCheck

MEASURED = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)
"""The objectives by which trees are compared with the optimum."""


class Optimum(Value, frozen=True):
    """The optimum of one objective.

    Attributes:
        value: The cost of the best tree found, which is proved if the status is optimal; null without a tree.
    """

    status: Status
    value: Figure | None


class Obstruction(Value, frozen=True):
    """The reason why no order of a tree executes.

    Attributes:
        motion: The motion of the first unit that cannot run; null where a goal is missing.
        missing: The node that the unit lacks, or the goal that is missing.
        cycle: Whether the cause is a cycle of units that wait for each other.
    """

    motion: str | None
    missing: Node
    cycle: bool


class SearchResult(Value, frozen=True):
    """The result of one search for one goal.

    Attributes:
        ending: How the search ended.
        stuck_at: The object that the search cannot have; null if it was not stuck.
        units: Unit ids in the order listed; null without a tree.
        measures: What the tree costs by each objective that is compared.
        ratios: The measure divided by the optimum; null if the optimum is not proved, or 0.
        verdict: Whether the tree executes; null without a tree.
        order: Positions of steps, from 1, in an order in which they run. If the tree does not execute, steps
            may be missing. Empty without a tree.
        obstacle: What stops every order; null if nothing does.
        runs_used_up: Whether the tree runs, in some order, where items are used up and each step is done
            once; null where that is not known.
        breaks: The user rules that the tree breaks, with their places; empty if it does not execute.
        tree: The steps in the order listed; null without a tree, and left out unless trees are asked for.
    """

    search: str
    ending: Ending
    stuck_at: Node | None = None
    units: tuple[int, ...] | None = None
    measures: dict[Objective, Figure] = field(default_factory=dict)
    ratios: dict[Objective, Fraction | None] = field(default_factory=dict)
    verdict: Verdict | None = None
    order: tuple[int, ...] = ()
    obstacle: Obstruction | None = None
    runs_used_up: bool | None = None
    breaks: tuple[str, ...] = ()
    tree: tuple[Step, ...] | UnsetType | None = UNSET

    @property
    def executes(self) -> bool:
        """Whether there is a tree that executes, as listed or in another order."""
        return self.verdict in {Verdict.AS_LISTED, Verdict.REORDERED}

    @property
    def is_valid(self) -> bool:
        """Whether the search returned a tree that executes and breaks no rule."""
        return self.executes and not self.breaks

    @property
    def has_cycle(self) -> bool:
        """Whether units of the tree wait for each other in a cycle."""
        return self.obstacle is not None and self.obstacle.cycle

    def beats_the_optimum(self, objective: Objective) -> bool:
        """Return whether the tree is better than the proved optimum.

        Such a tree does not execute, or breaks a rule. Without a tree or a proved optimum, the answer is
        false.
        """
        ratio = self.ratios.get(objective)
        return ratio is not None and (ratio > 1 if multiplies(objective) else ratio < 1)


class Comparison(Value, frozen=True):
    """The results of the searches for one goal, and its optimum.

    Attributes:
        optimum: The optimum of each objective by itself.
    """

    goal: Node
    optimum: dict[Objective, Optimum]
    searches: tuple[SearchResult, ...]


def compare(
    problem: Problem,
    searches: Sequence[Search],
    settings: SearchSettings,
    time_limit: float | None = None,
    rules: Settings | None = None,
) -> Comparison:
    """Return the results of searches on a problem of one goal, and the optimum by each objective.

    The trees of the searches are simulated. For each optimum, the limits are ``time_limit`` in seconds and
    the memory limit of ``settings``. The optimum by ``success`` is left out where no rates are known. Optima
    keep to the ``rules``. The searches ignore the rules; each result lists the rules that its tree breaks.
    Raises :class:`BugError` if a tree that executes is better than a proved optimum.
    """
    solver_settings = rules or Settings()
    optima: dict[Objective, Optimum] = {}
    for objective in MEASURED:
        if multiplies(objective) and problem.rates is None:
            continue
        deadline = Deadline(time_limit, settings.memory_limit)
        outcome = solve(problem, (objective,), solver_settings._replace(deadline=deadline))
        value = None if outcome.costs is None else outcome.costs.measure(objective)
        optima[objective] = Optimum(outcome.status, value)
    (goal,) = goals_of(problem.network, problem.goals)
    results = tuple(judge_search(problem, search, settings, optima, solver_settings) for search in searches)
    comparison = Comparison(goal, optima, results)
    _require_consistent(comparison)
    return comparison


def _require_consistent(comparison: Comparison) -> None:
    """Raise :class:`BugError` where a tree that executes is better than a proved optimum.

    Raise it also if a tree executes although it was proved that none exists. Trees that break a rule are not
    looked at.
    """
    for result in comparison.searches:
        if not result.is_valid:
            continue
        for objective, optimum in comparison.optimum.items():
            if result.beats_the_optimum(objective) or optimum.status is Status.INFEASIBLE:
                raise BugError(
                    f"{result.search} has a tree for {comparison.goal} that executes and is better by "
                    f"{objective} than what was proved ({optimum.status})"
                )


@lru_cache(maxsize=1)
def _rule_check_of(rules: Settings, used_up: bool) -> "UserRuleCheck":
    """Return the check against user rules: of trees or, if items are used up (``used_up``), of plans.

    The last check is kept in a cache, since many goals share it.
    """
    from foon_asp.asp.user_rule_check import UserRuleCheck  # noqa: PLC0415 (takes clingo along)

    return UserRuleCheck(rules, used_up)


def judge_search(
    problem: Problem,
    search: Search,
    settings: SearchSettings,
    optima: Mapping[Objective, Optimum],
    rules: Settings,
) -> SearchResult:
    """Run one search, simulate its tree, and compare its costs with the optima.

    The search runs as if items last. A tree that executes is also checked against the constraints of
    ``rules``. ``optima`` are by objective; the result has no ratio to an optimum that is missing.
    """
    network = problem.network
    retrieval = search.run(replace(problem, items=None), settings)
    if retrieval.ending is not Ending.TREE:
        stuck_at = None if retrieval.stuck_at is None else node_of(network, retrieval.stuck_at)
        return SearchResult(search.name, retrieval.ending, stuck_at)
    tree = problem.tree(retrieval.units)
    simulation = simulate_retrieval(problem, retrieval.units, tree)
    obstruction = None
    if simulation.obstacle is not None:
        position, missing, cycle = simulation.obstacle[:3]
        motion = None if position is None else tree.units[position].motion
        obstruction = Obstruction(motion, named_node(network, missing), bool(cycle))
    costs, lasting = problem.costs(retrieval.units), problem.items is None
    measures = {
        objective: costs.measure(objective)
        for objective in MEASURED
        if not multiplies(objective) or costs.success is not None
    }
    executes = simulation.verdict is not Verdict.NEVER
    check_rules = rules.constraints and executes
    broken = _rule_check_of(rules, not lasting).broken_rules(problem, retrieval.units) if check_rules else ()
    return SearchResult(
        search.name,
        retrieval.ending,
        None,
        tuple(map(network.unit_number, retrieval.units)),
        measures,
        {
            objective: _ratio_to_optimum(measure, optima.get(objective))
            for objective, measure in measures.items()
        },
        simulation.verdict,
        tuple(position + 1 for position in simulation.order),
        obstruction,
        used_up_run(problem, tree).runs if lasting else executes,
        tuple(map(str, broken)),
    )


def _ratio_to_optimum(measure: Figure, optimum: Optimum | None) -> Fraction | None:
    """Return a measure divided by the optimum; ``None`` if the optimum is missing, 0 or not proved."""
    if optimum is None or not optimum.value or optimum.status is not Status.OPTIMAL:
        return None
    return Fraction(measure) / optimum.value


def simulate_retrieval(problem: Problem, units: Sequence[int], tree: TaskTree) -> Simulation:
    """Return the simulation of a tree that a search returned; ``units`` are its ids.

    Where items last, the tree is simulated. Where items are used up, a plan is simulated that executes each
    unit once: in the order listed, or else in another one that runs. If the tree does not execute even with
    lasting items, the result is the simulation with lasting items.
    """
    simulation = simulate_for(problem, tree)
    if problem.items is None or simulation.verdict is Verdict.NEVER:
        return simulation
    shortage = replay_for(problem, tree).shortage
    if shortage is None:
        return Simulation(Verdict.AS_LISTED, tuple(range(len(units))), None, None)
    obstacle = Obstacle(shortage.step, shortage.node)
    plan = order_that_runs(problem, units)
    if plan is None:
        return Simulation(Verdict.NEVER, (), obstacle, obstacle)
    positions: dict[int, list[int]] = {}
    for position, unit in enumerate(units):
        positions.setdefault(unit, []).append(position)
    return Simulation(Verdict.REORDERED, tuple(positions[unit].pop(0) for unit in plan), obstacle, None)
