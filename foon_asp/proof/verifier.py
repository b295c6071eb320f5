"""Is a certificate right? Checked from the network alone: no solver, no linear program, no floats.

docs/dev/certificates.md describes certificates and proves that what passes here is true. In short: take a set
T of object nodes with a goal in it (a *cut*). The first unit of a tree that makes a node of T needs no node
of T. So every tree uses one of the *members* of T: the units that make a node of T and need no node of T. A
cut without members shows that there is no tree.

Now give each cut a positive weight. For every unit, the weights of the cuts that it is a member of may add up
to at most its cost. Then the sum of all weights is a lower bound on every tree's cost.

Weights and costs have one part for each objective, and are compared lexicographically. The part for
``success`` is a sum of ``e * -log(rate)`` with rational ``e``. Bounds of the logarithms decide its sign. If
they are too close, the product of ``rate ** e`` is compared with 1 in whole numbers.

This module imports the standard library and the plain network, and nothing of the rest of the package.
"""

import hashlib
import json
import math
import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from functools import cache
from itertools import accumulate, chain
from typing import Any, TypeAlias

from foon_asp.network import STAND_IN, Network, UnitPrices, node_at_level
from foon_asp.proof.certificate_fields import (
    read_goal,
    read_list,
    read_names,
    read_number,
    read_numbers,
    read_object,
    read_rational,
)
from foon_asp.proof.certificate_header import TREE_FORM, check_header
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.compiled_rules import CompiledRules, Limit
from foon_asp.proof.refusal import LimitError, RefusedError, refuse_deep_nesting, require
from foon_asp.proof.rule_meaning import ALL_STEPS, Meaning, Question, Rule, meaning_of_rule
from foon_asp.proof.stand_ins import Actions, StandInClaim, price_of, stand_in_fault
from foon_asp.proof.verified_claim import Trusted, Verified

_UNMEASURED = "nothing"  # in place of objectives, if the claim is that there is no tree
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


# A cost or weight: exact numbers by objective (its index) and rate (``None`` except by success).
Amount: TypeAlias = dict[tuple[int, Fraction | None], Fraction]


@refuse_deep_nesting()
def verify(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a tree against its data; return what it proves.

    The time is linear in the number of cuts times the size of the network. Raises :class:`RefusedError` with
    the first fault that is found. Raises :class:`LimitError` if the check takes more steps than
    :class:`CertificateLimits` allows, which is a few seconds.
    """
    rules = check_header(certificate, TREE_FORM, subject)
    return Check(certificate, rules, subject).verify_claim()


class Check:
    """One certificate, checked against its network.

    To *refuse* is to raise :class:`RefusedError`. A *member* of a cut is a unit, a kitchen item, or a step of
    a constraint (:class:`CompiledRules`). Items are members only if the objective ``kitchen`` counts them.

    All members are numbered together. A unit has its id as number. Kitchen item ``k`` has the number of units
    plus ``k``. Steps are numbered from the number of units and nodes on.
    """

    def __init__(self, certificate: dict[str, Any], rules: tuple[Rule, ...], subject: Subject) -> None:
        """Read objectives, costs, goals, rules and cuts of a certificate; tree and proof are read later."""
        network, kitchen, rates, utensils, prices = subject[:5]
        self.max_steps = ALLOWED.steps + ALLOWED.steps_each * (len(network) + len(network.objects))
        self.steps_left = self.max_steps
        self.minus_log = cache(self._minus_log)  # of a rate
        self.are_multiples = cache(self._are_multiples)  # of a number, by an objective
        self.trusted_costs: dict[str, dict[int, Fraction]] = {}  # costs by measures that the proof uses
        self.certificate, self.network, self.kitchen = certificate, network, kitchen
        self.utensils = utensils
        self.containers = certificate["containers"]
        require(self.containers in ("strict", "implied"), "expected the containers strict or implied")
        self.objectives = tuple(read_list(certificate["objective"]))
        measures = read_object(certificate.get("measures", {}))
        self.measures = {name: self._read_measure(name, stated) for name, stated in measures.items()}
        require(
            all(objective in (*OBJECTIVES, *self.measures) for objective in self.objectives),
            "an objective is unknown",
        )
        require(len(set(self.objectives)) == len(self.objectives), "an objective stands twice")
        by_rates = {"success", "attempts"} & set(self.objectives)
        self.rates = self._required_rates(rates) if by_rates else {}
        self.fractional_rates = frozenset(self.rates.values()) - {0, 1}
        self.prices = self._required_prices(prices) if "price" in self.objectives else []
        self.goals = tuple(read_goal(goal, network) for goal in read_list(certificate["goals"]))
        require(len(set(self.goals)) == len(self.goals) > 0, "expected goals, each of them once")
        self.needs, self.gives = cache(self._needs), cache(self._gives)  # of a unit, without its rules
        self.preconditions, self.cost = cache(self._preconditions), cache(self._cost)  # of a member
        self.stand_ins = subject.stand_ins
        self.rules, self.claim_size = rules, 0
        each_price = cache(lambda: self._unit_prices(prices))
        question = Question(
            network,
            kitchen,
            self.goals,
            utensils,
            lambda unit: (rates or {}).get(network.motions[unit]),
            lambda unit: each_price()[unit],
            self.needs,
            self.gives,
        )
        self.ruled = CompiledRules(
            [self._rule_meaning(rule, question) for rule in rules],
            len(network.objects),
            len(network) + len(network.objects),
        )
        self.not_covered = read_names(certificate["not_covered"])
        # other names could print misleading lines of their own
        require(all(name.isprintable() for name in self.not_covered), "a constraint has no printable name")
        nodes = len(network.objects) + len(self.ruled.makers)
        self.cuts = [frozenset(read_numbers(cut, nodes)) for cut in read_list(certificate["cuts"])]
        self.members = [frozenset(self._landmark(cut)) for cut in self.cuts]
        self.used_cuts: set[int] = set()  # the cuts that the proof uses

    def _check_stand_ins(self, least: Fraction | None) -> None:
        """Refuse a network whose stand-ins do not agree with their table, if it has a table.

        ``least`` is the claimed lower bound on the dissimilarity of trees, ``None`` if no tree exists.
        """
        if self.stand_ins is None:
            return
        steps = [unit for rule in self.rules if rule["rule"] == ALL_STEPS for unit in rule["units"]]
        ruled = any(rule["rule"] != ALL_STEPS for rule in self.rules)
        by_dissimilarity = self.objectives[:1] in {(), ("dissimilarity",)} and not ruled
        claim = StandInClaim(by_dissimilarity, least if by_dissimilarity else None)
        actions = Actions(self.kitchen, self.needs, self.gives)
        inputs = (o for unit in steps for o in self.needs(unit) if o is not None)
        wanted = [*dict.fromkeys((*self.goals, *inputs))]  # made or taken by every tree
        wrong = stand_in_fault(self.network, self.stand_ins, actions, wanted, claim)
        require(wrong is None, f"{wrong}")

    def _read_measure(self, name: str, stated: Any) -> Trusted:
        """Return the statement of a certificate about what units cost by a measure; check its digest."""
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
        """Return the success rate of each motion of the network; refuse missing rates and rates not in 0..1.

        With the objective ``attempts``, a rate of 0 is refused, too.
        """
        motions = self.network.different_motions
        rates = {
            motion: given_rates[motion]
            for motion in motions
            if given_rates is not None and motion in given_rates
        }
        values = None if given_rates is None else [*rates.values()]
        values_found = self._require_complete(values, len(motions), "success rates")
        require(all(rate <= 1 for rate in values_found), "a rate is above 1")
        require(
            "attempts" not in self.objectives or 0 not in values_found,
            "a unit that never succeeds is repeated forever",
        )
        return rates

    def rate(self, unit: int) -> Fraction:
        """Return the success rate of a unit."""
        return self.rates[self.network.motions[unit]]

    def _required_prices(self, unit_prices: UnitPrices | None) -> list[Fraction]:
        """Return the price of each unit, by id; refuse missing prices, and prices below 0."""
        prices = None if unit_prices is None else self._unit_prices(unit_prices)
        return self._require_complete(prices, len(self.network), "prices")

    def _unit_prices(self, unit_prices: UnitPrices | None) -> Sequence[Fraction | None]:
        """Return the price of each unit, by id: its own, or else that of its motion; ``None`` if unknown.

        Below level 3, it is the least price of the units of level 3 that the unit stands for. It is ``None``
        if one of them has no price.
        """
        network = self.network
        if unit_prices is None:
            return [None] * len(network)
        detailed = network.detailed or network
        own = {detailed.unit_id(unit): price for unit, price in unit_prices.units.items()}
        prices = [
            own.get(unit, unit_prices.motions.get(motion)) for unit, motion in enumerate(detailed.motions)
        ]
        if network.detailed is not None:
            details_prices = [[prices[detail] for detail in details] for details in network.stands_for]
            known_prices = [
                [price for price in detail_prices if price is not None] for detail_prices in details_prices
            ]
            prices = [
                min(stated) if len(stated) == len(detail_prices) else None
                for stated, detail_prices in zip(known_prices, details_prices, strict=True)
            ]
        return prices

    def _require_complete(
        self, values: Sequence[Fraction | None] | None, count: int, what: str
    ) -> list[Fraction]:
        """Return values from which none is missing; ``what`` names them in errors.

        Refuse ``None`` in place of values, fewer than ``count`` that are not ``None``, and values below 0.
        """
        require(values is not None, f"a claim needs {what}, but none are given")
        present = [value for value in values or () if value is not None]
        require(len(present) == count, f"a unit has none of the {what} that a claim needs")
        require(all(value >= 0 for value in present), f"one of the {what} is below 0")
        return present

    def verify_claim(self) -> Verified:
        """Check the tree, its costs and the proof; return what is proved.

        Refuse the certificate at the first fault.
        """
        claim, listed, proof = (self.certificate[key] for key in ("claim", "tree", "proof"))
        costs: list[int | Fraction] | None = None
        amount: Amount = {}
        if listed is not None:
            require(bool(self.objectives), "a tree is given, but no objective")
            amount, costs = self._execute(read_list(listed))
            computed = json.dumps([str(c) if isinstance(c, Fraction) else c for c in costs])
            stated = json.dumps(self.certificate["costs"])  # which tells 1 from True and from 1.0
            require(stated == computed, f"the tree costs {computed}, not what is stated")
        else:
            require(self.certificate["costs"] is None, "costs are given, but no tree")
        if claim == "infeasible":
            require(listed is None and not self.objectives, "there cannot be a tree")
            require(self.certificate["bound"] is None, "a bound is given where there is nothing to bound")
        elif claim == "optimal":
            require(listed is not None, "expected the tree that is optimal")
            require(self.certificate["bound"] is None, "the bound of an optimal tree is what it costs")
        elif claim == "bound":
            require(bool(self.objectives), "expected objectives")
            bound = self._read_amount(self.certificate["bound"])
            require(listed is None or self.sign(self.sum([amount, negate(bound)])) >= 0, "the bound is false")
            amount = bound
        else:
            raise RefusedError("expected the claim optimal, bound or infeasible")
        self._check_stand_ins(None if claim == "infeasible" else amount.get((0, None), Fraction(0)))
        self._check_proof(proof, None if claim == "infeasible" else amount)
        require(len(self.used_cuts) == len(self.cuts), "a cut is not used by the proof")
        return Verified(
            claim,
            self.goals,
            self.containers,
            self.network.level,
            self.objectives,
            self.rules,
            self.not_covered,
            None if listed is None else tuple(listed),
            None if costs is None else tuple(costs),
            len(self.cuts),
            tuple(
                measure._replace(costs=self.trusted_costs[name])
                for name, measure in self.measures.items()
                if name in self.objectives
            ),
        )

    def _execute(self, units: list[Any]) -> tuple[Amount, list[int | Fraction]]:
        """Execute the tree as listed; return its cost twice, as an amount and as written in a certificate.

        Refuse a tree that does not execute, misses a goal, or breaks a rule.
        """
        made: set[int | None] = set()
        for unit in read_numbers(units, len(self.network), ascending=False):
            lacking = (o for o in self.needs(unit) if o not in made and o not in self.kitchen)
            require(
                not any(True for _ in lacking), f"unit {unit} of the tree lacks an input when it is its turn"
            )
            made.update(self.gives(unit))
        unmade = [goal for goal in self.goals if goal not in made and goal not in self.kitchen]
        require(not unmade, "the tree does not make every goal")
        self._require_kept_rules(frozenset(units))
        items = {o for unit in units for o in self.needs(unit) if o is not None and o in self.kitchen}
        members = [*units, *(len(self.network) + o for o in sorted(items))]
        total = self.sum(map(self.cost, members))
        return total, self._written_costs(units, total)

    def _written_costs(self, units: list[int], total: Amount) -> list[int | Fraction]:
        """Return the cost of a tree by each objective, as written in a certificate.

        ``units`` are the units of the tree, and ``total`` is its cost as an amount. By ``success``, the cost
        is the product of the rates. Costs that are too long to be written are refused.
        """
        costs: list[int | Fraction] = []
        for level, objective in enumerate(self.objectives):
            if objective == "success":
                rates = [self.rate(u) for u in units]
                require(0 not in rates, "a tree that never succeeds is no better than another")
                if sum(rate.denominator.bit_length() for rate in rates) > ALLOWED.written_bits:
                    raise LimitError("the success rate of the tree is too long a number to be written")
                costs.append(math.prod(rates, start=Fraction(1)))
            else:
                figure = total.get((level, None), Fraction(0))
                if max(figure.numerator, figure.denominator).bit_length() > ALLOWED.written_bits:
                    raise LimitError("what the tree costs is too long a number to be written")
                sums = {"attempts", "price", "dissimilarity", *self.measures}
                costs.append(figure if objective in sums else int(figure))
        return costs

    def _require_kept_rules(self, units: frozenset[int]) -> None:
        """Refuse a tree of ``units`` that does not keep to the rules."""
        self._spend(len(self.ruled.makers) + len(self.network) * len(self.ruled.barred))
        self._spend(len(units) * len(self.ruled.limits))
        others = frozenset(range(len(self.network))) - units if self.rules else frozenset[int]()
        fault = self.ruled.fault(units, others)
        require(fault is None, f"the tree {fault}")

    def _barred_units(self, number: int, used: frozenset[int], without: frozenset[int]) -> frozenset[int]:
        """Return the units that the constraint ``number`` bars on a branch.

        No tree of the branch has such a unit: it has all members ``used``, and none of ``without``.
        """
        self._spend(len(self.network) + 5 * self.claim_size)
        units = frozenset(member for member in used if member < len(self.network))
        return self.ruled.barred[number](units, without)

    def _check_proof(self, proof: Any, least: Amount | None) -> None:
        """Check a proof, with its branches, that every tree costs at least ``least``.

        If ``least`` is ``None``, the proof is that no tree exists. All costs are then 0, so weights that add
        up to more than 0 are a contradiction.
        """
        no_members: frozenset[int] = frozenset()
        waiting: list[tuple[Any, frozenset[int], frozenset[int]]] = [(proof, no_members, self.ruled.removed)]
        while waiting:
            node, used, without = waiting.pop()
            self._spend(1 + len(used) + len(without))
            keys = set(read_object(node))
            if keys == {"branch", "without", "using"}:
                member = self._read_branch_member(node["branch"])
                require(member not in used | without, "a branch is taken twice")
                waiting.append((node["without"], used, without | {member}))
                waiting.append((node["using"], used | {member}, without))
                continue
            if keys == {"broken"}:
                number = read_number(node["broken"], range(len(self.rules)), "the number of a rule")
                never, barring = number in self.ruled.never, number in self.ruled.barred
                broken = never or (barring and not used.isdisjoint(self._barred_units(number, used, without)))
                require(broken, "a rule called broken is kept")
                continue
            excluded = without.union(*(self._barred_units(n, used, without) for n in self.ruled.barred))
            if keys == {"hopeless"}:
                crossing = self._crossing_members(node["hopeless"], used, excluded)
                require(not crossing, "a cut called hopeless is crossed")
                continue
            above_cutoff: list[int] | None = None
            if "dear" in keys:
                above_cutoff = self._above_cutoff(node["dear"], used | without)
                require("others" in keys, "expected a proof for what is without the dear")
                waiting.append((node["others"], used, without.union(above_cutoff)))
                keys -= {"dear", "others"}
            require(
                {"weights"} <= keys <= {"weights", "limits", "multiples"},
                "expected weights, a hopeless cut, a broken rule or a branch",
            )
            partition_sum, reduced_cost = self._check_cost_partition(
                node["weights"], node.get("limits", []), used, excluded
            )
            used_cost = self.sum(map(self.cost, used))
            for addition in [{}] if above_cutoff is None else map(reduced_cost, above_cutoff):
                total = self._round_up(self.sum([partition_sum, addition]), node.get("multiples", {}))
                require(self._is_enough([total, used_cost], least), "the weights do not add up to enough")

    def _above_cutoff(self, choices: Any, decided: frozenset[int]) -> list[int]:
        """Return the members that a reduced-cost fixing claims to be above the cutoff.

        Refuse an empty list, double members, and members in ``decided``, which are used or excluded already.
        """
        actions = [self._read_branch_member(choice) for choice in read_list(choices)]
        require(len(actions) > 0, "nothing is too dear")
        require(
            decided.isdisjoint(actions) and len(set(actions)) == len(actions), "what is dear is decided twice"
        )
        return actions

    def _is_enough(self, bound: Iterable[Amount], least: Amount | None) -> bool:
        """Return whether the sum of ``bound`` is at least ``least`` or, if ``least`` is ``None``, above 0."""
        if least is None:
            return self.sign(self.sum(bound)) > 0
        return self.sign(self.sum([*bound, negate(least)])) >= 0

    def _check_cost_partition(
        self, weights: Any, limits: Any, used: frozenset[int], without: frozenset[int]
    ) -> tuple[Amount, Callable[[int], Amount]]:
        """Check a cost partition on a branch; return its sum, and a function that returns reduced costs.

        The sum is a lower bound on the cost of all members that a tree of the branch has in addition to
        ``used``. With a certain member, the cost is higher by at least the reduced cost of the member.
        Members in ``without`` are excluded.

        ``weights`` and ``limits`` are rows of a proof: the weights of cuts and of limits. A member may carry
        more than its cost: the weight of a limit for each unit that it consumes of the limit. In return, this
        weight is subtracted from the sum for each unit of the limit that ``used`` leaves.
        """
        total: Amount = {}
        carried: list[tuple[Amount, Mapping[int, Fraction]]] = []
        for (limit_number,), weight in self.read_weights("limits", limits, self._read_amount):
            limit = self.limit_at(limit_number)
            self._spend(len(used))
            self._add_to(total, self.times(weight, -limit.remaining(used)))
            carried.append((weight, limit.amounts))
        rows = [*self.read_weights("weights", weights, self._read_amount)]
        scales = self._common_denominators([weight for _, weight in rows])
        # by part of a weight and member, over the common denominator: whole numbers are added quickly
        loads: dict[tuple[int, Fraction | None], defaultdict[int, int]] = {
            key: defaultdict(int) for key in scales
        }
        for (number,), weight in rows:
            self._add_to(total, weight)
            crossing = self._crossing_members(number, used, without)
            for key, value in weight.items():
                if not value:
                    continue
                self._spend_on_fractions(bit_length(value) + scales[key].bit_length(), len(crossing))
                scaled, load = value.numerator * (scales[key] // value.denominator), loads[key]
                for member in crossing:
                    load[member] += scaled

        def load_of(member: int) -> Amount:
            """Return the sum of the weights of a member's cuts."""
            return {key: Fraction(load.get(member, 0), scales[key]) for key, load in loads.items()}

        def allowed(member: int) -> Amount:
            """Return the greatest load of a member: its cost, and the weights of limits that it consumes.

            It is 0 for a used member, whose cost was paid before.
            """
            # the cost of a used member was paid before
            capacity = {} if member in used else self.cost(member)
            if carried and member not in used:
                extra = (self.times(w, amounts[member]) for w, amounts in carried if member in amounts)
                capacity = self.sum([capacity, *extra])
            return capacity

        def reduced_cost(member: int) -> Amount:
            """Return the part of a member's greatest load that its cuts do not take."""
            return self.sum([allowed(member), negate(load_of(member))])

        for member in dict.fromkeys(chain.from_iterable(loads.values())):
            if allowed(member) != load_of(member):
                require(
                    self.sign(reduced_cost(member)) >= 0, f"unit or item {member} carries more than it costs"
                )
        return total, reduced_cost

    def _common_denominators(self, amounts: Sequence[Amount]) -> dict[tuple[int, Fraction | None], int]:
        """Return, for each part of amounts (objective and rate), the least common denominator."""
        scales: dict[tuple[int, Fraction | None], int] = {}
        for amount in amounts:
            for key, value in amount.items():
                scale = scales.get(key, 1)
                if scale % value.denominator:
                    scale = math.lcm(scale, value.denominator)
                    self._spend_on_fractions(scale.bit_length())
                scales[key] = scale
        return scales

    def _round_up(self, amount: Amount, stated: Any) -> Amount:
        """Return a bound, rounded up to a stated common divisor of all costs by an objective.

        ``stated`` is an object with divisors by objective. The bound is rounded at the first objective whose
        part is no multiple of its divisor. The parts after this objective become 0, since no cost is below 0.
        A divisor that does not divide all costs is refused.
        """
        multiples = {name: read_rational(multiple) for name, multiple in read_object(stated).items()}
        require(multiples.keys() <= set(self.objectives), "a multiple is stated for another objective")
        for level, objective in enumerate(self.objectives):
            if objective in multiples:
                multiple = multiples[objective]
                require(multiple > 0, "a multiple is not above zero")
                require(self.are_multiples(level, multiple), "a cost is not a multiple of what is stated")
                times = amount.get((level, None), Fraction(0)) / multiple
                if times.denominator > 1:
                    before = {key: value for key, value in amount.items() if key[0] < level}
                    return {**before, (level, None): math.ceil(times) * multiple}
        return amount

    def _are_multiples(self, level: int, multiple: Fraction) -> bool:
        """Return whether the costs of all units and items by an objective are multiples of a number.

        ``level`` is the index of the objective. By ``success``, return ``False``.
        """
        if self.objectives[level] == "success":
            return False
        members = (*range(len(self.network)), *(len(self.network) + o for o in self.kitchen))
        self._spend(len(members))
        costs = (self._cost_by_objective(level, member) or Fraction(0) for member in members)
        for ratio in dict.fromkeys(cost.as_integer_ratio() for cost in costs):
            cost = Fraction(*ratio)
            self._spend_on_fractions(bit_length(cost) + bit_length(multiple))
            if cost % multiple:
                return False
        return True

    def _crossing_members(self, number: Any, used: frozenset[int], without: frozenset[int]) -> frozenset[int]:
        """Return the members of the cut ``number`` that are not in ``without``, and record that it is used.

        Refuse a cut that contains neither a goal nor a precondition of a member in ``used``.
        """
        index = read_number(number, range(len(self.cuts)), "the number of a cut")
        self._spend(1 + len(self.goals) + len(used) + len(self.members[index]))
        self.used_cuts.add(index)
        cut = self.cuts[index]
        before = (
            any(goal in cut and goal not in self.kitchen for goal in self.goals)
            or not cut.isdisjoint(self.ruled.goals)
            or any(not cut.isdisjoint(self.preconditions(member)) for member in used)
        )
        require(before, f"cut {number} holds neither a goal nor what a used unit needs")
        return self.members[index] - without

    def _landmark(self, cut: frozenset[int]) -> Iterator[int]:
        """Yield the members of a cut.

        They are the units and steps that make one of its nodes and need none, and its kitchen items. Refuse a
        cut with a kitchen item unless the objective ``kitchen`` counts items.
        """
        network, own = self.network, self.ruled.makers
        self._spend(sum(1 + len(own[o] if o in own else network.producers[o]) for o in cut))
        for o in cut:
            if o in self.kitchen:
                require("kitchen" in self.objectives, "a cut holds a kitchen item")
                yield len(network) + o
            elif o in own:
                yield from (member for member in own[o] if cut.isdisjoint(self.preconditions(member)))
            else:
                for unit in network.producers[o]:
                    if o in self.gives(unit) and cut.isdisjoint(self.preconditions(unit)):
                        yield unit

    def _preconditions(self, member: int) -> frozenset[int | None]:
        """Return the preconditions of a unit or a step, with nodes that constraints add; none for an item."""
        if member in self.ruled.steps:
            return frozenset(self.ruled.steps[member][0])
        if member >= len(self.network):
            return frozenset()
        own = self.ruled.needs.get(member)
        return self.needs(member).union(own) if own else self.needs(member)

    def _needs(self, unit: int) -> frozenset[int | None]:
        """Return the preconditions of a unit, without nodes that constraints add.

        Below level 3, they are the common preconditions of all units of level 3 that the unit stands for.
        """
        return frozenset.intersection(*(needed for needed, _ in self._detailed_effects(unit)))

    def _gives(self, unit: int) -> frozenset[int | None]:
        """Return the add effects of a unit, without nodes that constraints add.

        Below level 3, they are the add effects of all units of level 3 that the unit stands for.
        """
        return frozenset.union(*(made for _, made in self._detailed_effects(unit)))

    def _detailed_effects(self, unit: int) -> Iterator[tuple[frozenset[int | None], frozenset[int | None]]]:
        """Yield preconditions and add effects of each unit of level 3 that a unit stands for.

        Nodes are ids at the network's level. A unit of level 3 stands for itself. Containers that the
        container rule skips are omitted.
        """
        network = self.network
        detailed = network.detailed or network
        for detail in (unit,) if network.detailed is None else network.stands_for[unit]:
            inputs = set(detailed.inputs[detail])
            skipped = self._skipped_containers(detailed, inputs) if self.containers == "implied" else set()
            yield (
                self._ids_at_level(inputs - skipped),
                self._ids_at_level(set(detailed.outputs[detail]) - skipped),
            )

    def _skipped_containers(self, detailed: Network, inputs: set[int]) -> set[int]:
        """Return the inputs of a unit that the container rule ``implied`` takes as given.

        Such an input is a utensil with exactly one ingredient. This ingredient, located in the utensil, is
        another input.
        """
        nodes = [(o, detailed.objects[o]) for o in inputs]
        return {
            o
            for o, vessel in nodes
            if vessel.label in self.utensils
            and len(vessel.ingredients) == 1
            and any(
                other != o and node.label == vessel.ingredients[0] and node.is_in(vessel.label)
                for other, node in nodes
            )
        }

    def _ids_at_level(self, nodes: set[int]) -> frozenset[int | None]:
        """Return nodes of level 3 as ids at the network's level; ``None`` for nodes that it does not have."""
        network = self.network
        if network.detailed is None:
            return frozenset(nodes)
        nodes_at_level = (node_at_level(network.detailed.objects[o], network.level) for o in nodes)
        return frozenset(map(network.object_id, nodes_at_level))

    def _rule_meaning(self, rule: Rule, question: Question) -> Meaning:
        """Return the meaning of a rule for the network; the work counts as steps of the check."""
        self._spend(ALLOWED.rule_steps * (len(self.network) + len(self.network.objects)))
        self.claim_size += sum(1 + len(used) + len(without) for used, without in rule.get("claims", ()))
        return meaning_of_rule(rule, question)

    def _cost(self, member: int) -> Amount:
        """Return the cost of a unit or an item, with a part for each objective that counts it.

        A step of constraints costs nothing.
        """
        cost: Amount = {}
        if member in self.ruled.steps:
            return cost
        for level, objective in enumerate(self.objectives):
            figure = self._cost_by_objective(level, member)
            if figure is not None:
                cost[level, self.rate(member) if objective == "success" else None] = figure
        return cost

    def _cost_by_objective(self, level: int, member: int) -> Fraction | None:
        """Return the cost of a unit or an item by an objective; ``None`` if the objective does not count it.

        ``level`` is the index of the objective. By ``success``, it is 1, the exponent of the unit's rate.
        """
        network, objective = self.network, self.objectives[level]
        item = member >= len(network)
        if item or objective == "kitchen":
            return Fraction(1) if item and objective == "kitchen" else None
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

    def sign(self, amount: Amount) -> Fraction | int:
        """Return a number with the sign of an amount, exactly; the first objective that is not 0 decides."""
        for level, objective in enumerate(self.objectives or (_UNMEASURED,)):
            if objective == "success":
                sign = self._minus_log_sign({r: e for (_, r), e in amount.items() if r is not None})
            else:
                sign = amount.get((level, None), 0)
            if sign:
                return sign
        return 0

    def _read_branch_member(self, choice: Any) -> int:
        """Return the member that a branch is about, from an object such as ``{"unit": 3}``.

        A kitchen item has the key ``item`` and its id as node; a step of constraints has ``step`` and its
        number from 0.
        """
        network, kinds = self.network, [*read_object(choice)]
        kind = kinds[0] if kinds in (["item"], ["step"]) else "unit"
        number = read_object(choice, (kind,))[kind]
        if kind == "unit":
            return read_number(number, range(len(network)), "the id of a unit")
        if kind == "item":
            require("kitchen" in self.objectives, "a branch on an item where items cost nothing")
            return len(network) + read_number(number, self.kitchen, "the id of a kitchen item")
        steps = range(len(self.ruled.steps))
        first = len(network) + len(network.objects)
        return first + read_number(number, steps, "the number of a step")

    def read_weights(
        self, key: str, stated: Any, read: Callable[[Any], Amount], numbers: int = 1
    ) -> Iterator[tuple[list[int], Amount]]:
        """Yield the weighted conditions under a key of a proof; refuse weights that are not above 0.

        A row names its condition by its first ``numbers`` entries, which are yielded as a list, and has the
        weight last. ``read`` turns the stated weight into an amount.
        """
        for name, value in self.read_rows(key, stated, numbers):
            weight = read(value)
            require(self.sign(weight) > 0, f"{key}: a weight is not above zero")
            yield name, weight

    def read_rows(self, key: str, stated: Any, numbers: int = 1) -> Iterator[tuple[list[int], Any]]:
        """Yield rows under a key: their first ``numbers`` entries as a list, and the last entry.

        The first entries have to be whole numbers, and to ascend from row to row.
        """
        rows = [read_list(row) for row in read_list(stated)]
        names = [row[:numbers] for row in rows]
        require(
            all(len(row) == numbers + 1 for row in rows)
            and all(type(number) is int for name in names for number in name),
            f"{key}: expected what has a weight by its number, and the weight",
        )
        in_order = names == sorted(map(list, {*map(tuple, names)}))
        require(in_order, f"{key}: expected weights in order, each once")
        yield from ((name, row[numbers]) for name, row in zip(names, rows, strict=True))

    def limit_at(self, number: int) -> Limit:
        """Return the limit with a number; refuse a number that is of no limit."""
        require(number in self.ruled.limits, "a rule that limits nothing is given a weight")
        return self.ruled.limits[number]

    def _read_amount(self, stated: Any) -> Amount:
        """Return a weight or bound as an amount, from a list with one entry for each objective.

        An entry is a fraction or, for ``success``, an object from rate to exponent.
        """
        amount: Amount = {}
        entries = read_list(stated)
        objectives = self.objectives or (_UNMEASURED,)
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

    def _minus_log_sign(self, exponents: Mapping[Fraction, Fraction]) -> Fraction | int:
        """Return a number with the sign of the sum of ``e * -log(rate)`` over ``exponents``, exactly.

        Bounds of the logarithms decide if they can. Otherwise, exponents are multiplied by their common
        denominator. The product of all ``rate ** e`` is then a quotient of whole numbers, and is compared
        with 1. The sign is positive if it is below 1. A rate of 0 costs more than any weight.
        """
        if never := exponents.get(Fraction(0)):
            return never
        exponents = {rate: e for rate, e in exponents.items() if e and rate != 1}
        for size in accumulate(map(bit_length, exponents.values())):
            self._spend_on_fractions(4000 + size)  # bounds of logarithms have hundreds of bits themselves
        bounds = [[e * bound for bound in self.minus_log(rate)] for rate, e in exponents.items()]
        low, high = sum(map(min, bounds)), sum(map(max, bounds))
        if low > 0 or high < 0:
            return low
        common = math.lcm(*(e.denominator for e in exponents.values()))
        powers = {rate: int(e * common) for rate, e in exponents.items()}
        bits = sum(abs(e) * rate.denominator.bit_length() for rate, e in powers.items())
        if bits > ALLOWED.product_bits:
            raise LimitError("products of rates are too close to be told apart in reasonable time")
        self._spend(bits * math.isqrt(bits) // 64)
        above, below = 1, 1
        for rate, power in powers.items():
            up, down = max(power, 0), max(-power, 0)
            above *= rate.numerator**up * rate.denominator**down
            below *= rate.denominator**up * rate.numerator**down
        return below - above

    def _minus_log(self, rate: Fraction) -> tuple[Fraction, Fraction]:
        """Return bounds of ``-log(rate)`` from below and above.

        Python's decimal logarithm is correctly rounded, so it is off by less than one unit of its last digit.
        For a rate near 1, the logarithms of denominator and numerator share their first digits. So one more
        digit is computed for each three bits that they share.
        """
        shared = (rate.denominator.bit_length() - (rate.denominator - rate.numerator).bit_length()) // 3
        precise = Context(prec=50 + min(shared, 400))
        self._spend((precise.prec // 10) ** 3)
        low = high = Fraction(0)
        for sign, number in ((1, rate.denominator), (-1, rate.numerator)):
            logarithm = precise.ln(Decimal(number))
            unit = Fraction(10) ** (logarithm.adjusted() + 1 - precise.prec) if logarithm else Fraction(0)
            low += sign * Fraction(logarithm) - unit
            high += sign * Fraction(logarithm) + unit
        return low, high

    def _add_to(self, total: Amount, amount: Amount) -> None:
        """Add ``amount`` to ``total`` in place, and count the additions as steps of the check."""
        for key, value in amount.items():
            total[key] = total[key] + value if key in total else value
            self._spend_on_fractions(bit_length(total[key]))

    def times(self, amount: Amount, factor: Fraction) -> Amount:
        """Return an amount times a factor; the work counts as steps of the check."""
        return self.sum([{key: value * factor for key, value in amount.items()}])

    def sum(self, amounts: Iterable[Amount]) -> Amount:
        """Return the sum of amounts; the work counts as steps of the check."""
        total: Amount = {}
        for amount in amounts:
            self._add_to(total, amount)
        return total

    def _spend_on_fractions(self, bits: int, times: int = 1) -> None:
        """Count the steps of ``times`` operations on fractions of ``bits`` bits.

        The steps grow with the square of the bits. Raises :class:`LimitError` if the fractions or the check
        are too long.
        """
        if bits > ALLOWED.sum_bits:
            raise LimitError("its fractions add up to numbers that are too long")
        self._spend(times * (5 + (bits // 512) ** 2))

    def _spend(self, steps: int) -> None:
        """Count steps of the check; raises :class:`LimitError` if there are too many."""
        self.steps_left -= steps
        if self.steps_left < 0:
            raise LimitError(f"to check it takes more than {self.max_steps:,} steps")


def bit_length(value: Fraction) -> int:
    """Return the number of bits of a fraction, numerator and denominator together."""
    return value.numerator.bit_length() + value.denominator.bit_length()


def negate(amount: Amount) -> Amount:
    """Return an amount with the opposite sign."""
    return {key: -value for key, value in amount.items()}
