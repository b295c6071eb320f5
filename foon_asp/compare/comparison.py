"""One goal: what each search returned, whether it executes, and how far it is from the optimum."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.used_up import order_that_runs
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError
from foon_asp.network import TaskTree
from foon_asp.problem import ContainerRule, Objective, Problem, conditions, multiplies
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict, simulate_for
from foon_asp.search import Ending, Search, SearchSettings

if TYPE_CHECKING:
    from foon_asp.asp.breaking import Breaking

# The objectives whose optima a tree is compared with.
MEASURED = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)


class Optimum(NamedTuple):
    """The optimum of one objective: ``value`` is proved where ``status`` is ``optimal``."""

    status: str
    value: Fraction | None


class Judgement(NamedTuple):
    """What one search returned for one goal.

    ``ending`` is one of :class:`~foon_asp.search.Ending`; ``stuck_at`` the object in the way, if one was.
    ``executes`` is one of :class:`~foon_asp.proof.Verdict`, or ``None`` without a tree. ``obstacle`` says
    what stops every order: the motion of the first unit that cannot run (empty where it is the goal that is
    missing), what is missing, and whether a cycle is to blame. ``order`` is an order that executes, in
    positions of ``units`` from 0. ``breaks`` are the rules of the user's that a tree which executes breaks,
    each with its place.
    """

    search: str
    ending: str
    units: tuple[int, ...] | None = None
    measures: dict[Objective, Fraction] = {}  # noqa: RUF012 (never changed)
    executes: str | None = None
    order: tuple[int, ...] = ()
    obstacle: tuple[str, str, bool] | None = None
    stuck_at: str | None = None
    breaks: tuple[str, ...] = ()

    @property
    def counts(self) -> bool:
        """Whether it is a tree: one that executes, and keeps to the rules."""
        return self.executes in {Verdict.AS_LISTED, Verdict.REORDERED} and not self.breaks


class Comparison(NamedTuple):
    """The searches and the optimum for one goal (in one-line notation) under one rule, at one level.

    ``items`` says whether they last; where they are used up, a tree executes if it runs as a plan.
    ``starting`` says that no kitchen was given; rows of results are for one kitchen, and do not repeat it.
    """

    goal: str
    containers: str
    optima: dict[Objective, Optimum]
    judgements: tuple[Judgement, ...]
    level: int = 3
    items: str = "lasting"
    starting: bool = False

    @property
    def conditions(self) -> str:
        """What all of it holds under, in a few words: ``strict containers``."""
        said = conditions(ContainerRule(self.containers), self.level, self.starting)
        return said if self.items == "lasting" else f"{said}, items used up"

    def ratio(self, judgement: Judgement, objective: Objective) -> Fraction | None:
        """Give the measure of a tree over the proved optimum; ``None`` where either is not known or 0."""
        optimum = self.optima.get(objective)
        measure = judgement.measures.get(objective)
        if optimum is None or not optimum.value or measure is None or optimum.status != Status.OPTIMAL:
            return None
        return measure / optimum.value

    def beats_the_optimum(self, judgement: Judgement, objective: Objective) -> bool:
        """Whether a tree is better than the proved optimum: it does not execute then, or breaks a rule."""
        ratio = self.ratio(judgement, objective)
        return ratio is not None and (ratio > 1 if multiplies(objective) else ratio < 1)


def compare(
    problem: Problem,
    searches: Sequence[Search],
    settings: SearchSettings,
    time_limit: float | None = None,
    rules: Settings | None = None,
) -> Comparison:
    """Run searches on a problem, simulate their trees and prove the optima beside them.

    ``time_limit`` is in seconds for each optimum. Optima of ``success`` are left out where no rates are
    known. Optima keep to the ``rules``; the searches know nothing of them, and it is said of their trees
    which they break.
    """
    how = rules or Settings()
    objects = problem.network.objects
    optima: dict[Objective, Optimum] = {}
    for objective in MEASURED:
        if multiplies(objective) and problem.rates is None:
            continue
        deadline = Deadline(time_limit, settings.memory_limit)
        outcome = solve(problem, (objective,), how._replace(deadline=deadline))
        value = None if outcome.costs is None else Fraction(outcome.costs.measure(objective))
        optima[objective] = Optimum(str(outcome.status), value)
    comparison = Comparison(
        " + ".join(str(objects[goal]) for goal in problem.goals),
        str(problem.containers),
        optima,
        tuple(_under(how, problem, judge(problem, search, settings)) for search in searches),
        problem.network.level,
        "lasting" if problem.items is None else "used-up",
    )
    _require_consistent(comparison)
    return comparison


def _require_consistent(comparison: Comparison) -> None:
    """Require that no tree that executes is better than a proved optimum: if one were, that is our bug."""
    for judgement in comparison.judgements:
        if not judgement.counts:
            continue
        for objective, optimum in comparison.optima.items():
            better = comparison.beats_the_optimum(judgement, objective)
            if better or optimum.status == Status.INFEASIBLE:
                raise BugError(
                    f"{judgement.search} has a tree for {comparison.goal} that executes and is better by "
                    f"{objective} than what was proved ({optimum.status})"
                )


def _under(rules: Settings, problem: Problem, judgement: Judgement) -> Judgement:
    """Note which rules a tree breaks."""
    if not (rules.constraints and judgement.counts and judgement.units is not None):
        return judgement
    broken = _breaking(rules, problem.items is not None).broken(problem, judgement.units)
    return judgement._replace(breaks=tuple(map(str, broken)))


@lru_cache(maxsize=1)
def _breaking(rules: Settings, used_up: bool) -> "Breaking":
    from foon_asp.asp.breaking import Breaking  # noqa: PLC0415 (takes clingo along)

    return Breaking(rules, used_up)


def judge(problem: Problem, search: Search, settings: SearchSettings) -> Judgement:
    """Run one search and simulate the tree it returns."""
    objects = problem.network.objects
    retrieval = search.run(replace(problem, items=None), settings)
    if retrieval.ending is not Ending.TREE:
        stuck_at = None if retrieval.stuck_at is None else str(objects[retrieval.stuck_at])
        return Judgement(search.name, str(retrieval.ending), stuck_at=stuck_at)
    tree = problem.tree(retrieval.units)
    simulation = simulated(problem, retrieval.units, tree)
    obstacle = None
    if simulation.obstacle is not None:
        place, missing, cycle = simulation.obstacle
        motion = "" if place is None else tree.units[place].motion
        obstacle = (motion, str(missing), bool(cycle))
    costs = problem.costs(retrieval.units)
    measures = {
        objective: Fraction(costs.measure(objective))
        for objective in MEASURED
        if not multiplies(objective) or costs.success is not None
    }
    return Judgement(
        search.name,
        str(retrieval.ending),
        retrieval.units,
        measures,
        str(simulation.verdict),
        simulation.order,
        obstacle,
    )


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
