"""What constraints mean for trees, by their own words: of every set of units of small problems."""

import random
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from foon_asp.certificate import Coverage, NotBestError, certify, certify_infeasible
from foon_asp.certificate.arrays import Arrays
from foon_asp.certificate.certificate import subject_of
from foon_asp.certificate.coverage import without_unused_claims
from foon_asp.certificate.own_rules import check_with_clingo
from foon_asp.deadline import Deadline
from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.compiled_rules import CompiledRules
from foon_asp.proof.refusal import CheckLimitError, RefusedError
from foon_asp.proof.rule_meaning import LIBRARY, OWN, Meaning, sources_read
from foon_asp.proof.verifier import verify
from foon_asp.text.line_parser import parse_node
from tests.oracle import task_trees
from tests.oracle.constraints import keeps, random_rule
from tests.support.random_problems import MOTIONS, random_problem

SEEDS = range(24)


def drawn(seed: int) -> tuple[Problem, list[dict[str, Any]], random.Random]:
    """Draw a problem and a constraint of each kind."""
    rng = random.Random(seed)
    problem = random_problem(seed, list(ContainerRule)[seed % 2], units=6)
    prices = {motion: Fraction(place * place, 10) for place, motion in enumerate(MOTIONS)}
    problem = replace(problem, unit_prices=UnitPrices(prices, {}))
    rules: dict[str, dict[str, Any]] = {}
    while len(rules) < 19:
        rule = random_rule(rng, problem)
        rules[rule["rule"]] = rule
    return problem, [rules[name] for name in sorted(rules)], rng


def trees(problem: Problem) -> Iterator[tuple[frozenset[int], tuple[Any, ...]]]:
    for tree in task_trees.trees(problem):
        ids = frozenset(u for u in range(len(problem.network)) if problem.network.unit(u) in tree)
        yield ids, tree


@pytest.mark.parametrize("seed", SEEDS)
def test_a_tree_keeps_to_a_constraint_by_its_words(seed: int) -> None:
    problem, rules, rng = drawn(seed)
    every = frozenset(range(len(problem.network)))
    found = [*trees(problem)]
    for rule in rules:
        arrays = Arrays(problem, (Objective.UNITS,), Coverage((rule,)))
        for units, tree in found:
            kept = keeps(problem, tree, rule)
            assert (arrays.ruled.fault(units, every - units) is None) == kept, (rule, units)
            actions = arrays.actions(sorted(units))
            breaking = arrays.breaking_actions(frozenset(actions))
            assert derives(arrays, actions) == (kept or bool(breaking)), (rule, units)
            assert not kept or not breaking
            # what is barred from some trees is in none of them
            used = frozenset(a for a in actions if rng.random() < 0.5)
            without = frozenset(u for u in every - units if rng.random() < 0.5)
            for barred in arrays.barred_actions(used, without).values():
                assert not kept or units.isdisjoint(barred), (rule, units, used, without)


def derives(arrays: Arrays, actions: list[int]) -> bool:
    """Whether actions reach the goals, all of them running, within limits and with none that is forbidden."""
    graph, at_hand, left = arrays.graph, set(arrays.graph.start), set(actions)
    while ready := {a for a in left if at_hand.issuperset(graph.needs[a])}:
        left -= ready
        at_hand.update(o for a in ready for o in graph.gives[a])
    spent = [sum(amounts.get(a, 0) for a in actions) for amounts, _ in arrays.limits]
    return (
        not left
        and not arrays.ruled.never
        and at_hand.issuperset(arrays.goals)
        and arrays.forbidden.isdisjoint(actions)
        and all(total <= most for total, (_, most) in zip(spent, arrays.limits, strict=True))
    )


# --- By hand.


def small(*units: str, rule: ContainerRule = ContainerRule.STRICT) -> Problem:
    """Make a problem of units such as ``mix: a, b > end``, which is the goal; what none makes is at hand."""
    builder = NetworkBuilder()
    made: set[ObjectNode] = set()
    for line, unit in enumerate(units, 1):
        motion, _, nodes = unit.partition(": ")
        inputs, outputs = ([parse_node(node) for node in side.split(", ")] for side in nodes.split(" > "))
        builder.add(motion, inputs, outputs, Source(f"{motion}.txt", line))
        made.update(outputs)
    network = builder.build()
    kitchen = frozenset(o for o, node in enumerate(network.objects) if node not in made)
    (goal,) = (o for o, node in enumerate(network.objects) if node.label == "end")
    return Problem(network, kitchen, (goal,), None, frozenset({"cup", "pan"}), rule)


def arrays_of(problem: Problem, *rules: dict[str, Any]) -> Arrays:
    return Arrays(problem, (Objective.UNITS,), Coverage(rules))


def barred(arrays: Arrays, used: set[int], without: set[int]) -> frozenset[int]:
    (found,) = arrays.barred_actions(frozenset(used), frozenset(without)).values()
    return found


def test_what_is_barred_where_a_motion_has_to_come_before_another() -> None:
    kitchen = small(
        *("cut: start > a", "mix: a > b", "mix: start > b"),
        *("fry: b > end", "fry: a > end", "fry: start > end"),
        *("mix: x > b", "mix: start > x"),
    )
    arrays = arrays_of(kitchen, {"rule": "before", "earlier_motion": "cut", "later_motion": "fry"})
    assert barred(arrays, set(), set()) == {5}  # which never runs on what was cut
    assert barred(arrays, {2}, set()) == {3, 5}  # there is a b that was not
    assert barred(arrays, set(), {1}) == {3, 5}  # nothing makes a b of what was cut
    assert barred(arrays, set(), {0}) == {3, 4, 5}
    same = arrays_of(kitchen, {"rule": "before", "earlier_motion": "fry", "later_motion": "fry"})
    assert barred(same, set(), {3, 4, 5}) == frozenset()
    # a tree that breaks it is told by as few units as do, what they bar first
    assert arrays.breaking_actions(frozenset({0, 1, 3, 4})) == []
    assert arrays.breaking_actions(frozenset({0, 2, 3, 4})) == [3, 2]
    assert arrays.breaking_actions(frozenset({0, 1, 5})) == [5]


def test_what_is_barred_by_claims_of_units() -> None:
    claims = [[[0], []], [[], [1, 2]], [[3, 4], [5]], [[6], [7]], [[8, 9], []]]
    own = owning(*claims)
    arrays = arrays_of(small(*(f"mix: start > x{n}, end" for n in range(10))), own)
    assert arrays.forbidden == {0}
    assert [arrays.ruled.makers[goal] for goal in arrays.ruled.goals] == [[1, 2]]
    for used, without, expected in (
        ({3}, {5}, {4}),
        ({3, 4, 1}, {5, 2}, {3, 4}),
        ({6}, {7}, {6}),
        ({8}, set(), {9}),
        ({9}, {7}, {6, 8}),
    ):
        assert barred(arrays, used, without) == expected
    every = frozenset(range(10))
    for units, fault in (
        ({1}, "breaks a rule"),  # has not 7, so 6 is barred: but 6 is not there
        ({0, 1}, "has unit 0, which a rule removes"),
        ({3}, "lacks what a rule asks for"),
        ({1, 8, 9}, "breaks a rule"),
    ):
        found = arrays.ruled.fault(frozenset(units), every - units)
        assert found == (None if units == {1} else fault)
    assert arrays.ruled.fault(frozenset({2, 3, 4, 5, 6, 7}), every - {2, 3, 4, 5, 6, 7}) is None
    assert sources_read(own, arrays.problem.network) is None
    alone = {**own, "claims": claims[:2]}
    assert arrays_of(arrays.problem, alone).ruled.barred == {}


def test_an_intermediate_is_made_by_one_and_needed_by_another() -> None:
    def kept(units: set[int], problem: Problem, label: str = "cup") -> bool:
        arrays = arrays_of(problem, {"rule": "require_intermediate", "required_intermediate": label})
        return arrays.ruled.fault(frozenset(units), frozenset()) is None

    units = ("fill: tea > cup; contains {salt}", "pour: cup; contains {salt}, salt; in [cup] > end")
    assert kept({0, 1}, small(*units))
    assert not kept({1}, small(*units))
    assert not kept({0}, small(*units))
    assert not kept({0, 1}, small(*units, rule=ContainerRule.IMPLIED))  # where no unit needs the cup
    assert not kept({1}, small(units[1]))
    assert not kept({0, 1}, small(*units), "tea")
    # a unit that has it makes none
    assert not kept({1, 2}, small(*units, "wash: cup; contains {salt} > cup; contains {salt}"))


def test_which_constraints_only_remove_units_and_which_look_at_places() -> None:
    assert {name for name, constraint in LIBRARY.items() if constraint.removes} == {
        *("forbid_motion", "forbid_object", "least_rate", "only_sources", "at_least_videos"),
        *("motion_only_with", "never_heated"),
    }
    network = small("mix: a > b", "cut: b > end").network
    assert sources_read({"rule": "only_sources", "allowed": ["cut.txt", "no.txt"]}, network) == [
        [],
        ["cut.txt"],
    ]
    assert sources_read({"rule": "at_least_videos", "least_videos": 1}, network) == [[], []]
    assert sources_read({"rule": "forbid_motion", "forbidden_motion": "cut"}, network) is None


def test_what_is_wrong_with_a_tree_is_named() -> None:
    def units(*numbers: int) -> frozenset[int]:
        return frozenset(numbers)

    ways = [[units(0, 1)]], [[units(1), units(0)], [units(2)]]
    things = [(units(0), Fraction(1)), (units(1, 2), Fraction(2)), (units(0), Fraction(3))]
    ruled = CompiledRules(
        [
            Meaning(units(7), barred=lambda used, without: used | without),
            Meaning(units(8), [*ways], things, Fraction(4)),
            Meaning(never=True, counted_sets=[(units(2), Fraction(1, 2))], max_sum=Fraction(1)),
        ],
        10,
        20,
    )
    assert ruled.removed == {7, 8}
    assert (ruled.never, set(ruled.barred)) == ({2}, {0})
    assert [limit.remaining({0, 21, 5}) for limit in ruled.limits.values()] == [-2, 1]
    assert ruled.barred_units(units(1), units(2)) == {0: {1, 2}}
    for tree, fault in (
        (units(0, 7), "has unit 7, which a rule removes"),
        (units(0), "lacks what a rule asks for"),
        (units(0, 2), "exceeds what a rule limits"),
        (units(1, 2), "breaks a rule"),
    ):
        assert ruled.fault(tree, units()) == fault


def test_items_are_counted_under_rules_that_have_steps() -> None:
    kitchen = small("fill: tea > pan", "fry: pan > cup", "pour: cup > end", "drink: tea > end")
    utensils: dict[str, Any] = {"rule": "at_most_utensils", "max_utensils": 1}
    fry: dict[str, Any] = {"rule": "require_motion", "required_motion": "fry"}
    for most, rules, units in ((2, (utensils, fry), [0, 1, 2]), (1, (utensils,), [3])):
        given = tuple({**rule, **({"max_utensils": most} if rule is utensils else {})} for rule in rules)
        for objectives in ((Objective.KITCHEN, Objective.UNITS), (Objective.UNITS,)):
            found = certify(kitchen, objectives, units, Coverage(given))
            assert found is not None
            costs = verify(read_certificate(found.text()), subject_of(kitchen)).costs
            assert costs == ((1, len(units)) if len(objectives) > 1 else (len(units),))


# --- Certificates.


def in_order(problem: Problem, units: frozenset[int]) -> list[int]:
    """Put the units of a tree into an order in which they run."""
    at_hand, left, order = set(problem.kitchen), set(units), list[int]()
    while left:
        unit = min(u for u in left if at_hand.issuperset(problem.needs[u]))
        left.remove(unit)
        order.append(unit)
        at_hand.update(problem.gives[unit])
    return order


@pytest.mark.parametrize("seed", range(4))
def test_what_is_best_under_each_constraint_is_certified_without_a_search(seed: int) -> None:
    problem, rules, _ = drawn(seed)
    found = [*trees(problem)]
    objective = (Objective.UNITS, Objective.KITCHEN, Objective.INPUTS, Objective.PRICE)[seed % 4]
    for rule in rules:
        covered = Coverage((rule,))
        costs = {
            units: problem.costs(in_order(problem, units)).measure(objective)
            for units, tree in found
            if keeps(problem, tree, rule)
        }
        if not costs:
            certificate = certify_infeasible(problem, covered)
            assert certificate is not None, rule
            assert certificate.claim == "infeasible"
            continue
        assert certify_infeasible(problem, covered) is None
        best = min(costs, key=lambda units: (costs[units], sorted(units)))
        certificate = certify(problem, (objective,), in_order(problem, best), covered)
        assert certificate is not None, rule
        assert certificate.claim == "optimal"
        verified = verify(read_certificate(certificate.text()), subject_of(problem))
        assert (verified.tree, verified.costs) == (tuple(in_order(problem, best)), (costs[best],))
        assert verified.rules == (rule,)
        worst = max(costs, key=lambda units: (costs[units], sorted(units)))
        if costs[worst] > costs[best]:
            with pytest.raises(NotBestError) as better:
                certify(problem, (objective,), in_order(problem, worst), covered)
            assert costs[frozenset(better.value.units)] < costs[worst]


def owning(*claims: list[list[int]]) -> dict[str, Any]:
    """Give what is claimed of rules of the user's own."""
    return {"rule": OWN, "claims": [*claims], "constants": [], "files": [], "library": [], "limits": []}


def test_of_what_is_claimed_a_certificate_has_what_its_cuts_need() -> None:
    kitchen = small("cut: start > a", "mix: a > end", "boil: start > end", "junk: start > x", "fry: b > x")
    own = owning([[2], []], [[3], []], [[], [1, 3]], [[4], [0]])
    motion = {"rule": "forbid_motion", "forbidden_motion": "boil"}
    assert without_unused_claims((motion, own), [0, 1, 2]) == (
        motion,
        {**own, "claims": [own["claims"][n] for n in (0, 2, 3)]},
    )
    assert without_unused_claims((own,), []) == ({**own, "claims": [own["claims"][n] for n in (2, 3)]},)
    removed = owning([[2], []], [[3], []])
    certificate = certify(kitchen, (Objective.UNITS,), [0, 1], Coverage((removed,)))
    assert certificate is not None
    assert [rule["claims"] for rule in certificate.content["rules"]] == [[[[2], []]]]
    # where all is known of the rules, nothing is left out
    assert Coverage((removed,)).partial
    assert not Coverage((motion,)).partial
    plain = certify(kitchen, (Objective.UNITS,), [0, 1], Coverage((motion,)))
    assert plain is not None
    assert plain.content["rules"] == [motion]


def test_cuts_may_have_nodes_that_a_search_added() -> None:
    kitchen = small("cut: start > a", "mix: a > end", "boil: start > end")
    nodes = len(kitchen.network.objects)
    (end,) = kitchen.goals
    certificate = certify(kitchen, (Objective.UNITS,), [2], cuts=[[end, nodes], [end, nodes + 7]])
    assert certificate is not None
    assert certificate.content["cuts"] == [[end]]


def test_a_goal_that_no_tree_may_have_is_proved_by_its_constraint() -> None:
    kitchen = small("cut: start > end", "mix: b > a")
    rules = [{"rule": "forbid_ingredient", "allergen": names} for names in (["end", "x"], ["end"])]
    certificate = certify_infeasible(kitchen, Coverage((*rules,)))
    assert certificate is not None
    assert certificate.content["proof"] == {"broken": 0}
    assert certify_infeasible(kitchen, Coverage(({**rules[0], "allergen": ["a"]},))) is None


def test_certificates_say_where_they_come_from_only_if_rates_are_those_of_motions() -> None:
    kitchen = small("cut: start > end")
    fixed = replace(kitchen, own_rates={0: Fraction(1, 2)})
    motion = {"rule": "forbid_motion", "forbidden_motion": "cut"}
    assert certify_infeasible(kitchen, Coverage((motion,))) is not None
    assert certify_infeasible(fixed, Coverage((motion,))) is None
    assert certify(fixed, (Objective.UNITS,), [0], Coverage(({**motion, "forbidden_motion": "no"},))) is None
    assert certify(fixed, (Objective.UNITS,), [0]) is not None


def test_clingo_that_does_not_finish_checks_nothing() -> None:
    kitchen = small("cut: start > end", "mix: start > end")
    for tree, claims in (([0], []), (None, [[[1], []]])):
        own = owning(*claims)
        content = {"tree": tree, "objective": ["units"] if tree else []}
        with pytest.raises(CheckLimitError, match="clingo does not finish"):
            check_with_clingo(content, own, kitchen, Deadline(0.0))
    check_with_clingo({"tree": [0], "objective": ["units", "mine"]}, owning(), kitchen)
    with pytest.raises(RefusedError, match="is not true"):
        check_with_clingo({"tree": None, "objective": []}, owning([[1], []]), kitchen)


def test_what_a_rule_bars_counts_in_a_proof() -> None:
    problem = small("cut: start > a", "bake: a > end", "fry: start > end")
    before = {"rule": "before", "earlier_motion": "cut", "later_motion": "fry"}
    found = certify(problem, (Objective.UNITS,), (0, 1), Coverage((before,)))
    assert found is not None
    assert (found.claim, found.content["rules"]) == ("optimal", [before])
    with pytest.raises(NotBestError):
        certify(problem, (Objective.UNITS,), (0, 1))
