"""A problem and its objectives as plain arrays, on which bounds are computed."""

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cache, cached_property

from foon_asp.certificate.coverage import Coverage
from foon_asp.hypergraph.exact_optimum import Limit
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector
from foon_asp.hypergraph.proof_tree import Cases
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.proof import compiled_rules, verifier


class Arrays:
    """A question about trees in numbers: units are actions, and taking a kitchen item may be an action.

    With the objective ``kitchen``, no node is initial. Each item ``k`` then has an additional achiever
    without preconditions and of cost 1: the action ``items[k]``. Otherwise, ``items`` is empty. The nodes and
    steps of covered constraints come last; a step is an action of cost 0. ``forbidden`` are the units that
    constraints remove, and ``limits`` are the limits of constraints. Without objectives, all costs are 0.
    """

    def __init__(self, problem: Problem, objectives: Sequence[Objective], covered: Coverage) -> None:
        """Number the actions, compute their costs, and compile the covered rules into the graph."""
        network = problem.network
        self.problem, self.objectives = problem, tuple(objectives)
        self.rates = sorted({r for r in self._rates() if r != 1}) if Objective.SUCCESS in objectives else []
        self.order = Lexicographic([self.rates if multiplies(o) else None for o in objectives] or [None])
        self.ruled = covered.ruled(problem)
        self._own = covered.limits
        self._of_rules = len(covered.rules)  # the number of the first limit beyond those of the rules
        for limit in covered.limits.found_limits if covered.limits else ():
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
            self.items = {o: len(network) + index for index, o in enumerate(kitchen)}
            gives = [[o for o in effects if o not in problem.kitchen] for effects in gives]
            needs += [()] * len(kitchen)
            gives += [(o,) for o in kitchen]
            taking = tuple(Fraction(o.row.item) for o in objectives for _ in range(self.parts(o)))
            self.costs += [taking] * len(kitchen)
        for unit, nodes in self.ruled.needs.items():
            needs[unit] = (*needs[unit], *nodes)
        for unit, nodes in self.ruled.gives.items():
            gives[unit] = (*gives[unit], *nodes)
        self._steps = {step: len(needs) + index for index, step in enumerate(self.ruled.steps)}
        for preconditions, node in self.ruled.steps.values():
            needs.append(preconditions)
            gives.append((node,))
        self.costs += [self.order.zero] * len(self._steps)
        start = () if self.items else sorted(problem.kitchen)
        self.graph = Hypergraph(len(network.objects) + len(self.ruled.makers), needs, gives, start)

    @property
    def limits(self) -> list[Limit]:
        """The limits of constraints: the amount of each action, and the greatest sum."""
        return [
            ({self._steps.get(member, member): amount for member, amount in amounts.items()}, max_amount)
            for amounts, max_amount in self.ruled.limits.values()
        ]

    @cached_property
    def multiples(self) -> list[Fraction]:
        """For each coordinate the greatest common divisor of all costs; 0 for rates and for measures."""
        multiples: list[Fraction] = []
        all_costs = set(self.costs)
        for objective in self.objectives:
            additive = not multiplies(objective) and objective not in self.problem.measures
            for i in range(len(multiples), len(multiples) + self.parts(objective)):
                costs = {cost[i] for cost in all_costs} if additive else ()
                below = math.lcm(*(cost.denominator for cost in costs))
                multiples.append(Fraction(math.gcd(*(int(cost * below) for cost in costs)), below))
        return multiples

    def multiple(self, coordinate: int) -> dict[str, str]:
        """Return the JSON of the common divisor of all costs at a coordinate."""
        coordinates = [str(objective) for objective in self.objectives for _ in range(self.parts(objective))]
        return {coordinates[coordinate]: written(self.multiples[coordinate])}

    def _admit(self, limit: Limit) -> None:
        """Add a limit by user rules."""
        self.ruled.limits[self._of_rules + len(self.own_limits)] = compiled_rules.Limit(*limit)

    def exceeded(self, derivation: frozenset[int]) -> Limit | None:
        """Return a limit by user rules that a derivation exceeds, and add it; ``None`` without one."""
        limit = self._own and self._own.exceeded(self._units(derivation))
        if limit:
            self._admit(limit)
        return limit or None

    @property
    def asks(self) -> bool:
        """Whether the proof has to check its derivations against limits by user rules."""
        return self._own is not None

    @property
    def own_limits(self) -> dict[int, Limit]:
        """The limits by user rules found so far, by their numbers."""
        return {
            n: (limit.amounts, limit.max_sum) for n, limit in self.ruled.limits.items() if n >= self._of_rules
        }

    def bars(self, used: frozenset[int], without: frozenset[int]) -> dict[int, frozenset[int]]:
        """Return the barred units of each constraint, by its number.

        No tree with all used actions and none of ``without`` has a barred unit.
        """
        return self.ruled.barred_units(self._units(used), without)

    def breaking(self, derivation: frozenset[int]) -> list[int]:
        """Return units of a derivation that together break a constraint, barred units first; else none.

        The set is irreducible: the constraint bars no unit of a smaller set.
        """
        chosen = self._units(derivation)
        for barred in self.ruled.barred.values():
            if broken := chosen & barred(chosen, self.forbidden):
                for unit in sorted(chosen):
                    fewer = chosen - {unit}
                    if still_broken := fewer & barred(fewer, self.forbidden):
                        chosen, broken = fewer, still_broken
                return [*broken, *(chosen - broken)]
        return []

    def _units(self, actions: frozenset[int]) -> frozenset[int]:
        return frozenset(action for action in actions if action < len(self.problem.network))

    def parts(self, objective: Objective) -> int:
        """Return how many coordinates of a cost vector belong to an objective."""
        return len(self.rates) if multiplies(objective) else 1

    def actions(self, units: Iterable[int]) -> list[int]:
        """Return the actions of a tree: its units, its steps, and the taking of needed kitchen items."""
        units = list(units)
        needed = {o for unit in units for o in self.problem.needs[unit]}
        steps = self.ruled.units_and_steps(frozenset(units)).difference(units)
        taking = (action for o, action in self.items.items() if o in needed)
        return [*units, *taking, *map(self._steps.__getitem__, sorted(steps))]

    def cases(self, cases: Cases) -> Cases:
        """Return the branching cases of an answer, renumbered as actions; ``None`` for unknown cases.

        In an answer, the action that takes an item has the number of units plus the item's id.
        """
        if cases is None:
            return None
        action, without, using = cases
        units = len(self.problem.network)
        own_action = action if action < units else self.items.get(action - units)
        return None if own_action is None else (own_action, self.cases(without), self.cases(using))

    def stated(self, vector: Sequence[Fraction]) -> list[object]:
        """Return the JSON of a cost or weight, one part an objective; raises like :func:`written`."""
        if not self.objectives:
            return [written(vector[0])]
        parts: list[object] = []
        begin = 0
        for objective in self.objectives:
            values = vector[begin : begin + self.parts(objective)]
            begin += len(values)
            if multiplies(objective):
                parts.append({str(r): written(e) for r, e in zip(self.rates, values, strict=True) if e})
            else:
                parts.append(written(values[0]))
        return parts

    def member(self, action: int) -> dict[str, int]:
        """Return the JSON of an action, by ids in the whole network."""
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
        """Yield the rate of a unit, ``None`` where rates do not count, and its additive costs."""
        yield self.problem.rate(unit) if self.rates else None
        for objective in self.objectives:
            if not multiplies(objective):
                yield self.problem.figure(objective, unit)

    def _cost(self, rate: Fraction | None, *counts: int | Fraction) -> Vector:
        """Return a cost as a vector, from the rate and the other costs of an action."""
        cost: list[Fraction] = []
        remaining = iter(counts)
        for objective in self.objectives:
            if multiplies(objective):
                cost += [Fraction(r == rate) for r in self.rates]
            else:
                cost.append(Fraction(next(remaining)))
        return tuple(cost) or self.order.zero


def written(number: Fraction) -> str:
    """Return a fraction as text; raises :class:`LimitError` for one that is too long."""
    try:
        return str(number)
    except ValueError:  # Python writes no whole number of more than 4,300 digits
        raise verifier.LimitError("a fraction has more digits than are written") from None
