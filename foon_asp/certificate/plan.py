"""Certificates of plans with consumable items: the question as plain arrays, and its proofs as JSON."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from operator import add
from typing import Any

from foon_asp.certificate.arrays import fraction_text
from foon_asp.certificate.certificate import Certificate, Claimed, subject_of, write_certificate
from foon_asp.certificate.coverage import NOTHING, Coverage
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector, minus_log
from foon_asp.network import ObjectNode
from foon_asp.plans.conditions import (
    Balance,
    Condition,
    Landmark,
    Level,
    Measure,
    Rounded,
    Sum,
    SumLimit,
    Supply,
)
from foon_asp.plans.count_proof import Claim, CountProof, PlanProver, Split
from foon_asp.plans.flows import Flows, flows_of
from foon_asp.problem import (
    Objective,
    OptionalData,
    Problem,
    Restriction,
    first_tree,
    multiplies,
    reach,
    units_relevant_to_plans,
)
from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.refusal import CheckLimitError
from foon_asp.proof.rule_meaning import OWN
from foon_asp.proof.verify_plan import LOGARITHM_SCALE, PLAN, PLAN_RULES

_HALF = Fraction(1, 2)


def covered_for_plans(covered: Coverage) -> Coverage:
    """Return the coverage for plans: rules that certificates of plans cannot check go to ``not_covered``.

    Claims about user rules, and limits by user rules, are dropped.
    """
    rules = tuple(rule for rule in covered.rules if rule["rule"] in PLAN_RULES)
    others = {canonical_json(rule) for rule in covered.rules if rule not in rules and rule["rule"] != OWN}
    return Coverage(rules, tuple(sorted({*covered.not_covered, *others})))


def certify_plan(
    problem: Problem,
    objectives: Sequence[Objective],
    plan: Sequence[int],
    covered: Coverage = NOTHING,
    expired: Callable[[], bool] = lambda: False,
) -> Certificate | None:
    """Certify that a plan is optimal, by as many of the first objectives as are proved, or certify a bound.

    ``plan`` lists unit ids in the order of execution. ``expired`` returns whether time is up. Return ``None``
    if nothing is proved before that, or if the certificate is beyond the limits of the verifier. An objective
    that needs rates is not proved if a rate is 0. Some units may have rates that differ from the rates of
    their motions. Then return ``None`` if an objective needs rates or rules are covered.
    """
    if problem.own_rates and (covered.rules or any(o.row.needs is OptionalData.RATES for o in objectives)):
        return None
    question = _PlanQuestion(problem, covered_for_plans(covered), plan, expired)
    certified: list[Objective] = []
    for objective in objectives:
        if objective.row.needs is OptionalData.RATES and not all(
            map(problem.rate, range(len(problem.network)))
        ):
            break
        proved = question.prove(objective, certified)
        if proved is None:
            break
        proof, least = proved
        if least is not None:
            return question.write_certificate("bound", [objective], [proof], plan, [least])
        certified.append(objective)
        question.proofs.append(proof)
        if expired():
            break
    if not certified:
        return None
    return question.write_certificate("optimal", certified, question.proofs, plan)


def certify_no_plan(
    problem: Problem, covered: Coverage = NOTHING, expired: Callable[[], bool] = lambda: False
) -> Certificate | None:
    """Return a certificate that there is no plan; ``None`` if that is not proved before time is up.

    Also return ``None`` if the certificate is beyond the limits of the verifier. The result is ``None``, too,
    if rules are covered and units have rates that differ from the rates of their motions.
    """
    if covered.rules and problem.own_rates:
        return None
    question = _PlanQuestion(problem, covered_for_plans(covered), (), expired)
    proof = question.prove_none()
    return None if proof is None else question.write_certificate("infeasible", (), [proof])


class _PlanQuestion:
    """A question about plans as arrays, and the parts of its certificate.

    The *actions* are the relevant units, by position among them. Conditions on counts are those of
    :mod:`foon_asp.plans.conditions`. The cuts, balances and rounded conditions that proofs use are collected,
    and then written with the certificate. ``proofs`` has the JSON of a proof for each objective proved so
    far.
    """

    def __init__(
        self, problem: Problem, covered: Coverage, plan: Sequence[int], expired: Callable[[], bool]
    ) -> None:
        """Compute the reachable nodes, the relevant units, and the limits of rules in integers."""
        self._problem, self._covered, self._plan, self._expired = problem, covered, plan, expired
        self._ruled = ruled = covered.compile_rules(problem)
        self.proofs: list[Any] = []
        self._cuts: dict[tuple[int, ...], int] = {}
        self._balanced: set[int] = set()
        self._rounded: list[Rounded] = []
        self._rounded_stated: list[Any] = []
        required = tuple(frozenset(ruled.makers[goal]) for goal in ruled.goals)
        initial = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        restriction = Restriction(ruled.removed.__contains__, required)
        self._simplified = replace(problem, kitchen=initial, restriction=restriction)
        self._reached = reached = reach(self._simplified)
        self._units = sorted(reached.units if required else units_relevant_to_plans(problem, reached))
        self._limits: list[tuple[int, SumLimit, int]] = []  # number of the rule, the sum and its scale
        for rule_number, limit in ruled.limits.items():
            scale = math.lcm(
                limit.max_sum.denominator, *(amount.denominator for amount in limit.amounts.values())
            )
            weights = {a: int(limit.amounts.get(unit, 0) * scale) for a, unit in enumerate(self._units)}
            weights = {a: weight for a, weight in weights.items() if weight}
            self._limits.append((rule_number, (weights, int(limit.max_sum * scale), False, False), scale))

    # --- finding

    def prove(
        self, objective: Objective, earlier_objectives: Sequence[Objective]
    ) -> tuple[Any, Vector | None] | None:
        """Prove that no plan costs less than the plan in hand by an objective, or prove a bound.

        Only plans that are as good by ``earlier_objectives`` count. Return a pair: the JSON of the proof, and
        the proved bound. The bound is ``None`` if no plan costs less than the plan in hand. A bound below
        that cost is proved for the first objective only. If the plan in hand costs nothing, the proof is
        empty. Return ``None`` instead of a pair if nothing is proved.
        """
        earlier_levels = [self._level(earlier_objective) for earlier_objective in earlier_objectives]
        if any(level is None for level in earlier_levels):
            return None
        levels = [level for level, _ in filter(None, earlier_levels)]
        scales = [scale for _, scale in filter(None, earlier_levels)]
        claim = self._claim(objective)
        if claim.least is None or not claim.order.sign(claim.least):
            return {}, None  # nothing costs less than nothing
        prover = self._prover([a for a, unit in enumerate(self._units) if unit in self._plan])
        measure = Measure([0] * len(self._units), objective.row.item)
        proved = prover.prove_claim(claim, measure, levels)
        if proved is None:
            return None
        proof, least, columns = proved
        if least != claim.least and earlier_objectives:
            return None
        writer = _ProofWriter(self, claim.order if multiplies(objective) else None, levels, scales, columns)
        return writer.proof(proof), None if least == claim.least else least

    def prove_none(self) -> Any | None:
        """Return the JSON of a proof that there is no plan; ``None`` if none is found.

        If a rule excludes every plan, the proof is empty.
        """
        problem, ruled = self._problem, self._ruled
        if ruled.never:
            return {}
        goals = [goal for goal in problem.goals if not self._reached.available[goal]]
        reached = set(self._reached.units)
        goals += [goal for goal in ruled.goals if reached.isdisjoint(ruled.makers[goal])]
        if goals:  # a cut that nothing crosses
            return {"weights": [[self.cut_number((goals[0],)), "1"]]}
        order = Lexicographic([None])
        nothing = [order.zero] * len(self._units)
        claim = Claim(order, nothing, order.zero, None, None, [None] * len(nothing))
        tree = first_tree(self._simplified, self._reached) or ()
        prover = self._prover([a for a, unit in enumerate(self._units) if unit in tree])
        proved = prover.prove_claim(claim, Measure([0] * len(nothing)), ())
        if proved is None:
            return None
        proof, _, columns = proved
        return _ProofWriter(self, None, (), (), columns).proof(proof)

    def _prover(self, derivation: Sequence[int]) -> PlanProver:
        """Return a prover of the question, with the limits and the required sets of rules.

        ``derivation`` has the actions of some plan or tree, which the prover starts from.
        """
        flows: Flows = flows_of(self._problem, self._units)
        limits = [limit for _, limit, _ in self._limits]
        prover = PlanProver(flows, (), limits, derivation, expired=self._expired)
        ruled, actions_by_unit = self._ruled, {unit: a for a, unit in enumerate(self._units)}
        makers = {
            goal: tuple(actions_by_unit[u] for u in ruled.makers[goal] if u in actions_by_unit)
            for goal in ruled.goals
        }
        prover.add_known_landmarks([Landmark(members, objects=(goal,)) for goal, members in makers.items()])
        return prover

    def _unit_costs(self, objective: Objective) -> list[Fraction]:
        """Return the cost of each action by an objective; its rate if the objective multiplies rates."""
        return list(map(Fraction, self._problem.figures(objective, self._units)))

    def _claim(self, objective: Objective) -> Claim:
        """Return the claim that no plan costs less than the plan in hand by an objective.

        If the objective multiplies rates, costs have a coordinate for each rate below 1.
        """
        problem, unit_costs = self._problem, self._unit_costs(objective)
        if multiplies(objective):
            rates = sorted({rate for rate in unit_costs if rate != 1}) or [_HALF]
            order = Lexicographic([rates])
            counts = Counter(problem.rate(unit) for unit in self._plan)
            least = tuple(Fraction(counts[rate]) for rate in rates)
            costs = [tuple(Fraction(rate == own_rate) for own_rate in rates) for rate in unit_costs]
            plan_cost = order.approximate(least)[0]
            float_costs = (order.approximate(cost)[0] for cost in costs)
            caps = [math.floor(plan_cost / cost + 1e-6) if cost else None for cost in float_costs]
            return Claim(order, costs, order.zero, least, None, caps)
        cost = Fraction(problem.costs(self._plan).measure(objective))
        parts = None
        if objective not in problem.measures:
            all_unit_costs = problem.figures(objective, range(len(problem.network)))
            parts = math.lcm(*(Fraction(unit_cost).denominator for unit_cost in all_unit_costs))
        caps = [math.ceil(cost / unit_cost) - 1 if unit_cost else None for unit_cost in unit_costs]
        order = Lexicographic([None])
        return Claim(order, [(f,) for f in unit_costs], (Fraction(objective.row.item),), (cost,), parts, caps)

    def _level(self, objective: Objective) -> tuple[Level, int] | None:
        """Return the level of an objective in integers, and the scale of the integers.

        The level is the condition that a plan costs no more than the plan in hand. Return ``None`` if the
        integers would be too long.
        """
        unit_costs = self._unit_costs(objective)
        if multiplies(objective):
            costs = [_scaled_minus_log(rate, up=False) for rate in unit_costs]
            max_cost = sum(_minus_log_bound(self._problem.rate(unit), up=True) for unit in self._plan)
            return Level(Measure(costs), Fraction(0), math.ceil(LOGARITHM_SCALE * max_cost)), LOGARITHM_SCALE
        cost = Fraction(self._problem.costs(self._plan).measure(objective))
        scale = math.lcm(cost.denominator, *(unit_cost.denominator for unit_cost in unit_costs))
        if scale * max(unit_costs, default=0) > 10**9:  # conditions would be written with longer numbers
            return None
        measure = Measure([int(scale * unit_cost) for unit_cost in unit_costs], scale * objective.row.item)
        return Level(measure, scale * cost, int(scale * cost)), scale

    # --- writing

    def cut_number(self, objects: Iterable[int]) -> int:
        """Return the number of a cut in the certificate; a new cut is added to it."""
        return self._cuts.setdefault(tuple(sorted(set(objects))), len(self._cuts))

    def use_balance(self, o: int) -> int:
        """Record that the proof uses the balance of an object node, and return the node."""
        self._balanced.add(o)
        return o

    def rounded_number(self, condition: Rounded) -> int:
        """Return the number of a rounded condition in the certificate.

        A new condition is added to the certificate, after the rounded conditions that it adds up.
        """
        number = next(
            (i for i, earlier_condition in enumerate(self._rounded) if earlier_condition is condition), None
        )
        if number is not None:
            return number
        by_kind: dict[str, dict[int, Fraction]] = {}
        for summand, weight in condition.weights:
            kind, index, scale = self.count_reference(summand)
            weights = by_kind.setdefault(kind, {})
            weights[index] = weights.get(index, Fraction(0)) + weight * scale
        self._rounded.append(condition)
        self._rounded_stated.append(
            {
                kind: [[index, fraction_text(weight)] for index, weight in sorted(weights.items())]
                for kind, weights in sorted(by_kind.items())
            }
        )
        return len(self._rounded) - 1

    def count_reference(self, condition: Condition) -> tuple[str, int, Fraction]:
        """Return how the certificate refers to a condition: its kind, its number, and a factor.

        The kind is ``balance``, ``limits`` or ``rounded``. The number of a balance is the id of its node. The
        weight of the condition is multiplied by the factor. The condition is recorded as used.
        """
        if isinstance(condition, Balance):
            return "balance", self.use_balance(condition.object), Fraction(1)
        if isinstance(condition, Sum):
            number, scale = self.limit_and_scale(condition.limit)
            return "limits", number, Fraction(scale)
        assert isinstance(condition, Rounded)
        return "rounded", self.rounded_number(condition), condition.scale

    def unit(self, action: int) -> int:
        """Return the unit of an action, by id."""
        return self._units[action]

    def limit_and_scale(self, number: int) -> tuple[int, int]:
        """Return the certificate's number of a limit of the prover, and the scale of its integers."""
        rule_number, _, scale = self._limits[number]
        return rule_number, scale

    def _unreachable_nodes(self) -> list[int]:
        """Return unreachable nodes, ascending, which show that certain irrelevant units cannot be executed.

        The proofs look at nodes of cuts and balanced nodes. Each irrelevant unit that adds such a node has a
        returned node as a precondition. So does each unit that adds a returned node.
        """
        flows, units, removed = self._problem.flows, set(self._units), self._ruled.removed
        proof_nodes = {o for cut in self._cuts for o in cut} | self._balanced
        makers_by_rule = self._ruled.makers
        proof_nodes -= self._problem.endless  # of which only taking them crosses a cut
        makers = (
            makers_by_rule[o] if o in makers_by_rule else self._achievers(o) for o in sorted(proof_nodes)
        )
        waiting = [u for units_of in makers for u in units_of if u not in units and u not in removed]
        unreached: set[int] = set()
        while waiting:
            preconditions = flows[waiting.pop()].asks
            if unreached.isdisjoint(preconditions):
                unreachable_node = next(o for o in preconditions if not self._reached.available[o])
                unreached.add(unreachable_node)
                waiting += (unit for unit in self._achievers(unreachable_node) if unit not in removed)
        return sorted(unreached)

    def _achievers(self, o: int) -> list[int]:
        """Return all units that add copies of a node."""
        return [unit for unit in self._problem.makers[o] if o in self._problem.flows[unit].adds]

    def _amounts_json(self) -> list[list[Any]]:
        """Return the JSON of stated amounts: for each unit of the data, a list of its id, inputs and outputs.

        Inputs and outputs are pairs of a node id and an amount. Units without stated amounts are left out.
        """
        network = self._problem.network
        by_id = ((network.unit_id(unit), sides) for unit, sides in self._problem.amounts.items())
        return [
            [unit, *(sorted([network.object_id(node), n] for node, n in side.items()) for side in sides)]
            for unit, sides in sorted(((u, s) for u, s in by_id if u is not None), key=lambda row: row[0])
            if any(sides)
        ]

    def write_certificate(
        self,
        claim: str,
        objectives: Sequence[Objective],
        proofs: Sequence[Any],
        plan: Sequence[int] | None = None,
        bound: Sequence[Vector] | None = None,
    ) -> Certificate | None:
        """Return a verified certificate of a claim; ``None`` if it is beyond the limits of the verifier.

        ``bound`` has the bound by the first objective, for the claim ``bound``.
        """
        problem = self._problem
        items, network = problem.items, problem.network
        assert items is not None
        stock = sorted((o, problem.stock_of(o) or 0) for o in problem.kitchen - problem.endless)
        stated_labels = ((name, stays) for name, stays in items.told.items() if isinstance(name, str))
        nodes = (
            (network.object_id(name), stays)
            for name, stays in items.told.items()
            if isinstance(name, ObjectNode)
        )
        stated_nodes = ((o, stays) for o, stays in nodes if o is not None)
        try:
            cost_order = None if bound is None else self._claim(objectives[0]).order
            bound_json = None if bound is None else [weight_json(vector, cost_order) for vector in bound]
        except CheckLimitError:
            return None
        return write_certificate(
            PLAN,
            problem,
            Claimed(claim, tuple(objectives), plan, bound_json),
            self._covered,
            [list(cut) for cut in self._cuts],
            list(proofs),
            subject_of(problem),
            items={
                "stock": [list(pair) for pair in stock],
                "stays": [list(pair) for pair in (*sorted(stated_labels), *sorted(stated_nodes))],
                "wanted": [[o, n] for o in sorted(problem.goals) if (n := problem.wanted(o)) > 1],
                "amounts": self._amounts_json(),
            },
            rounded=self._rounded_stated,
            unreached=self._unreachable_nodes(),
        )


class _ProofWriter:
    """Writer of the JSON of proofs about counts, by one objective.

    ``order``: the order of costs by an objective that multiplies rates, else ``None``.
    ``levels``, ``scales``: the levels of earlier objectives, and the scales of their integers.
    ``columns``: for each column of the linear program that is no action, the id of its kitchen item.
    """

    def __init__(
        self,
        question: _PlanQuestion,
        order: Lexicographic | None,
        levels: Sequence[Level],
        scales: Sequence[int],
        columns: Mapping[int, int],
    ) -> None:
        self._question, self._order, self._columns = question, order, columns
        self._levels = [(level, scale) for level, scale in zip(levels, scales, strict=True)]

    def proof(self, proof: CountProof) -> Any:
        """Return the JSON of a proof, with its branches.

        The cuts, balances and rounded conditions that it uses are recorded in the question.
        """
        if isinstance(proof, Split):
            item = self._columns.get(proof.column)
            branch = {"unit": self._question.unit(proof.column)} if item is None else {"item": item}
            above, up_to = self.proof(proof.above), self.proof(proof.up_to)
            return {"branch": branch, "most": proof.max_count, "up_to": up_to, "above": above}
        by_kind: dict[str, dict[tuple[int, ...], Vector]] = {}
        for condition, weight in proof.weights:
            kind, key, scale = self._reference(condition)
            scaled = tuple(scale * coordinate for coordinate in weight)
            previous = by_kind.setdefault(kind, {}).get(key)
            by_kind[kind][key] = scaled if previous is None else tuple(map(add, previous, scaled))
        return {
            kind: [[*key, weight_json(weight, self._order)] for key, weight in sorted(weights.items())]
            for kind, weights in by_kind.items()
        }

    def _reference(self, condition: Condition) -> tuple[str, tuple[int, ...], int | Fraction]:
        """Return how the certificate refers to a condition: its kind, the numbers that name it, and a factor.

        The weight of the condition is multiplied by the factor. The condition is recorded as used.
        """
        question = self._question
        if isinstance(condition, Landmark):
            cut = question.cut_number(condition.objects)
            if condition.action is None:
                return "weights", (cut,), 1
            return "before", (cut, question.unit(condition.action)), 1
        if isinstance(condition, Supply):
            key = question.use_balance(condition.object), question.unit(condition.action)
            return "supply", key, 1
        if isinstance(condition, (Balance, Sum, Rounded)):
            kind, number, factor = question.count_reference(condition)
            return kind, (number,), factor
        index = next(index for index, (level, _) in enumerate(self._levels) if level is condition)
        return "levels", (index,), self._levels[index][1]


def weight_json(weight: Vector, order: Lexicographic | None) -> str | dict[str, str]:
    """Return the JSON of a weight: a fraction as text or, with rates in ``order``, the exponents by rate."""
    rates = None if order is None else order.levels[0]
    if rates is None:
        return fraction_text(weight[0])
    return {str(rate): fraction_text(e) for rate, e in zip(rates, weight, strict=True) if e}


def _minus_log_bound(rate: Fraction, up: bool) -> Fraction:
    """Return a bound of ``-log(rate)`` in 60 digits: an upper one if ``up``, else a lower one."""
    if rate == 1:
        return Fraction(0)
    approximation, error = minus_log(rate, 60)
    return approximation + error if up else approximation - error


def _scaled_minus_log(rate: Fraction, up: bool) -> int:
    """Return ``LOGARITHM_SCALE`` times a bound of ``-log(rate)``, rounded down.

    The bound is an upper one if ``up``, else a lower one.
    """
    return math.floor(LOGARITHM_SCALE * _minus_log_bound(rate, up))
