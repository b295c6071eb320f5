"""Branching over cuts: what it proves is held against brute force, whatever floats say."""

import json
import math
import random
from collections.abc import Callable, Collection, Iterable, Mapping
from fractions import Fraction
from typing import Any, ClassVar

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.asp import Proof, Reporter, Settings, solve
from foon_asp.bounds import branching, lower_bound
from foon_asp.bounds.branching import Branching, TooLongError, _Place, branched
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.landmark_cuts import Cuts
from foon_asp.bounds.lower_bound import Branch, Dear, Hopeless, Packing, Prover
from foon_asp.bounds.lower_bound import Proof as Proved
from foon_asp.bounds.relaxation import Covering, Relaxed
from foon_asp.certificate import certify
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.verify import RefusedError, seal, verify
from foon_asp.reduce import ALL, NONE, SAFE, Reduction, reduce, reduction
from tests.gap_problem import gap_problem
from tests.random_problems import random_problem
from tests.test_shared_costs import asked, cheapest


def require_proves(
    proof: Proved,
    graph: Hypergraph,
    targets: Collection[int],
    costs: list[int],
    total: int,
    used: frozenset[int] = frozenset(),
    without: frozenset[int] = frozenset(),
) -> None:
    """Require that a proof shows, by whole numbers alone, that no derivation costs less than ``total``."""
    wanted = {*targets}.union(*(graph.needs[a] for a in used))

    def crossing(objects: Iterable[int]) -> set[int]:
        inside = {*objects}
        assert inside & wanted
        assert inside.isdisjoint(graph.start)
        actions = {a for a in range(len(costs)) if inside & {*graph.gives[a]}} - without
        return {a for a in actions if inside.isdisjoint(graph.needs[a])}

    if isinstance(proof, Branch):
        assert proof.action not in used | without
        require_proves(proof.without, graph, targets, costs, total, used, without | {proof.action})
        require_proves(proof.using, graph, targets, costs, total, used | {proof.action}, without)
    elif isinstance(proof, Hopeless):
        assert not crossing(proof.cut.objects)
    else:
        packing = proof.packing if isinstance(proof, Dear) else proof
        assert isinstance(packing, Packing)
        load = [Fraction(0)] * len(costs)
        proved = Fraction(sum(costs[a] for a in used))
        for cut, (weight,) in packing.weights:
            assert weight > 0
            proved += weight
            for action in crossing(cut.objects):
                load[action] += weight
        assert all(carried <= (0 if a in used else costs[a]) for a, carried in enumerate(load))
        if isinstance(proof, Dear):
            assert proof.actions
            assert all(math.ceil(proved + costs[a] - load[a]) >= total for a in proof.actions)
            others = without.union(proof.actions)
            assert not others & used
            require_proves(proof.others, graph, targets, costs, total, used, others)
        else:
            assert math.ceil(proved) >= total


class Run:
    """A search with no derivation in hand, for one that costs less than all actions and one more."""

    def __init__(self, graph: Hypergraph, targets: list[int], costs: list[int], effort: int = 10**6) -> None:
        self.trees: list[set[int]] = []
        self.bounds: list[int] = []
        self.question = graph, targets, costs
        self.total = sum(costs) + 1
        everything = range(len(costs))
        search = Branching(
            *(graph, targets, everything, costs.__getitem__, (), self.total),
            *(lambda shares, without: (), self.trees.append, self.bounds.append),
        )
        self.proof = search.proof() if search.search(effort, lambda: False) else None

    def require_right(self, best: int) -> None:
        graph, targets, costs = self.question
        before = self.total
        for tree in self.trees:
            cost = sum(costs[a] for a in tree)
            assert best <= cost < before
            reached = graph.reach(frozenset(range(len(costs))) - tree)
            assert all(reached[o] for o in targets)
            before = cost
        assert all(bound <= best for bound in self.bounds)
        assert self.bounds == sorted(set(self.bounds))
        if self.proof is not None:
            assert before == best
            require_proves(self.proof, graph, targets, costs, best)


def branches(proof: Proved | None) -> int:
    if isinstance(proof, Dear):
        return branches(proof.others)
    return 1 + branches(proof.without) + branches(proof.using) if isinstance(proof, Branch) else 0


def length(proof: Proved) -> int:
    """Give how many objects and members a proof names, and 5,000 for each set of weights."""
    if isinstance(proof, Branch):
        return length(proof.without) + length(proof.using)
    if isinstance(proof, Dear):
        return length(proof.packing) + length(proof.others)
    if isinstance(proof, Hopeless):
        return 0
    assert isinstance(proof, Packing)
    return 5000 + sum(len(cut.objects) + len(cut.members) for cut, _ in proof.weights)


def corners(size: int, price: int = 1) -> tuple[Hypergraph, list[int], list[int]]:
    """Give a question whose relaxation falls short: a goal for each two of some things, which one makes."""
    pairs = [(a, b) for a in range(size) for b in range(a)]
    needs: list[list[int]] = [[] for _ in range(size)]
    gives = [[1 + a] for a in range(size)]
    targets = []
    for goal, pair in enumerate(pairs, start=1 + size):
        targets.append(goal)
        for one in pair:
            needs.append([1 + one])
            gives.append([goal])
    graph = Hypergraph(1 + size + len(pairs), needs, gives, [0])
    return graph, targets, [price] * size + [1] * (len(needs) - size)


@pytest.mark.parametrize("price", [1, 3, 10**30])
def test_what_the_relaxation_leaves_open_is_closed_by_branching(price: int) -> None:
    run = Run(*corners(4, price))
    run.require_right(best=3 * price + 6)
    assert branches(run.proof) > 0
    assert run.proof is not None


@pytest.mark.parametrize("seed", range(6, 11))
def test_what_a_used_action_needs_is_asked_for_only_where_it_is_used(seed: int) -> None:
    """A way to make each thing takes what one of two other actions makes, so cuts before that are found."""
    size, rng = 5, random.Random(seed)
    plain, targets, _ = corners(size)
    of = plain.size  # what the making of the first thing takes
    needs = [[of + a] for a in range(size)] + [*plain.needs[size:]] + [[]] * (2 * size)
    gives = [*plain.gives, *([of + a // 2] for a in range(2 * size))]
    first = {o: (o + size) % (plain.size + size) for o in range(plain.size + size)}  # cuts are of these first
    graph = Hypergraph(
        len(first), [[first[o] for o in n] for n in needs], [[first[o] for o in g] for g in gives], [first[0]]
    )
    costs = [rng.randint(1, 3) for _ in needs]
    made = [
        costs[a] + min(costs[len(plain.needs) + 2 * a : len(plain.needs) + 2 * a + 2]) for a in range(size)
    ]
    pairs = [(a, b) for a in range(size) for b in range(a)]
    ways = {pair: costs[size + 2 * n : size + 2 * n + 2] for n, pair in enumerate(pairs)}
    best = min(
        sum(made[a] for a in things)
        + sum(min(w for a, w in zip(p, ways[p], strict=True) if a in things) for p in pairs)
        for things in (set(range(size)), *({*range(size)} - {a} for a in range(size)))
    )
    run = Run(graph, [first[o] for o in targets], costs)
    run.require_right(best)
    assert run.proof is not None


@pytest.mark.parametrize("seed", range(8))
def test_the_cheapest_derivation_is_found_and_proved(seed: int) -> None:
    question = asked(seed)
    run = Run(*question)
    run.require_right(cheapest(*question))
    assert run.proof is not None


def _garbage(seed: int, monkeypatch: pytest.MonkeyPatch, *, weights: bool) -> None:
    """Let HiGHS say anything of what is taken, and of weights."""
    drawn, told, solve = random.Random(seed), Covering.weights, Covering.solve

    def taken(self: Covering, expired: Callable[[], bool] = lambda: False) -> Relaxed:
        relaxed = solve(self, expired)
        return relaxed._replace(
            value=drawn.uniform(-9, 9), x=[drawn.choice([0, 0.5, 1, 7, math.nan, x]) for x in relaxed.x]
        )

    monkeypatch.setattr(Covering, "solve", taken)
    if weights:
        monkeypatch.setattr(
            Covering,
            "weights",
            lambda self: [drawn.choice([w, w, -1.0, math.inf, math.nan, 3.0, 1e300]) for w in told(self)],
        )


@pytest.mark.parametrize("weights", [False, True])
@pytest.mark.parametrize(
    "seed", [*range(3), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(3, 60))]
)
def test_floats_may_be_wrong_and_what_is_proved_is_not(
    seed: int, weights: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    question = asked(seed)
    _garbage(seed, monkeypatch, weights=weights)
    monkeypatch.setattr(branching, "_ROUNDS", seed % 3)
    run = Run(*question, effort=20_000)
    run.require_right(cheapest(*question))


@given(st.integers(2, 5), st.data())
@pytest.mark.slow
def test_any_prices(size: int, data: st.DataObject) -> None:
    graph, targets, costs = corners(size)
    costs = [data.draw(st.integers(1, 4)) for _ in costs[:size]] + costs[size:]
    run = Run(graph, targets, costs)
    total = min(sum(costs[:size]) - costs[left_out] + size * (size - 1) // 2 for left_out in range(size))
    run.require_right(total)
    assert run.proof is not None


@pytest.mark.parametrize("effort", [0, 1, 40, 80, 160, 320])
def test_an_effort_that_is_not_enough_leaves_a_bound(effort: int) -> None:
    Run(*corners(6), effort=effort).require_right(best=5 + 15)


@pytest.mark.parametrize("asks", [0, 1, 2, 4, 8, 16, 1000])
def test_time_that_is_up_leaves_a_bound_and_the_best_derivation(asks: int) -> None:
    graph, targets, costs = corners(4)
    left = iter(range(asks))
    trees: list[set[int]] = []
    bounds: list[int] = []
    search = Branching(
        *(graph, targets, range(len(costs)), costs.__getitem__, (), sum(costs)),
        *(lambda shares, without: (), trees.append, bounds.append),
    )
    assert search.search(10**6, lambda: next(left, None) is None) == (asks == 1000)
    assert all(bound <= 3 + 6 for bound in bounds)
    assert all(sum(costs[a] for a in tree) >= 3 + 6 for tree in trees)


def test_guessed_derivations_count_and_those_of_other_actions_do_not() -> None:
    graph, targets, costs = corners(4)
    best = {1, 2, 3, *range(4, 4 + 12, 2)}
    heard: list[set[int]] = []
    calls: list[frozenset[int]] = []

    def guess(shares: Mapping[int, float], without: Collection[int]) -> list[set[int]]:
        assert shares.keys() == set(range(len(costs)))
        calls.append(frozenset(without))
        reached = graph.reach(frozenset(range(len(costs))) - best)
        return [{99}, best, {*shares} - {3}] if all(reached[o] for o in targets) else [{99}]

    search = Branching(
        *(graph, targets, range(len(costs)), costs.__getitem__, (), sum(costs)),
        *(guess, heard.append, lambda bound: None),
    )
    assert search.search(10**6, lambda: False)
    assert calls[0] == frozenset()
    assert heard
    assert {99} not in heard
    again = Branching(
        *(graph, targets, range(len(costs)), costs.__getitem__, (), sum(costs)),
        *(guess, heard.append, lambda bound: None),
    )
    heard.clear()
    again._guessed(numpy.zeros(len(costs)), _Place(frozenset(), frozenset(), 0, []))
    assert heard == [best]  # what came after costs more


def test_a_place_that_reaches_no_target_is_closed_by_a_cut_that_nothing_crosses() -> None:
    graph, targets, costs = corners(3)
    search = Branching(
        *(graph, targets, range(len(costs)), costs.__getitem__, (), sum(costs)),
        *(lambda shares, without: (), lambda tree: None, lambda bound: None),
    )
    search.effort = 10**6
    makers = frozenset(search._graph.makers[search._targets[0]])
    place = _Place(frozenset(), makers, 0, [])
    assert search._solve(place, 1, lambda: False)
    proof, barred = search._proof(place)
    assert isinstance(proof, Hopeless)
    assert barred == makers


class Noted(Branching):
    """Notes how searches ended."""

    ended: ClassVar[list[bool]] = []

    def search(self, effort: int, expired: Callable[[], bool]) -> bool:
        self.ended.append(super().search(effort, expired))
        return self.ended[-1]


@pytest.fixture
def ended(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """Leave all to branching, with a tree that may be bad and no cuts, and tell how that ends."""
    monkeypatch.setattr(reduction, "_SMALL", 0)
    monkeypatch.setattr(reduction, "_NEAR", (1, 0))
    monkeypatch.setattr(reduction, "landmark_cuts", lambda *_: Cuts(0, {}, []))
    monkeypatch.setattr(reduction, "improved", lambda graph, few, tree, *_: tree)
    monkeypatch.setattr(reduction, "guessed", lambda *_: ())
    monkeypatch.setattr(reduction._Reducer, "_share_costs", lambda self, costs: False)
    monkeypatch.setattr(branching, "Branching", Noted)
    Noted.ended.clear()
    return Noted.ended


@pytest.mark.slow
@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", range(25))
def test_answers_are_those_of_the_plain_program(seed: int, rule: ContainerRule, ended: list[bool]) -> None:
    problem = random_problem(seed, rule, units=14)
    by = [(Objective.UNITS,), (Objective.PRICE,), (Objective.INPUTS, Objective.PRICE), (Objective.KITCHEN,)]
    objectives = by[seed % 4]
    plain = solve(problem, objectives, Settings(reductions=NONE))
    for reductions in (ALL, frozenset({Reduction.BOUNDS})):
        outcome = solve(problem, objectives, Settings(reductions=reductions))
        assert outcome.status is plain.status
        if plain.costs is not None and outcome.costs is not None and outcome.units is not None:
            assert outcome.costs.key(levels(objectives)) == plain.costs.key(levels(objectives)), reductions
            if ended:
                assert ended[-1]
                assert outcome.proof is Proof.CUTS
                by_cases = certify(problem, levels(objectives), outcome.units, cases=outcome.cases)
                assert by_cases is not None
                assert by_cases.certified == levels(objectives)


@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.KITCHEN])
def test_a_certificate_tells_the_cases_of_the_search_apart(objective: Objective, ended: list[bool]) -> None:
    """Also where an item is taken or not, which has other numbers in a certificate."""
    told: set[str] = set()
    for seed in range(4):
        problem = gap_problem(seed)
        outcome = solve(problem, (objective,), Settings())
        assert outcome.units is not None
        certificate = certify(problem, levels((objective,)), outcome.units, cases=outcome.cases)
        assert certificate is not None
        assert certificate.certified == levels((objective,))
        if outcome.cases is not None:
            action, units = outcome.cases[0], len(problem.network)
            assert certificate.content["proof"]["branch"] == (
                {"unit": action} if action < units else {"item": action - units}
            )
            told.update(certificate.content["proof"]["branch"])
    assert all(ended)
    assert told == ({"unit"} if objective is Objective.UNITS else {"item"})


@pytest.mark.slow
@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.PRICE, Objective.SUCCESS])
def test_some_questions_are_branched_and_those_with_rounded_rates_are_not(
    objective: Objective, ended: list[bool]
) -> None:
    for seed in range(10):
        solve(random_problem(seed, ContainerRule.STRICT, units=14), (objective,), Settings())
    assert bool(ended) == (objective is not Objective.SUCCESS)
    assert all(ended)


def test_what_is_as_good_is_not_branched_away(ended: list[bool]) -> None:
    for seed in range(10):
        reduce(random_problem(seed, ContainerRule.STRICT, units=14), levels((Objective.UNITS,)), SAFE)
    assert not ended


def test_what_branching_proves_is_told(ended: list[bool]) -> None:
    told: list[object] = []

    class Listening(Reporter):
        def bound(self, objective: Objective, value: object) -> None:
            told.append((objective, value))

    outcome = solve(gap_problem(0), (Objective.UNITS,), Settings(), Listening())
    assert outcome.costs is not None
    assert ended == [True]
    assert told[-1] == (Objective.UNITS, outcome.costs.units)


def test_a_proof_alone_is_of_a_total_that_no_derivation_is_below(monkeypatch: pytest.MonkeyPatch) -> None:
    for size, best in ((4, 3 + 6), (5, 4 + 10)):
        graph, targets, costs = corners(size)
        everything = range(len(costs))

        def proved(total: int, late: bool = False) -> Proved | None:
            return branched(
                *(graph, targets, everything, costs.__getitem__, [{targets[0]}], total),  # noqa: B023
                lambda: late,
            )

        proof = proved(best)
        assert proof is not None
        require_proves(proof, graph, targets, costs, best)
        names = length(proof)
        assert names > 10_000
        assert proved(best + 1) is None
        assert proved(best, late=True) is None
        for most, enough in ((names, True), (names - 1, False)):
            with monkeypatch.context() as patched:
                patched.setattr(branching, "_LENGTH", most)
                assert (proved(best) is not None) == enough


@pytest.mark.parametrize("prices", [[2] * 20, [0, *[1] * 19]])
def test_costs_that_no_rounding_brings_to_the_total_are_not_proved(prices: list[int]) -> None:
    graph, targets, costs = corners(3)
    some = prices[: len(costs)]
    assert branched(graph, targets, range(len(costs)), some.__getitem__, (), 5, lambda: False) is None


def test_no_more_is_written_of_a_proof_when_time_is_up() -> None:
    graph, targets, costs = corners(4)
    search = Branching(
        *(graph, targets, range(len(costs)), costs.__getitem__, (), 3 + 6),
        *(lambda shares, without: (), lambda tree: None, lambda bound: None),
    )
    assert search.search(10**6, lambda: False)
    assert isinstance(search.proof(), Branch)
    with pytest.raises(TooLongError):
        search.proof(expired=lambda: True)


@pytest.mark.parametrize(("objective", "twice"), [(Objective.INPUTS, 0), (Objective.PRICE, 1)])
def test_what_is_too_dear_is_left_out_of_certificates_by_one_set_of_weights(
    objective: Objective, twice: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Greedy weights leave out what they can, those of the relaxation more, and the search does the rest."""
    monkeypatch.setattr(lower_bound, "_MANY", 0)
    monkeypatch.setattr(lower_bound, "_WORTH", 0.0)
    by, nested, dear, proved = (objective,), 0, 0, 0
    for seed in range(50, 80):
        problem = random_problem(seed, ContainerRule.STRICT, units=30)
        outcome = solve(problem, by, Settings(reductions=NONE))
        if outcome.units is None:
            continue
        found = certify(problem, by, outcome.units)
        assert found is not None
        assert found.claim == "optimal"
        proved += 1
        content = found.content
        verify_again(content, problem)
        proof = content["proof"]
        dear += "dear" in proof
        nested += json.dumps(proof).count('"dear"') > 1
        if "dear" in proof:
            with pytest.raises(RefusedError):
                verify_again({**content, "proof": {**proof, "others": {"weights": []}}}, problem)
    assert proved > 15
    assert dear > 5
    assert nested == twice


def verify_again(content: dict[str, Any], problem: Problem) -> None:
    sealed = {**content, "seal": seal(content)}
    verify(*(sealed, problem.network, problem.kitchen, problem.rates, problem.utensils), problem.unit_prices)


@pytest.mark.parametrize("seed", range(30))
def test_certificates_of_many_actions_branch_as_the_search_does(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing but the search is able to branch here."""
    monkeypatch.setattr(lower_bound, "_MANY", 0)
    monkeypatch.setattr(Prover, "_branch", lambda *_: pytest.fail("the search was not tried"))
    monkeypatch.setattr(lower_bound, "share_costs", lambda *_, often: None)
    problem = gap_problem(0, 7, 1.0) if seed == 0 else random_problem(seed, ContainerRule.STRICT, units=20)
    by = levels((Objective.UNITS,))
    outcome = solve(problem, by, Settings(reductions=NONE))
    if outcome.units is not None:
        certificate = certify(problem, by, outcome.units)
        assert certificate is not None
        verify(
            *(certificate.content, problem.network, problem.kitchen, problem.rates, problem.utensils),
            problem.unit_prices,
        )
        assert (seed != 0) or "branch" in certificate.content["proof"]
