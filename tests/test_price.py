"""The objective ``price``: the least sum of exact prices of units."""

import json
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.session import Session
from foon_asp.certificate import certify
from foon_asp.engines import Asked, DisagreementError, EngineAnswer, cross_check
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, UnitPrices, network_at_level
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof import verify
from foon_asp.questions.menu import menu
from foon_asp.questions.pareto import pareto
from foon_asp.reduce import ALL, NONE, Reduction
from foon_asp.report.disagreement import disagreement_files
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import find_data, read_data
from tests import oracle
from tests.conftest import Cli
from tests.handmade_certificate import before_rules
from tests.random_problems import (
    FREE,
    HUGE,
    LONG,
    MOTIONS,
    PRICES,
    TINY,
    random_prices,
    random_problem,
    random_steps,
)
from tests.test_exact_success import two_ways
from tests.test_optimum import assert_agrees
from tests.test_pareto import assert_agrees as assert_front_agrees

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

BY = (Objective.PRICE,)
RULES = list(ContainerRule)
FAMILIES = {"sums": PRICES, "free": FREE, "tiny": TINY, "huge": HUGE, "long": LONG}


def ways(one: list[str], other: list[str]) -> Problem:
    """Ask for a goal with two chains of units that make it, at these prices."""
    problem = two_ways(["1"] * len(one), ["1"] * len(other))
    prices = dict(zip(problem.network.motions, map(Fraction, (*one, *other)), strict=True))
    return replace(problem, unit_prices=UnitPrices(prices, {}))


def priced(network: Network, family: tuple[str, ...], seed: int) -> UnitPrices:
    """Draw prices of one family for all motions, and for some units."""
    drawn = random_prices(network, seed)
    places = {price: place for place, price in enumerate({*drawn.motions.values(), *drawn.units.values()})}

    def other(price: Fraction) -> Fraction:
        return Fraction(family[(places[price] + seed) % len(family)])

    return UnitPrices(
        {motion: other(price) for motion, price in drawn.motions.items()},
        {unit: other(price) for unit, price in drawn.units.items()},
    )


# --- by hand

LARGEST = str(2**31 - 1)
HANDS: list[tuple[list[str], list[str], int]] = [
    (["0.1", "0.2"], ["0.4"], 0),
    (["0.1", "0.2"], ["0.3"], 1),  # as cheap, with fewer units
    (["0.1", "0.2"], ["0.30000000000000004"], 0),
    (["0.1", "0.2"], ["0.29999999999999999"], 1),
    (["0", "0"], ["0.0000000000000000000000000000001"], 0),
    (["0", "0", "0"], ["0"], 1),
    (["0", "0"], ["0", "0"], 0),
    ([LARGEST, LARGEST, LARGEST], [str(3 * (2**31 - 1) + 1)], 0),  # the sums do not fit 32 bits
    ([LARGEST, LARGEST, LARGEST], [str(3 * (2**31 - 1) - 1)], 1),
    (["4294967296", "0.5"], ["1"], 1),  # 2**32, which wraps to 0
    (["1" + "0" * 40, "0.1"], ["1" + "0" * 40 + ".2"], 0),
    (["1" + "0" * 40, "0.1"], ["1" + "0" * 40], 1),
    (["0." + "0" * 29 + "1"] * 2, ["0." + "0" * 29 + "3"], 0),
    (["0." + "12" * 20, "0." + "34" * 20], ["0." + "46" * 19 + "47"], 0),
    (["0." + "12" * 20, "0." + "34" * 20], ["0." + "46" * 20], 1),
    (["9" * 999, "1"], ["1" + "0" * 999 + "." + "0" * 998 + "1"], 0),
]


@pytest.mark.parametrize("reductions", [ALL, *(frozenset({one}) for one in Reduction), NONE])
@pytest.mark.parametrize(("one", "other", "best"), HANDS)
@pytest.mark.sampled(3)
def test_sums_are_compared_to_the_last_digit(
    one: list[str], other: list[str], best: int, reductions: frozenset[Reduction]
) -> None:
    problem = ways(one, other)
    chosen, units = (one, range(len(one))) if best == 0 else (other, range(len(one), len(one) + len(other)))
    found = solve(problem, BY, Settings(reductions=reductions))
    assert found.status is Status.OPTIMAL
    assert found.costs is not None
    least = sum(map(Fraction, chosen))
    assert (found.costs.measure(Objective.PRICE), found.costs.units) == (least, len(chosen))
    assert sorted(found.units or ()) == [*units] or len(one) == len(other)
    assert found.bounds[Objective.PRICE] == least
    certificate = certify(problem, (*BY, Objective.UNITS), found.units or ())
    assert certificate is not None
    given = problem.network, problem.kitchen, problem.rates, problem.utensils
    assert verify.verify(certificate.content, *given, problem.unit_prices).costs == (least, len(chosen))
    with pytest.raises(verify.RefusedError, match="prices: not the one that the certificate is about"):
        verify.verify(certificate.content, *given)


# --- against brute force


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("make", [random_problem, random_steps])
@pytest.mark.sampled(20)
def test_the_best_are_those_of_brute_force_in_every_room(
    make: Callable[[int, ContainerRule], Problem], rule: ContainerRule, family: str
) -> None:
    said: Counter[object] = Counter()
    for seed in range(8):
        problem = make(seed, rule)
        problem = replace(problem, unit_prices=priced(problem.network, FAMILIES[family], seed))
        trees = list(oracle.trees(problem))
        for reductions in (ALL, NONE):
            assert_agrees(problem, ["price"], trees, Settings(reductions=reductions))
        second = ("units", "inputs", "kitchen", "inputs+ingredients")[seed % 4]
        assert_agrees(problem, ["price", second], trees)
        assert_agrees(problem, [second, "price"], trees, Settings(encodings=Path("by_need")))
        found = solve(problem, BY)
        if found.units is None:
            continue
        least = oracle.best(trees, problem, ["price"])
        assert least is not None
        certificate = certify(problem, (*BY, Objective.UNITS), found.units)
        assert certificate is not None
        given = problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices
        proved = verify.verify(verify.read_certificate(certificate.text()), *given)
        assert (proved.claim, proved.costs) == ("optimal", least)
        for check in cross_check(Asked(found)) if seed % 4 == 0 else ():
            said[check.engine, check.reason] += 1
            assert check.engine != "clingo" or check.reason is None
        if seed % 4 == 1:
            assert_front_agrees(pareto(problem, "units,price"), trees)
    assert said["clingo", None]


@pytest.mark.parametrize("rule", RULES)
def test_in_a_session_under_a_constraint_that_comes_and_goes(rule: ContainerRule) -> None:
    session = Session()
    solved = 0
    for seed in (3, 5, 8):
        base = random_steps(seed, rule)
        for family in FAMILIES.values():
            problem = replace(base, unit_prices=priced(base.network, family, seed))
            motion = MOTIONS[seed % len(MOTIONS)]
            trees = list(oracle.trees(problem, lambda tree, word=motion: all(u.motion != word for u in tree)))  # type: ignore[misc]
            constant = (f"forbidden_motion={motion}",)
            settings = Settings((Path("forbid_motion"),), constants=constant, session=session)
            assert_agrees(problem, ["price"], trees, settings)
            solved += bool(trees)
    assert solved > 3


# --- fronts, menus, levels, stores


def test_a_menu_adds_prices_up_and_a_front_trades_them() -> None:
    problem = ways(["0.1", "0.2"], ["0.5"])
    found = pareto(problem, "units,price")
    assert [point.costs.key((Objective.UNITS, *BY)) for point in found.points] == [
        (1, Fraction(1, 2)),
        (2, Fraction(3, 10)),
    ]
    kitchen = next(iter(problem.kitchen))
    assert "price 0.3" in menu(replace(problem, goals=(*problem.goals, kitchen)), "price").text()


def test_a_bound_on_sums_that_wrap_is_refused() -> None:
    """The best tree by success costs 2^31: clingo took "above 2^31 - 1" for "from -2^31 on"."""
    problem = two_ways(["1", "1"], ["0.5"])
    prices = dict(zip(problem.network.motions, map(Fraction, ("2147483647", "1", "2")), strict=True))
    asked = replace(problem, unit_prices=UnitPrices(prices, {}))
    with pytest.raises(UserError, match="by the objective price all units together cost more than fits"):
        pareto(asked, "success,price")
    assert len(pareto(asked, "units,price").points) == 1  # what leads needs no bound


def test_a_bound_on_sums_that_just_fit() -> None:
    problem = two_ways(["1", "1"], ["0.5"])
    prices = dict(zip(problem.network.motions, map(Fraction, ("2147483644", "1", "2")), strict=True))
    points = pareto(replace(problem, unit_prices=UnitPrices(prices, {})), "success,price").points
    assert [point.costs.measure(Objective.PRICE) for point in points] == [2147483645, 2]


@pytest.mark.parametrize("level", [1, 2])
@pytest.mark.parametrize("rule", RULES)
def test_below_level_3_the_least_counts_and_is_proved(level: int, rule: ContainerRule) -> None:
    proved = 0
    for seed in range(16):
        plain = random_steps(seed, rule) if seed % 2 else random_problem(seed, rule)
        network = network_at_level(plain.network, level)
        places = {o: place for place, of in enumerate(network.objects_stand_for) for o in of}
        kitchen = frozenset(places[o] for o in plain.kitchen)
        goals = tuple(places[o] for o in plain.goals)
        problem = replace(plain, network=network, kitchen=kitchen, goals=goals)
        by_hand = []
        for details in network.stands_for:
            units = [plain.network.unit(detail) for detail in details]
            by_hand.append(min(oracle.measure(plain, (unit,), "price") for unit in units))
        assert list(problem.prices) == by_hand
        found, without = solve(problem, BY), solve(problem, BY, Settings(reductions=NONE))
        assert (found.costs is None) == (without.costs is None)
        if found.units is None or found.costs is None or without.costs is None:
            continue
        assert found.costs.key((*BY, Objective.UNITS)) == without.costs.key((*BY, Objective.UNITS))
        assert found.costs.measure(Objective.PRICE) == sum(by_hand[unit] for unit in found.units)
        certificate = certify(problem, (*BY, Objective.UNITS), found.units)
        assert certificate is not None
        given = network, kitchen, problem.rates, problem.utensils, problem.unit_prices
        claim = verify.verify(certificate.content, *given)
        assert (claim.claim, claim.level) == ("optimal", level)
        proved += 1
    assert proved > 5


@pytest.fixture
def kitchen(tmp_path: Path) -> Path:
    """Give the bundled kitchen's macaroni with prices: by motion, and a unit that is free."""
    motions = read_data(find_data(foon_asp_kitchen())).network.motions
    lines = [f"{motion}\t0.{place % 9 + 1}" for place, motion in enumerate(dict.fromkeys(motions))]
    file = tmp_path / "prices.txt"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def foon_asp_kitchen() -> Path:
    return Path(foon_asp.__file__).parents[1] / "data" / "kitchen"


def test_text_and_store_give_the_same_answer_and_certificate(kitchen: Path, tmp_path: Path, cli: Cli) -> None:
    store = tmp_path / "kitchen.foon"
    import_files(find_data(foon_asp_kitchen())._replace(unit_prices=kitchen), store)
    asked = ("--goal", "macaroni", "--objective", "price")
    text = "--unit-prices", str(kitchen)
    shown = cli("solve", *text, *asked)
    assert shown.code == 0
    headline = shown.out.split("\n")[1]
    assert headline.startswith("optimal by price (strict containers): ")
    assert ", price " in headline
    as_json = json.loads(cli("solve", *text, *asked, "--format", "json").out)
    stored = json.loads(cli("solve", "--network", str(store), *asked, "--format", "json").out)
    assert stored["costs"] == as_json["costs"]
    assert stored["lower_bound"]["price"] == as_json["costs"]["price"]
    proof = str(tmp_path / "proof.json")
    assert cli("solve", "--network", str(store), *asked, "--certificate", proof).code == 0
    assert cli("verify", proof, *text).code == 0
    assert cli("verify", proof, "--network", str(store)).code == 0
    refused = cli("verify", proof)
    assert (refused.code, "prices: not the one" in refused.out) == (1, True)


# --- what is refused


def test_it_needs_prices_of_all_units_and_no_other_objective_that_is_rounded(cli: Cli, kitchen: Path) -> None:
    ran = cli("solve", "--goal", "macaroni", "--objective", "price")
    assert (ran.code, "the objective price needs the prices of the units" in ran.err) == (2, True)
    lines = kitchen.read_text().split("\n")
    kitchen.write_text("\n".join(lines[1:]))
    prices = ("--unit-prices", str(kitchen))
    ran = cli("solve", "--goal", "macaroni", "--objective", "price", *prices)
    assert ran.code == 2
    assert f"error: the unit {lines[0].split(chr(9))[0]!r} has no price" in ran.err
    assert cli("solve", "--goal", "macaroni", *prices).code == 0
    problem = ways(["1" + "0" * 40, "0.1"], ["1"])
    rates = {motion: Fraction(7 * 10**9 + 1 + n, 10**10) for n, motion in enumerate(problem.network.motions)}
    with pytest.raises(UserError, match="the objectives price and attempts have to be rounded"):
        solve(replace(problem, rates=rates), (*BY, Objective.ATTEMPTS), Settings(reductions=NONE))


def forged(problem: Problem, **values: Any) -> Any:
    """Change a certificate of the first way, and seal it anew."""
    certificate = certify(problem, (*BY, Objective.UNITS), (0, 1))
    assert certificate is not None
    content = {**certificate.content, **values}
    return {**content, "seal": verify.seal(content)}


def test_certificates_by_wrong_prices_are_refused() -> None:
    problem = ways(["0.1", "0.2"], ["0.5"])
    prices = problem.unit_prices
    assert prices is not None
    given = problem.network, problem.kitchen, problem.rates, problem.utensils
    right = forged(problem)
    assert verify.verify(right, *given, prices).costs == (Fraction(3, 10), 2)
    for costs in (["1/5", 2], ["3/10", 3], [0, 2], ["0.3", 2]):
        with pytest.raises(verify.RefusedError, match="the tree costs"):
            verify.verify(forged(problem, costs=costs), *given, prices)
    digests = {name: digest for name, digest in right["digests"].items() if name != "prices"}
    old = before_rules(forged(problem, version=2, digests=digests))
    old["seal"] = verify.seal(old)
    with pytest.raises(verify.RefusedError, match="a claim needs prices, but none are given"):
        verify.verify(old, *given, prices)
    one, two, other = problem.network.motions
    unit = problem.network.unit
    free = FunctionalUnit("one 0", unit(0).inputs, unit(0).inputs)  # of no unit here, and so of no account
    for wrong, said in (
        (None, "a claim needs prices, but none are given"),
        (UnitPrices({one: Fraction(1, 10), two: Fraction(1, 5)}, {}), "a unit has none of the prices"),
        (UnitPrices({**prices.motions, other: Fraction(-1)}, {}), "one of the prices is below 0"),
        (UnitPrices(prices.motions, {unit(2): Fraction(1, 5)}), "carries more than it costs|do not add up"),
        (UnitPrices(prices.motions, {unit(0): Fraction(0)}), "the tree costs"),
    ):
        content = forged(problem, digests=verify.digests(*given, wrong))
        with pytest.raises(verify.RefusedError, match=said):
            verify.verify(content, *given, wrong)
    also = UnitPrices(prices.motions, {free: Fraction(0), unit(2): Fraction(1, 2)})
    content = forged(problem, digests=verify.digests(*given, also))
    assert verify.verify(content, *given, also).claim == "optimal"


def test_a_disagreement_is_written_with_its_prices(tmp_path: Path) -> None:
    problem = ways(["0.1", "0.2"], ["0.5"])
    unit = problem.network.unit(2)
    problem = replace(
        problem,
        unit_prices=UnitPrices((problem.unit_prices or UnitPrices({}, {})).motions, {unit: Fraction(1, 8)}),
    )
    found = solve(problem, BY)
    liar = DisagreementError("it lies", EngineAnswer("Liar", BY, (0, 1), True))
    for name, text in disagreement_files(Asked(found), liar).items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    again = read_data(find_data(tmp_path))
    assert again.unit_prices == problem.unit_prices
    assert foon_asp.load(tmp_path).problem("goal;").prices == problem.prices
