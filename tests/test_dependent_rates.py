"""Certificates where rates depend on each other (49/100 is 7/10 twice), or are next to 1."""

import random
from fractions import Fraction
from itertools import combinations
from math import gcd, prod
from pathlib import Path

import pytest

from foon_asp.bounds.coprime_base import coprime_base, powers
from foon_asp.bounds.lexicographic import Lexicographic
from foon_asp.certificate import NotBestError, certify
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import Objective, Problem, levels
from foon_asp.proof.verify import read_certificate, verify
from tests.conftest import Cli


def below(nines: int) -> Fraction:
    """Give 0.99...9."""
    return 1 - Fraction(1, 10**nines)


POOLS = {
    "powers of one base": [Fraction(7, 10), Fraction(49, 100), Fraction(343, 1000)],
    "products of two": [Fraction(1, 2), Fraction(1, 3), Fraction(1, 6), Fraction(2, 3), Fraction(1, 4)],
    "next to 1": [below(nines) for nines in (22, 39, 45, 58, 60, 61, 80)],
    "powers next to 1": [below(60) ** power for power in (1, 2, 3)],
    "far apart": [below(39), below(300), below(500), 1 - Fraction(1, 10**300 + 1), Fraction(1, 10**400)],
}


def cover(seed: int, pool: list[Fraction]) -> tuple[Problem, list[list[int]]]:
    """Ask for every edge of a random graph, made at either of its corners; give all of its trees, too."""
    rng = random.Random(seed)
    corners = range(rng.randint(3, 6))
    edges = [pair for pair in combinations(corners, 2) if rng.random() < 0.8] or [(0, 1)]
    table, done = ObjectNode.of("table"), ObjectNode.of("done")
    made = {edge: ObjectNode.of("edge", [], [("at", str(edge))]) for edge in edges}
    builder = NetworkBuilder()
    rates = {"end": Fraction(1)}
    for corner in corners:
        rates[f"make {corner}"] = rng.choice(pool)
        outputs = [made[edge] for edge in edges if corner in edge] or [ObjectNode.of("nothing")]
        builder.add(f"make {corner}", [table], outputs, Source("cover", corner + 1))
    builder.add("end", list(made.values()), [done], Source("cover", 99))
    network = builder.build()
    start, goal = network.object_id(table), network.object_id(done)
    assert start is not None
    assert goal is not None
    trees = [
        [*chosen, len(corners)]
        for size in range(len(corners) + 1)
        for chosen in combinations(corners, size)
        if all(not {*edge}.isdisjoint(chosen) for edge in edges)
    ]
    return Problem(network, frozenset({start}), (goal,), rates, frozenset()), trees


def key(problem: Problem, tree: list[int], objectives: tuple[Objective, ...]) -> tuple[Fraction, ...]:
    costs = problem.costs(tree)
    assert costs.success is not None
    return tuple(-costs.success if o is Objective.SUCCESS else Fraction(costs.units) for o in objectives)


@pytest.mark.parametrize("pool", POOLS)
@pytest.mark.sampled(6)
def test_every_optimum_is_proved(pool: str) -> None:
    branched = 0
    for seed in (*range(60), 152, 347):  # 3, 152 and 347 have weights of nothing that are not 0
        problem, trees = cover(seed, POOLS[pool])
        objectives = random.Random(seed).choice(
            [
                (Objective.SUCCESS,),
                (Objective.UNITS, Objective.SUCCESS),
                (Objective.SUCCESS, Objective.UNITS),
            ]
        )
        ranked = sorted(trees, key=lambda tree: key(problem, tree, objectives))
        found = certify(problem, objectives, ranked[0])
        assert found is not None
        assert (found.claim, found.certified) == ("optimal", objectives)
        claim = verify(
            read_certificate(found.text()), problem.network, problem.kitchen, problem.rates, problem.utensils
        )
        assert claim.claim == "optimal"
        branched += "branch" in found.content["proof"]
        if key(problem, ranked[-1], objectives) > key(problem, ranked[0], objectives):
            with pytest.raises(NotBestError):
                certify(problem, objectives, ranked[-1])
    assert branched > 10


def test_a_vector_that_is_not_0_may_cost_nothing() -> None:
    order = Lexicographic([POOLS["powers of one base"], None])
    assert order.sign([Fraction(2), Fraction(-1), Fraction(0), Fraction(0)]) == 0
    assert order.sign([Fraction(2), Fraction(-1), Fraction(0), Fraction(-1)]) == -1
    huge = Fraction(10**300, 7)  # far beyond what could be multiplied out
    assert order.sign([3 * huge, 3 * huge, -3 * huge, Fraction(0)]) == 0
    assert order.sign([3 * huge, 3 * huge, -3 * huge - Fraction(1, 10**100), Fraction(0)]) == -1
    assert order.sign([3 * huge + Fraction(1, 10**100), 3 * huge, -3 * huge, Fraction(0)]) == 1


def test_rates_next_to_1_are_ordered() -> None:
    rates = [below(nines) for nines in (400, 600, 30)]
    order = Lexicographic([rates])
    assert order.sign([Fraction(1), Fraction(-1), Fraction(0)]) == 1
    assert order.sign([Fraction(1), Fraction(0), Fraction(-1)]) == -1
    # 10**200 times the smaller cost is more than the greater one only by a last digit
    assert order.sign([Fraction(-1), Fraction(10**200), Fraction(0)]) == -1
    assert order.sign([Fraction(-1), Fraction(10**200 + 1), Fraction(0)]) == 1


def test_a_coprime_base_has_no_common_divisors_and_makes_every_number() -> None:
    rng = random.Random(1)
    for _ in range(200):
        numbers = [prod(rng.choices((2, 3, 4, 6, 9, 35, 49, 10**9 + 7), k=4)) for _ in range(6)] + [1]
        base = coprime_base(numbers)
        assert all(gcd(one, other) == 1 for one, other in combinations(base, 2))
        for number in numbers:
            assert prod(b**power for b, power in powers(number, base).items()) == number


def chain(steps: int, rate: Fraction) -> Problem:
    """Make one thing of another, step by step."""
    builder = NetworkBuilder()
    nodes = [ObjectNode.of("thing", [str(step)]) for step in range(steps + 1)]
    for step in range(steps):
        builder.add("go", [nodes[step]], [nodes[step + 1]], Source("chain", step + 1))
    network = builder.build()
    goal = network.object_id(nodes[-1])
    assert goal is not None
    return Problem(network, frozenset({0}), (goal,), {"go": rate}, frozenset())


def test_a_success_rate_that_is_too_long_to_be_written_is_not_certified() -> None:
    problem = chain(30, below(500))
    assert certify(problem, levels((Objective.SUCCESS,)), range(30)) is None
    first = certify(problem, levels((Objective.UNITS, Objective.SUCCESS)), range(30))
    assert first is not None
    assert (first.claim, first.certified) == ("optimal", (Objective.UNITS,))


# --- constants in quotes


@pytest.fixture
def quoted(tmp_path: Path) -> tuple[str | Path, ...]:
    """Give the options for a network with a quote in the name of its best motion."""
    (tmp_path / "FOON.txt").write_text(
        'O\ta\nM\tcr"u\\sh\nO\tb\n//\nO\ta\nM\tpour\nO\tc\n//\nO\tc\nM\tpour\nO\tb\n//\n'
    )
    (tmp_path / "kitchen.json").write_text('[{"label": "a", "states": [], "ingredients": []}]')
    (tmp_path / "motion.txt").write_text('cr"u\\sh\t0.9\npour\t0.8\n')
    (tmp_path / "goal_nodes.json").write_text('[{"label": "b", "states": [], "ingredients": []}]')
    return ("--data", tmp_path, "--goal", "b", "--constraint", "forbid_motion")


@pytest.mark.parametrize("constant", ['cr"u\\sh', '"cr\\"u\\\\sh"'])
def test_a_constant_in_quotes_is_the_text_that_the_solver_takes_it_for(
    cli: Cli, quoted: tuple[str | Path, ...], constant: str
) -> None:
    ran = cli("certify", *quoted, "-c", f"forbidden_motion={constant}")
    assert ran.code == 0
    assert ran.json["rules"] == [{"rule": "forbid_motion", "forbidden_motion": 'cr"u\\sh'}]
    assert len(ran.json["tree"]) == 2


@pytest.mark.parametrize("constant", ['"', '"pour', '"cr"u"', '"a\\', '"a\\b"'])
def test_a_constant_with_half_of_its_quotes_is_an_error(
    cli: Cli, quoted: tuple[str | Path, ...], constant: str
) -> None:
    ran = cli("certify", *quoted, "-c", f"forbidden_motion={constant}")
    assert ran.code == 2
    assert f"found {constant} for a constant" in ran.err


def test_rules_and_constants_are_looked_over_for_a_given_tree_too(
    cli: Cli, quoted: tuple[str | Path, ...], tmp_path: Path
) -> None:
    tree, rule = tmp_path / "tree.foon", tmp_path / "rule.lp"
    tree.write_text('O\ta\nM\tcr"u\\sh\nO\tb\n//\n')
    assert cli("certify", *quoted, "--tree", tree, "-c", "forbidden_motion=pour").code == 0
    assert cli("certify", *quoted, "--tree", tree, "-c", "forbiden_motion=pour").code == 2
    rule.write_text("this is no rule\n")
    assert cli("certify", *quoted, "--tree", tree, "--constraint", rule).code == 2
