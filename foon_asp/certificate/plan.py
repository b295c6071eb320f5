"""Certificates of plans, where items are used up: what is asked as plain arrays, and proofs as JSON."""

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from operator import add
from typing import Any

from foon_asp.asp.used_up import flows_of
from foon_asp.bounds.counts import Balance, Condition, Flows, Landmark, Level, Measure, Sum, SumLimit
from foon_asp.bounds.lexicographic import Lexicographic, Vector, minus_log
from foon_asp.bounds.plan_proof import Claim, CountProof, PlanProver, Split
from foon_asp.certificate.arrays import written
from foon_asp.certificate.certificate import Certificate, Claimed, subject_of, write
from foon_asp.certificate.coverage import NOTHING, Coverage
from foon_asp.network import ObjectNode
from foon_asp.problem import (
    Known,
    Objective,
    Problem,
    Restriction,
    first_tree,
    multiplies,
    reach,
    relevant_to_plans,
)
from foon_asp.proof import verify
from foon_asp.proof.constraint import OWN
from foon_asp.proof.verify_plan import FINE, PLAN, RULES

_LARGEST = 10**9  # a cost of a unit, as a whole number that conditions are written with
_DIGITS = 60  # of a logarithm
_NEAR = 1e-6
_HALF = Fraction(1, 2)


def covered_for_plans(covered: Coverage) -> Coverage:
    """Leave to what is not covered the rules that plans are not held against by certificates."""
    rules = tuple(rule for rule in covered.rules if rule["rule"] in RULES)
    others = {verify.canonical(rule) for rule in covered.rules if rule not in rules and rule["rule"] != OWN}
    return Coverage(rules, tuple(sorted({*covered.not_covered, *others})))


def certify_plan(
    problem: Problem,
    objectives: Sequence[Objective],
    plan: Sequence[int],
    covered: Coverage = NOTHING,
    expired: Callable[[], bool] = lambda: False,
) -> Certificate | None:
    """Prove a plan optimal by as many objectives from the first as can be, or a bound by the first.

    ``plan`` lists units in the order of execution. ``None`` where nothing is proved before ``expired`` says
    so, and for objectives that need rates with rates of 0, or with rates that are not those of the motions.
    """
    if problem.own_rates and (covered.rules or any(o.row.needs is Known.RATES for o in objectives)):
        return None
    question = _Question(problem, covered_for_plans(covered), plan, expired)
    certified: list[Objective] = []
    for objective in objectives:
        if objective.row.needs is Known.RATES and not all(map(problem.rate, range(len(problem.network)))):
            break
        found = question.prove(objective, certified)
        if found is None:
            break
        proof, least = found
        if least is not None:
            return question.write("bound", [objective], [proof], plan, [least])
        certified.append(objective)
        question.proofs.append(proof)
        if expired():
            break
    if not certified:
        return None
    return question.write("optimal", certified, question.proofs, plan)


def certify_no_plan(
    problem: Problem, covered: Coverage = NOTHING, expired: Callable[[], bool] = lambda: False
) -> Certificate | None:
    """Prove that there is no plan; ``None`` where that is not proved before ``expired`` says so."""
    if covered.rules and problem.own_rates:
        return None
    question = _Question(problem, covered_for_plans(covered), (), expired)
    proof = question.prove_none()
    return None if proof is None else question.write("infeasible", (), [proof])


class _Question:
    """What is asked of plans, in numbers: the units that can matter are actions, by place."""

    def __init__(
        self, problem: Problem, covered: Coverage, plan: Sequence[int], expired: Callable[[], bool]
    ) -> None:
        self._problem, self._covered, self._plan, self._expired = problem, covered, plan, expired
        self._ruled = ruled = covered.ruled(problem)
        self.proofs: list[Any] = []
        self._cuts: dict[tuple[int, ...], int] = {}
        self._balanced: set[int] = set()
        required = tuple(frozenset(ruled.makers[goal]) for goal in ruled.goals)
        there = frozenset(o for o in problem.kitchen if problem.stock_of(o) != 0)
        left = Restriction(ruled.removed.__contains__, required)
        self._lasting = replace(problem, kitchen=there, restriction=left)
        self._reached = reached = reach(self._lasting)
        self._units = sorted(reached.units if required else relevant_to_plans(problem, reached))
        self._adders: dict[int, list[int]] = {}
        for unit, flow in enumerate(problem.flows):
            for o in flow.adds:
                self._adders.setdefault(o, []).append(unit)
        self._limits: list[tuple[int, SumLimit, int]] = []  # place of the rule, the sum and its scale
        for place, limit in ruled.limits.items():
            scale = math.lcm(limit.most.denominator, *(each.denominator for each in limit.amounts.values()))
            weights = {a: int(limit.amounts.get(unit, 0) * scale) for a, unit in enumerate(self._units)}
            weights = {a: weight for a, weight in weights.items() if weight}
            self._limits.append((place, (weights, int(limit.most * scale), False, False), scale))

    # --- finding

    def prove(self, objective: Objective, before: Sequence[Objective]) -> tuple[Any, Vector | None] | None:
        """Prove what the plan costs by an objective, of all that are as good by those before.

        Gives the proof, and by the first objective the bound where that is less.
        """
        kept = [self._level(each) for each in before]
        if any(level is None for level in kept):
            return None
        levels = [level for level, _ in filter(None, kept)]
        scales = [scale for _, scale in filter(None, kept)]
        claim = self._claim(objective)
        if claim.least is None or not claim.order.sign(claim.least):
            return {}, None  # nothing costs less than nothing
        prover = self._prover([a for a, unit in enumerate(self._units) if unit in self._plan])
        measure = Measure([0] * len(self._units), objective.row.item)
        found = prover.prove_claim(claim, measure, levels)
        if found is None:
            return None
        proof, least, columns = found
        if least != claim.least and before:
            return None
        stated = _Stated(self, claim.order if multiplies(objective) else None, levels, scales, columns)
        return stated.proof(proof), None if least == claim.least else least

    def prove_none(self) -> Any | None:
        """Prove that there is no plan."""
        problem, ruled = self._problem, self._ruled
        if ruled.never:
            return {}
        goals = [goal for goal in problem.goals if not self._reached.available[goal]]
        reached = set(self._reached.units)
        goals += [goal for goal in ruled.goals if reached.isdisjoint(ruled.makers[goal])]
        if goals:  # a cut that nothing crosses
            return {"weights": [[self.cut((goals[0],)), "1"]]}
        order = Lexicographic([None])
        nothing = [order.zero] * len(self._units)
        claim = Claim(order, nothing, order.zero, None, None, [None] * len(nothing))
        tree = first_tree(self._lasting, self._reached) or ()
        prover = self._prover([a for a, unit in enumerate(self._units) if unit in tree])
        found = prover.prove_claim(claim, Measure([0] * len(nothing)), ())
        return None if found is None else _Stated(self, None, (), (), found[2]).proof(found[0])

    def _prover(self, derivation: Sequence[int]) -> PlanProver:
        flows: Flows = flows_of(self._problem, self._units)
        limits = [limit for _, limit, _ in self._limits]
        prover = PlanProver(flows, (), limits, derivation, expired=self._expired)
        ruled, places = self._ruled, {unit: a for a, unit in enumerate(self._units)}
        makers = {goal: tuple(places[u] for u in ruled.makers[goal] if u in places) for goal in ruled.goals}
        prover.require([Landmark(members, objects=(goal,)) for goal, members in makers.items()])
        return prover

    def _figures(self, objective: Objective) -> list[Fraction]:
        return list(map(Fraction, self._problem.figures(objective, self._units)))

    def _claim(self, objective: Objective) -> Claim:
        """Return what is to be proved: that no plan costs less than the one in hand."""
        problem, figures = self._problem, self._figures(objective)
        if multiplies(objective):
            rates = sorted({rate for rate in figures if rate != 1}) or [_HALF]
            order = Lexicographic([rates])
            counts = Counter(problem.rate(unit) for unit in self._plan)
            least = tuple(Fraction(counts[rate]) for rate in rates)
            costs = [tuple(Fraction(rate == each) for each in rates) for rate in figures]
            whole = order.approximate(least)[0]
            each_float = (order.approximate(cost)[0] for cost in costs)
            caps = [math.floor(whole / cost + _NEAR) if cost else None for cost in each_float]
            return Claim(order, costs, order.zero, least, None, caps)
        cost = Fraction(problem.costs(self._plan).measure(objective))
        parts = None
        if objective not in problem.measures:
            every = problem.figures(objective, range(len(problem.network)))
            parts = math.lcm(*(Fraction(figure).denominator for figure in every))
        caps = [math.ceil(cost / figure) - 1 if figure else None for figure in figures]
        order = Lexicographic([None])
        return Claim(order, [(f,) for f in figures], (Fraction(objective.row.item),), (cost,), parts, caps)

    def _level(self, objective: Objective) -> tuple[Level, int] | None:
        """Return what plans may cost by an objective in whole numbers, and how many make up 1."""
        figures = self._figures(objective)
        if multiplies(objective):
            costs = [_fine(rate, up=False) for rate in figures]
            most = sum(_minus_log(self._problem.rate(unit), up=True) for unit in self._plan)
            return Level(Measure(costs), Fraction(0), math.ceil(FINE * most)), FINE
        cost = Fraction(self._problem.costs(self._plan).measure(objective))
        scale = math.lcm(cost.denominator, *(figure.denominator for figure in figures))
        if scale * max(figures, default=0) > _LARGEST:
            return None
        measure = Measure([int(scale * figure) for figure in figures], scale * objective.row.item)
        return Level(measure, scale * cost, int(scale * cost)), scale

    # --- writing

    def cut(self, objects: Iterable[int]) -> int:
        """Return the number of a cut, which is noted."""
        return self._cuts.setdefault(tuple(sorted(set(objects))), len(self._cuts))

    def balance(self, o: int) -> int:
        """Record that the balance of an object is used."""
        self._balanced.add(o)
        return o

    def unit(self, action: int) -> int:
        """Return the unit of an action."""
        return self._units[action]

    def limit(self, number: int) -> tuple[int, int]:
        """Return the place of the rule of a limit, and its scale."""
        place, _, scale = self._limits[number]
        return place, scale

    def _unreached(self) -> list[int]:
        """Return nodes that nothing reaches, by which some units are known to be executed by no plan.

        Those are units that could cross a cut or add to what is balanced; each asks for one of the nodes.
        """
        flows, units, removed = self._problem.flows, set(self._units), self._ruled.removed
        touched = {o for cut in self._cuts for o in cut} | self._balanced
        own = self._ruled.makers
        touched -= self._problem.endless  # of which only taking them crosses a cut
        makers = (own[o] if o in own else self._adders.get(o, ()) for o in sorted(touched))
        waiting = [u for each in makers for u in each if u not in units and u not in removed]
        found: set[int] = set()
        while waiting:
            asks = flows[waiting.pop()].asks
            if found.isdisjoint(asks):
                lacking = next(o for o in asks if not self._reached.available[o])
                found.add(lacking)
                waiting += (unit for unit in self._adders.get(lacking, ()) if unit not in removed)
        return sorted(found)

    def write(
        self,
        claim: str,
        objectives: Sequence[Objective],
        proofs: Sequence[Any],
        plan: Sequence[int] | None = None,
        bound: Sequence[Vector] | None = None,
    ) -> Certificate | None:
        """Write a certificate that is verified; ``None`` where that is beyond the limits."""
        problem = self._problem
        items, network = problem.items, problem.network
        assert items is not None
        stock = sorted((o, problem.stock_of(o) or 0) for o in problem.kitchen - problem.endless)
        told = ((name, stays) for name, stays in items.told.items() if isinstance(name, str))
        nodes = (
            (network.object_id(name), stays)
            for name, stays in items.told.items()
            if isinstance(name, ObjectNode)
        )
        known = ((o, stays) for o, stays in nodes if o is not None)
        try:
            order = None if bound is None else self._claim(objectives[0]).order
            stated = None if bound is None else [weight_text(each, order) for each in bound]
        except verify.LimitError:
            return None
        return write(
            PLAN,
            problem,
            Claimed(claim, tuple(objectives), plan, stated),
            self._covered,
            [list(cut) for cut in self._cuts],
            list(proofs),
            subject_of(problem),
            items={
                "stock": [list(pair) for pair in stock],
                "stays": [list(pair) for pair in (*sorted(told), *sorted(known))],
            },
            unreached=self._unreached(),
        )


class _Stated:
    """Proofs by counts as certificates state them."""

    def __init__(
        self,
        question: _Question,
        order: Lexicographic | None,
        levels: Sequence[Level],
        scales: Sequence[int],
        columns: Mapping[int, int],
    ) -> None:
        self._question, self._order, self._columns = question, order, columns
        self._levels = [(level, scale) for level, scale in zip(levels, scales, strict=True)]

    def proof(self, proof: CountProof) -> Any:
        """State a proof."""
        if isinstance(proof, Split):
            item = self._columns.get(proof.column)
            branch = {"unit": self._question.unit(proof.column)} if item is None else {"item": item}
            above, up_to = self.proof(proof.above), self.proof(proof.up_to)
            return {"branch": branch, "most": proof.max_count, "up_to": up_to, "above": above}
        found: dict[str, dict[tuple[int, ...], Vector]] = {}
        for condition, weight in proof.weights:
            kind, place, scale = self._place(condition)
            scaled = tuple(scale * part for part in weight)
            known = found.setdefault(kind, {}).get(place)
            found[kind][place] = scaled if known is None else tuple(map(add, known, scaled))
        return {
            kind: [[*place, weight_text(weight, self._order)] for place, weight in sorted(weights.items())]
            for kind, weights in found.items()
        }

    def _place(self, condition: Condition) -> tuple[str, tuple[int, ...], int]:
        """Return what a condition is in a certificate, and by how much its weight counts more there."""
        question = self._question
        if isinstance(condition, Landmark):
            cut = question.cut(condition.objects)
            if condition.action is None:
                return "weights", (cut,), 1
            return "before", (cut, question.unit(condition.action)), 1
        if isinstance(condition, Balance):
            return "balance", (question.balance(condition.object),), 1
        if isinstance(condition, Sum):
            place, scale = question.limit(condition.limit)
            return "limits", (place,), scale
        place = next(place for place, (level, _) in enumerate(self._levels) if level is condition)
        return "levels", (place,), self._levels[place][1]


def weight_text(weight: Vector, order: Lexicographic | None) -> str | dict[str, str]:
    """Write a weight by an objective: a number, or the exponents of rates."""
    rates = None if order is None else order.levels[0]
    if rates is None:
        return written(weight[0])
    return {str(rate): written(e) for rate, e in zip(rates, weight, strict=True) if e}


def _minus_log(rate: Fraction, up: bool) -> Fraction:
    """Return ``-log(rate)``, at most or at least."""
    if rate == 1:
        return Fraction(0)
    about, off = minus_log(rate, _DIGITS)
    return about + off if up else about - off


def _fine(rate: Fraction, up: bool) -> int:
    return math.floor(FINE * _minus_log(rate, up))
