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
from foon_asp.asp.bare_program import bare_program
from foon_asp.asp.session import Session
from foon_asp.certificate import certify, certify_infeasible
from foon_asp.engines.highs import solve_with_highs
from foon_asp.network import (
    LEVELS,
    Network,
    NetworkBuilder,
    ObjectNode,
    Source,
    TaskTree,
    UnitPrices,
    network_at_level,
    node_at_level,
    unit_at_level,
)
from foon_asp.problem import ContainerRule, Objective, Problem, executable_order, first_tree, reach, relevant
from foon_asp.proof.simulation import Verdict, simulate, simulate_for
from foon_asp.proof.verify import VERSION, RefusedError, seal
from foon_asp.questions.diff import side
from foon_asp.questions.menu import menu
from foon_asp.reduce import ALL, NONE
from foon_asp.search import SEARCHES, Ending, SearchSettings
from tests import oracle
from tests.conftest import Cli
from tests.handmade_certificate import before_rules, check, older
from tests.random_problems import random_problem

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

WATER = ObjectNode.of("water", [], [("in", "pot")])
POT = ObjectNode.of("pot", [], [], [("contains", ["water"])])
HOT = ObjectNode.of("hot water")
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


def test_facts_say_both_what_is_put_out_and_what_is_made() -> None:
    facts = bare_program(ask(HOT), (Objective.UNITS,), Settings(), {}).facts
    assert "output(0,1). output(0,2). gives(0,2)." in facts
    strict = bare_program(
        ask(HOT, ContainerRule.STRICT, (WATER, POT)), (Objective.UNITS,), Settings(), {}
    ).facts
    assert "output(0,1). output(0,2). gives(0,1). gives(0,2)." in strict


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


def test_a_session_says_the_same() -> None:
    of, session = network(FILL), Session()
    settings = Settings((Path("forbid_motion"),), constants=("forbidden_motion=fry",), session=session)
    for kitchen, units in (((WATER,), None), ((WATER, TAP, EMPTY), (1,)), ((WATER,), None), ((POT,), ())):
        for _ in range(2):
            assert solve(ask(POT, kitchen=kitchen, of=of), (), settings).units == units


def test_the_checker_and_the_plain_searches_do_without_it() -> None:
    problem = ask(POT)
    reached = reach(problem)
    assert not reached.available[problem.goals[0]]
    assert reached.units == (0,)
    assert first_tree(problem, reached) is None
    assert relevant(problem, reached) == ()
    found = simulate_for(problem, problem.tree([0]))
    assert found.verdict is Verdict.NEVER
    assert found.obstacle is not None
    assert (found.obstacle.unit, found.obstacle.missing) == (None, POT)

    boil = ("boil", [POT], [ObjectNode.of("steam")])
    circle = ask(boil[2][0], of=network(boil))
    assert executable_order(circle, [0, 1]) is None
    found = simulate_for(circle, circle.tree([0, 1]))
    assert found.verdict is Verdict.NEVER
    assert found.obstacle is not None
    assert (found.obstacle.unit, found.obstacle.missing, found.obstacle.cycle) == (1, POT, ())


def test_the_published_searches_take_it_as_made_and_the_verdict_does_not() -> None:
    problem = ask(POT)
    for name, search in SEARCHES.items():
        found = search.run(problem, SearchSettings())
        if name == "ids":
            assert found.ending is Ending.NONE
        else:
            assert found.units == (0,)
            assert simulate_for(problem, problem.tree(found.units)).verdict is Verdict.NEVER


def test_why_there_is_none(cli: Cli, tmp_path: Path) -> None:
    (root,) = why_not(ask(POT)).roots
    assert ask(POT).network.objects[root.object] == POT
    asked = written(tmp_path)
    ran = cli("why-not", *asked, "--goal", str(POT), "--containers", "implied")
    assert "taken as given, and so not made, by heat" in ran.out
    ran = cli("solve", *asked, "--goal", str(POT), "--containers", "implied")
    assert ran.code == 1
    assert f"no unit makes {POT}" in ran.out + ran.err
    assert "1 unit took it as given, and so did not make it" in ran.out + ran.err


def test_another_engine_says_the_same() -> None:
    answer = solve_with_highs(ask(POT), (Objective.UNITS,), frozenset(), 60.0)
    assert answer.finished
    assert answer.units is None


# --- Certificates


def test_that_there_is_no_tree_is_certified() -> None:
    problem = ask(POT)
    found = certify_infeasible(problem)
    assert found is not None
    assert found.content["version"] == VERSION
    assert check(found.content, problem).claim == "infeasible"


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
        (VERSION, "the tree does not make every goal"),
        (1, "had skipped.*certify again"),
        (VERSION + 1, f"version {VERSION}"),
    ],
)
def test_a_certificate_of_the_old_rule_is_refused(version: int, words: str) -> None:
    problem = ask(POT)
    content = forged(problem) | {"version": version}
    if version == 1:
        content = before_rules(content)
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


def test_version_1_holds_under_strict_containers() -> None:
    problem = ask(HOT, ContainerRule.STRICT, (WATER, POT))
    found = certify(problem, (Objective.UNITS,), [0])
    assert found is not None
    old = before_rules(found.content) | {"version": 1, "digests": older(problem)}
    old["seal"] = seal(old)
    assert check(old, problem).claim == "optimal"
    for version in (0, VERSION + 1, True, "1", 1.0, None):
        other = old | {"version": version}
        other["seal"] = seal(other)
        with pytest.raises(RefusedError, match="version"):
            check(other, problem)


# --- Levels


@pytest.mark.parametrize("level", LEVELS)
def test_levels(level: int) -> None:
    """Hot water is made at every level, and the pot, which was skipped, at none."""
    of = network_at_level(network(), level)
    water, pot, hot = (node_at_level(node, level) for node in (WATER, POT, HOT))
    problem = ask(pot, kitchen=(water,), of=of)
    assert solve(problem, ()).status is Status.INFEASIBLE
    assert solve(ask(hot, kitchen=(water,), of=of), ()).units == (0,)
    unit = unit_at_level(network().unit(0), level)
    found = simulate(TaskTree((unit,)), frozenset({water}), (pot,), problem.containers, problem.utensils, of)
    assert found.verdict is Verdict.NEVER
    certificate = certify_infeasible(problem)
    assert certificate is not None
    assert check(certificate.content, problem).level == level


@pytest.mark.parametrize("level", [1, 2])
def test_a_unit_gives_what_one_of_its_level_3_units_does(level: int) -> None:
    """Of the pot of water a pot of soup is made, which is the pot again at the levels below."""
    soup = ObjectNode.of("pot", [], [], [("contains", ["soup", "water"])])
    of = network(("heat", [WATER, POT], [soup, HOT]))
    below = ask(
        node_at_level(POT, level), kitchen=(node_at_level(WATER, level),), of=network_at_level(of, level)
    )
    assert below.network.stands_for == ((0, 1),)
    assert {str(below.network.objects[o]) for o in below.gives[0]} == {"pot", "hot water"}
    assert solve(below, ()).units == (0,)
    assert solve(ask(soup, of=of), ()).units == (1,)


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
                    for node in oracle.made(detail, problem.containers, problem.utensils)
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
    assert cli("solve", *asked, *pot).code == 1
    ran = cli("solve", *asked, *hot)
    assert ran.code == 0
    assert "     → pot; contains {water}  (implied, not made here)\n     → hot water\n" in ran.out
    (unit,) = cli("solve", *asked, *hot, "--format", "json").json["units"]
    made = [(node["node"], node["made"]) for node in unit["outputs"]]
    assert made == [("pot; contains {water}", False), ("hot water", True)]
    tree = tmp_path / "tree.txt"
    tree.write_text(cli("solve", *asked, *hot, "--format", "foon").out)
    assert "S\tcontains\t{water}\n" in tree.read_text()
    ran = cli("check", tree, *asked, *pot)
    assert ran.code == 1
    assert "every unit runs, but the goal is not made: pot; contains {water}; unit 1, heat    [" in ran.out
    assert "], took it as given, and so did not make it\n" in ran.out
    assert cli("check", tree, *asked, *hot).code == 0
    ran = cli("search", "bfs", *asked, *pot)
    assert "does not execute" in ran.out
    (row,) = cli("compare", *asked, *pot, "--search", "bfs", "--format", "json").json["comparisons"]
    assert row["optimum"]["units"]["status"] == "infeasible"
    assert row["searches"][0]["verdict"] == "does not execute"


def test_in_a_picture_no_arrow_leads_to_what_was_skipped(cli: Cli, tmp_path: Path) -> None:
    asked = (*written(tmp_path), "--goal", str(HOT), "--containers", "implied")
    drawn = cli("draw", *asked, "--format", "dot").out
    pots = re.findall(r'(o\d+) \[label="pot.*class="(\S+)', drawn)
    assert [kind for _, kind in pots] == ["object", "by-product"]
    arrows = re.findall(r"(\w+) -> (\w+)", drawn)
    assert [(tail, head) for tail, head in arrows if {tail, head} & {name for name, _ in pots}] == [
        (pots[0][0], "m0"),
        ("m0", pots[1][0]),
    ]


def test_two_trees_and_two_goals() -> None:
    """Where trees part, and which goals a unit serves: a pot that was skipped comes from nowhere."""
    boil = ("boil", [POT], [ObjectNode.of("steam")])
    of = network(FILL, boil)
    problem = ask(boil[2][0], kitchen=(WATER, TAP, EMPTY), of=of)
    listed = [(of.unit(unit), of.sources[unit][0]) for unit in (0, 1, 2)]
    kitchen, rule = frozenset((WATER, TAP, EMPTY)), problem.containers
    tree = side("tree", listed, [POT], kitchen, rule, problem.utensils, None, of)
    assert tree.origin(POT) == of.unit(1)
    assert tree.origin(HOT) == of.unit(0)
    bare = side("bare", listed[:1], [], kitchen, rule, problem.utensils, None, of)
    assert bare.origin(POT) is None

    hot = of.object_id(HOT)
    assert hot is not None
    found = menu(replace(problem, goals=(hot, *problem.goals)))
    assert found.serves == {0: (hot,), 1: problem.goals, 2: problem.goals}


def test_a_store_says_the_same(cli: Cli, tmp_path: Path) -> None:
    written(tmp_path)
    store = tmp_path / "kitchen.foon"
    assert cli("import", "--data", tmp_path, "--store", store).code == 0
    for goal, code in ((POT, 1), (HOT, 0)):
        ran = cli("solve", "--network", store, "--goal", str(goal), "--containers", "implied")
        assert ran.code == code, ran.err


def test_in_python(tmp_path: Path) -> None:
    written(tmp_path)
    with foon_asp.load(tmp_path) as foon:
        pot, hot = (foon.problem(str(goal), containers="implied") for goal in (POT, HOT))
        assert foon_asp.solve(pot).status == "infeasible"
        answer = foon_asp.solve(hot)
        assert answer.status == "optimal"
        assert answer.tree is not None
        assert [unit.motion for unit in answer.tree] == ["heat"]
        assert not foon_asp.check(pot, answer.tree).executes


# --- Random networks, where such units are frequent


@pytest.mark.slow
def test_it_matters_and_brute_force_agrees() -> None:
    """What the old rule gave away is counted, so that the networks are known to have it."""
    skipped = lost = 0
    for seed in range(500):
        problem = random_problem(seed, ContainerRule.IMPLIED, units=6)
        network = problem.network
        skipped += problem.gives != network.outputs
        old = set(problem.kitchen)
        for _ in range(len(network)):
            for unit, needs in enumerate(problem.needs):
                if old.issuperset(needs):
                    old.update(network.outputs[unit])
        possible = any(True for _ in oracle.trees(problem))
        assert possible == (solve(problem, ()).status is Status.OPTIMAL)
        assert possible == (certify_infeasible(problem) is None)
        lost += old.issuperset(problem.goals) and not possible
    assert skipped > 100
    assert lost > 5


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
