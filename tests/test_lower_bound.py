"""Proofs and bounds on small graphs: what is proved, by which cuts, and what is asked for it."""

import math
import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

import pytest

from foon_asp.bounds import lower_bound
from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.exact_optimum import ExactOptimum, Limit, exact_optimum
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lexicographic import Lexicographic
from foon_asp.bounds.lower_bound import (
    Branch,
    Broken,
    CheaperError,
    Dear,
    Hopeless,
    Packing,
    Proof,
    Prover,
    _cuts,
    _Node,
)
from foon_asp.bounds.relaxation import Covering, Relaxed
from foon_asp.bounds.shared_costs import share_costs
from foon_asp.errors import BugError

COUNT = Lexicographic([None])

# 0 and 1 are at hand; 4 is made of 2 and 3, 2 from 0 or from 3, 3 from 1 or from 2: there is a circle.
KITCHEN = Hypergraph(5, needs=[[2, 3], [0], [3], [1], [2]], gives=[[4], [2], [2], [3], [3]], start=[0, 1])


def costs(*values: int) -> list[tuple[Fraction]]:
    return [(Fraction(value),) for value in values]


def ones(graph: Hypergraph) -> list[tuple[Fraction]]:
    return costs(*[1] * len(graph.needs))


def covering(sets: list[list[int]], elements: int) -> tuple[Hypergraph, list[int]]:
    """Ask for elements, each of which needs one of the sets that hold it; sets cost, elements do not."""
    needs: list[list[int]] = [[] for _ in sets]
    gives = [[number] for number in range(len(sets))]
    for number, members in enumerate(sets):
        for element in members:
            needs.append([number])
            gives.append([len(sets) + element])
    return Hypergraph(len(sets) + elements, needs, gives, []), [len(sets) + e for e in range(elements)]


def least_cover(sets: list[list[int]], elements: int) -> list[int]:
    for size in range(len(sets) + 1):
        for chosen in combinations(range(len(sets)), size):
            if {e for number in chosen for e in sets[number]} == set(range(elements)):
                return list(chosen)
    raise AssertionError


def check(
    graph: Hypergraph, targets: list[int], costs: list[tuple[Fraction]], proof: Proof
) -> Fraction | None:
    """Recompute what a proof proves: the least of its leaves, ``None`` where there is no derivation."""

    def left(packing: Packing, action: int) -> Fraction:
        load = sum((weight for cut, (weight,) in packing.weights if action in cut.members), Fraction(0))
        return costs[action][0] - load

    def bound(proof: Proof, used: frozenset[int], without: frozenset[int]) -> Fraction | None:
        if isinstance(proof, Branch):
            sides = (
                bound(proof.without, used, without | {proof.action}),
                bound(proof.using, used | {proof.action}, without),
            )
            return min((side for side in sides if side is not None), default=None)
        assert not isinstance(proof, Broken)  # there are no rules
        if isinstance(proof, Dear):
            others = bound(proof.others, used, without.union(proof.actions))
            least = bound(proof.packing, used, without)
            assert least is not None
            assert not used.intersection(proof.actions)
            dear = [least + left(proof.packing, action) for action in proof.actions]
            return min(dear if others is None else [*dear, others])
        wanted = {*targets, *(o for a in used for o in graph.needs[a])}
        cuts = [proof.cut] if isinstance(proof, Hopeless) else [cut for cut, _ in proof.weights]
        for cut in cuts:
            assert wanted & {*cut.objects}
        if isinstance(proof, Hopeless):
            assert not {*proof.cut.members} - without
            return None
        assert isinstance(proof, Packing)
        for action, (cost,) in enumerate(costs):
            more = cost if action in used else Fraction(0)
            assert left(proof, action) >= more or action in without
        return sum((w for _, (w,) in proof.weights), Fraction(0)) + sum(
            (costs[a][0] for a in used), Fraction(0)
        )

    return bound(proof, frozenset(), frozenset())


def test_branching_closes_the_gap_of_random_covers() -> None:
    branched = 0
    for seed in range(40):
        rng = random.Random(seed)
        elements = rng.randint(4, 7)
        sets = [rng.sample(range(elements), 2) for _ in range(rng.randint(6, 9))]
        sets += [[e] for e in range(elements) if not any(e in members for members in sets)]
        graph, targets = covering(sets, elements)
        costs = [(Fraction(number < len(sets)),) for number in range(len(graph.needs))]
        best = least_cover(sets, elements)
        derivation = [*best, *_deliveries(sets, best, elements)]
        prover = Prover(graph, targets, costs, COUNT)
        proof = prover.prove(derivation)
        assert proof is not None
        assert check(graph, targets, costs, proof) == len(best)
        branched += isinstance(proof, Branch)
        worse = [*range(len(sets)), *_deliveries(sets, list(range(len(sets))), elements)]
        if len(best) < len(sets):
            with pytest.raises(CheaperError) as found:
                prover.prove(worse)
            assert Cutter(graph, targets).reached_by(found.value.actions)
            assert sum(a < len(sets) for a in found.value.actions) < len(sets)
    assert branched >= 5


def _deliveries(sets: list[list[int]], chosen: list[int], elements: int) -> list[int]:
    """Give for each element one action that takes it from a chosen set."""
    actions = [(number, element) for number, members in enumerate(sets) for element in members]
    first: dict[int, int] = {}
    for place, (number, element) in enumerate(actions):
        if number in chosen:
            first.setdefault(element, len(sets) + place)
    return [first[element] for element in range(elements)]


def test_the_relaxation_gives_what_it_has() -> None:
    graph, targets = covering([[0, 1], [0, 2], [1, 2]], 3)
    costs = [(Fraction(number < 3),) for number in range(len(graph.needs))]
    relaxed = Prover(graph, targets, costs, COUNT).relax([])
    assert relaxed is not None
    packing, value = relaxed
    assert value == (Fraction(3, 2),)
    assert check(graph, targets, costs, packing) == Fraction(3, 2)


def test_time_is_kept() -> None:
    graph, targets = covering([[0, 1], [0, 2], [1, 2]], 3)
    assert Prover(graph, targets, ones(graph), COUNT, expired=lambda: True).prove([0, 1, 3, 4, 6]) is None


def test_targets_at_hand_cost_nothing() -> None:
    assert Prover(KITCHEN, [0, 1], ones(KITCHEN), COUNT).prove([]) == Packing(())


def test_what_is_forbidden_is_out_of_every_proof() -> None:
    prover = Prover(KITCHEN, [4], ones(KITCHEN), COUNT, frozenset({1}))
    proof = prover.prove([0, 3, 2])
    assert isinstance(proof, Packing)
    assert all(1 not in cut.members for cut, _ in proof.weights)
    lost = Cutter(KITCHEN, [4], frozenset({1, 3})).hopeless
    assert lost is not None
    assert lost.members == ()


class Watched(Covering):
    """A relaxation that takes only rows that its last solution misses."""

    def __init__(self, costs: Sequence[float]) -> None:
        super().__init__(costs)
        self.rows: list[list[int]] = []
        self.solutions: list[Relaxed] = []

    def add(self, row: Sequence[int]) -> None:
        assert sum(self.solutions[-1].x[column] for column in row) < 0.999999
        assert row not in self.rows
        self.rows.append(list(row))
        super().add(row)

    def solve(self, expired: Callable[[], bool] = lambda: False) -> Relaxed:
        self.solutions.append(super().solve(expired))
        return self.solutions[-1]


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> list[Watched]:
    """Give the relaxations as they are made, the first of all the root's."""
    made: list[Watched] = []

    def make(costs: Sequence[float]) -> Watched:
        made.append(Watched(costs))
        return made[-1]

    monkeypatch.setattr(lower_bound, "Covering", make)
    return made


@pytest.fixture
def floats_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have every basis lead nowhere."""
    monkeypatch.setattr(lower_bound, "exact_optimum", lambda *_: None)


# Two triangles that share set 0: elements are their sides, sets their corners. Half of each set costs 5/2.
BOWTIE = [[0, 1, 3, 4], [0, 2], [1, 2], [3, 5], [4, 5]]


def test_a_cheaper_derivation_may_be_found_among_those_that_use_an_action() -> None:
    graph, targets = covering(BOWTIE, 6)
    price = costs(*[1] * 5, *[0] * 12)
    without = [1, 2, 3, 4]
    with pytest.raises(CheaperError, match=r"^a cheaper derivation was found$") as found:
        Prover(graph, targets, price, COUNT).prove([*without, *_deliveries(BOWTIE, without, 6)])
    sets = [action for action in found.value.actions if action < 5]
    assert len(sets) == 3
    assert sets[0] == 0
    assert Cutter(graph, targets).reached_by(found.value.actions)


def test_cuts_are_grown_beside_each_other_and_past_what_costs_nothing() -> None:
    graph, targets = covering(BOWTIE, 6)
    price = costs(*[1] * 5, *[0] * 12)

    def node(limits: Sequence[Limit] = ()) -> _Node:
        prover = Prover(graph, targets, price, COUNT, limits=limits)
        return _Node(prover, Cutter(graph, targets), frozenset(), frozenset(), None)

    free = node()
    free._share([0.0] * 17)
    assert free.shares == [0.0] * 5 + [1.0] * 12
    assert free._admit_beside()
    members = [a for cut in free.cuts for a in cut.members]
    assert len(members) == len({*members}) > 2
    assert max(members) < 5
    free._share([1.0] * 5 + [0.0] * 12)
    assert not free._admit_beside()
    # of what a limit may count, all counts
    limited = node([({16: Fraction(1)}, Fraction(1))])
    limited._share([0.0] * 18)
    assert limited.shares == [0.0] * 18


def test_no_more_cuts_are_looked_for_than_rounding_up_asks_for(monkeypatch: pytest.MonkeyPatch) -> None:
    # the sides of a triangle come to 3/2, and of its corners every cover has 2
    graph, targets = covering([[0, 1], [0, 2], [1, 2]], 3)
    price = costs(*[1] * 3, *[0] * 6)
    best = [0, 1, *_deliveries([[0, 1], [0, 2], [1, 2]], [0, 1], 3)]
    asked: list[float] = []
    solve, separate = Covering.solve, _Node._separate

    def solved(relaxation: Covering, _: object) -> Relaxed:
        asked.append(solve(relaxation).value)
        return solve(relaxation)

    def separated(node: _Node) -> bool:
        assert asked[-1] <= 1
        return separate(node)

    monkeypatch.setattr(Covering, "solve", solved)
    assert isinstance(Prover(graph, targets, price, COUNT).prove(best), Branch)
    monkeypatch.setattr(_Node, "_separate", separated)
    proof = Prover(graph, targets, price, COUNT, multiples=[Fraction(1)]).prove(best)
    assert isinstance(proof, Packing)
    assert proof.rounded == 0
    assert max(asked) > 1


def test_what_is_cheaper_has_nothing_that_cannot_run() -> None:
    # 1 comes of 0 at once, dear or cheap, or for nothing of 2, which has a price
    graph = Hypergraph(3, needs=[[], [], [2], []], gives=[[1], [1], [1], [2]], start=[0])
    with pytest.raises(CheaperError) as found:
        Prover(graph, [1], costs(5, 1, 0, 4), COUNT).prove([0])
    assert found.value.actions == (1,)


def test_the_most_expensive_of_those_half_taken_is_branched_on() -> None:
    sets = [[0, 1], [0, 2], [1, 2]]
    graph, targets = covering(sets, 3)
    for dear in range(3):
        price = costs(*(3 if number == dear else 2 for number in range(3)), *[0] * 6)
        best = sorted({0, 1, 2} - {dear})
        proof = Prover(graph, targets, price, COUNT).prove([*best, *_deliveries(sets, best, 3)])
        assert isinstance(proof, Branch)
        assert proof.action == dear
        assert check(graph, targets, price, proof) == 4
        same = Prover(graph, targets, costs(*[1] * 3, *[0] * 6), COUNT)
        again = same.prove([*best, *_deliveries(sets, best, 3)])
        assert isinstance(again, Branch)
        assert again.action == 0  # the first where all cost the same


def test_what_is_nearest_to_half_taken_is_branched_on() -> None:
    # four sets of which each element is in three, for a third of each, and a triangle of cheap ones
    sets = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3], [4, 5], [4, 6], [5, 6]]
    graph, targets = covering(sets, 7)
    price = costs(*[9] * 4, *[1] * 3, *[0] * 18)
    best = [0, 1, 4, 5]
    proof = Prover(graph, targets, price, COUNT).prove([*best, *_deliveries(sets, best, 7)])
    assert isinstance(proof, Branch)
    assert proof.action == 4
    assert check(graph, targets, price, proof) == 20


@pytest.mark.parametrize("seed", [0, 3, 4])
def test_what_floats_take_for_nothing_is_proved_too(seed: int) -> None:
    rng = random.Random(seed)
    sets = [rng.sample(range(6), rng.randint(2, 3)) for _ in range(8)] + [[e] for e in range(6)]
    graph, targets = covering(sets, 6)
    price = costs(*[1] * len(sets), *[0] * (len(graph.needs) - len(sets)))
    best = least_cover(sets, 6)
    order = Lexicographic([[1 - Fraction(1, 10**400)]])
    proof = Prover(graph, targets, price, order).prove([*best, *_deliveries(sets, best, 6)])
    assert proof is not None
    assert check(graph, targets, price, proof) == len(best)


def test_what_is_out_of_reach_is_proved_by_its_cut() -> None:
    prover = Prover(KITCHEN, [4], ones(KITCHEN), COUNT, frozenset({1, 3}))
    assert prover.prove([0, 1, 3]) == Hopeless(Cut((2, 3, 4), ()))
    assert prover.relax([0, 1, 3]) is None


def test_a_branch_may_be_out_of_reach() -> None:
    # an element that only set 3 holds besides a triangle: 3 holds a side of it, too
    sets = [[0, 1], [0, 2], [1, 2], [3]]
    graph, targets = covering(sets, 4)
    price = costs(1, 1, 1, 5, *[0] * 7)
    best = [0, 1, 3]
    proof = Prover(graph, targets, price, COUNT).prove([*best, *_deliveries(sets, best, 4)])
    assert proof is not None
    assert check(graph, targets, price, proof) == 7


def test_where_all_is_at_hand_nothing_is_cheaper_than_anything() -> None:
    with pytest.raises(CheaperError) as found:
        Prover(KITCHEN, [0, 1], ones(KITCHEN), COUNT).prove([2])
    assert found.value.actions == ()


# targets 1, 2 and 3, and what makes them: actions 0 and 1 make 1, 1 and 2 make 2, 3 makes 3
THREE = Hypergraph(4, needs=[[], [0], [], []], gives=[[1], [1, 2], [2], [3]], start=[0])


@pytest.mark.parametrize(
    ("price", "known", "weights"),
    [
        ([3, 2, 1, 1], [[1], [2], [3]], [((1,), (0, 1), 2), ((3,), (3,), 1)]),
        ([3, 2, 1, 1], [[2], [1], [3]], [((2,), (1, 2), 1), ((1,), (0, 1), 1), ((3,), (3,), 1)]),
        ([1, 2, 1, 0], [[3], [1], [2]], [((1,), (0, 1), 1), ((2,), (1, 2), 1)]),
    ],
)
def test_known_cuts_are_given_what_their_members_have_left(
    price: list[int],
    known: list[list[int]],
    weights: list[tuple[tuple[int, ...], tuple[int, ...], int]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delattr(lower_bound, "Covering")  # not even asked for
    prover = Prover(THREE, [1, 2, 3], costs(*price), COUNT, known=map(iter, known))
    proof = prover.prove([1, 3])
    assert proof == Packing(tuple((Cut(o, m), (Fraction(w),)) for o, m, w in weights))


def test_known_cuts_are_weighed_by_the_first_level_that_differs() -> None:
    half = Fraction(1, 2)
    order = Lexicographic([[half, half**2], None])
    price = [tuple(map(Fraction, cost)) for cost in ((2, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 9))]
    proof = Prover(THREE, [1, 2, 3], price, order, known=[[1], [3]]).prove([1, 3])
    assert proof == Packing(((Cut((1,), (0, 1)), price[1]), (Cut((3,), (3,)), price[3])))


def test_known_cuts_that_fall_short_are_no_proof() -> None:
    prover = Prover(THREE, [1, 2, 3], costs(2, 2, 2, 1), COUNT, known=[[1]])
    proof = prover.prove([1, 3])
    assert isinstance(proof, Packing)
    assert check(THREE, [1, 2, 3], costs(2, 2, 2, 1), proof) == 3
    with pytest.raises(CheaperError) as found:
        prover.prove([0, 2, 3])
    assert found.value.actions == (1, 3)


def test_a_bound_is_rounded_up_where_it_is_no_multiple() -> None:
    order = Lexicographic([None, None, None])
    multiples = [Fraction(2), Fraction(0), Fraction(3, 2)]
    prover = Prover(KITCHEN, [4], [order.zero] * 4, order, multiples=multiples)

    def rounded(*bound: Fraction | int) -> tuple[list[object], int | None]:
        found, place = prover.rounded(tuple(map(Fraction, bound)))
        return [*found], place

    third = Fraction(1, 3)
    assert rounded(4, third, 3) == ([4, third, 3], None)
    assert rounded(7 * third, 5, 1) == ([4, 0, 0], 0)  # what comes after counts for nothing then
    assert rounded(-3, 5, 1) == ([-2, 0, 0], 0)
    assert rounded(6, 5, 2) == ([6, 5, 3], 2)
    assert Prover(KITCHEN, [4], [order.zero] * 4, order).rounded(order.zero) == (order.zero, None)


def test_known_cuts_with_actions_of_no_use_are_left_out_of_the_relaxation() -> None:
    graph = Hypergraph(3, [[], []], [[1], [2]], [0])
    proof = Prover(graph, [1], costs(2, 1), COUNT, known=[[1, 2]]).prove([0])
    assert proof == Packing(((Cut((1,), (0,)), (Fraction(2),)),))


def test_known_cuts_whose_greedy_weights_fall_short_are_where_the_relaxation_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # of three actions each pair is a landmark; the cheap two can be paid by what they share with the third
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    monkeypatch.setattr(lower_bound._Node, "_separate", lambda _: False)
    known = [[2], [1], [3]]
    proof = Prover(graph, [1, 2, 3], costs(1, 1, 2), COUNT, known=known).prove([0, 1])
    assert isinstance(proof, Packing)
    assert {cut.objects: int(weight) for cut, (weight,) in proof.weights} == {(1,): 1, (3,): 1}
    prover = Prover(graph, [1, 2, 3], costs(1, 1, 2), COUNT)
    assert prover.prove([0, 1]) is None  # nothing else would have been found


@pytest.mark.parametrize("step", [1, 3])
def test_of_many_actions_rounded_weights_of_floats_come_before_exact_ones(
    monkeypatch: pytest.MonkeyPatch, step: int
) -> None:
    # of three actions each pair is a landmark: half of each adds up to one and a half steps, rounded up
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    monkeypatch.setattr(lower_bound, "_MANY", 2)
    monkeypatch.setattr(lower_bound, "_Node", None)
    each = costs(step, step, step)
    for known in ([], [[2]]):
        prover = Prover(graph, [1, 2, 3], each, COUNT, known=known, multiples=[Fraction(step)])
        proof = prover.prove([0, 1])
        assert isinstance(proof, Packing)
        assert check(graph, [1, 2, 3], each, proof) == Fraction(3 * step, 2)
        assert {weight for _, (weight,) in proof.weights} == {Fraction(step, 2)}
        assert (proof.limits, proof.rounded) == ((), 0)
    for several in (
        [Fraction(0)],
        [],
        [Fraction(1), Fraction(1)],
    ):  # nothing is rounded up, or costs have parts
        with pytest.raises(TypeError, match="NoneType"):
            Prover(graph, [1, 2, 3], each, COUNT, multiples=several).prove([0, 1])
    limited = Prover(
        graph, [1, 2, 3], each, COUNT, limits=[({0: Fraction(1)}, Fraction(9))], multiples=[Fraction(1)]
    )
    with pytest.raises(TypeError, match="NoneType"):
        limited.prove([0, 1])
    monkeypatch.setattr(lower_bound, "_MANY", 3)
    with pytest.raises(TypeError, match="NoneType"):
        Prover(graph, [1, 2, 3], each, COUNT, multiples=[Fraction(step)]).prove([0, 1])


@pytest.mark.parametrize(("worth", "kind"), [(1.0, Branch), (0.0, Dear)])
def test_rounded_weights_prove_each_of_the_cases_that_are_told_apart(
    worth: float, kind: type, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lower_bound, "_MANY", 0)
    monkeypatch.setattr(lower_bound, "_WORTH", worth)

    share: Any = share_costs
    shares: list[bool] = []

    def with_some_decided(*asked: Any, often: int) -> object:
        """At first, where all actions are there, the weights would be enough."""
        at_first = len(asked[2]) == len(asked[0].needs)
        shares.append(at_first)
        return None if kind is Branch and at_first else share(*asked, often=often)

    monkeypatch.setattr(lower_bound, "share_costs", with_some_decided)
    met = 0
    for seed in range(12):
        chance = random.Random(seed)
        sets = [chance.sample(range(7), 2) for _ in range(9)]
        sets += [[e] for e in range(7) if not any(e in members for members in sets)]
        graph, targets = covering(sets, 7)
        prices = costs(*[int(action < len(sets)) for action in range(len(graph.needs))])
        best = least_cover(sets, 7)
        derivation = [*best, *_deliveries(sets, best, 7)]
        cases = (chance.randrange(9), (chance.randrange(9), None, None), (chance.randrange(9), None, None))
        for told, known in ((None, [[9], targets[:1]]), (cases, [])):
            prover = Prover(graph, targets, prices, COUNT, known=known, multiples=[Fraction(1)])
            proof = prover.prove(derivation, told)
            assert proof is not None
            proved = check(graph, targets, prices, proof)
            assert proved is not None
            assert math.ceil(proved) == len(best)
            met += isinstance(proof, kind)
    assert met > 8
    assert any(shares)
    assert not all(shares)


def test_what_is_used_is_never_too_dear(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lower_bound, "_WORTH", 0.0)
    prover = Prover(KITCHEN, [4], costs(3, 3, 5, 1, 1), COUNT, multiples=[Fraction(1)])
    asked: list[frozenset[int]] = []
    rest = Hopeless(Cut((2, 3), ()))

    def others(dear: frozenset[int], known: object) -> Proof:
        asked.append(dear)
        return rest

    packing = Packing(((Cut((4,), (0,)), (Fraction(1),)),))
    # the weights come to 1 of 4, and leave 2 of the first action: of the others, 3 and more is too dear
    for used in (frozenset[int](), frozenset({2})):
        how = (
            Cutter(KITCHEN, [4]),
            used,
            (Fraction(4),),
            packing,
            {0: (Fraction(2),)},
            others,
            (),
            Fraction(1),
        )
        found = prover._narrowed(*how)
        assert found == Dear((1,), packing._replace(rounded=0), rest)  # the only one that crosses the cut
    assert asked == [{1, 2}, {1}]


def test_the_cuts_of_a_proof_are_those_of_all_its_parts() -> None:
    first, second, third, fourth = (Cut((number,), ()) for number in range(4))
    weight = (Fraction(1),)
    dear = Dear((1,), Packing(((first, weight), (second, weight))), Packing(((third, weight),)))
    assert {*_cuts(Branch(0, Hopeless(fourth), dear))} == {first, second, third, fourth}
    assert {*_cuts(Branch(0, dear, Broken(0)))} == {first, second, third}


def test_known_cuts_before_no_target_are_not_weighed() -> None:
    proof = Prover(THREE, [2], costs(5, 9, 1, 1), COUNT, known=[[1], [2]]).prove([2])
    assert proof == Packing(((Cut((2,), (1, 2)), (Fraction(1),)),))


def test_what_makes_up_for_a_limit_is_no_action() -> None:
    limits = [({0: Fraction(1)}, Fraction(1)), ({1: Fraction(2), 2: Fraction(1)}, Fraction(2))]
    prover = Prover(THREE, [1, 2], ones(THREE), COUNT, limits=limits)
    node = _Node(prover, Cutter(THREE, [1, 2]), frozenset({1}), frozenset(), (Fraction(1),))
    node.shares = [0.0, 1.0, 0.0, 0.5, 1.0]  # of actions 0 to 2, and beyond each limit
    assert node.undecided() is None
    assert node.taken() == [1]
    assert [node.exceeds(actions) for actions in ([], [0, 1], [1, 2], [0, 2])] == [False, False, True, False]


def test_cuts_are_looked_for_until_the_bound_is_enough(
    watched: list[Watched], monkeypatch: pytest.MonkeyPatch
) -> None:
    # ten targets, made two by two: one by one, or both for the same of something that costs as much again
    needs: list[list[int]] = [[] for _ in range(15)] + [[10 + number] for number in range(5)]
    gives = [[number] for number in range(15)] + [[2 * number, 2 * number + 1] for number in range(5)]
    graph = Hypergraph(15, needs, gives, [])
    price = costs(*[1] * 10, *[2] * 10)
    solved: list[int] = []

    def counted(rows: list[list[int]], *words: Any) -> ExactOptimum | None:
        solved.append(len(rows))
        return exact_optimum(rows, *words)

    monkeypatch.setattr(lower_bound, "exact_optimum", counted)
    proof = Prover(graph, range(10), price, COUNT).prove(range(10))
    assert isinstance(proof, Packing)
    assert check(graph, [*range(10)], price, proof) == 10
    (only,) = watched
    values = [solution.value for solution in only.solutions]
    assert values[0] == 0
    assert values == sorted(set(values))
    assert values[-1] == 10
    assert solved == [len(only.rows)]


def test_a_bound_that_floats_take_for_enough_is_raised_further() -> None:
    needs: list[list[int]] = [
        [],
        *[[] for _ in range(10)],
        *[[11 + n] for n in range(10)],
        *[[] for _ in range(10)],
    ]
    gives = [
        [0],
        *[[1 + n] for n in range(10)],
        *[[1 + n] for n in range(10)],
        *[[11 + n] for n in range(10)],
    ]
    graph = Hypergraph(21, needs, gives, [])
    price = costs(10**9, *[1] * 10, *[0] * 10, *[1] * 10)
    proof = Prover(graph, range(11), price, COUNT).prove(range(11))
    assert isinstance(proof, Packing)
    assert check(graph, [*range(11)], price, proof) == 10**9 + 10


@pytest.mark.usefixtures("floats_alone")
def test_floats_alone_prove_nothing_and_find_what_is_cheaper() -> None:
    graph, targets = covering(BOWTIE, 6)
    price = costs(*[1] * 5, *[0] * 12)
    best, worse = [0, 1, 3], [0, 1, 2, 3, 4]
    prover = Prover(graph, targets, price, COUNT)
    assert prover.relax([*best, *_deliveries(BOWTIE, best, 6)]) is None
    assert prover.prove([*best, *_deliveries(BOWTIE, best, 6)]) is None
    assert Prover(KITCHEN, [4], ones(KITCHEN), COUNT).prove([0, 1, 3]) is None  # all are taken, for as much
    with pytest.raises(CheaperError) as found:
        prover.prove([*worse, *_deliveries(BOWTIE, worse, 6)])
    assert Cutter(graph, targets).reached_by(found.value.actions)
    assert [action for action in found.value.actions if action < 5] == [1, 2, 3, 4]


def test_time_may_be_up_at_any_step() -> None:
    graph, targets = covering(BOWTIE, 6)
    price = costs(*[1] * 5, *[0] * 12)
    derivation = [0, 1, 3, *_deliveries(BOWTIE, [0, 1, 3], 6)]
    answers = iter([False] * 1000)
    assert Prover(graph, targets, price, COUNT, expired=answers.__next__).prove(derivation) is not None
    for steps in range(1000 - len(list(answers))):
        answers = iter([False] * steps + [True])
        prover = Prover(graph, targets, price, COUNT, expired=answers.__next__)
        assert prover.prove(derivation) is None
    assert Prover(graph, targets, price, COUNT, expired=lambda: True).relax(derivation) is None


def test_a_level_counts_much_less_than_the_one_before_it() -> None:
    third = Fraction(1, 3)
    counted = Prover(
        KITCHEN,
        [4],
        [(Fraction(a), Fraction(b), Fraction(3)) for a, b in ((2, 0), (1, 7), (0, 1), (2, 2), (1, 1))],
        Lexicographic([None] * 3),
    )
    assert counted.scaled((Fraction(1), Fraction(0), Fraction(0))) == 1
    assert counted.scaled((Fraction(0), Fraction(1), Fraction(0))) == pytest.approx(1e-4 / 3)
    assert counted.scaled((Fraction(0), Fraction(0), Fraction(1))) == pytest.approx(1e-4 / 3 * 1e-4 / 8)
    assert counted.scaled((Fraction(5), Fraction(3), third)) == pytest.approx(5 + 1e-4 + 1e-8 / 72)


def test_rates_are_measured_by_the_least_of_them() -> None:
    half = Fraction(1, 2)
    order = Lexicographic([[half, half**2], None])
    price = [tuple(map(Fraction, cost)) for cost in ((1, 0, 1), (0, 1, 4), (0, 1, 1), (1, 0, 1), (0, 0, 1))]
    prover = Prover(KITCHEN, [4], price, order)
    assert prover.scaled((Fraction(0), Fraction(1), Fraction(0))) == pytest.approx(1)
    assert prover.scaled((Fraction(1), Fraction(0), Fraction(0))) == pytest.approx(0.5)
    assert prover.scaled((Fraction(0), Fraction(0), Fraction(4))) == pytest.approx(2e-4)
    # so near to 1 that floats have nothing for it
    near = Lexicographic([[1 - Fraction(1, 10**400)], None])
    lost = Prover(KITCHEN, [4], [(Fraction(1), Fraction(1))] * 5, near)
    assert lost.scaled((Fraction(1), Fraction(1))) == pytest.approx(1e-4)


def test_the_relaxation_gives_shares_and_its_basis() -> None:
    relaxation = Covering([1.0, 1.0, 1.0, 5.0])
    assert relaxation.solve() == Relaxed(0.0, [0.0] * 4, [], [])
    for row in ([0, 1, 3], [1, 2], [0, 2, 3], [0, 1, 2]):
        relaxation.add(row)
    assert relaxation.solve() == Relaxed(1.5, [0.5, 0.5, 0.5, 0.0], [0, 1, 2], [0, 1, 2])
    relaxation.add([3])
    assert relaxation.solve().value == 6.0
    assert Covering([]).solve() == Relaxed(0.0, [], [], [])


def test_a_relaxation_is_stopped_on_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.bounds.highs_run._STEPS", 1)
    asked: list[int] = []

    def at(last: int) -> Callable[[], bool]:
        def expired() -> bool:
            asked.append(1)
            return len(asked) >= last

        return expired

    def hexagon() -> Covering:
        relaxation = Covering([1.0] * 6)
        for a in range(6):
            relaxation.add([a, (a + 1) % 6, (a + 2) % 6])
        return relaxation

    stopped = hexagon()
    early = stopped.solve(at(2))
    assert (len(asked), len(early.x), len(stopped.weights())) == (2, 6, 6)
    whole = hexagon().solve(at(10**6))
    assert len(asked) > 2
    assert whole.value == pytest.approx(2.0)
    assert hexagon().solve().value == pytest.approx(2.0)


def test_a_solution_amid_others_is_none_where_it_takes_long_and_a_corner_follows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    relaxation = Covering([1.0, 1.0, 1.0, 5.0])
    for row in ([0, 1, 3], [1, 2], [0, 2, 3]):
        relaxation.add(row)
    amid = relaxation.inside()
    assert amid is not None
    assert amid.value == pytest.approx(1.5, abs=1e-5)
    assert amid.x == pytest.approx([0.5, 0.5, 0.5, 0.0], abs=1e-4)
    assert amid.weights == pytest.approx([0.5] * 3, abs=1e-4)
    corner = relaxation.solve()
    assert corner.value == pytest.approx(1.5)
    assert (corner.columns, corner.rows) == ([0, 1, 2], [0, 1, 2])
    relaxation.add([3])
    assert relaxation.solve().value == pytest.approx(6.0)
    rng = random.Random(1)
    many = Covering([1.0] * 40)
    for _ in range(60):
        many.add(rng.sample(range(40), 5))
    whole = many.inside()
    assert whole is not None
    monkeypatch.setattr("foon_asp.bounds.relaxation._SOON", 0.0)
    assert many.inside() is None
    assert many.solve().value == pytest.approx(whole.value, abs=1e-5)  # by steps from nothing


def test_a_row_that_nothing_covers_is_a_bug(capfd: pytest.CaptureFixture[str]) -> None:
    relaxation = Covering([1.0])
    relaxation.add([])
    with pytest.raises(BugError, match=r"HiGHS ends a covering problem with HighsModelStatus\.kInfeasible"):
        relaxation.solve()
    assert capfd.readouterr() == ("", "")
