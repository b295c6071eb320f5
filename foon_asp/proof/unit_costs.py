"""The costs of units and kitchen items by the objectives of a certificate, computed from the data.

Costs by the user's own measures are taken as the certificate states them.
"""

import hashlib
import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

from foon_asp.network import STAND_IN, Network, UnitPrices
from foon_asp.proof.certificate_fields import read_list, read_numbers, read_object, read_rational
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.exact_amounts import UNMEASURED, Amount, bit_length
from foon_asp.proof.refusal import CheckLimitError, require
from foon_asp.proof.stand_ins import price_of
from foon_asp.proof.step_budget import StepBudget
from foon_asp.proof.verified_claim import Trusted

OBJECTIVES = (
    "units",
    "inputs",
    "inputs+ingredients",
    "success",
    "kitchen",
    "attempts",
    "price",
    "dissimilarity",
)

_MEASURE_NAME = re.compile(r"[a-z][A-Za-z0-9_']*", re.ASCII)


class UnitCosts:
    """The costs of units and kitchen items by the objectives of a certificate.

    The number of a unit is its id. The number of kitchen item ``k`` is ``k`` plus the number of units.

    ``objectives``: the objectives, most important first; empty if the claim is that there is no tree.
    ``measures``: the statements of the certificate about measures, by name.
    ``rates``: the success rate of each motion; empty unless an objective depends on rates.
    ``fractional_rates``: the set of success rates other than 0 and 1.
    ``prices``: the price of each unit, by id; empty unless ``price`` is an objective.
    ``trusted_costs``: the stated costs that were used so far, by measure and unit id.
    ``are_multiples``: a cached function from the index of an objective and a number. It returns whether all
    costs by the objective are multiples of the number.
    """

    def __init__(self, certificate: Mapping[str, Any], subject: Subject, budget: StepBudget) -> None:
        """Read the objectives and measures of a certificate; refuse data that lack what a cost depends on."""
        self.network, self.kitchen, self.stand_ins = subject.network, subject.kitchen, subject.stand_ins
        self.budget = budget
        self.are_multiples = cache(self._are_multiples)
        self.trusted_costs: dict[str, dict[int, Fraction]] = {}
        self.objectives = tuple(read_list(certificate["objective"]))
        measures = read_object(certificate.get("measures", {}))
        self.measures = {name: self._read_measure(name, stated) for name, stated in measures.items()}
        require(
            all(objective in (*OBJECTIVES, *self.measures) for objective in self.objectives),
            "an objective is unknown",
        )
        require(len(set(self.objectives)) == len(self.objectives), "an objective stands twice")
        needs_rates = not {"success", "attempts"}.isdisjoint(self.objectives)
        self.rates = self._required_rates(subject.rates) if needs_rates else {}
        self.fractional_rates = frozenset(self.rates.values()) - {0, 1}
        self.prices = self._required_prices(subject.prices) if "price" in self.objectives else []

    def _read_measure(self, name: str, stated: Any) -> Trusted:
        """Return the statement of a certificate about what units cost by a measure.

        Refuse an unfit name, a wrong digest, costs below 0, and a unit with two costs. No cost counts as used
        yet.
        """
        require(
            bool(_MEASURE_NAME.fullmatch(name)) and name not in OBJECTIVES, "a measure has no name of its own"
        )
        measure = read_object(stated, ("rules", "sha256", "costs"))
        rules = measure["rules"]
        require(isinstance(rules, str), "expected the text of rules")
        digest = hashlib.sha256(rules.encode(errors="backslashreplace")).hexdigest()
        require(measure["sha256"] == digest, "the digest of a measure is not that of its rules")
        costs: dict[int, Fraction] = {}
        for text, units in read_object(measure["costs"]).items():
            cost = read_rational(text)
            require(cost >= 0, "a unit costs less than 0 by a measure")
            for unit in read_numbers(units, len(self.network)):
                require(unit not in costs, "a unit has two costs by a measure")
                costs[unit] = cost
        self.trusted_costs[name] = {}
        return Trusted(name, rules, digest, costs)

    def _stated_cost(self, name: str, unit: int) -> Fraction:
        """Return the stated cost of a unit by a measure, and record that it is taken on trust.

        Refuse a unit without stated cost.
        """
        costs = self.measures[name].costs
        require(unit in costs, "the cost of a unit by a measure is not stated")
        self.trusted_costs[name][unit] = costs[unit]
        return costs[unit]

    def _required_rates(self, given_rates: Mapping[str, Fraction] | None) -> dict[str, Fraction]:
        """Return the success rate of each motion of the network; refuse missing rates.

        Rates below 0 or above 1 are refused. With the objective ``attempts``, a rate of 0 is refused as well.
        """
        motions = self.network.different_motions
        rates = {
            motion: given_rates[motion]
            for motion in motions
            if given_rates is not None and motion in given_rates
        }
        given_values = None if given_rates is None else [*rates.values()]
        found_rates = self._require_complete(given_values, len(motions), "success rates")
        require(all(rate <= 1 for rate in found_rates), "a rate is above 1")
        require(
            "attempts" not in self.objectives or 0 not in found_rates,
            "a unit that never succeeds is repeated forever",
        )
        return rates

    def rate(self, unit: int) -> Fraction:
        """Return the success rate of a unit."""
        return self.rates[self.network.motions[unit]]

    def _required_prices(self, unit_prices: UnitPrices | None) -> list[Fraction]:
        """Return the price of each unit, by id; refuse missing prices, and prices below 0."""
        prices = None if unit_prices is None else prices_by_id(self.network, unit_prices)
        return self._require_complete(prices, len(self.network), "prices")

    def _require_complete(
        self, values: Sequence[Fraction | None] | None, count: int, what: str
    ) -> list[Fraction]:
        """Return the values without ``None``; refuse fewer than ``count`` of them, and values below 0.

        ``values`` is ``None`` if all are missing, which is refused. ``what`` names the values in errors.
        """
        require(values is not None, f"a claim needs {what}, but none are given")
        present = [value for value in values or () if value is not None]
        require(len(present) == count, f"a unit has none of the {what} that a claim needs")
        require(all(value >= 0 for value in present), f"one of the {what} is below 0")
        return present

    def cost(self, member: int) -> Amount:
        """Return the cost of a unit or item as an amount, with a part for each objective that counts it.

        By ``success``, the part is 1, under the rate of the unit.
        """
        cost: Amount = {}
        for level, objective in enumerate(self.objectives):
            value = self._cost_by_objective(level, member)
            if value is not None:
                cost[level, self.rate(member) if objective == "success" else None] = value
        return cost

    def _cost_by_objective(self, level: int, member: int) -> Fraction | None:
        """Return the cost of a unit or an item by an objective; ``None`` if the objective does not count it.

        ``level`` is the index of the objective. By ``success``, return 1, the exponent of the unit's rate. By
        a measure, the stated cost is recorded as used.
        """
        network, objective = self.network, self.objectives[level]
        is_item = member >= len(network)
        if is_item or objective == "kitchen":
            return Fraction(1) if is_item and objective == "kitchen" else None
        if objective in {"units", "success"}:
            return Fraction(1)
        if objective == "attempts":
            return 1 / self.rate(member)
        if objective in {"price", "dissimilarity"}:
            return self.prices[member] if objective == "price" else self._dissimilarity(member)
        if objective in self.measures:
            return self._stated_cost(objective, member)
        require(objective in {"inputs", "inputs+ingredients"}, "an objective is unknown")
        inputs = network.inputs[member]
        count = len(inputs)
        if objective == "inputs+ingredients":
            count += sum(len(network.objects[o].ingredients) for o in inputs)
        return Fraction(count)

    def _dissimilarity(self, unit: int) -> Fraction:
        """Return the price of a stand-in by the table; 0 for other units."""
        network = self.network
        if self.stand_ins is None or network.motions[unit] != STAND_IN:
            return Fraction(0)
        (serving,), (served,) = network.inputs[unit], network.outputs[unit]
        # each has a price, since they agree with the table
        return price_of(self.stand_ins, network.objects[serving], network.objects[served]) or Fraction(0)

    def written_costs(self, units: list[int], total: Amount) -> list[int | Fraction]:
        """Return the cost of a tree by each objective, as written in a certificate.

        ``units`` are the units of the tree, and ``total`` is its cost as an amount. By ``success``, the cost
        is the product of the rates; a product of 0 is refused. Costs by ``success``, ``attempts``, ``price``,
        ``dissimilarity`` and measures are fractions. Other costs are whole numbers. Raises
        :class:`CheckLimitError` if a cost is too long to be written.
        """
        costs: list[int | Fraction] = []
        for level, objective in enumerate(self.objectives):
            if objective == "success":
                rates = [self.rate(u) for u in units]
                require(0 not in rates, "a tree that never succeeds is no better than another")
                if sum(rate.denominator.bit_length() for rate in rates) > ALLOWED.written_bits:
                    raise CheckLimitError("the success rate of the tree is too long a number to be written")
                costs.append(math.prod(rates, start=Fraction(1)))
            else:
                value = total.get((level, None), Fraction(0))
                if max(value.numerator, value.denominator).bit_length() > ALLOWED.written_bits:
                    raise CheckLimitError("what the tree costs is too long a number to be written")
                fractional = {"attempts", "price", "dissimilarity", *self.measures}
                costs.append(value if objective in fractional else int(value))
        return costs

    def _are_multiples(self, level: int, multiple: Fraction) -> bool:
        """Return whether the costs of all units and items by an objective are multiples of a number.

        ``level`` is the index of the objective. By ``success``, return ``False``.
        """
        if self.objectives[level] == "success":
            return False
        members = (*range(len(self.network)), *(len(self.network) + o for o in self.kitchen))
        self.budget.spend(len(members))
        costs = (self._cost_by_objective(level, member) or Fraction(0) for member in members)
        for ratio in dict.fromkeys(cost.as_integer_ratio() for cost in costs):
            cost = Fraction(*ratio)
            self.budget.spend_on_fractions(bit_length(cost) + bit_length(multiple))
            if cost % multiple:
                return False
        return True

    def read_amount(self, stated: Any) -> Amount:
        """Return a weight or bound as an amount, from a list with one entry for each objective.

        An entry is a fraction. For ``success``, it is an object from rate to exponent. Rates that no motion
        has, and rates of 0 or 1, are refused. Without objectives, the list has one fraction.
        """
        amount: Amount = {}
        entries = read_list(stated)
        objectives = self.objectives or (UNMEASURED,)
        require(len(entries) == len(objectives), "expected one part of a weight for each objective")
        for level, objective in enumerate(objectives):
            if objective == "success":
                for name, exponent in read_object(entries[level]).items():
                    rate = read_rational(name)
                    require(
                        rate in self.fractional_rates,
                        "expected rates of motions in a weight, and none of 0 or 1",
                    )
                    amount[level, rate] = read_rational(exponent)
            else:
                amount[level, None] = read_rational(entries[level])
        return amount

    def trusted_measures(self) -> tuple[Trusted, ...]:
        """Return the measures that are objectives, each with the stated costs that were used so far."""
        return tuple(
            measure._replace(costs=self.trusted_costs[name])
            for name, measure in self.measures.items()
            if name in self.objectives
        )


def prices_by_id(network: Network, unit_prices: UnitPrices | None) -> Sequence[Fraction | None]:
    """Return the price of each unit, by id: its own, or else that of its motion; ``None`` if unknown.

    Below level 3, it is the least price of the units of level 3 that the unit stands for. It is ``None``
    if one of them has no price.
    """
    if unit_prices is None:
        return [None] * len(network)
    detailed = network.detailed or network
    own_prices = {detailed.unit_id(unit): price for unit, price in unit_prices.units.items()}
    prices = [
        own_prices.get(unit, unit_prices.motions.get(motion)) for unit, motion in enumerate(detailed.motions)
    ]
    if network.detailed is not None:
        details_prices = [[prices[detail] for detail in details] for details in network.stands_for]
        known_prices = [
            [price for price in detail_prices if price is not None] for detail_prices in details_prices
        ]
        prices = [
            min(known_of_unit) if len(known_of_unit) == len(detail_prices) else None
            for known_of_unit, detail_prices in zip(known_prices, details_prices, strict=True)
        ]
    return prices
