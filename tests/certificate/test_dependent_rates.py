"""Certificates where rates depend on each other (49/100 is 7/10 twice), or are next to 1."""

import json
import random
from fractions import Fraction
from itertools import combinations
from pathlib import Path

import pytest

from foon_asp.certificate import NotBestError, certify
from foon_asp.problem import Objective, Problem
from foon_asp.proof.certificate_json import read_certificate
from tests.conftest import Cli
from tests.proof.by_hand import recipe
from tests.support.handmade_certificate import check


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


BY = (Objective.SUCCESS, Objective.UNITS)


def cover(seed: int, pool: list[Fraction]) -> tuple[Problem, list[list[int]]]:
    """Ask for every edge of a random graph, made at either of its corners; give all of its trees, too."""
    rng = random.Random(seed)
    corners = range(rng.randint(3, 6))
    edges = [pair for pair in combinations(corners, 2) if rng.random() < 0.8] or [(0, 1)]
    rates = {f"make {corner}": rng.choice(pool) for corner in corners}
    sides = ([f"edge; {edge}" for edge in edges if corner in edge] for corner in corners)
    units = [f"make {n}: table > {' + '.join(made or ['nothing'])}" for n, made in enumerate(sides)]
    end = f"end: {' + '.join(f'edge; {edge}' for edge in edges)} > done"
    problem = recipe(*units, end, kitchen="table", rates={**rates, "end": 1})
    trees = [
        [*chosen, len(corners)]
        for size in range(len(corners) + 1)
        for chosen in combinations(corners, size)
        if all(not {*edge}.isdisjoint(chosen) for edge in edges)
    ]
    return problem, trees


@pytest.mark.parametrize("pool", POOLS)
@pytest.mark.default_cases("powers of one base", "products of two")
def test_every_optimum_is_proved(pool: str) -> None:
    branched = 0
    for seed in (*range(60), 152, 347):  # 3, 152 and 347 have weights of nothing that are not 0
        problem, trees = cover(seed, POOLS[pool])
        objectives = random.Random(seed).choice([BY[:1], BY, BY[::-1]])
        ranked = sorted((problem.costs(tree).key(objectives), tree) for tree in trees)
        (least, best), (most, worst) = ranked[0], ranked[-1]
        found = certify(problem, objectives, best)
        assert found is not None
        assert (found.claim, found.certified) == ("optimal", objectives)
        assert check(read_certificate(found.text()), problem).claim == "optimal"
        branched += "branch" in found.content["proof"]
        if most > least:
            with pytest.raises(NotBestError):
                certify(problem, objectives, worst)
    assert branched > 10


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
    cli: Cli, quoted: tuple[str | Path, ...], constant: str, tmp_path: Path
) -> None:
    proof = tmp_path / "proof.json"
    ran = cli("solve", *quoted, "-c", f"forbidden_motion={constant}", "--certificate", proof)
    assert ran.code == 0
    content = json.loads(proof.read_text())
    assert content["rules"] == [{"rule": "forbid_motion", "forbidden_motion": 'cr"u\\sh'}]
    assert len(content["tree"]) == 2


@pytest.mark.parametrize("constant", ['"', '"cr"u"', '"a\\b"'])
def test_a_constant_with_half_of_its_quotes_is_an_error(
    cli: Cli, quoted: tuple[str | Path, ...], constant: str
) -> None:
    ran = cli("solve", *quoted, "-c", f"forbidden_motion={constant}", "--certificate", "proof.json")
    assert ran.code == 2
    assert f"found {constant} for a constant" in ran.err


def test_rules_and_constants_are_looked_over_for_a_given_tree_too(
    cli: Cli, quoted: tuple[str | Path, ...], tmp_path: Path
) -> None:
    tree, rule = tmp_path / "tree.foon", tmp_path / "rule.lp"
    tree.write_text('O\ta\nM\tcr"u\\sh\nO\tb\n//\n')
    asked = ("check", tree, *quoted, "--certificate", tmp_path / "proof.json")
    assert cli(*asked, "-c", "forbidden_motion=pour").code == 0
    assert cli(*asked, "-c", "forbiden_motion=pour").code == 2
    rule.write_text("this is no rule\n")
    assert cli(*asked, "--constraint", rule).code == 2
