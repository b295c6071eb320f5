"""Proofs and bounds on small graphs: what is proved, held against brute force and by hand."""

import random
from collections import Counter
from collections.abc import Callable
from fractions import Fraction
from itertools import combinations
from operator import mul
from typing import Any

import pytest

from foon_asp.errors import BugError
from foon_asp.hypergraph import optimality_proof, tuning
from foon_asp.hypergraph.branch_and_bound import prove_by_branching
from foon_asp.hypergraph.covering import BasicSolution, Covering
from foon_asp.hypergraph.cut import Cut
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.lexicographic import Lexicographic
from foon_asp.hypergraph.optimality_proof import CheaperError, Prover
from foon_asp.hypergraph.proof_tree import Branch, CostFixing, Hopeless, Packing, Proof
from tests.hypergraph.small_graphs import asked, best_tree, parts, reaches, require_proves

COUNT = Lexicographic([None])

# 0 and 1 are at hand; 4 is made of 2 and 3, 2 from 0 or from 3, 3 from 1 or from 2: there is a circle.
KITCHEN = Hypergraph(5, needs=[[2, 3], [0], [3], [1], [2]], gives=[[4], [2], [2], [3], [3]], start=[0, 1])


def costs(*values: int) -> list[tuple[Fraction]]:
    return [(Fraction(value),) for value in values]


def covering(sets: list[list[int]], elements: int) -> tuple[Hypergraph, list[int]]:
    """Ask for elements, each of which needs one of the sets that hold it; sets cost, elements do not."""
    needs: list[list[int]] = [[] for _ in sets]
    gives = [[number] for number in range(len(sets))]
    for number, members in enumerate(sets):
        for element in members:
            needs.append([number])
            gives.append([len(sets) + element])
    return Hypergraph(len(sets) + elements, needs, gives, []), [len(sets) + e for e in range(elements)]


def random_sets(rng: random.Random, elements: int, count: int) -> list[list[int]]:
    sets = [rng.sample(range(elements), 2) for _ in range(count)]
    return sets + [[e] for e in range(elements) if not any(e in members for members in sets)]


def least_cover(sets: list[list[int]], elements: int) -> list[int]:
    for size in range(len(sets) + 1):
        for chosen in combinations(range(len(sets)), size):
            if {e for number in chosen for e in sets[number]} == set(range(elements)):
                return list(chosen)
    raise AssertionError


def derivation(sets: list[list[int]], chosen: list[int], elements: int) -> list[int]:
    """Return chosen sets, and for each element one action that takes it from one of them."""
    actions = [(number, element) for number, members in enumerate(sets) for element in members]
    first: dict[int, int] = {}
    for place, (number, element) in enumerate(actions):
        if number in chosen:
            first.setdefault(element, len(sets) + place)
    return [*chosen, *(first[element] for element in range(elements))]


# Two triangles that share set 0: elements are their sides, sets their corners. Half of each set costs 5/2.
BOWTIE = [[0, 1, 3, 4], [0, 2], [1, 2], [3, 5], [4, 5]]
BOW, SIDES = covering(BOWTIE, 6)
PRICE = costs(*[1] * 5, *[0] * 12)


def require_cheaper(prover: Prover, worse: list[int], question: Any) -> tuple[int, ...]:
    """Require that a derivation is found that costs less than one."""
    graph, targets, price = question
    with pytest.raises(CheaperError, match=r"^a cheaper derivation was found$") as found:
        prover.prove(worse)
    assert reaches(graph, found.value.actions, targets)
    assert sum(price[a] for a in found.value.actions) < sum(price[a] for a in worse)
    return found.value.actions


def weighed(proof: Any, *factors: Fraction) -> Any:
    """Return the same proof with weights of one part, the sum of all times factors."""
    if isinstance(proof, Packing):
        sums = ((cut, sum(map(mul, weight, factors))) for cut, weight in proof.weights)
        return proof._replace(weights=tuple((cut, (total,)) for cut, total in sums))
    if isinstance(proof, Branch):
        return Branch(proof.action, weighed(proof.without, *factors), weighed(proof.using, *factors))
    if isinstance(proof, CostFixing):
        return CostFixing(proof.actions, weighed(proof.packing, *factors), weighed(proof.others, *factors))
    return proof


def test_branching_closes_the_gap_of_random_covers() -> None:
    branched = 0
    for seed in range(40):
        rng = random.Random(seed)
        elements = rng.randint(4, 7)
        sets = random_sets(rng, elements, rng.randint(6, 9))
        graph, targets = covering(sets, elements)
        price = [int(number < len(sets)) for number in range(len(graph.needs))]
        best, every = least_cover(sets, elements), [*range(len(sets))]
        prover = Prover(graph, targets, costs(*price), COUNT)
        proof = prover.prove(derivation(sets, best, elements))
        assert proof is not None
        require_proves(proof, graph, targets, price, len(best))
        branched += isinstance(proof, Branch)
        if len(best) < len(sets):
            require_cheaper(prover, derivation(sets, every, elements), (graph, targets, price))
    assert branched >= 5


@pytest.mark.parametrize("wrong", [False, True])
@pytest.mark.parametrize("seed", range(20))
def test_what_is_proved_of_random_graphs_is_true(
    seed: int, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where HiGHS says anything."""
    question = graph, targets, price = asked(seed)
    tree, every = best_tree(*question), range(len(price))
    best = sum(price[a] for a in tree)
    drawn, solve = random.Random(seed), Covering.solve

    def anything(covering: Covering, expired: Callable[[], bool] = lambda: False) -> BasicSolution:
        found = solve(covering, expired)
        value, x = drawn.uniform(-9, 9), [drawn.choice([0, 0.5, 1, x]) for x in found.x]
        basis = [pair for pair in zip(found.columns, found.rows, strict=True) if drawn.random() < 0.9]
        return BasicSolution(value, x, [column for column, _ in basis], [row for _, row in basis])

    if wrong:
        monkeypatch.setattr(Covering, "solve", anything)
    prover = Prover(graph, targets, costs(*price), COUNT)
    proof = prover.prove(tree)
    assert wrong or proof is not None
    if proof is not None:
        require_proves(proof, graph, targets, price, best)
    relaxed = prover.relax(tree)
    if relaxed is not None:
        require_proves(relaxed[0], graph, targets, price, relaxed[1][0])
    if sum(price) > best and not wrong:
        require_cheaper(prover, [*every], question)


@pytest.mark.parametrize("seed", range(20))
def test_of_several_levels_the_first_that_differs_decides(seed: int) -> None:
    graph, targets, first = asked(seed, (0, 1, 1, 2))
    rng, large = random.Random(seed), 10**30
    second = [rng.randint(0, 2) for _ in first]
    price = [large * a + b for a, b in zip(first, second, strict=True)]
    tree = best_tree(graph, targets, price)
    best = sum(price[a] for a in tree)
    levels = [(Fraction(a), Fraction(b)) for a, b in zip(first, second, strict=True)]
    proof = Prover(graph, targets, levels, Lexicographic([None, None])).prove(tree)
    assert proof is not None
    require_proves(weighed(proof, Fraction(large), Fraction(1)), graph, targets, price, best)


def test_the_relaxation_gives_what_it_has() -> None:
    graph, targets = covering([[0, 1], [0, 2], [1, 2]], 3)
    price = [int(number < 3) for number in range(len(graph.needs))]
    relaxed = Prover(graph, targets, costs(*price), COUNT).relax([])
    assert relaxed is not None
    packing, value = relaxed
    assert value == (Fraction(3, 2),)
    require_proves(packing, graph, targets, price, Fraction(3, 2))


def test_targets_at_hand_cost_nothing() -> None:
    prover = Prover(KITCHEN, [0, 1], costs(*[1] * 5), COUNT)
    assert prover.prove([]) == Packing(())
    with pytest.raises(CheaperError) as found:
        prover.prove([2])
    assert found.value.actions == ()


def test_what_is_forbidden_is_out_of_every_proof() -> None:
    price = costs(*[1] * 5)
    proof = Prover(KITCHEN, [4], price, COUNT, frozenset({1})).prove([0, 3, 2])
    assert isinstance(proof, Packing)
    assert all(1 not in cut.members for cut, _ in proof.weights)
    prover = Prover(KITCHEN, [4], price, COUNT, frozenset({1, 3}))
    assert prover.prove([0, 1, 3]) == Hopeless(Cut((2, 3, 4), ()))
    assert prover.relax([0, 1, 3]) is None


def test_a_cheaper_derivation_may_be_found_among_those_that_use_an_action() -> None:
    prover = Prover(BOW, SIDES, PRICE, COUNT)
    question = BOW, SIDES, [int(cost) for (cost,) in PRICE]
    found = require_cheaper(prover, derivation(BOWTIE, [1, 2, 3, 4], 6), question)
    assert found[0] == 0
    assert sum(action < 5 for action in found) == 3


def test_what_is_cheaper_has_nothing_that_cannot_run() -> None:
    # 1 comes of 0 at once, dear or cheap, or for nothing of 2, which has a price
    graph = Hypergraph(3, needs=[[], [], [2], []], gives=[[1], [1], [1], [2]], start=[0])
    with pytest.raises(CheaperError) as found:
        Prover(graph, [1], costs(5, 1, 0, 4), COUNT).prove([0])
    assert found.value.actions == (1,)


def test_what_floats_take_for_nothing_is_proved_too() -> None:
    rng = random.Random(3)
    sets = [rng.sample(range(6), rng.randint(2, 3)) for _ in range(8)] + [[e] for e in range(6)]
    graph, targets = covering(sets, 6)
    price = [*[1] * len(sets), *[0] * (len(graph.needs) - len(sets))]
    best = least_cover(sets, 6)
    order = Lexicographic([[1 - Fraction(1, 10**400)]])
    proof = Prover(graph, targets, costs(*price), order).prove(derivation(sets, best, 6))
    assert proof is not None
    require_proves(proof, graph, targets, price, len(best))


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
    price: list[int], known: list[list[int]], weights: list[tuple[tuple[int, ...], tuple[int, ...], int]]
) -> None:
    prover = Prover(THREE, [1, 2, 3], costs(*price), COUNT, known_cuts=map(iter, known))
    proof = prover.prove([1, 3])
    assert proof == Packing(tuple((Cut(o, m), (Fraction(w),)) for o, m, w in weights))


def test_known_cuts_are_weighed_by_the_first_level_that_differs() -> None:
    half = Fraction(1, 2)
    order = Lexicographic([[half, half**2], None])
    price = [tuple(map(Fraction, cost)) for cost in ((2, 0, 1), (0, 1, 0), (0, 1, 0), (1, 0, 9))]
    proof = Prover(THREE, [1, 2, 3], price, order, known_cuts=[[1], [3]]).prove([1, 3])
    assert proof == Packing(((Cut((1,), (0, 1)), price[1]), (Cut((3,), (3,)), price[3])))


def test_known_cuts_that_fall_short_or_are_of_no_use_are_no_proof() -> None:
    prover = Prover(THREE, [1, 2, 3], costs(2, 2, 2, 1), COUNT, known_cuts=[[1]])
    proof = prover.prove([1, 3])
    assert proof is not None
    require_proves(proof, THREE, [1, 2, 3], [2, 2, 2, 1], 3)
    assert require_cheaper(prover, [0, 2, 3], (THREE, [1, 2, 3], [2, 2, 2, 1])) == (1, 3)
    # one is before no target, and one is crossed by an action of no use
    proof = Prover(THREE, [2], costs(5, 9, 1, 1), COUNT, known_cuts=[[1], [2]]).prove([2])
    assert proof == Packing(((Cut((2,), (1, 2)), (Fraction(1),)),))
    graph = Hypergraph(3, [[], []], [[1], [2]], [0])
    proof = Prover(graph, [1], costs(2, 1), COUNT, known_cuts=[[1, 2]]).prove([0])
    assert proof == Packing(((Cut((1,), (0,)), (Fraction(2),)),))


def test_a_bound_is_rounded_up_where_it_is_no_multiple() -> None:
    order = Lexicographic([None, None, None])
    multiples = [Fraction(2), Fraction(0), Fraction(3, 2)]
    prover = Prover(KITCHEN, [4], [order.zero] * 4, order, multiples=multiples)

    def rounded(*bound: Fraction | int) -> tuple[list[object], int | None]:
        found, place = prover.round_up(tuple(map(Fraction, bound)))
        return [*found], place

    third = Fraction(1, 3)
    assert rounded(4, third, 3) == ([4, third, 3], None)
    assert rounded(7 * third, 5, 1) == ([4, 0, 0], 0)  # what comes after counts for nothing then
    assert rounded(-3, 5, 1) == ([-2, 0, 0], 0)
    assert rounded(6, 5, 2) == ([6, 5, 3], 2)
    assert Prover(KITCHEN, [4], [order.zero] * 4, order).round_up(order.zero) == (order.zero, None)


@pytest.mark.parametrize("step", [1, 3])
@pytest.mark.parametrize("many", [2, 1000])
def test_rounding_up_closes_a_gap(step: int, many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of many actions, without exact weights."""
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(rounded_actions=many))
    if many == 2:
        monkeypatch.setattr(optimality_proof, "exact_optimum", lambda *_: None)
    # of three actions each pair is a landmark: half of each adds up to one and a half steps, rounded up
    graph, each = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0]), costs(step, step, step)
    for known in ([], [[2]]):
        prover = Prover(graph, [1, 2, 3], each, COUNT, known_cuts=known, multiples=[Fraction(step)])
        proof = prover.prove([0, 1])
        assert isinstance(proof, Packing)
        assert proof.rounded == 0
        assert sum(weight for _, (weight,) in proof.weights) == Fraction(3 * step, 2)
        require_proves(proof, graph, [1, 2, 3], [step] * 3, Fraction(3 * step, 2))


@pytest.mark.parametrize("searched", [False, True])
@pytest.mark.parametrize("worth", [1.0, 0.0])
def test_of_many_actions_rounded_weights_prove_each_of_the_cases_that_are_told_apart(
    worth: float, searched: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(rounded_actions=0, fixed_share=worth))
    met, answers = Counter[type](), list[Proof | None]()

    def search(*asked: Any) -> Proof | None:
        answers.append(prove_by_branching(*asked) if searched else None)
        return answers[-1]

    monkeypatch.setattr(optimality_proof, "prove_by_branching", search)

    pairs = list(combinations(range(5), 2))
    complete = [[e for e, pair in enumerate(pairs) if corner in pair] for corner in range(5)]
    for seed in range(8):
        chance, step = random.Random(seed), 1 + seed % 3
        free = seed % 2 and not searched  # what costs nothing is not searched
        sets, elements = (complete, 10) if seed % 4 < 2 else (random_sets(chance, 7, 9), 7)
        graph, targets = covering(sets, elements)
        price = [int(not free or action < len(sets)) for action in range(len(graph.needs))]
        best = derivation(sets, least_cover(sets, elements), elements)
        least = sum(price[a] for a in best)
        cases = (chance.randrange(5), (chance.randrange(5), None, None), (chance.randrange(5), None, None))
        each, steps = costs(*(step * cost for cost in price)), [Fraction(step)]
        for told, known in ((None, [[len(sets)], targets[:1]]), (None if searched else cases, [])):
            prover = Prover(
                graph,
                targets,
                each,
                COUNT,
                known_cuts=known,
                multiples=steps,
            )
            proof = prover.prove(best, told)
            assert proof is not None
            met.update(map(type, parts(proof)))
            require_proves(weighed(proof, Fraction(1, step)), graph, targets, price, least, whole=True)
    assert all(answers) or not searched  # it finds a proof each time
    assert met[Packing]
    assert met[Branch]
    assert (met[CostFixing] > 0) == (worth == 0)


def test_what_a_search_proves_is_stated_of_all_actions_and_in_what_they_cost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def proof(cut: Cut, step: int, rounded: int | None = None) -> Proof:
        once, twice = (Packing(((cut, (Fraction(n * step),)),)) for n in (1, 2))
        return Branch(0, Hopeless(cut), CostFixing((1,), once._replace(rounded=rounded), twice))

    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(rounded_actions=0))
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    monkeypatch.setattr(optimality_proof, "prove_by_branching", lambda *_: proof(Cut((1,), (0,)), 1))
    prover = Prover(graph, [1, 2, 3], costs(3, 3, 3), COUNT, multiples=[Fraction(3)])
    found = prover.prove([0, 1, 2])
    assert found == proof(Cut((1,), (0, 2)), 3, rounded=0)


def test_a_bound_that_floats_take_for_enough_is_raised_further() -> None:
    needs: list[list[int]] = [[] for _ in range(11)] + [[11 + n] for n in range(10)] + [[] for _ in range(10)]
    gives = [[n] for n in range(11)] + [[1 + n] for n in range(10)] + [[11 + n] for n in range(10)]
    graph = Hypergraph(21, needs, gives, [])
    price = [10**9, *[1] * 10, *[0] * 10, *[1] * 10]
    proof = Prover(graph, range(11), costs(*price), COUNT).prove(range(11))
    assert proof is not None
    require_proves(proof, graph, range(11), price, 10**9 + 10)


def test_time_may_be_up_at_any_step() -> None:
    best, answers = derivation(BOWTIE, [0, 1, 3], 6), iter([False] * 1000)
    assert Prover(BOW, SIDES, PRICE, COUNT, expired=answers.__next__).prove(best) is not None
    for steps in range(1000 - len(list(answers))):
        answers = iter([False] * steps + [True])
        assert Prover(BOW, SIDES, PRICE, COUNT, expired=answers.__next__).prove(best) is None
    assert Prover(BOW, SIDES, PRICE, COUNT, expired=lambda: True).relax(best) is None


def test_the_relaxation_gives_shares_and_its_basis() -> None:
    relaxation = Covering([1.0, 1.0, 1.0, 5.0])
    assert relaxation.solve() == BasicSolution(0.0, [0.0] * 4, [], [])
    for row in ([0, 1, 3], [1, 2], [0, 2, 3], [0, 1, 2]):
        relaxation.add_row(row)
    assert relaxation.solve() == BasicSolution(1.5, [0.5, 0.5, 0.5, 0.0], [0, 1, 2], [0, 1, 2])
    amid = relaxation.interior_point()
    assert amid is not None
    assert amid.value == pytest.approx(1.5, abs=1e-5)
    assert [*amid.x, *amid.duals] == pytest.approx([0.5, 0.5, 0.5, 0.0] * 2, abs=1e-4)
    relaxation.add_row([3])
    assert relaxation.solve().value == pytest.approx(6.0)
    assert Covering([]).solve() == BasicSolution(0.0, [], [], [])


def test_a_row_that_nothing_covers_is_a_bug(capfd: pytest.CaptureFixture[str]) -> None:
    relaxation = Covering([1.0])
    relaxation.add_row([])
    with pytest.raises(BugError, match=r"HiGHS ends a covering problem with HighsModelStatus\.kInfeasible"):
        relaxation.solve()
    assert capfd.readouterr() == ("", "")
