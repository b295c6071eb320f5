"""What trees up to a cost can have, for rules that decide which trees count: by hand."""

from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.hypergraph import Subproblem, reduce_under_rules
from foon_asp.problem import Objective, Problem, Restriction, levels
from tests.hypergraph.test_extension import without_never
from tests.hypergraph.test_reduction import interrupt_at, two_rows
from tests.rules.test_constraint_meanings import small
from tests.support.gap_problem import gap_problem

UNITS, KITCHEN = Objective.UNITS, Objective.KITCHEN


def subproblem_of(problem: Problem, *objectives: Objective, spare: bool = False) -> Subproblem:
    subproblem = reduce_under_rules(problem, levels(objectives or (UNITS,)), redundant=spare).subproblem
    assert subproblem is not None
    return subproblem


def within(subproblem: Subproblem, units: Collection[int]) -> set[int]:
    """Return what trees can have that cost no more than these units."""
    return {*subproblem.units_within(subproblem.tree_cost(units), lambda: False)}


# 0 makes the goal, 1 to 3 and 4 lead to no goal, 5 and 7 wait for what nobody has, and so nothing needs 6
JUNK = without_never(
    *("boil: start > end", "peel: start > a, b", "cut: a > c", "mix: c > d", "stir: a, b > e"),
    *("wait: never > f", "fry: start > g", "bake: g, never > end"),
)


def test_what_a_tree_up_to_a_cost_can_have() -> None:
    plain, spare = subproblem_of(JUNK), subproblem_of(JUNK, spare=True)
    assert [{*subproblem.all_units()} for subproblem in (plain, spare)] == [{0}, {0, 1, 2, 3, 4, 6}]
    for units, expected in (
        ({0}, {0}),
        ({0, 1}, {0, 1, 6}),
        ({0, 1, 2}, {0, 1, 2, 4, 6}),  # 4 needs two things, which are made by one unit
        ({0, 1, 2, 3}, {0, 1, 2, 3, 4, 6}),
    ):
        assert within(plain, units) == {0}
        assert within(spare, units) == expected
    assert spare.units_within(0, lambda: False) == plain.units_within(0, lambda: False) == frozenset()
    assert spare.units_within(2, lambda: True) == {0, 1, 6}
    removed = subproblem_of(replace(JUNK, restriction=Restriction(lambda unit: unit in {1, 5})), spare=True)
    assert within(removed, {0, 6}) == {*removed.all_units()} == {0, 6}


# a has two makers, b a row of one each; start is grown, and at hand
MADE = small(
    *("boil: start > end", "mix: a, b > end", "cut: start > a", "chop: start > a", "fry: c > b"),
    *("wash: d > c", "dry: start > d", "grow: seed > start"),
    *("wind: thread > spool", "unwind: spool > thread"),
)
MADE = replace(
    MADE,
    kitchen=frozenset(o for o, node in enumerate(MADE.network.objects) if node.label in {"start", "seed"}),
)


def test_what_makes_what_units_need_and_what_makes_the_same() -> None:
    subproblem = subproblem_of(MADE)
    assert subproblem.achievers_for([]) == subproblem.achievers_for([0]) == {0, 1}
    assert subproblem.achievers_for([1]) == {0, 1, 2, 3, 4}
    assert subproblem.achievers_for([4, 5]) == {0, 1, 5, 6}
    assert [subproblem.rival_achievers(units) for units in ([2], [0, 6], [7])] == [{2, 3}, {0, 1, 6}, set()]


def test_what_units_build_upon_without_a_choice() -> None:
    subproblem = subproblem_of(MADE)
    assert [subproblem.with_only_achievers([unit], 99) for unit in (0, 1, 8)] == [{0}, {1, 4, 5, 6}, {8, 9}]
    assert subproblem.with_only_achievers([1, 0], 2) == {0, 1}
    assert [len(subproblem.with_only_achievers([1], most)) for most in range(6)] == [1, 1, 2, 3, 4, 4]


def test_sets_of_units_of_which_each_tree_has_one() -> None:
    assert subproblem_of(MADE).landmarks() == [{0, 1}]
    required = replace(
        MADE, restriction=Restriction(lambda unit: unit == 3, (frozenset({2, 3}), frozenset({6, 4})))
    )
    assert [{*each} for each in subproblem_of(required).landmarks()][-2:] == [{2}, {4, 6}]
    # kitchen items are no units, though one of them is taken by all trees
    assert all(max(each) < len(MADE.network) for each in subproblem_of(MADE, KITCHEN).landmarks())


def test_items_count_in_what_a_tree_costs_where_they_are_counted() -> None:
    size = len(MADE.network)
    (start,) = (o for o, node in enumerate(MADE.network.objects) if node.label == "start")
    subproblem = subproblem_of(MADE, KITCHEN)
    row = {1, 2, 4, 5, 6}
    assert subproblem.tree_cost(row) == sum(map(subproblem.costs, row)) + subproblem.costs(size + start)
    assert subproblem_of(MADE).tree_cost(row) == 5
    # they are no units
    subproblem = subproblem_of(small("mix: a, b > end", "cut: a > end"), KITCHEN)
    assert {*subproblem.actions_within(99, lambda: False)} > {2, 3}
    assert within(subproblem, {0}) == subproblem.all_units() == subproblem.nearest_units(9) == {0, 1}
    assert (subproblem.tree_cost({0}), subproblem.tree_cost({1})) == (
        2 * subproblem.costs(2) + 1,
        subproblem.costs(2) + 1,
    )


def test_units_that_lead_to_no_goal_are_dear_by_all_of_a_way_and_others_by_what_they_need() -> None:
    # 1 to 3 are one way to the goal, of which only 3 waits for nothing; 4 waits for what nobody has
    row = without_never(
        *("boil: start > end", "mix: a > end", "cut: b > a", "dry: start > b", "wait: never > a")
    )
    for spare, expected in ((False, [{0}, {0}, {0, 1, 2, 3}]), (True, [{0}, {0, 3}, {0, 1, 2, 3}])):
        assert [within(subproblem_of(row, spare=spare), {*range(1, n)}) for n in (2, 3, 4)] == expected
    # what cannot run has no costs where no unit is spare
    rates = {"boil": 9, "mix": 8, "cut": 7, "dry": 6, "wait": 5}
    rated = replace(row, rates={motion: Fraction(n, 10) for motion, n in rates.items()})
    assert within(subproblem_of(rated, Objective.SUCCESS), {1, 2, 3}) == {0, 1, 2, 3}


def test_what_rounding_makes_dearer_is_within_what_is_as_good() -> None:
    subproblem = subproblem_of(two_rows(-57), Objective.SUCCESS)  # the first 5 are worse
    assert subproblem.tree_cost(range(5)) < subproblem.tree_cost(range(5, 10))
    assert within(subproblem, range(5)) == {*range(10)}


def test_the_units_nearest_to_the_goals_make_them_sooner_or_later() -> None:
    """Whatever they cost: exact costs by success have forty digits."""
    rated = replace(MADE, rates=dict.fromkeys(MADE.network.motions, Fraction(1, 3)))
    for subproblem in (subproblem_of(MADE), subproblem_of(rated, Objective.SUCCESS)):
        assert [{*subproblem.nearest_units(most)} for most in (1, 6, 7)] == [{*range(n)} for n in (5, 6, 7)]
        assert subproblem.nearest_units(99) == subproblem.all_units() == {*range(7)}


def test_ctrl_c_while_cuts_are_found_anew_ends_it() -> None:
    for calls in range(2):
        with pytest.raises(KeyboardInterrupt):
            subproblem_of(JUNK, spare=True).units_within(2, interrupt_at(calls))


def test_what_is_wide_is_what_was_there_before_anything_was_left_out() -> None:
    for seed in range(3):
        subproblem = subproblem_of(gap_problem(seed))
        assert {*subproblem.remaining} == subproblem.all_units() == subproblem.graph.cone()[0]
