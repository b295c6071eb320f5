"""Answers under rules of every class, against all trees that keep to them."""

from collections.abc import Iterable
from functools import cache

import pytest
from clingo import Control

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.encoding.cost_scales import Scales
from foon_asp.encoding.fact_writer import write_facts
from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, reach
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import RuleText
from tests.rules.test_explained_rules import WRITTEN
from tests.support.random_problems import random_problem, random_steps
from tests.support.random_rules import RandomRules

UNITS = (Objective.UNITS,)
Tree = frozenset[int]


@cache
def _task_tree() -> str:
    return (encodings_folder() / "task_tree.lp").read_text()


def kept(problem: Problem, rules: str, units: Iterable[int]) -> set[Tree] | None:
    """Give all trees that keep to rules, with only some units in the facts; ``None`` for faulty rules."""
    chosen = sorted(units)
    facts = write_facts(problem, chosen, Scales(problem, chosen), [("source", 2), ("video", 2)])
    control = Control(["0", "--project=show"], logger=lambda *_: None)
    try:
        control.add("base", [], f"{_task_tree()}{facts}{rules}#show use/1.\n")
        control.ground([("base", [])])
    except RuntimeError:
        return None
    found: set[Tree] = set()
    control.solve(
        on_model=lambda model: found.add(
            frozenset(atom.arguments[0].number for atom in model.symbols(shown=True))
        )
    )
    return found


def check(problem: Problem, text: str) -> int:
    """Hold answers against all trees that keep to rules; says how many there are."""
    trees, settings = kept(problem, text, reach(problem).units), Settings((RuleText(text),))
    if trees is None:
        with pytest.raises(UserError):
            solve(problem, UNITS, settings)
        return 0
    outcome = solve(problem, UNITS, settings)
    if not trees:
        assert outcome.status is Status.INFEASIBLE, text
        return 0
    assert outcome.status is Status.OPTIMAL, text
    assert frozenset(outcome.units or ()) in trees, text
    assert len(outcome.units or ()) == min(map(len, trees)), text
    minimal = {tree for tree in trees if not any(other < tree for other in trees)}
    if len(minimal) < 9:
        assert {frozenset(units) for units, _ in Ranked(problem, UNITS, settings)} == minimal, text
    return len(trees)


def problem_of(seed: int) -> Problem:
    rule = ContainerRule.IMPLIED if seed % 2 else ContainerRule.STRICT
    return random_steps(seed, rule, 6) if seed % 3 else random_problem(seed, rule, units=6)


@pytest.mark.parametrize(
    "seeds", [range(24), pytest.param(range(24, 2000), marks=pytest.mark.nightly)], ids=["few", "many"]
)
@pytest.mark.parametrize("near", [False, True], ids=["any", "of one unit"])
def test_random_rules(near: bool, seeds: range) -> None:
    kept_to = 0
    for seed in seeds:
        problem = problem_of(seed)
        drawn = RandomRules(seed, problem, odd=seed % 4 == 0)
        kept_to += check(problem, drawn.of_one_unit() if near else drawn.text()) > 0
    assert kept_to > len(seeds) // 4


ODD = [
    'bad("salt"). bad("bowl"). bad("dough"). :- use(U), bad(L) : input(U,O), label(O,L).',
    'bad("salt"). bad("bowl"). bad("dough"). :- use(U), not bad(L) : input(U,O), label(O,L).',
    ":- use(U), output(U,P) : input(U,O), not goal(O), output(U,P), label(P,L), not label(O,L).",
    ":- not use(U) : unit(U), gives(U,O), not goal(O).",
    ":- use(U), #count { L : input(U,O), not goal(O), label(O,L) } > 1.",
    ":- use(U), not #count { L,O : input(U,O), label(O,L) ; O : output(U,O) } < 3.",
    ":- use(U), inputs(U,N), #count { O : output(U,O) } >= N.",
    ":- not use(U) : input(U,O), output(U,P), O < P.",
    ":- #count { U : use(U), input(U,O), output(U,P), O > P } = 0.",
    "early(U) :- use(U), input(U,O), output(U,P), O < P. :- not early(U) : unit(U).",
    ":- use(U), #count { P : input(U,P), label(P,L) } > 0, output(U,O), label(O,L).",
    ':- use(U), source(U,"random"), not video(U,"random").',
    ":- not use(0..1).",  # two rules
    ":- not use(1..0).",  # none
    ":- not available(O..O+1), goal(O).",
    ":- not use(0..1) : goal(_).",
    "must(0). must(1). :- must(U), not use(U).",
    ":- not use((0;1)).",
    ":- not use(0;1).",
    "made(O) :- use(U), output(U,O), goal(G), label(G,_). :- goal(O), not made(O).",
]
NOT_OF_A_TREE = ("risk(", "cost(", "optimize(", "_by_person(")


@pytest.mark.parametrize("text", [*ODD, *(text for text, *_ in WRITTEN)])
def test_rules_of_every_kind(text: str) -> None:
    if any(word in text for word in NOT_OF_A_TREE):
        return  # rounded, and there in some questions only
    for word, motion in (("fry", "cook"), ("bake", "mix"), ("soup", "dough")):
        text = text.replace(f'"{word}"', f'"{motion}"')
    for seed in range(3):
        check(problem_of(seed), text)


def test_objects_related_to_one_thing_in_two_ways() -> None:
    builder = NetworkBuilder()
    related = [ObjectNode.of("salt", [], [(word, "bowl")]) for word in ("on", "in", "in", "on")]
    for line, node in enumerate(related):
        builder.add("pour", [node], [ObjectNode.of("soup", [str(line)])], Source("handmade", line + 1))
    network = builder.build()
    kitchen = frozenset(o for node in related if (o := network.object_id(node)) is not None)
    goal = network.object_id(ObjectNode.of("soup", ["1"]))
    assert goal is not None
    problem = Problem(network, kitchen, (goal,), None, frozenset(), ContainerRule.STRICT)
    for test in ('W != "on"', "W != L", 'W < "on"', 'L != "cup", W > "in"'):
        check(problem, f":- use(U), input(U,O), located(O,W,L), {test}.")
