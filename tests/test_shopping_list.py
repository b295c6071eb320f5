"""``foon-asp shopping-list``: the cheapest lists, what is for sale, price lists."""

import random
import warnings
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import pytest
from shopping_lists import cases

import foon_asp
from foon_asp import shopping_list
from foon_asp.asp import Status
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem
from foon_asp.problem.shop import Shop
from foon_asp.questions.shopping_list import Offer
from foon_asp.text.diagnostics import InputError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.price_list import read_prices
from tests import oracle
from tests.conftest import CORPUS, STRUCK_WHILE_READING, Cli
from tests.random_problems import random_problem


def kitchen_problem(kitchen: list[str], goal: str, *units: tuple[list[str], list[str]]) -> Problem:
    builder = NetworkBuilder()
    for line, (inputs, outputs) in enumerate(units, 1):
        builder.add("m", map(parse_node, inputs), map(parse_node, outputs), Source("units", line))
    network = builder.build()
    ids = {str(node): o for o, node in enumerate(network.objects)}
    stocked = frozenset(ids[name] for name in kitchen)
    return Problem(network, stocked, (ids[goal],), None, frozenset({"bowl", "pan"}))


CAKE = kitchen_problem(
    ["oven; hot"],
    "cake; baked",
    (["flour; in [bag]", "egg; cracked"], ["batter; in [bowl]"]),
    (["egg; whole"], ["egg; cracked"]),
    (["batter; in [bowl]", "oven; hot"], ["cake; baked"]),
    (["cake; frozen"], ["cake; baked"]),
    (["batter; frozen"], ["batter; in [bowl]"]),
)


def bought(problem: Problem) -> list[list[str]]:
    found = shopping_list(problem)
    assert found.outcome is None or found.outcome.status is Status.OPTIMAL
    return [[str(problem.network.objects[o]) for o in each.items] for each in found.lists]


def test_raw_things_are_bought_and_the_dish_is_not() -> None:
    """A frozen cake would be one thing, but the cake is what is to be made; frozen batter is sold."""
    assert bought(CAKE) == [["batter; frozen"], ["flour; in [bag]", "egg; whole"]]


def test_the_dish_is_proposed_when_nothing_else_is_left() -> None:
    problem = kitchen_problem(
        [], "cake; baked", (["cake; frozen"], ["cake; thawed"]), (["cake; thawed"], ["cake; baked"])
    )
    assert shopping_list(problem).offer is Offer.FOR_SALE  # nothing makes a cake out of anything else
    problem = kitchen_problem(
        [],
        "cake; baked",
        (["cake; cold"], ["cake; baked"]),
        (["cake; baked"], ["cake; cold"]),
        (["air; thin"], ["cake; of air"]),
    )
    found = shopping_list(problem)
    assert found.offer is Offer.DISH
    assert bought(problem) == [["cake; cold"]]


def test_the_goal_itself_comes_last() -> None:
    problem = kitchen_problem(
        ["air"], "cake", (["air", "cake"], ["cake", "crumbs"]), (["air"], ["cake; hot"])
    )
    found = shopping_list(problem)
    assert found.offer is Offer.GOAL
    assert bought(problem) == [["cake"]]


def test_something_of_a_cycle_is_bought_where_it_feeds_only_itself() -> None:
    problem = kitchen_problem(
        [],
        "bread; baked",
        (["dough; sour"], ["dough; fed"]),
        (["dough; fed"], ["dough; sour", "bread; baked"]),
    )
    found = shopping_list(problem)
    assert found.offer is Offer.CYCLE
    assert bought(problem) == [["dough; fed"], ["dough; sour"]]


def test_nothing_is_bought_where_the_kitchen_suffices(cli: Cli) -> None:
    ran = cli("shopping-list", "--goal", "ice")
    assert ran.code == 0
    assert "nothing has to be bought" in ran.out


def good_lists(problem: Problem, sold: list[int], allowed: oracle.Allowed) -> list[frozenset[int]]:
    """Give every set of things for sale that makes a tree possible."""
    good = []
    for size in range(len(sold) + 1):
        for items in combinations(sold, size):
            stocked = replace(problem, kitchen=problem.kitchen.union(items))
            if next(oracle.trees(stocked, allowed), None) is not None:
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
@pytest.mark.sampled(2)
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
        assert found.prices == prices

        def allowed(tree: tuple[object, ...], bound: int = bound) -> bool:
            return len(tree) <= bound

        left = good_lists(problem, sold, allowed)
        none += not left
        for each in found.lists:
            assert each.proved
            assert frozenset(each.items) in left
            assert each.price == sum(prices[o] for o in each.items)
            assert each.price == min(sum(prices[o] for o in items) for items in left)
            left = [items for items in left if not items.issuperset(each.items)]
        assert found.complete == (len(found.lists) < 3 or not found.lists[0].items)
        assert not (found.complete and left)
        if found.lists and found.lists[0].items:
            helped += 1
            assert found.outcome is not None
            assert found.outcome.units is not None
            tree = tuple(map(problem.network.unit, found.outcome.units))
            assert oracle.makes(found.outcome.problem, tree)
    assert helped > 5
    assert none


@pytest.mark.slow
def test_the_universal_whipped_cream_is_made_possible(cli: Cli, universal: Path) -> None:
    for rule in ContainerRule:
        words = ["shopping-list", "--data", universal, "--goal", "whipped cream", "--containers", rule]
        found = cli(*words, "--format", "json").json
        (first, *others) = found["lists"]
        assert [item["node"] for item in first["items"]] == [
            "mixing bowl; in [mixer]; contains {condensed milk,cream cheese,pudding mix}"
        ]
        assert (first["proved"], others, found["complete"], found["offer"]) == (True, [], True, "for sale")
        assert found["answer"]["status"] == "optimal"


def test_a_price_list_decides(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "prices.txt"
    file.write_text(
        "# market\ncocoa tin; contains {cocoa powder}\t4.50\npie crust; chilled\t1.5\npie crust\t2\n"
    )
    ran = cli("shopping-list", "--goal", "hot cocoa", "--goal", "apple pie", "--prices", file)
    assert ran.code == 0
    assert "2 object nodes for 6\n" in ran.out
    assert "cocoa tin; contains {cocoa powder}    4.50" in ran.out
    file.write_text("cocoa tin; contains {cocoa powder}\t100\nwhisk\t1\nwisk\t1\n")
    short = cli("shopping-list", "--goal", "hot cocoa", "--goal", "apple pie", "--prices", file)
    assert short.code == 1
    assert "no list of things with a price" in short.out
    assert "no node for sale has this label: wisk" in short.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("flour\n", "prices.txt:1:6: error: found the end of the line"),
        ("flour\tcheap\n", "prices.txt:1:7: error: found 'cheap', expected a price"),
        ("flour\t-1\n", "found '-1'"),
        ("\nflour\t1\nflour\t2\n", "prices.txt:3:1: error: found a second price"),
        ("flour; in [\t2\n", "error"),
    ],
)
def test_faults_of_a_price_list_have_places(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "prices.txt"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        read_prices(file)
    assert message in str(caught.value)


def test_a_whole_node_outbids_its_label(tmp_path: Path) -> None:
    file = tmp_path / "prices.txt"
    file.write_text("egg; whole\t3\negg\t1\nflour\t2\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        prices = shopping_list(CAKE, prices=file).prices
    assert prices is not None
    shown = {str(CAKE.network.objects[o]): int(price) for o, price in prices.items()}
    assert shown == {"egg; whole": 3, "flour; in [bag]": 2}


def test_what_is_for_sale() -> None:
    shop = Shop(CAKE)
    names = {str(node): o for o, node in enumerate(CAKE.network.objects)}
    assert {name for name, o in names.items() if shop.sells(o)} == {
        "flour; in [bag]",
        "egg; whole",
        "oven; hot",
        "cake; frozen",
        "batter; frozen",
    }
    assert {name for name, o in names.items() if shop.is_dish(o)} == {"cake; baked", "cake; frozen"}


PLATE = kitchen_problem(
    ["lemon; whole", "knife; clean"],
    "lemon; sliced; on [plate]",
    (["lemon; whole", "knife; clean"], ["lemon; sliced"]),
    (["lemon; sliced", "plate; empty"], ["lemon; sliced; on [plate]", "plate; contains {lemon}"]),
    (["plate; contains {lemon}"], ["lemon; sliced; on [plate]"]),
    (["plate; dirty", "soap"], ["plate; empty"]),
)


def test_what_is_empty_or_clean_is_for_sale_although_it_can_be_washed() -> None:
    assert ["plate; empty"] in bought(PLATE)
    assert ["plate; dirty", "soap"] in bought(PLATE)


@pytest.mark.parametrize("objective", ["units", "inputs"])
def test_among_lists_of_one_size_that_with_the_best_tree_comes_first(objective: str) -> None:
    problem = kitchen_problem(
        [],
        "tea; hot",
        (["water; cold"], ["water; hot"]),
        (["water; hot"], ["tea; hot"]),
        (["kettle; empty", "faucet; on"], ["tea; hot"]),
        (["faucet; off"], ["faucet; on"]),
        (["tap; off", "kettle; full"], ["tea; hot"]),
        (["tap; off"], ["kettle; full"]),
        (["teabag"], ["tea; hot"]),
    )
    found = shopping_list(problem, objective, lists=9)
    costs = [each.costs for each in found.lists]
    assert [(len(each.items), each.costs.units) for each in found.lists if each.costs is not None] == [
        (1, 1),
        (1, 2),
        (1, 2),
        (2, 2),
    ]
    assert [each.inputs for each in costs if each is not None] == [1, 2, 3, 3]
    assert found.complete
    first = shopping_list(problem, objective, lists=1)
    assert first.lists == found.lists[:1]
    assert not first.complete
    assert "there are more lists than these" in first.text()
    assert "or, list 2 (1 object node), with 2 units, 2 inputs:\n  water; cold\n" in found.text()
    assert "any other set of things on offer" in found.text()


@pytest.mark.slow
@pytest.mark.parametrize("folder", [None, CORPUS / "universal"])
@pytest.mark.filterwarnings("ignore")
def test_a_kitchen_item_that_is_taken_away_is_on_a_list(folder: Path | None) -> None:
    """In 95 of 100 cases: all goals of the goals files, and each item they cannot do without."""
    if folder is not None and not folder.is_dir():
        pytest.skip(f"the real corpus is not at {CORPUS}")
    found = list(cases(foon_asp.load(folder), 3, list(ContainerRule)))
    assert len(found) > 20
    assert sum(case.place is not None for case in found) >= 0.95 * len(found)


@STRUCK_WHILE_READING
def test_a_limit_is_told(cli: Cli) -> None:
    ran = cli("shopping-list", "--goal", "hot cocoa", "--time-limit", "0")
    assert ran.code == 3


def test_a_rule_that_says_something_else_once_things_are_bought() -> None:
    """While everything is for sale, something can be fried; once flour is bought, nothing can."""
    problem = kitchen_problem([], "dough", (["flour"], ["dough"]), (["egg"], ["omelet"]))
    with pytest.raises(UserError, match="no shopping list can be found under it"):
        shopping_list(problem, constraints=[":- use(U), #count { V : unit(V) } < 2."])
