"""What trees up to a cost can have: a question made small for rules that decide which trees count."""

import math
from collections.abc import Callable, Collection, Container, Iterable
from dataclasses import dataclass

from foon_asp.bounds.landmark_cuts import Cuts, landmark_cuts
from foon_asp.problem import Problem
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.exact_costs import ExactCosts
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.near import near
from foon_asp.reduce.within_reach import within_reach

_ROUNDS = 6  # of cuts and what they leave


@dataclass(frozen=True, eq=False, repr=False)
class Wide:
    """A question with cuts that hold for every tree, before anything was left out.

    ``left`` are the actions that the cuts are about. With ``spare``, trees may have units that lead to no
    goal, which rules can ask for; ``costs`` are then those of all actions.
    """

    problem: Problem
    graph: Graph
    left: Collection[int]
    costs: ExactCosts
    cuts: Cuts
    spare: bool

    def landmarks(self) -> list[frozenset[int]]:
        """Return sets of units of each of which every tree has one: those of the cuts, and those required."""
        graph, restriction = self.graph, self.problem.restriction
        found = [frozenset(cut.members) for cut in self.cuts.cuts if max(cut.members) < graph.units]
        if restriction is not None:
            size = len(self.problem.network.objects)
            found += [frozenset(graph.makers[size + n]) for n in range(len(restriction.required))]
        return found

    def makers(self, units: Iterable[int]) -> set[int]:
        """Return all units that a tree can have to make the goals and what some units need."""
        graph, kitchen = self.graph, self.problem.kitchen
        needed = {o for unit in units for o in graph.needs[unit] if o not in kitchen}
        return {maker for o in needed.union(graph.goals) for maker in graph.makers[o]}

    def beside(self, units: Iterable[int]) -> set[int]:
        """Return units with all others that make one of the same things."""
        graph, kitchen = self.graph, self.problem.kitchen
        made = {o for unit in units for o in graph.gives[unit] if o not in kitchen}
        return {maker for o in made for maker in graph.makers[o]}

    def left_of(self, numbers: Iterable[int]) -> set[int]:
        """Return the units that there are of some, by number in a network that this one is a part of."""
        network, restriction = self.problem.network, self.problem.restriction
        units = {unit for number in numbers if (unit := network.unit_of_number(number)) is not None}
        return {unit for unit in units if restriction is None or not restriction.removed(unit)}

    def with_only_makers(self, units: Iterable[int], most: int) -> set[int]:
        """Return units with all that they build upon without a choice, or part of it beyond ``most``."""
        graph, kitchen = self.graph, self.problem.kitchen
        found, waiting = set(units), list(units)
        while waiting and len(found) < most:
            for o in graph.needs[waiting.pop()]:
                if o not in kitchen and len(graph.makers[o]) == 1:
                    [maker] = graph.makers[o]
                    if maker not in found:
                        found.add(maker)
                        waiting.append(maker)
        return found

    def total(self, units: Iterable[int]) -> int:
        """Return what a tree costs, with the items that it takes where these are counted."""
        return sum(map(self.costs, self.actions(units)))

    def actions(self, units: Iterable[int]) -> set[int]:
        """Return the units of a tree with the taking of the items that it needs, where these are counted."""
        tree = set(units)
        if self.graph.start:
            return tree
        needed = {o for unit in tree for o in self.problem.needs[unit]}
        return tree | {self.graph.units + o for o in needed & self.problem.kitchen}

    def nearest(self, most: int) -> frozenset[int]:
        """Return at least so many units, those nearest to the goals by what cuts leave, or all."""
        return self._units(near(self.graph, self.left, rests(self.costs, self.cuts), math.inf, most=most))

    def everything(self) -> frozenset[int]:
        """Return all units that a tree can have, whatever it costs."""
        if self.spare:
            return self._units(self._able(self._all()))
        cone, _ = self.graph.cone()
        left, _ = self.graph.cone(self._able(cone))
        return self._units(left)

    def within(self, limit: int, expired: Callable[[], bool]) -> frozenset[int]:
        """Return the units that a tree of costs up to a limit can have, and maybe more where time is up."""
        return self._units(self.actions_within(limit, expired))

    def actions_within(self, limit: int, expired: Callable[[], bool]) -> Collection[int]:
        """Return the actions that a tree of costs up to a limit can have, and maybe more where time is up.

        What the cuts leave of the costs of a tree is at most its cost less their bound. Where no unit is
        spare, it is on a way from each unit to a goal; else it is at least in what the unit itself takes.
        All trees up to the limit are among the units left, so cuts can be found anew among these.
        """
        graph, costs, cuts = self.graph, self.costs, self.cuts
        left: Collection[int] = self._all() if self.spare else self.left
        for _ in range(_ROUNDS):
            gap = limit - cuts.bound + costs.doubt
            if gap < 0:
                return ()
            rest = rests(costs, cuts)
            before = len(left)
            if self.spare:
                made = derive(graph, left, rest, added=False).before
                left = {action for action, least in made.items() if least <= gap}
            else:
                left = dear_left_out(graph, left, rest, gap, expired)
            if len(left) == before or expired():
                break
            among = left
            cuts = landmark_cuts(
                graph,
                graph.goals,
                among,
                costs,
                derive(graph, among, costs, added=False).cost,
                expired,
                lambda rest, among=among: derive(graph, among, rest, added=False).cost,  # type: ignore[misc]
            )
            if cuts.interrupted:
                raise KeyboardInterrupt
            if cuts.hopeless:
                return ()
        return left

    def _all(self) -> list[int]:
        """Return all actions that a tree may have."""
        units, restriction = self.graph.units, self.problem.restriction
        actions = (
            range(units) if restriction is None else [u for u in range(units) if not restriction.removed(u)]
        )
        counted = not self.graph.start
        return [*actions, *(units + o for o in self.problem.kitchen if counted)]

    def _able(self, actions: Collection[int]) -> Collection[int]:
        """Return those that can run; what cannot be made has no costs, and none are asked for."""
        return derive(self.graph, actions, lambda _: 0, added=False).before

    def _units(self, actions: Iterable[int]) -> frozenset[int]:
        return frozenset(a for a in actions if a < self.graph.units)


def rests(costs: ExactCosts, cuts: Cuts) -> Callable[[int], int]:
    """Return what cuts leave of the costs of actions."""
    left = cuts.reduced_costs
    return lambda action: left[action] if action in left else costs(action)


def dear_left_out(
    graph: Graph,
    allowed: Container[int],
    rest: Callable[[int], int],
    limit: int,
    expired: Callable[[], bool],
) -> set[int]:
    """Return the allowed actions that trees without spare units, of rests up to a limit, can have."""
    left = near(graph, allowed, rest, limit, within=within_reach(graph, allowed, rest))
    while not expired():
        made = derive(graph, left, rest, added=False)
        nearer = near(graph, left, rest, limit, made.before)
        if len(nearer) == len(left):
            break
        left = nearer
    return left
