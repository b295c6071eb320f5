"""Optimal trees for a problem of a large store, reading only the units that a proof needs."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status
from foon_asp.asp.assembly import hold_for_subtrees, need_clingo, program_of
from foon_asp.asp.optimum import solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import ALL
from foon_asp.hypergraph.reduction import h_add_tree
from foon_asp.problem import (
    Costs,
    Objective,
    Problem,
    executable_order,
    follow_achievers,
    levels,
    multiplies,
    reach,
)

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.dataset.nearby import Nearby


class RefinementTuning(NamedTuple):
    """How many units of a store are read in each round, and when rounds do without a proof.

    ``proved_units``: the greatest number of units read at which a round proves the optimality of its tree.
    Proofs are quick for few units, and the fewest units are read. Above this number, trees without a proof
    choose the units to read next. If the number is doubled, the hardest questions take twice as long
    (``benchmarks/store.py``, family ``deep``).
    ``narrow_step``: a round reads one more unit for each ``narrow_step`` units that were read.
    ``wide_step``: replaces ``narrow_step`` in long rounds, where it matters less to read few units.
    """

    proved_units: int = 1_500
    narrow_step: int = 10
    wide_step: int = 5


REFINEMENT = RefinementTuning()


def near_goals(problem: Problem, objectives: Sequence[Objective], settings: Settings) -> "Nearby | None":
    """Return the units that were read of a large store, near the goals of a problem.

    More units can be read in the result without changing the problem.

    Return ``None`` if :func:`solve_nearby` does not apply:
    - if the problem is not about a large store, or all its units were read,
    - if an objective is not built in, or does not only add or multiply values of units,
    - if a rule is not antimonotone, or
    - if the settings have options of clingo, replaced encodings, or not all reductions.
    """
    nearby_of: Callable[[], Nearby | None] | None = getattr(problem, "nearby", None)
    if nearby_of is None or settings.reductions != ALL or settings.clingo_options:
        return None
    are_sums_over_units = all(objective in Objective and not objective.row.item for objective in objectives)
    return nearby_of() if are_sums_over_units and hold_for_subtrees(settings) else None


def solve_nearby(
    nearby: "Nearby", objectives: Sequence[Objective], settings: Settings, reporter: Reporter | None = None
) -> Outcome | None:
    """Solve a problem of a large store by relaxation and refinement, reading only units that are needed.

    Each round solves the relaxation, in which open nodes are available. If its optimal tree uses no open
    node, this tree is also optimal in the whole network. Otherwise more units that lead to the open nodes are
    read. This repeats until a tree is optimal or all units are read.

    User rules have to be antimonotone: if a tree keeps them, so does every part of the tree. If only clingo
    can check the rules, two trees choose the units that are read first. The first is the optimal tree without
    rules, the second is the smallest tree that keeps the rules.

    At a limit or ctrl-C, return the best tree among the units read, or an outcome without a tree. Its bound
    on the first objective is the tightest of all rounds. If the rules exclude all trees, return an outcome
    that says so. Return ``None`` if no tree exists even without rules: the caller then reads all units, to
    explain why.

    ``reporter`` receives warnings, bounds and the last tree.
    """
    reporter = reporter or Reporter()
    if settings.constraints:
        program_of(nearby.problem, settings, reporter.warning)  # warns of names that the rules alone have
    deadline = settings.effective_deadline
    settings_with_rules = settings._replace(deadline=deadline)
    settings_without_rules = settings_with_rules._replace(constraints=(), constants=())
    first_objective = levels(tuple(objectives))[0]
    tighter = min if multiplies(first_objective) else max
    bounds_found: list[int | Fraction] = []  # on the first objective
    units_of_rules = set[int]()  # units, by number, on which the rules depend
    smallest_tree: list[int] | None = None  # with the rules, by number; ``None`` before the search
    unconstrained: Outcome | None = None
    if need_clingo(settings):  # the optimum without rules is needed anyway, and read quickly
        unconstrained = solve_nearby(nearby, objectives, settings_without_rules, _WarningsAndBounds(reporter))
        if unconstrained is None:
            return None
        bounds_found += [
            bound for objective, bound in unconstrained.bounds.items() if objective == first_objective
        ]
    while True:
        problem = nearby.problem
        outcome = solve(
            nearby.relaxation, objectives, settings_with_rules, _WarningsAndBounds(reporter), units_of_rules
        )
        if outcome.status is Status.INFEASIBLE:
            excluded_by_rules = unconstrained is not None or (
                bool(settings.constraints) and _may_have_tree(nearby, deadline)
            )
            return outcome._replace(problem=nearby.problem) if excluded_by_rules else None
        bounds_found += [bound for objective, bound in outcome.bounds.items() if objective == first_objective]
        open_nodes = [] if outcome.units is None else nearby.open_nodes_used(outcome.units)
        if open_nodes and outcome.status is Status.OPTIMAL:
            try:
                with deadline.watched("reading"):  # stops early, so that time for a tree remains
                    _read_more(nearby, open_nodes, objectives, settings)
            except KeyboardInterrupt:
                deadline.interrupt()
                outcome = outcome._replace(proof=None, stopped=deadline.stopped)
            else:
                if unconstrained is not None and smallest_tree is None:
                    smallest_tree = (
                        []
                        if first_objective is Objective.UNITS
                        else _read_smallest_tree(nearby, settings_with_rules, units_of_rules)
                    )
                continue
        bounds = (
            {**outcome.bounds, first_objective: tighter(bounds_found)} if bounds_found else outcome.bounds
        )
        outcome = outcome._replace(problem=problem, bounds=bounds)
        if open_nodes:  # at a limit: the bound holds, and the units read may have a tree
            outcome_of_units_read = solve(
                problem, objectives, settings_with_rules, _WarningsAndBounds(Reporter())
            )
            status = Status.UNKNOWN if outcome_of_units_read.units is None else Status.FEASIBLE
            outcome = outcome._replace(
                status=status, units=outcome_of_units_read.units, costs=outcome_of_units_read.costs
            )
        if outcome.status is Status.UNKNOWN and smallest_tree:
            units = [
                unit
                for number in smallest_tree
                if (unit := problem.network.unit_of_number(number)) is not None
            ]
            outcome = outcome._replace(
                status=Status.FEASIBLE, units=executable_order(problem, units), costs=problem.costs(units)
            )
        if outcome.units is not None:
            postconditions = Postconditions(problem, levels(tuple(objectives)), settings)
            outcome = outcome._replace(units=postconditions.require_executable(outcome.units))
            assert outcome.costs is not None
            reporter.tree(outcome.costs)
        return outcome


def _may_have_tree(nearby: "Nearby", deadline: Deadline) -> bool:
    """Whether the goals have a tree without rules; units are read until that is known.

    At a limit or ctrl-C, which stops the deadline, return true.
    """
    while True:
        relaxed = nearby.relaxation
        reached = reach(relaxed)
        tree = follow_achievers(relaxed.goals, reached.makers, relaxed.needs, relaxed.kitchen)
        if tree is None:
            return False
        open_nodes = nearby.open_nodes_used(unit for unit in reached.units if unit in tree)
        if not open_nodes:
            return True
        try:
            with deadline.watched("reading"):
                nearby.grow(open_nodes, REFINEMENT.wide_step)
        except KeyboardInterrupt:
            deadline.interrupt()
            return True


def _read_smallest_tree(nearby: "Nearby", settings: Settings, units_of_rules: set[int]) -> list[int]:
    """Search for the tree of fewest units that keeps the rules, reading units until it is found.

    Return its units by id in the whole network. Return an empty list if there is no such tree, and at a limit
    or ctrl-C. ``units_of_rules`` collects the ids of the units on which the rules depend.

    This tree is found faster than the optimum of other objectives, and better trees mostly use units near it.
    """
    while True:
        outcome = solve(nearby.relaxation, (Objective.UNITS,), settings, mattered=units_of_rules)
        if outcome.status is not Status.OPTIMAL or outcome.units is None:
            return []
        open_nodes = nearby.open_nodes_used(outcome.units)
        if not open_nodes:
            return [*map(nearby.problem.network.unit_number, outcome.units)]
        try:
            with settings.effective_deadline.watched("reading"):
                nearby.grow(open_nodes, REFINEMENT.wide_step)
        except KeyboardInterrupt:
            settings.effective_deadline.interrupt()
            return []


def _read_more(
    nearby: "Nearby", open_nodes: Sequence[int], objectives: Sequence[Objective], settings: Settings
) -> None:
    """Read more units that lead to ``open_nodes``, which an optimal tree of the relaxation uses.

    Stop there if there are rules, or if at most :attr:`RefinementTuning.proved_units` units were read before.
    Otherwise read units for trees that ``h_add`` finds, until one of them uses no open node. Such trees
    mostly lead to the units of an optimal tree, in a tenth of the time of a proof.
    """
    many_read = nearby.unit_count > REFINEMENT.proved_units
    long_rounds = many_read or need_clingo(settings)
    nearby.grow(open_nodes, REFINEMENT.wide_step if long_rounds else REFINEMENT.narrow_step)
    if not many_read or settings.constraints:
        return
    while (tree := h_add_tree(nearby.relaxation, levels(tuple(objectives)))) is not None:
        order = executable_order(nearby.relaxation, tree)
        assert order is not None
        open_nodes = nearby.open_nodes_used(order)
        if not open_nodes:
            return
        nearby.grow(open_nodes, REFINEMENT.narrow_step)


def least_with_more(
    costs: Costs, order: Sequence[Objective], extra_units: int = 1
) -> tuple[int | Fraction, ...]:
    """Return a lower bound on the cost of a tree with at least ``extra_units`` more units than ``costs`` has.

    The tree must cost at least ``costs`` by every objective. The result has the cost by each objective of
    ``order``, one of which is ``units``.
    """
    least_costs = dict(zip(order, costs.key(order), strict=True))
    least_costs[Objective.UNITS] += extra_units
    return tuple(least_costs.values())


class _WarningsAndBounds(Reporter):
    """A reporter that passes on warnings and bounds, but no trees and no steps.

    A tree of the relaxation may not be a tree of the whole network.
    """

    def __init__(self, reporter: Reporter) -> None:
        self.warning = reporter.warning  # type: ignore[method-assign]
        self.bound = reporter.bound  # type: ignore[method-assign]
