"""Proofs that no plan costs less: Farkas combinations of conditions on counts, and branching over counts.

The relaxation of counts (:mod:`foon_asp.plans.count_bound`) has dual values of its rows in floats. Any such
values, rounded or solved for exactly, prove a bound (Lagrangian relaxation). It is the sum of the weighted
right-hand sides and, for each action, of the least reduced cost of a count that it may have.

Costs are vectors in an exact lexicographic order (:class:`Lexicographic`).
"""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cmp_to_key
from typing import NamedTuple

from foon_asp.hypergraph.exact_optimum import UnusableBasisError, solve_exactly
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector, multiply, subtract
from foon_asp.plans.conditions import Condition, Landmark, Level, Measure
from foon_asp.plans.count_bound import CountBound
from foon_asp.plans.count_model import CountModel
from foon_asp.plans.state_equation import StateEquation
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import INTEGRALITY, PARTS, Relaxation


class Weighted(NamedTuple):
    """A leaf of a proof: conditions with weights above 0, which prove the bound for counts of the leaf."""

    weights: Sequence[tuple[Condition, Vector]]


class Split(NamedTuple):
    """A branching of a proof over the value of a column.

    ``up_to`` is the proof for values up to ``max_count``, and ``above`` the proof for greater values.
    """

    column: int
    max_count: int
    up_to: "CountProof"
    above: "CountProof"


CountProof = Weighted | Split


class Claim(NamedTuple):
    """The claim that all plans cost at least ``least``.

    ``order``: the order on costs.
    ``costs``: the cost of each action.
    ``item``: the cost of each endless item, and of each initial copy that is taken.
    ``least``: the claimed least cost; ``None`` for the claim that there is no plan. All costs are then 0.
    ``parts``: if not ``None``, the costs of plans are multiples of ``1 / parts``.
    ``caps``: an upper bound on the count of each action in plans that cost less; ``None`` for no bound.
    """

    order: Lexicographic
    costs: Sequence[Vector]
    item: Vector
    least: Vector | None
    parts: int | None
    caps: Sequence[int | None]


class PlanProver(CountBound):
    """Searches for a proof of a claim about all plans that are as good as the incumbent by some levels.

    If the search fails at a node, it lowers the claim to the bound that the node proves.
    """

    def prove_claim(
        self, claim: Claim, measure: Measure, kept_levels: Sequence[Level]
    ) -> tuple[CountProof, Vector | None, Mapping[int, int]] | None:
        """Return a proof of a claim or of a weaker claim, the bound that it proves, and objects by column.

        The bound is ``None`` if the claim is that there is no plan. The objects are those of the columns of
        endless items and initial copies, if these have costs. Return ``None`` if nothing is proved.

        The rounded rows known so far are replaced. ``measure`` is the objective of the claim. Plans that are
        worse than the incumbent by a level in ``kept_levels`` are excluded from the claim.
        """
        self._claim, self._least, self._leaves = claim, claim.least, 0
        floats = [claim.order.approximate(cost)[0] for cost in claim.costs]
        self._objective = {action: cost for action, cost in enumerate(floats) if cost}
        equation = StateEquation(self._flows, self._limits, claim.caps, self._expired)
        # costs in whole numbers: they only steer the rounding
        equation.strengthen({action: round(cost / INTEGRALITY) for action, cost in self._objective.items()})
        self._rounded_rows = list(equation.rounded_rows)
        model = self._new_model([measure, *(level.measure for level in kept_levels)])
        for level in kept_levels:
            model.add_level(level)
        for action, cap in enumerate(claim.caps):
            if cap is not None:
                model.program.cap(action, cap)
        self._columns = {column: o for o, column in {**model.items, **model.stock}.items()}
        self._objective |= dict.fromkeys(self._columns, claim.order.approximate(claim.item)[0])
        self._failed = False
        proof = self._prove_node(model, 0)
        if self._failed:
            return None
        return proof, self._least, self._columns

    def add_known_landmarks(self, landmarks: Sequence[Landmark]) -> None:
        """Add landmarks that all plans are known to satisfy."""
        self._landmarks += landmarks

    def _prove_node(self, model: CountModel, depth: int) -> CountProof:
        """Return the proof of a node of the branching; ``model`` has the bounds of columns at the node.

        If the node proves less than the claim, the claim is lowered to the bound of the node. If the node
        proves nothing, ``_failed`` is set.
        """
        program = model.program
        model.tighten()
        if program.is_empty:
            return Weighted(())
        best: tuple[Vector, dict[int, Vector]] | None = None
        while True:
            relaxed = program.relaxation(self._objective)
            for weights in self._candidate_weights(model, relaxed):
                bound = self._bound(model, weights)
                if bound is not None and (best is None or self._claim.order.compare(bound, best[0]) > 0):
                    best = bound, weights
                if best is not None and self._is_enough(best[0]):
                    return self._make_leaf(model, best[1])
            if relaxed.x is None or self._expired():
                break
            if not (self._add_landmark(relaxed.x, model) or self._separate(relaxed.x, model, depth == 0)):
                break
        column = None if relaxed.x is None or self._expired() else self._branching_column(model, relaxed.x)
        if column is None or depth > PLANS.depth or self._leaves > PLANS.leaves:
            self._give_up(best)
            return self._make_leaf(model, best[1] if best else {})
        return self._prove_split(model, *column, depth)

    def _prove_split(self, model: CountModel, column: int, max_count: int, depth: int) -> Split:
        """Return a proof by branching on a column: its values are above ``max_count``, or at most that.

        The bounds of the model are restored at the end.
        """
        program, action_count = model.program, self._action_count
        lower, upper = list(program.lower), list(program.upper)
        is_count = column < action_count
        program.lower[column] = max_count + 1
        if is_count:
            program.lower[action_count + column] = 1
        above = self._prove_node(model, depth + 1)
        program.lower, program.upper = list(lower), list(upper)
        program.upper[column] = max_count
        if is_count and not max_count:
            program.upper[action_count + column] = 0
        up_to = self._prove_node(model, depth + 1)
        program.lower, program.upper = lower, upper
        return Split(column, max_count, up_to, above)

    def _branching_column(self, model: CountModel, x: Sequence[float]) -> tuple[int, int] | None:
        """Return a column to branch on, and its maximum in the lower branch; ``None`` if all are whole.

        A count is chosen first if its indicator is below 1 and below the count. Otherwise, the column with
        the most fractional value is chosen.
        """
        program, action_count = model.program, self._action_count
        for a in range(action_count):
            upper = program.upper[a]
            if (
                x[action_count + a] < min(1.0, x[a]) - INTEGRALITY
                and not program.lower[a]
                and (upper is None or upper > 1)
            ):
                return a, max(1, math.floor(x[a] + INTEGRALITY))
        columns = [*range(action_count), *self._columns]
        distances = [(abs(x[column] - math.floor(x[column]) - 0.5), column) for column in columns]
        most_fractional = min(
            (candidate for candidate in distances if candidate[0] < 0.5 - INTEGRALITY), default=None
        )
        return None if most_fractional is None else (most_fractional[1], math.floor(x[most_fractional[1]]))

    def _give_up(self, best: tuple[Vector, object] | None) -> None:
        """Lower the claim to the bound of the ``best`` weights at a node.

        If ``best`` is ``None``, or if the claim is that there is no plan, note that nothing is proved.
        """
        if self._least is None or best is None:
            self._failed = True
            return
        self._least = min(self._least, self._round_up(best[0]), key=cmp_to_key(self._claim.order.compare))

    def _round_up(self, bound: Vector) -> Vector:
        """Return a bound, rounded up to a multiple of ``1 / parts`` if the claim has ``parts``."""
        parts = self._claim.parts
        return bound if parts is None else tuple(Fraction(math.ceil(b * parts), parts) for b in bound)

    def _is_enough(self, bound: Vector) -> bool:
        """Return whether a bound, rounded up, proves the claim as it is now (it may have been lowered).

        The claim that there is no plan is proved by a bound above 0.
        """
        order = self._claim.order
        if self._least is None:
            return order.sign(bound) > 0
        return order.compare(self._round_up(bound), self._least) >= 0

    def _make_leaf(self, model: CountModel, weights: Mapping[int, Vector]) -> Weighted:
        """Return the leaf with the given weights by row, and count it."""
        self._leaves += 1
        return Weighted([(model.conditions[row], weight) for row, weight in sorted(weights.items())])

    def _candidate_weights(self, model: CountModel, relaxed: Relaxation) -> "list[dict[int, Vector]]":
        """Return candidates for the weights of rows, each a dictionary by row.

        They are rounded duals. Exact duals are added if the relaxation is close to the claim and cannot be
        rounded up. If the relaxation is infeasible, the only candidate is a Farkas combination, scaled to
        reach the claim. If no such combination is found, return an empty list.
        """
        claim = self._claim
        rates = claim.order.levels[0]
        one = (Fraction(1), *claim.order.zero[1:])
        scale = claim.order.approximate(one)[0]
        floats = relaxed.weights
        if relaxed.x is None:
            largest = max(floats, default=0.0)
            if largest == 0.0:  # a row without columns whose least sum is above 0
                rows = ((row, *model.program.row_of(row)) for row in model.conditions)
                return [{row: one} for row, coefficients, least in rows if least > 0 and not coefficients]
            for parts in PARTS:
                ray = self._rounded_weights(model, [weight / largest for weight in floats], parts, one)
                bound_without_costs = self._bound(model, ray, free=True)
                if bound_without_costs is None or claim.order.sign(bound_without_costs) <= 0:
                    continue
                if self._least is None:
                    return [ray]
                missing_factor = (
                    claim.order.approximate(self._least)[0] / claim.order.approximate(bound_without_costs)[0]
                )
                factor = Fraction(math.ceil(abs(missing_factor) * 1.001) + 1)
                return [{row: multiply(weight, factor) for row, weight in ray.items()}]
            return []
        floats = [weight / scale for weight in floats]
        candidates = [self._rounded_weights(model, floats, parts, one) for parts in PARTS]
        value = sum(cost * relaxed.x[column] for column, cost in self._objective.items())
        least = 0.0 if self._least is None else claim.order.approximate(self._least)[0]
        is_close = value > least - INTEGRALITY * max(1.0, abs(least))
        if is_close and (rates is not None or claim.parts is None):
            candidates += self._exact_weights(model, relaxed)
        return candidates

    def _rounded_weights(
        self, model: CountModel, floats: Sequence[float], parts: int, one: Vector
    ) -> dict[int, Vector]:
        """Return the weights above 0 by row, rounded to multiples of ``one`` divided by ``parts``."""
        rounded = {row: round(floats[row] * parts) for row in model.conditions if abs(floats[row]) < 1e15}
        return {row: multiply(one, Fraction(n, parts)) for row, n in rounded.items() if n > 0}

    def _exact_weights(self, model: CountModel, relaxed: Relaxation) -> "list[dict[int, Vector]]":
        """Return a list of one candidate: the exact duals of the basis of a relaxation.

        Return an empty list if the basis is singular. Weights that are not above 0 are omitted.
        """
        columns, tight = set(relaxed.columns), relaxed.rows
        matrix: dict[int, dict[int, Fraction]] = {column: {} for column in sorted(columns)}
        for row in tight:
            for column, coefficient in model.program.row_of(row)[0].items():
                if column in columns and coefficient:
                    matrix[column][row] = Fraction(coefficient)
        if len(columns) != len(tight):
            return []
        try:
            solved = solve_exactly(matrix, {column: self._column_cost(column) for column in columns})
        except UnusableBasisError:
            return []
        sign = self._claim.order.sign
        return [{row: w for row, w in solved.items() if row in model.conditions and sign(w) > 0}]

    def _column_cost(self, column: int) -> Vector:
        """Return the cost of a column: of an action, an item or an initial copy; others cost 0."""
        claim = self._claim
        if column < self._action_count:
            return claim.costs[column]
        return claim.item if column in self._columns else claim.order.zero

    def _bound(self, model: CountModel, weights: Mapping[int, Vector], free: bool = False) -> Vector | None:
        """Return the bound that weights of rows prove for the current node; ``None`` if they prove no bound.

        With ``free``, all costs are taken to be 0.
        """
        program, action_count, order = model.program, self._action_count, self._claim.order
        loads: dict[int, list[Vector]] = {}
        terms: list[Vector] = []
        for row, weight in weights.items():
            coefficients, least = program.row_of(row)
            terms.append(multiply(weight, Fraction(least)))
            for column, coefficient in coefficients.items():
                loads.setdefault(column, []).append(multiply(weight, Fraction(coefficient)))
        zero = order.zero

        def reduced_cost(column: int) -> Vector:
            """Return the cost of a column less the weighted coefficients of its rows."""
            cost = zero if free else self._column_cost(column)
            return subtract(cost, order.total(loads[column])) if column in loads else cost

        for column in (*range(action_count), *self._columns):
            low, high = program.lower[column], program.upper[column]
            once = reduced_cost(action_count + column) if column < action_count else zero
            if column not in loads and action_count + column not in loads and not low:
                continue
            per_execution = reduced_cost(column)
            ends = [zero] if low == 0 else []
            if high is None or high >= 1:
                ends.append(order.total([multiply(per_execution, Fraction(max(low, 1))), once]))
                if order.sign(per_execution) < 0:
                    if high is None:
                        return None
                    ends.append(order.total([multiply(per_execution, Fraction(high)), once]))
            terms.append(min(ends, key=cmp_to_key(order.compare)))
        return order.total(terms)
