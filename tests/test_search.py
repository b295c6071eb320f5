"""The searches: the published procedure by hand, iterative deepening against depths computed naively."""

from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.compare.comparison import compare
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof.simulation import Verdict
from foon_asp.search import (
    SEARCHES,
    Count,
    Ending,
    SearchSettings,
    Ties,
    breadth_first,
    depth_first,
    greedy_inputs,
    greedy_success,
    iterative_deepening,
)
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.goal_name import find_goal
from tests import oracle
from tests.conftest import Cli
from tests.hard_problem import hard_problem
from tests.random_problems import random_problem

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

RULES = list(ContainerRule)
PLAIN = SearchSettings()


def problem_of(units: list[tuple[str, str, str]], kitchen: str, goal: str) -> Problem:
    """Make a problem of units written as motion, inputs and outputs, one letter for each object."""
    builder = NetworkBuilder()
    for line, (motion, inputs, outputs) in enumerate(units, 1):
        builder.add(motion, map(ObjectNode.of, inputs), map(ObjectNode.of, outputs), Source("x", line))
    network = builder.build()
    ids = {node.label: o for o, node in enumerate(network.objects)}
    rates = {"safe": Fraction(9, 10), "risky": Fraction(1, 10), "fair": Fraction(1, 2)}
    return Problem(
        network, frozenset(ids[x] for x in kitchen), (ids[goal],), rates, frozenset(), ContainerRule.STRICT
    )


# Units 0 to 5; g is made by 0 and 1, each of whose inputs is made in its own way.
LAYERS = [
    ("risky", "ab", "g"),
    ("safe", "cde", "g"),
    ("fair", "k", "a"),
    ("fair", "k", "b"),
    ("safe", "k", "c"),
    ("fair", "a", "b"),
]


def test_the_published_procedure_step_by_step() -> None:
    problem = problem_of(LAYERS, "kde", "g")
    # g takes 0, then a takes 2, then b takes 3; reversed
    assert breadth_first(problem, PLAIN).units == (3, 2, 0)
    assert depth_first(problem, PLAIN).units == (2, 3, 0)  # from the stack b comes before a
    assert breadth_first(problem, SearchSettings(ties=Ties.LAST)).units == (4, 1)
    assert greedy_success(problem, PLAIN).units == (4, 1)
    assert greedy_inputs(problem, PLAIN).units == (3, 2, 0)
    assert greedy_inputs(problem, SearchSettings(ties=Ties.LAST)).units == (5, 2, 0)  # b by unit 5, not by 3


def test_heuristic_two_counts_ingredients_or_nodes() -> None:
    full, small = ObjectNode.of("pot", [], [], [("contains", ["a", "b", "c"])]), ObjectNode.of("cup")
    spoon, soup = ObjectNode.of("spoon"), ObjectNode.of("soup")
    builder = NetworkBuilder()
    builder.add("pour", [full], [soup], Source("x", 1))
    builder.add("mix", [small, spoon], [soup], Source("x", 2))
    network = builder.build()
    kitchen = frozenset({0, 2, 3})
    problem = Problem(network, kitchen, (1,), None, frozenset())
    assert greedy_inputs(problem, PLAIN).units == (1,)
    assert greedy_inputs(problem, SearchSettings(count=Count.NODES)).units == (0,)
    with pytest.raises(UserError, match="needs a rates file"):
        greedy_success(problem, PLAIN)


def test_a_unit_that_makes_two_objects_is_listed_once() -> None:
    problem = problem_of([("safe", "ab", "g"), ("safe", "k", "ab")], "k", "g")
    for search in (breadth_first, depth_first, greedy_success, greedy_inputs):
        assert search(problem, PLAIN).units == (1, 0)


def test_an_object_that_no_unit_makes_ends_the_search_there() -> None:
    problem = problem_of([("safe", "az", "g"), ("safe", "k", "a")], "k", "g")
    stuck = breadth_first(problem, PLAIN)
    assert stuck.ending is Ending.STUCK
    assert stuck.stuck_at is not None
    assert problem.network.objects[stuck.stuck_at].label == "z"
    assert iterative_deepening(problem, PLAIN).ending is Ending.NONE


def test_deepening_backtracks_where_the_first_unit_is_a_dead_end() -> None:
    cycle = [("safe", "x", "g"), ("safe", "g", "x"), ("safe", "y", "g"), ("safe", "k", "y")]
    problem = problem_of(cycle, "k", "g")
    assert breadth_first(problem, PLAIN).units == (1, 0)  # a cycle that supports itself
    assert iterative_deepening(problem, PLAIN).units == (3, 2)
    assert SEARCHES["ids"].run(problem, SearchSettings(published=True)).units == (1, 0)


def test_deepening_keeps_limits_apart() -> None:
    # an object that is found within 2 while it is being looked for within 4 keeps the smaller limit
    units = [("safe", "bc", "g"), ("safe", "a", "b"), ("safe", "c", "a"), ("safe", "a", "c")]
    problem = problem_of([*units, ("safe", "k", "d"), ("safe", "d", "c")], "k", "g")
    found = iterative_deepening(problem, PLAIN)
    assert oracle.makes(problem, tuple(map(problem.network.unit, found.units)))


def depths(problem: Problem) -> dict[int, int]:
    """Compute the least depth of every object by sweeping until nothing changes."""
    network, objects = problem.network, problem.network.objects
    ids = {node: o for o, node in enumerate(objects)}
    depth = dict.fromkeys(problem.kitchen, 0)
    changed = True
    while changed:
        changed = False
        for u in range(len(network)):
            needs = [ids[n] for n in oracle.needed(network.unit(u), problem.containers, problem.utensils)]
            if all(o in depth for o in needs):
                level = 1 + max((depth[o] for o in needs), default=0)
                made = oracle.made(network.unit(u), problem.containers, problem.utensils)
                for o in (ids[n] for n in made):
                    if depth.get(o, level + 1) > level:
                        depth[o], changed = level, True
    return depth


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("units", [8, pytest.param(30, marks=pytest.mark.slow)])
def test_deepening_returns_a_tree_of_least_depth_or_says_that_none_exists(
    rule: ContainerRule, units: int
) -> None:
    for seed in range(1500):
        problem = random_problem(seed, rule, units)
        found = iterative_deepening(problem, PLAIN)
        depth = depths(problem)
        if not all(goal in depth for goal in problem.goals):
            assert found.ending is Ending.NONE
            continue
        least = max(depth[goal] for goal in problem.goals)
        assert found.ending is Ending.TREE
        tree = tuple(map(problem.network.unit, found.units))
        assert oracle.makes(problem, tree)
        assert all(depths(sub_problem(problem, found.units))[goal] <= least for goal in problem.goals)
        limited = iterative_deepening(problem, SearchSettings(depth_limit=least - 1)) if least else None
        assert limited is None or limited.ending is Ending.UNKNOWN
        assert iterative_deepening(problem, SearchSettings(depth_limit=least)) == found


def sub_problem(problem: Problem, units: tuple[int, ...]) -> Problem:
    """Keep only some units of a problem."""
    builder = NetworkBuilder()
    for u in range(len(problem.network)):  # the others as units that give nothing, so that ids stay
        unit = problem.network.unit(u)
        builder.add(f"{u} {unit.motion}", unit.inputs, unit.outputs, Source("x", u + 1))
    network = builder.build()
    outputs = tuple(out if u in units else () for u, out in enumerate(network.outputs))
    object.__setattr__(network, "outputs", outputs)
    return Problem(network, problem.kitchen, problem.goals, None, problem.utensils, problem.containers)


def test_limits_end_in_unknown() -> None:
    problem = hard_problem()
    assert iterative_deepening(problem, SearchSettings(depth_limit=5)).ending is Ending.UNKNOWN
    assert iterative_deepening(problem, SearchSettings(time_limit=0)).ending is Ending.UNKNOWN
    assert iterative_deepening(problem, PLAIN).ending is Ending.TREE


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_no_tree_that_executes_beats_the_optimum(rule: ContainerRule) -> None:
    for seed in range(200):
        comparison = compare(random_problem(seed, rule), tuple(SEARCHES.values()), SearchSettings())
        for judgement in comparison.judgements:
            if judgement.executes in {Verdict.AS_LISTED, Verdict.REORDERED}:
                for objective in judgement.measures:
                    assert not comparison.beats_the_optimum(judgement, objective)
            if judgement.search == "ids" and judgement.ending == Ending.TREE:
                assert judgement.executes == Verdict.AS_LISTED


@pytest.fixture(scope="module")
def data(universal: Path) -> Data:
    return read_data(find_data(universal))


# Units under `implied`: greek salad, macaroni, whipped cream, sweet potato, ice.
MEASURED = {
    ("bfs", Count.INGREDIENTS): [28, 7, 10, 3, 1],
    ("dfs", Count.INGREDIENTS): [28, 7, 10, 3, 1],
    ("greedy-success", Count.INGREDIENTS): [35, 7, 10, 3, 1],
    ("greedy-inputs", Count.NODES): [28, 8, 15, 3, 1],
    ("greedy-inputs", Count.INGREDIENTS): [31, 7, 15, 3, 1],
}


@pytest.mark.parametrize(("name", "count"), MEASURED)
def test_on_the_real_universal_foon(data: Data, name: str, count: Count) -> None:
    found: list[int] = []
    executes: list[str | None] = []
    for label in ("greek salad", "macaroni", "whipped cream", "sweet potato", "ice"):
        goal = find_goal(label, data.network, data.goals)
        problem = Problem(
            data.network, data.kitchen, (goal,), data.rates, data.utensils, ContainerRule.IMPLIED
        )
        comparison = compare(problem, (SEARCHES[name],), SearchSettings(count=count))
        (judgement,) = comparison.judgements
        assert judgement.units is not None
        found.append(len(judgement.units))
        executes.append(judgement.executes)
    assert found == MEASURED[name, count]
    assert executes[0] == Verdict.REORDERED
    assert (executes[1] == Verdict.NEVER) is (name == "greedy-success") or count is Count.NODES
    assert executes[2] == Verdict.NEVER


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_deepening_executes_for_every_makeable_object(data: Data, rule: ContainerRule) -> None:
    one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, rule)
    depth = depths(one)
    for goal in sorted(depth)[::3]:
        problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)
        found = iterative_deepening(problem, PLAIN)
        assert oracle.makes(problem, tuple(map(data.network.unit, found.units)))


def test_search_prints_its_promise_and_verdict(cli: Cli) -> None:
    ran = cli("search", "bfs", "--goal", "macaroni")
    assert ran.code in {0, 1}
    assert "bfs promises only that each input" in ran.out
    ran = cli("search", "ids", "--goal", "macaroni", "--format", "json")
    assert ran.code == 0
    assert ran.json["verdict"] == "executes as listed"
    assert len(ran.json["units"]) == ran.json["costs"]["units"] >= 9
    ran = cli("search", "ids", "--goal", "apple pie")
    assert ran.code == 1
    assert "no tree: none executes, at any depth" in ran.out
    ran = cli("search", "ids", "--goal", "macaroni", "--depth-limit", "2")
    assert ran.code == 3
    assert "unknown: stopped at a limit" in ran.out
    assert cli("search", "ids", "--goal", "macaroni", "--format", "foon").out.count("//\n") >= 10
