"""Each part of the reductions by itself: what it leaves holds every tree that it says it leaves."""

import math
import random
from collections.abc import Iterator
from fractions import Fraction

import pytest

from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut, landmark_cuts
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.reduce import ALL, NONE, SAFE, Reduction, parse_reductions, reduce
from foon_asp.reduce.derivation import derive
from foon_asp.reduce.dominance import undominated
from foon_asp.reduce.exact_costs import CoarseCosts, ExactCosts
from foon_asp.reduce.forced import beside_forced
from foon_asp.reduce.graph import Graph, graph_of
from foon_asp.reduce.near import near
from foon_asp.reduce.upper_bound import improved, without_spare
from tests.oracle import trees
from tests.random_problems import random_problem

SEEDS = range(60)


def asked(seed: int) -> tuple[Problem, Graph, list[frozenset[int]]]:
    """Give a problem, its graph, and the trees without a spare unit, as ids, by brute force."""
    problem = random_problem(seed, list(ContainerRule)[seed % 2], units=10)
    ids = {problem.network.unit(u): u for u in range(len(problem.network))}
    found = [frozenset(ids[unit] for unit in tree) for tree in trees(problem)]  # small ones first
    slim: list[frozenset[int]] = []
    for tree in found:
        if not any(smaller < tree for smaller in slim):
            slim.append(tree)
    return problem, graph_of(problem, (Objective.UNITS,)), slim


def with_trees(seeds: range = SEEDS) -> Iterator[tuple[int, Problem, Graph, list[frozenset[int]]]]:
    met = 0
    for seed in seeds:
        problem, graph, slim = asked(seed)
        if slim:
            met += 1
            yield seed, problem, graph, slim
    assert met > 20


def prices(seed: int, graph: Graph, least: int = 1) -> dict[int, int]:
    rng = random.Random(seed)
    return {a: rng.randint(least, 6) for a in range(len(graph.needs))}


def test_all_trees_without_a_spare_unit_are_beside_what_is_forced() -> None:
    for _, _, graph, slim in with_trees(range(100)):
        cone, _ = graph.cone()
        left = beside_forced(graph, set(cone))
        assert frozenset().union(*slim) <= left
        for tree in slim:  # allowed is heard: nothing comes from units that are not
            assert beside_forced(graph, tree) == tree


def test_what_a_forced_unit_gives_needs_no_other_maker() -> None:
    builder = NetworkBuilder()
    water, cup, tea, dish = (ObjectNode.of(name) for name in ("water", "cup", "tea", "dish"))
    builder.add("wash", [water], [cup, dish], Source("forced", 1))  # the only one that makes a cup
    builder.add("brew", [cup], [tea], Source("forced", 2))
    builder.add("rinse", [water], [dish], Source("forced", 3))  # of no use: a dish is there anyway
    network = builder.build()
    ids = [network.object_id(node) for node in (water, tea, dish)]
    start, *goals = (o for o in ids if o is not None)
    for order in (goals, goals[::-1]):
        problem = Problem(network, frozenset({start}), tuple(order), None, frozenset(), ContainerRule.STRICT)
        assert beside_forced(graph_of(problem, (Objective.UNITS,)), range(3)) == {0, 1}


def test_all_cheap_trees_are_near() -> None:
    left_out = 0
    for seed, _, graph, slim in with_trees():
        price = prices(seed, graph, least=0)
        cone, _ = graph.cone()
        made = derive(graph, cone, price.__getitem__, added=False)
        for limit in (0, 1, 3, 6, 12, 100):
            cheap = [tree for tree in slim if sum(map(price.__getitem__, tree)) <= limit]
            plain = near(graph, set(cone), price.__getitem__, limit)
            nearer = near(graph, set(cone), price.__getitem__, limit, made.before)
            assert nearer <= plain <= set(cone)
            assert frozenset().union(*cheap) <= plain
            assert frozenset().union(*cheap) <= nearer
            left_out += len(plain - nearer)
            # what is there leads to a goal for no more than the limit, seen from it alone
            assert all(price[a] <= limit for a in plain)
            assert all(made.before[a] <= limit for a in nearer)
        everything = near(graph, range(len(graph.needs)), price.__getitem__, 10**9)
        assert everything == set(cone)
        few = near(graph, range(len(graph.needs)), price.__getitem__, 10**9, most=1)
        assert few
        assert few <= everything
    assert left_out > 5


def test_what_others_stand_in_for_costs_no_tree() -> None:
    left_out = 0
    for seed, _, graph, slim in with_trees():
        price = prices(seed, graph)
        cone, _ = graph.cone()
        left = undominated(graph, cone, price.__getitem__)
        assert left <= set(cone)
        left_out += len(set(cone) - left)
        kept = [tree for tree in slim if tree <= left]
        assert kept
        assert min(sum(map(price.__getitem__, tree)) for tree in kept) == min(
            sum(map(price.__getitem__, tree)) for tree in slim
        )
        # none that is left can stand in for another one that is
        needs = {a: set(graph.needs[a]) - graph.start for a in left}
        wanted = set(graph.goals).union(*({*graph.needs[a]} - graph.start for a in cone))
        gives = {a: set(graph.gives[a]) & wanted for a in left}
        assert all(gives.values())
        for one in left:
            for other in left - {one}:
                stands_in = needs[other] <= needs[one] and gives[one] <= gives[other]
                assert not (stands_in and price[other] <= price[one])
    assert left_out > 5


def test_without_spare_nothing_can_be_left_out() -> None:
    only = 0
    for seed, _, graph, slim in with_trees():
        price = prices(seed, graph)
        cone, _ = graph.cone()
        made = derive(graph, cone, price.__getitem__, added=False)
        tree = without_spare(graph, set(made.before), price.__getitem__)
        assert tree in slim
        for other in slim:
            assert without_spare(graph, other, price.__getitem__) == other
        for larger in (tree | {more} for tree in slim for more in made.before):
            able = derive(graph, larger, lambda _: 1, added=False).before
            inside = [other for other in slim if other <= larger]
            if len(able) < len(larger) or len(inside) > 1:
                continue
            only += 1  # whatever the costs
            for cost in (price, prices(seed + 1000, graph, least=0)):
                assert without_spare(graph, larger, cost.__getitem__) == inside[0]
    assert only > 100


def test_a_tree_is_exchanged_for_a_cheaper_one_only() -> None:
    better = 0
    for seed, _, graph, slim in with_trees():
        price = prices(seed, graph)
        cone, _ = graph.cone()

        def total(tree: object, price: dict[int, int] = price) -> int:
            assert isinstance(tree, set | frozenset)
            return sum(map(price.__getitem__, tree))

        dearest = set(max(slim, key=total))
        for thorough in (False, True):
            found = improved(
                graph, cone, dearest, price.__getitem__, price.__getitem__, lambda: False, thorough
            )
            assert found in slim
            assert total(found) <= total(dearest)
            assert (total(found) == total(dearest)) == (found is dearest)
            better += total(found) < total(dearest)
            best = set(min(slim, key=total))
            same = improved(graph, cone, best, price.__getitem__, price.__getitem__, lambda: False, thorough)
            assert same is best
    assert better > 10


def chain(*rates: str) -> Problem:
    """Ask for what comes of a chain of units, each with a rate of its own."""
    builder = NetworkBuilder()
    nodes = [ObjectNode.of(f"node {place}") for place in range(len(rates) + 1)]
    for place in range(len(rates)):
        builder.add(f"motion {place}", [nodes[place]], [nodes[place + 1]], Source("chain", place + 1))
    network = builder.build()
    known = {f"motion {place}": Fraction(rate) for place, rate in enumerate(rates)}
    goal = network.object_id(nodes[-1])
    start = network.object_id(nodes[0])
    assert goal is not None
    assert start is not None
    return Problem(network, frozenset({start}), (goal,), known, frozenset(), ContainerRule.STRICT)


def test_cuts_settle_by_exact_costs_and_not_by_rounded_ones() -> None:
    problem = chain("0.9", "0.900000001")
    levels = (Objective.SUCCESS, Objective.UNITS)
    costs = ExactCosts(problem, levels, range(2))
    first, second = costs(0), costs(1)
    assert costs.doubt > 0
    assert first > second + costs.doubt
    own = [WeightedCut(frozenset({1}), (0,), 0, first), WeightedCut(frozenset({2}), (1,), 1, second)]
    assert costs.met(Cuts(first + second, {0: 0, 1: 0}, own), {0, 1})
    # a cut of both, worth the first: the second has less than that, exactly, and is overloaded
    both = WeightedCut(frozenset({1}), (0, 1), 0, first)
    rest = {0: 0, 1: second - first}
    assert not costs.met(Cuts(first, rest, [both]), {0})
    # the other way round it is the first that has some left
    fair = WeightedCut(frozenset({1}), (0, 1), 1, second)
    assert costs.met(Cuts(second, {0: first - second, 1: 0}, [fair]), {1})
    assert not costs.met(Cuts(second, {0: first - second, 1: 0}, [fair]), {0})
    # less than the tree costs proves nothing, and one cut may not be used twice
    assert not costs.met(Cuts(first, {0: 0}, own[:1]), {0, 1})
    assert not costs.met(Cuts(2 * first, {0: -first}, own[:1] * 2), {0, 1})


def test_without_rates_costs_are_whole_numbers_and_bounds_are_compared_as_they_are() -> None:
    problem = chain("0.5", "0.5", "0.5")
    costs = ExactCosts(problem, (Objective.UNITS,), range(3))
    assert costs.doubt == 0
    assert [costs(a) for a in range(3)] == [1, 1, 1]
    assert costs.met(Cuts(3, {}, []), {0, 1, 2})
    assert costs.met(Cuts(4, {}, []), {0, 1, 2})
    assert not costs.met(Cuts(2, {}, []), {0, 1, 2})
    assert [costs.first(total) for total in (0, 1, 7)] == [0, 1, 7]


@pytest.mark.parametrize("rate", ["0.5", "0.001", "0.999999", "1"])
def test_a_bound_on_success_is_near_the_product_and_never_below_it(rate: str) -> None:
    problem = chain(rate, rate, "0.75")
    costs = ExactCosts(problem, (Objective.SUCCESS, Objective.UNITS), range(3))
    product = Fraction(rate) ** 2 * Fraction("0.75")
    bound = costs.first(sum(map(costs, range(3))))
    assert product <= bound <= 1
    assert bound <= product * (1 + Fraction(1, 10**15))
    assert math.isclose(costs.first(0), 1)
    assert costs.first(0) == 1


def test_cuts_leave_of_costs_what_they_do_not_take() -> None:
    for seed, _, graph, slim in with_trees():
        price = prices(seed, graph)
        cone, _ = graph.cone()
        made = derive(graph, cone, price.__getitem__, added=False)
        cuts = landmark_cuts(
            graph, graph.goals, set(made.before), price.__getitem__, made.cost, lambda: False
        )
        assert (cuts.hopeless, cuts.interrupted) == (False, False)
        assert cuts.bound == sum(cut.weight for cut in cuts.cuts)
        assert cuts.bound <= min(sum(map(price.__getitem__, tree)) for tree in slim)
        assert bool(graph.goals) == (cuts.bound > 0)
        taken = dict.fromkeys(made.before, 0)
        for cut in cuts.cuts:
            assert cut.weight > 0
            assert cut.cheapest in cut.members
            assert cut.objects.intersection(graph.goals)
            assert cut.objects.isdisjoint(graph.start)
            for tree in slim:
                assert tree.intersection(cut.members), "a tree uses none of a landmark"
            for action in cut.members:
                taken[action] += cut.weight
        for action, weight in taken.items():
            assert cuts.left.get(action, price[action]) == price[action] - weight >= 0
        # of what is left, the goals come for nothing
        left = {action: price[action] - weight for action, weight in taken.items()}
        rest = derive(graph, set(made.before), left.__getitem__, added=False)
        assert all(rest.cost[goal] == 0 for goal in graph.goals)
        none = landmark_cuts(graph, graph.goals, (), price.__getitem__, {}, lambda: False)
        assert none.hopeless == bool(graph.goals)


def test_where_no_tree_is_nothing_is_left() -> None:
    met = 0
    for seed in SEEDS:
        problem, _, slim = asked(seed)
        if not slim:
            met += 1
            for reductions in (ALL, NONE):
                found = reduce(problem, (Objective.UNITS,), reductions)
                assert found == (None, (), False, None, 0, None, False, None, None, None, ())
    assert met > 2


@pytest.mark.parametrize("rate", ["1", "0.999", "0.5", "0.04", "1/1" + "0" * 400])
def test_coarse_costs_are_next_to_the_logarithm_and_not_above_it(rate: str) -> None:
    problem = chain(rate, "0.5")
    exact = Fraction(rate)
    logarithm = 1000 * (math.log(exact.denominator) - math.log(exact.numerator))
    costs = CoarseCosts(problem, Objective.SUCCESS)
    assert logarithm - 1 < costs(0) <= logarithm
    assert [CoarseCosts(problem, Objective.INPUTS)(a) for a in range(2)] == [1, 1]
    # beyond the units, an action takes an item of the kitchen
    assert CoarseCosts(problem, Objective.KITCHEN)(2) == 1
    assert CoarseCosts(problem, Objective.UNITS)(2) == 0


def test_what_never_succeeds_is_dearest_by_far() -> None:
    costs = CoarseCosts(chain("0", "0.000001"), Objective.SUCCESS)
    assert costs(0) > 5 * costs(1)


def test_reductions_are_named() -> None:
    assert [parse_reductions(word) for word in ("all", "safe", "none")] == [ALL, SAFE, NONE]
    assert parse_reductions("dear") == {Reduction.DEAR}
    assert parse_reductions("bounds, forced") == {Reduction.BOUNDS, Reduction.FORCED}
    with pytest.raises(UserError, match=r"found the reduction 'cheap', expected all, safe, none or some of"):
        parse_reductions("dear,cheap")
