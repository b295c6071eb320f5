"""Preconditions, consumption and add effects of the units of a question, on plain numbers."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from foon_asp.problem import Problem


class Flows(NamedTuple):
    """Actions with preconditions and effects on copies of objects, all by number.

    An action can be executed while there is a copy of each of its preconditions ``asks``. It consumes one
    copy of each object of ``uses``, and adds one of each object of ``adds``. ``start`` maps initial objects
    to their numbers of copies. Objects that are not consumable appear nowhere here; ``items`` are the
    preconditions of each action among them. One copy of each of the ``targets`` has to remain.
    """

    asks: Sequence[Sequence[int]]
    uses: Sequence[Sequence[int]]
    adds: Sequence[Sequence[int]]
    items: Sequence[Sequence[int]]
    start: Mapping[int, int]
    targets: Sequence[int]

    @property
    def achievers(self) -> dict[int, list[int]]:
        """The actions that add each object."""
        achievers: dict[int, list[int]] = {}
        for action, effects in enumerate(self.adds):
            for o in effects:
                achievers.setdefault(o, []).append(action)
        return achievers


def flows_of(problem: Problem, units: Sequence[int]) -> Flows:
    """Return the preconditions, consumption and add effects of units, by their index in ``units``.

    Object nodes that only other units need are excluded.
    """
    needed = {o for unit in units for o in problem.flows[unit].asks}.union(problem.goals)

    def finite(ids: Sequence[int]) -> list[int]:
        return [o for o in ids if o not in problem.endless and o in needed]

    flows = [problem.flows[unit] for unit in units]
    return Flows(
        [finite(flow.asks) for flow in flows],
        [finite(flow.uses) for flow in flows],
        [finite(flow.adds) for flow in flows],
        [[o for o in flow.asks if o in problem.endless] for flow in flows],
        {o: problem.stock_of(o) or 0 for o in needed & problem.kitchen - problem.endless},
        [goal for goal in problem.goals if goal not in problem.endless],
    )
