"""``alternatives --union``: the units of every tree and of some, held against brute force."""

import random
from fractions import Fraction

import pytest

import foon_asp
from foon_asp.problem import ContainerRule
from foon_asp.questions.unit_union import Membership, UnitUnion
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.questions.recipes import posed
from tests.questions.test_alternatives import choosing, drawn, key, minimal_trees

TWO_WAYS = posed(
    "egg; whole",
    "egg; fried",
    "egg; whole > egg; cracked",
    "egg; cracked > egg; fried",
    "egg; cracked > egg; poured",
    "egg; poured > egg; fried",
    "egg; whole > egg; boiled",
)


def of(found: UnitUnion, *memberships: Membership) -> set[int]:
    return {unit.id for unit in found.units if unit.trees in memberships and unit.id is not None}


def test_an_optimal_tree_that_is_alone_has_all_units_of_every_tree() -> None:
    found = foon_asp.unit_union(TWO_WAYS)
    assert found.complete
    assert (of(found, Membership.EVERY), of(found, Membership.NOT_EVERY)) == ({0, 1}, set())


def test_a_worse_tree_counts_within_a_gap() -> None:
    """Three units instead of two are 50 % more; boiling leads to no goal, so no tree needs it."""
    assert of(foon_asp.unit_union(TWO_WAYS, within=49), Membership.NOT_EVERY) == set()
    found = foon_asp.unit_union(TWO_WAYS, within=50)
    assert (of(found, Membership.EVERY), of(found, Membership.NOT_EVERY)) == ({0}, {1, 2, 3})


def test_without_a_tree_it_is_proved_that_there_is_none(cli: Cli) -> None:
    problem = posed("egg; whole", "egg; fried", "egg; cracked > egg; fried", "egg; whole > egg; boiled")
    assert foon_asp.unit_union(problem).complete
    assert cli("alternatives", "--goal", "ice", "--union", "--rule", ":- goal(_).").code == 1


def test_what_union_does_not_list_is_refused(cli: Cli) -> None:
    for words in (("--best", "2"), ("--within", "10", "--rule", ':- use(U), motion(U,"crush").')):
        ran = cli("alternatives", "--goal", "ice", "--union", *words)
        assert (ran.code, ran.err.count("--union")) == (2, 1)


def test_a_limit_leaves_units_undecided(cli: Cli) -> None:
    ran = cli("alternatives", "--goal", "macaroni", "--union", "--time-limit", "0")
    assert ran.code == 3


@pytest.mark.parametrize("rule", list(ContainerRule))
@pytest.mark.parametrize(
    "seeds", [range(7100, 7104), pytest.param(range(7104, 7150), marks=pytest.mark.slow)]
)
def test_union_and_intersection_against_brute_force(rule: ContainerRule, seeds: range) -> None:
    several = 0
    for seed in seeds:
        problem, objectives, rng = choosing(seed, rule), drawn(seed), random.Random(seed)
        banned = rng.choice(problem.network.motions) if seed % 3 == 0 else None
        within = 0 if banned else rng.choice((0, 0, 20, 60))
        everything = minimal_trees(problem, lambda tree, banned=banned: all(u.motion != banned for u in tree))  # type: ignore[misc]
        rules = [f':- use(U), motion(U,"{banned}").'] if banned else []
        found = foon_asp.unit_union(problem, objectives, within=within, constraints=rules)
        assert found.complete
        if not everything:
            assert not found.units
            continue
        best = min(key(problem, tree, objectives) for tree in everything)
        if within:
            first = [task_trees.measure(problem, tuple(tree), objectives[0]) for tree in everything]
            share = Fraction(
                -within if objectives[0] == "success" else within, 100
            )  # success counts negative
            count = [
                tree
                for tree, figure in zip(everything, first, strict=True)
                if figure <= min(first) * (1 + share)
            ]
        else:
            count = [tree for tree in everything if key(problem, tree, objectives) == best]
        unit_id = {
            problem.network.unit(u): problem.network.unit_number(u) for u in range(len(problem.network))
        }
        assert of(found, Membership.EVERY) == {unit_id[u] for u in frozenset.intersection(*count)}
        assert of(found, *Membership) == {unit_id[u] for u in frozenset().union(*count)}
        several += len(count) > 1
    assert several
