"""A question as opponents get it: units and nodes by number, without what is always at hand."""

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from foon_asp.engines.engine import float_cost
from foon_asp.problem import Objective, Problem, reach, relevant_units

_STEPS = 2**53  # whole numbers that floats hold
SCALE = 10**6  # steps of -ln(rate) to 1, for engines that add whole numbers


@dataclass(frozen=True)
class Instance:
    """Actions that need and give nodes, at a cost each; all nodes have to be made, none is at hand.

    ``units[a]`` is the number that action ``a`` has in the network, ``needs[a]`` and ``gives[a]`` are nodes
    from 0 to ``nodes``, and ``costs[a]`` is a whole number: for ``success`` a rounded logarithm,
    for prices a multiple of them, rounded where that is too large. Actions
    that need what they give are left out as makers of that: such a node is not in ``gives``.
    """

    units: tuple[int, ...]
    needs: tuple[tuple[int, ...], ...]
    gives: tuple[tuple[int, ...], ...]
    costs: tuple[int, ...]
    goals: tuple[int, ...]
    nodes: int

    @cached_property
    def makers(self) -> list[list[int]]:
        """For each node, the actions that give it."""
        found: list[list[int]] = [[] for _ in range(self.nodes)]
        for action, gives in enumerate(self.gives):
            for node in gives:
                found[node].append(action)
        return found

    @cached_property
    def component(self) -> list[int]:
        """For each node, the number of its strongly connected component, from what it is made of upwards."""
        return _components(self)

    @cached_property
    def sizes(self) -> list[int]:
        """For each component, how many nodes it has."""
        sizes = [0] * (1 + max(self.component, default=-1))
        for number in self.component:
            sizes[number] += 1
        return sizes

    def inner(self, action: int, node: int) -> list[int]:
        """Give what an action needs of the component of a node that it gives: there cycles can close."""
        component = self.component
        if self.sizes[component[node]] == 1:
            return []
        return [need for need in self.needs[action] if component[need] == component[node]]

    def executed(self, used: Iterable[int]) -> tuple[list[int], bytearray]:
        """Give the actions among some that execute, starting from nothing, and a mark for each node made."""
        chosen = list(used)
        missing = {action: len(self.needs[action]) for action in chosen}
        waiting: dict[int, list[int]] = {}
        for action in chosen:
            for node in self.needs[action]:
                waiting.setdefault(node, []).append(action)
        made = bytearray(self.nodes)
        ready = [action for action in chosen if not missing[action]]
        order: list[int] = []
        while ready:
            action = ready.pop()
            order.append(action)
            for node in self.gives[action]:
                if not made[node]:
                    made[node] = 1
                    for other in waiting.get(node, ()):
                        missing[other] -= 1
                        if not missing[other]:
                            ready.append(other)
        return order, made

    def tree(self, used: Iterable[int]) -> tuple[int, ...] | None:
        """Give the numbers in the network of the actions that execute, if they make the goals."""
        order, made = self.executed(used)
        if not all(made[goal] for goal in self.goals):
            return None
        return tuple(sorted(self.units[action] for action in order))


def raw_units(problem: Problem) -> tuple[int, ...]:
    """Give what the plain program leaves: units that can be made to run and that the goals can need."""
    return relevant_units(problem, reach(problem))


def instance_of(problem: Problem, units: Sequence[int], objective: Objective) -> Instance:
    """Number the given units of a problem, what they need and what they give; all units must be able to run.

    Raises :class:`ValueError` for ``kitchen``, which is no cost of units.
    """
    if objective is Objective.KITCHEN:
        raise ValueError("what the kitchen gives is no cost of units")
    kitchen = problem.kitchen
    numbers: dict[int, int] = {}
    needs = []
    for unit in units:
        wanted = dict.fromkeys(o for o in problem.needs[unit] if o not in kitchen)
        needs.append(tuple([numbers.setdefault(o, len(numbers)) for o in wanted]))
    goals = tuple(numbers.setdefault(o, len(numbers)) for o in problem.goals if o not in kitchen)
    gives = [
        tuple({numbers[o] for o in problem.gives[unit] if o in numbers}.difference(wanted))
        for unit, wanted in zip(units, needs, strict=True)
    ]
    scale = SCALE if objective is Objective.SUCCESS else 1
    by_motion: dict[str, int] = {}
    costs = []
    whole = {} if objective is Objective.SUCCESS else _whole(problem, units, objective)
    for unit in units:
        if objective is Objective.SUCCESS:
            motion = problem.network.motions[unit]
            if motion not in by_motion:
                by_motion[motion] = round(scale * float_cost(problem, objective, unit))
            costs.append(by_motion[motion])
        else:
            costs.append(whole[unit])
    return Instance(tuple(units), tuple(needs), tuple(gives), tuple(costs), goals, len(numbers))


def _whole(problem: Problem, units: Iterable[int], objective: Objective) -> dict[int, int]:
    """Give what units cost as whole numbers: exactly, or to 2^53 steps of the sum of all."""
    costs = {unit: Fraction(problem.figure(objective, unit)) for unit in units}
    scale = Fraction(math.lcm(*(cost.denominator for cost in costs.values())))
    total = sum(costs.values(), Fraction())
    if total * scale > _STEPS:
        scale = _STEPS / total
    return {unit: round(cost * scale) for unit, cost in costs.items()}


def unfounded(instance: Instance, used: Collection[int]) -> list[frozenset[int]]:
    """Give sets of nodes that used actions make from each other alone, where the goals are not made.

    All are free of nodes that the used actions do make. First the largest, which has a goal in it, then the
    smallest ones, each strongly connected. Empty where the used actions make the goals.
    """
    _, made = instance.executed(used)
    lacking = [goal for goal in instance.goals if not made[goal]]
    if not lacking:
        return []
    makers: dict[int, list[int]] = {}
    for action in used:
        for node in instance.gives[action]:
            makers.setdefault(node, []).append(action)
    reached = dict.fromkeys(lacking)
    stack = list(lacking)
    below: dict[int, list[int]] = {}
    while stack:
        node = stack.pop()
        nexts = {n for action in makers.get(node, ()) for n in instance.needs[action] if not made[n]}
        below[node] = sorted(nexts)
        fresh = [n for n in below[node] if n not in reached]
        reached.update(dict.fromkeys(fresh))
        stack += fresh
    everything = frozenset(node for node in range(instance.nodes) if not made[node])
    return [everything, *_sinks(below)]


def supports(instance: Instance, nodes: Collection[int]) -> list[int]:
    """Give the actions that make one of some nodes and need none of them."""
    within = set(nodes)
    found = {action for node in nodes for action in instance.makers[node]}
    return sorted(a for a in found if within.isdisjoint(instance.needs[a]))


def cuts(instance: Instance, used: Collection[int]) -> list[tuple[list[int], int | None]]:
    """Give what every tree keeps to and the used actions do not: pairs of supports and a user.

    One of the supports has to be used, where the user is; always, where the user is ``None``. Empty where
    the used actions make the goals.
    """
    sets = unfounded(instance, used)
    if not sets:
        return []
    found: list[tuple[list[int], int | None]] = [(supports(instance, sets[0]), None)]
    for nodes in sets[1:]:
        outside = supports(instance, nodes)
        found += [(outside, action) for action in used if not nodes.isdisjoint(instance.needs[action])]
    return found


def _sinks(below: dict[int, list[int]]) -> list[frozenset[int]]:
    """Give the strongly connected sets without a way out."""
    order = list(below)
    places = {node: place for place, node in enumerate(order)}
    component = _tarjan([[places[n] for n in below[node]] for node in order])
    members: dict[int, list[int]] = {}
    leaving = set()
    for place, node in enumerate(order):
        members.setdefault(component[place], []).append(node)
        if any(component[places[n]] != component[place] for n in below[node]):
            leaving.add(component[place])
    return [frozenset(nodes) for number, nodes in members.items() if number not in leaving]


def _components(instance: Instance) -> list[int]:
    below: list[list[int]] = [[] for _ in range(instance.nodes)]
    for needs, gives in zip(instance.needs, instance.gives, strict=True):
        for node in gives:
            below[node] += needs
    return _tarjan(below)


def _tarjan(below: Sequence[Sequence[int]]) -> list[int]:
    """Number the strongly connected components of a graph, those without a way out first."""
    count = len(below)
    index = [-1] * count
    low = [0] * count
    component = [-1] * count
    path: list[int] = []
    next_index = found = 0
    for root in range(count):
        if index[root] >= 0:
            continue
        index[root] = low[root] = next_index
        next_index += 1
        path.append(root)
        work = [(root, iter(below[root]))]
        while work:
            node, rest = work[-1]
            for other in rest:
                if index[other] < 0:
                    index[other] = low[other] = next_index
                    next_index += 1
                    path.append(other)
                    work.append((other, iter(below[other])))
                    break
                if component[other] < 0:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    while True:
                        member = path.pop()
                        component[member] = found
                        if member == node:
                            break
                    found += 1
    return component
