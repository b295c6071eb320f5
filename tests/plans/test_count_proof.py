"""Proofs about all plans: held against all counts up to a length, and against what they say."""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from foon_asp.asp import Settings
from foon_asp.asp.optimum import solve
from foon_asp.certificate import certify_outcome
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector
from foon_asp.plans import count_proof, state_equation
from foon_asp.plans.conditions import Balance, Counts, Landmark, Level, Measure, Rounded, Sum, SumLimit
from foon_asp.plans.count_bound import CountBound
from foon_asp.plans.count_proof import Claim, CountProof, PlanProver, Split
from foon_asp.plans.flows import Flows
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import Relaxation, WholeProgram
from foon_asp.problem import Objective
from tests.oracle import used_up
from tests.plans.test_count_bound import flows, possible, random_flows, random_limit, whole, within

COUNT = Lexicographic([None])
ORDERS = [COUNT, Lexicographic([None, None]), Lexicographic([[Fraction(1, 2)], None])]


def claim_of(
    costs: Sequence[int],
    least: int | Fraction | None,
    item: int = 0,
    parts: int | None = 1,
    caps: Sequence[int | None] = (),
    order: Lexicographic = COUNT,
) -> Claim:
    def vector(number: int | Fraction) -> Vector:
        return (Fraction(number), *order.zero[1:])

    goal = None if least is None else vector(least)
    return Claim(order, list(map(vector, costs)), vector(item), goal, parts, caps)


def leaves(
    proof: CountProof, low: Mapping[int, int], most: Mapping[int, int], depth: int = 0
) -> Iterator[tuple[Any, Mapping[int, int], Mapping[int, int], int]]:
    """Return each part that is not divided, with the bounds of its columns, and how deep it is."""
    if not isinstance(proof, Split):
        yield proof.weights, low, most, depth
        return
    column = proof.column
    yield from leaves(proof.above, {**low, column: proof.max_count + 1}, most, depth + 1)
    yield from leaves(proof.up_to, low, {**most, column: proof.max_count}, depth + 1)


def require_shows(
    proof: CountProof,
    made: Flows,
    claim: Claim,
    bound: Fraction | None,
    columns: Mapping[int, int],
    kept: Sequence[Level] = (),
    limits: Sequence[SumLimit] = (),
) -> None:
    """Require that each part of a proof shows by exact numbers that no counts in it cost less.

    With ``None``, that there are none, and nothing costs anything.
    """
    size, taken = len(made.asks), {o: column for column, o in columns.items()}
    first = {column: made.start.get(o, 1) for column, o in columns.items()}
    for action in range(size):
        caps = [] if (cap := claim.caps[action]) is None else [cap]
        caps += [level.max_cost // price for level in kept if (price := level.measure.costs[action])]
        for sizes, limit, *kind in limits:
            if kind == [False, False] and action in sizes:
                caps.append(max(limit, 0) // sizes[action])
        if caps:
            first[action] = min(caps)

    def meaning(condition: Any) -> tuple[int | Fraction, Mapping[int, Any], Counter[int]]:
        """Return what a sum is at least: of counts times the first, and of what is executed, the second."""
        each, once = Counter[int](), Counter[int]()
        if isinstance(condition, Rounded):
            total, sums = Fraction(0), defaultdict[int, Fraction](Fraction)
            for part, weight in condition.weights:
                assert weight > 0
                wanted, counts, _ = meaning(part)
                if isinstance(part, Balance) and part.object in taken:  # all copies that there are
                    wanted -= made.start.get(part.object, 0)
                    counts = {a: n for a, n in counts.items() if a < size}
                total += weight * wanted
                for a, n in counts.items():
                    sums[a] += weight * n
            part_of = total - math.floor(total)
            floors = {a: math.floor(n) for a, n in sums.items()}
            row = {a: floors[a] + min(Fraction(1), (n - floors[a]) / part_of) for a, n in sums.items()}
            return math.ceil(total) * condition.scale, {a: n * condition.scale for a, n in row.items()}, once
        if isinstance(condition, Balance):
            o = condition.object
            for action in range(size):
                each[action] = [*made.adds[action]].count(o) - [*made.uses[action]].count(o)
            there = 0 if o in taken else made.start.get(o, 0)
            each.update([taken[o]] if o in taken else [])
            return (o in made.targets) - there, each, once
        if isinstance(condition, Sum):
            weights, limit, least, used = limits[condition.limit]
            sign = 1 if least else -1
            (once if used else each).update({a: sign * weight for a, weight in weights.items()})
            return sign * limit, each, once
        if isinstance(condition, Level):
            each.update({a: -cost for a, cost in enumerate(condition.measure.costs)})
            each.update(dict.fromkeys(columns, -condition.measure.item))
            return -condition.max_cost, each, once
        assert isinstance(condition, Landmark)
        zone = {*condition.objects}
        assert all(o in taken for o in zone if made.start.get(o))
        adders = [a for a in range(size) if zone.intersection(made.adds[a])]
        once.update([a for a in adders if zone.isdisjoint(made.asks[a])] if zone else condition.members)
        each.update(taken[o] for o in zone & taken.keys())
        if condition.action is None:
            assert not zone or zone.intersection(made.targets)
            return 1, each, once
        assert zone.intersection([*made.asks[condition.action], *made.items[condition.action]])
        once[condition.action] -= 1
        return 0, each, once

    for weights, low, most, _ in leaves(proof, {}, first):
        total = Fraction(0)
        each, once = defaultdict[int, Fraction](Fraction), defaultdict[int, Fraction](Fraction)
        for condition, (weight, *_) in weights:
            assert weight > 0
            least, by_count, by_use = meaning(condition)
            total += weight * least
            for brought, some in ((each, by_count), (once, by_use)):
                for column, times in some.items():
                    brought[column] += weight * times
        if any(low.get(column, 0) > top for column, top in most.items()):
            continue
        for column in (*range(size), *columns):
            cost = 0 if bound is None else claim.costs[column][0] if column < size else claim.item[0]
            start, top = low.get(column, 0), most.get(column)
            assert top is not None or cost >= each[column]
            tried = {start, max(start, 1)} if top is None else {start, min(max(start, 1), top), top}
            total += min((cost - each[column]) * n - once[column] * (n > 0) for n in tried)
        assert total > 0 if bound is None else (math.ceil(total) if claim.parts else total) >= bound


def garbage(choose: Random) -> Callable[..., Relaxation]:
    """Return a relaxation with weights and a basis that may be anything."""
    solve = WholeProgram.relaxation

    def relaxation(program: WholeProgram, objective: Mapping[int, float]) -> Relaxation:
        found = solve(program, objective)
        odd = (-1.0, 1.0, 1e300, math.nan, math.inf, choose.random())
        weights = [choose.choice((weight, weight, *odd)) for weight in found.weights]
        columns, rows = ([n for n in some if choose.random() < 0.7] for some in (found.columns, found.rows))
        return Relaxation(found.x, weights, columns, rows)

    return relaxation


@pytest.mark.parametrize("wrong", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_the_cost_of_the_cheapest_counts_is_proved_and_no_more(
    seed: int, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    choose, tried = Random(seed), 0
    if wrong:
        monkeypatch.setattr(WholeProgram, "relaxation", garbage(choose))
    while tried < 6:
        made = random_flows(choose)
        size, item = len(made.asks), choose.choice((0, 0, 1))
        costs = [choose.randint(1, 3) for _ in range(size)]
        kept = [whole(Measure([choose.randint(0, 2) for _ in range(size)]), choose.randint(1, 3))]
        kept = kept[: choose.randint(0, 1)]
        limits = [random_limit(choose, size)][: choose.randint(0, 1)]

        def cost(counts: Counts, taken: int, costs: Sequence[int] = costs, item: int = item) -> int:
            return sum(costs[a] * n for a, n in counts.items()) + item * taken

        known = [
            (counts, cost(counts, taken))
            for counts, taken in possible(made)
            if all(sum(each.measure.costs[a] * n for a, n in counts.items()) <= each.cost for each in kept)
            and within(limits, counts)
        ]
        best = min((each for _, each in known), default=99)
        if best > 3:
            continue
        tried += 1
        for derivation, more in ((), 0), ((), 5), (range(size), 1):
            less = [counts for counts, each in known if each < best + more <= 4]
            caps = [max(counts.get(a, 0) for counts in less) if less else None for a in range(size)]
            how = choose.choice((None, 1)), caps, choose.choice(ORDERS)
            claim = claim_of(costs, best + more, item, *how)
            prover = PlanProver(made, (), limits, derivation)
            found = prover.prove_claim(claim, Measure(costs, item), kept)
            assert wrong or found is not None
            if found is None:
                continue
            proof, bound, columns = found
            assert bound is not None
            assert bound[0] <= best if wrong else bound[0] == best
            assert columns.keys() == set(range(2 * size, 2 * size + len(columns)))
            require_shows(proof, made, claim, bound[0], columns, kept, limits)


@pytest.mark.parametrize("wrong", [False, True])
def test_that_there_is_no_plan_is_proved(wrong: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    choose, none = Random(7), 0
    if wrong:
        monkeypatch.setattr(WholeProgram, "relaxation", garbage(choose))
    for _ in range(40):
        made = random_flows(choose)
        size = len(made.asks)
        limits = [random_limit(choose, size)]
        nothing = claim_of([0] * size, None, caps=[None] * size)
        found = PlanProver(made, (), limits).prove_claim(nothing, Measure([0] * size), ())
        proved = CountBound(made, (), limits).is_infeasible()
        assert (found is not None) == proved or (wrong and found is None)
        if found is not None:
            none += 1
            require_shows(found[0], made, nothing, None, found[2], (), limits)
    assert wrong or none > 5
    wide = PlanProver(flows(">0"), (), [({0: 10**7}, 5, False, True)])  # weights differ by as much
    nothing = claim_of([0], None, caps=[None])
    found = wide.prove_claim(nothing, Measure([0]), ())
    assert wrong or found is not None


@pytest.mark.parametrize("seed", range(12))
def test_every_certificate_verifies_whatever_floats_say(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    problem, how = used_up.random_problem(seed), Settings()
    asked = ((Objective.UNITS,), (Objective.KITCHEN, Objective.SUCCESS), (Objective.SUCCESS,))[seed % 3]
    found = solve(problem, asked, how)
    monkeypatch.setattr(WholeProgram, "relaxation", garbage(Random(seed)))
    certify_outcome(found, how, lambda: False)  # one that is refused is a bug, and an error


def test_known_landmarks_are_taken_and_counts_are_capped() -> None:
    ways = flows(">0", ">0")
    for known, cap, least in (([], None, 1), ([Landmark((1,))], None, 3), ([], 0, 3)):
        prover = PlanProver(ways)
        prover.add_known_landmarks(known)
        found = prover.prove_claim(claim_of([1, 3], 3, caps=[cap, None]), Measure([1, 3]), ())
        assert found is not None
        assert found[1] == (Fraction(least),)


# of three actions each two make one of the targets: a half of each would do, so parts are told apart
HALF = flows(">0 1", ">0 2", ">1 2", targets=(0, 1, 2))


def test_a_proof_is_given_up_where_parts_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = [1, 1, 1]

    def proved(parts: int | None = 1, **named: Any) -> tuple[Vector | None, list[int]] | None:
        claim = claim_of(costs, 2, parts=parts, caps=[None] * 3)
        found = PlanProver(HALF, **named).prove_claim(claim, Measure(costs), ())
        return None if found is None else (found[1], [depth for *_, depth in leaves(found[0], {}, {})])

    half, whole_proof = (Fraction(3, 2),), ((Fraction(2),), [1, 2, 2])
    assert proved() == ((Fraction(2),), [0])  # a bound of 3/2 is one of 2
    assert proved(None) == ((Fraction(2),), [0])  # and so is the rounded half of the sum of all conditions
    # without rounded sums it takes parts
    monkeypatch.setattr(state_equation, "PLANS", PLANS._replace(stalled_rounds=-1))
    assert proved(None) == whole_proof
    for parts in (None, 2):
        assert proved(parts, expired=lambda: True) == (half, [0])
    for name in ("leaves", "depth"):
        with monkeypatch.context() as patched:
            for most, expected in ((-1, (half, [0])), (0, (half, [1, 1])), (1, whole_proof)):
                patched.setattr(count_proof, "PLANS", PLANS._replace(**{name: most}))
                assert proved(None) == expected


def test_weights_that_no_rounding_tells_are_solved_for() -> None:
    eggs = flows(f">{'0 ' * 17}", f"{'0 ' * 20}>1", targets=(1,))
    for order in ORDERS:
        claim = claim_of([1, 1], Fraction(37, 17), parts=None, caps=[None] * 2, order=order)
        found = PlanProver(eggs, expired=lambda: True).prove_claim(claim, Measure([1, 1]), ())
        assert found is not None
        assert found[1] == (Fraction(37, 17), *order.zero[1:])
