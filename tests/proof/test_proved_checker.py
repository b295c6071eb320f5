"""The checker proved in Coq accepts certificates that are written, and refuses forged ones."""

import copy
import json
import random
import re
import sys
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
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.proof import proved_checker
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.certificate_rules import read_rules
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.verifier import verify
from tests.conftest import Cli
from tests.oracle.constraints import random_rule, settings_of
from tests.proof.by_hand import PLAIN, UNPROVED
from tests.proof.forging import Forged
from tests.proof.test_forged_certificates import (
    ANY,
    BAKED,
    BEFORE,
    FIVE,
    FORGED,
    INTERMEDIATE,
    NEVER,
    PARTS,
    PLACES,
    certificate,
    measured,
)
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import MOTIONS, random_objectives, random_problem

Judge = Callable[[Any, Subject], tuple[str, str]]

# A right certificate: where bounds of logarithms cannot tell products apart, the other checker gives up, and
# this one computes the products.
RIGHT = {"_minus_log_sign: products of rates are too close to be told apart in reasonable time"}
# What the proved checker does not know tells what is wrong here: what a rule means, or what units cost.
UNKNOWN = {
    "_check_stand_ins: …": "stand-ins",
    "__init__: an objective is unknown": "the objective unit",
    "_stated_cost: the cost of a unit by a measure is not stated": "measures of your own",
    "_check_proof: a rule called broken is kept": "the rule before",
    "what a rule bars is told from the branch": "the rule before",
    "no unit of the tree is barred": "the rule before",
    "a step costs nothing": "the rule require_intermediate",
    "what is at hand is not passed on": "the rule require_intermediate",
    "of each set a tree has a unit": "the rule require_intermediate",
    "things of one unit are counted each": "the rule at_most_utensils",
    "a claim bars the last of its units where the others are used": (
        "claims about several units of rules of your own"
    ),
}
# Refused for their size or their words, though the claims are right.
UNREAD = (
    "load_certificate: it has more than … letters",
    "read_certificate: it has more than … letters or … brackets",
    "read_rules: it has more than … rules",
    "read_rational: a fraction has more than … digits",
    "written_costs: the success rate of the tree is too long a number to be written",
    "spend_on_fractions: its fractions add up to numbers that are too long",
    "_check_user_rules: a file of rules has no printable name",
    "read_goal: a goal is not the node of its id",
    "__init__: a constraint has no printable name",
)


@pytest.fixture
def judge() -> Judge:
    checker = proved_checker.find_checker()
    if checker is None:
        pytest.skip("the proved checker is not built: make verified")

    def judged(content: Any, subject: Subject) -> tuple[str, str]:
        try:
            rules = read_rules(content["rules"], len(subject.network))
        except (RefusedError, KeyError, TypeError):
            rules = ()
        text = content if isinstance(content, str) else json.dumps(content)
        data = subject.canonical_data(rules, range(len(subject.network.objects)))
        return proved_checker.run_checker(checker, data, text)

    return judged


def forged(judge: Judge, forgery: Forged) -> tuple[str, str]:
    content = forgery.content
    if isinstance(content, bytes):
        content = content.decode(errors="replace")
    return judge(content, subject_of(forgery.at))


def test_forged_certificates_are_refused(judge: Judge) -> None:
    every = {**FORGED, **PLACES, **{name: part.forged for name, part in PARTS.items()}}
    judged = {name: forged(judge, forgery) for name, forgery in every.items()}
    assert {name: each for name, each in judged.items() if each[0] != "refused"} == {
        **dict.fromkeys(RIGHT, ("accepted", "")),
        **{n: ("not checked", f"the proved checker does not know {what}") for n, what in UNKNOWN.items()},
    }


@pytest.mark.parametrize("name", UNREAD)
def test_size_and_words_are_refused_for_what_they_are(judge: Judge, name: str) -> None:
    _, reason = forged(judge, FORGED[name])
    assert re.match(".*".join(map(re.escape, name.partition(": ")[2].split("…"))), reason)


def test_names_are_printable(judge: Judge) -> None:
    letters = "".join(filter(str.isprintable, map(chr, range(sys.maxunicode))))
    assert judge(certificate(not_covered=[letters]), subject_of(PLAIN)) == ("accepted", "")
    for letter in "\n\x7f\x85\xa0\u200b\u2028\ue000\U000f0000":
        assert judge(certificate(not_covered=["a" + letter]), subject_of(PLAIN))[0] == "refused"


@pytest.mark.parametrize(
    ("content", "at", "what"),
    [
        (certificate(**FIVE, measures=measured()), PLAIN, "measures of your own"),
        (certificate(rules=[BEFORE]), PLAIN, "the rule before"),
        (
            certificate(**ANY, rules=[INTERMEDIATE], **UNPROVED, **BAKED),
            PLAIN,
            "the rule require_intermediate",
        ),
        (
            certificate(NEVER, **ANY, **UNPROVED, rules=[{"rule": "least_rate", "least_rate": 0}]),
            NEVER,
            "a motion that never succeeds",
        ),
    ],
)
def test_right_certificates_of_what_is_unknown_are_not_checked(
    judge: Judge, content: dict[str, Any], at: Problem, what: str
) -> None:
    verify(content, subject_of(at))
    assert judge(content, subject_of(at)) == ("not checked", f"the proved checker does not know {what}")


@pytest.mark.parametrize(
    "change",
    [
        {"costs": ["1"]},
        {"rules": [{"rule": "forbid_motion", "forbidden_motion": "sing", "more": 1}]},
        {"rules": [{"rule": "forbid_ingredient", "allergen": ["b", "a"]}]},
        {"rules": [BEFORE], "costs": [2]},
        {"rules": [{**BEFORE, "later_motion": 1}]},
    ],
)
def test_what_can_be_told_without_the_meaning_is_refused(judge: Judge, change: dict[str, Any]) -> None:
    content = certificate(**change)
    with pytest.raises(RefusedError):
        verify(content, subject_of(PLAIN))
    assert judge(content, subject_of(PLAIN))[0] == "refused"


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


def changed(rng: random.Random, content: dict[str, Any]) -> dict[str, Any]:
    """Return a certificate with another value somewhere, sealed."""
    content = copy.deepcopy(content)
    inner: list[tuple[Any, Any]] = []
    waiting: list[Any] = [content]
    while waiting:
        at = waiting.pop()
        keys = [*at] if isinstance(at, dict) else [*range(len(at))]
        inner += [(at, key) for key in keys if key not in ("seal", "digests")]
        waiting += [at[key] for key in keys if isinstance(at[key], dict | list)]
    at, key = rng.choice(inner)
    values: list[Any] = [None, 0, True, "1", "2", "1/2", [], {}, f"{at[key]} "]
    if isinstance(at[key], list):
        values += [at[key][::-1], at[key] + at[key][:1], at[key][1:]]
    elif isinstance(at[key], int):
        values += [at[key] + 1, at[key] - 1]
    at[key] = rng.choice(values)
    return {**content, "seal": seal(content)}


@pytest.mark.parametrize("seeds", [range(20), pytest.param(range(20, 500), marks=pytest.mark.slow)])
def test_both_checkers_agree_about_changed_certificates(judge: Judge, seeds: range) -> None:
    met: Counter[tuple[bool, str]] = Counter()
    for seed in seeds:
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        settings = settings_of([random_rule(rng, problem)])
        objectives = tuple(each for each in random_objectives(rng, 3) if each != Objective.PRICE)
        _, found = certify_outcome(solve(problem, objectives or (Objective.UNITS,), settings), settings)
        assert found is not None
        subject = subject_of(problem)
        for _ in range(5):
            content = changed(rng, read_certificate(found.text()))
            try:
                verify(content, subject)
                right = True
            except (RefusedError, TypeError, AttributeError):
                right = False
            verdict, _ = judge(content, subject)
            assert verdict != ("refused" if right else "accepted")
            met[right, verdict] += 1
    assert met.keys() >= {(True, "accepted"), (False, "refused")}


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
    monkeypatch.setattr(proved_checker, "find_checker", lambda: None)
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
