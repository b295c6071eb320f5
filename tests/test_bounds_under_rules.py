"""Proofs where so much of something may be used at most, and under rules: against every derivation."""

import math
import random
from collections import Counter
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

import pytest

from foon_asp.bounds.cut import Cut
from foon_asp.bounds.exact_optimum import Limit
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
    _Node,
)

COUNT = Lexicographic([None])
NOBODY: frozenset[int] = frozenset()


class NotAll(NamedTuple):
    """Rules that no derivation has all actions of a set; every other is only known once all are used.

    Or those that a derivation breaks are limits from then on, which are ``learnt``.
    """

    sets: Sequence[frozenset[int]]
    learnt: list[Limit] | None = None

    def bars(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        found: dict[int, frozenset[int]] = {}
        if self.learnt is not None:
            return found
        for rule, each in enumerate(self.sets):
            if each <= used:
                found[rule] = each
            elif rule % 2 and len(each - used) == 1 and each.isdisjoint(without):
                found[rule] = each - used
        return found

    def breaking(self, derivation: frozenset[int]) -> Sequence[int]:
        broken = (sorted(each) for each in self.sets if each <= derivation and self.learnt is None)
        return next(broken, [])

    def exceeded(self, derivation: frozenset[int]) -> Limit | None:
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
        at_hand, left = set(self.graph.start), set(actions)
        while ready := {a for a in left if at_hand.issuperset(self.graph.needs[a])}:
            left -= ready
            at_hand.update(o for a in ready for o in self.graph.gives[a])
        return (
            not left
            and at_hand.issuperset(self.targets)
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


def hold(case: Case, proof: Proof, goal: Fraction | None, met: Counter[str]) -> None:
    """Hold each leaf of a proof against what it says, with nothing of what found it."""

    def leaf(proof: Proof, used: frozenset[int], without: frozenset[int]) -> None:
        if isinstance(proof, Branch):
            assert proof.action not in used | without
            leaf(proof.without, used, without | {proof.action})
            leaf(proof.using, used | {proof.action}, without)
            return
        met[type(proof).__name__] += 1
        bars = case.rules.bars(used, without)
        if isinstance(proof, Broken):
            assert not used.isdisjoint(bars[proof.rule])
            return
        assert not isinstance(proof, Dear)  # under rules, nothing is left out as too dear
        gone = without.union(*bars.values())
        wanted = {*case.targets, *(o for a in used for o in case.graph.needs[a])}
        cuts = [proof.cut] if isinstance(proof, Hopeless) else [cut for cut, _ in proof.weights]
        for cut in cuts:
            zone = set(cut.objects)
            assert zone & wanted
            assert not zone & set(case.graph.start)
            makers = {
                a
                for a in range(len(case.costs))
                if zone & set(case.graph.gives[a]) and not zone & set(case.graph.needs[a])
            }
            assert makers - gone <= set(cut.members)
        if isinstance(proof, Hopeless):
            assert set(proof.cut.members) <= gone
            return
        met["limits"] += bool(proof.limits)
        total = sum((case.costs[a][0] if goal is not None else Fraction(0) for a in used), Fraction(0))
        carried: Counter[int] = Counter()
        for row, (weight,) in proof.limits:
            amounts, most = [*case.limits, *(case.rules.learnt or [])][row]
            met["learnt"] += row >= len(case.limits)
            assert weight > 0
            total -= weight * (most - sum(amounts.get(a, 0) for a in used))
            for a, amount in amounts.items():
                carried[a] += weight * amount  # type: ignore[assignment]
        for cut, (weight,) in proof.weights:
            assert weight > 0
            total += weight
            for a in cut.members:
                carried[a] -= weight  # type: ignore[assignment]
        for a, rest in carried.items():
            cost = 0 if a in used or goal is None else case.costs[a][0]
            assert a in gone or (a in used and rest >= 0) or cost + rest >= 0
        rounded = isinstance(proof, Packing) and proof.rounded is not None
        met["rounded"] += rounded
        assert not rounded or {*case.multiples} == {1}
        assert total > 0 if goal is None else (math.ceil(total) if rounded else total) >= goal

    leaf(proof, NOBODY, NOBODY)


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
            hold(case, none, None, met)
            continue
        best = min(found, key=case.cost)
        proof = case.prover().prove(best)
        assert proof is not None, seed
        hold(case, proof, case.cost(best), met)
        relaxed = case.prover().relax(best)
        if relaxed is not None:
            packing, (value,) = relaxed
            hold(case, packing, value, met)
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
    hold(case, proof, Fraction(3), Counter())


def test_to_go_beyond_a_limit_costs_more_than_the_derivation_in_hand() -> None:
    spent = {0: Fraction(2)}, Fraction(0)
    dear = [(Fraction(1),), (Fraction(10),)]
    case = Case(Hypergraph(2, [[], []], [[1], [1]], [0]), [1], dear, [spent], NotAll([]))
    proof = case.prover().prove([1])
    assert isinstance(proof, Packing)
    hold(case, proof, Fraction(10), Counter())


def test_what_is_taken_in_part_only_is_no_derivation(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = _Node.taken

    def instead(node: _Node) -> list[int]:
        assert node.undecided() is None
        return taken(node)

    monkeypatch.setattr(_Node, "taken", instead)
    # each of three actions makes two of three targets: a half of each is none
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    case = Case(graph, [1, 2, 3], [(Fraction(1),)] * 3, [], NotAll([frozenset({0, 1})], []))
    assert isinstance(case.prover().prove([0, 2]), Branch)


def test_a_limit_that_leaves_nothing_is_proved_without_branching() -> None:
    half = {0: Fraction(2)}, Fraction(1)
    case = Case(Hypergraph(2, [[]], [[1]], [0]), [1], [(Fraction(1),)], [half], NotAll([]))
    # to go beyond the limit costs 1, which is what the landmark weighs more than it may take of it
    weight, limit = ((Fraction(2),), (Fraction(1),))
    assert case.prover(free=True).prove_none() == Packing(((Cut((1,), (0,)), weight),), ((0, limit),))
