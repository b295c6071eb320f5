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
    """A question before any reduction, with landmark cuts that hold for all of its trees.

    ``remaining``: the actions over which the cuts were found.
    ``redundant``: whether trees may have units that lead to no goal, since rules can require such units. Then
    ``costs`` cover all actions.
    """

    problem: Problem
    graph: GoalGraph
    remaining: Collection[int]
    costs: ExactCosts
    cuts: Cuts
    redundant: bool

    def landmarks(self) -> list[frozenset[int]]:
        """Return disjunctive landmarks, as sets of unit ids: landmarks of the cuts, then the required sets.

        A landmark is left out if it has an action that takes a kitchen item.
        """
        graph, restriction = self.graph, self.problem.restriction
        landmarks = [frozenset(cut.members) for cut in self.cuts.cuts if max(cut.members) < graph.units]
        if restriction is not None:
            size = len(self.problem.network.objects)
            landmarks += [frozenset(graph.makers[size + n]) for n in range(len(restriction.required))]
        return landmarks

    def achievers_for(self, units: Iterable[int]) -> set[int]:
        """Return the achievers of the goals and of some units' preconditions.

        Kitchen items among the preconditions are skipped.
        """
        graph, kitchen = self.graph, self.problem.kitchen
        needed = {o for unit in units for o in graph.needs[unit] if o not in kitchen}
        return {achiever for o in needed.union(graph.goals) for achiever in graph.makers[o]}

    def rival_achievers(self, units: Iterable[int]) -> set[int]:
        """Return all achievers of the objects that some units achieve, including these units.

        Kitchen items do not count as objects. So a unit that achieves nothing else may be missing.
        """
        graph, kitchen = self.graph, self.problem.kitchen
        achieved = {o for unit in units for o in graph.gives[unit] if o not in kitchen}
        return {achiever for o in achieved for achiever in graph.makers[o]}

    def units_of_numbers(self, numbers: Iterable[int]) -> set[int]:
        """Return the ids of the units with these public numbers.

        Numbers of removed units, and numbers that no unit of the network has, are left out.
        """
        network, restriction = self.problem.network, self.problem.restriction
        units = {unit for number in numbers if (unit := network.unit_of_number(number)) is not None}
        return {unit for unit in units if restriction is None or not restriction.removed(unit)}

    def with_only_achievers(self, units: Iterable[int], max_units: int) -> set[int]:
        """Return these units together with the units without which they cannot be executed.

        If a precondition has only one achiever, this achiever is added, and its preconditions are looked at
        as well. Kitchen items do not count as preconditions. Stops at about ``max_units`` units.
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

    def tree_cost(self, units: Iterable[int]) -> int:
        """Return the cost of the tree with ``units``: the sum of the costs of its :meth:`tree_actions`."""
        return sum(map(self.costs, self.tree_actions(units)))

    def tree_actions(self, units: Iterable[int]) -> set[int]:
        """Return the actions of the tree with ``units``.

        They are the units themselves. If an objective counts kitchen items, the actions that take the needed
        items are added.
        """
        tree = set(units)
        if self.graph.start:
            return tree
        needed = {o for unit in tree for o in self.problem.needs[unit]}
        return tree | {self.graph.units + o for o in needed & self.problem.kitchen}

    def nearest_units(self, min_units: int) -> frozenset[int]:
        """Return units among the ``remaining`` actions: those nearest to the goals by reduced cost.

        The search ends when ``min_units`` actions are found. These may include actions that take kitchen
        items.
        """
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
        """Return all units that a tree of any cost can have.

        They are the units that can run. If trees may not be redundant, units that lead to no goal are left
        out.
        """
        if self.redundant:
            return self._units(self._runnable_actions(self._all_actions()))
        cone, _ = self.graph.cone()
        relevant, _ = self.graph.cone(self._runnable_actions(cone))
        return self._units(relevant)

    def units_within(self, limit: int, expired: Callable[[], bool]) -> frozenset[int]:
        """Return the units among :meth:`actions_within`."""
        return self._units(self.actions_within(limit, expired))

    def actions_within(self, limit: int, expired: Callable[[], bool]) -> Collection[int]:
        """Return a superset of the actions of trees that cost up to ``limit``.

        Let the gap be ``limit`` minus the bound of the cuts. The reduced costs of such a tree add up to at
        most the gap. So an action is excluded if its derivation has a greater reduced cost. If trees may not
        be redundant, the path from the action to a goal is added to the derivation. As long as many actions
        are excluded, new cuts are found over the remaining ones. If time is up, the superset is larger. The
        result is empty if cuts prove that there is no such tree.

        Raises ``KeyboardInterrupt`` if the search for cuts is interrupted.
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
        """Return all actions that a tree may have.

        They are the units that are not removed and, if an objective counts kitchen items, the actions that
        take these.
        """
        units, restriction = self.graph.units, self.problem.restriction
        actions = (
            range(units) if restriction is None else [u for u in range(units) if not restriction.removed(u)]
        )
        counted = not self.graph.start
        return [*actions, *(units + o for o in self.problem.kitchen if counted)]

    def _runnable_actions(self, actions: Collection[int]) -> Collection[int]:
        """Return those of the given actions that can run if no other actions are allowed.

        Costs are not looked at, since not every action has a known cost.
        """
        return compute_h_values(self.graph, actions, lambda _: 0, h_add=False).h_actions

    def _units(self, actions: Iterable[int]) -> frozenset[int]:
        """Return the units among actions."""
        return frozenset(a for a in actions if a < self.graph.units)
