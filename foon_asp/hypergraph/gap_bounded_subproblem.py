"""Gap-bounded subproblems: all units of trees up to a cost, for questions with rules on trees."""

import math
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.exact_costs import ExactCosts
from foon_asp.hypergraph.goal_graph import GoalGraph
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.landmark_cuts import Cuts, landmark_cuts
from foon_asp.hypergraph.reduced_cost_fixing import neighbourhood, reduced_cost_fixing, reduced_costs_of
from foon_asp.problem import Problem


@dataclass(frozen=True, eq=False, repr=False)
class Subproblem:
    """A question with landmark cuts from before any reduction, so that they hold for every tree.

    ``remaining`` are the actions over which the cuts were found. With ``redundant``, trees may have units
    that lead to no goal, since rules can require such units. Then ``costs`` cover all actions.
    """

    problem: Problem
    graph: GoalGraph
    remaining: Collection[int]
    costs: ExactCosts
    cuts: Cuts
    redundant: bool

    def landmarks(self) -> list[frozenset[int]]:
        """Return disjunctive landmarks, as sets of units: those of the cuts, and the required sets.

        Landmarks with an action that takes a kitchen item are left out.
        """
        graph, restriction = self.graph, self.problem.restriction
        landmarks = [frozenset(cut.members) for cut in self.cuts.cuts if max(cut.members) < graph.units]
        if restriction is not None:
            size = len(self.problem.network.objects)
            landmarks += [frozenset(graph.makers[size + n]) for n in range(len(restriction.required))]
        return landmarks

    def achievers_for(self, units: Iterable[int]) -> set[int]:
        """Return the achievers of the goals and of the preconditions of some units."""
        graph, kitchen = self.graph, self.problem.kitchen
        needed = {o for unit in units for o in graph.needs[unit] if o not in kitchen}
        return {achiever for o in needed.union(graph.goals) for achiever in graph.makers[o]}

    def rival_achievers(self, units: Iterable[int]) -> set[int]:
        """Return all achievers of the objects that some units achieve, including these units."""
        graph, kitchen = self.graph, self.problem.kitchen
        achieved = {o for unit in units for o in graph.gives[unit] if o not in kitchen}
        return {achiever for o in achieved for achiever in graph.makers[o]}

    def units_of_numbers(self, numbers: Iterable[int]) -> set[int]:
        """Return the ids of units, given by public numbers.

        Units that are removed or of other networks are left out.
        """
        network, restriction = self.problem.network, self.problem.restriction
        units = {unit for number in numbers if (unit := network.unit_of_number(number)) is not None}
        return {unit for unit in units if restriction is None or not restriction.removed(unit)}

    def with_only_achievers(self, units: Iterable[int], max_units: int) -> set[int]:
        """Return units with the only achievers of their preconditions added, transitively.

        Stops at about ``max_units`` units.
        """
        graph, kitchen = self.graph, self.problem.kitchen
        closed, waiting = set(units), list(units)
        while waiting and len(closed) < max_units:
            for o in graph.needs[waiting.pop()]:
                if o not in kitchen and len(graph.makers[o]) == 1:
                    [achiever] = graph.makers[o]
                    if achiever not in closed:
                        closed.add(achiever)
                        waiting.append(achiever)
        return closed

    def total(self, units: Iterable[int]) -> int:
        """Return the cost of a tree, with the kitchen items that it takes if an objective counts these."""
        return sum(map(self.costs, self.actions(units)))

    def actions(self, units: Iterable[int]) -> set[int]:
        """Return the actions of a tree: its units and, if an objective counts items, those that take them."""
        tree = set(units)
        if self.graph.start:
            return tree
        needed = {o for unit in tree for o in self.problem.needs[unit]}
        return tree | {self.graph.units + o for o in needed & self.problem.kitchen}

    def nearest_units(self, min_units: int) -> frozenset[int]:
        """Return the units nearest to the goals by reduced cost: at least ``min_units``, or all."""
        return self._units(
            neighbourhood(
                self.graph,
                self.remaining,
                reduced_costs_of(self.costs, self.cuts),
                math.inf,
                enough=min_units,
            )
        )

    def all_units(self) -> frozenset[int]:
        """Return all units that a tree of any cost can have."""
        if self.redundant:
            return self._units(self._runnable_actions(self._all_actions()))
        cone, _ = self.graph.cone()
        relevant, _ = self.graph.cone(self._runnable_actions(cone))
        return self._units(relevant)

    def units_within(self, limit: int, expired: Callable[[], bool]) -> frozenset[int]:
        """Return a superset of the units of trees that cost up to ``limit``; a larger one if time is up."""
        return self._units(self.actions_within(limit, expired))

    def actions_within(self, limit: int, expired: Callable[[], bool]) -> Collection[int]:
        """Return a superset of the actions of trees that cost up to ``limit``; a larger one where time is up.

        Let the gap be ``limit`` minus the bound of the cuts. The reduced costs of a tree add up to at most
        the gap. So an action is excluded if its derivation costs more than the gap. In an irredundant tree,
        the path from the action to a goal counts, too. New cuts are then found among the remaining actions,
        as long as that excludes many.

        Raises ``KeyboardInterrupt`` where the search for cuts is interrupted.
        """
        graph, costs, cuts = self.graph, self.costs, self.cuts
        remaining: Collection[int] = self._all_actions() if self.redundant else self.remaining
        while True:
            gap = limit - cuts.bound + costs.doubt
            if gap < 0:
                return ()
            reduced_cost = reduced_costs_of(costs, cuts)
            before = len(remaining)
            if self.redundant:
                h_actions = compute_h_values(graph, remaining, reduced_cost, h_add=False).h_actions
                remaining = {action for action, h_action in h_actions.items() if h_action <= gap}
            else:
                remaining = reduced_cost_fixing(graph, remaining, reduced_cost, gap, expired)
            if len(remaining) >= tuning.PRESOLVE.worthwhile_share * before or expired():
                break
            candidates = remaining
            cuts = landmark_cuts(
                graph,
                graph.goals,
                candidates,
                costs,
                compute_h_values(graph, candidates, costs, h_add=False).h_objects,
                expired,
                lambda reduced_cost, candidates=candidates: (
                    compute_h_values(graph, candidates, reduced_cost, h_add=False).h_objects
                ),  # type: ignore[misc]
            )
            if cuts.interrupted:
                raise KeyboardInterrupt
            if cuts.hopeless:
                return ()
        return remaining

    def _all_actions(self) -> list[int]:
        """Return all actions that a tree may have: units that are not removed, and the taking of items."""
        units, restriction = self.graph.units, self.problem.restriction
        actions = (
            range(units) if restriction is None else [u for u in range(units) if not restriction.removed(u)]
        )
        counted = not self.graph.start
        return [*actions, *(units + o for o in self.problem.kitchen if counted)]

    def _runnable_actions(self, actions: Collection[int]) -> Collection[int]:
        """Return the given actions that can run, if only these are allowed.

        All costs count as 0, since not every action has a known cost.
        """
        return compute_h_values(self.graph, actions, lambda _: 0, h_add=False).h_actions

    def _units(self, actions: Iterable[int]) -> frozenset[int]:
        """Return the units among actions."""
        return frozenset(a for a in actions if a < self.graph.units)
