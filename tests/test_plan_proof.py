"""Proofs about all plans, step by step: what weights prove, how parts are divided, what is claimed."""

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from foon_asp.bounds import plan_proof
from foon_asp.bounds.counts import Balance, CountBound, Flows, Landmark, Level, Measure, _Model
from foon_asp.bounds.lexicographic import Lexicographic, Vector
from foon_asp.bounds.plan_proof import Claim, CountProof, PlanProver, Split, Weighted
from foon_asp.bounds.whole_program import Relaxation
from tests.test_counts import flows, possible, random_flows, random_limit, whole

COUNT = Lexicographic([None])
PAIR = Lexicographic([None, None])


def one(number: int | Fraction) -> Vector:
    return (Fraction(number),)


def claim_of(
    costs: Sequence[int],
    least: int | None,
    item: int = 0,
    parts: int | None = 1,
    caps: Mapping[int, int] | None = None,
) -> Claim:
    goal = None if least is None else one(least)
    every = [(caps or {}).get(action) for action in range(len(costs))]
    return Claim(COUNT, [one(cost) for cost in costs], one(item), goal, parts, every)


def begun(made: Flows, claim: Claim, item: int = 0, **named: Any) -> tuple[PlanProver, _Model]:
    """Give a prover in the middle of its work, and its model."""
    prover = PlanProver(made, **named)
    model = prover._model([Measure([0] * len(made.asks), item)])
    prover._claim, prover._least, prover._leaves, prover._failed = claim, claim.least, 0, False
    prover._columns = {column: o for o, column in {**model.items, **model.stock}.items()}
    prover._objective = {a: float(cost[0]) for a, cost in enumerate(claim.costs) if cost[0]}
    prover._objective |= dict.fromkeys(prover._columns, float(claim.item[0])) if any(claim.item) else {}
    return prover, model


# --- What weights prove.


def least_sum(
    prover: PlanProver, model: _Model, weights: Mapping[int, int], free: bool
) -> Fraction | int | None:
    """Try every count of each column by itself: what costs less what is brought, and what rows leave."""
    size, program, claim = prover._size, model.program, prover._claim
    brought = dict.fromkeys(range(program.columns), 0)
    total: Fraction | int = 0
    for row, weight in weights.items():
        parts, least = program.said(row)
        total += weight * least
        for column, part in parts.items():
            brought[column] += weight * part
    for column in (*range(size), *prover._columns):
        low, most = program.lower[column], program.upper[column]
        cost = claim.costs[column][0] if column < size else claim.item[0]
        once = brought[size + column] if column < size else 0
        each = (0 if free else cost) - brought[column]
        if most is None and each < 0:
            return None
        tried = range(low, (low + 2 if most is None else most) + 1)
        total += min(each * count - once * (count > 0) for count in tried)
    return total


@pytest.mark.parametrize("seed", range(12))
def test_weights_prove_the_least_of_every_column_by_itself(seed: int) -> None:
    choose = Random(seed)
    proved = 0
    for _ in range(25):
        made = random_flows(choose)
        size, item = len(made.asks), choose.choice((0, 0, 1, 2))
        claim = claim_of([choose.randint(0, 3) for _ in range(size)], 1, item)
        prover, model = begun(made, claim, item)
        if choose.random() < 0.5:
            model.add_landmark(Landmark((0, 1), tuple(model.stock), choose.choice((None, 1))))
        for column in (*range(size), *prover._columns):
            model.program.lower[column] = low = choose.choice((0, 0, 0, 1, 2))
            most = model.program.upper[column]
            model.program.upper[column] = choose.choice(
                (None if most is None else max(most, low), low, low + 2)
            )
        rows = [row for row in model.conditions if choose.random() < 0.7]
        weights = {row: choose.randint(1, 3) for row in rows}
        for free in (False, True):
            expected = least_sum(prover, model, weights, free)
            found = prover._bound(model, {row: one(weight) for row, weight in weights.items()}, free)
            assert found == (None if expected is None else one(expected))
            proved += found is not None
    assert proved > 15


# --- How a part is divided.


def test_what_is_branched_on() -> None:
    made = flows(">3 5", "3 100>0", "3* 4 100 101>1", start={4: 2}, targets=(0, 1))
    prover, model = begun(made, claim_of([1, 1, 1], 3), 1)
    # 0 to 2 are how often, 3 to 5 whether at all, then copies of 4, and 100 and 101
    assert [*prover._columns] == [7, 8, 6]
    program = model.program

    def choice(*x: float) -> tuple[int, int] | None:
        return prover._choice(model, x)

    rest = (0.0, 0.0, 0.0)
    assert choice(1, 1, 1, 1, 1, 1, *rest) is None
    assert choice(2.0, 1, 1, 0.5, 1, 1, *rest) == (0, 2)  # executed, and told so in part only
    assert choice(2.9999999, 1, 1, 0.5, 1, 1, *rest) == (0, 3)
    assert choice(0.4, 1, 1, 0.3, 1, 1, *rest) == (0, 1)
    assert choice(1, 1, 1, 0.9999999, 1, 1, *rest) is None
    program.upper[0] = 2
    assert choice(2.0, 1, 1, 0.5, 1, 1, *rest) == (0, 2)
    program.upper[0] = 1
    assert choice(1, 1, 1, 0.5, 1, 1, *rest) is None
    program.upper[0] = None
    program.lower[0] = 1
    assert choice(2.0, 1, 1, 0.5, 1, 1, *rest) is None
    # what is most nearly half
    assert choice(1, 1.8, 2.6, 1, 1, 1, *rest) == (2, 2)
    assert choice(1.4, 1.8, 2, 1, 1, 1, *rest) == (0, 1)
    assert choice(1, 1, 1, 1, 1, 1, 1.3, 0.6, 0.8) == (7, 0)
    assert choice(1, 1, 1, 1, 1, 1, 1.5, 0.6, 0.8) == (6, 1)
    assert choice(1, 1, 1.9999999, 1, 1, 1, *rest) is None


@pytest.mark.parametrize(
    ("column", "most", "above", "up_to"),
    [
        (0, 0, ({0: 1, 2: 1}, {}), ({}, {0: 0, 2: 0})),
        (1, 0, ({1: 1, 3: 1}, {}), ({}, {1: 0, 3: 0})),
        (0, 2, ({0: 3, 2: 1}, {}), ({}, {0: 2})),
        (4, 0, ({4: 1}, {}), ({}, {4: 0})),
        (4, 1, ({4: 2}, {}), ({}, {4: 1})),
    ],
)
def test_the_sides_of_a_part(
    column: int,
    most: int,
    above: tuple[dict[int, int], dict[int, int]],
    up_to: tuple[dict[int, int], dict[int, int]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    made = flows("4>0", ">0", start={4: 2})
    prover, model = begun(made, claim_of([1, 1], 1), 1)
    before: tuple[list[int], list[int | None]] = (list(model.program.lower), list(model.program.upper))
    assert before == ([0] * 5, [None, None, 1, 1, 2])
    seen: list[tuple[dict[int, int], dict[int, int | None], int]] = []

    def part(_: PlanProver, model: _Model, depth: int) -> CountProof:
        program = model.program
        lower = {c: new for c, new in enumerate(program.lower) if before[0][c] != new}
        upper = {c: new for c, new in enumerate(program.upper) if before[1][c] != new}
        seen.append((lower, upper, depth))
        program.lower[:], program.upper[:] = [9] * 5, [9] * 5  # which the other side does not see
        return Weighted([len(seen)])  # type: ignore[list-item]

    monkeypatch.setattr(PlanProver, "_part", part)
    split = prover._split(model, column, most, 6)
    assert seen == [(*above, 7), (*up_to, 7)]
    assert split == Split(column, most, Weighted([2]), Weighted([1]))  # type: ignore[list-item]
    assert (model.program.lower, model.program.upper) == before


# --- How much is proved.


def cheapest(made: Flows, costs: Sequence[int], item: int, within: Sequence[Level] = ()) -> int | None:
    """Try all counts up to a length."""
    return min(
        (
            sum(costs[a] * n for a, n in counts.items()) + item * taken
            for counts, taken in possible(made)
            if all(sum(each.measure.costs[a] * n for a, n in counts.items()) <= each.cost for each in within)
        ),
        default=None,
    )


@pytest.mark.parametrize("seed", range(12))
def test_the_cost_of_the_cheapest_counts_is_proved_and_no_more(seed: int) -> None:
    choose, tried = Random(seed), 0
    while tried < 4:
        made = random_flows(choose)
        size, item = len(made.asks), choose.choice((0, 0, 1))
        costs = [choose.randint(1, 3) for _ in range(size)]
        kept = [whole(Measure([choose.randint(0, 2) for _ in range(size)]), choose.randint(1, 3))]
        kept = kept[: choose.randint(0, 1)]
        best = cheapest(made, costs, item, kept)
        if best is None or best > 3:
            continue
        tried += 1
        for derivation in ((), range(size)):
            for more in (0, 1, 5):
                prover = PlanProver(made, derivation=derivation)
                claim = claim_of(costs, best + more, item)
                found = prover.prove_claim(claim, Measure(costs, item), kept)
                assert found is not None
                assert found[1] == one(best)
                assert found[2].keys() == set(range(2 * size, 2 * size + len(found[2])))


def test_that_there_is_no_plan_is_proved() -> None:
    choose, none = Random(7), 0
    for _ in range(40):
        made = random_flows(choose)
        size = len(made.asks)
        limits = [random_limit(choose, size)]
        nothing = claim_of([0] * size, None)
        found = PlanProver(made, (), limits).prove_claim(nothing, Measure([0] * size), ())
        assert (found is not None) == CountBound(made, (), limits).none()
        none += found is not None
    assert none > 5


# --- What is asked, and when a part is given up.


def test_what_a_part_is_made_of(monkeypatch: pytest.MonkeyPatch) -> None:
    made = flows("4 100>0", ">0", ">4", start={4: 2})
    seen: list[tuple[Any, ...]] = []

    def part(prover: PlanProver, model: _Model, depth: int) -> CountProof:
        program = model.program
        seen.append((program.upper[:3], prover._objective, depth, [*model.conditions.values()][-2:]))
        prover._failed = len(seen) == 3
        return Weighted(())

    monkeypatch.setattr(PlanProver, "_part", part)
    prover, kept = PlanProver(made), whole(Measure([1, 0, 1]), 7)
    known = Landmark((0, 1))
    prover.require([known])
    prover.require([])
    claim = claim_of([1, 0, 3], 4, 2, caps={1: 2, 2: 9})
    found = prover.prove_claim(claim, Measure([1, 0, 3], 2), [kept])
    assert found == (Weighted(()), one(4), {6: 4, 7: 100})
    assert seen == [([7, 2, 7], {0: 1.0, 2: 3.0, 6: 2.0, 7: 2.0}, 0, [known, kept])]
    free = PlanProver(made).prove_claim(claim_of([0, 0, 0], None), Measure([0] * 3), ())
    assert free == (Weighted(()), None, {})
    assert seen[1][:2] == ([None] * 3, {})
    assert PlanProver(made).prove_claim(claim, Measure([1, 0, 3], 2), [kept]) is None
    nothing, two = (Fraction(0),) * 2, (Fraction(2), Fraction(0))
    pair = Claim(Lexicographic([None, None]), [nothing] * 3, two, two, None, [])
    PlanProver(made).prove_claim(pair, Measure([0, 0, 0], 2), ())
    assert seen[3][1] == {6: 2.0, 7: 2.0}


def test_cuts_are_looked_for_some_times(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[bool] = []

    def separate(_: object, x: Sequence[float], model: _Model, at_root: bool) -> bool:
        asked.append(at_root)
        return True

    monkeypatch.setattr(PlanProver, "_separate", separate)
    monkeypatch.setattr(PlanProver, "_is_enough", lambda *_: False)
    prover, model = begun(flows(">0"), claim_of([1], 5))
    for depth in (0, 3):
        assert isinstance(prover._part(model, depth), Weighted)
        assert asked == [depth == 0] * 20
        asked.clear()


def test_a_part_without_counts_needs_no_weights() -> None:
    prover, model = begun(flows(">0"), claim_of([1], 5))
    model.program.lower[0], model.program.upper[0] = 2, 1
    assert prover._part(model, 0) == Weighted(())
    assert model.program.said(0) == ({1: 1, 0: -1}, 0)  # once at most
    assert (prover._least, prover._leaves) == (one(5), 0)
    model.program.upper[0] = 2
    assert prover._part(model, 0) != Weighted(())
    assert (prover._least, prover._leaves) == (one(2), 1)


# of three actions each two make one of the targets: a half of each would do, so parts are told apart
HALF = flows(">0 1", ">0 2", ">1 2", targets=(0, 1, 2))


def leaves(proof: CountProof, depth: int = 0) -> list[int]:
    if isinstance(proof, Split):
        return leaves(proof.up_to, depth + 1) + leaves(proof.above, depth + 1)
    return [depth]


def test_a_proof_is_given_up_where_parts_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = [1, 1, 1]

    def proved(parts: int | None = 1, **named: Any) -> tuple[Vector | None, list[int]] | None:
        claim = claim_of(costs, 2, parts=parts)
        found = PlanProver(HALF, **named).prove_claim(claim, Measure(costs), ())
        return None if found is None else (found[1], leaves(found[0]))

    half, whole_proof = one(Fraction(3, 2)), (one(2), [2, 2, 1])
    assert proved() == (one(2), [0])  # a bound of 3/2 is one of 2
    assert proved(None) == whole_proof
    for parts in (None, 2):
        assert proved(parts, expired=lambda: True) == (half, [0])
    for name in ("_MOST_LEAVES", "_MOST_DEPTH"):
        with monkeypatch.context() as patched:
            for most, expected in ((-1, (half, [0])), (0, (half, [1, 1])), (1, whole_proof)):
                patched.setattr(plan_proof, name, most)
                assert proved(None) == expected


def test_the_best_weights_of_a_part_count(monkeypatch: pytest.MonkeyPatch) -> None:
    claim = claim_of([1], 5, parts=None)
    weights = [{2: one(Fraction(number, 4))} for number in (8, 1, 3, 2)]  # the first prove nothing
    monkeypatch.setattr(PlanProver, "_weights", lambda *_: weights)
    prover, model = begun(flows(">0"), claim, expired=lambda: True)
    assert prover._part(model, 0) == Weighted([(Balance(0), one(Fraction(3, 4)))])
    assert (prover._least, prover._failed, prover._leaves) == (one(Fraction(3, 4)), False, 1)
    # of two that prove the same, the first
    monkeypatch.setattr(PlanProver, "_weights", lambda *_: [{4: one(1)}, {5: one(1)}])
    prover, model = begun(flows(">0", ">1", targets=(0, 1)), claim_of([1, 1], 5), expired=lambda: True)
    assert prover._part(model, 0) == Weighted([(Balance(0), one(1))])
    monkeypatch.setattr(PlanProver, "_weights", lambda *_: weights[:1])
    prover, model = begun(flows(">0"), claim)
    assert prover._part(model, 0) == Weighted([])
    assert prover._failed
    monkeypatch.undo()
    circle = flows("1*>0", "0*>1", ">0", targets=(0,))
    prover, model = begun(circle, claim_of([1, 1, 5], 5, parts=None), expired=lambda: True)
    prover._part(model, 0)
    assert prover._landmarks == []  # there is no time for more
    prover, model = begun(circle, claim_of([1, 1, 5], 5, parts=None))
    prover._part(model, 0)
    assert prover._least == one(5)
    assert prover._landmarks != []


def test_what_is_given_up_lowers_the_claim() -> None:
    prover, _ = begun(flows(">0"), claim_of([1], 5, parts=2))
    prover._give_up((one(Fraction(16, 5)), ()))
    assert (prover._least, prover._failed) == (one(Fraction(7, 2)), False)
    prover._give_up((one(4), ()))
    assert (prover._least, prover._failed) == (one(Fraction(7, 2)), False)
    prover._give_up(None)
    assert prover._failed
    none, _ = begun(flows(">0"), claim_of([0], None))
    none._give_up((one(0), ()))
    assert none._failed


def test_what_is_enough() -> None:
    prover, _ = begun(flows(">0"), claim_of([1], 3, parts=1))
    assert [prover._is_enough(one(Fraction(n, 10))) for n in (20, 21, 30, 31)] == [False, True, True, True]
    prover._claim = prover._claim._replace(parts=None)
    assert [prover._is_enough(one(Fraction(n, 10))) for n in (29, 30)] == [False, True]
    prover._least = None
    assert [prover._is_enough(one(n)) for n in (-1, 0, Fraction(1, 9))] == [False, False, True]


# --- Weights of what floats say.


def rounded(found: Sequence[Mapping[int, Vector]]) -> list[dict[int, Fraction]]:
    return [{row: weight for row, (weight,) in weights.items()} for weights in found]


def test_weights_of_floats_are_rounded_or_those_of_the_basis() -> None:
    prover, model = begun(flows(">0", ">0"), claim_of([1, 1], 1))
    # rows 0 to 3 hold what is executed; only row 4, of the target, is a condition
    assert [*model.conditions] == [4]

    def made(weight: float, x: list[float], parts: int | None = 1, least: int | None = 1) -> Any:
        prover._claim = claim_of([1, 1], least, parts=parts)
        prover._least = prover._claim.least
        relaxed = Relaxation(x, [9.0, 9.0, 0.0, 0.0, weight], [0], [4])
        return rounded(prover._weights(model, relaxed))

    once = [1.0, 0.0, 1.0, 0.0]
    third = Fraction(1, 3)
    fine = Fraction(round(2**40 / 3), 2**40)
    assert made(1 / 3, once) == [{4: third}, {4: fine}]
    assert made(-0.5, once) == [{}, {}]
    assert made(1 / 720720, once)[0] == {4: Fraction(1, 720720)}
    assert made(1e15, once) == [{}, {}]
    # where 1 has no parts, the weights that the basis has are solved for
    assert made(1 / 3, once, None) == [{4: third}, {4: fine}, {4: 1}]
    assert made(1 / 3, once, None, None) == [{4: third}, {4: fine}, {4: 1}]
    assert made(1 / 3, [0.5, 0.0, 1.0, 0.0], None) == [{4: third}, {4: fine}]  # too far from what is claimed
    for x, least, exact in ((3.0, 3, 1), (3 - 2e-6, 3, 1), (3 - 4e-6, 3, 0), (1 - 1e-6, 1, 0)):
        basis = [{4: 1}] * exact
        assert made(1 / 3, [x, 0.0, 1.0, 0.0], None, least) == [{4: third}, {4: fine}, *basis]
    nothing = Fraction(0)
    pair, cost = Lexicographic([None, None]), (Fraction(1), nothing)
    prover._claim = Claim(pair, [cost] * 2, (nothing, nothing), cost, 1, [])
    prover._least = cost
    found = prover._weights(model, Relaxation(once, [0.0] * 4 + [0.5], [0], [4]))
    assert found == [{4: (Fraction(1, 2), nothing)}] * 2
    prover._claim = claim_of([1, 1], 1)._replace(order=Lexicographic([[Fraction(1, 2)]]))  # of rates
    prover._least = prover._claim.least
    rate = -math.log(0.5)
    found = prover._weights(model, Relaxation(once, [0.0, 0.0, 0.0, 0.0, rate * 0.75], [0], [4]))
    assert rounded(found)[:2] == [{4: Fraction(3, 4)}] * 2
    prover._claim = claim_of([1, 1], 1)
    assert prover._exact_weights(model, Relaxation(once, [], [0, 1], [4])) == []
    assert prover._exact_weights(model, Relaxation(once, [], [0], [4, 2])) == []
    assert prover._exact_weights(model, Relaxation(once, [], [2], [4])) == []  # a basis that is none
    weights = prover._exact_weights(model, Relaxation(once, [], [0, 2], [4, 2]))
    assert rounded(weights) == [{4: 1}]


def test_where_there_is_no_solution_weights_are_as_great_as_wanted() -> None:
    limit = ({0: 1}, 0, False, False)
    prover, model = begun(flows(">0"), claim_of([1], None), limits=[limit])
    assert [*model.conditions] == [2, 3]

    def made(weights: list[float], least: int | None = None) -> Any:
        prover._claim = claim_of([1], least)
        prover._least = prover._claim.least
        return rounded(prover._weights(model, Relaxation(None, [0.0, 0.0, *weights], [], [])))

    model.program.upper[0] = 1
    assert made([4.0, 4.0]) == [{2: 1, 3: 1}]
    assert made([4.0, 2.0]) == [{2: 1, 3: Fraction(1, 2)}]
    assert made([4.0, 4.0], 7) == [{2: 9, 3: 9}]
    assert made([4.0, 2.0], 7) == [{2: 16, 3: 8}]
    assert made([4.0, 4.0], -7) == [{2: 9, 3: 9}]
    assert made([0.0, 0.0]) == []
    assert made([0.0, 4.0]) == []  # which say nothing
    prover, model = begun(flows(">0"), claim_of([1], None), limits=[({0: 10**7}, 0, False, False)])
    model.program.upper[0] = 1
    assert made([1.0, 1e-7]) == [{2: 1, 3: Fraction(109951, 2**40)}]  # too little for coarser parts
