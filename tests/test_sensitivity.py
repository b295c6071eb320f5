"""How wrong rates may be: cases checked by hand, and every end held against all trees of small networks."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Outcome, Status, solve
from foon_asp.errors import BugError, UserError
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.problem.root import Root
from foon_asp.questions.result import Ending
from foon_asp.questions.sensitivity import Sensitivity, sensitivity
from foon_asp.questions.sensitivity.interval import End, Interval
from foon_asp.resources import bundled_kitchen, encodings_folder
from tests import oracle
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.random_problems import (
    MOTIONS,
    NEAR_0,
    NEAR_1,
    POWERS,
    RATES,
    UTENSILS,
    random_problem,
    random_steps,
)
from tests.stopped_search import stopped_after
from tests.test_alternatives import choosing

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

RULES = list(ContainerRule)
Way = tuple[str, ...]


def ways(rates: dict[str, str], *each: Way) -> Problem:
    """Make one thing by each of some ways, one motion after another."""
    builder = NetworkBuilder()
    flour, bread = ObjectNode.of("flour"), ObjectNode.of("bread")
    line = 0
    for number, motions in enumerate(each):
        between = [ObjectNode.of("dough", [f"{number}.{step}"]) for step in range(1, len(motions))]
        nodes = [flour, *between, bread]
        for motion, node, after in zip(motions, nodes, nodes[1:], strict=False):
            builder.add(motion, [node], [after], Source("ways", line := line + 1))
    network = builder.build()
    kitchen, goal = network.object_id(flour), network.object_id(bread)
    assert kitchen is not None
    assert goal is not None
    exact = {motion: Fraction(rate) for motion, rate in rates.items()}
    return Problem(network, frozenset([kitchen]), (goal,), exact, UTENSILS, ContainerRule.STRICT)


def found(result: Sensitivity, motion: str) -> Interval:
    (interval,) = (each for each in result.intervals if each.motion == motion)
    return interval


def ends(result: Sensitivity, motion: str) -> tuple[Root | None, Root | None]:
    interval = found(result, motion)
    assert interval.proved
    return interval.below.at, interval.above.at


# --- By hand.


def test_two_ways_that_differ_by_one_motion_each() -> None:
    """0.8 against 0.6: mixing may sink to 0.6, and cutting rise to 0.8."""
    result = sensitivity(ways({"mix": "0.8", "cut": "0.6"}, ("mix",), ("cut",)))
    assert ends(result, "mix") == (Root(1, Fraction(3, 5)), None)
    assert ends(result, "cut") == (None, Root(1, Fraction(4, 5)))
    assert result.first is not None
    assert (result.first.interval.motion, result.first.above) == ("mix", False)  # -25 % and not +33.3 %
    assert result.ending is Ending.DONE
    assert result.text().splitlines()[2:] == [
        "one rate may be wrong between these ends, each proved",
        "",
        "  rate  from   to  motion",
        "   0.8   0.6    1  mix",
        "      below 0.6 (-25 %): - mix  + cut",
        "   0.6     0  0.8  cut (0)",
        "      above 0.8 (+33.3 %): - mix  + cut",
        "",
        "flips first: mix, below 0.6 (-25 %); measure it before",
        "  others",
    ]


def test_an_end_that_is_a_root() -> None:
    """Mixing twice, 0.81, against 0.5: the end is the root of 0.5, and is rounded inwards."""
    result = sensitivity(ways({"mix": "0.9", "cut": "0.5"}, ("mix", "mix"), ("cut",)))
    assert ends(result, "mix") == (Root(2, Fraction(1, 2)), None)
    flip = found(result, "mix").flips[0]
    assert flip.inwards == Fraction("0.7072")
    assert "below 0.7072 (-21.4 %)" in result.text()
    end = result.json()["intervals"][0]["below"]
    assert (end["at"]["root"], end["at"]["of"], end["at"]["inwards"]["exact"]) == (2, "1/2", "442/625")
    assert end["beyond"]["costs"]["success"]["exact"] == "1/2"


def test_a_third_way_comes_between_two() -> None:
    """Far below, the way without mixing is the best; nearer by, one that mixes once is: it comes first."""
    rates = {"mix": "0.9", "cut": "0.7", "bake": "0.3"}
    result = sensitivity(ways(rates, ("mix",) * 3, ("mix", "cut"), ("bake",)))
    assert ends(result, "mix") == (Root(2, Fraction(7, 10)), None)
    beyond = found(result, "mix").below.beyond
    assert beyond is not None
    assert sorted(result.outcome.problem.network.motions[unit] for unit in beyond) == ["cut", "mix"]


def test_a_way_that_is_as_good_flips_at_no_change() -> None:
    """0.9 * 0.9 = 0.81: the tree with one unit is given, and any change of one rate decides."""
    result = sensitivity(ways({"mix": "0.9", "cut": "0.81"}, ("mix", "mix"), ("cut",)))
    assert result.outcome.costs is not None
    assert result.outcome.costs.units == 1
    assert ends(result, "cut") == (Root(1, Fraction(81, 100)), None)
    assert ends(result, "mix") == (None, Root(1, Fraction(9, 10)))
    assert "above 0.9 (0 %)" in result.text()


def test_a_way_that_is_as_good_all_along_is_not_beyond() -> None:
    result = sensitivity(ways({"mix": "0.9", "cut": "1"}, ("mix", "cut"), ("mix",)))
    assert all(interval.flips == () for interval in result.intervals)
    assert result.first is None
    assert "there is nothing to measure" in result.text()


def test_hardly_any_rate_is_small_enough_for_the_other_way() -> None:
    """Of all trees one mixes less often, and is better only far below: that is found all the same."""
    rates = {"mix": "0.5", "cut": "0.00000000000001"}
    result = sensitivity(ways(rates, ("mix", "mix"), ("mix", "cut"), ("cut", "cut", "cut")))
    assert ends(result, "mix") == (Root(1, Fraction(1, 10**14)), None)
    alone = sensitivity(ways(rates, ("mix", "mix"), ("mix", "mix", "cut")))
    assert ends(alone, "mix") == (None, None)


def test_changes_on_two_sides_are_compared_exactly() -> None:
    def interval(rate: str, below: Root | None, above: Root | None) -> Interval:
        return Interval("mix", Fraction(rate), 1, End(below, ()), End(above, ()))

    half, more = Root(1, Fraction(1, 3)), Root(1, Fraction(2, 3))
    low, high = sorted(interval("0.5", half, more).flips, key=lambda flip: flip.above)
    assert not low < high  # a third on both sides, which no decimal tells apart
    assert not high < low
    rooted = Root.taken(2, Fraction(1, 4) * Fraction(16, 9) + Fraction(1, 10**40))
    (near,) = interval("0.5", None, rooted).flips
    assert high < near
    assert low < near
    assert not near < low
    (same,) = interval("1", Root(1, Fraction(1)), None).flips
    assert same.change(4) == (Fraction(0), Fraction(0))


def test_what_no_tree_needs_changes_nothing() -> None:
    problem = ways({"mix": "0.9", "cut": "0.5"}, ("mix",))
    builder = NetworkBuilder()
    for unit in range(len(problem.network)):
        one = problem.network.unit(unit)
        builder.add(one.motion, one.inputs, one.outputs, Source("x", 1))
    builder.add("cut", [ObjectNode.of("flour")], [ObjectNode.of("dust")], Source("x", 9))
    result = sensitivity(replace(problem, network=builder.build()))
    assert result.others == ("cut",)
    assert [interval.motion for interval in result.intervals] == ["mix"]
    assert "at any rate: mix, 1 motion that the tree does not have" in result.text()


def test_rates_of_single_units_stay() -> None:
    problem = ways({"mix": "0.9", "cut": "0.5"}, ("mix", "mix"), ("cut",))
    result = sensitivity(replace(problem, own_rates={0: Fraction(9, 10)}))
    assert ends(result, "mix") == (Root(1, Fraction(5, 9)), None)
    every = sensitivity(replace(problem, own_rates={0: Fraction(9, 10), 1: Fraction(9, 10)}))
    assert every.others == ("mix",)


def test_nothing_to_do_and_nothing_to_be_done() -> None:
    problem = ways({"mix": "0.9"}, ("mix",))
    at_hand = replace(problem, goals=tuple(problem.kitchen))
    result = sensitivity(at_hand)
    assert (result.ending, result.intervals, result.others) == (Ending.DONE, (), ("mix",))
    nothing = sensitivity(replace(problem, kitchen=frozenset()))
    assert (nothing.ending, nothing.intervals, nothing.first) == (Ending.NEGATIVE, (), None)
    assert "infeasible" in nothing.text()
    with pytest.raises(UserError, match="needs the success rates"):
        sensitivity(replace(problem, rates=None))
    with pytest.raises(UserError, match="found 0 for the success rate of 'mix'"):
        sensitivity(replace(problem, rates={"mix": Fraction(0)}))
    with pytest.raises(UserError, match="found 0 for the success rate of a unit"):
        sensitivity(replace(problem, own_rates={0: Fraction(0)}))


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
    problem, units = result.outcome.problem, result.outcome.units
    if not trees:
        assert (result.outcome.status, result.intervals) == (Status.INFEASIBLE, ())
        return 0, 0
    assert units is not None
    assert problem.rates is not None
    asked = {*(interval.motion for interval in result.intervals), *result.others}
    assert asked == set(problem.network.motions)
    number = irrational = 0
    for motion in sorted(set(problem.network.motions)):
        power, rest = line(problem, list(map(problem.network.unit, units)), motion)
        lines = {(*line(problem, tree, motion), len(tree)) for tree in trees}
        tops = [(Root.taken(p - power, rest / r), p, -n) for p, r, n in lines if p > power and rest < r]
        bottoms = [(Root.taken(power - p, r / rest), -p, -n) for p, r, n in lines if p < power]
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
        assert (interval.below.at, interval.above.at) == (bottom and bottom[0], top and top[0])
        for end, expected, sign in ((interval.below, bottom, -1), (interval.above, top, 1)):
            if expected is None or end.beyond is None or end.at is None:
                assert end.beyond is None
                continue
            beyond = list(map(problem.network.unit, end.beyond))
            assert set(beyond) in map(set, trees)
            assert (line(problem, beyond, motion)[0], len(beyond)) == (sign * expected[1], -expected[2])
            number += 1
            irrational += end.at.rational is None
        for flip in interval.flips:
            inwards = Root(1, flip.inwards)
            assert flip.at >= inwards >= Root(1, interval.rate) or flip.at <= inwards <= Root(
                1, interval.rate
            )
    changes = [flip.change(60) for interval in result.intervals for flip in interval.flips]
    if changes:
        assert result.first is not None
        assert result.first.change(60)[0] <= min(high for _, high in changes)
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
@pytest.mark.parametrize("seeds", [range(10), pytest.param(range(10, 300), marks=pytest.mark.slow)])
def test_every_end_is_that_of_all_trees(rule: ContainerRule, seeds: range) -> None:
    counts = []
    for seed in seeds:
        problem = drawn(seed, rule)
        counts.append(assert_agrees(sensitivity(problem), list(oracle.trees(problem))))
    assert sum(number for number, _ in counts) > len(seeds)
    assert sum(irrational for _, irrational in counts) > len(seeds) // 20


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("name", ["forbid", "require"])
@pytest.mark.parametrize("seeds", [range(2), pytest.param(range(2, 60), marks=pytest.mark.slow)])
def test_ends_under_a_constraint(rule: ContainerRule, name: str, seeds: range) -> None:
    for seed in seeds:
        problem = drawn(seed, rule)
        motion = random.Random(seed).choice(MOTIONS)

        def allowed(tree: tuple[FunctionalUnit, ...], motion: str = motion) -> bool:
            return any(unit.motion == motion for unit in tree) == (name == "require")

        word = {"forbid": "forbidden", "require": "required"}[name]
        result = sensitivity(problem, constraints=f"{name}_motion", constants={f"{word}_motion": motion})
        assert_agrees(result, list(oracle.trees(problem, allowed)))


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seeds", [range(4), pytest.param(range(4, 40), marks=pytest.mark.slow)])
def test_solving_just_within_an_end_and_just_beyond_it(rule: ContainerRule, seeds: range) -> None:
    """Within, no tree is better than the one in hand; beyond, the one that is said to be best is."""
    tried = 0
    for seed in seeds:
        problem = random_ways(seed, rule)
        result = sensitivity(problem)
        for flip in (flip for interval in result.intervals for flip in interval.flips):
            assert flip.end.beyond is not None
            assert result.outcome.units is not None
            low, high = flip.at.below(60), flip.at.above(60)
            off = high / 10**60
            within, beyond = (low - off, high + off) if flip.above else (high + off, low - off)
            if not within <= 1 or not beyond <= 1:
                continue
            for rate, units in ((within, result.outcome.units), (beyond, flip.end.beyond)):
                if (rate is within) and flip.inwards == flip.interval.rate:
                    continue  # there is nothing within
                there = replace(problem, rates={**(problem.rates or {}), flip.interval.motion: rate})
                best = solve(there, [Objective.SUCCESS])
                assert best.status is Status.OPTIMAL
                assert best.costs is not None
                assert best.costs.success == there.costs(units).success
                tried += 1
            ours, theirs = (there.costs(tree).success for tree in (result.outcome.units, flip.end.beyond))
            assert ours is not None
            assert theirs is not None
            assert ours < theirs
    assert tried > len(seeds)


# --- Rules, limits, and faults.


def bundled(goal: str) -> Problem:
    return foon_asp.load().problem(goal)


def test_a_constraint_sees_the_rates_that_are_given() -> None:
    """A motion must succeed in 0.5: which trees there are stays, whatever rate is asked about."""
    problem = ways({"mix": "0.9", "cut": "0.6", "bake": "0.4"}, ("mix",), ("cut",), ("bake",))
    result = sensitivity(problem, constraints="least_rate", constants={"least_rate": 500000})
    assert ends(result, "mix") == (Root(1, Fraction(3, 5)), None)
    assert ends(result, "cut") == (None, Root(1, Fraction(9, 10)))
    assert ends(result, "bake") == (None, None)  # never in a tree, and without the constraint from 0.9 on


def test_a_constraint_that_looks_at_weights_is_refused(tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text(":- use(U), risk(U,W), W > 100000000.\n")
    with pytest.raises(UserError, match="uses risk/2"):
        sensitivity(bundled("ice"), constraints=mine)


def test_trees_by_need_have_the_same_ends() -> None:
    problem = ways({"mix": "0.9", "cut": "0.7"}, ("mix",) * 3, ("mix", "cut"))
    assert sensitivity(problem, encodings="by_need").intervals == sensitivity(problem).intervals


def test_encodings_that_are_not_ours_are_refused(tmp_path: Path) -> None:
    """They would be asked at other rates, too, and the answers be taken for what success is."""
    text = (encodings_folder() / "objectives.lp").read_text()
    (tmp_path / "objectives.lp").write_text(text.replace("{ W@P,U ", "{ -W@P,U "))
    with pytest.raises(UserError, match="it is not known what these encodings measure"):
        sensitivity(ways({"mix": "0.9", "cut": "0.6"}, ("mix",), ("cut",)), encodings=tmp_path)


def test_a_worse_tree_called_the_best_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    rates = {"mix": "0.9", "cut": "0.6", "bake": "0.1"}
    problem = ways(rates, ("mix",), ("cut",), ("bake",))

    def wrong(asked: Problem, *given: Any) -> Outcome:
        worst = (2,)
        return solve(asked, *given)._replace(units=worst, costs=asked.costs(worst))

    monkeypatch.setattr("foon_asp.questions.sensitivity.envelope.solve", wrong)
    with pytest.raises(BugError, match=r"optimal is said, but the tree \(0,\) is better"):
        sensitivity(problem)


@pytest.mark.parametrize("interrupted", [True, False])
def test_what_was_found_before_a_limit_is_said(interrupted: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    rates = {"mix": "0.9", "cut": "0.7", "bake": "0.3"}
    problem = ways(rates, ("mix",) * 3, ("mix", "cut"), ("bake",))
    whole = sensitivity(problem)
    done = False
    for searches in range(12):
        stopping = stopped_after(searches, lambda asked: interrupted and asked.as_seen is not None)
        for module in ("sensitivity", "sensitivity.envelope"):
            monkeypatch.setattr(f"foon_asp.questions.{module}.solve", stopping)
        result = sensitivity(problem)
        if result.ending is Ending.DONE:
            done = True
            assert result.intervals == whole.intervals
            continue
        assert not done
        assert result.ending is Ending.LIMIT
        assert "stopped at a limit" in result.text() or not result.intervals
        for interval in result.intervals:
            other = found(whole, interval.motion)
            for end, true in ((interval.below, other.below), (interval.above, other.above)):
                if end.proved:
                    assert end == true
                elif end.at is not None and true.at is not None:
                    assert abs(end.at.below(9) - interval.rate) >= abs(true.at.below(9) - interval.rate)
                else:
                    assert end.at is None
    assert done


# --- The command.


@STRUCK_WHILE_READING
def test_exit_codes_and_what_is_printed(cli: Cli, tmp_path: Path) -> None:
    ran = cli("sensitivity", "--goal", "macaroni")
    assert ran.code == 0
    assert "      below 0.899 (-5.36 %): - fill, switch on, pour  +" in ran.out
    assert max(map(len, ran.out.splitlines()[2:])) <= 60
    assert cli("sensitivity", "--goal", "apple pie").code == 1
    hurried = cli("sensitivity", "--goal", "tea", "--time-limit", "0")
    assert hurried.code == 3
    assert cli("sensitivity", "--goal", "tea", "--objective", "units").code == 2


def test_in_a_session(cli: Cli, tmp_path: Path) -> None:
    script = tmp_path / "evening.txt"
    script.write_text("goal ice\nconstraint forbid_motion forbidden_motion=crush\nsolve\nsensitivity\n")
    words = ("--goal", "ice", "--constraint", "forbid_motion", "-c", "forbidden_motion=crush")
    alone = cli("sensitivity", *words)
    assert cli("shell", script).out.endswith(alone.out)


def test_of_a_store(cli: Cli, tmp_path: Path) -> None:
    store = tmp_path / "kitchen.foon"
    assert cli("import", "--data", bundled_kitchen(), "--store", store).code == 0
    words = ("sensitivity", "--goal", "whipped cream", "--containers", "implied", "--format", "json")
    ours, theirs = cli(*words).json, cli(*words, "--network", store).json
    assert theirs["intervals"] == ours["intervals"]


def test_on_the_universal_foon(cli: Cli, universal: Path) -> None:
    """A tree that pours three times, and one that pours once: the end is a root."""
    words = ("sensitivity", "--data", universal, "--containers", "implied", "--goal", "macaroni")
    (first, *_) = cli(*words, "--format", "json").json["intervals"]
    assert (first["motion"], first["below"]["at"]["root"], first["below"]["at"]["of"]) == (
        "pour",
        2,
        "18/125",
    )
