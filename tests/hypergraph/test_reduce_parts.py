"""Each part of the reductions by itself, held against its definition or against all trees there are."""

import math
import random
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import count

import pytest

from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE, SAFE, Reduction, parse_reductions, tuning
from foon_asp.hypergraph.action_landmarks import relevant_given_landmarks
from foon_asp.hypergraph.dominance import undominated_actions
from foon_asp.hypergraph.exact_costs import CoarseCosts
from foon_asp.hypergraph.goal_graph import GoalGraph, graph_of
from foon_asp.hypergraph.h_values import Derivations, compute_h_values
from foon_asp.hypergraph.lazy_h_max import lazy_h_max_test
from foon_asp.hypergraph.reduced_cost_fixing import neighbourhood
from foon_asp.hypergraph.restricted_subproblem import restricted_subproblem
from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from tests.oracle.task_trees import trees
from tests.support.plain_graphs import Action, executes, plain, plain_problem, random_graph
from tests.support.random_problems import random_problem


@cache
def with_trees() -> list[tuple[dict[int, int], GoalGraph, list[frozenset[int]]]]:
    """Return graphs with prices of actions and all trees without a spare unit, by brute force."""
    found = []
    for seed in range(60):
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=10)
        ids = {problem.network.unit(u): u for u in range(len(problem.network))}
        slim: list[frozenset[int]] = []
        for tree in (frozenset(ids[unit] for unit in tree) for tree in trees(problem)):  # small ones first
            if not any(smaller < tree for smaller in slim):
                slim.append(tree)
        if slim:
            graph = graph_of(problem, (Objective.UNITS,))
            rng = random.Random(seed)
            found.append(({a: rng.randint(seed % 2, 6) for a in range(len(graph.needs))}, graph, slim))
    assert len(found) > 20
    return found


def solvable(seeds: int) -> Iterator[tuple[GoalGraph, dict[int, int], list[int]]]:
    """Return graphs with a tree, prices of actions, and the actions that can run.

    The actions of half of them give much, so that cheap ways to make things have spare ones.
    """
    for seed in range(seeds):
        rng = random.Random(f"solvable {seed}")
        if seed % 2:
            graph = random_graph(seed, actions=14)
        else:
            actions = [
                (rng.sample(range(12), rng.choice((0, 1, 2))), rng.sample(range(12), 3)) for _ in range(20)
            ]
            graph = plain(actions, rng.sample(range(1, 12), 6), [0])
        price = {a: rng.randint(0, 6) for a in range(len(graph.needs))}
        made = compute_h_values(graph, price, price, h_add=False)
        if made.tree(graph, graph.goals):
            yield graph, price, list(made.h_actions)


# --- What things cost at least.


def costs_by_definition(
    graph: GoalGraph, actions: Collection[int], price: Mapping[int, int], added: bool
) -> tuple[dict[int, int], dict[int, int]]:
    """Work estimates out by going over all actions until nothing changes."""
    cost: dict[int, float] = dict.fromkeys(range(graph.size), math.inf) | dict.fromkeys(graph.start, 0)
    before: dict[int, float] = {}
    for _ in range(graph.size + 1):
        for a in actions:
            needed = [cost[o] for o in graph.needs[a] if o not in graph.start]
            before[a] = price[a] + (sum(needed) if added else max(needed, default=0))
            for o in graph.gives[a]:
                cost[o] = min(cost[o], before[a])
    return (
        {o: int(c) for o, c in cost.items() if o not in graph.start and c < math.inf},
        {a: int(c) for a, c in before.items() if c < math.inf},
    )


@pytest.mark.parametrize("added", [True, False])
def test_estimates_are_what_they_are_defined_to_be(added: bool) -> None:
    made = missed = 0
    for seed in range(120):
        rng = random.Random(seed)
        graph = random_graph(seed)
        price = {a: rng.randint(seed % 2, 5) for a in range(9)}
        actions = rng.sample(range(9), 8)
        found = compute_h_values(graph, actions, price, added)
        assert (found.h_objects, found.h_actions) == costs_by_definition(graph, actions, price, added)
        assert list(found.h_actions.values()) == sorted(found.h_actions.values())
        assert all(found.h_actions[found.best_achievers[o]] == cost for o, cost in found.h_objects.items())
        tree = found.tree(graph, graph.goals)
        if graph.start.union(found.h_objects).issuperset(graph.goals):
            assert tree is not None
            assert executes(graph, tree)
            used = {*graph.goals}.union(*(graph.needs[a] for a in tree)) - graph.start
            assert tree == {found.best_achievers[o] for o in used}
            made += 1
        else:
            assert tree is None
            missed += 1
    assert min(made, missed) > 10


def test_what_is_there_from_the_start_is_made_by_nothing() -> None:
    graph = plain([([], [0, 1]), ([0], [2])], [0, 2], [0])
    found = compute_h_values(graph, range(2), {0: 1, 1: 1}.__getitem__, h_add=True)
    assert found == Derivations({1: 1, 2: 1}, {1: 0, 2: 1}, {0: 1, 1: 1})
    assert [found.tree(graph, objects) for objects in ([0], [0, 2], [2, 3])] == [set(), {1}, None]


def test_of_a_tree_each_action_is_followed_once() -> None:
    # two of each of 60 steps, each of which needs both of the step before: 2 ** 60 ways back
    steps = [([2 * step, 2 * step + 1], [2 * step + 2 + side]) for step in range(60) for side in range(2)]
    graph = plain(steps, [120, 121], [0, 1])
    found = compute_h_values(graph, range(120), dict.fromkeys(range(120), 1), h_add=False)
    assert found.tree(graph, graph.goals) == set(range(120))


# --- What is near the goals.


def near_by_definition(
    graph: GoalGraph, allowed: set[int], rest: Mapping[int, int], limit: int, before: Mapping[int, int] | None
) -> set[int]:
    """Work out what is near by going over all actions until nothing changes."""
    distance: dict[int, float] = dict.fromkeys(range(graph.size), math.inf) | dict.fromkeys(graph.goals, 0)
    kept: set[int] = set()
    for _ in range(2 * graph.size):
        for a in allowed:
            closest = min((distance[o] for o in graph.gives[a] if o not in graph.start), default=math.inf)
            least = rest[a] if before is None else max(rest[a], before.get(a, math.inf))
            if closest + least <= limit:
                kept.add(a)
                for o in graph.needs[a]:
                    distance[o] = min(distance[o], closest + rest[a])
    return kept


def test_what_is_near_is_what_it_is_defined_to_be() -> None:
    some = 0
    for seed in range(60):
        rng = random.Random(seed)
        graph = random_graph(seed, actions=12)
        rest = {a: rng.randint(seed % 2, 5) for a in range(12)}
        allowed = set(rng.sample(range(12), 11))
        before = compute_h_values(graph, allowed, rest, h_add=False).h_actions
        for limit in (0, 1, 2, 4, 7, 11):
            for known in (None, before):
                found = neighbourhood(
                    graph, allowed, rest.__getitem__, limit, known, min_reduced_cost=seed % 2
                )
                assert found == near_by_definition(graph, allowed, rest, limit, known)
                some += 0 < len(found) < 9
            nearest = neighbourhood(graph, allowed, rest.__getitem__, 99, enough=limit)
            assert len(nearest) >= min(limit, len(neighbourhood(graph, allowed, rest.__getitem__, 99)))
    assert some > 50


def test_all_cheap_trees_are_near() -> None:
    for price, graph, slim in with_trees():
        cone, _ = graph.cone()
        made = compute_h_values(graph, cone, price.__getitem__, h_add=False)
        for limit in (0, 1, 3, 6, 12, 100):
            cheap = [tree for tree in slim if sum(map(price.__getitem__, tree)) <= limit]
            close = neighbourhood(graph, set(cone), price.__getitem__, limit)
            assert frozenset().union(*cheap) <= neighbourhood(
                graph, set(cone), price.__getitem__, limit, made.h_actions
            )
            assert frozenset().union(*cheap) <= close
        assert neighbourhood(graph, range(len(graph.needs)), price.__getitem__, 10**9) == set(cone)


def test_the_nearest_come_first_until_there_are_enough() -> None:
    # 0, 1 and 2 give the goal; 3 and 4 what 0 needs, 5 what 1 needs, 6 what 5 needs
    graph = plain([([2], [1]), ([3], [1]), ([], [1]), ([], [2]), ([], [2]), ([4], [3]), ([], [4])], [1])
    rest = {0: 1, 1: 2, 2: 5, 3: 1, 4: 0, 5: 1, 6: 1}.__getitem__
    enough = [len(neighbourhood(graph, range(7), rest, 100, enough=most)) for most in (1, 3, 4, 5, 6, 7, 8)]
    assert enough == [3, 3, 5, 5, 6, 7, 7]


@pytest.mark.parametrize(("least", "asked"), [(0, [0, 1, 2]), (1, [0, 1])])
def test_what_cannot_be_within_the_limit_is_not_asked_about(least: int, asked: list[int]) -> None:
    row = plain([([2], [1]), ([3], [2]), ([4], [3]), ([], [4])], [1])
    prices: list[int] = []

    def rest(action: int) -> int:
        prices.append(action)
        return 1

    assert neighbourhood(row, range(4), rest, 2, min_reduced_cost=least) == {0, 1}
    assert prices == asked


@pytest.mark.parametrize(("deep", "looks"), [(100, 1000), (1, 1000), (100, 20)])
def test_what_is_within_reach_is_what_is_derived_at_once(
    deep: int, looks: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Or it may be, where it is too deep to tell, as in circles that cost nothing."""
    monkeypatch.setattr(tuning, "CUTS", tuning.CutTuning(lazy_depth=deep, lazy_looks=looks))
    told = 0
    for seed in range(40):
        rng = random.Random(seed)
        graph = random_graph(seed, actions=14)
        allowed = set(rng.sample(range(14), 12))
        rest = {a: rng.randint(seed % 2, 4) for a in allowed}
        exact = (deep, looks, seed % 2) == (100, 1000, 1)
        made = compute_h_values(graph, allowed, rest, h_add=False)
        reach = lazy_h_max_test(graph, allowed, rest.__getitem__)
        asked = [(o, limit) for o in range(graph.size) for limit in range(9)]
        rng.shuffle(asked)
        for o, limit in asked:
            beyond = o not in graph.start and made.h_objects.get(o, math.inf) > limit
            said = not reach(o, limit)
            assert (beyond == said) if exact else (beyond or not said), (seed, o, limit)
            told += said
        for limit in (0, 2, 5):
            close = neighbourhood(graph, allowed, rest.__getitem__, limit, made.h_actions)
            reach = lazy_h_max_test(graph, allowed, rest.__getitem__)
            found = neighbourhood(graph, allowed, rest.__getitem__, limit, reachable=reach)
            assert found == close if exact else found >= close, (seed, limit)
    assert told > 500


def test_circles_are_not_gone_round_for_ever(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each of ten objects makes each other one, at a rest of its own: 67,869 looks, if nothing ends them."""
    actions = [([one], [other]) for one in range(1, 11) for other in range(1, 11) if one != other]
    rng = random.Random(2)
    rests = [1 << rng.randrange(20) for _ in actions]
    looked = count()

    def rest(action: int) -> int:
        next(looked)
        return rests[action]

    monkeypatch.setattr(tuning, "CUTS", tuning.CutTuning(lazy_looks=500))
    reach = lazy_h_max_test(plain(actions, [1]), range(len(actions)), rest)
    assert reach(1, 10**7)
    assert reach(2, 10**7)
    assert next(looked) < 700


def test_costs_may_be_larger_than_any_float() -> None:
    """Of an object that nothing makes, nothing is said, however much the action costs that needs it."""
    reach = lazy_h_max_test(plain([([], [2]), ([2, 3], [1])], [1]), range(2), lambda _: 10**400)
    asked = (1, 10**500), (1, 2 * 10**400), (2, 10**400), (2, 10**399)
    assert [reach(o, limit) for o, limit in asked] == [False, False, True, False]


def test_actions_are_added_until_there_is_a_tree() -> None:
    for graph, price, _ in solvable(40):
        found = [restricted_subproblem(graph, set(), price.__getitem__, most) for most in (0, 4, 99)]
        assert found[-1] is not None
        for made, tree in filter(None, found):
            assert executes(graph, tree)
            assert tree <= {*made.h_actions}
    assert restricted_subproblem(plain([([2], [1]), ([1], [2])], [1]), set(), lambda _: 1, 100) is None
    assert restricted_subproblem(plain([([0], [1])], [1], [0]), set(), lambda _: 1, 0) is not None


def test_of_a_large_network_few_actions_are_added() -> None:
    """One for each object that is wanted and not made: those that lack least, then cheap ones first."""
    # the goal 1 is given by 0, of what nothing gives, and by 1, of 2 and 3, which are given by two each
    few = plain([([5, 0], [1]), ([2, 3], [1]), ([2], [2]), ([0], [2]), ([6], [3]), ([0], [3])], [1], [0])
    found = restricted_subproblem(few, set(), {0: 1, 1: 1, 2: 1, 3: 4, 4: 1, 5: 2}.__getitem__, 100)
    assert found is not None
    assert (found[1], found[0].h_actions) == ({1, 3, 5}, {3: 4, 5: 2, 1: 5})
    cheap = restricted_subproblem(plain([([0], [1])] * 3, [1], [0]), set(), [9, 1, 1].__getitem__, 100)
    assert cheap is not None
    assert {*cheap[0].h_actions} == cheap[1] == {1}


# --- What is of no use.


def test_those_that_dominate_are_found_as_by_looking_at_all() -> None:
    gone = 0
    for seed in range(60):
        chance = random.Random(seed)
        objects = range(2, chance.randint(5, 9))
        some: list[Action] = [
            (chance.sample(objects, chance.randint(0, 3)), chance.sample(objects, chance.randint(1, 3)))
            for _ in range(40)
        ]
        prices = [chance.randint(1, 3) for _ in some]
        graph = plain(some, chance.sample(objects, 2), [0])
        actions = {*chance.sample(range(40), 30)} if seed % 2 else {*range(40)}
        wanted = set(graph.goals).union(*(graph.needs[a] for a in actions))
        left = set(actions)
        for action in sorted(left, key=lambda a: (-prices[a], a)):
            needs, gives = set(graph.needs[action]), wanted.intersection(graph.gives[action])
            if not gives or any(
                needs.issuperset(graph.needs[other])
                and gives.issubset(graph.gives[other])
                and prices[other] <= prices[action]
                for other in left - {action}
            ):
                left.discard(action)
        assert undominated_actions(graph, actions, prices.__getitem__) == left
        gone += len(actions) - len(left)
    assert gone > 400


def test_what_others_dominate_costs_no_tree() -> None:
    for price, graph, slim in with_trees():
        cone, _ = graph.cone()
        left = undominated_actions(graph, cone, price.__getitem__)
        totals = {tree: sum(map(price.__getitem__, tree)) for tree in slim}
        assert min(totals[tree] for tree in slim if tree <= left) == min(totals.values())


def test_all_trees_without_a_spare_unit_are_beside_what_is_forced() -> None:
    for _, graph, slim in with_trees():
        cone, _ = graph.cone()
        assert frozenset().union(*slim) <= relevant_given_landmarks(graph, set(cone))
        for tree in slim:  # allowed is heard: nothing comes from units that are not
            assert relevant_given_landmarks(graph, tree) == tree


@pytest.mark.parametrize(
    ("actions", "goals", "expected"),
    [
        # what else gives something that a chain of single makers gives
        ([([0], [2, 3]), ([2, 3], [1]), ([0], [3])], [1], {0, 1}),
        # two makers: neither is forced, and both stay, with what they need
        ([([2], [1]), ([3], [1]), ([0], [2]), ([0], [3]), ([0], [4])], [1], {0, 1, 2, 3}),
        # a forced one that may build upon what it gives itself: 2 of 3, of which it gives some, too
        ([([2], [1, 3]), ([3], [2]), ([0], [2]), ([0], [3])], [3, 1], {0, 1, 2, 3}),
        # it gives the start, too, which it builds upon: that does not matter
        ([([2], [1, 0, 3]), ([0], [2]), ([4], [2]), ([0], [4]), ([0], [3])], [1, 3], {0, 1, 2, 3}),
        # of two makers of a goal that is there by then, both go; so they do where it is met first
        ([([0], [2, 3]), ([2], [1]), ([0], [3]), ([0], [3])], [3, 1], {0, 1}),
        ([([0], [2, 3]), ([2], [1]), ([0], [3]), ([0], [3])], [1, 3], {0, 1}),
        # what cannot run at all, and goals that are there
        ([([2], [1]), ([0], [4])], [1], {0}),
        ([([0], [1])], [0], set()),
    ],
)
def test_beside_what_is_forced_nothing_else_stays(
    actions: list[Action], goals: list[int], expected: set[int]
) -> None:
    assert relevant_given_landmarks(plain(actions, goals, [0]), range(len(actions))) == expected


# --- A question as plain arrays.


def boiling() -> Problem:
    """Ask for tea and for the water at hand, which can be drawn as well, and for tea once more."""
    builder = NetworkBuilder()
    tap, water, leaves, tea = (ObjectNode.of(name) for name in ("tap", "water", "leaves", "tea"))
    builder.add("draw", [tap], [water, tap], Source("graph", 1))
    builder.add("boil", [water, leaves], [tea, water], Source("graph", 2))
    network = builder.build()
    # objects by number: tap, water, leaves, tea
    return Problem(network, frozenset({1, 2}), (3, 1, 3), None, frozenset(), ContainerRule.STRICT)


def test_where_items_are_counted_to_take_one_is_an_action() -> None:
    graph = graph_of(boiling(), (Objective.INPUTS, Objective.UNITS))
    assert (graph.units, graph.size, graph.goals, graph.start) == (2, 4, (3,), frozenset({1, 2}))
    assert [sorted(give) for give in graph.gives] == [[0, 1], [1, 3]]
    graph = graph_of(boiling(), (Objective.INPUTS, Objective.KITCHEN))
    assert (graph.units, graph.size, graph.goals, graph.start) == (2, 4, (3,), frozenset())
    assert [sorted(need) for need in graph.needs] == [[0], [1, 2], [], [], [], []]
    assert [sorted(give) for give in graph.gives] == [[0], [3], [0], [1], [2], [3]]
    assert [list(makers) for makers in graph.makers] == [[0], [3], [4], [1]]


def test_the_goals_can_come_from_what_leads_to_them() -> None:
    # 2 is there, and 5 leads nowhere; 1 comes of 2 and 3, which comes of 4 and of 1
    graph = plain([([2, 3], [1]), ([4], [3]), ([1], [3]), ([6], [2]), ([1], [5]), ([2], [1])], [1], [2])
    assert graph.cone() == ({0, 1, 2, 5}, {1, 3, 4})
    assert graph.cone({0, 2, 3, 4}) == ({0, 2}, {1, 3})
    assert graph.cone(()) == (set(), {1})


# --- Costs and names.


@pytest.mark.parametrize("rate", ["1", "0.999", "0.5", "0.04", "1/1" + "0" * 400])
def test_coarse_costs_are_next_to_the_logarithm_and_not_above_it(rate: str) -> None:
    problem = plain_problem([([0], [1]), ([1], [2])], [2], rates=[rate, "0.5"])
    exact = Fraction(rate)
    logarithm = 1000 * (math.log(exact.denominator) - math.log(exact.numerator))
    costs = CoarseCosts(problem, Objective.SUCCESS)
    assert logarithm - 1 < costs(0) <= logarithm
    assert [CoarseCosts(problem, Objective.INPUTS)(a) for a in range(2)] == [1, 1]
    prices = UnitPrices({"motion 0": Fraction("0.25"), "motion 1": Fraction(3)}, {})
    costs = CoarseCosts(replace(problem, unit_prices=prices), Objective.PRICE)
    assert [costs(a) for a in range(2)] == [250, 3000]  # fractions are told apart
    # beyond the units, an action takes an item of the kitchen
    assert [CoarseCosts(problem, each)(2) for each in (Objective.KITCHEN, Objective.UNITS)] == [1, 0]


def test_what_never_succeeds_is_dearest_by_far() -> None:
    costs = CoarseCosts(plain_problem([([0], [1])] * 2, [1], rates=["0", "0.000001"]), Objective.SUCCESS)
    assert costs(0) > 5 * costs(1)


def test_reductions_are_named() -> None:
    assert [parse_reductions(word) for word in ("all", "safe", "none")] == [ALL, SAFE, NONE]
    assert parse_reductions("dear") == {Reduction.DEAR}
    assert parse_reductions("bounds, forced") == {Reduction.BOUNDS, Reduction.FORCED}
    with pytest.raises(UserError, match=r"found the reduction 'cheap', expected all, safe, none or some of"):
        parse_reductions("dear,cheap")
