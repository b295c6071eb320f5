"""Is a certificate of a plan right, where items are used up? Without a solver, a linear program or floats.

docs/dev/certificates.md describes these certificates and proves that what passes here is true. In short: the
*count* of a unit says how often a plan executes it. Counts satisfy linear conditions that can be read from
the network. One is the *balance* of a node: no more copies are used up than are initial or added. Another is
a cut before a goal, or before a unit that is executed: a member of the cut is executed. Counts are integers,
so sums of balances can be rounded.

A Farkas combination of the conditions, with weights from 0, bounds the cost of every plan. The bound is the
sum of the right-hand sides and of one number for each unit. This number is the least reduced cost over all
counts that the unit may have.

The inputs that a unit uses up are computed anew from the plain network (``unit_flows.py``). The plan is
executed anew as well.
"""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, cached_property, partial
from typing import Any, NamedTuple, TypeAlias

from foon_asp.proof.certificate_fields import (
    read_list,
    read_number,
    read_numbers,
    read_object,
    read_rational,
)
from foon_asp.proof.certificate_header import CERTIFICATE_KEYS, Form, check_header
from foon_asp.proof.certificate_items import (
    COUNTS,
    read_amounts,
    read_copies,
    read_stays,
    read_stock,
)
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.exact_amounts import Amount, bit_length, negate
from foon_asp.proof.refusal import refuse_deep_nesting, require
from foon_asp.proof.rule_meaning import LIBRARY, Rule
from foon_asp.proof.unit_flows import Flow, UnitFlows
from foon_asp.proof.verified_claim import ItemClaims, Verified
from foon_asp.proof.verifier import Check, verify

PLAN = Form("foon-asp certificate of a plan", 3, CERTIFICATE_KEYS | {"items", "unreached", "rounded"})

# The rules that plans can be checked against: those that remove units, at-least-one constraints, and those
# whose limit counts each execution.
COUNTING = ("at_most_units", "at_most_motion", "at_most_utensil_uses", "at_most_price")
WANTING = ("forbid_ingredient", "require_motion", "require_object", "require_ingredient")
PLAN_RULES = frozenset({*COUNTING, *WANTING, *(name for name, rule in LIBRARY.items() if rule.removes)})

LOGARITHM_SCALE = 10**9  # of logarithms in conditions on earlier objectives
_LEAF = {"weights", "before", "supply", "balance", "limits", "levels", "rounded"}


Row: TypeAlias = tuple[Mapping[int, int | Fraction], int | Fraction]
"""A condition on counts: the coefficient of each unit, and a lower bound on the weighted sum."""


class Node(NamedTuple):
    """A node of the branching over counts.

    ``proof``: the proof of the node, as JSON.
    ``min_counts``, ``max_counts``: the bounds of counts by member, if branches set them. The count of an item
    is the number of its copies that are taken.
    """

    proof: Any
    min_counts: Mapping[int, int]
    max_counts: Mapping[int, int]


def is_of_plan(certificate: Any) -> bool:
    """Return whether a certificate claims, by its format, to be one of a plan."""
    return isinstance(certificate, dict) and certificate.get("format") == PLAN.name


def verify_any(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a tree or of a plan; return what it proves.

    Raises :class:`RefusedError` with the first fault that is found.
    """
    check = verify_plan if is_of_plan(certificate) else verify
    return check(certificate, subject)


@refuse_deep_nesting()
def verify_plan(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a plan against its data; return what it proves.

    Raises :class:`RefusedError` with the first fault that is found. Below level 3, every certificate is
    refused, since consumption depends on contents. A rule that is not in :data:`PLAN_RULES` is refused.
    """
    rules = check_header(certificate, PLAN, subject)
    require(subject.network.level == 3, "below level 3 nothing says what is used up: contents decide")
    require(PLAN_RULES.issuperset(rule["rule"] for rule in rules), "a rule that plans are not held against")
    check = PlanCheck(certificate, rules, subject)
    return check.verify_claim()._replace(
        used_up=ItemClaims(check.stock, check.stays_stated, check.wanted_stated)
    )


class PlanCheck(Check):
    """One certificate of a plan, checked against its network.

    If the objective ``kitchen`` counts items, they are members of cuts, too. The count of an endless item is
    0 or 1. The count of another item is the number of copies taken from the stock.
    """

    def __init__(self, certificate: dict[str, Any], rules: tuple[Rule, ...], subject: Subject) -> None:
        """Read the items of a certificate, then all that :class:`Check` reads, and then the rounded sums."""
        items = read_object(certificate["items"], ("stock", "stays", "wanted", "amounts"))
        self.stock = read_stock(items["stock"], subject.kitchen)
        self.stays_stated = read_stays(items["stays"], len(subject.network.objects))
        self.wanted_stated = read_copies(items["wanted"], "goals and how many of each are wanted")
        require(all(n > 1 for n in self.wanted_stated.values()), "an amount of a goal is not above 1")
        self.amounts = read_amounts(items["amounts"], subject)
        self.endless = frozenset(subject.kitchen) - self.stock.keys()
        self.max_count_by_cost = cache(self._max_count_by_cost)
        self.cost_denominator = cache(self._cost_denominator)
        self.unmet_preconditions = cache(self._unmet_preconditions)
        super().__init__(certificate, rules, subject)
        require(set(self.goals).issuperset(self.wanted_stated), "an amount is wanted of what is no goal")
        self.rounded = self._read_rounded()

    # --- what units do

    @cached_property
    def _flows(self) -> UnitFlows:
        """The flows of all units, each computed at its first use."""
        return UnitFlows(
            self.network, self.effects, self.utensils, self.amounts, self.stays_stated, self.budget
        )

    def flow(self, unit: int) -> Flow:
        """Return the copies that one execution of a unit needs, consumes and adds."""
        return self._flows.flow(unit)

    def _unmet_preconditions(self, unit: int) -> frozenset[int]:
        """Return the preconditions of a unit that initial copies do not satisfy.

        With the objective ``kitchen``, these are all preconditions, since initial copies are members of cuts.
        """
        return frozenset(o for o, n in self.flow(unit).asks.items() if self._is_lacking(o, n))

    def _is_lacking(self, o: int, copies: int) -> bool:
        """Return whether initial copies of a node are fewer than ``copies``.

        With the objective ``kitchen``, return ``True`` in all cases, since initial copies are members of
        cuts.
        """
        if "kitchen" in self.objectives:
            return True
        return o not in self.endless and copies > self.stock.get(o, 0)

    def copies_wanted(self, goal: int) -> int:
        """Return how many copies of a goal have to exist in the end."""
        return self.wanted_stated.get(goal, 1)

    @cached_property
    def idle(self) -> frozenset[int]:
        """The units that no plan executes: removed by a rule, or with an unreachable precondition.

        The certificate lists the unreachable nodes under ``unreached``. Refuse the list if one of its nodes
        is initial. Also refuse it if a unit could reach it: it is not removed, adds a listed node and needs
        no listed node.
        """
        network = self.network
        stated_ids = self.certificate["unreached"]
        unreached = frozenset(read_numbers(stated_ids, len(network.objects), ascending=stated_ids != []))
        removed = self.ruled.removed
        for o in unreached:
            self.budget.spend(1 + len(network.producers[o]))
            require(not self._is_initial(o), "what is there at first is called unreached")
            for unit in network.producers[o]:
                reaches = o in self.flow(unit).adds and unreached.isdisjoint(self.flow(unit).asks)
                require(unit in removed or not reaches, "what a unit can add is called unreached")
        needing_units = {
            unit for o in unreached for unit in network.consumers[o] if o in self.flow(unit).asks
        }
        return removed | needing_units

    def _is_initial(self, o: int) -> bool:
        """Return whether a node is endless or has copies in the stock."""
        return o in self.endless or self.stock.get(o, 0) > 0

    def _landmark(self, cut: frozenset[int]) -> Iterator[int]:
        """Yield the members of a cut, given as a set of nodes; a member may be yielded twice.

        They are the units that add a node of the cut and need no node of it, except units that no plan
        executes. The cut may have nodes that rules add. If the objective ``kitchen`` counts items, initial
        nodes of the cut are members, too. Otherwise, a cut with an endless node is refused.
        """
        network, makers_by_rules = self.network, self.ruled.makers
        self.budget.spend(
            sum(1 + len(makers_by_rules[o] if o in makers_by_rules else network.producers[o]) for o in cut)
        )
        units: list[int] = []
        for o in cut:
            if o in makers_by_rules:
                units += makers_by_rules[o]
                continue
            if self._is_initial(o):
                items_count = "kitchen" in self.objectives
                require(items_count or o not in self.endless, "a cut holds a kitchen item")
                yield from [len(network) + o] * items_count
            if o not in self.endless:
                units += (unit for unit in network.producers[o] if o in self.flow(unit).adds)
        yield from (u for u in units if u not in self.idle and cut.isdisjoint(self.unmet_preconditions(u)))

    # --- conditions on counts alone

    def balance(self, o: int) -> tuple[dict[int, int], int]:
        """Return the net effect of each unit on the copies of a node, and the copies wanted in the end.

        The copies wanted are 0 unless the node is a goal. Units without effect on the node are omitted.
        Refuse an endless node.
        """
        network = self.network
        read_number(o, range(len(network.objects)), "the id of a node in a balance")
        require(o not in self.endless, "what never runs out has no balance")
        changes = {}
        for unit in {*network.producers[o], *network.consumers[o]}:
            flow = self.flow(unit)
            if change := flow.adds.get(o, 0) - flow.uses.get(o, 0):
                changes[unit] = change
        return changes, self.copies_wanted(o) if o in self.goals else 0

    def _read_rounded(self) -> list[Row]:
        """Return the rounded sums of the certificate as rows.

        Each is a sum of balances, limits and earlier rounded sums, with weights above 0, which is then
        rounded (:func:`_round_row`).
        """
        rows: list[Row] = []
        for stated_sum in read_list(self.certificate["rounded"]):
            require(
                set(read_object(stated_sum)) <= {"balance", "limits", "rounded"},
                "expected sums of conditions",
            )
            coefficients, least = dict[int, Fraction](), Fraction(0)
            for key, weights in stated_sum.items():
                for (number,), text in self.read_rows(key, weights):
                    weight = read_rational(text)
                    require(weight > 0, "what is rounded has a weight that is not above zero")
                    row, row_least = self._condition_on_counts(key, number, rows)
                    least += weight * row_least
                    for unit, n in row.items():
                        coefficients[unit] = coefficients.get(unit, Fraction(0)) + weight * n
                        self.budget.spend_on_fractions(bit_length(coefficients[unit]))
            rows.append(_round_row(coefficients, least))
        return rows

    def _condition_on_counts(self, key: str, number: int, earlier_rows: Sequence[Row]) -> Row:
        """Return the condition of a certificate that ``key`` and ``number`` name, as a row.

        ``key`` is ``balance``, ``limits`` or ``rounded``. ``earlier_rows`` has the rounded sums before this
        one.
        """
        if key == "rounded":
            return earlier_rows[
                read_number(number, range(len(earlier_rows)), "the number of an earlier rounded sum")
            ]
        if key == "limits":
            limit = self.limit_at(number)
            return {unit: -amount for unit, amount in limit.amounts.items()}, -limit.max_sum
        changes, wanted = self.balance(number)
        return changes, wanted - self.stock.get(number, 0)

    # --- the plan

    def _execute(self, units: list[Any]) -> tuple[Amount, list[int | Fraction]]:
        """Execute the plan copy by copy; return its cost twice, as an amount and as written in a certificate.

        Refuse a plan that does not run, does not make the wanted copies of goals, or breaks a rule.
        """
        network = self.network
        copies, items_taken = Counter(self.stock), set[int]()
        initial_needed: Counter[int] = Counter()  # initial copies that the plan needs
        for step, stated_unit in enumerate(units):
            unit = read_number(stated_unit, range(len(network)), "ids of units in a plan")
            asks, uses, adds = self.flow(unit)
            self.budget.spend(1 + len(asks) + len(adds))
            require(
                all(o in self.endless or copies[o] >= n for o, n in asks.items()),
                f"unit {unit} of the plan lacks a copy of an input at step {step + 1}",
            )
            items_taken |= self.endless & asks.keys()
            for o in asks.keys() & self.stock.keys():
                initial_needed[o] = max(initial_needed[o], asks[o] + self.stock[o] - copies[o])
            copies.subtract({o: n for o, n in uses.items() if o not in self.endless})
            copies.update({o: n for o, n in adds.items() if o not in self.endless})
        for goal in set(self.goals) - self.endless:
            wanted_copies = self.copies_wanted(goal)
            require(copies[goal] >= wanted_copies, "a copy of a goal is not there in the end")
            if goal in self.stock:
                needed = wanted_copies + self.stock[goal] - copies[goal]
                initial_needed[goal] = max(initial_needed[goal], needed)
        self._require_kept_rules_by_counts(Counter(units))
        item_offset = len(network)
        members = [
            *units,
            *(item_offset + o for o in sorted(items_taken)),
            *(item_offset + o for o in sorted(initial_needed.elements())),
        ]
        total = self.arithmetic.sum(map(self._cost, members))
        return total, self.unit_costs.written_costs(units, total)

    def _require_kept_rules_by_counts(self, counts: Counter[int]) -> None:
        """Refuse a plan that breaks a rule; ``counts`` says how often it executes each unit.

        Limits count each execution.
        """
        ruled, units = self.ruled, frozenset(counts)
        require(not units & ruled.removed, "the plan has a unit that a rule removes")
        has_goals = all(not units.isdisjoint(ruled.makers[goal]) for goal in ruled.goals)
        require(has_goals and not ruled.never, "the plan lacks what a rule asks for")
        for limit in ruled.limits.values():
            total = sum((limit.amounts.get(unit, 0) * n for unit, n in counts.items()), Fraction(0))
            require(total <= limit.max_sum, "the plan exceeds what a rule limits")

    # --- the proof

    def _check_proof(self, proof: Any, least: Amount | None) -> None:
        """Check the proof of each objective: no plan costs less than ``least`` by it.

        Only plans that are as good by the earlier objectives are considered. If ``least`` is ``None``, the
        proof is that no plan exists. All costs are then 0, and bounds have to be above 0. If a rule allows no
        plan, ``least`` has to be ``None``, and the proof has to be empty.
        """
        proofs = read_list(proof)
        levels = range(max(1, len(self.objectives)))
        require(len(proofs) == len(levels), "expected a proof for each objective")
        if self.ruled.never:
            require(least is None, "a rule allows no plan")
            require(proofs == [{}], "a proof is given where a rule allows no plan")
            return
        self.least = least
        for level in levels:
            waiting = [Node(proofs[level], {}, {})]
            while waiting:
                node = waiting.pop()
                self.budget.spend(1 + len(node.min_counts) + len(node.max_counts))
                if "branch" in read_object(node.proof):
                    waiting += self._children(node)
                else:
                    self._check_leaf(node, level)

    def _children(self, node: Node) -> Iterator[Node]:
        """Yield the two children of a branching node.

        In the first, the count of a member is at most a certain number. In the second, it is above this
        number.
        """
        proof = read_object(node.proof, ("branch", "most", "up_to", "above"))
        member = self._read_branch_member(proof["branch"])
        max_count = read_number(proof["most"], COUNTS, "the most executions of a branch")
        up_to = min(max_count, node.max_counts.get(member, max_count))
        yield Node(proof["up_to"], node.min_counts, {**node.max_counts, member: up_to})
        above = max(max_count + 1, node.min_counts.get(member, 0))
        yield Node(proof["above"], {**node.min_counts, member: above}, node.max_counts)

    def _check_leaf(self, node: Node, level: int) -> None:
        """Check that the Farkas combination of a leaf proves the bound for the counts of this node.

        If a member has no possible count at the node, the leaf is accepted without a bound.
        """
        require(set(node.proof) <= _LEAF, "expected weights of conditions or a branch")
        conditions = _FarkasCombination(self, level, node.proof)
        bound = conditions.constant
        for member in sorted({*conditions.executed, *conditions.used, *node.min_counts, *node.max_counts}):
            cheapest = self._least_reduced_cost(member, level, node, conditions)
            if cheapest is None:
                return  # there are no such counts
            self.arithmetic.add_to(bound, cheapest)
        self._require_enough(bound, level)

    def _least_reduced_cost(
        self, member: int, level: int, node: Node, conditions: "_FarkasCombination"
    ) -> Amount | None:
        """Return the least reduced cost of a member over all its possible counts at a node.

        Return ``None`` if no count is possible. ``level`` is the index of the objective. For counts from 1
        on, the cost is linear in the count. So only the count 0 and the least and greatest count from 1 on
        are compared. If the cost falls with the count, and there is no greatest count, refuse the
        certificate.
        """
        arithmetic = self.arithmetic
        low, high = node.min_counts.get(member, 0), self._max_count(member, level, node)
        if high is not None and high < low:
            return None
        per_execution = arithmetic.sum(
            [self.amount_by_objective(member, level), conditions.executed.get(member, {})]
        )
        per_execution = arithmetic.sum(
            [
                per_execution,
                *(
                    arithmetic.times(w, self.cost_lower_bound(member, earlier_level))
                    for earlier_level, w in conditions.levels
                ),
            ]
        )
        once = conditions.used.get(member, {})
        ends: list[Amount] = [{}] if low == 0 else []
        if high is None or high >= 1:
            ends.append(arithmetic.sum([arithmetic.times(per_execution, Fraction(max(low, 1))), once]))
            if arithmetic.sign(per_execution) < 0:
                require(high is not None, f"member {member} brings more than it costs, without end")
                ends.append(arithmetic.sum([arithmetic.times(per_execution, Fraction(high or 0)), once]))
        cheapest = ends[0]
        for cost in ends[1:]:
            if arithmetic.sign(arithmetic.sum([cost, negate(cheapest)])) < 0:
                cheapest = cost
        return cheapest

    def _max_count(self, member: int, level: int, node: Node) -> int | None:
        """Return an upper bound on the count of a member at a node; ``None`` without a bound.

        Bounds come from branches, the stock, limits, and the claimed cost by this and earlier objectives. For
        a unit that no plan executes (``idle``), the bound is 0.
        """
        bounds = [node.max_counts[member]] if member in node.max_counts else []
        if member >= len(self.network):
            o = member - len(self.network)
            return min([*bounds, self.stock.get(o, 1)])
        if member in self.idle:
            return 0
        bounds += self._max_counts_by_limits(member)
        if self.least is not None:
            bounds += (
                cap
                for index in range(level + 1)
                if (cap := self.max_count_by_cost(member, index, index == level)) is not None
            )
        return min(bounds, default=None)

    def _max_counts_by_limits(self, unit: int) -> Iterator[int]:
        """Yield an upper bound on the count of a unit for each limit that counts it.

        Limits with negative amounts are skipped.
        """
        for limit in self.ruled.limits.values():
            amount = limit.amounts.get(unit, 0)
            if amount > 0 and min(limit.amounts.values()) >= 0:
                yield max(0, math.floor(limit.max_sum / amount))

    def _max_count_by_cost(self, unit: int, level: int, less: bool) -> int | None:
        """Return an upper bound on the count of a unit in plans of at most the claimed cost by an objective.

        With ``less``, the bound is for plans of less than the claimed cost, except by ``success``. Return
        ``None`` if an execution costs nothing.
        """
        per_execution, max_cost = self.cost_lower_bound(unit, level), self.claimed_cost(level)
        if per_execution == 0:
            return None
        is_strict = less and self.objectives[level] != "success"
        return math.ceil(max_cost / per_execution) - 1 if is_strict else math.floor(max_cost / per_execution)

    def amount_by_objective(self, member: int, level: int) -> Amount:
        """Return the cost of a member by the objective with the index ``level``, as an amount."""
        return {key: value for key, value in self._cost(member).items() if key[0] == level}

    def cost_lower_bound(self, member: int, level: int) -> Fraction:
        """Return a lower bound on the cost of a member by an objective, as one number.

        For objectives other than ``success``, it is the exact cost. For ``success``, it is ``-log`` of the
        rate, rounded down to a multiple of ``1 / LOGARITHM_SCALE``. A rate of 0 is refused, and an item costs
        0.
        """
        if self.objectives[level] != "success":
            return self.amount_by_objective(member, level).get((level, None), Fraction(0))
        if member >= len(self.network):
            return Fraction(0)
        require(self.unit_costs.rate(member) > 0, "a unit that never succeeds is not compared")
        return Fraction(
            math.floor(LOGARITHM_SCALE * self.arithmetic.minus_log(self.unit_costs.rate(member))[0]),
            LOGARITHM_SCALE,
        )

    def claimed_cost(self, level: int) -> Fraction:
        """Return the claimed least cost of plans by an objective, as one number.

        By ``success``, it is ``-log`` of the product, rounded up to a multiple of ``1 / LOGARITHM_SCALE``.
        """
        assert self.least is not None
        parts_of_claim = {rate: value for (index, rate), value in self.least.items() if index == level}
        if self.objectives[level] != "success":
            return parts_of_claim.get(None, Fraction(0))
        bounds = (
            [e * bound for bound in self.arithmetic.minus_log(rate)]
            for rate, e in parts_of_claim.items()
            if rate
        )
        return Fraction(math.ceil(LOGARITHM_SCALE * sum(map(max, bounds), Fraction(0))), LOGARITHM_SCALE)

    def cut_nodes(self, number: int) -> frozenset[int]:
        """Return the nodes of the cut with this number; refuse a number that no cut has."""
        return self.cuts[read_number(number, range(len(self.cuts)), "the number of a cut")]

    def holds_goal(self, nodes: frozenset[int]) -> bool:
        """Return whether a cut, a set of nodes, has a goal of a rule or a goal that needs more copies.

        A goal needs more copies if initial copies do not satisfy it. With the objective ``kitchen``, every
        goal that is not endless needs more copies.
        """
        has_goal = any(
            goal in nodes and goal not in self.endless and self._is_lacking(goal, self.copies_wanted(goal))
            for goal in self.goals
        )
        return has_goal or not nodes.isdisjoint(self.ruled.goals)

    def read_weight(self, stated: Any, level: int) -> Amount:
        """Return a stated weight for one objective as an amount.

        It is a fraction or, by ``success``, an object from rate to exponent.
        """
        parts = [*({} if objective == "success" else "0" for objective in self.objectives)] or ["0"]
        parts[level] = stated
        return {key: value for key, value in self.unit_costs.read_amount(parts).items() if key[0] == level}

    def _require_enough(self, bound: Amount, level: int) -> None:
        """Refuse a bound that is below the claimed cost by an objective.

        If ``cost_denominator`` is not ``None``, the bound is first rounded up to a multiple of ``1 /
        cost_denominator``. If the claim is that no plan exists, refuse a bound that is not above 0.
        """
        if self.least is None:
            enough = self.arithmetic.sign(bound) > 0
        else:
            denominator = self.cost_denominator(level)
            if denominator is not None:
                (key,) = bound or [(level, None)]
                bound = {key: Fraction(math.ceil(bound.get(key, Fraction(0)) * denominator), denominator)}
            claimed = {key: value for key, value in self.least.items() if key[0] == level}
            enough = self.arithmetic.sign(self.arithmetic.sum([bound, negate(claimed)])) >= 0
        require(enough, "the weights do not add up to enough")

    def _cost_denominator(self, level: int) -> int | None:
        """Return the least common denominator of the costs of units by an objective.

        Return ``None`` if the objective is ``success``, ``dissimilarity`` or a measure: bounds by these are
        not rounded.
        """
        objective = self.objectives[level]
        if objective in {"success", "dissimilarity"} or objective in self.unit_costs.measures:
            return None
        if objective == "price":
            costs = self.unit_costs.prices
        elif objective == "attempts":
            costs = [1 / self.unit_costs.rate(unit) for unit in range(len(self.network))]
        else:
            costs = []
        return math.lcm(*(cost.denominator for cost in costs))


class _FarkasCombination:
    """A Farkas combination: conditions on counts with weights from 0, added up.

    ``executed``: the coefficient of each member for each execution, or for each copy taken.
    ``used``: the coefficient of each member for being executed at all.
    ``constant``: the right-hand side of the sum.
    ``levels``: the weights of earlier objectives, as pairs of the objective's index and the weight.

    Coefficients have the sign reversed, so that they can be added to costs.
    """

    def __init__(self, check: PlanCheck, level: int, proof: Mapping[str, Any]) -> None:
        """Read the weighted conditions of a proof for the objective with the index ``level``; add them up.

        The cuts among them count as used by the proof.
        """
        self.check, self.level, self.proof = check, level, proof
        self.constant: Amount = {}
        self.executed: dict[int, Amount] = {}
        self.used: dict[int, Amount] = {}
        self.levels: list[tuple[int, Amount]] = []
        units = len(check.network)
        for (cut,), weight in self._weighted_rows("weights"):
            self._add_cut(cut, weight, check.holds_goal(check.cut_nodes(cut)))
        for (cut, stated), weight in self._weighted_rows("before", 2):
            unit = read_number(stated, range(units), "the id of a unit that a cut is before")
            self._add_cut(cut, weight, not check.cut_nodes(cut).isdisjoint(check.unmet_preconditions(unit)))
            self._add_coefficient(self.used, unit, weight, 1)
            self._add_to_constant(weight, -1)
        for (o, stated), weight in self._weighted_rows("supply", 2):
            self._add_supply(
                o, read_number(stated, range(units), "the id of a unit that is supplied"), weight
            )
        for (o,), weight in self._weighted_rows("balance"):
            self._add_balance(o, weight)
        for (number,), weight in self._weighted_rows("limits"):
            limit = check.limit_at(number)
            self._add_to_constant(weight, -limit.max_sum)
            for member, amount in limit.amounts.items():
                self._add_coefficient(self.executed, member, weight, amount)
        for (number,), weight in self._weighted_rows("rounded"):
            rows = check.rounded
            row, least = rows[read_number(number, range(len(rows)), "the number of a rounded sum")]
            self._add_to_constant(weight, least)
            for unit, coefficient in row.items():
                self._add_coefficient(self.executed, unit, weight, -coefficient)
        for (number,), weight in self._weighted_rows("levels"):
            require(0 <= number < level, "an objective that is not before this one is given a weight")
            self._add_to_constant(weight, -check.claimed_cost(number))
            self.levels.append((number, weight))

    def _weighted_rows(self, key: str, name_length: int = 1) -> Iterator[tuple[list[int], Amount]]:
        """Yield the weighted conditions under a key: a list of the numbers that name one, and its weight.

        ``name_length`` is the length of the list.
        """
        read = partial(self.check.read_weight, level=self.level)
        return self.check.read_weights(key, self.proof.get(key, []), read, name_length)

    def _add_cut(self, cut: int, weight: Amount, holds: bool) -> None:
        """Add the condition of a cut: a member is executed, or a copy of an item in it is taken.

        ``holds`` says whether the cut has a goal or, for a cut before a unit, a precondition of this unit. If
        not, the cut is refused. The cut is recorded as used.
        """
        check = self.check
        require(holds, f"cut {cut} holds neither a goal nor what the unit asks for")
        check.used_cuts.add(cut)
        self._add_to_constant(weight, 1)
        for member in check.members[cut]:
            coefficients = self.used if member < len(check.network) else self.executed
            self._add_coefficient(coefficients, member, weight, -1)

    def _add_balance(self, o: int, weight: Amount) -> None:
        """Add the balance of a node: its initial copies and net effects are at least the copies wanted."""
        changes, wanted = self.check.balance(o)
        self._add_to_constant(weight, wanted - self._initial_copies(o, weight))
        for unit, change in changes.items():
            self._add_coefficient(self.executed, unit, weight, -change)

    def _add_supply(self, o: int, supplied: int, weight: Amount) -> None:
        """Add the condition that the unit ``supplied`` gets the copies of a node that it needs.

        These copies are initial or added by other units, since the unit adds none before its first execution.
        Refuse an endless node.
        """
        check, network = self.check, self.check.network
        read_number(o, range(len(network.objects)), "the id of a node in a supply")
        require(o not in check.endless, "what never runs out needs no supply")
        self._add_to_constant(weight, -self._initial_copies(o, weight))
        self._add_coefficient(self.used, supplied, weight, check.flow(supplied).asks.get(o, 0))
        for unit in network.producers[o]:
            if unit != supplied and (added := check.flow(unit).adds.get(o, 0)):
                self._add_coefficient(self.executed, unit, weight, -added)

    def _initial_copies(self, o: int, weight: Amount) -> int:
        """Return the number of initial copies of a node, to be used as a constant.

        With the objective ``kitchen``, taking copies has a cost. The item is then added as a member with this
        weight, and 0 is returned.
        """
        check = self.check
        initial = check.stock.get(o, 0)
        if "kitchen" in check.objectives and initial:
            self._add_coefficient(self.executed, len(check.network) + o, weight, -1)
            return 0
        return initial

    def _add_to_constant(self, weight: Amount, factor: int | Fraction) -> None:
        """Add ``factor`` times a weight to the right-hand side."""
        self.constant = self._plus_multiple(self.constant, weight, factor)

    def _add_coefficient(
        self, coefficients: dict[int, Amount], member: int, weight: Amount, factor: int | Fraction
    ) -> None:
        """Add ``factor`` times a weight to the coefficient of a member in ``coefficients``, in place."""
        coefficients[member] = self._plus_multiple(coefficients.get(member, {}), weight, factor)

    def _plus_multiple(self, amount: Amount, weight: Amount, factor: int | Fraction) -> Amount:
        """Return an amount plus ``factor`` times a weight."""
        arithmetic = self.check.arithmetic
        return arithmetic.sum([amount, arithmetic.times(weight, Fraction(factor))])


def _round_row(coefficients: Mapping[int, Fraction], least: Fraction) -> Row:
    """Return a row that follows from the given one for whole counts from 0 (mixed-integer rounding).

    The given row has coefficients by unit, and the lower bound ``least`` on the weighted sum. A whole
    ``least`` is refused.
    """
    fraction = least - math.floor(least)
    require(fraction > 0, "a sum is rounded that is whole")

    def rounded(coefficient: Fraction) -> Fraction:
        """Return the coefficient of a unit in the rounded row."""
        below = math.floor(coefficient)
        return below + min(Fraction(1), (coefficient - below) / fraction)

    return {unit: rounded(n) for unit, n in coefficients.items()}, math.ceil(least)
