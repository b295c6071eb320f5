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
from foon_asp.proof import compiled_rules
from foon_asp.proof.refusal import CheckLimitError


class Arrays:
    """A question about trees in numbers: units are actions, and taking a kitchen item may be an action.

    With the objective ``kitchen``, no node is initial. Each kitchen item ``k`` then has an additional
    achiever without preconditions and of cost 1: the action ``items[k]``. Otherwise, ``items`` is empty.

    A cost is a vector. It has a *coordinate* for each objective, except that ``success`` has one for each
    rate below 1. Without objectives, all costs are 0.

    Covered constraints may add nodes and steps (:class:`~foon_asp.proof.compiled_rules.CompiledRules`,
    ``ruled``). Added nodes and steps have the last numbers. A step is an action of cost 0. ``forbidden`` are
    the units that constraints remove, and ``limits`` are the limits of constraints. Limits by user rules
    (*own* limits) may be found later and added.
    """

    def __init__(self, problem: Problem, objectives: Sequence[Objective], covered: Coverage) -> None:
        """Number the actions, compute their costs, and compile the covered rules into the graph."""
        network = problem.network
        self.problem, self.objectives = problem, tuple(objectives)
        self.rates = sorted({r for r in self._rates() if r != 1}) if Objective.SUCCESS in objectives else []
        self.order = Lexicographic([self.rates if multiplies(o) else None for o in objectives] or [None])
        self.ruled = covered.compile_rules(problem)
        self._own_limits = covered.limits
        self._first_own_limit = len(covered.rules)  # the number of the first limit beyond those of the rules
        for limit in covered.limits.found_limits if covered.limits else ():
            self._add_own_limit(limit)
        self.goals = [goal for goal in problem.goals if goal not in problem.kitchen] + self.ruled.goals
        self.forbidden = self.ruled.removed
        cost_vector = cache(self._cost_vector)  # many units cost the same
        self.costs = [cost_vector(*self._rate_and_costs(unit)) for unit in range(len(network))]
        needs: list[Sequence[int]] = list(problem.needs)
        gives: list[Sequence[int]] = list(problem.gives)
        self.items: dict[int, int] = {}
        if any(objective.row.item for objective in objectives):
            kitchen = sorted(problem.kitchen)
            self.items = {o: len(network) + index for index, o in enumerate(kitchen)}
            gives = [[o for o in effects if o not in problem.kitchen] for effects in gives]
            needs += [()] * len(kitchen)
            gives += [(o,) for o in kitchen]
            cost_of_taking = tuple(
                Fraction(o.row.item) for o in objectives for _ in range(self.coordinate_count(o))
            )
            self.costs += [cost_of_taking] * len(kitchen)
        for unit, nodes in self.ruled.needs.items():
            needs[unit] = (*needs[unit], *nodes)
        for unit, nodes in self.ruled.gives.items():
            gives[unit] = (*gives[unit], *nodes)
        self._steps = {step: len(needs) + index for index, step in enumerate(self.ruled.steps)}
        for preconditions, node in self.ruled.steps.values():
            needs.append(preconditions)
            gives.append((node,))
        self.costs += [self.order.zero] * len(self._steps)
        initial_nodes = () if self.items else sorted(problem.kitchen)
        self.graph = Hypergraph(len(network.objects) + len(self.ruled.makers), needs, gives, initial_nodes)

    @property
    def limits(self) -> list[Limit]:
        """The limits of constraints: pairs of the amounts by action and the greatest sum."""
        return [
            ({self._steps.get(member, member): amount for member, amount in amounts.items()}, max_amount)
            for amounts, max_amount in self.ruled.limits.values()
        ]

    @cached_property
    def multiples(self) -> list[Fraction]:
        """The greatest common divisor of all costs at each coordinate of a cost; 0 for rates and measures."""
        multiples: list[Fraction] = []
        all_costs = set(self.costs)
        for objective in self.objectives:
            additive = not multiplies(objective) and objective not in self.problem.measures
            for i in range(len(multiples), len(multiples) + self.coordinate_count(objective)):
                costs = {cost[i] for cost in all_costs} if additive else ()
                denominator = math.lcm(*(cost.denominator for cost in costs))
                multiples.append(
                    Fraction(math.gcd(*(int(cost * denominator) for cost in costs)), denominator)
                )
        return multiples

    def multiple_json(self, coordinate: int) -> dict[str, str]:
        """Return the JSON of the common divisor of costs at a coordinate: ``{"units": "1"}``."""
        coordinates = [
            str(objective) for objective in self.objectives for _ in range(self.coordinate_count(objective))
        ]
        return {coordinates[coordinate]: fraction_text(self.multiples[coordinate])}

    def _add_own_limit(self, limit: Limit) -> None:
        """Add a limit by user rules to ``ruled``, under the next number."""
        self.ruled.limits[self._first_own_limit + len(self.own_limits)] = compiled_rules.Limit(*limit)

    def exceeded_limit(self, derivation: frozenset[int]) -> Limit | None:
        """Search for a limit by user rules that a derivation, a set of actions, exceeds.

        Return it after adding it to the limits. Return ``None`` if no limit is exceeded, or if no such limits
        are searched for.
        """
        limit = self._own_limits and self._own_limits.exceeded_limit(self._units_among(derivation))
        if limit:
            self._add_own_limit(limit)
        return limit or None

    @property
    def has_own_limits(self) -> bool:
        """Whether limits by user rules are searched for, so that a proof has to check its derivations."""
        return self._own_limits is not None

    @property
    def own_limits(self) -> dict[int, Limit]:
        """The limits by user rules found so far, by number."""
        return {
            n: (limit.amounts, limit.max_sum)
            for n, limit in self.ruled.limits.items()
            if n >= self._first_own_limit
        }

    def barred_actions(self, used: frozenset[int], without: frozenset[int]) -> dict[int, frozenset[int]]:
        """Return the units that each barring constraint bars, by number of the constraint.

        A tree with all actions ``used`` and none of ``without`` breaks the constraint if it has a barred
        unit.
        """
        return self.ruled.barred_units(self._units_among(used), without)

    def breaking_actions(self, derivation: frozenset[int]) -> list[int]:
        """Return units that together break the first barring constraint that a derivation breaks.

        If it breaks no such constraint, return an empty list. Units that the constraint bars come first. The
        set of units is irreducible: the constraint bars no unit of a smaller set.
        """
        chosen = self._units_among(derivation)
        for barred in self.ruled.barred.values():
            if broken := chosen & barred(chosen, self.forbidden):
                for unit in sorted(chosen):
                    fewer = chosen - {unit}
                    if still_broken := fewer & barred(fewer, self.forbidden):
                        chosen, broken = fewer, still_broken
                return [*broken, *(chosen - broken)]
        return []

    def _units_among(self, actions: frozenset[int]) -> frozenset[int]:
        """Return those of the actions that are units."""
        return frozenset(action for action in actions if action < len(self.problem.network))

    def coordinate_count(self, objective: Objective) -> int:
        """Return how many coordinates of a cost belong to an objective: the number of rates, or 1."""
        return len(self.rates) if multiplies(objective) else 1

    def actions(self, units: Iterable[int]) -> list[int]:
        """Return the actions of a tree: its units, the taking of needed kitchen items, and its steps."""
        units = list(units)
        needed = {o for unit in units for o in self.problem.needs[unit]}
        steps = self.ruled.units_and_steps(frozenset(units)).difference(units)
        taking = (action for o, action in self.items.items() if o in needed)
        return [*units, *taking, *map(self._steps.__getitem__, sorted(steps))]

    def renumber_cases(self, cases: Cases) -> Cases:
        """Return the case split of an answer of a search, with actions as numbered here.

        In an answer, the action that takes an item has the number of units plus the item's id. A split by an
        action that does not exist here is replaced by ``None``, which means no split.
        """
        if cases is None:
            return None
        action, without, using = cases
        unit_count = len(self.problem.network)
        own_action = action if action < unit_count else self.items.get(action - unit_count)
        return (
            None
            if own_action is None
            else (own_action, self.renumber_cases(without), self.renumber_cases(using))
        )

    def vector_json(self, vector: Sequence[Fraction]) -> list[object]:
        """Return the JSON of a cost or weight, with one part for each objective.

        A part is a fraction as text or, for ``success``, the exponents other than 0, by rate. Without
        objectives, it has one fraction. Raises :class:`CheckLimitError` as :func:`fraction_text` does.
        """
        if not self.objectives:
            return [fraction_text(vector[0])]
        parts: list[object] = []
        start = 0
        for objective in self.objectives:
            values = vector[start : start + self.coordinate_count(objective)]
            start += len(values)
            if multiplies(objective):
                parts.append({str(r): fraction_text(e) for r, e in zip(self.rates, values, strict=True) if e})
            else:
                parts.append(fraction_text(values[0]))
        return parts

    def action_json(self, action: int) -> dict[str, int]:
        """Return the JSON of an action, by ids in the whole network: ``{"unit": 7}``.

        The key is ``unit``, ``item`` or ``step``.
        """
        network = self.problem.network
        if action < len(network):
            return {"unit": network.unit_number(action)}
        first_step = len(self.graph.needs) - len(self._steps)
        if action >= first_step:
            return {"step": action - first_step}
        return {"item": network.object_number(sorted(self.items)[action - len(network)])}

    def _rates(self) -> Iterable[Fraction]:
        """Return the rate of each unit, by id."""
        return map(self.problem.rate, range(len(self.problem.network)))

    def _rate_and_costs(self, unit: int) -> Iterator[Fraction | int | None]:
        """Yield the rate of a unit, and then its cost by each objective that adds up costs.

        The rate is ``None`` if no objective multiplies rates, or all rates are 1.
        """
        yield self.problem.rate(unit) if self.rates else None
        for objective in self.objectives:
            if not multiplies(objective):
                yield self.problem.figure(objective, unit)

    def _cost_vector(self, rate: Fraction | None, *additive_costs: int | Fraction) -> Vector:
        """Return the cost vector of a unit from what :meth:`_rate_and_costs` yields."""
        cost: list[Fraction] = []
        remaining_costs = iter(additive_costs)
        for objective in self.objectives:
            if multiplies(objective):
                cost += [Fraction(r == rate) for r in self.rates]
            else:
                cost.append(Fraction(next(remaining_costs)))
        return tuple(cost) or self.order.zero


def fraction_text(number: Fraction) -> str:
    """Return a fraction as text, such as ``16/5``; raise :class:`CheckLimitError` above 4,300 digits."""
    try:
        return str(number)
    except ValueError:  # Python writes no whole number of more than 4,300 digits
        raise CheckLimitError("a fraction has more digits than are written") from None
