"""What a tree takes more to have a unit of each required set: by hand, and by brute force."""

import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import count, groupby
from typing import Any

import pytest

from foon_asp.bounds.landmark_cuts import Cuts, landmark_cuts
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction, levels
from foon_asp.reduce import ALL, SAFE, ExactCosts, Reduction, reduce
from foon_asp.reduce import extension as extension_module
from foon_asp.reduce import reduction as reduction_module
from foon_asp.reduce.extension import extended, extensions
from foon_asp.reduce.graph import Graph, graph_of
from foon_asp.reduce.reduction import at_costs
from foon_asp.reduce.wide import dear_left_out
from tests import oracle
from tests.random_problems import random_problem
from tests.test_constraint_meanings import small
from tests.test_reduction import Heard

UNITS = levels((Objective.UNITS,))
# 3 needs what 1 makes, 6 what 4 and 5 make, and 7 what nobody has
WAYS = (
    *("boil: start > end", "cut: start > a", "mix: a > end", "fry: a > p", "wash: start > s", "dry: s > t"),
    *("fold: t > q", "wait: never > r"),
)


def without_never(*units: str) -> Problem:
    problem = small(*units)
    (never,) = (o for o, node in enumerate(problem.network.objects) if node.label == "never")
    return replace(problem, kitchen=problem.kitchen - {never})


MADE = without_never(*WAYS)


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


def test_what_an_extension_cannot_have_is_not_asked_about() -> None:
    prices: list[int] = []

    def price(unit: int) -> int:
        prices.append(unit)
        return 1

    assert extensions(requiring({3, 6}), {4}, price, 2, lambda: False) == {1, 3, 5, 6}
    assert {*prices} == {1, 3, 5, 6}
    # 3 is near, but builds upon 4 and 5, which takes too much; 8 has what it needs of 9, which is free
    ways = [
        "boil: start > end",
        "fry: p > z",
        "cut: start > p",
        "chop: t > p, w",
        "dry: u > t",
        "wait: never > u",
    ]
    ways += ["mix: q > z", "stir: r > q", "bake: w > r", "peel: start > w"]
    prices.clear()
    graph = requiring({1, 6}, problem=without_never(*ways))
    assert extensions(graph, {9}, price, 3, lambda: False) == {1, 2, 6, 7, 8}
    assert (prices.count(3), prices.count(5)) == (2, 1)  # not again by what is left


def test_what_an_extension_uses_twice_costs_it_once() -> None:
    # 4 needs two things that come of what 1 makes: 4 units, on ways of 3
    fork = small(
        *("boil: start > end", "wash: start > s", "cut: s > p", "fry: s > q", "mix: p, q > z"),
        *("chop: start > t", "dry: t > z"),
    )
    graph = requiring({4}, problem=fork)
    found = [extensions(graph, set(), lambda _: 1, limit, lambda: False) for limit in (2, 3, 4)]
    assert found == [set(), {1, 2, 3, 4}, {1, 2, 3, 4}]
    # but where a tree is looked for, it counts twice: 5 rather than 3 by estimates, which 6 is between
    prices = [9, 1, 1, 1, 1, 2, 2].__getitem__
    assert extended(requiring({4, 6}, problem=fork), {0}, prices, 99) == {0, 5, 6}


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
        began += found is not None or vars(given[0])["proved"]
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


# --- In the course of the reductions.

BEST = frozenset({0, 1, 3})  # 1 to 3 are as good, and found later
# in a larger network more may be looked at for a tree
EITHER = replace(
    without_never(*WAYS, *(f"wait: never > x{n}" for n in range(19))),
    restriction=Restriction(lambda _: False, (frozenset({3, 6}),)),
)
SUCCESS = levels((Objective.SUCCESS,))
MOTIONS = ("boil", "cut", "mix", "fry", "wash", "dry", "fold", "wait")
RATED = replace(EITHER, rates={motion: Fraction(9, 10 + n) for n, motion in enumerate(MOTIONS)})


class Asking:
    """Notes which extensions are asked for: what is free, and up to which cost."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.asked: list[tuple[set[int], int]] = []
        monkeypatch.setattr(reduction_module, "extensions", self)

    def __call__(
        self, graph: Graph, free: set[int], costs: ExactCosts, limit: int, expired: Callable[[], bool]
    ) -> set[int]:
        self.asked.append((free, limit))
        return extensions(graph, free, costs, limit, expired)


def test_only_where_dear_units_are_left_out_and_sets_are_required_extensions_are_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asking = Asking(monkeypatch)
    for reduction in Reduction:
        reduce(EITHER, UNITS, ALL - {reduction})
        assert len(asking.asked) == (reduction is not Reduction.DEAR)
        asking.asked.clear()
        reduce(EITHER, UNITS, frozenset({reduction}))
        assert len(asking.asked) == (reduction is Reduction.DEAR)
        asking.asked.clear()
    reduce(EITHER, UNITS, ALL, rest=True)
    reduce(MADE, UNITS)
    reduce(replace(MADE, restriction=Restriction(lambda unit: unit == 0)), UNITS)
    assert not asking.asked


def test_extensions_may_cost_what_a_tree_for_the_goals_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    # 1 unit for the goal, and 3 with the required one
    asking = Asking(monkeypatch)
    for reductions, limit in ((ALL, 1), (frozenset({Reduction.DEAR}), 2)):
        reduced = reduce(EITHER, UNITS, reductions)
        assert reduced.tree == BEST
        assert asking.asked.pop() == ({0, 1, 2, 3}, limit)
    # products of rates are rounded, and units that do not lead to the goals have rates, too
    reduced = reduce(RATED, SUCCESS, ALL)
    assert reduced.tree == BEST
    costs = ExactCosts(RATED, SUCCESS, range(len(RATED.network)))
    [(free, limit)] = asking.asked
    assert free >= {0, 1, 3}
    assert limit == costs(1) + costs(3) - 1 + costs.doubt


def test_what_is_found_for_the_goals_alone_is_no_tree_but_its_bound_holds(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    heard = Heard()
    assert reduce(EITHER, UNITS, listener=heard).tree == BEST
    assert (heard.trees, heard.bounds) == ([{0, 1, 3}], [1, 3])
    # a tree with what is required is looked for among a quarter of all units
    asked: list[Any] = []
    monkeypatch.setattr(reduction_module, "extended", lambda *given: asked.append(given[1:]))
    assert reduce(EITHER, UNITS).tree == BEST
    [(tree, _, most)] = asked
    assert (tree, most, len(EITHER.network)) == ({0}, 6, 27)


def test_a_tree_as_cheap_as_the_best_for_the_goals_alone_is_the_best(monkeypatch: pytest.MonkeyPatch) -> None:
    asking = Asking(monkeypatch)
    for objectives, posed in ((UNITS, EITHER), (SUCCESS, RATED)):
        heard = Heard() if objectives == UNITS else None
        plain = replace(posed, restriction=Restriction(never_removed))
        best = reduce(plain, objectives)
        assert best.settled
        assert best.tree is not None
        asked = replace(posed, restriction=Restriction(never_removed, (best.tree,)))
        found = reduce(asked, objectives, listener=heard)
        assert (found.tree, found.settled, found.units) == (best.tree, True, tuple(best.tree))
        assert found.costs is not None
        assert found.cuts is not None
        assert best.cuts is not None
        assert found.costs.first(found.bound) == found.costs.first(sum(map(found.costs, best.tree)))
        assert [cut.objects for cut in found.cuts.cuts] == [cut.objects for cut in best.cuts.cuts]
        assert heard is None or heard.trees == [set(best.tree)]
        assert not asking.asked
        # not where what is as good counts, or what is left out may be in such a tree
        assert not reduce(asked, objectives, ALL - {Reduction.BOUNDS}).settled
        assert asking.asked
        asking.asked.clear()


def test_where_rounding_may_decide_the_tree_has_to_be_the_one_for_the_goals_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = small("cut: start > end", "fry: start > end", "mix: end > bowl")
    rates = dict.fromkeys(("cut", "fry", "mix"), Fraction(1, 2))
    asked = replace(problem, rates=rates, restriction=Restriction(never_removed, (frozenset({0, 1}),)))
    alone = reduce(replace(asked, restriction=None), SUCCESS).tree
    assert alone is not None
    asking = Asking(monkeypatch)
    assert (reduce(asked, SUCCESS).tree, asking.asked) == (alone, [])
    monkeypatch.setattr(reduction_module, "extended", lambda *_: {0, 1} - alone)
    assert reduce(asked, UNITS).tree == frozenset({0, 1}) - alone
    assert not asking.asked
    assert reduce(asked, SUCCESS).settled
    assert len(asking.asked) == 1
    monkeypatch.setattr(reduction_module, "extended", lambda *_: {*alone})
    monkeypatch.setattr(ExactCosts, "met", lambda *_: False)
    assert not reduce(asked, SUCCESS).settled
    assert len(asking.asked) == 2


def never_removed(_: int) -> bool:
    return False


def test_cuts_are_guided_by_what_is_left_with_extensions(monkeypatch: pytest.MonkeyPatch) -> None:
    fork = ("boil: start > end", "wash: start > s", "cut: s > p", "fry: s > q", "mix: p, q > z")
    problem = without_never(*fork, *(f"wait: never > x{n}" for n in range(20)))
    guides: list[dict[int, int]] = []

    def cutting(*given: Any) -> Cuts:
        guides.append(given[4])
        return landmark_cuts(*given)

    monkeypatch.setattr(reduction_module, "landmark_cuts", cutting)
    asking = Asking(monkeypatch)
    reduced = reduce(replace(problem, restriction=Restriction(lambda _: False, (frozenset({4}),))), UNITS)
    assert (reduced.tree, len(asking.asked), len(guides)) == (frozenset(range(5)), 1, 2)
    assert sorted(guides[1].values()) == [1, 1, 2, 2, 3, 3]


def test_ctrl_c_leaves_a_tree_with_a_unit_of_each_required_set() -> None:
    ended = []
    for calls in range(99):
        asked = count()

        def expired(asked: Iterator[int] = asked, calls: int = calls) -> bool:
            if next(asked) == calls:
                raise KeyboardInterrupt
            return False

        reduced = reduce(EITHER, UNITS, SAFE, expired)
        assert (reduced.tree, reduced.settled) == (BEST, False)
        ended.append((reduced.interrupted, set(reduced.units) == set(BEST)))
        if next(asked) < calls:
            break
    # before there are cuts all is begun anew; then the tree is all that is known, then what is left as well
    assert [each for each, _ in groupby(ended)] == [
        (False, False),
        (True, True),
        (True, False),
        (False, False),
    ]


def test_ctrl_c_while_dear_units_are_left_out_for_the_goals_alone_ends_it_all(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    struck = iter([True])

    def leaving_out(*given: Any) -> set[int]:
        if next(struck, False):
            raise KeyboardInterrupt
        return dear_left_out(*given)

    monkeypatch.setattr(reduction_module, "dear_left_out", leaving_out)
    reduced = reduce(EITHER, UNITS, SAFE)
    assert (reduced.interrupted, reduced.tree, {*reduced.units}) == (True, BEST, {*BEST})


def test_where_time_is_up_with_the_extensions_the_tree_in_hand_is_all_that_is_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asking = Asking(monkeypatch)
    reduced = reduce(EITHER, UNITS, SAFE, lambda: bool(asking.asked))
    assert (reduced.tree, reduced.units) == (BEST, (0, 1, 3))
    assert (reduced.interrupted, reduced.settled, len(asking.asked)) == (True, False, 1)


def test_without_cuts_of_the_goals_alone_all_is_begun_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    struck = iter([True])

    def cutting(*given: Any) -> Cuts:
        return landmark_cuts(*given)._replace(interrupted=next(struck, False))

    monkeypatch.setattr(reduction_module, "landmark_cuts", cutting)
    asking = Asking(monkeypatch)
    reduced = reduce(EITHER, UNITS)
    assert (reduced.tree, reduced.settled, asking.asked) == (BEST, True, [])


def test_the_same_is_asked_for_other_costs() -> None:
    wide = reduce(EITHER, UNITS, rest=True).wide
    assert wide is not None
    found = at_costs(wide, UNITS, wide.costs.priced(lambda unit: unit == 3, 9), lambda: False)
    assert (found.tree, found.bound, found.settled) == (frozenset({0, 4, 5, 6}), 4, True)
    assert found.wide is not None
    assert ({*found.wide.left}, found.wide.spare) == ({*wide.left}, False)
