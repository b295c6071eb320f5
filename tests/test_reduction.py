"""What is left of a question: the tree in hand, the bound, the units left, and what is heard of them."""

import gc
import math
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from itertools import combinations, count, pairwise
from typing import Any

import pytest

from foon_asp.asp import Status, solve
from foon_asp.bounds.landmark_cuts import Cuts, landmark_cuts
from foon_asp.problem import Objective, Problem, levels
from foon_asp.reduce import ALL, NONE, SAFE, ExactCosts, Listener, Reduced, Reduction, reduce, reduction
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.graph import Graph
from foon_asp.reduce.upper_bound import improved
from tests.gap_problem import gap_problem
from tests.plain_graphs import Action, plain_problem

UNITS, INPUTS, SUCCESS = (Objective.UNITS,), levels((Objective.INPUTS,)), levels((Objective.SUCCESS,))
BOUNDS, DEAR = frozenset({Reduction.BOUNDS}), frozenset({Reduction.DEAR})
FORCED, DOMINATED = frozenset({Reduction.FORCED}), frozenset({Reduction.DOMINATED})


class Heard(Listener):
    """Keeps what it hears."""

    def __init__(self) -> None:
        self.trees: list[set[int]] = []
        self.bounds: list[int] = []

    def tree(self, units: frozenset[int]) -> None:
        self.trees.append(set(units))

    def bound(self, costs: ExactCosts, bound: int) -> None:
        first = costs.first(bound)
        assert isinstance(first, int)
        self.bounds.append(first)


def tree_of(found: Reduced) -> set[int] | None:
    return None if found.tree is None else set(found.tree)


def after(calls: int) -> Callable[[], bool]:
    """Have the time be up after it was asked for so often."""
    asked = count()
    return lambda: next(asked) >= calls


# The goal 1 comes of 3 and 4, each of which comes of 2 (0 to 3), of 5 and 6 (4 to 6), or at once (7). 8 gives
# what nobody needs, and 9 what only 10 needs, which cannot run.
ROUTES: list[Action] = [
    ([], [2]),
    ([2], [3]),
    ([2], [4]),
    ([3, 4], [1]),
    ([], [5]),
    ([], [6]),
    ([5, 6], [1]),
    ([], [1]),
    ([], [8]),
    ([], [9]),
    ([9, 10], [1]),
]
SHARING, APART, ONCE = {0, 1, 2, 3}, {4, 5, 6}, {7}


def routes(*prices: int) -> Problem:
    return plain_problem(ROUTES, [1], [*prices, 1, 1, 2])


def test_without_reductions_all_is_left_that_runs_and_leads_to_the_goals() -> None:
    heard = Heard()
    found = reduce(routes(1, 1, 1, 2, 1, 1, 2, 9), INPUTS, NONE, listener=heard)
    assert found == Reduced(frozenset(APART), tuple(range(8)), False, None, 0, None)
    assert (heard.trees, heard.bounds) == ([], [])


def test_where_there_is_no_tree_nothing_is_left() -> None:
    heard = Heard()
    for reductions in (NONE, ALL):
        found = reduce(plain_problem([([2], [1]), ([0], [3])], [1]), INPUTS, reductions, listener=heard)
        assert found == Reduced(None, (), False, None, 0, None)
    assert (heard.trees, heard.bounds) == ([], [])


def test_where_bounds_meet_nothing_is_left_but_the_tree() -> None:
    heard = Heard()
    found = reduce(routes(1, 1, 1, 2, 1, 1, 2, 9), INPUTS, listener=heard)
    assert (tree_of(found), found.units, found.settled, found.interrupted) == (APART, (4, 5, 6), True, False)
    assert found.costs is not None
    assert found.cuts is not None
    assert found.bound == found.cuts.bound == sum(map(found.costs, APART))
    assert (heard.trees, heard.bounds) == ([APART], [4])


def test_better_trees_are_looked_for_only_where_bounds_or_dear_units_are() -> None:
    # the dearest ways lead to what shares, 8; to add up leads to what is apart, 7
    problem = routes(1, 3, 3, 2, 5, 1, 2, 20)
    for reductions in (FORCED, DOMINATED, FORCED | DOMINATED):
        heard = Heard()
        found = reduce(problem, INPUTS, reductions, listener=heard)
        assert (tree_of(found), found.bound, found.cuts, found.settled) == (SHARING, 0, None, False)
        assert (heard.trees, heard.bounds) == ([SHARING], [])
    for reductions in (BOUNDS, DEAR, ALL, SAFE):
        heard = Heard()
        found = reduce(problem, INPUTS, reductions, listener=heard)
        assert (tree_of(found), found.settled) == (APART, bool(reductions & BOUNDS))
        assert heard.trees == [SHARING, APART]


@pytest.mark.parametrize("easy", [0, 7, 8])
def test_a_tree_by_added_estimates_comes_first_where_much_is_left(
    easy: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_EASY", easy)
    heard = Heard()
    found = reduce(routes(1, 3, 3, 2, 5, 1, 2, 20), INPUTS, FORCED, listener=heard)  # 8 are left
    assert heard.trees == ([SHARING, APART] if easy < 8 else [SHARING])
    assert tree_of(found) == heard.trees[-1]
    # and where it is no better it is not heard of
    heard = Heard()
    reduce(routes(1, 1, 1, 2, 1, 1, 2, 9), INPUTS, FORCED, listener=heard)
    assert heard.trees == [APART]


def test_dear_is_what_is_far_from_the_goals_or_dear_to_begin_with() -> None:
    # the goal 1 comes at once for 5, or of 2 for 1, which comes of 3 for 1, which costs 10
    found = reduce(
        plain_problem([([0], [1]), ([2], [1]), ([3], [2]), ([0], [3])], [1], [5, 1, 1, 10]), INPUTS, DEAR
    )
    assert (tree_of(found), found.units, found.settled, found.bound) == ({0}, (0,), False, 5 * 5 + 1)


def gap(steps: int) -> tuple[Problem, set[int], set[int]]:
    """Ask for what comes of three edges drawn from two of three corners (0 to 9), or otherwise (from 10 on).

    The cheapest of the former have 14 inputs and 6 units, and cuts leave 4 inputs of that unproved; the
    others have 14 inputs, and 4 units and some steps. All that cuts leave of these is left of the first, of
    which two things come that are needed both.
    """
    corners: list[Action] = [([0], [5]), ([0], [6]), ([0], [7])]
    edges: list[Action] = [([5], [8]), ([6], [8]), ([5], [9]), ([7], [9]), ([6], [10]), ([7], [10])]
    others: list[Action] = [([0], [2]), ([2], [3]), ([2], [4]), ([3, 4], [11])]
    others += [([11 + step], [12 + step]) for step in range(steps)]
    others[-1] = (others[-1][0], [1])
    actions = [*corners, *edges, ([8, 9, 10], [1]), *others]
    prices = [4, 4, 4, *([1] * 6), 3, 10 - steps, 1, 1, 2, *([1] * steps)]
    return plain_problem(actions, [1], prices), set(range(10)), set(range(10, len(actions)))


@pytest.mark.parametrize(
    ("steps", "reductions", "stays"),
    [
        # one of as many inputs and fewer units than the tree in hand is better, with 6 it is as good
        *((steps, reductions, True) for steps in (0, 1) for reductions in (DEAR, DEAR | BOUNDS, ALL)),
        (2, DEAR, True),
        (2, SAFE, True),
        (2, DEAR | BOUNDS, False),
        (2, ALL, False),
        *((steps, reductions, False) for steps in (3, 4) for reductions in (DEAR, DEAR | BOUNDS, ALL)),
    ],
)
def test_what_is_better_than_the_tree_in_hand_stays_and_what_is_dearer_goes(
    steps: int, reductions: frozenset[Reduction], stays: bool
) -> None:
    problem, drawn, others = gap(steps)
    found = reduce(problem, INPUTS, reductions)
    assert found.tree is not None
    assert found.tree < drawn
    assert set(found.units) == (drawn | others if stays else drawn)
    assert found.costs is not None
    assert found.cuts is not None
    assert (found.bound, found.costs.first(found.bound)) == (found.cuts.bound, 10)
    assert not found.settled


def test_no_bound_is_above_what_the_tree_in_hand_costs() -> None:
    # with the first corner and the last it is 17 inputs, with others 18 and more, otherwise 19
    edges: list[Action] = [([5], [8]), ([6], [8]), ([5], [9]), ([7], [9]), ([6], [10]), ([7], [10])]
    corners: list[Action] = [([0], [5]), ([0], [6]), ([0], [7])]
    actions = [*corners, *edges, ([8, 9, 10], [1]), ([0], [2]), ([2], [1])]
    problem = plain_problem(actions, [1], [2, 5, 1, 3, 1, 4, 4, 4, 4, 3, 18, 1])
    heard = Heard()
    found = reduce(problem, INPUTS, listener=heard)
    assert (tree_of(found), found.settled) == ({0, 2, 3, 6, 8, 9}, True)
    # the cuts of what is left then come to more: nothing of that is better
    assert found.cuts is not None
    assert found.costs is not None
    assert found.bound == sum(map(found.costs, {0, 2, 3, 6, 8, 9})) < found.cuts.bound
    assert heard.bounds[-1] == 17


def least_covers(problem: Problem, corners: int) -> set[int]:
    """Give the units that some tree of fewest units has, where edges are drawn from corners."""
    network = problem.network
    drawn: dict[frozenset[str], dict[str, int]] = {}
    ready: dict[str, list[int]] = {}
    last = len(network) - 1
    for unit in range(last):
        [output] = (network.objects[o] for o in network.outputs[unit])
        places = [relation.object for relation in output.relations]
        if output.label == "corner":
            ready.setdefault(places[0], []).append(unit)
        else:
            [corner] = (network.objects[o].relations for o in network.inputs[unit])
            [place] = (relation.object for relation in corner)
            drawn.setdefault(frozenset(places), {})[place] = unit
    for size in range(corners + 1):
        covers = [set(c) for c in combinations(ready, size) if all(not edge.isdisjoint(c) for edge in drawn)]
        if covers:
            chosen = {unit for cover in covers for corner in cover for unit in ready[corner]}
            for cover in covers:
                chosen.update(unit for by in drawn.values() for corner, unit in by.items() if corner in cover)
            return chosen | {last}
    raise AssertionError("no cover")


@pytest.mark.parametrize("seed", range(40))
def test_every_optimal_tree_is_left_where_bounds_leave_a_gap(seed: int) -> None:
    problem = gap_problem(seed, corners=5 + seed % 2)
    wanted = least_covers(problem, 5 + seed % 2)
    for reductions in (DEAR, FORCED, SAFE):
        found = reduce(problem, UNITS, reductions)
        assert wanted <= set(found.units)


ROWS = ((0, 4, 8, 16, 17), (1, 2, 10, 14, 18))  # with the same sums of powers up to the fourth


def two_rows(least: int) -> Problem:
    """Ask for what comes of either of two rows of units, the product of whose rates differs by 5040 / 10**45.

    The units from 5 on are the better row.
    """
    steps = [0, 2, 3, 4, 5, 1], [0, 6, 7, 8, 9, 1]
    actions: list[Action] = [([have], [then]) for row in steps for have, then in pairwise(row)]
    rates = [f"{10**9 + least + more}/{10**9}" for row in ROWS for more in row]
    return plain_problem(actions, [1], rates=rates)


def test_what_rounding_makes_dearer_is_left() -> None:
    problem = two_rows(-57)
    worse, better = set(range(5)), set(range(5, 10))
    products = [math.prod(map(problem.rate, row)) for row in (worse, better)]
    assert products[0] < products[1]
    for reductions in (DEAR, SAFE, ALL):
        found = reduce(problem, SUCCESS, reductions)
        assert found.costs is not None
        assert sum(map(found.costs, worse)) < sum(map(found.costs, better))
        assert (tree_of(found), found.settled) == (worse, False)
        assert set(found.units) == worse | better
    outcome = solve(problem, (Objective.SUCCESS,))
    assert (outcome.units, outcome.status) == (tuple(sorted(better)), Status.OPTIMAL)


def test_what_rounding_makes_as_dear_is_told_apart_exactly() -> None:
    problem = two_rows(-58)
    found = reduce(problem, SUCCESS)
    assert found.costs is not None
    assert sum(map(found.costs, range(5))) == sum(map(found.costs, range(5, 10)))
    assert (tree_of(found), found.units, found.settled) == (set(range(5)), tuple(range(10)), False)
    found = reduce(two_rows(-59), SUCCESS)  # here it is made cheaper
    assert (tree_of(found), found.settled) == (set(range(5, 10)), True)


def test_rates_too_fine_leave_what_is_beside_forced_units() -> None:
    # 1 is forced, and gives what 3 gives; 2 is as good as 0 and needs no more
    actions: list[Action] = [([0], [1]), ([0], [2, 3]), ([0], [1]), ([0], [3]), ([1, 2, 3], [4])]
    problem = plain_problem(actions, [4], rates=["0", "1/2", "1/2", "1/2", "1/2"])
    heard = Heard()
    found = reduce(problem, SUCCESS, ALL, listener=heard)
    assert found == Reduced(frozenset({1, 2, 4}), (0, 1, 2, 4), False, None, 0, None)
    assert heard.trees == [{1, 2, 4}]


# The goal 1 comes of what is made in three more steps, in either of two ways.
NEAR: list[Action] = [([2], [1]), ([3], [2]), ([4], [2]), ([5], [3]), ([6], [4]), ([0], [5]), ([0], [6])]


def far(count: int) -> list[Action]:
    """Give actions that lead nowhere, of what is not there."""
    return [([100 + n], [200 + n]) for n in range(count)]


@pytest.mark.parametrize(
    ("large", "first", "lazy"),
    [
        (39, 1, True),
        (40, 1, False),  # 40 are not large
        (39, 3, True),  # there are 1, 3, 5 and 7 at most so near
        (39, 6, True),
        (39, 7, True),
        (39, 8, False),  # there are fewer
    ],
)
def test_of_a_large_network_only_what_is_near_is_looked_at(
    large: int, first: int, lazy: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_LARGE", large)
    monkeypatch.setattr(reduction, "_FIRST", first)
    problem = plain_problem([*NEAR, *far(33)], [1])
    for reductions in (BOUNDS, DEAR, SAFE, FORCED, DOMINATED):
        # when time is up at once, what is left says whether all have been looked at
        found = reduce(problem, UNITS, reductions, after(0))
        assert found.tree is not None
        early = lazy and not reductions <= FORCED | DOMINATED
        assert found.interrupted is early
        assert found.units == (tuple(sorted(found.tree)) if early else tuple(range(7)))
        assert found.settled is False
        # with time there is no difference
        found = reduce(problem, UNITS, reductions)
        assert (found.interrupted, len(found.tree or ())) == (False, 4)


@pytest.mark.parametrize(("size", "lazy"), [(7, False), (8, True)])
def test_a_quarter_of_a_large_network_is_no_longer_a_few(
    size: int, lazy: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_LARGE", 0)
    monkeypatch.setattr(reduction, "_FIRST", 1)
    # after 0, the only one that gives the goal, comes 1, which lacks less, and only then what makes a tree
    few: list[Action] = [([2], [1]), ([9], [2]), ([3, 4], [2]), ([0], [3]), ([0], [4])]
    found = reduce(plain_problem([*few, *far(size - 5)], [1]), UNITS, ALL, after(0))
    assert (tree_of(found), found.interrupted) == ({0, 2, 3, 4}, lazy)


def test_a_large_network_is_cut_to_what_its_goals_can_need(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reduction, "_LARGE", 0)
    monkeypatch.setattr(reduction, "_FIRST", 1)
    monkeypatch.setattr(reduction, "_EASY", 0)
    # the tree that is near is the dear one at once
    actions = [([0], [1]), *NEAR, ([7], [1]), *far(40)]
    problem = plain_problem(actions, [1], [9, 2, 2, 1, 2, 1, 2, 1, *([1] * 41)])
    for reductions in (BOUNDS, DEAR, SAFE, ALL):
        heard = Heard()
        found = reduce(problem, INPUTS, reductions, listener=heard)
        assert heard.trees == [{0}, {1, 3, 5, 7}]
        assert heard.bounds == [5]
        assert (tree_of(found), found.units) == ({1, 3, 5, 7}, (1, 3, 5, 7))
        assert (found.settled, found.interrupted) == (bool(reductions & BOUNDS), False)


FORCING: list[Action] = [([0], [1]), ([0], [2, 3]), ([0], [1]), ([0], [3]), ([1, 2, 3], [4])]


@pytest.mark.parametrize(
    ("reductions", "many", "left"),
    [
        # 2 is as good as 0, and what 3 gives is there with 1, which is forced and dearer
        (NONE, 5, {0, 1, 2, 3, 4}),
        (FORCED, 5, {0, 1, 2, 4}),
        (FORCED, 4, {0, 1, 2, 3, 4}),
        (DOMINATED, 5, {1, 2, 3, 4}),
        (FORCED | DOMINATED, 5, {1, 2, 4}),
        (FORCED | DOMINATED, 4, {1, 2, 4}),
        (FORCED | DOMINATED, 3, {1, 2, 3, 4}),
        (DEAR, 5, {0, 1, 2, 4}),  # no more than the tree costs
        (SAFE, 5, {0, 1, 2, 4}),
    ],
)
def test_each_reduction_leaves_out_what_it_is_for(
    reductions: frozenset[Reduction], many: int, left: set[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_MANY", many)
    found = reduce(plain_problem(FORCING, [4], [1, 2, 1, 1, 3]), INPUTS, reductions)
    kept = set(found.units)
    assert kept - (found.tree or set()) == left - (found.tree or set())


def test_a_tree_in_hand_stays_where_another_one_stands_in_for_it() -> None:
    problem = plain_problem([([0], [1]), ([0], [1])], [1])
    found = reduce(problem, UNITS, DOMINATED)
    assert found.tree is not None
    assert set(found.units) == found.tree | {1}


def count_until(question: Callable[[Callable[[], bool]], Reduced], bound: int) -> Reduced:
    """Give what is found when time is up just when a bound is proved."""
    return next(found for calls in range(50) if (found := question(after(calls))).bound == bound)


def test_when_time_is_up_nothing_more_is_done() -> None:
    problem, drawn, others = gap(0)
    heard = Heard()
    found = count_until(lambda expired: reduce(problem, INPUTS, ALL, expired), 155)
    assert found.cuts is not None
    assert (found.cuts.bound, found.settled, found.interrupted) == (155, False, False)
    assert set(found.units) == drawn | others
    # nor are better trees looked for, or dear units dropped
    problem = routes(1, 3, 3, 2, 5, 1, 2, 20)
    found = count_until(lambda expired: reduce(problem, INPUTS, ALL, expired, heard), 75)
    assert heard.trees[-1] == SHARING
    assert (tree_of(found), found.units, found.settled) == (SHARING, tuple(range(8)), False)


def test_whenever_time_is_up_what_is_left_has_the_best_tree() -> None:
    seen = set()
    for steps in range(3):
        problem, drawn, others = gap(steps)
        for calls in range(40):
            found = reduce(problem, INPUTS, ALL, after(calls))
            assert (found.settled, found.interrupted) == (False, False)
            assert found.costs is not None
            assert found.tree is not None
            assert found.costs.first(found.bound) <= 10
            assert found.cuts is not None
            assert found.cuts.bound == found.bound  # and not what was found of others when time was up
            assert found.tree < drawn
            left = set(found.units)
            assert left == drawn | others or (steps == 2 and left == drawn)
            seen.add(len(left))
    assert seen == {14, 15, 16, 10}


def interrupt_at(calls: int) -> Callable[[], bool]:
    """Have ctrl-C pressed once, when the time was asked for so often."""
    asked = count()

    def expired() -> bool:
        if next(asked) == calls:
            raise KeyboardInterrupt
        return False

    return expired


def test_ctrl_c_leaves_the_tree_in_hand_and_the_bound() -> None:
    problem, drawn, _ = gap(0)
    bounds = []
    for calls in range(40):
        heard = Heard()
        found = reduce(problem, INPUTS, ALL, interrupt_at(calls), heard)
        if not found.interrupted:
            break
        assert found.tree is not None
        assert found.tree < drawn
        assert found.settled is False
        assert tree_of(found) == heard.trees[-1]
        assert found.costs is not None
        assert found.costs.first(found.bound) == max(heard.bounds, default=0)
        bounds.append(found.bound)
    assert bounds == sorted(bounds)
    assert bounds[0] == 0
    assert bounds[-1] == found.bound == 155


def test_ctrl_c_before_there_is_a_tree_is_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object, **__: object) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr(reduction, "derive", interrupt)
    with pytest.raises(KeyboardInterrupt):
        reduce(gap(0)[0], INPUTS)


@contextmanager
def struck(numbers: Collection[int], guards: Iterator[int]) -> Iterator[None]:
    """Have ctrl-C pressed as some of the guarded parts end."""
    yield
    if next(guards) in numbers:
        raise KeyboardInterrupt


@pytest.mark.parametrize("reductions", [ALL, NONE])
@pytest.mark.parametrize("problem", [routes(1, 1, 1, 2, 1, 1, 2, 9), plain_problem([([2], [1])], [1])])
def test_ctrl_c_at_the_very_end_takes_nothing_away(
    problem: Problem, reductions: frozenset[Reduction]
) -> None:
    guards = count()
    with pytest.raises(KeyboardInterrupt):
        reduce(problem, INPUTS, reductions, guard=lambda: struck({0}, guards))
    guards = count()
    found = reduce(problem, INPUTS, reductions, guard=lambda: struck({1}, guards))
    expected = reduce(problem, INPUTS, reductions)
    # but for what is never equal to others
    found, expected = (each._replace(costs=None, cuts=None, wide=None) for each in (found, expected))
    assert found == expected
    assert next(guards) == 2


def test_garbage_is_collected_again_afterwards() -> None:
    inside = []

    class Looking(Listener):
        def tree(self, units: frozenset[int]) -> None:
            inside.append(gc.isenabled())

    assert gc.isenabled()
    reduce(gap(0)[0], INPUTS, listener=Looking())
    assert gc.isenabled()
    try:
        gc.disable()
        reduce(gap(0)[0], INPUTS, listener=Looking())
        assert not gc.isenabled()
    finally:
        gc.enable()
    assert inside == [False, False]


@pytest.mark.parametrize(
    ("steps", "reductions", "easy", "expected"),
    [
        # nothing is left out of 15: that is the end where these are easy, and else one thorough search is
        (1, DEAR, 600, [False]),
        (1, DEAR, 15, [False]),
        (1, DEAR, 14, [False, True]),
        (1, BOUNDS, 0, [False, True]),
        # 7 are left of 16, and nothing is left out of them in a second round
        (2, ALL, 600, [False, False]),
        (2, ALL, 7, [False, False]),
        (2, ALL, 6, [False, False, True]),
        (2, SAFE, 16, [False]),
        (2, SAFE, 15, [False, True]),
    ],
)
def test_better_trees_are_looked_for_thoroughly_where_nothing_else_helps(
    steps: int,
    reductions: frozenset[Reduction],
    easy: int,
    expected: list[bool],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(reduction, "_EASY", easy)
    asked = []

    def improved(_graph: Any, _actions: Any, tree: set[int], *rest: Any) -> set[int]:
        asked.append(rest[-1])
        return tree

    monkeypatch.setattr(reduction, "improved", improved)
    reduce(gap(steps)[0], INPUTS, reductions)
    assert asked == expected


def test_cuts_are_guided_by_estimates_of_what_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    problem, _, _ = gap(2)
    rounds: list[int] = []

    def cutting(
        graph: Graph, targets: Any, left: Collection[int], costs: ExactCosts, guide: Any, *rest: Any
    ) -> Cuts:
        # by number of inputs at first, then by all that counts, as the dearest of the needs
        expected = derive(graph, left, (lambda a: (costs(a) - 1) // 17) if not rounds else costs, added=False)
        assert guide == expected.cost
        anew = rest[-2]
        assert anew(lambda a: a) == derive(graph, left, lambda a: a, added=False).cost
        rounds.append(len(left))
        return landmark_cuts(graph, targets, left, costs, guide, *rest)

    monkeypatch.setattr(reduction, "landmark_cuts", cutting)
    reduce(problem, INPUTS)
    assert rounds == [16, 7]


def test_of_a_large_network_what_runs_is_left_without_a_proof(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(reduction, "_LARGE", 0)
    monkeypatch.setattr(reduction, "_FIRST", 1)
    for steps in range(4):
        problem, drawn, others = gap(steps)
        heard = Heard()
        found = reduce(problem, INPUTS, BOUNDS, listener=heard)
        assert (set(found.units), found.settled, found.interrupted) == (drawn | others, False, False)
        assert heard.trees[0] == others
        assert len(heard.trees) == (1 if steps < 3 else 2)  # with 3, the others are dearer
        assert heard.bounds == [10]


@pytest.fixture
def rounds(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Note how often cuts are looked for, and what is among what better trees are looked for."""
    noted: list[Any] = []

    def cutting(*asked: Any) -> Cuts:
        noted.append("cuts")
        return landmark_cuts(*asked)

    def improving(graph: Graph, actions: Collection[int], *asked: Any) -> set[int]:
        noted.append(set(actions))
        return improved(graph, actions, *asked)

    monkeypatch.setattr(reduction, "landmark_cuts", cutting)
    monkeypatch.setattr(reduction, "improved", improving)
    return noted


def test_where_bounds_meet_nothing_more_is_looked_for(rounds: list[Any]) -> None:
    assert reduce(routes(1, 1, 1, 2, 1, 1, 2, 9), INPUTS).settled
    assert rounds == ["cuts"]
    rounds.clear()
    # with a better tree than the first
    assert reduce(routes(1, 3, 3, 2, 5, 1, 2, 20), INPUTS).settled
    assert rounds == ["cuts", SHARING | APART]
    rounds.clear()
    # and where time is up
    count_until(lambda expired: reduce(routes(1, 3, 3, 2, 5, 1, 2, 20), INPUTS, ALL, expired), 75)
    assert rounds.count("cuts") == len(rounds) == 6


def test_better_trees_are_looked_for_among_what_is_not_dearer(rounds: list[Any]) -> None:
    # in hand is what shares, for 9, all cuts come to 7; what is at once costs 3 more than the tree in hand
    reduce(routes(1, 3, 3, 2, 5, 1, 2, 12), INPUTS)
    assert rounds == ["cuts", SHARING | APART]


def test_better_trees_are_looked_for_among_what_is_in_hand(
    rounds: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "near", lambda *_, **__: {11})
    found = reduce(gap(0)[0], INPUTS, BOUNDS)
    assert found.tree is not None
    assert rounds[1] == found.tree | {11}


def test_cuts_of_all_units_are_kept_before_those_of_fewer() -> None:
    problem, _, others = gap(2)
    found = reduce(problem, INPUTS, ALL)
    assert others.isdisjoint(found.units)
    assert found.cuts is not None
    assert any(not others.isdisjoint(cut.members) for cut in found.cuts.cuts)


@pytest.mark.parametrize(
    ("reductions", "heard", "left"),
    [
        (NONE, [], {0, 1, 2}),
        (FORCED, [{2}], {0, 1, 2}),
        (DOMINATED, [{2}], {0, 1, 2}),
        (BOUNDS, [{2}, {0, 1}], {0, 1}),
        (ALL, [{2}, {0, 1}], {0, 1}),
    ],
)
def test_items_of_the_kitchen_are_no_units(
    reductions: frozenset[Reduction], heard: list[set[int]], left: set[int]
) -> None:
    # 0 and 1 take one item, the first object, for what 2 takes two for
    problem = plain_problem([([], [2]), ([2], [1]), ([], [1])], [1], [1, 1, 2])
    assert min(problem.kitchen) == 0
    hears = Heard()
    found = reduce(problem, levels((Objective.KITCHEN,)), reductions, listener=hears)
    assert (tree_of(found), set(found.units)) == ({0, 1} if reductions & BOUNDS else {2}, left)
    assert hears.trees == heard


def test_a_large_network_is_not_looked_at_for_estimates(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reduction, "_LARGE", 0)
    monkeypatch.setattr(reduction, "_FIRST", 1)
    anew = []

    def cutting(*asked: Any) -> Cuts:
        anew.append(asked[-2])
        return landmark_cuts(*asked)

    monkeypatch.setattr(reduction, "landmark_cuts", cutting)
    reduce(gap(2)[0], INPUTS)
    first, second = anew
    assert first is None
    assert second is not None


def test_rounds_come_to_an_end_where_something_is_left_out_each_time(monkeypatch: pytest.MonkeyPatch) -> None:
    nothing = Cuts(0, {}, [])
    rounds = 0

    def one_less(_graph: Graph, left: Collection[int], *_: object) -> set[int]:
        nonlocal rounds
        rounds += 1
        return {*left} - {max(left)}

    monkeypatch.setattr(reduction, "landmark_cuts", lambda *_: nothing)
    monkeypatch.setattr(reduction, "dear_left_out", one_less)
    problem = plain_problem([([0], [1])] * 40, [1])
    found = reduce(problem, UNITS, DEAR)
    assert (rounds, len(found.units), found.settled) == (24, 16, False)
    assert found.wide is not None
    # fewer where other costs are tried
    monkeypatch.setattr(reduction, "undominated", lambda _graph, left, _costs: left)
    rounds = 0
    found = reduction.at_costs(found.wide, UNITS, found.wide.costs, lambda: False)
    assert (rounds, len(found.units), found.settled) == (6, 34, False)


@pytest.mark.parametrize(
    ("dropped", "many", "below", "given_up"),
    [
        (3, 30, 9, True),  # hardly any of many
        (3, 36, 9, True),
        (3, 37, 9, False),  # too few are left
        (4, 30, 9, False),  # a tenth
        (3, 30, 0, False),  # nothing but a good tree was asked for
    ],
)
def test_what_leaves_out_hardly_any_at_first_is_given_up(
    dropped: int, many: int, below: int, given_up: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = plain_problem([([0], [1])] * 40, [1])
    wide = reduce(problem, UNITS, rest=True).wide
    assert wide is not None
    cuts = []

    def none(*_: object) -> Cuts:
        cuts.append(Cuts(0, {}, []))
        return cuts[-1]

    def fewer(_graph: Graph, left: Collection[int], *_: object) -> set[int]:
        return {*sorted(left)[:-dropped]} if len(left) == 40 else {*left}

    monkeypatch.setattr(reduction, "landmark_cuts", none)
    monkeypatch.setattr(reduction, "dear_left_out", fewer)
    found = reduction.at_costs(wide, UNITS, wide.costs, lambda: False, {0}, below, many)
    assert (len(cuts) == 1) is given_up
    assert not found.settled
    assert len(found.units) == 40 - dropped or not below
