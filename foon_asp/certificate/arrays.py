"""A problem and its objectives as the plain arrays that bounds are computed on."""

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cache, cached_property

from foon_asp.bounds.exact_optimum import Limit
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lexicographic import Lexicographic, Vector
from foon_asp.bounds.lower_bound import Cases
from foon_asp.certificate.coverage import Coverage
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.proof import ruled, verify


class Arrays:
    """What is asked of a problem, in numbers: units are actions, and taking a kitchen item may be one.

    Where ``kitchen`` is an objective, nothing is at hand from the start, and each item is given by an
    action of its own that needs nothing and costs 1: the action's number is ``items[k]`` for item ``k``.
    Elsewhere ``items`` is empty. What the covered constraints add comes last: nodes, and steps that are
    actions and cost nothing. ``forbidden`` are the units that they rule out, and ``limits`` what they limit.
    Without objectives, everything costs nothing.
    """

    def __init__(self, problem: Problem, objectives: Sequence[Objective], covered: Coverage) -> None:
        network = problem.network
        self.problem, self.objectives = problem, tuple(objectives)
        self.rates = sorted({r for r in self._rates() if r != 1}) if Objective.SUCCESS in objectives else []
        self.order = Lexicographic([self.rates if multiplies(o) else None for o in objectives] or [None])
        self.ruled = covered.ruled(problem)
        self._own = covered.limits
        self._of_rules = len(covered.rules)  # the number of the first limit beyond those of the rules
        for limit in covered.limits.known if covered.limits else ():
            self._admit(limit)
        self.goals = [goal for goal in problem.goals if goal not in problem.kitchen] + self.ruled.goals
        self.forbidden = self.ruled.removed
        cost = cache(self._cost)  # many units cost the same
        self.costs = [cost(*self._measures(unit)) for unit in range(len(network))]
        needs: list[Sequence[int]] = list(problem.needs)
        gives: list[Sequence[int]] = list(problem.gives)
        self.items: dict[int, int] = {}
        if any(objective.row.item for objective in objectives):
            kitchen = sorted(problem.kitchen)
            self.items = {o: len(network) + place for place, o in enumerate(kitchen)}
            gives = [[o for o in given if o not in problem.kitchen] for given in gives]
            needs += [()] * len(kitchen)
            gives += [(o,) for o in kitchen]
            taking = tuple(Fraction(o.row.item) for o in objectives for _ in range(self.parts(o)))
            self.costs += [taking] * len(kitchen)
        for unit, nodes in self.ruled.needs.items():
            needs[unit] = (*needs[unit], *nodes)
        for unit, nodes in self.ruled.gives.items():
            gives[unit] = (*gives[unit], *nodes)
        self._steps = {step: len(needs) + place for place, step in enumerate(self.ruled.steps)}
        for asked, node in self.ruled.steps.values():
            needs.append(asked)
            gives.append((node,))
        self.costs += [self.order.zero] * len(self._steps)
        start = () if self.items else sorted(problem.kitchen)
        self.graph = Hypergraph(len(network.objects) + len(self.ruled.makers), needs, gives, start)

    @property
    def limits(self) -> list[Limit]:
        """What the constraints limit: how much each action takes of it, and how much there is."""
        return [
            ({self._steps.get(member, member): amount for member, amount in amounts.items()}, most)
            for amounts, most in self.ruled.limits.values()
        ]

    @cached_property
    def multiples(self) -> list[Fraction]:
        """By coordinate what all costs are multiples of; 0 where that is not known, or not stated briefly."""
        found: list[Fraction] = []
        every = set(self.costs)
        for objective in self.objectives:
            known = not multiplies(objective) and objective not in self.problem.measures
            for place in range(len(found), len(found) + self.parts(objective)):
                costs = {cost[place] for cost in every} if known else ()
                below = math.lcm(*(cost.denominator for cost in costs))
                found.append(Fraction(math.gcd(*(int(cost * below) for cost in costs)), below))
        return found

    def multiple(self, place: int) -> dict[str, str]:
        """State what all costs are multiples of at a coordinate."""
        coordinates = [str(objective) for objective in self.objectives for _ in range(self.parts(objective))]
        return {coordinates[place]: written(self.multiples[place])}

    def _admit(self, limit: Limit) -> None:
        """Number a limit of rules of the user's own."""
        self.ruled.limits[self._of_rules + len(self.own_limits)] = ruled.Limit(*limit)

    def exceeded(self, derivation: frozenset[int]) -> Limit | None:
        """Return a limit that a derivation exceeds by rules of the user's own."""
        limit = self._own and self._own.exceeded(self._units(derivation))
        if limit:
            self._admit(limit)
        return limit or None

    @property
    def asks(self) -> bool:
        """Whether rules of the user's own are asked what derivations exceed."""
        return self._own is not None

    @property
    def own_limits(self) -> dict[int, Limit]:
        """The limits of rules of the user's own that are known, by their numbers."""
        return {n: (each.amounts, each.most) for n, each in self.ruled.limits.items() if n >= self._of_rules}

    def bars(self, used: frozenset[int], without: frozenset[int]) -> dict[int, frozenset[int]]:
        """Return by constraint the units that no tree has which uses some actions and none of others."""
        return self.ruled.bars(self._units(used), without)

    def breaking(self, derivation: frozenset[int]) -> list[int]:
        """Return as few units of a derivation as break a constraint, first what the others bar."""
        chosen = self._units(derivation)
        for barred in self.ruled.barred.values():
            if broken := chosen & barred(chosen, self.forbidden):
                for unit in sorted(chosen):
                    fewer = chosen - {unit}
                    if found := fewer & barred(fewer, self.forbidden):
                        chosen, broken = fewer, found
                return [*broken, *(chosen - broken)]
        return []

    def _units(self, actions: frozenset[int]) -> frozenset[int]:
        return frozenset(action for action in actions if action < len(self.problem.network))

    def parts(self, objective: Objective) -> int:
        """Return the number of coordinates that an objective has in a cost."""
        return len(self.rates) if multiplies(objective) else 1

    def actions(self, units: Iterable[int]) -> list[int]:
        """Return the actions of a tree: units, the taking of the kitchen items that they need, and steps."""
        units = list(units)
        needed = {o for unit in units for o in self.problem.needs[unit]}
        steps = self.ruled.used(frozenset(units)).difference(units)
        taking = (action for o, action in self.items.items() if o in needed)
        return [*units, *taking, *map(self._steps.__getitem__, sorted(steps))]

    def cases(self, cases: Cases) -> Cases:
        """Return cases of an answer by the numbers of actions here, as far as these are known.

        There, the taking of an item is numbered by the object, after all units.
        """
        if cases is None:
            return None
        action, without, using = cases
        units = len(self.problem.network)
        here = action if action < units else self.items.get(action - units)
        return None if here is None else (here, self.cases(without), self.cases(using))

    def stated(self, vector: Sequence[Fraction]) -> list[object]:
        """Write a cost or weight as certificates do, one part an objective; raises like :func:`written`."""
        if not self.objectives:
            return [written(vector[0])]
        parts: list[object] = []
        place = 0
        for objective in self.objectives:
            values = vector[place : place + self.parts(objective)]
            place += len(values)
            if multiplies(objective):
                parts.append({str(r): written(e) for r, e in zip(self.rates, values, strict=True) if e})
            else:
                parts.append(written(values[0]))
        return parts

    def member(self, action: int) -> dict[str, int]:
        """Name an action as certificates do, by ids in the whole network."""
        network = self.problem.network
        if action < len(network):
            return {"unit": network.unit_number(action)}
        first = len(self.graph.needs) - len(self._steps)
        if action >= first:
            return {"step": action - first}
        return {"item": network.object_number(sorted(self.items)[action - len(network)])}

    def _rates(self) -> Iterable[Fraction]:
        return map(self.problem.rate, range(len(self.problem.network)))

    def _measures(self, unit: int) -> Iterator[Fraction | int | None]:
        """Yield what the cost of a unit is made of: its rate, where rates count, and its counts."""
        yield self.problem.rate(unit) if self.rates else None
        for objective in self.objectives:
            if not multiplies(objective):
                yield self.problem.figure(objective, unit)

    def _cost(self, rate: Fraction | None, *counts: int | Fraction) -> Vector:
        cost: list[Fraction] = []
        left = iter(counts)
        for objective in self.objectives:
            if multiplies(objective):
                cost += [Fraction(r == rate) for r in self.rates]
            else:
                cost.append(Fraction(next(left)))
        return tuple(cost) or self.order.zero


def written(number: Fraction) -> str:
    """Write a fraction as certificates do; raises :class:`LimitError` for one that is too long."""
    try:
        return str(number)
    except ValueError:  # Python writes no whole number of more than 4,300 digits
        raise verify.LimitError("a fraction has more digits than are written") from None
