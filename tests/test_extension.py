"""What a tree takes more to have a unit of each required set: by hand, and by brute force."""

import random
from dataclasses import replace

import pytest

from foon_asp.problem import ContainerRule, Objective, Problem, Restriction, levels
from foon_asp.reduce import ALL, Reduction, reduce
from foon_asp.reduce import extension as extension_module
from foon_asp.reduce import reduction as reduction_module
from foon_asp.reduce.extension import extended, extensions
from foon_asp.reduce.graph import Graph, graph_of
from tests import oracle
from tests.random_problems import random_problem
from tests.test_constraint_meanings import small

UNITS = levels((Objective.UNITS,))
# 3 needs what 1 makes, 6 what 4 and 5 make, and 7 what nobody has
MADE = small(
    *("boil: start > end", "cut: start > a", "mix: a > end", "fry: a > p", "wash: start > s", "dry: s > t"),
    *("fold: t > q", "wait: never > r"),
)
(NEVER,) = (o for o, node in enumerate(MADE.network.objects) if node.label == "never")
MADE = replace(MADE, kitchen=MADE.kitchen - {NEVER})


def requiring(*sets: set[int], problem: Problem = MADE) -> Graph:
    required = tuple(map(frozenset, sets))
    return graph_of(replace(problem, restriction=Restriction(lambda _: False, required)), UNITS)


def test_a_tree_is_extended_as_cheaply_as_it_can_be() -> None:
    graph = requiring({3, 6})
    assert extended(graph, {1, 2}, lambda _: 1, 99) == {1, 2, 3}
    assert extended(graph, {0}, lambda _: 1, 99) == {0, 1, 3}
    assert extended(graph, {0, 4, 5}, lambda _: 1, 99) == {0, 4, 5, 6}
    assert extended(graph, {0}, lambda unit: 5 if unit == 3 else 1, 99) == {0, 4, 5, 6}
    assert extended(requiring({3}, {6}), {0}, lambda _: 1, 99) == {0, 1, 3, 4, 5, 6}
    assert extended(requiring({0}), {0}, lambda _: 1, 99) == {0}
    assert extended(requiring({7}), {0}, lambda _: 1, 99) is None


@pytest.mark.parametrize(("most", "enough"), [(1, False), (2, True)])
def test_far_from_the_tree_few_actions_are_looked_at(
    most: int, enough: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(extension_module, "_FIRST", 1)
    found = extended(requiring({6}), {0}, lambda _: 1, most)
    assert found == ({0, 4, 5, 6} if enough else None)


def test_what_an_extension_up_to_a_cost_can_have() -> None:
    graph = requiring({3, 6})

    def up_to(limit: int, *free: int) -> set[int]:
        return extensions(graph, set(free), lambda _: 1, limit, lambda: False)

    assert [up_to(limit) for limit in range(4)] == [set(), set(), {1, 3}, {1, 3, 4, 5, 6}]
    assert up_to(1, 1) == {3}  # what is free is there anyway
    assert up_to(1, 4, 5) == {6}
    assert up_to(0, 3) == set()


def test_a_dear_extension_in_hand_hides_no_cheaper_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reduction_module, "extended", lambda *_: {0, 4, 5, 6})
    problem = replace(MADE, restriction=Restriction(lambda _: False, (frozenset({3, 6}),)))
    reduced = reduce(problem, UNITS, frozenset({Reduction.DEAR}))
    assert {0, 1, 3} <= {*reduced.units} or {1, 2, 3} <= {*reduced.units}


def test_of_a_large_required_set_the_units_stay_that_lack_least() -> None:
    graph = requiring({0, 1, 3, 5, 6}, {2, 4})
    one, other = graph.required
    costs = {0: 2, 1: 1, 2: 1, 3: 1, 4: 9, 5: 1, 6: 0}
    assert [{*graph.thin(most, costs.__getitem__).makers[one]} for most in (1, 2, 3, 4, 9)] == [
        *({1}, {0, 1}, {0, 1, 6}, {0, 1, 3, 6}, {0, 1, 3, 5, 6}),
    ]
    assert {*graph.thin(1, costs.__getitem__).makers[other]} == {4}
    assert {*graph.makers[one]} == {0, 1, 3, 5, 6}
    assert graph.size == len(MADE.network.objects) + 2
    plain = graph_of(MADE, UNITS)
    assert plain.thin(1, costs.__getitem__) is plain
    assert (len(plain.required), plain.size) == (0, len(MADE.network.objects))


@pytest.mark.parametrize("reductions", [ALL, ALL - {Reduction.BOUNDS}, frozenset({Reduction.DEAR})], ids=len)
def test_what_is_left_has_the_best_tree_with_a_unit_of_each_required_set(
    reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever tree is in hand, where nothing is required from the beginning."""
    began = 0
    by_extending = reduction_module._Reducer._by_extending

    def counted(*given: object) -> dict[int, int] | None:
        nonlocal began
        found = by_extending(*given)  # type: ignore[arg-type]
        began += found is not None
        return found

    monkeypatch.setattr(reduction_module._Reducer, "_by_extending", counted)
    left_out = 0
    for seed in range(60):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=6)
        size = len(problem.network)
        objective = (Objective.UNITS, Objective.INPUTS, Objective.KITCHEN)[seed % 3]
        sets = tuple(
            frozenset(rng.sample(range(size), rng.choice((1, 2)))) for _ in range(rng.choice((1, 2)))
        )
        gone = frozenset({rng.randrange(size)}) if seed % 2 else frozenset()
        problem = replace(problem, restriction=Restriction(gone.__contains__, sets))
        found = []
        for tree in oracle.trees(problem):
            ids = frozenset(u for u in range(size) if problem.network.unit(u) in tree)
            if not ids & gone and all(ids & each for each in sets):
                found.append((oracle.key(problem, tree, [str(objective)]), ids))
        reduced = reduce(problem, levels((objective,)), reductions)
        if not found:
            assert reduced.tree is None, seed
            continue
        best = min(key for key, _ in found)
        keys = {ids: key for key, ids in found}
        assert reduced.tree is not None, seed
        assert not reduced.settled or keys[reduced.tree] == best, seed
        assert any(key == best and ids <= {*reduced.units} for key, ids in found), seed
        left_out += size - len(reduced.units)
    assert began > 10
    assert left_out > 20
