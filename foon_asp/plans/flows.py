"""Preconditions, consumption and add effects of the units of a question, on plain numbers."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from foon_asp.plans.conditions import Remainder, Supply
from foon_asp.plans.tuning import PLANS
from foon_asp.problem import Problem


@dataclass(frozen=True)
class Flows:
    """Actions, numbered from 0, with preconditions and effects on copies of objects.

    ``asks``: for each action, the copies of objects that have to exist.
    ``uses``: for each action, the copies that an execution consumes.
    ``adds``: for each action, the copies that an execution makes.
    ``items``: for each action, the preconditions that never run out. No other attribute has them.
    ``start``: the initial copies by object.
    ``targets``: the copies of goals that have to remain.
    """

    asks: Sequence[Mapping[int, int]]
    uses: Sequence[Mapping[int, int]]
    adds: Sequence[Mapping[int, int]]
    items: Sequence[Sequence[int]]
    start: Mapping[int, int]
    targets: Mapping[int, int]

    def lacking(self, priced: bool) -> tuple[list[list[int]], list[int]]:
        """Return the objects of preconditions, by action, and of targets that initial copies do not satisfy.

        If ``priced``, initial copies have a cost, and satisfy no precondition or target.
        """

        def lacks(copies: Mapping[int, int]) -> list[int]:
            """Return the objects with more copies asked for than initial; with ``priced``, all objects."""
            return [o for o, n in copies.items() if priced or n > self.start.get(o, 0)]

        return list(map(lacks, self.asks)), lacks(self.targets)

    def balances(self) -> Iterator[tuple[int, dict[int, int], int]]:
        """Yield the rows of the state equation: an object, its change by each action, and its target.

        Objects without target that no action reduces are omitted, since their row always holds.
        """
        changes: dict[int, dict[int, int]] = {o: {} for o in (*self.achievers, *self.targets)}
        for action, (uses, adds) in enumerate(zip(self.uses, self.adds, strict=True)):
            for o, n in adds.items():
                changes[o][action] = n
            for o, n in uses.items():
                change = changes.setdefault(o, {})
                change[action] = change.get(action, 0) - n
        for o, change in changes.items():
            if o in self.targets or any(effect < 0 for effect in change.values()):
                yield o, change, self.targets.get(o, 0)

    @property
    def supplies(self) -> Iterator[Supply]:
        """The supplies: one for each action and each object of which the action asks for several copies."""
        for action, preconditions in enumerate(self.asks):
            for o, n in preconditions.items():
                if n > 1:
                    yield Supply(o, action, n)

    @property
    def remainders(self) -> Iterator[Remainder]:
        """The remainders of objects.

        An object has remainders if every action that asks for it leaves more copies than its target. Each of
        these actions has a remainder of the object. ``copies`` is the least number of copies that any of them
        leaves.
        """
        remaining_by_object: dict[int, dict[int, int]] = {}
        for action, preconditions in enumerate(self.asks):
            for o, n in preconditions.items():
                remaining = n - self.uses[action].get(o, 0) + self.adds[action].get(o, 0)
                remaining_by_object.setdefault(o, {})[action] = remaining
        for o, by_action in remaining_by_object.items():
            copies = min(by_action.values())
            if copies > self.targets.get(o, 0):
                yield from (Remainder(o, action, copies) for action in by_action)

    def copy_changes(self, condition: Supply | Remainder) -> dict[int, int]:
        """Return by how much each action changes the copies that a condition counts.

        A supply counts the copies that other actions add. A remainder counts the net effects of all actions.
        Actions without such a change are omitted.
        """
        o, adds = condition.object, self.adds
        if isinstance(condition, Supply):
            return {a: adds[a][o] for a in self.achievers.get(o, ()) if a != condition.action}
        changes = {a: adds[a].get(o, 0) - uses.get(o, 0) for a, uses in enumerate(self.uses)}
        return {a: n for a, n in changes.items() if n}

    @cached_property
    def roles(self) -> Mapping[int, int]:
        """A number for the role of each object (colour refinement, Weisfeiler & Leman 1968).

        At first, there are two roles: targets and other objects. Actions are of one kind if they consume and
        add objects of the same roles in the same amounts. Objects keep a common role if actions of the same
        kinds consume and add them in the same amounts. This is repeated ``role_depth`` times.
        """
        touched: dict[int, list[tuple[int, int]]] = {o: [] for o in self.targets}
        sides = [
            [*((o, -n) for o, n in uses.items()), *adds.items()]
            for uses, adds in zip(self.uses, self.adds, strict=True)
        ]
        for action, effects in enumerate(sides):
            for o, n in effects:
                touched.setdefault(o, []).append((action, n))
        roles = {o: int(o in self.targets) for o in touched}
        for _ in range(PLANS.role_depth):
            action_kinds = [hash(tuple(sorted((roles[o], n) for o, n in effects))) for effects in sides]
            roles = {
                o: hash((roles[o], *sorted({(action_kinds[action], n) for action, n in by_action})))
                for o, by_action in touched.items()
            }
        return roles

    @cached_property
    def achievers(self) -> dict[int, list[int]]:
        """The actions that add each object; objects that no action adds are omitted."""
        achievers: dict[int, list[int]] = {}
        for action, effects in enumerate(self.adds):
            for o in effects:
                achievers.setdefault(o, []).append(action)
        return achievers


def flows_of(problem: Problem, units: Sequence[int]) -> Flows:
    """Return the preconditions, consumption and add effects of units; action ``i`` is ``units[i]``.

    Object nodes that no unit in ``units`` needs are omitted, except goals. Nodes that never run out are only
    in ``items``.
    """
    needed = {o for unit in units for o in problem.flows[unit].asks}.union(problem.goals)

    def finite(copies: Mapping[int, int]) -> dict[int, int]:
        """Return the copies of nodes that may run out and are needed."""
        return {o: n for o, n in copies.items() if o not in problem.endless and o in needed}

    flows = [problem.flows[unit] for unit in units]
    return Flows(
        [finite(flow.asks) for flow in flows],
        [finite(flow.uses) for flow in flows],
        [finite(flow.adds) for flow in flows],
        [[o for o in flow.asks if o in problem.endless] for flow in flows],
        {o: problem.stock_of(o) or 0 for o in needed & problem.kitchen - problem.endless},
        {goal: problem.wanted(goal) for goal in problem.goals if goal not in problem.endless},
    )
