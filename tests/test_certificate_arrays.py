"""What is asked, as the plain arrays that certificates are computed on: small cases worked out by hand."""

from fractions import Fraction

import pytest

from foon_asp.certificate import Coverage
from foon_asp.certificate.arrays import Arrays, written
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.verify import LimitError
from tests.handmade_certificate import forbid

UNITS, INPUTS, INGREDIENTS, SUCCESS, KITCHEN, *_ = Objective
START, SALT, MIDDLE, END = range(4)
HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


def problem(goals: tuple[int, ...] = (END,), rates: dict[str, Fraction] | None = None) -> Problem:
    """Mix the middle of a start and salt, which leaves the salt; bake the end of the middle; or pour it."""
    builder = NetworkBuilder()
    start, salt = ObjectNode.of("start"), ObjectNode.of("salt", [], [], [("contains", ["grain", "iodine"])])
    middle, end = ObjectNode.of("middle"), ObjectNode.of("end")
    builder.add("mix", [start, salt], [middle, salt], Source("small", 1))
    builder.add("bake", [middle], [end], Source("small", 2))
    builder.add("pour", [start], [end], Source("small", 3))
    return Problem(builder.build(), frozenset({START, SALT}), goals, rates, frozenset())


RATED = problem(rates={"mix": HALF, "bake": Fraction(1), "pour": THIRD})


def costs(asked: Problem, *objectives: Objective) -> object:
    return Arrays(asked, objectives, Coverage()).costs


@pytest.mark.parametrize(
    ("objectives", "expected"),
    [
        ((UNITS,), [(1,), (1,), (1,)]),
        ((INPUTS,), [(2,), (1,), (1,)]),
        ((INGREDIENTS, UNITS), [(4, 1), (1, 1), (1, 1)]),
        # the rates that cost something are 1/3 and 1/2, in this order
        ((SUCCESS,), [(0, 1), (0, 0), (1, 0)]),
        ((UNITS, SUCCESS, INPUTS), [(1, 0, 1, 2), (1, 0, 0, 1), (1, 1, 0, 1)]),
        # after the units, taking the start and taking the salt
        ((KITCHEN,), [(0,), (0,), (0,), (1,), (1,)]),
        (
            (SUCCESS, KITCHEN, UNITS),
            [(0, 1, 0, 1), (0, 0, 0, 1), (1, 0, 0, 1), (0, 0, 1, 0), (0, 0, 1, 0)],
        ),
    ],
)
def test_costs(objectives: tuple[Objective, ...], expected: list[tuple[int, ...]]) -> None:
    assert costs(RATED, *objectives) == expected


def test_without_kitchen_the_items_are_there_from_the_start() -> None:
    arrays = Arrays(RATED, (UNITS,), Coverage())
    assert (arrays.graph.size, list(arrays.graph.start)) == (4, [START, SALT])
    assert [list(needs) for needs in arrays.graph.needs] == [[START, SALT], [MIDDLE], [START]]
    assert [list(gives) for gives in arrays.graph.gives] == [[MIDDLE, SALT], [END], [END]]
    assert arrays.items == {}
    assert arrays.actions(unit for unit in (0, 1)) == [0, 1]
    assert arrays.rates == []
    assert arrays.order.levels == (None,)


def test_by_kitchen_each_item_is_taken_by_an_action_and_made_by_no_unit() -> None:
    arrays = Arrays(RATED, (SUCCESS, KITCHEN), Coverage())
    assert (arrays.graph.size, list(arrays.graph.start)) == (4, [])
    assert [list(needs) for needs in arrays.graph.needs] == [[START, SALT], [MIDDLE], [START], [], []]
    assert [list(gives) for gives in arrays.graph.gives] == [[MIDDLE], [END], [END], [START], [SALT]]
    assert arrays.items == {START: 3, SALT: 4}
    assert arrays.actions(unit for unit in (2,)) == [2, 3]
    assert arrays.actions([0, 1]) == [0, 1, 3, 4]
    assert [arrays.member(action) for action in range(5)] == [
        *({"unit": 0}, {"unit": 1}, {"unit": 2}),
        *({"item": START}, {"item": SALT}),
    ]
    assert arrays.rates == [THIRD, HALF]
    assert arrays.order.levels == ((THIRD, HALF), None)


def test_items_are_numbered_by_their_place_in_the_kitchen() -> None:
    """The goal comes first in the network, and the item last."""
    builder = NetworkBuilder()
    builder.add("split", [ObjectNode.of("middle")], [ObjectNode.of("end")], Source("late", 1))
    builder.add("mix", [ObjectNode.of("salt")], [ObjectNode.of("middle")], Source("late", 2))
    late = Problem(builder.build(), frozenset({2}), (1,), None, frozenset())
    arrays = Arrays(late, (KITCHEN,), Coverage())
    assert arrays.items == {2: 2}
    assert arrays.member(2) == {"item": 2}
    assert arrays.actions([1, 0]) == [1, 0, 2]


def test_cases_are_numbered_anew() -> None:
    """There, the taking of an object is numbered by the object, and here by its place in the kitchen."""
    builder = NetworkBuilder()
    builder.add("split", [ObjectNode.of("middle")], [ObjectNode.of("end")], Source("late", 1))
    builder.add("mix", [ObjectNode.of("salt")], [ObjectNode.of("middle")], Source("late", 2))
    late = Problem(builder.build(), frozenset({2}), (1,), None, frozenset())
    arrays = Arrays(late, (KITCHEN,), Coverage())
    assert arrays.cases(None) is None
    assert arrays.cases((4, (1, None, None), (0, None, None))) == (2, (1, None, None), (0, None, None))
    # there is no taking of what is not in the kitchen
    assert arrays.cases((0, (2, None, None), (3, None, None))) == (0, None, None)


def test_what_is_stated_has_a_part_for_each_objective() -> None:
    arrays = Arrays(RATED, (UNITS, SUCCESS, INPUTS), Coverage())
    assert [arrays.parts(objective) for objective in arrays.objectives] == [1, 2, 1]
    assert arrays.stated((Fraction(7, 2), Fraction(0), Fraction(-2, 3), Fraction(4))) == [
        "7/2",
        {"1/2": "-2/3"},
        "4",
    ]
    assert arrays.stated(arrays.costs[2]) == ["1", {"1/3": "1"}, "1"]
    assert Arrays(RATED, (), Coverage()).stated((HALF,)) == ["1/2"]


def test_a_vector_has_all_its_parts() -> None:
    with pytest.raises(ValueError, match=r"zip\(\)"):
        Arrays(RATED, (SUCCESS,), Coverage()).stated((Fraction(1),))


def test_goals_at_hand_ask_for_nothing() -> None:
    assert Arrays(problem(goals=(END, SALT, MIDDLE)), (UNITS,), Coverage()).goals == [END, MIDDLE]


def test_units_of_forbidden_motions_and_objects() -> None:
    asked = problem()
    assert Arrays(asked, (UNITS,), Coverage(tuple(forbid(["bake", "pour"])))).forbidden == {1, 2}
    assert Arrays(asked, (UNITS,), Coverage(tuple(forbid([], ["middle"])))).forbidden == {
        0,
        1,
    }
    assert Arrays(asked, (UNITS,), Coverage(tuple(forbid(["pour"], ["salt"])))).forbidden == {0, 2}
    assert Arrays(asked, (UNITS,), Coverage(tuple(forbid(["stir"], ["pepper"])))).forbidden == frozenset()


def test_what_nobody_asks_for_takes_no_rates() -> None:
    assert costs(problem(rates=None), UNITS, KITCHEN) == [(1, 0), (1, 0), (1, 0), (0, 1), (0, 1)]


def test_needs_and_gives_are_those_of_the_container_rule() -> None:
    """The cup of salt is taken as given, and what was skipped is not made."""
    builder = NetworkBuilder()
    salt = ObjectNode.of("salt", [], [("in", "cup")])
    cup = ObjectNode.of("cup", [], [], [("contains", ["salt"])])
    builder.add("pour", [salt, cup], [ObjectNode.of("end"), cup], Source("cups", 1))
    network, utensils = builder.build(), frozenset({"cup"})
    for rule, needs, gives in (
        (ContainerRule.STRICT, (0, 1), (2, 1)),
        (ContainerRule.IMPLIED, (0,), (2,)),
    ):
        asked = Problem(network, frozenset({0}), (2,), None, utensils, rule)
        graph = Arrays(asked, (INPUTS,), Coverage()).graph
        assert (graph.needs, graph.gives) == ([needs], [gives])
        assert costs(asked, INPUTS) == [(2,)]  # all inputs count


def test_numbers_have_4_300_digits() -> None:
    assert written(Fraction(10**4299, 7)) == f"{10**4299}/7"
    with pytest.raises(LimitError, match=r"^a fraction has more digits than are written$"):
        written(Fraction(10**4300, 7))
