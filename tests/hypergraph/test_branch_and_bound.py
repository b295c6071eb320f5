"""Branching over cuts: what it proves is held against brute force, whatever floats say."""

import math
import random
from collections.abc import Callable, Collection, Mapping
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.asp import Proof, Reporter, Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.hypergraph import (
    ALL,
    NONE,
    SAFE,
    Reduction,
    greedy_stages,
    reduce,
    relaxation_stages,
    tuning,
)
from foon_asp.hypergraph.branch_and_bound import Branching, TooLongError, prove_by_branching
from foon_asp.hypergraph.covering import BasicSolution, Covering
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.proof_tree import Branch
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.verifier import verify
from tests.hypergraph.small_graphs import asked, cheapest, parts, reaches, require_proves
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import random_problem

Question = tuple[Hypergraph, list[int], list[int]]


class Run:
    """A search with no derivation in hand, for one that costs less than all actions and one more."""

    def __init__(self, question: Question, guess: Any = lambda lp_values, without: ()) -> None:
        graph, targets, costs = self.question = question
        self.trees: list[set[int]] = []
        self.bounds: list[int] = []
        self.total = sum(costs) + 1
        self.search = Branching(graph, targets, range(len(costs)), costs.__getitem__, (), self.total, guess)

    def require_right(
        self, best: int, effort: int = 10**6, expired: Callable[[], bool] = lambda: False
    ) -> bool:
        """Search, and hold all that is heard against what the cheapest costs; whether that is proved."""
        search = self.search
        for _ in search.search(effort, expired):
            if search.incumbent is not None and (not self.trees or self.trees[-1] != search.incumbent):
                self.trees.append(set(search.incumbent))
            if not self.bounds or self.bounds[-1] != search.bound:
                self.bounds.append(search.bound)
        ended = search.closed
        graph, targets, costs = self.question
        before = self.total
        for tree in self.trees:
            cost = sum(costs[a] for a in tree)
            assert best <= cost < before
            assert reaches(graph, tree, targets)
            before = cost
        assert all(bound <= best for bound in self.bounds)
        assert self.bounds == sorted(set(self.bounds))
        if ended:
            assert before == best
            require_proves(self.search.proof(), graph, targets, costs, best, whole=True)
        return ended


def corners(size: int, price: int = 1) -> Question:
    """Return a question whose relaxation falls short: a goal for each two of some things, which one makes."""
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
    run = Run(corners(4, price))
    assert run.require_right(best=3 * price + 6)
    assert any(isinstance(part, Branch) for part in parts(run.search.proof()))
    assert run.search.cases() is not None
    small = Run(corners(3))
    assert small.require_right(best=2 + 3)
    assert small.bounds[-1] == 5  # the relaxation comes to 9/2


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
    assert Run((graph, [first[o] for o in targets], costs)).require_right(best)


@pytest.mark.parametrize("seed", range(12))
def test_the_cheapest_derivation_is_found_and_proved(seed: int) -> None:
    question = asked(seed, (1, 1, 2, 10**12) if seed % 2 else (2, 4, 6))
    assert Run(question).require_right(cheapest(*question))


@pytest.mark.parametrize("weights", [False, True])
@pytest.mark.parametrize(
    "seed", [*range(6), *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(6, 30))]
)
def test_floats_may_be_wrong_and_what_is_proved_is_not(
    seed: int, weights: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """HiGHS says anything of what is taken, and of weights."""
    question = asked(seed)
    drawn, told, solve = random.Random(seed), Covering.duals, Covering.solve

    def taken(self: Covering, expired: Callable[[], bool] = lambda: False) -> BasicSolution:
        relaxed = solve(self, expired)
        x = [drawn.choice([0, 0.5, 1, 7, math.nan, x]) for x in relaxed.x]
        return relaxed._replace(value=drawn.uniform(-9, 9), x=x)

    monkeypatch.setattr(Covering, "solve", taken)
    if weights:
        monkeypatch.setattr(
            Covering,
            "duals",
            lambda self: [drawn.choice([w, w, -1.0, math.inf, math.nan, 3.0, 1e300]) for w in told(self)],
        )
    Run(question).require_right(cheapest(*question), effort=20_000)


@given(st.integers(2, 5), st.data())
@pytest.mark.slow
def test_any_prices(size: int, data: st.DataObject) -> None:
    graph, targets, costs = corners(size)
    costs = [data.draw(st.integers(1, 4)) for _ in costs[:size]] + costs[size:]
    total = min(sum(costs[:size]) - costs[left_out] + size * (size - 1) // 2 for left_out in range(size))
    assert Run((graph, targets, costs)).require_right(total)


@pytest.mark.parametrize("effort", [0, 1, 40, 80, 160, 320])
def test_an_effort_that_is_not_enough_leaves_a_bound(effort: int) -> None:
    assert not Run(corners(6)).require_right(5 + 15, effort)


@pytest.mark.parametrize("asks", [0, 1, 2, 4, 8, 16, 1000])
def test_time_that_is_up_leaves_a_bound_and_the_best_derivation(asks: int) -> None:
    left = iter(range(asks))
    run = Run(corners(4))
    assert run.require_right(3 + 6, expired=lambda: next(left, None) is None) == (asks == 1000)
    if asks == 1000:
        with pytest.raises(TooLongError):
            run.search.proof(expired=lambda: True)
        with pytest.raises(TooLongError):
            run.search.proof(10_000)


@pytest.mark.parametrize("size", [3, 4])  # a guess at once is the best, or is one of many
def test_guessed_derivations_count_and_those_of_other_actions_do_not(size: int) -> None:
    graph, targets, costs = corners(size)
    best = {*range(1, size), *range(size, len(costs), 2)}
    barred: list[Collection[int]] = []

    def guess(lp_values: Mapping[int, float], without: Collection[int]) -> list[set[int]]:
        assert lp_values.keys() == set(range(len(costs)))
        barred.append(without)
        tree = best if reaches(graph, best, targets) else set()
        return [{99}, tree, {*lp_values} - {3}]  # what comes after costs more

    run = Run((graph, targets, costs), guess)
    assert run.require_right(sum(costs[a] for a in best))
    assert best in run.trees
    assert not barred[0]


# --- In the course of a question.


@pytest.fixture
def searching(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave small questions to branching, too."""
    monkeypatch.setattr(tuning, "PRESOLVE", PresolveTuning(relaxed_actions=0))


@pytest.mark.slow
@pytest.mark.usefixtures("searching")
@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", range(16))
def test_answers_are_those_of_the_plain_program(
    seed: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a tree that may be bad."""
    monkeypatch.setattr(greedy_stages, "improve_locally", lambda graph, few, tree, *_: tree)
    monkeypatch.setattr(relaxation_stages, "trees_by_lp_values", lambda *_: ())
    problem = random_problem(seed, rule, units=14)
    by = [(Objective.UNITS,), (Objective.PRICE,), (Objective.INPUTS, Objective.PRICE), (Objective.KITCHEN,)]
    objectives = by[seed % 4]
    plain = solve(problem, objectives, Settings(reductions=NONE))
    for reductions in (ALL, frozenset({Reduction.BOUNDS})):
        outcome = solve(problem, objectives, Settings(reductions=reductions))
        assert outcome.status is plain.status
        if plain.costs is not None and outcome.costs is not None and outcome.units is not None:
            assert outcome.costs.key(levels(objectives)) == plain.costs.key(levels(objectives)), reductions
            by_cases = certify(problem, levels(objectives), outcome.units, cases=outcome.cases)
            assert by_cases is not None
            assert by_cases.certified == levels(objectives)


@pytest.mark.usefixtures("searching")
@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.KITCHEN])
def test_a_certificate_tells_the_cases_of_the_search_apart(objective: Objective) -> None:
    """Also where an item is taken or not, which has other numbers in a certificate."""
    told: set[str] = set()
    heard: list[object] = []

    class Listening(Reporter):
        def bound(self, objective: Objective, value: object) -> None:
            heard.append((objective, value))

    for seed in range(3):
        problem = gap_problem(seed, density=1.0)
        outcome = solve(problem, (objective,), Settings(), Listening())
        assert outcome.units is not None
        assert outcome.costs is not None
        assert outcome.proof is Proof.CUTS
        assert heard[-1] == (objective, getattr(outcome.costs, objective))
        certificate = certify(problem, levels((objective,)), outcome.units, cases=outcome.cases)
        assert certificate is not None
        assert certificate.certified == levels((objective,))
        if outcome.cases is not None:
            action, units = outcome.cases[0], len(problem.network)
            branch = certificate.content["proof"]["branch"]
            assert branch == ({"unit": action} if action < units else {"item": action - units})
            told.update(branch)
    assert ("unit" if objective is Objective.UNITS else "item") in told


@pytest.mark.usefixtures("searching")
@pytest.mark.parametrize(("objective", "how"), [(Objective.UNITS, SAFE), (Objective.SUCCESS, ALL)])
def test_what_is_as_good_is_not_branched_away_nor_what_rounding_may_decide(
    objective: Objective, how: frozenset[Reduction]
) -> None:
    for seed in range(3):
        found = reduce(gap_problem(seed), levels((objective,)), how)
        assert not found.settled
        assert found.cases is None


# --- Proofs of certificates.


def test_a_proof_alone_is_of_a_total_that_no_derivation_is_below() -> None:
    for size, best in ((4, 3 + 6), (5, 4 + 10)):
        graph, targets, costs = corners(size)
        question = graph, targets, range(len(costs)), costs.__getitem__, [{targets[0]}]
        proof = prove_by_branching(*question, best, lambda: False)
        assert proof is not None
        require_proves(proof, graph, targets, costs, best, whole=True)
        assert prove_by_branching(*question, best + 1, lambda: False) is None
        assert prove_by_branching(*question, best, lambda: True) is None


@pytest.mark.parametrize("prices", [[2] * 20, [0, *[1] * 19]])
def test_costs_that_no_rounding_brings_to_the_total_are_not_proved(prices: list[int]) -> None:
    graph, targets, costs = corners(3)
    some = prices[: len(costs)]
    assert (
        prove_by_branching(graph, targets, range(len(costs)), some.__getitem__, (), 5, lambda: False) is None
    )


def test_a_proof_that_names_too_much_is_not_given(monkeypatch: pytest.MonkeyPatch) -> None:
    graph, targets, costs = corners(4)
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(proof_length=10_000))
    assert (
        prove_by_branching(graph, targets, range(len(costs)), costs.__getitem__, (), 9, lambda: False) is None
    )


def verify_again(content: dict[str, Any], problem: Problem) -> None:
    sealed = {**content, "seal": seal(content)}
    verify(sealed, subject_of(problem))


@pytest.mark.parametrize("worth", [0.0, 1.0])
@pytest.mark.parametrize("objective", [Objective.INPUTS, Objective.PRICE])
def test_certificates_of_many_actions_verify(
    objective: Objective, worth: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Greedy weights leave out what is too dear, those of the relaxation more, and the search the rest."""
    monkeypatch.setattr(tuning, "PROOF", tuning.ProofTuning(rounded_actions=0, fixed_share=worth))
    by, told, proved = (objective,), list[str](), 0
    problems = [gap_problem(0), *(random_problem(n, ContainerRule.STRICT, units=30) for n in range(50, 66))]
    for problem in problems:
        outcome = solve(problem, by, Settings(reductions=NONE))
        if outcome.status is not Status.OPTIMAL:
            continue
        assert outcome.units is not None
        found = certify(problem, by, outcome.units)
        assert found is not None
        assert found.claim == "optimal"
        proved += 1
        content = found.content
        verify_again(content, problem)
        proof = content["proof"]
        told += proof
        if "dear" in proof:
            with pytest.raises(RefusedError):
                verify_again({**content, "proof": {**proof, "others": {"weights": []}}}, problem)
    assert proved > 8
    assert "weights" in told
    assert worth or "dear" in told
