"""One goal: what each search returned, whether it executes, and how far it is from the optimum."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from msgspec import UNSET, UnsetType, field

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.used_up import order_that_runs
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError
from foon_asp.network import TaskTree
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict, simulate_for
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.results.values import Figure, Node, Step, Value
from foon_asp.results.values_of import goals_of, named_node, node_of
from foon_asp.searches import Ending, Search, SearchSettings

if TYPE_CHECKING:
    from foon_asp.asp.breaking import Breaking

# The objectives whose optima a tree is compared with.
MEASURED = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)


class Optimum(Value, frozen=True):
    """The optimum of one objective.

    Attributes:
        value: What the best tree costs, proved where the status is optimal; null without a tree.
    """

    status: Status
    value: Figure | None


class Obstruction(Value, frozen=True):
    """What stops every order of a tree.

    Attributes:
        motion: The motion of the first unit that cannot run; null where a goal is missing.
        missing: What the unit lacks, or the goal.
        cycle: Whether units that wait for each other are to blame.
    """

    motion: str | None
    missing: Node
    cycle: bool


class SearchResult(Value, frozen=True):
    """What one search returned for one goal.

    Attributes:
        ending: How the search ended.
        stuck_at: The object in the way, if one was.
        units: Unit ids in the order listed; null without a tree.
        measures: What the tree costs by each objective that is compared.
        ratios: Measure over optimum; null where the optimum is not proved, or 0.
        verdict: Whether the tree executes; null without a tree.
        order: An order that executes, in positions from 1.
        obstacle: What stops every order, if anything.
        runs_used_up: Whether the tree runs, in some order, where items are used up and each step is done
            once; null where that is not known.
        breaks: The rules that a tree which executes breaks, with their places.
        tree: The steps in the order listed, where the trees are asked for; null without a tree.
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
    def counts(self) -> bool:
        """Whether it is a tree: one that executes, and keeps to the rules."""
        return self.executes and not self.breaks

    @property
    def waits(self) -> bool:
        """Whether units of the tree wait for each other."""
        return self.obstacle is not None and self.obstacle.cycle

    def beats_the_optimum(self, objective: Objective) -> bool:
        """Whether the tree is better than the proved optimum: it does not execute then, or breaks a rule."""
        ratio = self.ratios.get(objective)
        return ratio is not None and (ratio > 1 if multiplies(objective) else ratio < 1)


class Comparison(Value, frozen=True):
    """What the searches returned for one goal, beside the optimum.

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
    """Run searches on a problem of one goal, simulate their trees and prove the optima beside them.

    ``time_limit`` is in seconds for each optimum. Optima of ``success`` are left out where no rates are
    known. Optima keep to the ``rules``; the searches know nothing of them, and it is said of their trees
    which they break.
    """
    how = rules or Settings()
    optima: dict[Objective, Optimum] = {}
    for objective in MEASURED:
        if multiplies(objective) and problem.rates is None:
            continue
        deadline = Deadline(time_limit, settings.memory_limit)
        outcome = solve(problem, (objective,), how._replace(deadline=deadline))
        value = None if outcome.costs is None else outcome.costs.measure(objective)
        optima[objective] = Optimum(outcome.status, value)
    (goal,) = goals_of(problem.network, problem.goals)
    results = tuple(judge(problem, search, settings, optima, how) for search in searches)
    comparison = Comparison(goal, optima, results)
    _require_consistent(comparison)
    return comparison


def _require_consistent(comparison: Comparison) -> None:
    """Require that no tree that executes is better than a proved optimum: if one were, that is our bug."""
    for result in comparison.searches:
        if not result.counts:
            continue
        for objective, optimum in comparison.optimum.items():
            if result.beats_the_optimum(objective) or optimum.status is Status.INFEASIBLE:
                raise BugError(
                    f"{result.search} has a tree for {comparison.goal} that executes and is better by "
                    f"{objective} than what was proved ({optimum.status})"
                )


@lru_cache(maxsize=1)
def _breaking(rules: Settings, used_up: bool) -> "Breaking":
    from foon_asp.asp.breaking import Breaking  # noqa: PLC0415 (takes clingo along)

    return Breaking(rules, used_up)


def judge(
    problem: Problem,
    search: Search,
    settings: SearchSettings,
    optima: Mapping[Objective, Optimum],
    rules: Settings,
) -> SearchResult:
    """Run one search, simulate the tree it returns, and compare it with the optima."""
    network = problem.network
    found = search.run(replace(problem, items=None), settings)
    if found.ending is not Ending.TREE:
        stuck_at = None if found.stuck_at is None else node_of(network, found.stuck_at)
        return SearchResult(search.name, found.ending, stuck_at)
    tree = problem.tree(found.units)
    simulation = simulated(problem, found.units, tree)
    obstruction = None
    if simulation.obstacle is not None:
        place, missing, cycle = simulation.obstacle[:3]
        motion = None if place is None else tree.units[place].motion
        obstruction = Obstruction(motion, named_node(network, missing), bool(cycle))
    costs, lasting = problem.costs(found.units), problem.items is None
    measures = {
        objective: costs.measure(objective)
        for objective in MEASURED
        if not multiplies(objective) or costs.success is not None
    }
    executes = simulation.verdict is not Verdict.NEVER
    asked = rules.constraints and executes
    broken = _breaking(rules, not lasting).broken(problem, found.units) if asked else ()
    return SearchResult(
        search.name,
        found.ending,
        None,
        tuple(map(network.unit_number, found.units)),
        measures,
        {objective: _ratio(measure, optima.get(objective)) for objective, measure in measures.items()},
        simulation.verdict,
        tuple(position + 1 for position in simulation.order),
        obstruction,
        used_up_run(problem, tree).runs if lasting else executes,
        tuple(map(str, broken)),
    )


def _ratio(measure: Figure, optimum: Optimum | None) -> Fraction | None:
    if optimum is None or not optimum.value or optimum.status is not Status.OPTIMAL:
        return None
    return Fraction(measure) / optimum.value


def simulated(problem: Problem, units: Sequence[int], tree: TaskTree) -> Simulation:
    """Simulate a tree; where items are used up, it has to run as a plan, in whatever order."""
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
    places = {unit: [n for n, each in enumerate(units) if each == unit] for unit in units}
    return Simulation(Verdict.REORDERED, tuple(places[unit].pop(0) for unit in plan), obstacle, None)
