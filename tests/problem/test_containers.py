"""Nothing comes from nothing: a unit does not make a container that the rule ``implied`` let it skip.

A kitchen has water in a pot, and nothing of the pot itself. Heating needs the water and the pot of water, and
puts out the pot of water and hot water. Under ``implied`` the pot of water is skipped, so it is not made.
"""

import copy
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import why_not
from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify, certify_infeasible
from foon_asp.errors import UserError
from foon_asp.hypergraph import ALL, NONE
from foon_asp.network import (
    LEVELS,
    Network,
    NetworkBuilder,
    ObjectNode,
    Source,
    UnitPrices,
    network_at_level,
    node_at_level,
    unit_at_level,
)
from foon_asp.problem import (
    ContainerRule,
    Objective,
    Problem,
    executable_order,
    first_tree,
    reach,
    relevant_units,
)
from foon_asp.proof.certificate_header import TREE_FORM, seal
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.simulation import Verdict, simulate_for
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.support.handmade_certificate import check
from tests.support.random_problems import random_problem

WATER = ObjectNode.of("water", [], [("in", "pot")])
POT = ObjectNode.of("pot", [], [], [("contains", ["water"])])
HOT, STEAM = ObjectNode.of("hot water"), ObjectNode.of("steam")
TAP, EMPTY = ObjectNode.of("tap"), ObjectNode.of("pot", ["empty"])
FILES = {
    "FOON.txt": "O\twater\nS\tin\t[pot]\nO\tpot\nS\tcontains\t{water}\nM\theat\n"
    "O\tpot\nS\tcontains\t{water}\nO\thot water\n//\n",
    "kitchen.txt": "O\twater\nS\tin\t[pot]\n",
    "utensils.txt": "pot\n",
    "motion.txt": "heat\t0.5\n",
}


def network(*more: tuple[str, list[ObjectNode], list[ObjectNode]]) -> Network:
    """Heat, as unit 0, and what is added to it."""
    builder = NetworkBuilder()
    builder.add("heat", [WATER, POT], [POT, HOT], Source("heat", 1))
    for line, (motion, inputs, outputs) in enumerate(more, 2):
        builder.add(motion, inputs, outputs, Source("more", line))
    return builder.build()


def ask(
    goal: ObjectNode,
    rule: ContainerRule = ContainerRule.IMPLIED,
    kitchen: tuple[ObjectNode, ...] = (WATER,),
    of: Network | None = None,
) -> Problem:
    of = of or network()
    ids = [of.object_id(node) for node in (goal, *kitchen)]
    assert None not in ids
    goal_id, *at_hand = (o for o in ids if o is not None)
    rates = dict.fromkeys(of.motions, Fraction(1, 2))
    prices = UnitPrices(dict.fromkeys(of.motions, Fraction(2)), {})
    given = of, frozenset(at_hand), (goal_id,), rates, frozenset({"pot"}), rule
    return Problem(*given, unit_prices=prices)


# The unit that fills: with a tap and an empty pot at hand, the pot of water is made in one step.
FILL = ("fill", [TAP, EMPTY], [POT, WATER])


# --- What a unit makes


def test_a_unit_gives_its_outputs_without_what_it_skipped() -> None:
    problem = ask(HOT)
    named = problem.network.objects
    assert [named[o] for o in problem.needs[0]] == [WATER]
    assert [named[o] for o in problem.gives[0]] == [HOT]
    assert problem.makers == ((), (), (0,))
    strict = ask(HOT, ContainerRule.STRICT)
    assert strict.gives == strict.network.outputs
    assert strict.makers == strict.network.producers


def test_what_is_needed_and_put_out_is_given_and_what_is_new_is() -> None:
    """Two ingredients imply nothing, and a pot of something else is another node."""
    stew = ObjectNode.of("pot", [], [], [("contains", ["onion", "water"])])
    of = network(("stir", [WATER, stew], [stew]), ("season", [WATER, POT], [stew]))
    problem = ask(HOT, of=of)
    assert [[of.objects[o] for o in gives] for gives in problem.gives] == [[HOT], [stew], [stew]]
    with pytest.raises(UserError, match="no goal is given"):
        replace(problem, goals=())


# --- Every room says that the pot cannot be had


@pytest.mark.parametrize("encodings", [None, Path("by_need")])
@pytest.mark.parametrize("reductions", [NONE, ALL], ids=["not reduced", "reduced"])
@pytest.mark.parametrize("objective", Objective)
def test_the_pot_is_not_made_and_hot_water_is(
    encodings: Path | None, reductions: Any, objective: Objective
) -> None:
    settings = Settings(encodings=encodings, reductions=reductions)
    assert solve(ask(POT), (objective,), settings).status is Status.INFEASIBLE
    assert solve(ask(HOT), (objective,), settings).units == (0,)
    filled = ask(POT, kitchen=(WATER, TAP, EMPTY), of=network(FILL))
    assert solve(filled, (objective,), settings).units == (1,)


def test_the_checker_and_the_plain_searches_do_without_it() -> None:
    problem = ask(POT)
    reached = reach(problem)
    assert not reached.available[problem.goals[0]]
    assert reached.units == (0,)
    assert first_tree(problem, reached) is None
    assert relevant_units(problem, reached) == ()
    boil = ("boil", [POT], [STEAM])
    circle = ask(boil[2][0], of=network(boil))
    assert executable_order(circle, [0, 1]) is None
    found = simulate_for(circle, circle.tree([0, 1]))
    assert found.verdict is Verdict.NEVER
    assert found.obstacle is not None
    assert (found.obstacle.unit, found.obstacle.missing, found.obstacle.cycle) == (1, POT, ())


def test_why_there_is_none(cli: Cli, tmp_path: Path) -> None:
    (root,) = why_not(ask(POT)).roots
    assert root.object.node == str(POT)
    asked = written(tmp_path)
    ran = cli("why-not", *asked, "--goal", str(POT), "--containers", "implied")
    assert "taken as given, and so not made, by heat" in ran.out
    ran = cli("solve", *asked, "--goal", str(POT), "--containers", "implied")
    assert ran.code == 1
    assert f"no unit makes {POT}" in ran.out + ran.err
    assert "1 unit took it as given, and so did not make it" in ran.out + ran.err


# --- Certificates


def forged(problem: Problem) -> dict[str, Any]:
    """Say what the rule said before: heat makes the pot of water, at the cost of one unit."""
    honest = certify(ask(HOT), (Objective.UNITS,), [0])
    assert honest is not None
    content = copy.deepcopy(honest.content)
    goal = problem.goals[0]
    content |= {"goals": [{"id": goal, "node": str(problem.network.objects[goal])}], "cuts": [[goal]]}
    return content


@pytest.mark.parametrize(
    ("version", "words"),
    [
        (TREE_FORM.version, "the tree does not make every goal"),
        (1, f"version {TREE_FORM.version}"),
        (TREE_FORM.version + 1, f"version {TREE_FORM.version}"),
    ],
)
def test_a_certificate_of_the_old_rule_is_refused(version: int, words: str) -> None:
    problem = ask(POT)
    content = forged(problem) | {"version": version}
    content["seal"] = seal(content)
    with pytest.raises(RefusedError, match=words):
        check(content, problem)


def test_a_cut_is_not_crossed_by_a_unit_that_skips() -> None:
    """With the pot of water skipped, heat is no member of its cut: only fill is, which costs 1."""
    problem = ask(POT, kitchen=(WATER, TAP, EMPTY), of=network(FILL))
    honest = certify(problem, (Objective.UNITS,), [1])
    assert honest is not None
    (cut,) = honest.content["cuts"]
    assert problem.goals[0] in cut
    hopeless = copy.deepcopy(honest.content)  # fill makes the pot: that nothing does is refused
    hopeless |= {
        "claim": "infeasible",
        "tree": None,
        "costs": None,
        "objective": [],
        "proof": {"hopeless": 0},
    }
    hopeless["seal"] = seal(hopeless)
    with pytest.raises(RefusedError, match="crossed"):
        check(hopeless, problem)


def test_a_certificate_of_another_version_is_refused() -> None:
    problem = ask(HOT, ContainerRule.STRICT, (WATER, POT))
    found = certify(problem, (Objective.UNITS,), [0])
    assert found is not None
    for version in (0, TREE_FORM.version - 1, TREE_FORM.version + 1, True, "1", 1.0, None):
        other = found.content | {"version": version}
        other["seal"] = seal(other)
        with pytest.raises(RefusedError, match="version"):
            check(other, problem)


# --- Levels


@pytest.mark.parametrize("level", LEVELS)
def test_levels(level: int) -> None:
    """Hot water and steam are made at every level, and the pot, which was skipped, at none."""
    cups = [ObjectNode.of("cup", [str(state)]) for state in range(4)]
    washing = ("wash", cups[:1], cups[1:2]), ("wash", cups[2:3], cups[3:])  # at level 1, one unit
    of = network_at_level(network(*washing, ("boil", [WATER, POT], [POT, STEAM])), level)
    water, pot = (node_at_level(node, level) for node in (WATER, POT))
    problem = ask(pot, kitchen=(water,), of=of)
    assert solve(problem, ()).status is Status.INFEASIBLE
    for goal in (HOT, STEAM):
        outcome = solve(ask(node_at_level(goal, level), kitchen=(water,), of=of), ())
        assert outcome.status is Status.OPTIMAL
    certificate = certify_infeasible(problem)
    assert certificate is not None
    assert check(certificate.content, problem).level == level


def test_random_units_give_the_image_of_what_their_level_3_units_give() -> None:
    less = 0
    for seed in range(150):
        problem = random_problem(seed, ContainerRule.IMPLIED)
        units = [problem.network.unit(u) for u in range(len(problem.network))]
        whole = [problem.network.objects[o] for o in problem.kitchen]
        for level in LEVELS:
            of = network_at_level(problem.network, level)
            at_hand = frozenset(
                o for o in (of.object_id(node_at_level(n, level)) for n in whole) if o is not None
            )
            below = Problem(of, at_hand, (0,), None, problem.utensils, problem.containers)
            for unit, gives in enumerate(below.gives):
                expected = {
                    node_at_level(node, level)
                    for detail in units
                    if unit_at_level(detail, level) == of.unit(unit)
                    for node in task_trees.made(detail, problem.containers, problem.utensils)
                }
                assert {of.objects[o] for o in gives} == expected
                assert gives == tuple(o for o in of.outputs[unit] if o in gives)
                less += len(gives) < len(of.outputs[unit])
            for o, makers in enumerate(below.makers):
                assert makers == tuple(u for u in range(len(of)) if o in below.gives[u])
    assert less > 200


# --- From outside


def written(folder: Path, *options: str) -> tuple[object, ...]:
    for name, text in FILES.items():
        (folder / name).write_text(text)
    return ("--data", folder, *options)


def test_the_command_line(cli: Cli, tmp_path: Path) -> None:
    asked = written(tmp_path)
    pot, hot = (("--goal", goal, "--containers", "implied") for goal in (str(POT), str(HOT)))
    ran = cli("solve", *asked, *hot)
    assert ran.code == 0
    assert "     → pot; contains {water}  (implied, not made here)\n     → hot water\n" in ran.out
    (unit,) = cli("solve", *asked, *hot, "--format", "json").json["units"]
    made = [(node["node"], node["made"]) for node in unit["outputs"]]
    assert made == [("pot; contains {water}", False), ("hot water", True)]
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", *asked, *hot, "--format", "foon").out)
    ran = cli("check", tree, *asked, *pot)
    assert ran.code == 1
    assert "every unit runs, but the goal is not made: pot; contains {water}; unit 1, heat    [" in ran.out
    assert "], took it as given, and so did not make it\n" in ran.out
    assert cli("check", tree, *asked, *hot).code == 0
    (row,) = cli("compare", *asked, *pot, "--search", "bfs", "--format", "json").json["comparisons"]
    assert row["optimum"]["units"]["status"] == "infeasible"
    assert row["searches"][0]["verdict"] == "does not execute"


def test_in_a_picture_no_arrow_leads_to_what_was_skipped(cli: Cli, tmp_path: Path) -> None:
    asked = (*written(tmp_path), "--goal", str(HOT), "--containers", "implied")
    drawn = cli("view", *asked, "--format", "dot").out
    (before, kind), (after, other) = re.findall(r'(o\d+) \[label="pot.*class="(\S+)', drawn)
    assert (kind, other) == ("object", "by-product")
    arrows = re.findall(rf"\w+ -> {after}\b|{before} -> \w+|\w+ -> {before}\b|{after} -> \w+", drawn)
    assert arrows == [f"{before} -> m0", f"m0 -> {after}"]


def test_a_pot_that_was_skipped_serves_no_goal() -> None:
    boil = ("boil", [POT], [STEAM])
    of = network(FILL, boil)
    problem = ask(boil[2][0], kitchen=(WATER, TAP, EMPTY), of=of)
    hot = of.object_id(HOT)
    assert hot is not None
    found = foon_asp.solve(replace(problem, goals=(hot, *problem.goals)))
    assert isinstance(found.serves, tuple)
    served = {each.unit: tuple(node.id for node in each.goals) for each in found.serves}
    assert served == {0: (hot,), 1: problem.goals, 2: problem.goals}


def test_a_tree_under_strict_containers_is_one_under_implied_ones() -> None:
    """The first unit that makes a node has it in no input, so it makes the node under either rule."""
    trees = 0
    for seed in range(300):
        strict = random_problem(seed, ContainerRule.STRICT)
        units = solve(strict, ()).units
        if units is not None:
            implied = replace(strict, containers=ContainerRule.IMPLIED)
            assert simulate_for(implied, implied.tree(units)).verdict is Verdict.AS_LISTED
            trees += bool(units)
    assert trees > 80
