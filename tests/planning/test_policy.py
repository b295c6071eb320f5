"""Policies with retries: their chances by all outcomes, and the best one against all policies."""

import random
from collections.abc import Iterator
from fractions import Fraction
from itertools import islice
from xml.etree import ElementTree

import pytest

import foon_asp
from foon_asp import ContainerRule, Objective, Problem, UserError
from foon_asp.planning import policy as policies
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.planning.policy import Policy, PolicyBranch, best_policy
from foon_asp.questions.robot_plan import RobotPlan
from tests.conftest import Cli
from tests.oracle.task_trees import made, needed, trees
from tests.planning.test_behaviour_tree import faults, needs_py_trees, nodes_in
from tests.proof.by_hand import recipe
from tests.support.random_problems import random_problem


def problems(number: int, units: int) -> Iterator[tuple[Problem, list[tuple[int, ...]], int]]:
    """Yield random problems with rates, up to three trees of each, and a number of retries."""
    for seed in range(number):
        choose = random.Random(seed)
        problem = random_problem(seed, choose.choice(list(ContainerRule)), units=units)
        number_of = problem.network.unit_id
        found = list(islice(trees(problem), 40))
        listed = [tuple(o for o in map(number_of, tree) if o is not None) for tree in found]
        irredundant = [tree for tree in listed if tree and not any(set(o) < set(tree) for o in listed)]
        if irredundant:
            ordered = [
                in_order(problem, tree) for tree in choose.sample(irredundant, min(3, len(irredundant)))
            ]
            yield problem, ordered, choose.randint(0, 2)


def in_order(problem: Problem, tree: tuple[int, ...]) -> tuple[int, ...]:
    available = set(problem.kitchen)
    order: list[int] = []
    while len(order) < len(tree):
        unit = next(u for u in tree if u not in order and available.issuperset(problem.needs[u]))
        order.append(unit)
        available.update(problem.gives[unit])
    return tuple(order)


def greatest_chance(problem: Problem, units: set[int], retries: int) -> Fraction:
    """Return the greatest chance of all policies, each of which may look at all that happened so far."""
    objects, rules = problem.network.objects, (problem.containers, problem.utensils)
    goals = {objects[o] for o in problem.goals}

    def value(available: frozenset[object], failures: int) -> Fraction:
        if goals <= available:
            return Fraction(1)
        best = Fraction(0)
        for unit in map(problem.network.unit, units):
            new = available | made(unit, *rules)
            if needed(unit, *rules) <= available and new != available:
                rate = problem.rate(problem.network.unit_id(unit) or 0)
                chance = rate * value(new, failures)
                if failures:
                    chance += (1 - rate) * value(available, failures - 1)
                best = max(best, chance)
        return best

    return value(frozenset(objects[o] for o in problem.kitchen), retries)


def behaviour_tree(problem: Problem, branches: tuple[PolicyBranch, ...]) -> str:
    ways = [(branch.units, branch.failures) for branch in branches]
    return RobotPlan.of(problem, [Objective.UNITS], branches[0].units, {}, ways).behaviour_tree()


class Script:
    """A kitchen in which the outcomes of executions are given, as far as they are."""

    def __init__(self, problem: Problem, outcomes: tuple[bool, ...]) -> None:
        network = problem.network
        self._problem, self._outcomes = problem, iter(outcomes)
        self._name = {o: pddl_name("o", o, str(node)) for o, node in enumerate(network.objects)}
        self.there = {self._name[o] for o in problem.kitchen}
        self.chance = Fraction(1)
        self.unknown: Fraction | None = None

    def execute(self, execution: foon_asp.Execution) -> bool | None:
        rate = self._problem.rate(execution.unit)
        outcome = next(self._outcomes, None)
        if outcome is None:
            self.unknown = rate
        else:
            self.chance *= rate if outcome else 1 - rate
            self.there.update(self._name[o] for o in self._problem.gives[execution.unit] if outcome)
        return outcome


def chance_of_run(problem: Problem, xml: str) -> Fraction:
    """Return the chance that a run of a tree by py_trees succeeds, by all outcomes of its executions."""
    total = Fraction(0)
    waiting: list[tuple[bool, ...]] = [()]
    while waiting:
        outcomes = waiting.pop()
        kitchen = Script(problem, outcomes)
        root = foon_asp.py_trees_root(xml, kitchen.execute, kitchen.there.__contains__)
        root.tick_once()
        while root.status.name == "RUNNING" and kitchen.unknown is None:
            root.tick_once()
        if kitchen.unknown is not None:
            waiting += [(*outcomes, outcome) for outcome in (True, False) if outcome or kitchen.unknown < 1]
        elif root.status.name == "SUCCESS":
            total += kitchen.chance
    return total


def test_the_best_of_all_policies_is_found() -> None:
    compared = 0
    for problem, ways, retries in problems(150, units=5):
        best = best_policy(problem, ways, retries)
        units = {unit for tree in ways for unit in tree}
        greatest = greatest_chance(problem, units, retries)
        assert (best.bound, best.is_exact) == (greatest, True)
        assert best.chance <= greatest
        assert 1 <= sum(branch.failures for branch in best.branches) == retries + 1
        compared += 1
    assert compared > 40


def test_without_a_dynamic_program_the_bound_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(policies, "POLICY_LIMITS", policies.POLICY_LIMITS._replace(states=0))
    apart = 0
    for problem, ways, retries in problems(100, units=5):
        best = best_policy(problem, ways, retries)
        greatest = greatest_chance(problem, {unit for tree in ways for unit in tree}, retries)
        if problem.kitchen.issuperset(problem.goals):
            continue
        assert not best.is_exact
        assert best.chance <= greatest <= best.bound <= 1
        apart += best.bound > greatest
    assert apart


@needs_py_trees
def test_the_chance_is_that_of_the_tree_that_is_run() -> None:
    several = 0
    for problem, ways, retries in problems(40, units=5):
        best = best_policy(problem, ways, retries)
        shared = tuple(PolicyBranch(tree, 1) for tree in ways)  # also where that is not the best
        for branches, chance in ((best.branches, best.chance), (shared, None)):
            xml = behaviour_tree(problem, branches)
            assert not list(faults(xml))
            run = chance_of_run(problem, xml)
            assert chance is None or run == chance
            assert run <= best_policy(problem, ways, sum(b.failures for b in branches) - 1).chance
            several += len(branches) > 1
    assert several > 1


def test_a_safe_detour_is_better_than_a_risky_unit_only_with_retries() -> None:
    problem = recipe(
        "risk: egg > dish",
        "peel: egg > egg; peeled",
        "cut: egg; peeled > egg; cut",
        "fry: egg; cut > dish",
        kitchen="egg",
        goals="dish",
        rates={"risk": "6/10", "peel": "8/10", "cut": "8/10", "fry": "8/10"},
    )
    risky, detour = (0,), (1, 2, 3)
    assert best_policy(problem, [detour], 0).chance == Fraction(8, 10) ** 3
    six_tenths = Fraction(6, 10)
    assert best_policy(problem, [detour, risky], 0) == Policy(
        (PolicyBranch(risky, 1),), six_tenths, six_tenths, True
    )
    three = best_policy(problem, [detour, risky], 3)
    chance = Fraction(8, 10) ** 3 * sum(
        Fraction(2, 10) ** failed * ways for failed, ways in enumerate((1, 3, 6, 10))
    )
    assert (three.branches, three.chance) == ((PolicyBranch(detour, 4),), chance)


def test_another_tree_is_a_branch_where_it_goes_on_with_what_is_there() -> None:
    problem = recipe(
        "crack: egg > egg; cracked",
        "toss: egg; cracked > dish",
        "order: phone > egg; cracked",
        "fry: egg; cracked > dish",
        kitchen="egg + phone",
        goals="dish",
        rates={"crack": 1, "toss": "1/2", "order": "1/10", "fry": "9/10"},
    )
    found = best_policy(problem, [(0, 1), (2, 3)], 1)
    assert found.branches == (PolicyBranch((0, 1), 1), PolicyBranch((2, 3), 1))
    assert found.chance == Fraction(1, 2) + Fraction(1, 2) * Fraction(9, 10)
    assert (found.bound, found.is_exact) == (Fraction(99, 100), True)  # of cracking and frying
    assert best_policy(problem, [(0, 1), (2, 3), (0, 3)], 1).chance == Fraction(99, 100)


def test_policies_without_end_are_best_by_attempts() -> None:
    compared = 0
    for problem, _, _ in problems(40, units=5):
        answer = foon_asp.solve(problem, "attempts")
        assert answer.costs is not None
        assert answer.costs.measures[Objective.ATTEMPTS] == least_attempts(problem)
        xml = answer.behaviour_tree()
        if answer.units:
            (retry,) = ElementTree.fromstring(xml).iter("RetryUntilSuccessful")
            assert retry.get("num_attempts") == "-1"
            compared += 1
    assert compared > 10


def least_attempts(problem: Problem) -> Fraction:
    """Return the least expected number of executions of all policies that never give up (Bellman)."""
    best = {frozenset(problem.kitchen): Fraction(0)}
    waiting = [*best]
    while waiting:  # values of states that are reached at a lower cost are mended
        state = waiting.pop()
        for unit, needs in enumerate(problem.needs):
            new = state.union(problem.gives[unit])
            value = best[state] + 1 / problem.rate(unit)
            if state.issuperset(needs) and new != state and (new not in best or value < best[new]):
                best[new] = value
                waiting.append(new)
    return min(value for state, value in best.items() if state.issuperset(problem.goals))


def test_retries_on_the_command_line(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--retries", "1", "--format", "json")
    policy = ran.json["policy"]
    # twist 23/25, pound 17/20, pour 19/20: each may fail once, and one of them
    whole = Fraction(23, 25) * Fraction(17, 20) * Fraction(19, 20)
    assert policy["chance"]["exact"] == str(whole * (1 + Fraction(2, 25) + Fraction(3, 20) + Fraction(1, 20)))
    assert (policy["bound"], policy["is_exact"]) == (policy["chance"], True)
    assert [(branch["failures"], branch["tree"]["costs"]["units"]) for branch in policy["branches"]] == [
        (2, 3)
    ]
    xml = cli("solve", "--goal", "ice", "--retries", "1", "--format", "behaviour-tree").out
    assert not list(faults(xml))
    assert nodes_in(xml)["RetryUntilSuccessful"] == 1
    assert "with 1 retry: success ≈ 0.9509; proved" in cli("solve", "--goal", "ice", "--retries", "1").out
    assert cli("solve", "--goal", "apple pie", "--retries", "1", "--format", "json").json["policy"] is None


def test_retries_are_refused_where_they_mean_nothing(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--retries", "1", "--items", "used-up")
    assert (ran.code, "solve --retries is not built" in ran.err) == (2, True)
    ran = cli("solve", "--goal", "ice", "--retries", "1", "--all-goals")
    assert (ran.code, "retries of one goal" in ran.err) == (2, True)
    with pytest.raises(UserError, match="retries"):
        foon_asp.solve(foon_asp.load().problem("ice"), retries=-1)


def test_a_limit_leaves_the_tree_without_a_policy(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(*_: object) -> None:
        while True:
            pass

    monkeypatch.setattr("foon_asp.questions.retry_policy.best_policy", endless)
    ran = cli("solve", "--goal", "ice", "--retries", "1", "--time-limit", "1")
    assert (ran.code, "optimal by units" in ran.out) == (3, True)
    assert "no policy for retries: stopped at the time limit" in ran.out
