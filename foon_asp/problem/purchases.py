"""Purchases as units: buying an object node is a unit without inputs, at a price."""

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Self

from foon_asp.deadline import Deadline
from foon_asp.network import Network, Source
from foon_asp.problem.objective import Objective, OptionalData
from foon_asp.problem.problem import Problem
from foon_asp.problem.restriction import Restriction

_BUY = "buy"
_PRICE, _ITEMS, _SECOND_CHOICES = "_price", "_items", "_second_choices"


@dataclass(frozen=True)
class _FixedCosts:
    """A user measure whose costs are known in advance, by unit id."""

    name: str
    unit_costs: Sequence[int | Fraction]
    text: str = ""
    place: str = ""

    def costs(self, problem: Problem, deadline: Deadline | None = None) -> Sequence[int | Fraction]:
        """Return the cost of each unit, whatever the problem is."""
        del problem, deadline
        return self.unit_costs


class Purchases:
    """A question about what to buy, as a problem with an additional unit for each ware.

    A *ware* is an object node that can be bought. Its unit has no inputs, and makes a copy of the ware. The
    best tree or plan of ``problem`` by ``objectives`` has the cheapest purchases. Ties are broken by fewer
    purchases, then by fewer purchases of wares to avoid, then by the objectives of the question. For the
    objectives of the question, a purchase is a unit that always succeeds. It costs nothing by price and by
    user measures.
    """

    def __init__(
        self,
        problem: Problem,
        wares: Mapping[int, Fraction],
        second_choices: Collection[int],
        objectives: Sequence[Objective],
    ) -> None:
        """Add a unit to a problem for each ware.

        ``wares`` maps the ids of object nodes that can be bought to their prices. ``second_choices`` are the
        ids of wares to avoid. ``objectives`` are those of the question.
        """
        self._wares = tuple(wares)
        self._first_purchase = len(problem.network)
        self._purchases = range(self._first_purchase, self._first_purchase + len(wares))
        no_costs = [0] * self._first_purchase
        costs: dict[str, list[int | Fraction]] = {_PRICE: [*no_costs, *wares.values()]}
        if set(wares.values()) != {Fraction(1)}:
            costs[_ITEMS] = [*no_costs, *(1 for _ in wares)]
        if second_choices:
            costs[_SECOND_CHOICES] = [*no_costs, *(int(o in second_choices) for o in wares)]
        search_objectives = [*map(Objective.of_measure, costs)]
        for objective in objectives:
            if objective.row.needs in {OptionalData.PRICES, OptionalData.MEASURES}:
                name = f"_by_{objective}"
                figures = problem.figures(objective, range(self._first_purchase))
                costs[name] = [*figures, *(0 for _ in wares)]
                objective = Objective.of_measure(name)  # noqa: PLW2901
            search_objectives.append(objective)
        self.objectives = tuple(search_objectives)
        rates = None if problem.rates is None else {_BUY: Fraction(1), **problem.rates}
        self.problem = replace(
            problem,
            network=_add_purchases(problem.network, self._wares),
            rates=rates,
            own_rates=dict(problem.own_rates) | dict.fromkeys(self._purchases, Fraction(1)),
            unit_prices=None,
            measures={name: _FixedCosts(name, unit_costs) for name, unit_costs in costs.items()},
            origin=None,
        )

    def without(self, wares: Collection[int]) -> Self:
        """Return a copy in which some wares, given by object node id, cannot be bought.

        The problem of the copy has a restriction that removes the purchases of ``wares``, in place of any
        other restriction. If no id is that of a ware, the question itself is returned.
        """
        removed = {unit for unit in self._purchases if self._wares[unit - self._first_purchase] in wares}
        if not removed:
            return self
        fewer = copy(self)
        fewer.problem = replace(self.problem, restriction=Restriction(removed.__contains__))
        return fewer

    def split(self, units: Sequence[int]) -> tuple[dict[int, int], tuple[int, ...]]:
        """Return the purchases in a tree or plan, and the other units in their order.

        The purchases map the ids of the object nodes bought, ascending, to numbers of copies.
        """
        bought = Counter(
            self._wares[unit - self._first_purchase] for unit in units if unit >= self._first_purchase
        )
        return dict(sorted(bought.items())), tuple(unit for unit in units if unit < self._first_purchase)


def _add_purchases(network: Network, wares: Sequence[int]) -> Network:
    """Return a network with an additional unit for each ware, which makes the ware out of nothing.

    The new units come last, and their public numbers follow the last public number. The result has no level-3
    network.
    """
    count, numbers = len(wares), network.unit_numbers
    if numbers:
        numbers += tuple(range(numbers[-1] + 1, numbers[-1] + 1 + count))
    return replace(
        network,
        motions=(*network.motions, *[_BUY] * count),
        inputs=(*network.inputs, *[()] * count),
        outputs=(*network.outputs, *((o,) for o in wares)),
        sources=(*network.sources, *[(Source("-", 0),)] * count),
        detailed=None,
        stands_for=(),
        unit_numbers=numbers,
    )
