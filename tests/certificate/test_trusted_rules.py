"""Certificates under rules of the user's own: what they take on trust, and clingo's check of that."""

import hashlib
import json
import random
import re
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.certificate import Coverage, certify_outcome
from foon_asp.certificate.coverage import coverage
from foon_asp.certificate.own_rules import check_with_clingo, with_own_rules
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_rules import trusted_claims
from foon_asp.proof.refusal import CheckLimitError, RefusedError
from foon_asp.proof.rule_meaning import Rule
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import given_constraint
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.oracle.constraints import keeps
from tests.rules.test_constraint_meanings import small
from tests.support.gap_problem import gap_problem
from tests.support.handmade_certificate import check
from tests.support.random_problems import MOTIONS, random_problem

NO_CRUSHING = ':- use(U), motion(U,"crush").\n'
DRAINING = ':- not use(U) : motion(U,"drain").\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (NO_CRUSHING, "no tree has one of the units 27; the tree keeps to them"),
        (DRAINING, "every tree has a unit of 1 set; the tree keeps to them"),
        (":- unit(0).", "no tree keeps to them"),
        (':- use(A), use(B), motion(A,"twist"), motion(B,"crush").', "no tree has all of the units 26, 27"),
        (':- #count { U : use(U), motion(U,"crush") } > 0.', "no tree has one of the units 27"),
        (":- #count { U : use(U), unit(U) } > 1.", "no tree has more than 1 of 209 units"),
        (":- #sum { N,U : use(U), inputs(U,N) } > 5.", "units count comes to 5 at most"),
        ('sharp("crush"). bad(M) :- sharp(M).\n:- use(U), motion(U,M), bad(M).\n', "no tree has one of"),
    ],
)
def test_what_is_taken_on_trust_is_said_and_checked(cli: Cli, tmp_path: Path, text: str, said: str) -> None:
    mine, file = tmp_path / "mine.lp", tmp_path / "proof.json"
    mine.write_text(text)
    asked = ("solve", "--goal", "ice", "--constraint", mine, "--certificate", file)
    assert "but takes on trust what rules say" in cli(*asked).out
    mine.unlink()  # the certificate has all that it is about
    plain = cli("verify", file)
    assert plain.code == 0
    assert "among the trees that keep to mine.lp (SHA-256 " in plain.out
    assert re.search(rf"taken on trust: .*{said}.*\(--with-clingo checks it\)", plain.out)
    checked = cli("verify", file, "--with-clingo")
    assert checked.code == 0
    assert re.search(f"checked with clingo: .*{said}", checked.out)
    for words, (on_trust, by_clingo) in ((), (1, 0)), (("--with-clingo",), (0, 1)):
        found = cli("verify", file, *words, "--format", "json").json
        assert (len(found["trusted"]), len(found["checked"])) == (on_trust, by_clingo)


def test_an_answer_that_rests_on_trust_is_not_called_certified(cli: Cli, tmp_path: Path) -> None:
    ran = cli(
        "solve", "--goal", "ice", "--rule", NO_CRUSHING, "--certificate", tmp_path / "p", "--format", "json"
    )
    assert ran.json["proof"] == "cuts"


def changed(cli: Cli, folder: Path, text: str, change: Any) -> str:
    """Give what clingo says of a certificate in which what is taken on trust is another."""
    mine, file = folder / "mine.lp", folder / "proof.json"
    mine.write_text(text)
    assert cli("solve", "--goal", "ice", "--constraint", mine, "--certificate", file).code == 0
    content = json.loads(file.read_text())
    change(content, content["rules"][0])
    content["seal"] = seal(content)
    file.write_text(json.dumps(content))
    assert cli("verify", file).code == 0  # which is why it says what it takes on trust
    ran = cli("verify", file, "--with-clingo")
    assert ran.code == 1
    return ran.out


def test_a_claim_that_does_not_follow_is_refused(cli: Cli, tmp_path: Path) -> None:
    false = "refused: what is taken on trust is not true: clingo finds a tree without it\n"

    def more(content: Any, own: Any) -> None:
        own["claims"].append([[0], []])

    def narrower(content: Any, own: Any) -> None:
        (claim,) = own["claims"]
        own["claims"] = [[[], [unit for unit in claim[1] if unit in content["tree"]]]]

    assert changed(cli, tmp_path, NO_CRUSHING, more) == false
    assert changed(cli, tmp_path, DRAINING, narrower) == false


def test_rules_that_clingo_cannot_take_are_refused(cli: Cli, tmp_path: Path) -> None:
    def script(content: Any, own: Any) -> None:
        text = "#script (python) print(1) #end."
        own["files"][0].update(text=text, sha256=hashlib.sha256(text.encode()).hexdigest())

    assert changed(cli, tmp_path, NO_CRUSHING, script).startswith("refused: clingo cannot be asked")


RULES: dict[str, dict[str, str]] = {
    ':- use(U), motion(U,"{0}").': {"rule": "forbid_motion", "forbidden_motion": "{0}"},
    ':- not use(U) : motion(U,"{0}").': {"rule": "require_motion", "required_motion": "{0}"},
    ':- use(U), input(U,O), label(O,"salt"), motion(U,"{0}").': {},
}


@pytest.mark.slow
def test_answers_under_random_rules_of_the_users_own() -> None:
    met = set()
    for seed in range(100):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2])
        motion, limited = rng.choice(MOTIONS), rng.choice(MOTIONS)
        text, same = rng.choice([*RULES.items()])
        given = [given_constraint(text.format(motion))]
        rules: list[Any] = [{name: value.format(motion) for name, value in same.items()}]
        if rng.random() < 0.5:
            given.append(given_constraint(f"at_most_motion:limited_motion={limited},max_uses=1"))
            rules.append({"rule": "at_most_motion", "limited_motion": limited, "max_uses": 1})
        settings = Settings(tuple(given))
        outcome, found = certify_outcome(solve(problem, (Objective.UNITS,), settings), settings)
        assert found is not None
        met.add((found.claim, trusted_claims(found.content) is not None))
        claim = check(found.content, problem)
        own = trusted_claims(found.content)
        if own is not None:
            check_with_clingo(found.content, own, problem)
        if same:
            kept = [t for t in task_trees.trees(problem) if all(keeps(problem, t, rule) for rule in rules)]
            assert (outcome.status is Status.INFEASIBLE) == (not kept)
            if claim.claim == "optimal":
                assert claim.costs is not None
                assert claim.costs[0] == min(map(len, kept))
            else:
                assert claim.claim == "infeasible"
    assert {("optimal", True), ("infeasible", True)} <= met


# --- By hand: what is taken on trust of which rules.

BOILED = small("cut: start > a", "mix: a > end", "boil: start > end", "rot: end > a", "junk: start > x")
NO_BOILING, NO_ROTTING = (f':- use(U), motion(U,"{motion}").' for motion in ("boil", "rot"))
JUNK = ':- not use(U) : motion(U,"junk").'


def own_rule(*given: str, **named: Any) -> Rule:
    """Give what rules of the user's own come to, beside the covered ones."""
    settings = Settings(tuple(map(given_constraint, given)))._replace(**named)
    covered = with_own_rules(coverage(settings), BOILED, settings)
    assert covered is not None
    assert covered.not_covered == ()
    (own,) = (rule for rule in covered.rules if rule["rule"] == "own")
    assert Coverage((own,)).partial
    return own


def test_what_rules_of_the_users_own_claim() -> None:
    for given, claims, library in (
        ([NO_BOILING], [[[2], []]], []),
        ([NO_BOILING, JUNK], [[[2], []], [[], [4]]], []),
        ([":- goal(O)."], [[[], []]], []),
        # what ours say, too, is not taken on trust
        ([JUNK, NO_BOILING, "require_motion:required_motion=junk"], [[[2], []]], ["require_motion"]),
        ([NO_BOILING, NO_ROTTING, "forbid_motion:forbidden_motion=boil"], [[[3], []]], ["forbid_motion"]),
    ):
        own = own_rule(*given)
        assert own["claims"] == claims
        assert [name.partition(":")[0] for name in own["library"]] == library
        texts = [rule for rule in given if rule.startswith(":-")]
        assert [file["text"] for file in own["files"]] == texts
    own = own_rule(NO_BOILING, "at_most_units", constants=("max_units=3",))
    assert (own["library"], own["constants"]) == (["at_most_units"], ["max_units=3"])
    assert len(own["files"]) == 1


def test_of_rules_beside_other_encodings_nothing_is_claimed() -> None:
    settings = Settings((given_constraint(NO_BOILING),), encodings=encodings_folder())
    assert with_own_rules(coverage(settings), BOILED, settings) is None


def test_a_file_is_stated_with_what_it_includes(tmp_path: Path) -> None:
    alone, more = tmp_path / "alone.lp", tmp_path / "more.lp"
    alone.write_text(f"% Why: it boils over.\n{NO_BOILING}\n\n")
    more.write_text(f'#include "alone.lp".\n{NO_ROTTING}\n')
    own = own_rule(str(alone))
    (file,) = own["files"]
    assert (file["name"], file["text"]) == ("alone.lp", alone.read_text())
    assert file["sha256"] == hashlib.sha256(alone.read_bytes()).hexdigest()
    own = own_rule(str(more))
    (file,) = own["files"]
    assert "#include" not in file["text"]
    assert "boil" in file["text"]
    assert "rot" in file["text"]


def test_clingo_says_what_of_it_is_not_true() -> None:
    own = own_rule(NO_BOILING, JUNK)
    tree: dict[str, Any] = {"tree": [0, 1, 4], "objective": ["units"]}
    none: dict[str, Any] = {"tree": None, "objective": []}
    for content in (tree, none):
        check_with_clingo(content, own, BOILED)
    claims: list[list[list[int]]] = [[[0], []], [[], [3]], [[], []], [[4], [2]]]
    for false in claims:
        with pytest.raises(RefusedError, match="what is taken on trust is not true"):
            check_with_clingo(none, {**own, "claims": [*own["claims"], false]}, BOILED)
    with pytest.raises(RefusedError, match="the tree does not keep to the rules"):
        check_with_clingo({**tree, "tree": [0, 1]}, own, BOILED)
    check_with_clingo(none, own_rule(":- unit(0)."), BOILED)


# --- What shrinking rules limit.

SHRINKING = {
    ':- use(A), use(B), A < B, motion(A,"{0}"), motion(B,"{1}").': "pairs",
    ':- #count {{ U : use(U), motion(U,"{0}") }} > 1.': "sums",
    ":- #sum {{ N,U : use(U), inputs(U,N) }} > 4.": "sums",
    "p(L) :- use(U), output(U,O), label(O,L).\n:- #count {{ L : p(L) }} > 2.": "helpers",
    ":- available(O), available(P), O < P, not kitchen(O), not kitchen(P), state(O,S), state(P,S).": "far",
}


@pytest.mark.parametrize("part", [39, pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.default_cases("39")
def test_answers_under_random_shrinking_rules_of_the_users_own(
    part: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each has a certificate, whose claims clingo confirms, and the verifier refuses it without them."""
    monkeypatch.setattr("foon_asp.asp.assembly._is_ready_made", lambda _: True)  # grounded in this process
    met = set()
    for seed in range(3, 400, part):
        rng = random.Random(seed)
        problem = (
            gap_problem(seed % 8, 4) if seed % 4 == 3 else random_problem(seed, list(ContainerRule)[seed % 2])
        )
        motions = problem.network.motions
        text = rng.choice([*SHRINKING])
        given = [given_constraint(text.format(rng.choice(motions), rng.choice(motions)))]
        if rng.random() < 0.3:
            given.append(given_constraint(f"at_most_motion:limited_motion={rng.choice(motions)},max_uses=1"))
        settings = Settings(tuple(given))
        outcome, found = certify_outcome(solve(problem, (Objective.UNITS,), settings), settings)
        assert found is not None
        assert found.claim == ("infeasible" if outcome.status is Status.INFEASIBLE else "optimal")
        own = trusted_claims(found.content)
        check(found.content, problem)
        met.add((SHRINKING[text], own is not None))
        if own is not None:
            assert own["limits"]
            check_with_clingo(found.content, own, problem)
            content = json.loads(found.text())
            for rule in content["rules"]:
                for limit in rule.get("limits", ()):
                    limit[1] += 1000
            content["seal"] = seal(content)
            with pytest.raises(RefusedError):
                check(content, problem)
    if part == 4:
        assert met == {(kind, trusts) for kind in SHRINKING.values() for trusts in (False, True)}


ONE_OF = ':- use(A), use(B), motion(A,"cut"), motion(B,"mix").'
WHERE_JUNK = ':- use(A), use(B), motion(A,"cut"), motion(B,"mix"), unit(U), motion(U,"junk").'
FEW = ":- #sum { N,U : use(U), inputs(U,N) } > 1."
CUT_ONLY = ':- #sum { 1,U : use(U), motion(U,"cut"); 0,U : use(U), motion(U,"mix") } > 0.'
UNKNOWN = ":- #sum { 2*N-1,U : use(U), inputs(U,N) } > 1."  # of which nobody knows that it is shrinking
NO_TREE = "infeasible"


@pytest.mark.parametrize(
    ("rules", "claim", "claims", "limits"),
    [
        # no cut has a unit that rots as a member
        ((NO_BOILING, NO_ROTTING), "optimal", [[[2], []]], []),
        ((NO_ROTTING,), "optimal", None, None),  # the proof does not need it
        # of the two ways to the end, one is longer, and with a limit on what is cut there is none
        ((NO_BOILING, ONE_OF), NO_TREE, [[[2], []]], [[{"1": [0, 1]}, 1]]),
        ((NO_BOILING, WHERE_JUNK), NO_TREE, [[[2], []]], [[{"1": [0, 1]}, 1]]),
        ((NO_BOILING, FEW), NO_TREE, [[[2], []]], [[{"1": [0, 1, 2, 3, 4]}, 1]]),
        ((NO_BOILING, CUT_ONLY), NO_TREE, [[[2], []]], [[{"1": [0]}, 0]]),
        ((NO_BOILING, UNKNOWN), None, None, None),
        # what ours say is not taken on trust
        ((NO_BOILING, FEW, "at_most_units:max_units=1"), NO_TREE, [[[2], []]], []),
        (
            (NO_BOILING, FEW, "at_most_motion:limited_motion=cut,max_uses=1"),
            NO_TREE,
            [[[2], []]],
            [[{"1": [*range(5)]}, 1]],
        ),
    ],
)
def test_what_a_proof_takes_on_trust(
    rules: tuple[str, ...], claim: str | None, claims: Any, limits: Any
) -> None:
    settings = Settings(tuple(map(given_constraint, rules)))
    outcome, found = certify_outcome(solve(BOILED, settings=settings), settings)
    assert (found and found.claim) == claim
    own = None if found is None else trusted_claims(found.content)
    assert (None if own is None else own["claims"]) == claims
    assert (None if own is None else own["limits"]) == limits
    assert (outcome.proof is Proof.CERTIFICATE) == (claim is not None and own is None)


def test_clingo_says_what_limits_are_not_true() -> None:
    own = own_rule(NO_BOILING)
    none: dict[str, Any] = {"tree": None, "objective": []}
    for most in (2, 2**31 - 1):
        check_with_clingo(none, {**own, "limits": [[{"1": [0, 1], "5": [2]}, most]]}, BOILED)
    for limit in ([{"1": [0, 1]}, 1], [{"3": [0], "1": [4]}, 2]):
        with pytest.raises(RefusedError, match="what is taken on trust is not true"):
            check_with_clingo(none, {**own, "limits": [limit]}, BOILED)
    for limit in ([{str(2**31): [0]}, 1], [{"1": [0]}, -(2**31)]):
        with pytest.raises(CheckLimitError, match="clingo cannot add up"):
            check_with_clingo(none, {**own, "limits": [limit]}, BOILED)
