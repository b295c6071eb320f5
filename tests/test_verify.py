"""No wrong certificate passes: every change is refused, by the seal and, sealed anew, by what it says."""

import copy
import json
import random
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.certificate import Certificate, Coverage, certify, certify_infeasible, certify_outcome
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof.verify import RefusedError, Verified, seal, verify
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.goal_name import find_goal
from tests import oracle
from tests.constraint_oracle import keeps, random_rule, settings_of
from tests.gap_problem import gap_problem
from tests.random_problems import MOTIONS, random_problem

Content = dict[str, Any]


def check(content: Content, problem: Problem) -> Verified:
    given = problem.network, problem.kitchen, problem.rates, problem.utensils
    return verify(content, *given, problem.unit_prices)


def certificate(problem: Problem, *objectives: Objective) -> Certificate:
    _, found = certify_outcome(solve(problem, objectives), Settings())
    assert found is not None
    return found


def accepted(content: Content, problem: Problem) -> Verified | None:
    """Seal a changed certificate anew; give what it proves, or ``None`` where it is refused."""
    content["seal"] = seal(content)
    try:
        return check(content, problem)
    except RefusedError:
        return None


# --- changes


def paths(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Give the way to everything in a JSON value."""
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from paths(value[key], (*path, key))
    elif isinstance(value, list):
        for place in range(len(value)):
            yield from paths(value[place], (*path, place))


def at(value: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        value = value[key]
    return value


def changes(value: Any) -> list[Any]:
    """Give other values of the same kind and of others."""
    if isinstance(value, bool) or value is None:
        return [0, [], {}]
    if isinstance(value, int):
        return [value + 1, value - 1, -value - 1, str(value), value + 0.5, None]
    if isinstance(value, str):
        found: list[Any] = [value + " ", value[:-1], value[::-1], "", "0", "1", "-1", "1/2", "2", None, 1]
        try:
            number = Fraction(value)
            found += [
                str(number + 1),
                str(number / 2),
                str(number * 2),
                str(-number),
                str(number + Fraction(1, 97)),
            ]
        except (ValueError, ZeroDivisionError):
            found += [("0" if value[:1] != "0" else "1") + value[1:]]
        return found
    if isinstance(value, list):
        found = [[], [*value, *value[:1]], value[::-1], value[1:], value[:-1], [*value, 0], None, {}]
        return [*found, *([*value[:i], *value[i + 1 :]] for i in range(len(value)))]
    assert isinstance(value, dict)
    found = [{}, None, [], {**value, "more": 1}]
    return [*found, *({k: v for k, v in value.items() if k != key} for key in value)]


def mutants(content: Content) -> Iterator[tuple[tuple[Any, ...], Content]]:
    """Give every certificate in which one value is another."""
    for path in paths(content):
        if not path:
            continue
        old = at(content, path)
        for new in changes(old):
            if type(new) is type(old) and new == old:
                continue
            mutant = copy.deepcopy(content)
            at(mutant, path[:-1])[path[-1]] = new
            yield path, mutant


@cache
def subjects() -> list[tuple[Problem, Content]]:
    """Give certificates of all kinds, on networks small enough for brute force."""
    found: list[tuple[Problem, Content]] = []
    kinds: dict[tuple[str, ...], int] = {}
    for seed in range(400):
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        objective = list(Objective)[seed % 5]
        content = certificate(problem, objective).content
        size = len(content["tree"] or []) + len(content["cuts"])
        kind = (content["claim"], str(objective), str(problem.containers))
        if content["claim"] == "infeasible":
            kind = ("infeasible", "", str(problem.containers))
        if kinds.get(kind, 0) < 2 and (size > 2 or kind[0] == "infeasible"):
            kinds[kind] = kinds.get(kind, 0) + 1
            found.append((problem, content))
    gaps = Objective.UNITS, Objective.SUCCESS, Objective.KITCHEN, Objective.ATTEMPTS
    for seed, objective in enumerate(gaps):
        problem = gap_problem(seed, 3)
        found.append((problem, certificate(problem, objective).content))
    bounds = 0
    for seed in range(100):
        problem = random_problem(seed, ContainerRule.STRICT)
        covered = Coverage(not_covered=("mine.lp",))
        settings = Settings((Path("require_motion"),), constants=(f"required_motion={MOTIONS[seed % 6]}",))
        units = solve(problem, (), settings).units
        bound = None if units is None else certify(problem, (Objective.UNITS,), units, covered)
        if bound is not None and bound.claim == "bound" and bounds < 3:
            bounds += 1
            found.append((problem, bound.content))
    return found


@pytest.mark.slow
def test_the_subjects_are_of_all_kinds() -> None:
    claims = [content["claim"] for _, content in subjects()]
    assert claims.count("infeasible") == 4
    assert claims.count("optimal") > 15
    assert claims.count("bound") == 3
    assert sum("branch" in content["proof"] for _, content in subjects()) >= 2
    assert any("multiples" in content["proof"] for _, content in subjects())


@pytest.mark.slow
def test_no_mutant_passes() -> None:
    tried = 0
    for problem, content in subjects():
        check(content, problem)
        for _, mutant in mutants(content):
            tried += 1
            with pytest.raises(RefusedError):
                check(mutant, problem)
    assert tried > 10_000


class Judge:
    """Knows all trees of a problem by brute force."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._trees: list[tuple[FunctionalUnit, ...]] | None = None

    def is_true(self, claim: Verified, content: Content) -> bool:
        """Whether what was verified holds."""
        problem = self.problem
        if claim.goals != problem.goals or claim.containers != problem.containers:
            problem = Problem(
                problem.network,
                problem.kitchen,
                claim.goals,
                problem.rates,
                problem.utensils,
                ContainerRule(claim.containers),
            )
            trees = list(oracle.trees(problem))
        else:
            self._trees = list(oracle.trees(problem)) if self._trees is None else self._trees
            trees = self._trees
        trees = [tree for tree in trees if all(keeps(problem, tree, rule) for rule in claim.rules)]
        if claim.claim == "infeasible":
            return not trees
        if claim.claim == "bound":
            assert claim.objectives[0] == "units"
            return all(len(tree) >= Fraction(content["bound"][0]) for tree in trees)
        assert claim.claim == "optimal"
        assert claim.tree is not None
        tree = tuple(map(problem.network.unit, claim.tree))
        objectives = list(claim.objectives)
        keys = {tuple(oracle.measure(problem, other, o) for o in objectives) for other in trees}
        return {*tree} in map(set, trees) and min(keys) == tuple(
            oracle.measure(problem, tree, o) for o in objectives
        )


def ruled_subjects() -> list[tuple[Problem, Content]]:
    """Give certificates under each ready-made constraint that can be drawn, of trees and of none."""
    found: dict[tuple[str, str], tuple[Problem, Content]] = {}
    for seed in range(300):
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        rule = random_rule(random.Random(seed), problem)
        settings = settings_of([rule])
        _, ruled = certify_outcome(solve(problem, (), settings), settings)
        if ruled is not None:
            found.setdefault((rule["rule"], ruled.claim), (problem, ruled.content))
    return [*found.values()]


@pytest.mark.slow
@pytest.mark.parametrize("given", [subjects, ruled_subjects])
def test_a_mutant_that_is_sealed_anew_passes_only_if_it_is_a_proof(
    given: Callable[[], list[tuple[Problem, Content]]],
) -> None:
    """Such as one with a node in a cut that makes no difference, or with another tree that is as good."""
    passed = refused = 0
    for problem, content in given():
        judge = Judge(problem)
        for path, mutant in mutants(content):
            if path[0] == "seal":
                continue
            claim = accepted(mutant, problem)
            if claim is None:
                refused += 1
            else:
                passed += 1
                assert judge.is_true(claim, mutant), (path, at(mutant, path))
    assert refused > (40 if given is subjects else 4) * passed
    assert passed > 0


@pytest.mark.slow
def test_weights_landmarks_and_digests_cannot_be_changed_even_if_sealed_anew() -> None:
    """Without branches and rounding, the weights are all needed: none can be raised, lowered or left out."""
    tried = 0
    for problem, content in subjects():
        if set(content["proof"]) != {"weights"} or content["claim"] == "bound":
            continue
        for path, mutant in mutants(content):
            if mutant["version"] == 4:  # which says the same where nothing is left out as too dear
                continue
            if path[0] in {"digests", "proof", "costs", "bound", "claim", "format", "version"}:
                tried += 1
                assert accepted(mutant, problem) is None, path
        for number in range(len(content["cuts"])):  # a landmark and its weight, dropped together
            mutant = copy.deepcopy(content)
            del mutant["cuts"][number]
            kept = [pair for pair in mutant["proof"]["weights"] if pair[0] != number]
            mutant["proof"]["weights"] = [[n - (n > number), weight] for n, weight in kept]
            tried += 1
            assert accepted(mutant, problem) is None
    assert tried > 2500


@pytest.mark.slow
def test_units_of_a_tree_cannot_be_swapped_for_others() -> None:
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("macaroni", data.network, data.goals)
    problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils)
    content = certificate(problem, Objective.SUCCESS).content
    passed = 0
    for place in range(len(content["tree"])):
        for unit in range(len(data.network)):
            if unit == content["tree"][place]:
                continue
            mutant = copy.deepcopy(content)
            mutant["tree"][place] = unit
            with pytest.raises(RefusedError, match="seal"):
                check(mutant, problem)
            claim = accepted(mutant, problem)
            if claim is not None:  # another tree, which then has to be as good
                passed += 1
                assert claim.tree is not None
                assert problem.costs(claim.tree) == problem.costs(content["tree"])
    assert passed < 10


@pytest.mark.parametrize("part", ["network", "kitchen", "rates", "utensils", "prices"])
def test_other_data_is_refused(part: str) -> None:
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("ice", data.network, data.goals)
    prices = UnitPrices({"pour": Fraction(1, 2)}, {data.network.unit(3): Fraction(0)})
    given = data.network, data.kitchen, (goal,), data.rates, data.utensils
    content = certificate(Problem(*given, unit_prices=prices), Objective.UNITS).content
    assert data.rates is not None
    network, kitchen, rates, utensils = data.network, data.kitchen, dict(data.rates), data.utensils
    if part == "network":
        builder = NetworkBuilder()
        for unit in reversed([network.unit(u) for u in range(len(network))]):
            builder.add(unit.motion, unit.inputs, unit.outputs, Source("reversed", 1))
        network = builder.build()
    elif part == "kitchen":
        kitchen = kitchen - {min(kitchen)}
    elif part == "rates":
        rates["pour"] /= 2
    elif part == "prices":
        prices = UnitPrices(prices.motions, {data.network.unit(2): Fraction(0)})
    else:
        utensils = utensils | {"thimble"}
    with pytest.raises(RefusedError, match=part):
        verify(content, network, kitchen, rates, utensils, prices)


# --- handmade


def pair(one: str, other: str) -> Problem:
    """Make a thing by pouring or by mixing, which succeed at two rates."""
    builder = NetworkBuilder()
    start, end = ObjectNode.of("start"), ObjectNode.of("end")
    builder.add("pour", [start], [end], Source("pair", 1))
    builder.add("mix", [start], [end], Source("pair", 2))
    rates = {"pour": Fraction(one), "mix": Fraction(other)}
    return Problem(builder.build(), frozenset({0}), (1,), rates, frozenset())


def sealed(problem: Problem, rates: tuple[str, str], change: Callable[[Content], None]) -> Verified | None:
    """Take the certificate of a pair of rates to another pair."""
    found = certify(problem, (Objective.SUCCESS,), [0])
    assert found is not None
    content = copy.deepcopy(found.content)
    other = pair(*rates)
    fresh = certify(other, (Objective.UNITS,), [0])
    assert fresh is not None
    content["digests"] = fresh.content["digests"]
    change(content)
    return accepted(content, other)


def nothing(content: Content) -> None:
    pass


def test_a_rate_of_zero_costs_more_than_any_weight() -> None:
    assert sealed(pair("1/2", "1/4"), ("1/2", "0"), nothing) is not None
    assert sealed(pair("1/2", "1/4"), ("1/2", "2/3"), nothing) is None


def test_a_tree_that_never_succeeds_is_not_called_the_best() -> None:
    def hopeless(content: Content) -> None:
        content["tree"], content["costs"] = [1], ["0"]

    assert sealed(pair("1/2", "1/4"), ("1/2", "0"), hopeless) is None
    assert sealed(pair("1/2", "1/4"), ("0", "0"), nothing) is None


def test_rates_are_compared_exactly() -> None:
    nines = "0." + "9" * 50
    assert sealed(pair(nines, "0.9"), (nines, nines), nothing) is not None
    assert sealed(pair(nines, "0.9"), (nines, nines + "1"), nothing) is None

    def rational(content: Content) -> None:
        content["proof"]["weights"][0][1] = [{"1/4": "1/2"}]  # (1/4) ** (1/2) is 1/2

    assert sealed(pair("1/2", "1/4"), ("1/2", "1/4"), rational) is not None

    def above(content: Content) -> None:
        content["proof"]["weights"][0][1] = [{"1/4": "1/2", "1/3": "1/1000"}]

    assert sealed(pair("1/2", "1/4"), ("1/2", "1/4"), above) is None

    def endless(content: Content) -> None:
        content["proof"]["weights"][0][1] = [{"1/4": f"{10**40 + 1}/{10**41}"}]

    assert sealed(pair("1/2", "1/4"), ("1/2", "1/4"), endless) is None


def test_branches_without_end_are_refused() -> None:
    problem = gap_problem(0, 3)
    content = certificate(problem, Objective.UNITS).content
    proof: Any = content["proof"]
    for _ in range(50_000):
        proof = {"branch": {"unit": 0}, "without": proof, "using": proof}
    with pytest.raises(RefusedError):
        check({**content, "proof": proof}, problem)


@pytest.mark.slow
def test_an_infeasible_claim_needs_a_cut_that_nothing_crosses() -> None:
    problem = next(p for p, content in subjects() if content["claim"] == "optimal")
    infeasible = next((p, c) for p, c in subjects() if c["claim"] == "infeasible")
    assert certify_infeasible(problem) is None
    content = copy.deepcopy(infeasible[1])
    content["proof"] = {"weights": []}
    content["cuts"] = []
    assert accepted(content, infeasible[0]) is None


def test_the_levels_after_the_first_are_checked_too() -> None:
    checked = 0
    for problem, content in subjects():
        if (
            len(content["objective"]) < 2
            or content["claim"] == "bound"
            or "branch" in content["proof"]
            or not content["cuts"]
        ):
            continue
        assert tuple(content["objective"]) == levels((Objective(content["objective"][0]),))
        for pair_ in content["proof"]["weights"]:
            mutant = copy.deepcopy(content)
            weight = next(p for p in mutant["proof"]["weights"] if p[0] == pair_[0])[1]
            weight[1] = str(Fraction(weight[1]) - Fraction(1, 1000))
            assert accepted(mutant, problem) is None
            checked += 1
    assert checked > 20


def test_a_certificate_survives_its_own_text() -> None:
    for problem, content in subjects():
        assert json.loads(json.dumps(content)) == content
        check(json.loads(json.dumps(content)), problem)
        shuffled = list(content.items())
        random.Random(1).shuffle(shuffled)
        check(dict(shuffled), problem)
