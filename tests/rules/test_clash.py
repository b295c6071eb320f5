"""The clash of ``foon-asp why-not`` and ``solve --soft``: against brute force, and as a user meets them."""

import random
from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status
from foon_asp.asp.integrity import relax
from foon_asp.asp.soft import solve_soft
from foon_asp.dataset.paths import File
from foon_asp.network import FunctionalUnit
from foon_asp.problem import ContainerRule, Objective, Problem, parse_objectives
from foon_asp.questions.why_not import why_not
from foon_asp.rules.passed_constraint import Constraint
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.oracle import task_trees
from tests.support.random_problems import MOTIONS, random_problem

Tree = tuple[FunctionalUnit, ...]
Ways = Callable[[Tree], int]
RULES = list(ContainerRule)


def draw(rng: random.Random, problem: Problem) -> tuple[str, Ways]:
    """Draw a constraint, and count in how many ways a tree breaks it."""
    motion = rng.choice(MOTIONS)
    label = rng.choice([node.label for node in problem.network.objects])
    bound = rng.randint(0, 3)
    drawn: list[tuple[str, Ways]] = [
        (f':- use(U), motion(U,"{motion}").', lambda t: sum(u.motion == motion for u in t)),
        (
            f':- use(U), input(U,O),\n   label(O,"{label}").',
            lambda t: sum(node.label == label for u in t for node in set(u.inputs)),
        ),
        (f":- #count {{ U : use(U) }} > {bound}.", lambda t: int(len(t) > bound)),
        (f':- not motion_used("{motion}").', lambda t: int(all(u.motion != motion for u in t))),
    ]
    return rng.choice(drawn)


def files(folder: Path, seed: int, problem: Problem) -> tuple[list[Path], list[list[Ways]], random.Random]:
    """Write two files of constraints."""
    rng = random.Random(seed)
    paths, ways = [], []
    for name in ("one.lp", "two.lp"):
        drawn = [draw(rng, problem) for _ in range(rng.choice([1, 2, 2, 3]))]
        path = folder / f"{seed}-{name}"
        rule = "motion_used(M) :- use(U), motion(U,M).\n" if name == "one.lp" else ""
        path.write_text("% comment\n" + rule + "\n".join(text for text, _ in drawn) + "\n")
        paths.append(path)
        ways.append([count for _, count in drawn])
    return paths, ways, rng


@pytest.mark.parametrize(
    "seeds", [range(8500, 8520), pytest.param(range(8520, 8540), marks=pytest.mark.slow)], ids=["few", "many"]
)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.default_cases("implied-few")
def test_clashes_and_penalties_against_brute_force(rule: ContainerRule, seeds: range, tmp_path: Path) -> None:
    sizes, penalties = set(), set()
    for seed in seeds:
        problem = random_problem(seed, rule, units=7)
        paths, ways, rng = files(tmp_path, seed, problem)
        weights: dict[File, int] = {path: rng.randint(1, 4) for path in paths}
        soft_ones: dict[Constraint, int] = {path: weights[path] for path in paths}
        explained = why_not(problem, constraints=paths, weights=weights)
        objectives = [str(rng.choice(sorted(Objective)))]
        soft = solve_soft(problem, parse_objectives(objectives), Settings(), soft_ones)
        trees = list(task_trees.trees(problem))
        assert explained.tree_exists == bool(trees)
        found = explained.clash
        if found is None:
            assert not trees
            assert (soft.outcome.status, soft.penalty) == (Status.INFEASIBLE, None)
            continue
        assert found.complete
        assert found.tree_exists_without_constraints
        all_ways = [count for of_file in ways for count in of_file]
        cost = [weights[path] for path, of_file in zip(paths, ways, strict=True) for _ in of_file]
        numbers = range(len(all_ways))
        broken = [frozenset(n for n in numbers if all_ways[n](tree)) for tree in trees]

        def clashes(chosen: tuple[int, ...], broken: list[frozenset[int]] = broken) -> bool:
            return all(not faults.isdisjoint(chosen) for faults in broken)

        smallest = next(
            (c for size in range(len(all_ways) + 1) for c in combinations(numbers, size) if clashes(c)), ()
        )
        sizes.add(len(smallest))
        assert len(found.constraints) == len(all_ways)
        assert len(found.smallest_clash) == len(smallest)
        assert not smallest or clashes(tuple(c.number - 1 for c in found.smallest_clash))
        assert found.smallest_proved == bool(smallest)
        drop = sum(c.weight for c in found.cheapest_to_drop)
        assert drop == min(sum(cost[n] for n in faults) for faults in broken)
        left = [c.number - 1 for c in found.constraints if c not in found.cheapest_to_drop]
        assert found.answer is not None
        assert found.answer.costs is not None
        kept = [t for t, faults in zip(trees, broken, strict=True) if faults.isdisjoint(left)]
        assert found.answer.costs.units == min(map(len, kept))

        penalty = [sum(cost[n] * all_ways[n](tree) for n in numbers) for tree in trees]
        penalties.add(min(penalty))
        assert soft.outcome.status is Status.OPTIMAL
        assert soft.outcome.units is not None
        tree = tuple(map(problem.network.unit, soft.outcome.units))
        assert [each.ways for each in soft.constraints] == [count(tree) for count in all_ways]
        assert soft.penalty == min(penalty) == sum(cost[n] * all_ways[n](tree) for n in numbers)
        least = [t for t, each in zip(trees, penalty, strict=True) if each == min(penalty)]
        assert task_trees.key(problem, tree, objectives) == task_trees.best(least, problem, objectives)
    assert {0, 1, 2} <= sizes
    assert len(penalties) > 3


def test_constraints_are_given_with_their_place_text_and_constants(tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    rules = "#const most = 2.\nseen(M) :- use(U), motion(U,M).\n"
    file.write_text(rules + '  :- #count { U :\n    use(U) } > most. :- seen("é").\n')
    constraints, relaxed = relax([file, Path("forbid_motion")], ["most=4", "other=1"], soft=False)
    assert [c.number for c in constraints] == [1, 2, 3]
    assert [c.source.line for c in constraints[:2]] == [3, 4]
    assert [c.text for c in constraints] == [
        ":- #count { U : use(U) } > most.",
        ':- seen("é").',
        ":- use(U), motion(U,forbidden_motion).",
    ]
    assert [c.constants for c in constraints] == [("most=4",), (), ()]
    assert "seen(M) :- use(U); motion(U,M)." in relaxed.rules


@pytest.fixture
def two_files(tmp_path: Path) -> tuple[Path, Path]:
    """Give constraints of two cooks: mixing without a machine, and with clean hands and no siphon."""
    one, two = tmp_path / "one.lp", tmp_path / "two.lp"
    one.write_text(
        '% by hand, but not by whisk\n:- use(U), motion(U,"beat").\n:- use(U), motion(U,"whip").\n'
    )
    two.write_text(
        '% nothing under pressure\n:- use(U), motion(U,"dispense").\n:- use(U), motion(U,"fry").\n'
    )
    return one, two


@pytest.mark.slow
def test_a_clash_of_two_files(cli: Cli, two_files: tuple[Path, Path]) -> None:
    one, two = two_files
    words = ["--goal", "whipped cream", "--constraint", one, "--constraint", two]
    ran = cli("why-not", *words)
    assert ran.code == 1
    assert "3 of the 4 constraints cannot hold together, and no smaller set: proved" in ran.out
    for place, text in ((f"{one}:2", "beat"), (f"{one}:3", "whip"), (f"{two}:2", "dispense")):
        assert f'  {place}\n      :- use(U), motion(U,"{text}").\n' in ran.out
    weights = ["--weight", f"{two}=5", "--weight", f"{one}=2"]
    found = cli("why-not", *words, *weights, "--format", "json").json["clash"]
    (dropped,) = found["cheapest_to_drop"]
    assert (dropped["file"], found["answer"]["status"]) == (str(one), "optimal")
    assert (found["smallest_proved"], len(found["smallest_clash"])) == (True, 3)
    solved = cli("solve", *words)
    assert solved.code == 1
    assert "foon-asp why-not finds those that do" in solved.out


@STRUCK_WHILE_READING
def test_constraints_that_are_not_the_reason(cli: Cli, two_files: tuple[Path, Path]) -> None:
    ran = cli("why-not", "--goal", "apple pie", "--constraint", two_files[0])
    assert ran.code == 1
    assert "1 cycle feeds only itself" in ran.out
    verb = cli("clash", "--goal", "ice")
    assert (verb.code, "type: foon-asp why-not --constraint" in verb.err) == (2, True)
    held = cli("why-not", "--goal", "ice", "--constraint", two_files[0], "--constraint", two_files[1])
    assert held.code == 0
    assert "no clash: the 4 constraints can hold together" in held.out
    assert cli("why-not", "--goal", "ice", "--constraint", two_files[0], "--time-limit", "0").code == 3


def test_faults_keep_their_places(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    file.write_text("% first\n:- use(U), not motion(U,M).\n")
    for words in (["why-not", "--constraint", file], ["solve", "--soft", f"{file}=1"]):
        ran = cli(*words, "--goal", "ice")
        assert (ran.code, ran.out) == (2, "")
        assert "mine.lp:2:25: error: the variable 'M' is unsafe" in ran.err
    file.write_text("#script (python)\n#end.\n:- use(3).\n")
    assert "mine.lp:1:1: error: found #script" in cli("why-not", "--goal", "ice", "--constraint", file).err


def test_other_rules_always_hold(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    file.write_text("never :- not never.\n:- use(3).\n")
    ran = cli("why-not", "--goal", "ice", "--constraint", file)
    assert ran.code == 1
    assert "no task tree is left whatever is dropped" in ran.out


@pytest.mark.slow
def test_soft_constraints(cli: Cli, two_files: tuple[Path, Path]) -> None:
    one, two = two_files
    words = ["solve", "--goal", "whipped cream", "--soft", f"{one}=3", "--soft", f"{two}=2"]
    ran = cli(*words)
    assert ran.code == 0
    assert (
        f"penalty 2, the least there is: 1 of 4 soft constraints broken\n  {two}:2    (weight 2)" in ran.out
    )
    found = cli(*words, "--format", "json").json
    assert (found["status"], found["penalty"]) == ("optimal", 2)
    assert [each["broken"] for each in found["soft_constraints"]] == [0, 0, 1, 0]
    hard = ["--constraint", "forbid_motion", "-c", "forbidden_motion=dispense"]
    assert cli(*words, *hard, "--format", "json").json["penalty"] == 3
    foon = cli(*words, "--format", "foon")
    assert foon.out.startswith("# Task tree for")
    assert "penalty 2" in foon.err


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("forbid_motion", "expected FILE.lp=WEIGHT"),
        ("forbid_motion=0", "expected a whole number from 1"),
        ("forbid_motion=1.5", "expected a whole number from 1"),
        ("nothing.lp=1", "no such file"),
    ],
)
def test_weights_that_are_none(cli: Cli, setting: str, message: str) -> None:
    ran = cli("solve", "--goal", "ice", "--soft", setting)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err


def test_soft_goes_with_no_certificate(cli: Cli, tmp_path: Path) -> None:
    words = ["solve", "--goal", "ice", "--soft", "forbid_motion=1", "-c", "forbidden_motion=crush"]
    assert cli(*words, "--certificate", tmp_path / "c.json").code == 2


@pytest.mark.parametrize("name", ["_dropped(1)", "_broken(1,2)", "_kept(1)"])
def test_words_of_the_questions_are_taken(cli: Cli, tmp_path: Path, name: str) -> None:
    file = tmp_path / "mine.lp"
    file.write_text(f"{name}.\n:- use(3).\n")
    ran = cli("why-not", "--goal", "ice", "--constraint", file)
    assert ran.code == 2
    assert "which a constraint may not define" in ran.err
