"""The checker proved in Coq accepts certificates that are written, and refuses forged ones."""

import json
import random
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, solve
from foon_asp.certificate import certify_outcome
from foon_asp.certificate.certificate import subject_of
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof import proved_checker
from foon_asp.proof.verifier import RefusedError, Subject, read_certificate, read_rules, seal, verify
from tests.conftest import Cli
from tests.oracle.constraints import random_rule, settings_of
from tests.proof.forging import Forged
from tests.proof.test_forged_certificates import FORGED, PARTS
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import MOTIONS, random_objectives, random_problem

Judge = Callable[[Any, Subject], tuple[str, str]]

# Right certificates that the other checker refuses all the same: they are large, or their words are wrong.
RIGHT = {
    "read_certificate: it has more than … letters or … brackets",
    "read_rules: it has more than … rules",
    "_rational: a fraction has more than … digits",
    "_figures: the success rate of the tree is too long a number to be written",
    "_minus_log_sign: products of rates are too close to be told apart in reasonable time",
    "_spend_on: its fractions add up to numbers that are too long",
    "_own: a file of rules has no printable name",
    "_goal: a goal is not the node of its id",
    "__init__: a constraint has no printable name",
}
# The proved checker knows rules that are a set of units or a sum over units.
UNKNOWN = (
    "the rule ",
    "the objective ",
    "stand-ins",
    "claims about several units",
    "measures of your own",
    "a motion that never succeeds",
)


@pytest.fixture
def judge() -> Judge:
    checker = proved_checker.program()
    if checker is None:
        pytest.skip("the proved checker is not built: make verified")

    def judged(content: Any, subject: Subject) -> tuple[str, str]:
        try:
            rules = read_rules(content["rules"], len(subject.network))
        except (RefusedError, KeyError, TypeError):
            rules = ()
        text = content if isinstance(content, str) else json.dumps(content)
        return proved_checker.judge(checker, subject.described(rules), text)

    return judged


def forged(judge: Judge, name: str, forgery: Forged) -> None:
    content = forgery.content
    if isinstance(content, bytes):
        content = content.decode(errors="replace")
    verdict, reason = judge(content, subject_of(forgery.at))
    if name in RIGHT:
        assert verdict in ("accepted", "not checked")
    elif verdict == "not checked":
        assert reason.removeprefix("the proved checker does not know ").startswith(UNKNOWN)
    else:
        assert verdict == "refused"


def test_forged_certificates_are_refused(judge: Judge) -> None:
    for name, forgery in FORGED.items():
        if name not in RIGHT:
            forged(judge, name, forgery)
    for name, part in PARTS.items():
        forged(judge, name, part.forged)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(RIGHT & FORGED.keys()))
def test_right_certificates_that_are_refused_for_their_size_or_words(judge: Judge, name: str) -> None:
    forged(judge, name, FORGED[name])


def raised(content: dict[str, Any]) -> dict[str, Any]:
    """Return the claim that each tree costs a bit more than the best one by the first objective."""
    costs = zip(content["objective"], content["costs"], strict=True)
    parts: list[Any] = [{} if name == "success" else str(cost) for name, cost in costs]
    parts[0] = str(Fraction(parts[0]) + Fraction(1, 7))
    forgery = {**content, "claim": "bound", "tree": None, "costs": None, "bound": parts}
    return {**forgery, "seal": seal(forgery)}


def random_certificates(judge: Judge, seeds: range, ruled: bool) -> Counter[str]:
    met: Counter[str] = Counter()
    for seed in seeds:
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        if seed % 10 == 9:
            problem = gap_problem(seed % 6, 3)
        elif seed % 3 == 0:
            prices = {motion: Fraction(place * place, 10) for place, motion in enumerate(MOTIONS)}
            problem = replace(problem, unit_prices=UnitPrices(prices, {}))
        drawn = {rule["rule"]: rule for rule in [random_rule(rng, problem)]} if ruled else {}
        settings = settings_of([*drawn.values()]) if ruled else Settings()
        objectives = random_objectives(rng, 3) if seed % 2 else (list(Objective)[seed % len(Objective)],)
        if problem.unit_prices is None:
            objectives = tuple(each for each in objectives if each != Objective.PRICE) or (Objective.UNITS,)
        _, found = certify_outcome(solve(problem, objectives, settings), settings)
        assert found is not None
        content, subject = read_certificate(found.text()), subject_of(problem)
        verify(content, subject)
        verdict, reason = judge(content, subject)
        met[verdict] += 1
        met[content["claim"]] += 1
        if verdict == "not checked":
            assert ruled
            assert reason.startswith("the proved checker does not know the rule ")
        else:
            assert verdict == "accepted"
            if content["claim"] == "optimal" and content["objective"][0] != "success":
                met["raised"] += 1
                assert judge(raised(content), subject)[0] == "refused"
    return met


@pytest.mark.parametrize(
    "seeds",
    [
        range(20),
        pytest.param(range(20, 300), marks=pytest.mark.slow),
        pytest.param(range(300, 2000), marks=pytest.mark.nightly),
    ],
)
def test_certificates_of_random_networks(judge: Judge, seeds: range) -> None:
    met = random_certificates(judge, seeds, ruled=False)
    assert met.keys() == {"accepted", "optimal", "infeasible", "raised"}
    met = random_certificates(judge, seeds[: len(seeds) // 2], ruled=True)
    assert met["accepted"] > met["not checked"]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::foon_asp.errors.FoonWarning")
def test_certificates_of_the_universal_network(judge: Judge, universal: Path, tmp_path: Path) -> None:
    foon = foon_asp.load(universal)
    motions = sorted(set(foon.network.motions))
    foon = foon.vary(unit_prices={motion: Fraction(place % 23, 4) for place, motion in enumerate(motions)})
    subject = foon.dataset.subject()
    for goal in foon.goals:
        for objectives in (["units"], ["inputs", "price"], ["price"], ["success", "inputs"]):
            for containers in ContainerRule:
                problem = foon.problem(goal, containers=containers)
                foon_asp.solve(problem, objectives, certificate=tmp_path / "proof.json")
                content = json.loads((tmp_path / "proof.json").read_text())
                assert content["objective"] in ([], [*objectives, "units"], objectives)
                assert judge(content, subject) == ("accepted", "")


@pytest.mark.parametrize("part", [40, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("level", [1, 2, 3])
def test_certificates_of_the_bundled_goals(judge: Judge, level: int, part: int, tmp_path: Path) -> None:
    foon = foon_asp.load(level=level)
    subject = foon.dataset.subject()
    for goal in list(foon.goals)[::part]:
        for containers in ContainerRule:
            problem = foon.problem(goal, containers=containers)
            foon_asp.solve(problem, ["inputs", "success"], certificate=tmp_path / "proof.json")
            content = json.loads((tmp_path / "proof.json").read_text())
            assert judge(content, subject) == ("accepted", "")


def test_verify_asks_both_checkers(cli: Cli, judge: Judge, tmp_path: Path) -> None:
    del judge  # skips where it is not built
    proof = tmp_path / "proof.json"
    cli("solve", "--goal", "ice", "--certificate", str(proof))
    ran = cli("verify", str(proof), "--proved")
    assert (ran.code, ran.out.splitlines()[-1]) == (0, "proved checker: accepted")


def test_verify_says_where_the_proved_checker_is_not_built(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(proved_checker, "program", lambda: None)
    proof = tmp_path / "proof.json"
    cli("solve", "--goal", "ice", "--certificate", str(proof))
    ran = cli("verify", str(proof), "--proved")
    assert ran.code == 3
    assert ran.out.splitlines()[-1].startswith("proved checker: not built")
    assert cli("verify", str(proof)).code == 0


def test_other_data_are_refused(judge: Judge) -> None:
    found = certify_outcome(solve(random_problem(0, ContainerRule.STRICT), (Objective.UNITS,)), Settings())[1]
    assert found is not None
    other = subject_of(random_problem(1, ContainerRule.STRICT))
    verdict, reason = judge(json.loads(found.text()), other)
    assert verdict == "refused"
    assert "not the one that the certificate is about" in reason
