"""How wrong rates may be: cases checked by hand, and every end held against all trees of small networks."""

import random
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Status
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Problem
from foon_asp.problem.root import Root
from foon_asp.questions.ending import Ending
from foon_asp.questions.flip import Flip
from foon_asp.questions.sensitivity import RateEnd, RateInterval, Sensitivity, sensitivity
from foon_asp.resources import encodings_folder
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.questions.test_alternatives import choosing
from tests.support.random_problems import (
    MOTIONS,
    NEAR_0,
    NEAR_1,
    POWERS,
    RATES,
    UTENSILS,
    random_problem,
    random_steps,
)

RULES = list(ContainerRule)
Way = tuple[str, ...]
Rates = Mapping[str, str | Fraction]


def ways(rates: Rates, *each: Way) -> Problem:
    """Make one thing by each of some ways, one motion after another."""
    units: list[tuple[str, str, str]] = []
    for number, motions in enumerate(each):
        between = [f"dough; {number}.{step}" for step in range(1, len(motions))]
        units += zip(motions, ["flour", *between], [*between, "bread"], strict=True)
    foon = foon_asp.build(units, kitchen="flour", goals="bread", utensils=UTENSILS)
    return replace(foon.problem(), rates={motion: Fraction(rate) for motion, rate in rates.items()})


def found(result: Sensitivity, motion: str) -> RateInterval:
    (interval,) = (each for each in result.intervals if each.motion == motion)
    return interval


def ends(result: Sensitivity, motion: str) -> tuple[Root | None, Root | None]:
    interval = found(result, motion)
    assert interval.proved
    return root(interval.below), root(interval.above)


def root(end: RateEnd) -> Root | None:
    return None if end.at is None else Root(end.at.root, Fraction(end.at.of))


def flips(interval: RateInterval) -> list[Flip]:
    """Give the rates at which another tree is as good."""
    sides = [(root(interval.below), False), (root(interval.above), True)]
    return [Flip(interval.rate, at, above) for at, above in sides if at is not None]


# --- By hand.


def test_two_ways_that_differ_by_one_motion_each() -> None:
    """0.8 against 0.6: mixing may sink to 0.6, and cutting rise to 0.8."""
    result = sensitivity(ways({"mix": "0.8", "cut": "0.6"}, ("mix",), ("cut",)))
    assert ends(result, "mix") == (Root(1, Fraction(3, 5)), None)
    assert ends(result, "cut") == (None, Root(1, Fraction(4, 5)))
    assert result.first is not None
    assert (result.first.motion, result.first.side) == ("mix", "below")  # -25 % and not +33.3 %
    assert result.ending is Ending.DONE
    assert "\n   0.6     0  0.8  cut (0)  +33.3 %: - mix  + cut\n" in result.text()
    assert "\nflips first: mix, below 0.6 (-25 %); measure it before others\n" in result.text()


def test_an_end_that_is_a_root() -> None:
    """Mixing twice, 0.81, against 0.5: the end is the root of 0.5, and is rounded inwards."""
    result = sensitivity(ways({"mix": "0.9", "cut": "0.5"}, ("mix", "mix"), ("cut",)))
    assert ends(result, "mix") == (Root(2, Fraction(1, 2)), None)
    at = found(result, "mix").below.at
    assert at is not None
    assert at.inwards == Fraction("0.7072")
    assert "below 0.7072 (-21.4 %)" in result.text()
    end = result.json()["intervals"][0]["below"]
    assert (end["at"]["root"], end["at"]["of"], end["at"]["inwards"]["exact"]) == (2, "1/2", "442/625")
    assert end["beyond"]["costs"]["success"]["exact"] == "1/2"


def test_a_way_that_is_as_good_flips_at_no_change() -> None:
    """0.9 * 0.9 = 0.81: the tree with one unit is given, and any change of one rate decides."""
    result = sensitivity(ways({"mix": "0.9", "cut": "0.81"}, ("mix", "mix"), ("cut",)))
    assert result.answer.costs is not None
    assert result.answer.costs.units == 1
    assert ends(result, "cut") == (Root(1, Fraction(81, 100)), None)
    assert ends(result, "mix") == (None, Root(1, Fraction(9, 10)))
    assert "  0.9  mix (0)  0 %: - cut  + mix (2)\n" in result.text()


def test_a_way_that_is_as_good_all_along_is_not_beyond() -> None:
    result = sensitivity(ways({"mix": "0.9", "cut": "1"}, ("mix", "cut"), ("mix",)))
    assert not any(interval.flips for interval in result.intervals)
    assert result.first is None
    assert "there is nothing to measure" in result.text()


def test_what_no_tree_needs_changes_nothing() -> None:
    units = [("mix", "flour", "bread"), ("cut", "flour", "dust")]
    foon = foon_asp.build(units, kitchen="flour", goals="bread", rates={"mix": 0.9, "cut": 0.5})
    result = sensitivity(foon.problem())
    assert result.others == ("cut",)
    assert [interval.motion for interval in result.intervals] == ["mix"]
    assert "at any rate: mix, 1 motion that the tree does not have" in result.text()


def test_nothing_to_do_and_nothing_to_be_done() -> None:
    problem = ways({"mix": "0.9"}, ("mix",))
    result = sensitivity(replace(problem, goals=tuple(problem.kitchen)))
    assert (result.ending, result.intervals, result.others) == (Ending.DONE, (), ("mix",))
    nothing = sensitivity(replace(problem, kitchen=frozenset()))
    assert (nothing.ending, nothing.intervals, nothing.first) == (Ending.NEGATIVE, (), None)
    assert "infeasible" in nothing.text()


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"rates": None}, "needs the success rates"),
        ({"rates": {"mix": Fraction(0)}}, "found 0 for the success rate of 'mix'"),
        ({"own_rates": {0: Fraction(0)}}, "found 0 for the success rate of a unit"),
    ],
)
def test_rates_are_needed_and_above_0(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(UserError, match=message):
        sensitivity(replace(ways({"mix": "0.9"}, ("mix",)), **changed))


# --- Against all trees.


def line(problem: Problem, tree: Sequence[FunctionalUnit], motion: str) -> tuple[int, Fraction]:
    """Give how often the rate of a motion counts in a tree, and the product of the others."""
    power, rest = 0, Fraction(1)
    assert problem.rates is not None
    for unit in tree:
        number = problem.network.unit_id(unit)
        assert number is not None
        if number in problem.own_rates:
            rest *= problem.own_rates[number]
        elif unit.motion == motion:
            power += 1
        else:
            rest *= problem.rates[unit.motion]
    return power, rest


def assert_agrees(result: Sensitivity, trees: Sequence[tuple[FunctionalUnit, ...]]) -> tuple[int, int]:
    """Hold every end against all trees; give how many ends there are, and how many are no rational number."""
    problem, units = result.answer.problem, result.answer.ids
    if not trees:
        assert (result.answer.status, result.intervals) == (Status.INFEASIBLE, ())
        return 0, 0
    assert units is not None
    assert problem.rates is not None
    assert {*(interval.motion for interval in result.intervals), *result.others} == {*problem.network.motions}
    number = irrational = 0
    for motion in sorted(set(problem.network.motions)):
        power, rest = line(problem, list(map(problem.network.unit, units)), motion)
        lines = {(*line(problem, tree, motion), len(tree)) for tree in trees}
        tops = [(Root.simplify(p - power, rest / r), p, -n) for p, r, n in lines if p > power and rest < r]
        bottoms = [(Root.simplify(power - p, r / rest), -p, -n) for p, r, n in lines if p < power]
        top, bottom = min(tops, default=None), max(bottoms, default=None)
        # of those that meet at one end the one that is the best beyond, and with the fewest units
        if top is not None:
            top = max(each for each in tops if each[0] == top[0])
        if motion in result.others:
            assert top is bottom is None or not power
            assert top is None
            continue
        interval = found(result, motion)
        assert interval.proved
        assert (interval.rate, interval.units) == (problem.rates[motion], power)
        assert (root(interval.below), root(interval.above)) == (bottom and bottom[0], top and top[0])
        for end, expected, sign in ((interval.below, bottom, -1), (interval.above, top, 1)):
            if expected is None or end.beyond is None or end.at is None:
                assert end.beyond is None
                continue
            beyond = list(map(problem.network.unit, problem.network.units_of_numbers(end.beyond.ids)))
            assert set(beyond) in map(set, trees)
            assert (line(problem, beyond, motion)[0], len(beyond)) == (sign * expected[1], -expected[2])
            number += 1
            irrational += end.at.root > 1
            assert {*end.beyond.new} == {*end.beyond.ids} - {*(step.id for step in result.answer.units or ())}
        for flip in flips(interval):
            inwards = Root(1, flip.inwards)
            assert flip.at >= inwards >= Root(1, interval.rate) or flip.at <= inwards <= Root(
                1, interval.rate
            )
    every = [flip for interval in result.intervals for flip in flips(interval)]
    if every:
        assert result.first is not None
        first = flips(result.intervals[0])[0 if result.first.side == "below" else -1]
        assert result.first.motion == result.intervals[0].motion
        assert first.change(60)[0] <= min(flip.change(60)[1] for flip in every)
    assert result.text()
    assert result.json()["intervals"] or not result.intervals
    return number, irrational


def random_ways(seed: int, rule: ContainerRule) -> Problem:
    """Make one thing by ways that have a few motions again and again: so there are roots."""
    rng = random.Random(f"ways {seed}")
    motions = MOTIONS[:3]
    family = rng.choice((RATES, RATES, NEAR_1, NEAR_0, POWERS))
    rates = {motion: rng.choice(family) for motion in motions}
    each = [tuple(rng.choice(motions) for _ in range(length)) for length in rng.sample((1, 2, 2, 3, 4), 3)]
    return replace(ways(rates, *each), containers=rule)


def drawn(seed: int, rule: ContainerRule) -> Problem:
    problem = (random_ways, choosing, random_ways, random_steps, random_problem)[seed % 5](seed, rule)
    if seed % 4 == 1:  # some units have rates of their own
        rng = random.Random(seed)
        some = rng.sample(range(len(problem.network)), len(problem.network) // 3)
        problem = replace(problem, own_rates={unit: Fraction(rng.randint(1, 9), 9) for unit in some})
    return problem


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seeds", [range(10), pytest.param(range(10, 150), marks=pytest.mark.slow)])
@pytest.mark.default_cases("seeds0-strict", "seeds0-implied")
def test_every_end_is_that_of_all_trees(rule: ContainerRule, seeds: range) -> None:
    counts = []
    for seed in seeds:
        problem = drawn(seed, rule)
        counts.append(assert_agrees(sensitivity(problem), list(task_trees.trees(problem))))
    assert sum(number for number, _ in counts) > len(seeds)
    assert sum(irrational for _, irrational in counts) > len(seeds) // 20


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seeds", [range(2), pytest.param(range(2, 40), marks=pytest.mark.slow)])
def test_ends_under_a_constraint(rule: ContainerRule, seeds: range) -> None:
    for seed in seeds:
        problem = drawn(seed, rule)
        motion = random.Random(seed).choice(MOTIONS)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return any(unit.motion == motion for unit in tree)

        result = sensitivity(problem, constraints="require_motion", constants={"required_motion": motion})
        assert_agrees(result, list(task_trees.trees(problem, allowed)))


# --- Rules, limits, and faults.


def test_a_constraint_sees_the_rates_that_are_given() -> None:
    """A motion must succeed in 0.5: which trees there are stays, whatever rate is asked about."""
    problem = ways({"mix": "0.9", "cut": "0.6", "bake": "0.4"}, ("mix",), ("cut",), ("bake",))
    result = sensitivity(problem, constraints="least_rate:least_rate=500000", encodings="by_need")
    assert ends(result, "mix") == (Root(1, Fraction(3, 5)), None)
    assert ends(result, "cut") == (None, Root(1, Fraction(9, 10)))
    assert ends(result, "bake") == (None, None)  # never in a tree, and without the constraint from 0.9 on


def test_a_constraint_that_looks_at_weights_is_refused() -> None:
    with pytest.raises(UserError, match="uses risk/2"):
        sensitivity(foon_asp.load().problem("ice"), constraints=":- use(U), risk(U,W), W > 100000000.")


def test_encodings_that_are_not_ours_are_refused(tmp_path: Path) -> None:
    """They would be asked at other rates, too, and the answers be taken for what success is."""
    text = (encodings_folder() / "objectives.lp").read_text()
    (tmp_path / "objectives.lp").write_text(text.replace("{ W@P,U ", "{ -W@P,U "))
    with pytest.raises(UserError, match="it is not known what these encodings measure"):
        sensitivity(ways({"mix": "0.9", "cut": "0.6"}, ("mix",), ("cut",)), encodings=tmp_path)


# --- The command.


@STRUCK_WHILE_READING
def test_exit_codes_and_what_is_printed(cli: Cli) -> None:
    ran = cli("sensitivity", "--goal", "macaroni")
    assert ran.code == 0
    assert "  -5.36 %: - fill, switch on, pour  + fill, heat\n" in ran.out
    for words, code in (
        (["--goal", "apple pie"], 1),
        (["--goal", "tea", "--time-limit", "0"], 3),
        (["--goal", "tea", "--objective", "units"], 2),
    ):
        assert cli("sensitivity", *words).code == code


def test_on_the_universal_foon(cli: Cli, universal: Path) -> None:
    """A tree that pours three times, and one that pours once: the end is a root."""
    words = ("sensitivity", "--data", universal, "--containers", "implied", "--goal", "macaroni")
    (first, *_) = cli(*words, "--format", "json").json["intervals"]
    assert (first["motion"], first["below"]["at"]["root"], first["below"]["at"]["of"]) == (
        "pour",
        2,
        "18/125",
    )
