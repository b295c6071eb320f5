"""``foon-asp shopping-list``: the cheapest lists, what is for sale, price lists."""

import random
import warnings
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import pytest

from foon_asp import shopping_list
from foon_asp.asp import Status
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import ContainerRule, Problem
from foon_asp.problem.for_sale import Offer, Shop
from foon_asp.text.diagnostics import InputError
from foon_asp.text.tables import PRICES
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.questions.recipes import posed
from tests.support.random_problems import random_objectives, random_problem

CAKE = posed(
    "oven; hot",
    "cake; baked",
    "flour; in [bag] + egg; cracked > batter; in [bowl]",
    "egg; whole > egg; cracked",
    "batter; in [bowl] + oven; hot > cake; baked",
    "cake; frozen > cake; baked",
    "batter; frozen > batter; in [bowl]",
)


def bought(problem: Problem) -> list[list[str]]:
    found = shopping_list(problem)
    assert found.answer is None or found.answer.status is Status.OPTIMAL
    return [list(map(str, each.items)) for each in found.lists]


def test_raw_things_are_bought_and_the_dish_is_not() -> None:
    """A frozen cake would be one thing, but the cake is what is to be made; frozen batter is sold."""
    assert bought(CAKE) == [["batter; frozen"], ["flour; in [bag]", "egg; whole"]]


@pytest.mark.parametrize(
    ("problem", "offer", "lists"),
    [
        # nothing makes a cake out of anything else
        (
            posed("", "cake; baked", "cake; frozen > cake; thawed", "cake; thawed > cake; baked"),
            Offer.FOR_SALE,
            [["cake; frozen"]],
        ),
        (
            posed(
                *("", "cake; baked", "cake; cold > cake; baked", "cake; baked > cake; cold"),
                "air; thin > cake; of air",
            ),
            Offer.DISH,
            [["cake; cold"]],
        ),
        # the goal itself comes last
        (posed("air", "cake", "air + cake > cake + crumbs", "air > cake; hot"), Offer.GOAL, [["cake"]]),
        (
            posed(
                *("", "bread; baked", "dough; sour > dough; fed", "dough; fed > dough; sour + bread; baked"),
                "dough; fed > bowl; contains {dough}",
            ),
            Offer.CYCLE,
            [["dough; fed"], ["dough; sour"]],
        ),
    ],
)
def test_the_dish_is_proposed_when_nothing_else_is_left(
    problem: Problem, offer: Offer, lists: list[list[str]]
) -> None:
    assert shopping_list(problem).offer is offer
    assert bought(problem) == lists


def test_nothing_is_bought_where_the_kitchen_suffices(cli: Cli) -> None:
    ran = cli("shopping-list", "--goal", "ice")
    assert ran.code == 0
    assert "nothing has to be bought" in ran.out


def good_lists(problem: Problem, sold: list[int], allowed: task_trees.Allowed) -> list[frozenset[int]]:
    """Give every set of things for sale that makes a tree possible."""
    good = []
    for size in range(len(sold) + 1):
        for items in combinations(sold, size):
            stocked = replace(problem, kitchen=problem.kitchen.union(items))
            if next(task_trees.trees(stocked, allowed), None) is not None:
                good.append(frozenset(items))
    return good


def whole_node(node: ObjectNode) -> str:
    """Name an object node so that it is not taken for all nodes with its label."""
    return str(node) if ";" in str(node) else f"{node};"


@pytest.mark.slow
@pytest.mark.parametrize(
    "seeds", [range(7000, 7040), pytest.param(range(7040, 7120), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_lists_against_brute_force(rule: ContainerRule, seeds: range) -> None:
    """Each list is the cheapest of those that do not hold all of an earlier one, and none is left out."""
    helped = none = 0
    for seed in seeds:
        problem = random_problem(seed, rule, units=5)
        rng = random.Random(seed)
        others = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        sold = rng.sample(others, min(len(others), 5))
        prices = {o: Fraction(rng.choice(["0.5", "0.05", "1", "2.25", "3"])) for o in sold}
        bound = rng.choice([0, 1, 2, 9])
        named = {whole_node(problem.network.objects[o]): price for o, price in prices.items()}
        found = shopping_list(
            problem, prices=named, constraints="at_most_units", constants={"max_units": bound}
        )

        def allowed(tree: tuple[object, ...], bound: int = bound) -> bool:
            return len(tree) <= bound

        left = good_lists(problem, sold, allowed)
        none += not left
        for each in found.lists:
            assert each.proved
            listed = {item.id: item.price for item in each.items}
            assert listed.keys() in left
            least = min(sum(prices[o] for o in items) for items in left)
            assert each.price == sum(listed.values()) == least
            left = [items for items in left if not items >= listed.keys()]
        assert found.complete == (len(found.lists) < 3 or not found.lists[0].items)
        assert not (found.complete and left)
        if found.lists and found.lists[0].items:
            helped += 1
            assert found.answer is not None
            assert found.answer.ids is not None
            tree = tuple(map(problem.network.unit, found.answer.ids))
            assert task_trees.makes(found.answer.problem, tree)
    assert helped > 5
    assert none


@pytest.mark.parametrize(
    "seeds", [range(7200, 7230), pytest.param(range(7230, 7400), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_lists_by_tree_against_brute_force(rule: ContainerRule, seeds: range) -> None:
    """Of one price and number of items, the list with the best tree by any objective comes first."""
    ties = 0
    for seed in seeds:
        problem = random_problem(seed, rule, units=6)
        rng = random.Random(seed)
        others = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        sold = rng.sample(others, min(len(others), 5))
        prices = {o: Fraction(rng.choice(["0", "0.5", "1", "1"])) for o in sold}
        objectives = list(map(str, random_objectives(rng, 1)))
        named = {whole_node(problem.network.objects[o]): price for o, price in prices.items()}
        most = rng.choice((1, 3, 40))
        found = shopping_list(problem, objectives, prices=named, lists=most)
        left = good_lists(problem, sold, lambda _: True)
        expected: list[tuple[Fraction | int, int]] = []
        while left and len(expected) < most:
            costs = {}
            for items in left:
                stocked = replace(problem, kitchen=problem.kitchen.union(items))
                key = task_trees.best(list(task_trees.trees(stocked)), stocked, objectives)
                costs[items] = sum(prices[o] for o in items), len(items), key
            least = min((price, size) for price, size, _ in costs.values())
            best = min(cost for cost in costs.values() if cost[:2] == least)
            ties += sum(cost[:2] == least for cost in costs.values()) > 1
            expected.append(best[:2])
            each = found.lists[len(expected) - 1]
            items = frozenset(item.id for item in each.items if item.id is not None)
            assert each.proved
            assert costs[items][:2] == least
            assert each.costs is not None
            if not any(map(Shop(problem).is_second_choice, sold)) and "kitchen" not in objectives:
                assert costs[items] == best
            left = [other for other in left if not other >= items]
            if not items:
                break
        assert len(found.lists) == len(expected)
        assert not (found.complete and left and expected and expected[-1][1])
        if found.lists and found.lists[0].items:
            assert found.answer is not None
            assert found.answer.ids is not None
            tree = tuple(map(problem.network.unit, found.answer.ids))
            assert task_trees.makes(found.answer.problem, tree)
    assert ties


@pytest.mark.slow
@pytest.mark.parametrize("rule", list(ContainerRule))
def test_the_universal_whipped_cream_is_made_possible(cli: Cli, universal: Path, rule: ContainerRule) -> None:
    words = ["shopping-list", "--data", universal, "--goal", "whipped cream", "--containers", rule]
    found = cli(*words, "--format", "json").json
    (only,) = found["lists"]
    assert [item["node"] for item in only["items"]] == [
        "mixing bowl; in [mixer]; contains {condensed milk,cream cheese,pudding mix}"
    ]
    assert (only["proved"], found["complete"], found["offer"]) == (True, True, "for sale")
    assert found["answer"]["status"] == "optimal"


def test_a_price_list_decides(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "prices.txt"
    asked = ("shopping-list", "--goal", "hot cocoa", "--goal", "apple pie", "--prices", file)
    file.write_text(
        "# market\ncocoa tin; contains {cocoa powder}\t4.50\npie crust; chilled\t1.5\npie crust\t2\n"
    )
    said = cli(*asked).out
    assert "2 object nodes for 6\n" in said
    assert "cocoa tin; contains {cocoa powder}    4.50" in said
    file.write_text("cocoa tin; contains {cocoa powder}\t100\nwhisk\t1\nwisk\t1\n")
    short = cli(*asked)
    assert (short.code, "no list of things with a price" in short.out) == (1, True)
    assert "no node for sale has this label: wisk" in short.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("flour\n", "prices.txt:1:6: error: found the end of the line"),
        ("flour\tcheap\n", "prices.txt:1:7: error: found 'cheap', expected a price"),
        ("flour\t-1\n", "found '-1'"),
        ("\nflour\t1\nflour\t2\n", "prices.txt:3:7: error: found a second price"),
        ("flour; in [\t2\n", "error"),
    ],
)
def test_faults_of_a_price_list_have_places(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "prices.txt"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        PRICES.read(file)
    assert message in str(caught.value)


def test_a_whole_node_outbids_its_label(tmp_path: Path) -> None:
    file = tmp_path / "prices.txt"
    file.write_text("egg; whole\t3\negg\t1\nflour\t2\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = shopping_list(CAKE, prices=file)
    assert found.offer is Offer.PRICED
    (only,) = found.lists
    assert {str(item): int(item.price) for item in only.items} == {"egg; whole": 3, "flour; in [bag]": 2}


def test_what_is_empty_or_clean_is_for_sale_although_it_can_be_washed() -> None:
    problem = posed(
        "lemon; whole + knife; clean",
        "lemon; sliced; on [plate]",
        "lemon; whole + knife; clean > lemon; sliced",
        "lemon; sliced + plate; empty > lemon; sliced; on [plate] + plate; contains {lemon}",
        "plate; contains {lemon} > lemon; sliced; on [plate]",
        "plate; dirty + soap > plate; empty",
    )
    lists = bought(problem)
    assert ["plate; empty"] in lists
    assert ["plate; dirty", "soap"] in lists


def test_among_lists_of_one_size_that_with_the_best_tree_comes_first() -> None:
    problem = posed(
        "",
        "tea; hot",
        "water; cold > water; hot",
        "water; hot > tea; hot",
        "kettle; empty + faucet; on > tea; hot",
        "faucet; off > faucet; on",
        "tap; off + kettle; full > tea; hot",
        "tap; off > kettle; full",
        "teabag > tea; hot",
    )
    found = shopping_list(problem, lists=9)
    costs = [(len(each.items), each.costs and (each.costs.units, each.costs.inputs)) for each in found.lists]
    assert costs == [(1, (1, 1)), (1, (2, 2)), (1, (2, 3)), (2, (2, 3))]
    assert found.complete
    first = shopping_list(problem, lists=1)
    assert first.lists == found.lists[:1]
    assert not first.complete
    assert "there are more lists than these" in first.text()
    assert "or, list 2 (1 object node), with 2 units, 2 inputs:\n  water; cold\n" in found.text()
    assert "any other set of things on offer" in found.text()


@STRUCK_WHILE_READING
def test_a_limit_is_told(cli: Cli) -> None:
    ran = cli("shopping-list", "--goal", "hot cocoa", "--time-limit", "0")
    assert ran.code == 3


def test_a_rule_that_says_something_else_once_things_are_bought() -> None:
    """While everything is for sale, something can be fried; once flour is bought, nothing can."""
    problem = posed("", "dough", "flour > dough", "egg > omelet")
    with pytest.raises(UserError, match="no shopping list can be found under it"):
        shopping_list(problem, constraints=[":- use(U), #count { V : unit(V) } < 2."])
