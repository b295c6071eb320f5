"""Certificates of plans in which items are used up: what is claimed is true, and what is not is refused."""

import json
from dataclasses import replace
from decimal import ROUND_FLOOR, Decimal, localcontext
from fractions import Fraction
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Outcome, Settings, Status
from foon_asp.asp.optimum import solve
from foon_asp.certificate import Certificate, Coverage, certify_no_plan, certify_outcome, certify_plan
from foon_asp.certificate.certificate import subject_of
from foon_asp.deadline import Deadline
from foon_asp.network import ObjectNode, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, UsedUp, levels
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.verified_claim import Verified
from foon_asp.proof.verify_plan import LOGARITHM_SCALE, verify_any
from foon_asp.questions.certificate_text import certificate_lines
from tests.conftest import Cli
from tests.oracle.used_up import key, plans, random_problem
from tests.proof.test_verify import mutants
from tests.rules.test_constraint_meanings import small

Content = dict[str, Any]

UNITS, INPUTS, INGREDIENTS, SUCCESS, KITCHEN, ATTEMPTS, *_ = Objective
LISTS: list[tuple[Objective, ...]] = [
    *((UNITS,), (INPUTS,), (SUCCESS,), (KITCHEN,), (ATTEMPTS,)),
    *((KITCHEN, SUCCESS), (SUCCESS, KITCHEN), (INGREDIENTS,)),
]
RULES: list[tuple[str, tuple[str, ...]]] = [
    ("forbid_motion", ("forbidden_motion=a",)),
    ("at_most_motion", ("limited_motion=b", "max_uses=1")),
    ("require_motion", ("required_motion=c",)),
    ("at_most_units", ("max_units=3",)),
    ("not_both_motions", ("one_motion=a", "other_motion=b")),
]


def check(content: Any, problem: Problem) -> Verified:
    return verify_any(content, subject_of(problem))


def certified(
    problem: Problem, asked: tuple[Objective, ...], how: Settings
) -> tuple[Outcome, Certificate | None]:
    """Solve a problem, and find a certificate."""
    deadline = Deadline(5)
    found = solve(problem, asked, how._replace(deadline=Deadline(5)))
    return certify_outcome(found, how, lambda: deadline.passed)


def best(problem: Problem, asked: tuple[Objective, ...], longest: int = 5) -> tuple[Any, ...] | None:
    """Give what the best of all plans up to a length costs, as a key."""
    keys = (key(problem, counts, kitchen, asked) for counts, kitchen in plans(problem, longest))
    return min(keys, default=None)


def require_true(verified: Verified, problem: Problem, bound: list[Any] | None, longest: int = 5) -> None:
    """Require that no plan up to a length is better than what is claimed."""
    asked = tuple(map(Objective, verified.objectives))
    found = best(problem, asked, longest)
    if verified.claim == "infeasible":
        assert found is None
    elif verified.claim == "optimal":
        assert verified.costs is not None
        pairs = zip(asked, verified.costs, strict=True)
        claimed = tuple(-cost if objective is SUCCESS else cost for objective, cost in pairs)
        assert found is None or found >= claimed
    else:
        assert bound is not None
        if asked[0] is SUCCESS:
            product = 1.0
            for rate, exponent in bound[0].items():
                product *= float(Fraction(rate)) ** float(Fraction(exponent))
            assert found is None or -float(found[0]) <= product * (1 + 1e-9)
        else:
            assert found is None or found[0] >= Fraction(bound[0])


def hold(seed: int) -> str:
    """Certify the answer to a random question, and hold what is claimed against every short plan."""
    problem, asked = random_problem(seed), LISTS[seed % len(LISTS)]
    outcome, certificate = certified(problem, asked, Settings())
    if certificate is None:
        assert outcome.status not in (Status.OPTIMAL, Status.INFEASIBLE)
        return "none"
    verified = check(certificate.content, problem)
    require_true(verified, problem, certificate.content["bound"], 4)
    assert (verified.claim == "infeasible") == (outcome.status is Status.INFEASIBLE)
    whole = verified.claim == "infeasible" or certificate.certified == levels(asked)
    return verified.claim if whole else "bound"


@pytest.mark.parametrize("seed", range(24))
def test_every_answer_to_small_questions_is_certified(seed: int) -> None:
    assert hold(seed) in ("optimal", "infeasible")


@pytest.mark.slow
def test_many_small_questions() -> None:
    claims = [hold(seed) for seed in range(100, 800) if seed != 102]
    assert claims.count("bound") + claims.count("none") < 10
    assert claims.count("infeasible") > 200
    assert claims.count("optimal") > 200


@pytest.mark.parametrize("seed", range(5))
def test_under_rules_the_claim_is_about_plans_that_keep_to_them(seed: int) -> None:
    problem = random_problem(seed + 1000)
    name, constants = RULES[seed % len(RULES)]
    how = Settings((Path(name),), constants=constants)
    outcome, certificate = certified(problem, (UNITS,), how)
    assert certificate is not None or outcome.status is Status.INFEASIBLE
    if certificate is None:
        return
    verified = check(certificate.content, problem)
    covered = name != "not_both_motions"
    assert [rule["rule"] for rule in verified.rules] == [name] * covered
    assert bool(verified.not_covered) == (not covered)
    if outcome.costs is not None and covered:
        assert verified.claim == "optimal"
        assert verified.costs == (outcome.costs.units,)


# --- mutants


# Questions of up to so many units whose certificates are of all kinds; the last one proves a bound.
SUBJECTS = [*((seed, 12) for seed in (0, 1, 19, 23, 41, 66, 92, 128, 138, 156, 181, 229, 251, 318)), (577, 6)]


@cache
def subjects() -> list[tuple[Problem, Content]]:
    """Give certificates of all kinds, on networks small enough for brute force."""
    found: list[tuple[Problem, Content]] = []
    for seed, most in SUBJECTS:
        problem = random_problem(seed, most)
        _, certificate = certified(problem, LISTS[seed % len(LISTS)], Settings())
        assert certificate is not None
        found.append((problem, certificate.content))
    return found


def accepted(content: Content, problem: Problem) -> Verified | None:
    """Seal a changed certificate anew; give what it proves, or ``None`` where it is refused."""
    content["seal"] = seal(content)
    try:
        return check(content, problem)
    except RefusedError:
        return None


def require_no_lie(problem: Problem, mutant: Content) -> bool:
    """Require that what a mutant is accepted for is true of the question that it is about."""
    verified = accepted(mutant, problem)
    if verified is None:
        return False
    assert verified.used_up is not None
    objects = problem.network.objects
    told = verified.used_up.stays.items()
    stays = {name if isinstance(name, str) else objects[name]: kept for name, kept in told}
    stock = {objects[o]: count for o, count in verified.used_up.stock.items()}
    asked = replace(
        problem,
        goals=verified.goals,
        containers=ContainerRule(verified.containers),
        items=UsedUp(stays, stock),
    )
    require_true(verified, asked, mutant["bound"], 4)
    return True


def test_the_subjects_are_of_all_kinds() -> None:
    claims = [content["claim"] for _, content in subjects()]
    assert [claims.count(claim) for claim in ("optimal", "bound", "infeasible")] == [11, 1, 3]
    proofs = json.dumps([content["proof"] for _, content in subjects()])
    assert all(f'"{part}"' in proofs for part in ("weights", "before", "balance", "levels", "branch"))
    assert any(content["unreached"] for _, content in subjects())
    assert any(content["items"]["stock"] and content["items"]["stays"] for _, content in subjects())


def test_a_mutant_that_is_sealed_anew_passes_only_if_what_it_claims_is_true() -> None:
    tried = passed = 0
    for problem, content in subjects()[:9]:
        for _, mutant in islice(mutants(content), 5, None, 50):
            tried += 1
            passed += require_no_lie(problem, mutant)
    assert tried > 80
    assert passed < tried / 5


@pytest.mark.slow
def test_all_mutants() -> None:
    tried = 0
    for problem, content in subjects():
        for path, mutant in mutants(content):
            tried += 1
            require_no_lie(problem, mutant)
            if path != ("seal",):
                with pytest.raises(RefusedError):
                    check({**mutant, "seal": content["seal"]}, problem)
    assert tried > 5_000


# --- how much is proved


def covering(rule: str, **values: Any) -> Coverage:
    return Coverage(({"rule": rule, **values},))


def problem_of(*units: str, **more: Any) -> Problem:
    return replace(small(*units), items=UsedUp(), **more)


HALVED = problem_of("mix: start > end", rates={"mix": Fraction(1)})
NEAR = problem_of("roast: start, salt > end", "boil: start > end")
RELIABLE = covering("least_rate", least_rate=900_000)


def rate(cost: str) -> Fraction:
    """Give a rate whose logarithm, below 0, has so many parts of a billion; it has 70 digits."""
    with localcontext(prec=120):
        exact = (-Decimal(cost) / LOGARITHM_SCALE).exp()
        return Fraction(exact.quantize(Decimal(1).scaleb(-70), rounding=ROUND_FLOOR))


@pytest.mark.parametrize(("boil", "proved"), [("500000001.5", 1), ("500000002.5", 3)])
def test_plans_that_are_nearly_as_good_by_success_are_taken_to_be_as_good(boil: str, proved: int) -> None:
    """Then nothing is proved by what comes after it, of whatever that may be true."""
    problem = replace(NEAR, rates={"roast": rate("500000000"), "boil": rate(boil)})
    by = (SUCCESS, INPUTS, UNITS)
    certificate = certify_plan(problem, by, (0,))
    assert certificate is not None
    assert (certificate.claim, certificate.certified) == ("optimal", by[:proved])


def test_after_costs_that_are_too_fine_nothing_more_is_proved() -> None:
    by = (UNITS, Objective.PRICE, INPUTS)
    for fine, proved in ((9, 3), (10, 2)):
        prices = UnitPrices({"boil": Fraction(1, 10**fine), "roast": Fraction(1)}, {})
        certificate = certify_plan(replace(NEAR, unit_prices=prices), by, (1,))
        assert certificate is not None
        assert certificate.certified == by[:proved]


def test_with_rates_of_their_own_nothing_is_proved_of_what_looks_at_rates() -> None:
    own = replace(HALVED, own_rates={0: Fraction(1, 2)})
    assert certify_plan(own, (UNITS,), (0,)) is not None
    assert certify_plan(own, (UNITS, SUCCESS), (0,)) is None
    assert certify_plan(own, (UNITS,), (0,), covering("at_most_units", max_units=1)) is None
    assert certify_no_plan(own, RELIABLE) is None
    assert certify_no_plan(replace(HALVED, rates={"mix": Fraction(1, 2)}), RELIABLE) is not None
    assert certify_no_plan(replace(own, kitchen=frozenset())) is not None


def test_with_a_rate_of_0_nothing_is_proved_by_success_and_what_comes_after_it() -> None:
    never = replace(HALVED, rates={"mix": Fraction(0)})
    assert certify_plan(never, (SUCCESS, UNITS), (0,)) is None
    certificate = certify_plan(never, (UNITS, SUCCESS, INPUTS), (0,))
    assert certificate is not None
    assert certificate.certified == (UNITS,)
    other = replace(NEAR, rates={"roast": Fraction(1, 2), "boil": Fraction(0)})
    assert certify_plan(other, (SUCCESS,), (0,)) is None


def test_when_time_is_up_what_is_proved_is_certified() -> None:
    by = (UNITS, INPUTS)
    for expired, proved in ((lambda: False, 2), (lambda: True, 1)):
        certificate = certify_plan(HALVED, by, (0,), expired=expired)
        assert certificate is not None
        assert (certificate.claim, certificate.certified) == ("optimal", by[:proved])


def test_that_there_is_no_plan_may_take_branching_for_which_there_has_to_be_time() -> None:
    """Each side of two triangles is tied at one of its ends, and two of three have to be ready for that."""
    corners, sides = "abcdef", ("ab", "bc", "ca", "de", "ef", "fd")
    ready = (f"ready: start > {corner}" for corner in corners)
    tied = (f"tie: {corner} > {side}" for side in sides for corner in side)
    problem = small(*ready, *tied, f"bake: {', '.join(sides)} > end")
    asked = replace(problem, items=UsedUp(dict.fromkeys(corners, True)))
    for most, there_is in ((3, False), (4, True)):
        rule = covering("at_most_motion", limited_motion="ready", max_uses=most)
        assert (certify_no_plan(asked, rule) is None) == there_is
        assert certify_no_plan(asked, rule, lambda: True) is None


def test_that_a_rule_alone_allows_no_plan_takes_no_proof() -> None:
    certificate = certify_no_plan(HALVED, covering("forbid_ingredient", allergen=["end"]))
    assert certificate is not None
    assert (certificate.claim, certificate.content["proof"]) == ("infeasible", [{}])


def test_limits_count_each_execution() -> None:
    """Each plan mixes twice, and has five executions of four units; one of a is cut, and one is chopped."""
    asked = problem_of("mix: start > a", "cut: a > b", "chop: a > c", "bake: b, c > end")
    for most, none in ((4, True), (5, False)):
        assert (certify_no_plan(asked, covering("at_most_units", max_units=most)) is not None) == none
    for most, none in ((1, True), (2, False)):
        rule = covering("at_most_motion", limited_motion="mix", max_uses=most)
        assert (certify_no_plan(asked, rule) is not None) == none


def test_copies_that_a_plan_takes_are_no_contradiction() -> None:
    """Three eggs are needed, and the plan in hand takes salt as well, for nothing."""
    problem = small("beat: egg > a", "mix: egg > b", "boil: egg > c", "bake: a, b, c > end", "melt: salt > x")
    eggs = replace(problem, items=UsedUp(stock={ObjectNode.of("egg"): 4}))
    best = solve(eggs, (KITCHEN,))
    assert best.costs is not None
    assert best.costs.kitchen == 3
    units = (0, 1, 2, 4, 3)
    stopped = best._replace(status=Status.FEASIBLE, units=units, costs=eggs.costs(units), proof=None)
    _, certificate = certify_outcome(stopped, Settings())
    assert certificate is not None
    assert (certificate.claim, certificate.content["bound"]) == ("bound", ["3"])


# --- answers at a limit


def test_a_plan_that_was_found_at_a_limit_can_be_proved_the_best() -> None:
    problem = foon_asp.load().problem("greek salad", items="used-up")
    found = solve(problem)
    stopped = found._replace(status=Status.FEASIBLE, proof=None, stopped="time limit", bounds={})
    outcome, certificate = certify_outcome(stopped, Settings())
    assert certificate is not None
    assert (certificate.claim, outcome.status, outcome.stopped) == ("optimal", Status.OPTIMAL, None)
    assert outcome.bounds == found.bounds
    assert certify_outcome(stopped._replace(units=None, status=Status.UNKNOWN), Settings())[1] is None


def test_without_time_the_bound_of_the_first_relaxation_is_proved() -> None:
    problem = random_problem(577)
    stopped = solve(problem, (INPUTS,))._replace(status=Status.FEASIBLE, proof=None)
    outcome, certificate = certify_outcome(stopped, Settings(), lambda: True)
    assert certificate is not None
    assert (certificate.claim, outcome.status) == ("bound", Status.FEASIBLE)
    lines = certificate_lines(outcome, certificate, "proof.json")
    assert lines[0].startswith(
        "proof: none; the certificate proof.json proves a bound on all plans: inputs at"
    )
    require_true(check(certificate.content, problem), problem, certificate.content["bound"])


# --- the command line


def test_a_plan_is_certified_and_verified(cli: Cli, tmp_path: Path) -> None:
    proof, plan = tmp_path / "proof.json", tmp_path / "plan.txt"
    asked = ("--goal", "macaroni", "--items", "used-up", "--containers", "implied")
    solved = cli("solve", *asked, "--format", "foon", "--certificate", str(proof))
    plan.write_text(solved.out, encoding="utf-8")
    shown = cli("verify", str(proof))
    assert shown.code == 0
    assert "verified: no plan is better by units (implied containers, items used up)" in shown.out
    certified = cli("check", plan, *asked, "--certificate", tmp_path / "again.json")
    assert (certified.code, "\nproved best by units (" in certified.out) == (0, True)
    again = json.loads((tmp_path / "again.json").read_text(encoding="utf-8"))
    assert again["tree"] == json.loads(proof.read_text(encoding="utf-8"))["tree"]


def test_what_is_not_the_best_gets_a_bound_and_what_does_not_run_nothing(cli: Cli, tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    plan.write_text(cli("solve", "--goal", "ice", "--items", "used-up", "--format", "foon").out)
    spare = cli("solve", "--goal", "macaroni", "--items", "used-up", "--format", "foon").out
    asked = ("--goal", "ice", "--items", "used-up", "--certificate", str(tmp_path / "p.json"))
    (tmp_path / "more.txt").write_text(plan.read_text(encoding="utf-8") + spare, encoding="utf-8")
    more = cli("check", tmp_path / "more.txt", *asked)
    assert more.code == 3
    assert more.out.endswith(" proves a bound only: units at least 2; the plan has 11 (gap 9)\n")
    said = "verified: a bound on all plans (strict containers, items used up): units at least 2"
    assert said in cli("verify", str(tmp_path / "p.json")).out
    (tmp_path / "other.txt").write_text(spare, encoding="utf-8")
    (tmp_path / "p.json").unlink()
    other = cli("check", tmp_path / "other.txt", *asked)
    assert (other.code, "does not execute" in other.out, (tmp_path / "p.json").exists()) == (1, True, False)


def test_a_stock_and_what_stays_are_part_of_the_claim(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "stock.txt").write_text("onion; whole→1\n".replace("→", "\t"), encoding="utf-8")
    (tmp_path / "stays.txt").write_text("mixing bowl\tstays\n", encoding="utf-8")
    given = ("--stock", str(tmp_path / "stock.txt"), "--stays", str(tmp_path / "stays.txt"))
    proof = str(tmp_path / "proof.json")
    assert cli("solve", "--goal", "ice", "--items", "used-up", *given, "--certificate", proof).code == 0
    shown = cli("verify", proof).out
    assert "in stock: 1 x onion; whole" in shown
    assert "said to stay: mixing bowl" in shown
    said = json.loads(cli("verify", proof, "--format", "json").out)
    assert (said["items"], said["used_up"][0]) == ("used-up", "in stock: 1 x onion; whole")
