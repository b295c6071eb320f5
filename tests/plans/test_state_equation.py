"""Rounded sums of the state equation: held against all counts of small plans."""

from fractions import Fraction
from random import Random

import pytest

from foon_asp.plans.conditions import Level, Measure
from foon_asp.plans.count_bound import CountBound
from foon_asp.plans.flows import Flows
from foon_asp.plans.state_equation import StateEquation
from tests.plans.test_count_bound import possible, proves, random_flows, whole

UNITS = Measure([1, 1, 1, 1])


def crafts(*crafts: tuple[dict[int, int], dict[int, int]], wanted: dict[int, int]) -> Flows:
    """Return actions that use up and add copies."""
    uses, adds = ([dict(craft[side]) for craft in crafts] for side in (0, 1))
    return Flows(uses, uses, adds, [[] for _ in crafts], {}, wanted)


def strengthened(made: Flows, costs: dict[int, int]) -> StateEquation:
    equation = StateEquation(made, (), (), lambda: False)
    equation.strengthen(costs)
    return equation


@pytest.mark.parametrize("seed", range(40))
def test_rounded_sums_hold_of_all_plans(seed: int) -> None:
    choose = Random(seed)
    made = random_flows(choose)
    amounts = [choose.randint(1, 3) for _ in made.asks]
    adds = [{o: n * amounts[a] for o, n in effects.items()} for a, effects in enumerate(made.adds)]
    made = Flows(made.asks, made.uses, adds, made.items, made.start, made.targets)
    equation = strengthened(made, {a: choose.randint(1, 3) for a in range(len(made.asks))})
    for counts, _ in possible(made):
        for _, row, least in equation.rounded_rows:
            assert sum(n * counts.get(a, 0) for a, n in row.items()) >= least


def test_what_comes_by_threes_is_rounded_up_whichever_alternative_makes_it() -> None:
    # signs of planks of one wood or another: 3 of 2 planks, which come by fours
    woods = [({1 + wood: 2}, {0: 3}) for wood in range(2)] + [({}, {1 + wood: 4}) for wood in range(2)]
    signs = crafts(*woods, wanted={0: 64})
    solved = StateEquation(signs, (), (), lambda: False).strengthen(dict.fromkeys(range(4), 1), 32)
    assert solved.bound > 32  # 22 crafts of signs, and 11 of planks
    assert proves(CountBound(signs), whole(UNITS, 33)) == []
    equation = StateEquation(signs, (), (), lambda: False)
    assert sum(equation.optimum([1] * 4) or ()) == 33


def test_a_level_that_is_kept_counts_in_rounded_sums() -> None:
    pairs = crafts(({}, {0: 2}), ({}, {0: 3}), wanted={0: 7})
    equation = StateEquation(pairs, (), (), lambda: False)
    equation.add_level(Level(Measure([0, 1]), Fraction(1), 1))
    assert equation.strengthen({0: 1}, 1).bound == 2


def test_a_remainder_is_left_where_an_action_asks_for_more_than_it_uses_up() -> None:
    # enriching asks for three, uses up one, and makes what is wanted
    enriching = Flows([{0: 3}, {}], [{0: 1}, {}], [{1: 1}, {0: 1}], [[], []], {}, {1: 4})
    assert [(r.object, r.action, r.copies) for r in enriching.remainders] == [(0, 0, 2)]
    assert CountBound(enriching).cheapest_counts_by_equation([Measure([1, 1])]) == {0: 4, 1: 6}
