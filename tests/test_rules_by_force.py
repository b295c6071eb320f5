"""What is claimed of rules holds for all trees of small problems: each claim is looked at by brute force."""

from collections.abc import Iterable, Iterator
from functools import cache

import pytest
from clingo import Control

from foon_asp.deadline import Deadline
from foon_asp.encoding.encoding import read_encoding
from foon_asp.encoding.facts import write_facts
from foon_asp.encoding.scales import Scales
from foon_asp.grounding.stated import Stated
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Contradiction, Problem, reach
from foon_asp.resources import encodings_folder
from foon_asp.rules.lifted_program import stands_alone
from foon_asp.rules.rule_kind import Kind
from foon_asp.rules.rules import Rules
from tests.random_problems import random_problem, random_steps
from tests.random_rules import RandomRules

Tree = frozenset[int]


@cache
def _task_tree() -> str:
    return (encodings_folder() / "task_tree.lp").read_text()


def kept(problem: Problem, rules: str, units: Iterable[int]) -> set[Tree] | None:
    """Give all trees that keep to rules, with only some units in the facts; ``None`` for faulty rules."""
    chosen = sorted(units)
    facts = write_facts(problem, chosen, Scales(problem, chosen), ())
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


def understood(text: str) -> Rules:
    return Rules([read_encoding(Stated("rule 1", text))], (), endless=False)


def parts(text: str) -> Iterator[str]:
    """Give each constraint with all the rules for helpers."""
    lines = text.splitlines()
    helpers = [line for line in lines if not line.startswith(":-")]
    for line in lines:
        if line.startswith(":-"):
            yield "\n".join([*helpers, line]) + "\n"
    yield text


def check(problem: Problem, text: str) -> None:
    """Hold what is claimed of rules against all trees."""
    everything = frozenset(reach(problem).units)
    trees = kept(problem, text, everything)
    if trees is None:
        return
    rules = understood(text)
    kinds = {rule.kind for rule in rules.rules}
    free = kept(problem, "", everything)
    assert free is not None
    if kinds <= {Kind.HELPER, Kind.FACT}:
        assert trees in (free, set())
    if rules.shrinking:
        assert all(tree in trees for larger in trees for tree in free if tree <= larger)
    if kinds <= {Kind.HELPER, Kind.FACT, Kind.REQUIRING}:
        assert all(tree in trees for smaller in trees for tree in free if tree >= smaller)
    if rules.all_deleting:
        assert not rules.rest
    left = rules.applied(problem)
    assert left is not None
    if isinstance(left, Contradiction):
        assert not trees
    else:
        keeping = {
            tree
            for tree in free
            if not any(map(left.removed, tree)) and all(tree & units for units in left.required)
        }
        assert trees <= keeping
        assert rules.rest or trees == keeping
    check_both_ways(problem, rules)
    if rules.local:
        for part in {frozenset(), *sorted(free, key=sorted)[:4], *(everything - {u} for u in everything)}:
            assert kept(problem, text, part) == {tree for tree in trees if tree <= part}


def check_both_ways(problem: Problem, rules: Rules) -> int:
    """Hold what is answered without clingo against clingo, unit by unit; says how many rules were."""
    live = rules._live
    both = [n for n in rules._flat if not rules.rules[n].one_of or stands_alone(live[n])]
    for number in both:
        flat, clingo = rules._by_hand([number], problem), rules._by_clingo([number], problem, Deadline())
        units = reach(problem).units
        there = frozenset(units)
        if isinstance(clingo, Contradiction):  # which asks for none but those that can be made
            assert isinstance(flat, Contradiction) or any(not each & there for each in flat.required)
            continue
        assert clingo is not None
        assert not isinstance(flat, Contradiction)
        assert list(map(flat.removed, units)) == list(map(clingo.removed, units))
        assert {each & there for each in flat.required} == set(clingo.required)
    return len(both)


def problem_of(seed: int) -> Problem:
    rule = ContainerRule.IMPLIED if seed % 2 else ContainerRule.STRICT
    return random_steps(seed, rule, 6) if seed % 3 else random_problem(seed, rule, units=6)


@pytest.mark.parametrize("seeds", [range(12), pytest.param(range(12, 400), marks=pytest.mark.slow)])
def test_claims_hold(seeds: range) -> None:
    for seed in seeds:
        problem = problem_of(seed)
        for text in parts(RandomRules(seed, problem, odd=seed % 2 == 0).text()):
            check(problem, text)


@pytest.mark.parametrize("seeds", [range(60), pytest.param(range(60, 3000), marks=pytest.mark.slow)])
def test_clingo_and_we_remove_and_require_the_same(seeds: range) -> None:
    answered = 0
    for seed in seeds:
        problem = problem_of(seed)
        text = RandomRules(seed, problem, odd=seed % 5 == 0).of_one_unit()
        if kept(problem, text, ()) is not None:
            answered += check_both_ways(problem, understood(text))
    assert answered > len(seeds) // 4


@pytest.mark.parametrize(
    "text",
    [
        'bad("salt"). bad("bowl"). bad("dough"). :- use(U), bad(L) : input(U,O), label(O,L).',
        'bad("salt"). bad("bowl"). bad("dough"). :- use(U), not bad(L) : input(U,O), label(O,L).',
        ":- use(U), output(U,P) : input(U,O), not goal(O), output(U,P), label(P,L), not label(O,L).",
        ":- not use(U) : unit(U), gives(U,O), not goal(O).",
        ":- use(U), #count { L : input(U,O), not goal(O), label(O,L) } > 1.",
        ":- use(U), not #count { L,O : input(U,O), label(O,L) ; O : output(U,O) } < 3.",
        ":- use(U), inputs(U,N), #count { O : output(U,O) } >= N.",
    ],
)
def test_conditions_with_variables_of_their_own(text: str) -> None:
    for seed in range(12):
        assert check_both_ways(problem_of(seed), understood(text))


@pytest.mark.parametrize(
    "text",
    [
        ":- not use(0..1).",  # two rules
        ":- not use(1..0).",  # none
        ":- not available(O..O+1), goal(O).",
        ":- not use(0..1) : goal(_).",
        "must(0). must(1). :- must(U), not use(U).",
        ":- not use((0;1)).",
        ":- not use(0;1).",
        "made(O) :- use(U), output(U,O), goal(G), label(G,_). :- goal(O), not made(O).",
    ],
)
def test_claims_hold_of_odd_rules(text: str) -> None:
    for seed in range(12):
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
