"""The searches: the published procedure by hand, iterative deepening against depths computed naively."""

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.comparison.comparison import compare
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof.simulation import Verdict
from foon_asp.searches import (
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
from foon_asp.text.node_lookup import find_goal
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.support.hard_problem import hard_problem
from tests.support.random_problems import random_problem

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
    assert task_trees.makes(problem, tuple(map(problem.network.unit, found.units)))


def depths(problem: Problem, units: Iterable[int] | None = None) -> dict[int, int]:
    """Compute the least depth of every object, by all units or some, sweeping until nothing changes."""
    network, objects = problem.network, problem.network.objects
    ids = {node: o for o, node in enumerate(objects)}
    depth = dict.fromkeys(problem.kitchen, 0)
    changed = True
    while changed:
        changed = False
        for u in range(len(network)) if units is None else units:
            needs = [ids[n] for n in task_trees.needed(network.unit(u), problem.containers, problem.utensils)]
            if all(o in depth for o in needs):
                level = 1 + max((depth[o] for o in needs), default=0)
                made = task_trees.made(network.unit(u), problem.containers, problem.utensils)
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
        assert task_trees.makes(problem, tree)
        assert all(depths(problem, found.units)[goal] <= least for goal in problem.goals)
        limited = iterative_deepening(problem, SearchSettings(depth_limit=least - 1)) if least else None
        assert limited is None or limited.ending is Ending.UNKNOWN
        assert iterative_deepening(problem, SearchSettings(depth_limit=least)) == found


def test_limits_end_in_unknown() -> None:
    problem = hard_problem()
    assert iterative_deepening(problem, SearchSettings(depth_limit=5)).ending is Ending.UNKNOWN
    assert iterative_deepening(problem, SearchSettings(time_limit=0)).ending is Ending.UNKNOWN
    assert iterative_deepening(problem, PLAIN).ending is Ending.TREE


@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
def test_no_tree_that_executes_beats_the_optimum(rule: ContainerRule) -> None:
    for seed in range(200):
        problem = random_problem(seed, rule)
        problem = replace(problem, goals=problem.goals[:1])
        comparison = compare(problem, tuple(SEARCHES.values()), SearchSettings())
        for result in comparison.searches:
            if result.executes:
                assert not any(map(result.beats_the_optimum, result.measures))
            if result.search == "ids" and result.ending == Ending.TREE:
                assert result.verdict == Verdict.AS_LISTED


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
        (result,) = comparison.searches
        assert result.units is not None
        found.append(len(result.units))
        executes.append(result.verdict)
    assert found == MEASURED[name, count]
    assert executes[0] == Verdict.REORDERED
    assert (executes[1] == Verdict.NEVER) is (name == "greedy-success") or count is Count.NODES
    assert executes[2] == Verdict.NEVER


def test_a_tree_is_shown_with_its_promise_and_verdict(cli: Cli) -> None:
    words = "compare", "--search", "ids", "--trees", "--goal"
    (row,) = cli(*words, "macaroni", "--format", "json").json["comparisons"]
    (found,) = row["searches"]
    assert found["verdict"] == "executes as listed"
    assert [step["id"] for step in found["tree"]] == found["units"]
    assert "ids promises a tree that executes, of least depth" in cli(*words, "macaroni").out
    assert "no tree: none executes, at any depth" in cli(*words, "apple pie").out
    assert "unknown: stopped at a limit" in cli(*words, "macaroni", "--depth-limit", "2").out
    assert "; type: foon-asp compare --search NAME --trees" in cli("search", "ids").err
    several = cli("compare", "--goal", "ice", "--format", "foon")
    assert (several.code, "name one search (--search)" in several.err) == (2, True)
