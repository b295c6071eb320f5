"""Proofs where so much of something may be used at most, and under rules: against every derivation."""

import random
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

import pytest

from foon_asp.hypergraph.cut import Cut
from foon_asp.hypergraph.exact_optimum import Limit
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.lexicographic import Lexicographic
from foon_asp.hypergraph.optimality_proof import CheaperError, Prover
from foon_asp.hypergraph.proof_tree import Branch, Broken, Packing, Proof
from tests.hypergraph.small_graphs import NOBODY, parts, reaches, require_proves

COUNT = Lexicographic([None])


class NotAll(NamedTuple):
    """Rules that no derivation has all actions of a set; every other is only known once all are used.

    Or those that a derivation breaks are limits from then on, which are ``learnt``.
    """

    sets: Sequence[frozenset[int]]
    learnt: list[Limit] | None = None

    def barred_actions(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        found: dict[int, frozenset[int]] = {}
        if self.learnt is not None:
            return found
        for rule, each in enumerate(self.sets):
            if each <= used:
                found[rule] = each
            elif rule % 2 and len(each - used) == 1 and each.isdisjoint(without):
                found[rule] = each - used
        return found

    def breaking_actions(self, derivation: frozenset[int]) -> Sequence[int]:
        broken = (sorted(each) for each in self.sets if each <= derivation and self.learnt is None)
        return next(broken, [])

    def exceeded_limit(self, derivation: frozenset[int]) -> Limit | None:
        for each in self.sets:
            if each <= derivation and self.learnt is not None:
                self.learnt.append((dict.fromkeys(each, Fraction(1)), Fraction(len(each) - 1)))
                return self.learnt[-1]
        return None


class Case(NamedTuple):
    graph: Hypergraph
    targets: list[int]
    costs: list[tuple[Fraction]]
    limits: list[Limit]
    rules: NotAll
    multiples: Sequence[Fraction] = ()

    def prover(self, free: bool = False) -> Prover:
        costs = [(Fraction(0),)] * len(self.costs) if free else self.costs
        more = {"limits": self.limits, "rules": self.rules, "multiples": self.multiples}
        if self.rules.learnt:
            self.rules.learnt.clear()
        return Prover(self.graph, self.targets, costs, COUNT, NOBODY, **more)  # type: ignore[arg-type]

    def holds(self, actions: frozenset[int]) -> bool:
        wanted = {*self.targets, *(o for a in actions for o in self.graph.needs[a])}
        return (
            reaches(self.graph, actions, wanted)
            and all(sum(amounts.get(a, 0) for a in actions) <= most for amounts, most in self.limits)
            and not any(each <= actions for each in self.rules.sets)
        )

    def cost(self, actions: frozenset[int]) -> Fraction:
        return sum((self.costs[a][0] for a in actions), Fraction(0))


def drawn(seed: int) -> Case:
    """Draw a case; in every other, each action makes two of the targets, which leaves gaps to be closed."""
    choose = random.Random(seed)
    size, count = choose.randint(3, 5), choose.randint(6, 8)
    gaps = seed % 2
    limits: list[Limit] = [
        (
            {a: Fraction(choose.choice((1, 1, 2, 3)), 2) for a in range(count) if choose.random() < 0.6},
            Fraction(choose.randint(1, 5), 2),
        )
        for _ in range(choose.choice((0, 1, 2)))
    ]
    sets = [frozenset(choose.sample(range(count), choose.choice((1, 2, 2)))) for _ in range(4)]
    return Case(
        Hypergraph(
            size,
            [choose.sample(range(size), 0 if gaps else choose.choice((0, 1, 2))) for _ in range(count)],
            [choose.sample(range(size), 2 if gaps else choose.choice((1, 2))) for _ in range(count)],
            choose.sample(range(size), choose.choice((0, 0, 1))),
        ),
        choose.sample(range(size), size if gaps else choose.choice((1, 2))),
        [(Fraction(choose.randint(1, 2 if gaps else 4)),) for _ in range(count)],
        limits,
        NotAll(sets[: choose.randint(0, 4)], [] if seed % 3 == 2 else None),
        [Fraction(seed % 4 > 1)],
    )


def hold(case: Case, proof: Proof, least: Fraction | None) -> Counter[str]:
    """Hold a proof against what it says; return how often it has parts of each kind."""
    limits = [*case.limits, *(case.rules.learnt or [])]
    met = Counter(type(part).__name__ for part in parts(proof))
    packings = [part for part in parts(proof) if isinstance(part, Packing)]
    rows = [row for packing in packings for row, _ in packing.limits]
    met["limits"] = len(rows)
    met["learnt"] = sum(row >= len(case.limits) for row in rows)
    met["rounded"] = sum(packing.rounded is not None for packing in packings)
    assert not met["rounded"] or {*case.multiples} == {1}
    require_proves(
        proof, case.graph, case.targets, [cost for (cost,) in case.costs], least, limits, case.rules
    )
    return met


@pytest.mark.parametrize("part", range(4))
def test_what_is_proved_is_true_of_every_derivation(part: int) -> None:
    met: Counter[str] = Counter()
    for seed in range(30 * part, 30 * part + 30):
        case = drawn(seed)
        actions = range(len(case.costs))
        every = [frozenset(c) for size in range(len(actions) + 1) for c in combinations(actions, size)]
        found = [each for each in every if case.holds(each)]
        none = case.prover(free=True).prove_none()
        assert (none is None) == bool(found), seed
        if none is not None:
            met["none"] += 1
            met += hold(case, none, None)
            continue
        best = min(found, key=case.cost)
        proof = case.prover().prove(best)
        assert proof is not None, seed
        met += hold(case, proof, case.cost(best))
        relaxed = case.prover().relax(best)
        if relaxed is not None:
            packing, (value,) = relaxed
            met += hold(case, packing, value)
            assert value <= case.cost(best)
        worst = max(found, key=case.cost)
        if case.cost(worst) > case.cost(best):
            with pytest.raises(CheaperError) as error:
                case.prover().prove(worst)
            cheaper = frozenset(error.value.actions)
            assert case.holds(cheaper)
            assert case.cost(cheaper) < case.cost(worst)
            met["cheaper"] += 1
    assert met.keys() >= {"Packing", "Hopeless", "Broken", "limits", "none", "cheaper"}
    assert met["learnt"] > 0
    assert met["rounded"] > 0


def test_what_is_used_is_not_asked_about_again() -> None:
    # the cheapest two make a target each, and only once both are used is it known that this breaks a rule
    case = Case(
        Hypergraph(3, [[], [], []], [[1], [2], [1, 2]], [0]),
        [1, 2],
        [(Fraction(1),), (Fraction(1),), (Fraction(3),)],
        [({2: Fraction(1)}, Fraction(1))],
        NotAll([frozenset({0, 1})]),
    )
    proof = case.prover().prove([2])
    assert isinstance(proof, Branch)
    assert isinstance(proof.using, Branch)
    assert (proof.action, proof.using.action, proof.using.using) == (0, 1, Broken(0))
    hold(case, proof, Fraction(3))


def test_to_go_beyond_a_limit_costs_more_than_the_derivation_in_hand() -> None:
    spent = {0: Fraction(2)}, Fraction(0)
    dear = [(Fraction(1),), (Fraction(10),)]
    case = Case(Hypergraph(2, [[], []], [[1], [1]], [0]), [1], dear, [spent], NotAll([]))
    proof = case.prover().prove([1])
    assert isinstance(proof, Packing)
    hold(case, proof, Fraction(10))


def test_a_limit_that_leaves_nothing_is_proved_without_branching() -> None:
    half = {0: Fraction(2)}, Fraction(1)
    case = Case(Hypergraph(2, [[]], [[1]], [0]), [1], [(Fraction(1),)], [half], NotAll([]))
    # to go beyond the limit costs 1, which is what the landmark weighs more than it may take of it
    weight, limit = ((Fraction(2),), (Fraction(1),))
    assert case.prover(free=True).prove_none() == Packing(((Cut((1,), (0,)), weight),), ((0, limit),))
