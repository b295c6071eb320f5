"""What is left of a question: the tree in hand, the bound, the units left, and what is heard of them."""

import gc
import math
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from itertools import count, pairwise

import pytest

from foon_asp.asp import Status, solve
from foon_asp.hypergraph import (
    ALL,
    NONE,
    SAFE,
    ExactCosts,
    Listener,
    Reduced,
    Reduction,
    reduce,
    tuning,
)
from foon_asp.hypergraph.landmark_cuts import Cuts, WeightedCut
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.problem import Objective, Problem, levels
from tests.support.plain_graphs import Action, plain_problem

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
        first = costs.first_objective_bound(bound)
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
SHARING, APART = {0, 1, 2, 3}, {4, 5, 6}


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


@pytest.mark.parametrize("reductions", [BOUNDS, DEAR, ALL, SAFE])
def test_a_better_tree_than_the_first_is_found(reductions: frozenset[Reduction]) -> None:
    # the dearest ways lead to what shares, 8; to add up leads to what is apart, 7
    heard = Heard()
    found = reduce(routes(1, 3, 3, 2, 5, 1, 2, 20), INPUTS, reductions, listener=heard)
    assert (tree_of(found), found.settled) == (APART, bool(reductions & BOUNDS))
    assert heard.trees == [SHARING, APART]


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
        (1, ALL, True),
        (2, DEAR, True),
        (2, SAFE, True),
        (2, DEAR | BOUNDS, False),
        (2, ALL, False),
        (3, DEAR, False),
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
    assert (found.bound, found.costs.first_objective_bound(found.bound)) == (found.cuts.bound, 10)
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


# --- Products of rates.

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
    heard = Heard()
    problem = plain_problem(FORCING, [4], rates=["0", "1/2", "1/2", "1/2", "1/2"])
    found = reduce(problem, SUCCESS, ALL, listener=heard)
    assert found == Reduced(frozenset({1, 2, 4}), (0, 1, 2, 4), False, None, 0, None)
    assert heard.trees == [{1, 2, 4}]
    # a rate of what leads to no goal does not matter
    assert reduce(plain_problem([([0], [1]), ([0], [2])], [1], rates=["1/2", "0"]), SUCCESS).settled


def row_of(*rates: str) -> Problem:
    """Ask for what comes of a row of units, each with a rate of its own."""
    actions: list[Action] = [([place and place + 1], [place + 2]) for place in range(len(rates))]
    return plain_problem(actions, [len(rates) + 1], rates=rates)


def test_cuts_settle_by_exact_costs_and_not_by_rounded_ones() -> None:
    costs = ExactCosts(row_of("0.9", "0.900000001"), (Objective.SUCCESS, Objective.UNITS), range(2))
    first, second = costs(0), costs(1)
    assert costs.doubt > 0
    assert first > second + costs.doubt
    own = [WeightedCut(frozenset({1}), (0,), 0, first), WeightedCut(frozenset({2}), (1,), 1, second)]
    assert costs.proves_optimal(Cuts(first + second, {0: 0, 1: 0}, own), {0, 1})
    # a cut of both, worth the first: the second has less than that, exactly, and is overloaded
    both = WeightedCut(frozenset({1}), (0, 1), 0, first)
    assert not costs.proves_optimal(Cuts(first, {0: 0, 1: second - first}, [both]), {0})
    # the other way round it is the first that has some left
    fair = WeightedCut(frozenset({1}), (0, 1), 1, second)
    assert costs.proves_optimal(Cuts(second, {0: first - second, 1: 0}, [fair]), {1})
    assert not costs.proves_optimal(Cuts(second, {0: first - second, 1: 0}, [fair]), {0})
    # less than the tree costs proves nothing, and one cut may not be used twice
    assert not costs.proves_optimal(Cuts(first, {0: 0}, own[:1]), {0, 1})
    assert not costs.proves_optimal(Cuts(2 * first, {0: -first}, own[:1] * 2), {0, 1})


def test_without_rates_costs_are_whole_numbers_and_bounds_are_compared_as_they_are() -> None:
    costs = ExactCosts(row_of("0.5", "0.5", "0.5"), (Objective.UNITS,), range(3))
    assert (costs.doubt, [*map(costs, range(3))]) == (0, [1, 1, 1])
    assert [costs.proves_optimal(Cuts(bound, {}, []), {0, 1, 2}) for bound in (2, 3, 4)] == [
        False,
        True,
        True,
    ]
    assert [costs.first_objective_bound(total) for total in (0, 1, 7)] == [0, 1, 7]


@pytest.mark.parametrize("rate", ["0.5", "0.001", "0.999999", "1"])
def test_a_bound_on_success_is_near_the_product_and_never_below_it(rate: str) -> None:
    problem = row_of(rate, rate, "0.75")
    costs = ExactCosts(problem, (Objective.SUCCESS, Objective.UNITS), range(3))
    product = math.prod(map(problem.rate, range(3)))
    bound = costs.first_objective_bound(sum(map(costs, range(3))))
    assert product <= bound <= min(1, product * (1 + 1 / 10**15))
    assert costs.first_objective_bound(0) == 1


# --- What each reduction is for.

FORCING: list[Action] = [([0], [1]), ([0], [2, 3]), ([0], [1]), ([0], [3]), ([1, 2, 3], [4])]


@pytest.mark.parametrize(
    ("reductions", "left"),
    [
        # 2 is as good as 0, and what 3 gives is there with 1, which is forced and dearer
        (NONE, {0, 1, 2, 3, 4}),
        (FORCED, {0, 1, 2, 4}),
        (DOMINATED, {1, 2, 3, 4}),
        (FORCED | DOMINATED, {1, 2, 4}),
        (DEAR, {0, 1, 2, 4}),  # no more than the tree costs
        (SAFE, {0, 1, 2, 4}),
    ],
)
def test_each_reduction_leaves_out_what_it_is_for(reductions: frozenset[Reduction], left: set[int]) -> None:
    found = reduce(plain_problem(FORCING, [4], [1, 2, 1, 1, 3]), INPUTS, reductions)
    kept = set(found.units)
    assert kept - (found.tree or set()) == left - (found.tree or set())


def test_dear_is_what_is_far_from_the_goals_or_dear_to_begin_with() -> None:
    # the goal 1 comes at once for 5, or of 2 for 1, which comes of 3 for 1, which costs 10
    found = reduce(
        plain_problem([([0], [1]), ([2], [1]), ([3], [2]), ([0], [3])], [1], [5, 1, 1, 10]), INPUTS, DEAR
    )
    assert (tree_of(found), found.units, found.settled, found.bound) == ({0}, (0,), False, 5 * 5 + 1)


def test_a_tree_in_hand_stays_where_another_one_stands_in_for_it() -> None:
    found = reduce(plain_problem([([0], [1]), ([0], [1])], [1]), UNITS, DOMINATED)
    assert found.tree is not None
    assert set(found.units) == found.tree | {1}


@pytest.mark.parametrize(
    ("reductions", "heard", "left"),
    [(NONE, [], {0, 1, 2}), (DOMINATED, [{2}], {0, 1, 2}), (ALL, [{2}, {0, 1}], {0, 1})],
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


def test_a_large_network_is_cut_to_what_its_goals_can_need(monkeypatch: pytest.MonkeyPatch) -> None:
    presolve_tuning = PresolveTuning(lazy_actions=0, first_actions=1, easy_actions=0)
    monkeypatch.setattr(tuning, "PRESOLVE", presolve_tuning)
    # the goal 1 comes of what is made in three more steps, in either of two ways, or dear at once
    near: list[Action] = [([2], [1]), ([3], [2]), ([4], [2]), ([5], [3]), ([6], [4]), ([0], [5]), ([0], [6])]
    far: list[Action] = [([100 + n], [200 + n]) for n in range(40)]
    actions = [([0], [1]), *near, ([7], [1]), *far]
    problem = plain_problem(actions, [1], [9, 2, 2, 1, 2, 1, 2, 1, *([1] * 41)])
    for reductions in (BOUNDS, DEAR, SAFE, ALL):
        heard = Heard()
        found = reduce(problem, INPUTS, reductions, listener=heard)
        assert heard.trees == [{0}, {1, 3, 5, 7}]
        assert heard.bounds == [5]
        assert (tree_of(found), found.units) == ({1, 3, 5, 7}, (1, 3, 5, 7))
        assert (found.settled, found.interrupted) == (bool(reductions & BOUNDS), False)


# --- Stopped.


def test_whenever_time_is_up_what_is_left_has_the_best_tree() -> None:
    for steps in range(3):
        problem, drawn, others = gap(steps)
        for calls in range(0, 40, 3):
            found = reduce(problem, INPUTS, ALL, after(calls))
            assert (found.settled, found.interrupted) == (False, False)
            assert found.costs is not None
            assert found.cuts is not None
            assert found.costs.first_objective_bound(found.bound) <= 10
            assert found.cuts.bound == found.bound  # and not what was found of others when time was up
            assert found.tree is not None
            assert found.tree < drawn
            left = set(found.units)
            assert left == drawn | others or (steps == 2 and left == drawn)


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
        assert found.costs.first_objective_bound(found.bound) == max(heard.bounds, default=0)
        bounds.append(found.bound)
    assert bounds == sorted(bounds)
    assert bounds[0] == 0
    assert bounds[-1] == found.bound == 155


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
    with pytest.raises(KeyboardInterrupt):  # before there is a tree it is passed on
        reduce(problem, INPUTS, reductions, guard=lambda: struck({0}, guards))
    guards = count()
    found = reduce(problem, INPUTS, reductions, guard=lambda: struck({1}, guards))
    expected = reduce(problem, INPUTS, reductions)
    # but for what is never equal to others
    found, expected = (each._replace(costs=None, cuts=None, subproblem=None) for each in (found, expected))
    assert found == expected
    assert next(guards) == 2


def test_garbage_is_collected_again_afterwards() -> None:
    inside = []

    class Looking(Listener):
        def tree(self, units: frozenset[int]) -> None:
            inside.append(gc.isenabled())

    reduce(gap(0)[0], INPUTS, listener=Looking())
    assert inside == [False]
    assert gc.isenabled()
