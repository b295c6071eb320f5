"""``foon-asp clash`` and ``solve --soft``: against brute force, and as a user meets them."""

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
from foon_asp.questions.clash import clash
from foon_asp.rules.constraint import Constraint
from tests import oracle
from tests.conftest import STRUCK_WHILE_READING, Cli
from tests.random_problems import MOTIONS, random_problem

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

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
    "seeds", [range(8040, 8075), pytest.param(range(8000, 8100), marks=pytest.mark.slow)]
)
@pytest.mark.slow
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_clashes_against_brute_force(rule: ContainerRule, seeds: range, tmp_path: Path) -> None:
    sizes = set()
    for seed in seeds:
        problem = random_problem(seed, rule, units=7)
        paths, ways, rng = files(tmp_path, seed, problem)
        weights: dict[File, int] = {path: rng.randint(1, 4) for path in paths}
        found = clash(problem, constraints=paths, weights=weights)
        trees = list(oracle.trees(problem))
        assert found.tree_exists == bool(trees)
        assert found.complete
        if not trees:
            continue
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
        assert len(found.smallest) == len(smallest)
        assert not smallest or clashes(tuple(c.number - 1 for c in found.smallest))
        assert found.proved == bool(smallest)
        drop = sum(found.weights[c.number] for c in found.dropped)
        assert drop == min(sum(cost[n] for n in faults) for faults in broken)
        left = [c.number - 1 for c in found.constraints if c not in found.dropped]
        assert found.outcome is not None
        assert found.outcome.costs is not None
        kept = [t for t, faults in zip(trees, broken, strict=True) if faults.isdisjoint(left)]
        assert found.outcome.costs.units == min(map(len, kept))
    assert {0, 1, 2} <= sizes


@pytest.mark.parametrize(
    "seeds", [range(8500, 8535), pytest.param(range(8535, 8580), marks=pytest.mark.slow)]
)
@pytest.mark.parametrize("rule", RULES)
@pytest.mark.sampled(2)
def test_soft_constraints_against_brute_force(rule: ContainerRule, seeds: range, tmp_path: Path) -> None:
    penalties = set()
    for seed in seeds:
        problem = random_problem(seed, rule, units=7)
        paths, ways, rng = files(tmp_path, seed, problem)
        weights: dict[Constraint, int] = {path: rng.randint(1, 4) for path in paths}
        objectives = [str(rng.choice(sorted(Objective)))]
        found = solve_soft(problem, parse_objectives(objectives), Settings(), weights)
        trees = list(oracle.trees(problem))
        if not trees:
            assert (found.outcome.status, found.penalty) == (Status.INFEASIBLE, None)
            continue

        def penalty(tree: Tree, paths: list[Path] = paths, ways: list[list[Ways]] = ways) -> int:
            return sum(
                weights[path] * count(tree)  # noqa: B023
                for path, of_file in zip(paths, ways, strict=True)
                for count in of_file
            )

        least = min(map(penalty, trees))
        penalties.add(least)
        assert found.outcome.status is Status.OPTIMAL
        assert found.outcome.units is not None
        tree = tuple(map(problem.network.unit, found.outcome.units))
        assert found.penalty == penalty(tree) == least
        best = oracle.best([t for t in trees if penalty(t) == least], problem, objectives)
        assert oracle.key(problem, tree, objectives) == best
        flat = [count(tree) for of_file in ways for count in of_file]
        assert [each.ways for each in found.constraints] == flat
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


@pytest.mark.parametrize(
    ("constraint", "head"),
    [
        (":- use(U), motion(U,M).", "_broken(1,_way(M,U))"),
        (":- use(_).", "_broken(1,_way)"),
        (":- #count { U : use(U), kitchen(O) } > 3, goal(O).", "_broken(1,_way(O))"),
        (":- N = #count { U : use(U) }, N > 3.", "_broken(1,_way(N))"),
        (":- use(U), available(O) : needs(U,O).", "_broken(1,_way(U))"),
        (":- not use(3).", "_broken(1,_way)"),
        (":- use(U), not kitchen(U+1), X = 1..2, U != X.", "_broken(1,_way(U,X))"),
    ],
)
def test_ways_are_the_values_of_the_variables_of_the_whole_rule(
    tmp_path: Path, constraint: str, head: str
) -> None:
    file = tmp_path / "mine.lp"
    file.write_text(constraint)
    _, relaxed = relax([file], (), soft=True)
    assert f"{head} :- " in relaxed.rules


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
    ran = cli("clash", *words)
    assert ran.code == 1
    assert "3 of the 4 constraints cannot hold together, and no smaller set: proved" in ran.out
    for place, text in ((f"{one}:2", "beat"), (f"{one}:3", "whip"), (f"{two}:2", "dispense")):
        assert f'  {place}\n      :- use(U), motion(U,"{text}").\n' in ran.out
    found = cli("clash", *words, "--weight", f"{two}=5", "--weight", f"{one}=2", "--format", "json").json
    (dropped,) = found["cheapest_to_drop"]
    assert dropped["file"] == str(one)
    assert found["answer"]["status"] == "optimal"
    assert (found["clash"], found["smallest_proved"], len(found["smallest_clash"])) == (True, True, 3)
    held = cli("clash", "--goal", "ice", "--constraint", one, "--constraint", two)
    assert held.code == 0
    assert "no clash: the 4 constraints can hold together" in held.out
    solved = cli("solve", *words)
    assert solved.code == 1
    assert "foon-asp clash finds those that do" in solved.out
    why = cli("why-not", *words, "--format", "json")
    assert why.code == 1
    assert len(why.json["clash"]["smallest_clash"]) == 3


@STRUCK_WHILE_READING
def test_clash_where_there_is_no_tree_at_all(cli: Cli, two_files: tuple[Path, Path]) -> None:
    ran = cli("clash", "--goal", "apple pie", "--constraint", two_files[0])
    assert ran.code == 1
    assert "even without the constraints" in ran.out
    assert "foon-asp why-not" in ran.out
    assert cli("clash", "--goal", "ice").code == 2
    assert cli("clash", "--goal", "ice", "--constraint", two_files[0], "--time-limit", "0").code == 3


def test_faults_keep_their_places(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    file.write_text("% first\n:- use(U), not motion(U,M).\n")
    for words in (["clash", "--constraint", file], ["solve", "--soft", f"{file}=1"]):
        ran = cli(*words, "--goal", "ice")
        assert (ran.code, ran.out) == (2, "")
        assert "mine.lp:2:25: error: the variable 'M' is unsafe" in ran.err
    file.write_text("#script (python)\n#end.\n:- use(3).\n")
    assert "mine.lp:1:1: error: found #script" in cli("clash", "--goal", "ice", "--constraint", file).err


def test_other_rules_always_hold(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    file.write_text("never :- not never.\n:- use(3).\n")
    ran = cli("clash", "--goal", "ice", "--constraint", file)
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
    assert found["status"] == "optimal"
    assert found["penalty"] == 2
    assert [each["broken"] for each in found["soft_constraints"]] == [0, 0, 1, 0]
    hard = ["--constraint", "forbid_motion", "-c", "forbidden_motion=dispense"]
    assert cli(*words, *hard, "--format", "json").json["penalty"] == 3
    both = cli(*words, "--constraint", two)
    assert both.code == 2
    assert "two.lp is named as a constraint and as a soft one" in both.err
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
    ran = cli("clash", "--goal", "ice", "--constraint", file)
    assert ran.code == 2
    assert "which a constraint may not define" in ran.err
