"""Is a certificate right? Checked from the network alone: no solver, no linear program, no floats.

docs/dev/certificates.md describes certificates and proves that what passes here is true. In short: take a set
T of object nodes with a goal in it (a *cut*). The first unit of a tree that makes a node of T needs no node
of T. So every tree uses one of the *members* of T: the units that make a node of T and need no node of T. A
cut without members shows that there is no tree.

Now give each cut a positive weight. For every unit, the weights of the cuts that it is a member of may add up
to at most its cost. Then the sum of all weights is a lower bound on every tree's cost.

Weights and costs have one part for each objective, and are compared lexicographically (``exact_amounts.py``).

This module and those that it imports need the standard library and the plain network, and nothing of the rest
of the package.
"""

import json
import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from itertools import chain
from typing import Any

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
from foon_asp.proof.exact_amounts import Amount, AmountArithmetic, bit_length, negate
from foon_asp.proof.refusal import RefusedError, refuse_deep_nesting, require
from foon_asp.proof.rule_meaning import ALL_STEPS, Meaning, Question, Rule, meaning_of_rule
from foon_asp.proof.stand_ins import Actions, StandInClaim, stand_in_fault
from foon_asp.proof.step_budget import StepBudget
from foon_asp.proof.unit_costs import UnitCosts, prices_by_id
from foon_asp.proof.unit_effects import UnitEffects
from foon_asp.proof.verified_claim import Verified


@refuse_deep_nesting()
def verify(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a tree against its data; return what it proves.

    The time is linear in the number of cuts times the size of the network. Raises :class:`RefusedError` with
    the first fault that is found. Raises :class:`CheckLimitError` if the check takes more steps than
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
        self.budget = StepBudget(ALLOWED.steps + ALLOWED.steps_each * (len(network) + len(network.objects)))
        self.certificate, self.network, self.kitchen = certificate, network, kitchen
        self.utensils = utensils
        self.containers = certificate["containers"]
        require(self.containers in ("strict", "implied"), "expected the containers strict or implied")
        self.unit_costs = UnitCosts(certificate, subject, self.budget)
        self.objectives = self.unit_costs.objectives
        self.arithmetic = AmountArithmetic(self.objectives, self.budget)
        self.goals = tuple(read_goal(goal, network) for goal in read_list(certificate["goals"]))
        require(len(set(self.goals)) == len(self.goals) > 0, "expected goals, each of them once")
        self.effects = UnitEffects(network, self.containers, utensils)
        self.needs, self.gives = self.effects.needs, self.effects.gives  # of a unit, without its rules
        self.preconditions, self.cost = cache(self._preconditions), cache(self._cost)  # of a member
        self.stand_ins = subject.stand_ins
        self.rules, self.claim_size = rules, 0
        each_price = cache(lambda: prices_by_id(network, prices))
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
        """Refuse a network whose stand-ins do not agree with their table; without a table, do nothing.

        ``least`` is the claimed lower bound on the dissimilarity of trees. It is ``None`` if the claim is
        that no tree exists.
        """
        if self.stand_ins is None:
            return
        required_units = [unit for rule in self.rules if rule["rule"] == ALL_STEPS for unit in rule["units"]]
        is_ruled = any(rule["rule"] != ALL_STEPS for rule in self.rules)
        by_dissimilarity = self.objectives[:1] in {(), ("dissimilarity",)} and not is_ruled
        claim = StandInClaim(by_dissimilarity, least if by_dissimilarity else None)
        actions = Actions(self.kitchen, self.needs, self.gives)
        inputs = (o for unit in required_units for o in self.needs(unit) if o is not None)
        needed_nodes = [*dict.fromkeys((*self.goals, *inputs))]  # made or taken by every tree
        fault = stand_in_fault(self.network, self.stand_ins, actions, needed_nodes, claim)
        require(fault is None, f"{fault}")

    def verify_claim(self) -> Verified:
        """Check the tree, its costs, the stand-ins and the proof; return what is proved.

        Refuse the certificate at the first fault. A cut that the proof does not use is a fault.
        """
        claim, stated_tree, proof = (self.certificate[key] for key in ("claim", "tree", "proof"))
        costs: list[int | Fraction] | None = None
        amount: Amount = {}
        if stated_tree is not None:
            require(bool(self.objectives), "a tree is given, but no objective")
            amount, costs = self._execute(read_list(stated_tree))
            computed = json.dumps([str(c) if isinstance(c, Fraction) else c for c in costs])
            stated_costs = json.dumps(self.certificate["costs"])  # which tells 1 from True and from 1.0
            require(stated_costs == computed, f"the tree costs {computed}, not what is stated")
        else:
            require(self.certificate["costs"] is None, "costs are given, but no tree")
        if claim == "infeasible":
            require(stated_tree is None and not self.objectives, "there cannot be a tree")
            require(self.certificate["bound"] is None, "a bound is given where there is nothing to bound")
        elif claim == "optimal":
            require(stated_tree is not None, "expected the tree that is optimal")
            require(self.certificate["bound"] is None, "the bound of an optimal tree is what it costs")
        elif claim == "bound":
            require(bool(self.objectives), "expected objectives")
            bound = self.unit_costs.read_amount(self.certificate["bound"])
            require(
                stated_tree is None
                or self.arithmetic.sign(self.arithmetic.sum([amount, negate(bound)])) >= 0,
                "the bound is false",
            )
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
            None if stated_tree is None else tuple(stated_tree),
            None if costs is None else tuple(costs),
            len(self.cuts),
            self.unit_costs.trusted_measures(),
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
        total = self.arithmetic.sum(map(self.cost, members))
        return total, self.unit_costs.written_costs(units, total)

    def _require_kept_rules(self, units: frozenset[int]) -> None:
        """Refuse a tree of ``units`` that does not keep to the rules; count the work as steps."""
        self.budget.spend(len(self.ruled.makers) + len(self.network) * len(self.ruled.barred))
        self.budget.spend(len(units) * len(self.ruled.limits))
        others = frozenset(range(len(self.network))) - units if self.rules else frozenset[int]()
        fault = self.ruled.fault(units, others)
        require(fault is None, f"the tree {fault}")

    def _barred_units(self, number: int, used: frozenset[int], without: frozenset[int]) -> frozenset[int]:
        """Return the units that the constraint ``number`` bars on a branch: no tree of the branch has them.

        A tree of the branch has all members ``used``, and none of ``without``. The work counts as steps of
        the check.
        """
        self.budget.spend(len(self.network) + 5 * self.claim_size)
        units = frozenset(member for member in used if member < len(self.network))
        return self.ruled.barred[number](units, without)

    def _check_proof(self, proof: Any, least: Amount | None) -> None:
        """Check a proof, with its branches, that every tree costs at least ``least``.

        If ``least`` is ``None``, the proof is that no tree exists. All costs are then 0, so weights that add
        up to more than 0 are a contradiction. The cuts that the proof names are recorded as used.
        """
        no_members: frozenset[int] = frozenset()
        waiting: list[tuple[Any, frozenset[int], frozenset[int]]] = [(proof, no_members, self.ruled.removed)]
        while waiting:
            node, used, without = waiting.pop()
            self.budget.spend(1 + len(used) + len(without))
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
            used_cost = self.arithmetic.sum(map(self.cost, used))
            for addition in [{}] if above_cutoff is None else map(reduced_cost, above_cutoff):
                total = self._round_up(
                    self.arithmetic.sum([partition_sum, addition]), node.get("multiples", {})
                )
                require(self._is_enough([total, used_cost], least), "the weights do not add up to enough")

    def _above_cutoff(self, choices: Any, decided: frozenset[int]) -> list[int]:
        """Return the members that a node of the proof excludes by reduced-cost fixing, as stated.

        Whether they cost too much is not checked here. Refuse an empty list, double members, and members in
        ``decided``, which are used or excluded already.
        """
        members = [self._read_branch_member(choice) for choice in read_list(choices)]
        require(len(members) > 0, "nothing is too dear")
        require(
            decided.isdisjoint(members) and len(set(members)) == len(members), "what is dear is decided twice"
        )
        return members

    def _is_enough(self, bound: Iterable[Amount], least: Amount | None) -> bool:
        """Return whether the sum of ``bound`` is at least ``least`` or, if ``least`` is ``None``, above 0."""
        if least is None:
            return self.arithmetic.sign(self.arithmetic.sum(bound)) > 0
        return self.arithmetic.sign(self.arithmetic.sum([*bound, negate(least)])) >= 0

    def _check_cost_partition(
        self, weights: Any, limits: Any, used: frozenset[int], without: frozenset[int]
    ) -> tuple[Amount, Callable[[int], Amount]]:
        """Check a cost partition on a branch; return its sum, and a function that returns reduced costs.

        A tree of the branch has all members ``used`` and none of ``without``. The sum is a lower bound on the
        cost of its other members. If the tree has a certain member, the bound rises by the member's reduced
        cost.

        ``weights`` and ``limits`` are rows of a proof: the weights of cuts and of limits. The weights of a
        member's cuts may add up to its cost. Each limit with a weight adds to this maximum: the weight times
        the amount of the member in the limit. For each such limit, the sum is reduced by the weight times
        what ``used`` leaves of the limit. Greater weights of cuts are refused. The cuts count as used by the
        proof.
        """
        total: Amount = {}
        weighted_limits: list[tuple[Amount, Mapping[int, Fraction]]] = []
        for (limit_number,), weight in self.read_weights("limits", limits, self.unit_costs.read_amount):
            limit = self.limit_at(limit_number)
            self.budget.spend(len(used))
            self.arithmetic.add_to(total, self.arithmetic.times(weight, -limit.remaining(used)))
            weighted_limits.append((weight, limit.amounts))
        rows = [*self.read_weights("weights", weights, self.unit_costs.read_amount)]
        scales = self.arithmetic.common_denominators([weight for _, weight in rows])
        # by part of a weight and member, over the common denominator: whole numbers are added quickly
        loads: dict[tuple[int, Fraction | None], defaultdict[int, int]] = {
            key: defaultdict(int) for key in scales
        }
        for (number,), weight in rows:
            self.arithmetic.add_to(total, weight)
            crossing = self._crossing_members(number, used, without)
            for key, value in weight.items():
                if not value:
                    continue
                self.budget.spend_on_fractions(bit_length(value) + scales[key].bit_length(), len(crossing))
                scaled, load = value.numerator * (scales[key] // value.denominator), loads[key]
                for member in crossing:
                    load[member] += scaled

        def load_of(member: int) -> Amount:
            """Return the sum of the weights of a member's cuts."""
            return {key: Fraction(load.get(member, 0), scales[key]) for key, load in loads.items()}

        def allowed(member: int) -> Amount:
            """Return the most that the weights of a member's cuts may add up to.

            It is the cost of the member, plus each weighted limit's weight times the amount of the member. It
            is 0 for a used member, whose cost is added apart.
            """
            capacity = {} if member in used else self.cost(member)
            if weighted_limits and member not in used:
                extra = (
                    self.arithmetic.times(w, amounts[member])
                    for w, amounts in weighted_limits
                    if member in amounts
                )
                capacity = self.arithmetic.sum([capacity, *extra])
            return capacity

        def reduced_cost(member: int) -> Amount:
            """Return ``allowed(member)`` less the sum of the weights of the member's cuts."""
            return self.arithmetic.sum([allowed(member), negate(load_of(member))])

        for member in dict.fromkeys(chain.from_iterable(loads.values())):
            if allowed(member) != load_of(member):
                require(
                    self.arithmetic.sign(reduced_cost(member)) >= 0,
                    f"unit or item {member} carries more than it costs",
                )
        return total, reduced_cost

    def _round_up(self, amount: Amount, stated_divisors: Any) -> Amount:
        """Return a bound, rounded up to a stated common divisor of all costs by an objective.

        ``stated_divisors`` is an object with divisors by objective. The bound is rounded at the first
        objective whose part is no multiple of its divisor. The parts after this objective become 0, since no
        cost is below 0. A divisor that does not divide all costs is refused.
        """
        divisors = {name: read_rational(divisor) for name, divisor in read_object(stated_divisors).items()}
        require(divisors.keys() <= set(self.objectives), "a multiple is stated for another objective")
        for level, objective in enumerate(self.objectives):
            if objective in divisors:
                divisor = divisors[objective]
                require(divisor > 0, "a multiple is not above zero")
                require(
                    self.unit_costs.are_multiples(level, divisor),
                    "a cost is not a multiple of what is stated",
                )
                quotient = amount.get((level, None), Fraction(0)) / divisor
                if quotient.denominator > 1:
                    kept_parts = {key: value for key, value in amount.items() if key[0] < level}
                    return {**kept_parts, (level, None): math.ceil(quotient) * divisor}
        return amount

    def _crossing_members(self, number: Any, used: frozenset[int], without: frozenset[int]) -> frozenset[int]:
        """Return the members of the cut ``number`` that are not in ``without``, and record that it is used.

        Refuse a cut that contains neither a goal nor a precondition of a member in ``used``.
        """
        index = read_number(number, range(len(self.cuts)), "the number of a cut")
        self.budget.spend(1 + len(self.goals) + len(used) + len(self.members[index]))
        self.used_cuts.add(index)
        cut = self.cuts[index]
        separates_wanted = (
            any(goal in cut and goal not in self.kitchen for goal in self.goals)
            or not cut.isdisjoint(self.ruled.goals)
            or any(not cut.isdisjoint(self.preconditions(member)) for member in used)
        )
        require(separates_wanted, f"cut {number} holds neither a goal nor what a used unit needs")
        return self.members[index] - without

    def _landmark(self, cut: frozenset[int]) -> Iterator[int]:
        """Yield the members of a cut, given as a set of nodes; a member may be yielded twice.

        They are the kitchen items in the cut, and the units and steps that make a node of the cut and need no
        node of it. Refuse a cut with a kitchen item unless the objective ``kitchen`` counts items.
        """
        network, makers_by_rules = self.network, self.ruled.makers
        self.budget.spend(
            sum(1 + len(makers_by_rules[o] if o in makers_by_rules else network.producers[o]) for o in cut)
        )
        for o in cut:
            if o in self.kitchen:
                require("kitchen" in self.objectives, "a cut holds a kitchen item")
                yield len(network) + o
            elif o in makers_by_rules:
                yield from (
                    member for member in makers_by_rules[o] if cut.isdisjoint(self.preconditions(member))
                )
            else:
                for unit in network.producers[o]:
                    if o in self.gives(unit) and cut.isdisjoint(self.preconditions(unit)):
                        yield unit

    def _preconditions(self, member: int) -> frozenset[int | None]:
        """Return the preconditions of a member, with nodes that constraints add; a kitchen item has none."""
        if member in self.ruled.steps:
            return frozenset(self.ruled.steps[member][0])
        if member >= len(self.network):
            return frozenset()
        needs_by_rules = self.ruled.needs.get(member)
        return self.needs(member).union(needs_by_rules) if needs_by_rules else self.needs(member)

    def _rule_meaning(self, rule: Rule, question: Question) -> Meaning:
        """Return the meaning of a rule; count its work, and add the size of its claims to ``claim_size``."""
        self.budget.spend(ALLOWED.rule_steps * (len(self.network) + len(self.network.objects)))
        self.claim_size += sum(1 + len(used) + len(without) for used, without in rule.get("claims", ()))
        return meaning_of_rule(rule, question)

    def _cost(self, member: int) -> Amount:
        """Return the cost of a unit, an item or a step, with a part for each objective that counts it.

        A step of constraints costs nothing.
        """
        if member in self.ruled.steps:
            return {}
        return self.unit_costs.cost(member)

    def _read_branch_member(self, choice: Any) -> int:
        """Return the member that a branch is about, from an object such as ``{"unit": 3}``.

        A kitchen item has the key ``item`` and its id as node; a step of constraints has ``step`` and its
        number from 0. Refuse an item unless the objective ``kitchen`` counts items.
        """
        network, keys = self.network, [*read_object(choice)]
        key = keys[0] if keys in (["item"], ["step"]) else "unit"
        number = read_object(choice, (key,))[key]
        if key == "unit":
            return read_number(number, range(len(network)), "the id of a unit")
        if key == "item":
            require("kitchen" in self.objectives, "a branch on an item where items cost nothing")
            return len(network) + read_number(number, self.kitchen, "the id of a kitchen item")
        steps = range(len(self.ruled.steps))
        first_step = len(network) + len(network.objects)
        return first_step + read_number(number, steps, "the number of a step")

    def read_weights(
        self, key: str, stated: Any, read: Callable[[Any], Amount], name_length: int = 1
    ) -> Iterator[tuple[list[int], Amount]]:
        """Yield the weighted conditions under a key of a proof; refuse weights that are not above 0.

        A row names its condition by its first ``name_length`` entries, which are yielded as a list, and has
        the weight last. ``read`` turns the stated weight into an amount.
        """
        for name, value in self.read_rows(key, stated, name_length):
            weight = read(value)
            require(self.arithmetic.sign(weight) > 0, f"{key}: a weight is not above zero")
            yield name, weight

    def read_rows(self, key: str, stated: Any, name_length: int = 1) -> Iterator[tuple[list[int], Any]]:
        """Yield rows under a key: their first ``name_length`` entries as a list, and the last entry.

        Refuse rows of another length, and first entries that are no whole numbers or do not ascend from row
        to row. ``key`` names the rows in errors.
        """
        rows = [read_list(row) for row in read_list(stated)]
        names = [row[:name_length] for row in rows]
        require(
            all(len(row) == name_length + 1 for row in rows)
            and all(type(number) is int for name in names for number in name),
            f"{key}: expected what has a weight by its number, and the weight",
        )
        in_order = names == sorted(map(list, {*map(tuple, names)}))
        require(in_order, f"{key}: expected weights in order, each once")
        yield from ((name, row[name_length]) for name, row in zip(names, rows, strict=True))

    def limit_at(self, number: int) -> Limit:
        """Return the limit with this number (:class:`CompiledRules`); refuse a number without a limit."""
        require(number in self.ruled.limits, "a rule that limits nothing is given a weight")
        return self.ruled.limits[number]
