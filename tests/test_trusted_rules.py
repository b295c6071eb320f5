"""Certificates under rules of the user's own: what they take on trust, and clingo's check of that."""

import hashlib
import json
import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp import deadline
from foon_asp.asp import Proof, Settings, Status, solve
from foon_asp.asp.prepared import Prepared
from foon_asp.bounds.exact_optimum import Limit
from foon_asp.certificate import Coverage, certify_outcome
from foon_asp.certificate.coverage import coverage
from foon_asp.certificate.own_limits import OwnLimits
from foon_asp.certificate.own_rules import check_with_clingo, with_own_rules
from foon_asp.deadline import Deadline
from foon_asp.grounding.run import Run
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof.constraint import Rule
from foon_asp.proof.verify import LimitError, RefusedError, seal, trusted, verify
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import given_constraint
from foon_asp.rules.rules import Rules
from tests import oracle
from tests.conftest import Cli
from tests.constraint_oracle import keeps
from tests.gap_problem import gap_problem
from tests.random_problems import MOTIONS, random_problem
from tests.test_constraint_meanings import small

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

NO_CRUSHING = ':- use(U), motion(U,"crush").\n'
DRAINING = ':- not use(U) : motion(U,"drain").\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (NO_CRUSHING, "no tree has one of the units 27; the tree keeps to them"),
        (DRAINING, "every tree has a unit of 1 set; the tree keeps to them"),
        ('sharp("crush"). bad(M) :- sharp(M).\n:- use(U), motion(U,M), bad(M).\n', "no tree has one of"),
    ],
)
def test_what_is_taken_on_trust_is_said_and_checked(cli: Cli, tmp_path: Path, text: str, said: str) -> None:
    mine, file = tmp_path / "mine.lp", tmp_path / "proof.json"
    mine.write_text(text)
    asked = ("certify", "--goal", "ice", "--constraint", mine, "-o", file)
    found = cli(*asked)
    assert found.code == 0
    assert "but takes on trust what rules say" in found.err
    mine.unlink()  # the certificate has all that it is about
    plain = cli("verify", file)
    assert plain.code == 0
    assert "among the trees that keep to mine.lp (SHA-256 " in plain.out
    assert f"taken on trust (--with-clingo checks it): {said}" in plain.out
    checked = cli("verify", file, "--with-clingo")
    assert checked.code == 0
    assert f"checked with clingo: {said}" in checked.out
    assert cli("verify", file, "--format", "json").json["trusted"]["checked"] is False
    assert cli("verify", file, "--with-clingo", "--format", "json").json["trusted"]["checked"] is True


def test_that_no_tree_keeps_to_rules_is_said_to_be_taken_on_trust(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    assert cli("certify", "--goal", "ice", "--rule", ":- unit(0).", "-o", file).code == 1
    assert "; taken on trust (--with-clingo checks it): no tree keeps to them\n" in cli("verify", file).out


def test_an_answer_that_rests_on_trust_is_not_called_certified(cli: Cli, tmp_path: Path) -> None:
    ran = cli(
        "solve", "--goal", "ice", "--rule", NO_CRUSHING, "--certificate", tmp_path / "p", "--format", "json"
    )
    assert ran.json["proof"] == "cuts"


def changed(cli: Cli, folder: Path, text: str, change: Any) -> str:
    """Give what clingo says of a certificate in which what is taken on trust is another."""
    mine, file = folder / "mine.lp", folder / "proof.json"
    mine.write_text(text)
    assert cli("certify", "--goal", "ice", "--constraint", mine, "-o", file).code == 0
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


def test_a_tree_that_breaks_the_rules_is_refused(cli: Cli, tmp_path: Path) -> None:
    def weaker(content: Any, own: Any) -> None:
        own["claims"], own["files"][0]["text"] = [], ":- not use(0).\n"
        content.update(claim="bound", bound=["0"], cuts=[], proof={"weights": []})
        own["files"][0]["sha256"] = hashlib.sha256(own["files"][0]["text"].encode()).hexdigest()

    said = "refused: the tree does not keep to the rules: clingo says so\n"
    assert changed(cli, tmp_path, NO_CRUSHING, weaker) == said


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
@pytest.mark.parametrize("part", [8, pytest.param(1, marks=pytest.mark.slow)])
def test_answers_under_random_rules_of_the_users_own(part: int) -> None:
    met = set()
    for seed in range(0, 240, part):
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
        met.add((found.claim, trusted(found.content) is not None))
        claim = verify(
            found.content,
            problem.network,
            problem.kitchen,
            problem.rates,
            problem.utensils,
            problem.unit_prices,
        )
        own = trusted(found.content)
        if own is not None:
            check_with_clingo(found.content, own, problem)
        if same:
            kept = [t for t in oracle.trees(problem) if all(keeps(problem, t, rule) for rule in rules)]
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


def own_rule(*given: str, **named: Any) -> Rule | None:
    """Give what rules of the user's own come to, beside the covered ones."""
    settings = Settings(tuple(map(given_constraint, given)))._replace(**named)
    covered = with_own_rules(coverage(settings), BOILED, settings)
    if covered is None:
        return None
    assert covered.not_covered == ()
    (own,) = (rule for rule in covered.rules if rule["rule"] == "own")
    assert Coverage((own,)).partial
    return own


def test_what_rules_of_the_users_own_claim() -> None:
    for given, claims, library in (
        ([NO_BOILING], [[[2], []]], []),
        ([NO_BOILING, JUNK], [[[2], []], [[], [4]]], []),
        ([":- unit(0)."], [[[], []]], []),
        # what ours say, too, is not taken on trust
        ([JUNK, NO_BOILING, "require_motion:required_motion=junk"], [[[2], []]], ["require_motion"]),
        ([NO_BOILING, NO_ROTTING, "forbid_motion:forbidden_motion=boil"], [[[3], []]], ["forbid_motion"]),
    ):
        own = own_rule(*given)
        assert own is not None
        assert own["claims"] == claims
        assert [name.partition(":")[0] for name in own["library"]] == library
        texts = [rule for rule in given if rule.startswith(":-")]
        assert [file["text"] for file in own["files"]] == texts
    own = own_rule(NO_BOILING, "at_most_units", constants=("max_units=3",))
    assert own is not None
    assert (own["library"], own["constants"]) == (["at_most_units"], ["max_units=3"])
    assert len(own["files"]) == 1


def test_of_rules_that_are_not_understood_nothing_is_claimed(monkeypatch: pytest.MonkeyPatch) -> None:
    assert own_rule(NO_BOILING, encodings=encodings_folder()) is None
    monkeypatch.setattr(Rules, "applied", lambda *_: None)
    assert own_rule(NO_BOILING) is None


def test_a_file_is_stated_with_what_it_includes(tmp_path: Path) -> None:
    alone, more = tmp_path / "alone.lp", tmp_path / "more.lp"
    alone.write_text(f"% Why: it boils over.\n{NO_BOILING}\n\n")
    more.write_text(f'#include "alone.lp".\n{NO_ROTTING}\n')
    own = own_rule(str(alone))
    assert own is not None
    (file,) = own["files"]
    assert (file["name"], file["text"]) == ("alone.lp", alone.read_text())
    assert file["sha256"] == hashlib.sha256(alone.read_bytes()).hexdigest()
    own = own_rule(str(more))
    assert own is not None
    (file,) = own["files"]
    assert "#include" not in file["text"]
    assert "boil" in file["text"]
    assert "rot" in file["text"]


def test_only_what_a_proof_rests_on_is_claimed() -> None:
    settings = Settings((given_constraint(NO_BOILING), given_constraint(NO_ROTTING)))
    _, found = certify_outcome(solve(BOILED, settings=settings), settings)
    assert found is not None
    own = trusted(found.content)
    assert own is not None
    assert (found.claim, own["claims"]) == ("optimal", [[[2], []]])  # no cut has a unit that rots as a member


def test_clingo_says_what_of_it_is_not_true() -> None:
    own = own_rule(NO_BOILING, JUNK)
    assert own is not None
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
    never = own_rule(":- unit(0).")
    assert never is not None
    check_with_clingo(none, never, BOILED)


def test_nothing_is_taken_on_trust_that_a_proof_does_not_need(monkeypatch: pytest.MonkeyPatch) -> None:
    settings = Settings((given_constraint(NO_ROTTING),))
    outcome, found = certify_outcome(solve(BOILED, settings=settings), settings)
    assert found is not None
    assert (found.claim, trusted(found.content), outcome.proof) == ("optimal", None, Proof.CERTIFICATE)
    # of rules that are not understood, there is nothing to trust, and only a bound
    monkeypatch.setattr(Rules, "applied", lambda *_: None)
    settings = Settings((given_constraint(NO_BOILING),))
    outcome, found = certify_outcome(solve(BOILED, settings=settings), settings)
    assert found is not None
    assert (found.claim, trusted(found.content), outcome.proof) == ("bound", None, Proof.SOLVER)


# --- What shrinking rules limit.

SHRINKING = {
    ':- use(A), use(B), A < B, motion(A,"{0}"), motion(B,"{1}").': "pairs",
    ':- #count {{ U : use(U), motion(U,"{0}") }} > 1.': "sums",
    ":- #sum {{ N,U : use(U), inputs(U,N) }} > 4.": "sums",
    "p(L) :- use(U), output(U,O), label(O,L).\n:- #count {{ L : p(L) }} > 2.": "helpers",
    ":- available(O), available(P), O < P, not kitchen(O), not kitchen(P), state(O,S), state(P,S).": "far",
}


@pytest.mark.parametrize("part", [39, pytest.param(2, marks=pytest.mark.slow)])
def test_answers_under_random_shrinking_rules_of_the_users_own(
    part: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each has a certificate, whose claims clingo confirms, and the verifier refuses it without them."""
    monkeypatch.setattr("foon_asp.asp.assembly._is_own", lambda _: True)  # grounded in this process
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
        own = trusted(found.content)
        data = (problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices)
        verify(found.content, *data)
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
                verify(content, *data)
    if part == 2:
        assert met == {(kind, trusts) for kind in SHRINKING.values() for trusts in (False, True)}


def test_what_shrinking_rules_of_the_users_own_limit() -> None:
    """Of the two ways to the end, one is longer; with a limit on units that are cut, the other is taken."""
    one_of = ':- use(A), use(B), motion(A,"cut"), motion(B,"mix").'
    settings = Settings((given_constraint(one_of), given_constraint(NO_BOILING)))
    outcome, found = certify_outcome(solve(BOILED, settings=settings), settings)
    assert outcome.status is Status.INFEASIBLE
    assert found is not None
    own = trusted(found.content)
    assert own is not None
    assert (own["claims"], own["limits"]) == ([[[2], []]], [[{"1": [0, 1]}, 1]])
    few = Settings(
        (given_constraint(":- #sum { N,U : use(U), inputs(U,N) } > 1."), given_constraint(NO_BOILING))
    )
    outcome, found = certify_outcome(solve(BOILED, settings=few), few)
    assert found is not None
    own = trusted(found.content)
    assert own is not None
    assert (found.claim, own["limits"]) == ("infeasible", [[{"1": [0, 1, 2, 3, 4]}, 1]])


def own_limits(*given: str) -> OwnLimits:
    """Give what shrinking rules of the user's own limit, beside the covered ones."""
    settings = Settings(tuple(map(given_constraint, given)))
    covered = with_own_rules(coverage(settings), BOILED, settings)
    assert covered is not None
    assert covered.limits is not None
    return covered.limits


ONE_OF = ':- use(A), use(B), motion(A,"cut"), motion(B,"mix").'
WHERE_JUNK = ':- use(A), use(B), motion(A,"boil"), motion(B,"mix"), unit(U), motion(U,"junk").'
FEW_INPUTS = ":- #sum { N,U : use(U), inputs(U,N) } > 3."


def at_most(most: int, *units: int) -> Limit:
    """Give the limit that a tree has so many of some units at most."""
    return dict.fromkeys(units, Fraction(1)), Fraction(most)


ALL = range(5)


def test_limits_are_found_of_the_fewest_units_that_break_a_rule() -> None:
    limits = own_limits(ONE_OF)
    assert limits.known == []
    for kept in ({0}, {1, 2}, {0, 2, 3, 4}):
        assert limits.exceeded(frozenset(kept)) is None
    assert limits.known == []
    assert limits.exceeded(frozenset({0, 1, 2, 4})) == at_most(1, 0, 1)
    assert limits.known == [at_most(1, 0, 1)]


def test_one_rule_that_sees_what_is_not_in_a_tree_is_asked_with_it() -> None:
    limits = own_limits(ONE_OF, WHERE_JUNK)
    assert limits.exceeded(frozenset({1, 2})) == at_most(1, 1, 2)
    assert limits.exceeded(frozenset({0, 2})) is None


def test_sums_are_limited_and_what_is_asked_for_is_not() -> None:
    assert own_limits(FEW_INPUTS).known == [at_most(3, *ALL)]
    # what counts for nothing is left out, and so is a rule of which nobody knows that it is shrinking
    counted = ':- #sum { 1,U : use(U), motion(U,"cut"); 0,U : use(U), motion(U,"mix") } > 0.'
    assert own_limits(counted).known == [at_most(0, 0)]
    assert own_limits(":- #sum { 2*N-1,U : use(U), inputs(U,N) } > 3.").known == []
    assert own_limits(ONE_OF, JUNK, ':- #count { U : use(U), motion(U,"junk") } < 1.').known == []
    # without a shrinking rule, there is nothing to be found
    asking = own_limits(':- #count { U : use(U), motion(U,"junk") } < 1.')
    assert asking.exceeded(frozenset({0, 1})) is None
    assert asking.known == []


def test_limits_that_follow_from_ours_are_left_out() -> None:
    known: list[Limit] = [at_most(3, *ALL)]
    for most, left in ((2, []), (3, []), (4, known)):
        assert own_limits(FEW_INPUTS, f"at_most_units:max_units={most}").known == left
    # of the units, ours limits only one
    assert own_limits(FEW_INPUTS, "at_most_motion:limited_motion=cut,max_uses=1").known == known


def test_where_clingo_does_not_finish_nothing_is_said_to_keep_to_the_rules(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    limits = own_limits(ONE_OF)
    monkeypatch.setattr(Prepared, "run", lambda *_: Run())
    with pytest.raises(KeyboardInterrupt):
        limits.exceeded(frozenset({0}))
    monkeypatch.setattr(Prepared, "run", lambda *_: Run(exhausted=True))
    assert limits.exceeded(frozenset({0})) is None
    assert limits.known == []
    monkeypatch.setattr(Prepared, "run", lambda *_: Run())
    monkeypatch.setattr(Deadline, "passed", True)
    with pytest.raises(deadline.LimitError):
        limits.exceeded(frozenset({0}))


def test_clingo_says_what_limits_are_not_true() -> None:
    own = own_rule(NO_BOILING)
    assert own is not None
    none: dict[str, Any] = {"tree": None, "objective": []}
    check_with_clingo(none, {**own, "limits": [[{"1": [0, 1], "5": [2]}, 2]]}, BOILED)
    for limit in ([{"1": [0, 1]}, 1], [{"3": [0], "1": [4]}, 2]):
        with pytest.raises(RefusedError, match="what is taken on trust is not true"):
            check_with_clingo(none, {**own, "limits": [limit]}, BOILED)
    for limit in ([{str(2**31): [0]}, 1], [{"1": [0]}, -(2**31)]):
        with pytest.raises(LimitError, match="clingo cannot add up"):
            check_with_clingo(none, {**own, "limits": [limit]}, BOILED)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (':- use(A), use(B), motion(A,"twist"), motion(B,"crush").', "no tree has all of the units 26, 27"),
        (':- #count { U : use(U), motion(U,"crush") } > 0.', "no tree has one of the units 27"),
        (":- #count { U : use(U), unit(U) } > 1.", "no tree has more than 1 of 209 units"),
        (":- #sum { N,U : use(U), inputs(U,N) } > 5.", "units count comes to 5 at most"),
    ],
)
def test_limits_on_trust_are_said(cli: Cli, tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "proof.json"
    assert cli("certify", "--goal", "ice", "--rule", text, "-o", file).code in {0, 1}
    plain = cli("verify", file)
    assert said in plain.out
    assert cli("verify", file, "--with-clingo", "--format", "json").json["trusted"]["checked"] is True
