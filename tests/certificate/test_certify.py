"""What is certified of small problems, as far as it can be, and what is said where answers contradict it."""

import time
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Outcome, Proof, Settings, Status
from foon_asp.certificate import (
    Certificate,
    Coverage,
    NotBestError,
    certify,
    certify_infeasible,
    certify_outcome,
)
from foon_asp.errors import BugError
from foon_asp.hypergraph.proof_tree import Packing
from foon_asp.problem import Objective, Problem
from foon_asp.proof.certificate_header import seal
from tests.proof.by_hand import recipe
from tests.support.gap_problem import gap_problem
from tests.support.handmade_certificate import forbid

UNITS, INPUTS, INGREDIENTS, SUCCESS, KITCHEN, *_ = Objective
POUR, MIX, BAKE = range(3)


def small(**rates: str) -> Problem:
    """Pour the end of a start and salt; or mix a middle of the two, and bake the end of it."""
    known = {"mix": "3/4", "bake": "9/10", **rates}
    units = ("pour: start + salt > end", "mix: start > middle", "bake: middle > end")
    return recipe(*units, kitchen="start + salt", rates=known)


SMALL = small()
START, SALT, END, MIDDLE = range(4)
TINY = f"1/{10**2000 + 1}"


def found(certificate: Certificate | None) -> Certificate:
    assert certificate is not None
    return certificate


# --- the text


@pytest.mark.parametrize(
    ("content", "lines"),
    [
        (
            {"claim": "bound", "costs": [1, "2/3"], "cuts": [[1, 2], [3]], "proof": {"hopeless": 0}},
            [
                *("{", ' "claim": "bound",', ' "costs": [1, "2/3"],'),
                *(' "cuts": [', "  [1, 2],", "  [3]", " ],", ' "proof": {"hopeless": 0}', "}"),
            ],
        ),
        (
            {"rules": {"weights": [1]}, "proof": {"weights": [[0, ["1"]], [1, [{"1/2": "1"}]]]}},
            [
                *("{", ' "rules": {"weights": [1]},', ' "proof": {"weights": ['),
                *('  [0, ["1"]],', '  [1, [{"1/2": "1"}]]', " ]}", "}"),
            ],
        ),
        ({"goals": [{"node": "p\u00e2t\u00e9"}]}, ["{", ' "goals": [{"node": "p\u00e2t\u00e9"}]', "}"]),
    ],
)
def test_text_has_a_line_for_each_cut_and_weight(content: dict[str, Any], lines: list[str]) -> None:
    assert Certificate(content, "bound", ()).text() == "\n".join(lines) + "\n"


# --- how far a certificate goes


def test_all_objectives_are_certified_where_they_can_be() -> None:
    certificate = found(certify(SMALL, (INPUTS, UNITS), [POUR]))
    assert (certificate.claim, certificate.certified) == ("optimal", (INPUTS, UNITS))
    assert (certificate.content["costs"], certificate.content["bound"]) == ([2, 1], None)
    assert found(certify(SMALL, (SUCCESS,), [MIX, BAKE])).content["costs"] == ["27/40"]
    assert found(certify(SMALL, (KITCHEN,), [MIX, BAKE])).content["costs"] == [1]


@pytest.mark.parametrize("digits", [1980, 2100])
def test_as_many_of_the_first_objectives_as_can_be_written(digits: int) -> None:
    """A product of 3,960 digits is more than the verifier takes, one of 4,200 more than Python writes."""
    tiny = f"1/{10**digits + 1}"
    problem = replace(small(bake=tiny, mix=tiny), kitchen=frozenset({START}))
    whole = (UNITS, INPUTS, SUCCESS, KITCHEN)
    certificate = found(certify(problem, whole, [MIX, BAKE]))
    assert (certificate.claim, certificate.certified) == ("optimal", (UNITS, INPUTS))
    first = found(certify(problem, (UNITS, SUCCESS), [MIX, BAKE]))
    assert (first.claim, first.certified) == ("optimal", (UNITS,))
    assert certify(problem, (SUCCESS, UNITS), [MIX, BAKE]) is None


def test_a_better_tree_is_named() -> None:
    for objectives, worse, better in (
        ((UNITS,), [MIX, BAKE], {POUR}),
        ((SUCCESS, UNITS), [POUR], {MIX, BAKE}),
        ((KITCHEN, UNITS), [POUR], {MIX, BAKE}),  # of which no taking of items is a part
        ((INPUTS, KITCHEN), [POUR], {MIX, BAKE}),
    ):
        with pytest.raises(NotBestError) as raised:
            certify(SMALL, objectives, worse)
        assert set(raised.value.units) == better
        assert raised.value.costs == SMALL.costs(better)
        assert str(raised.value) == "the tree is not the best: another one costs less"


def test_among_trees_that_keep_to_other_rules_only_a_bound_is_proved() -> None:
    """Such a rule may forbid the better tree, which is the best one by all objectives at once."""
    rules = Coverage(not_covered=("mine.lp",))
    for objectives, units, bound in (
        ((UNITS,), [MIX, BAKE], ["1"]),
        ((INPUTS, UNITS), [MIX, BAKE], ["2", "1"]),
        ((INPUTS, KITCHEN), [POUR], ["2", "1"]),
        ((SUCCESS,), [POUR], [{"3/4": "1", "9/10": "1"}]),
    ):
        certificate = found(certify(SMALL, objectives, units, rules))
        assert (certificate.claim, certificate.certified) == ("bound", objectives)
        assert (certificate.content["bound"], certificate.content["tree"]) == (bound, units)
        assert certificate.content["not_covered"] == ["mine.lp"]
    best = found(certify(SMALL, (UNITS,), [POUR], rules))
    assert (best.claim, best.content["bound"]) == ("optimal", None)


def test_rates_of_units_of_their_own_are_not_certified() -> None:
    own = replace(SMALL, own_rates={POUR: Fraction(1)})
    assert certify(own, (SUCCESS,), [POUR]) is None
    assert found(certify(own, (UNITS,), [POUR])).claim == "optimal"
    assert certify(small(bake="0"), (UNITS, SUCCESS), [POUR]) is None
    without = replace(SMALL, rates=None)
    assert found(certify(without, (UNITS, KITCHEN), [POUR])).claim == "optimal"


def test_when_time_is_over_only_what_is_known_is_proved() -> None:
    """The cut that is given proves the units; for the inputs, another one would have to be found."""

    def certified(objectives: tuple[Objective, ...], expired: bool) -> object:
        certificate = certify(SMALL, objectives, [POUR], expired=lambda: expired, cuts=[[END]])
        return certificate and (certificate.claim, certificate.certified)

    assert certified((UNITS,), expired=True) == ("optimal", (UNITS,))
    assert certified((UNITS, INPUTS), expired=True) is None  # nothing else is begun then
    assert certified((UNITS, INPUTS), expired=False) == ("optimal", (UNITS, INPUTS))


def test_where_costs_are_whole_bounds_are() -> None:
    problem = gap_problem(0, 3)
    with pytest.raises(NotBestError) as raised:
        certify(problem, (UNITS,), range(len(problem.network)))
    best = raised.value.units
    proof = found(certify(problem, (UNITS,), best)).content["proof"]
    assert set(proof) == {"weights", "multiples"}
    assert proof["multiples"] == {"units": "1"}
    assert sum(Fraction(weight) for _, (weight,) in proof["weights"]) == len(best) - Fraction(1, 2)
    # under a rule that is not covered, the bound is rounded up as well
    worse = found(certify(problem, (UNITS,), range(len(problem.network)), Coverage(not_covered=("mine.lp",))))
    assert (worse.claim, worse.content["bound"]) == ("bound", [str(len(best))])


def test_no_tree() -> None:
    problem = replace(SMALL, kitchen=frozenset({SALT}))
    certificate = found(certify_infeasible(problem))
    assert (certificate.claim, certificate.certified) == ("infeasible", ())
    assert certificate.content["proof"] == {"hopeless": 0}
    assert [certificate.content[key] for key in ("objective", "tree", "costs", "bound")] == [[], *[None] * 3]
    (cut,) = certificate.content["cuts"]
    assert END in cut
    assert SALT not in cut
    assert certify_infeasible(SMALL) is None
    forbidden = found(certify_infeasible(SMALL, Coverage(tuple(forbid(["bake"], ["salt"])))))
    assert forbidden.content["cuts"] == [[END]]


def test_a_certificate_that_is_refused_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("foon_asp.certificate.certificate.Prover.prove", lambda *_: Packing(()))
    with pytest.raises(BugError) as bug:
        certify(SMALL, (UNITS,), [POUR])
    assert str(bug.value) == "a certificate that was found is refused: the weights do not add up to enough"


# --- answers


def outcome(
    problem: Problem,
    units: tuple[int, ...] | None,
    *objectives: Objective,
    status: Status = Status.OPTIMAL,
) -> Outcome:
    costs = None if units is None else problem.costs(units)
    return Outcome(problem, objectives or (UNITS,), status, units, costs, {}, {}, proof=Proof.SOLVER)


def test_an_answer_is_marked_with_its_certificate() -> None:
    answer = outcome(SMALL, (POUR,), INPUTS)
    began = time.perf_counter()
    marked, certificate = certify_outcome(answer, Settings())
    taken = time.perf_counter() - began
    assert 0 < marked.seconds["certificate"] <= taken
    assert found(certificate).certified == marked.certified == (INPUTS, UNITS)
    assert (marked.proof, marked.units) == (Proof.CERTIFICATE, (POUR,))


def test_an_answer_that_is_certified_in_part_keeps_its_proof() -> None:
    problem = replace(small(bake=TINY, mix=TINY), kitchen=frozenset({START}))
    marked, certificate = certify_outcome(outcome(problem, (MIX, BAKE), UNITS, SUCCESS), Settings())
    assert found(certificate).certified == marked.certified == (UNITS,)
    assert marked.proof is Proof.SOLVER


def test_no_tree_is_certified_whatever_the_objectives() -> None:
    problem = replace(SMALL, kitchen=frozenset({SALT}))
    answer = outcome(problem, None, INPUTS, status=Status.INFEASIBLE)
    marked, certificate = certify_outcome(answer, Settings())
    assert (marked.proof, marked.certified) == (Proof.CERTIFICATE, ())
    assert found(certificate).claim == "infeasible"


def test_nothing_is_looked_for_where_nothing_is_claimed() -> None:
    for status, units in ((Status.FEASIBLE, (POUR,)), (Status.UNKNOWN, None)):
        answer = outcome(SMALL, units, status=status)
        assert certify_outcome(answer, Settings()) == (answer, None)
        assert answer.seconds["certificate"] >= 0


def test_cuts_of_an_answer_are_tried_first() -> None:
    answer = outcome(SMALL, (POUR,))._replace(cuts=((END,),))
    _, certificate = certify_outcome(answer, Settings(), expired=lambda: True)
    assert found(certificate).content["cuts"] == [[END]]
    assert certify_outcome(outcome(SMALL, (POUR,)), Settings(), expired=lambda: True)[1] is None


# --- contradictions

ASKED = """
goals: end
containers: strict, level 3
objectives: {objectives}
network: 3 units, 4 object nodes
kitchen: 2 items"""
BOTH = "2 units, 2 inputs, 0 ingredients, 1 kitchen items"
POURED = (
    "the answer is optimal, the units [0] (1 units, 2 inputs, 0 ingredients, 2 kitchen items, success 1/2)"
)


def changed(objectives: tuple[Objective, ...], **values: Any) -> Certificate:
    """Return a certificate that says something else, and was never verified."""
    right = found(certify(SMALL, objectives, [MIX, BAKE] if objectives == (SUCCESS,) else [POUR]))
    content = {**right.content, **values}
    return Certificate(content, content["claim"], right.certified)


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> Callable[..., str]:
    """Return what is said where an answer has a certificate; nothing where both can be true."""

    def ask(answer: Outcome, certificate: Certificate, settings: Settings | None = None) -> str:
        for finder in ("certify", "certify_infeasible"):
            monkeypatch.setattr(f"foon_asp.certificate.certified_outcome.{finder}", lambda *_: certificate)
        try:
            assert certify_outcome(answer, settings or Settings()) == (answer, certificate)
        except BugError as bug:
            return str(bug)
        return ""

    return ask


def test_a_better_tree_than_the_answer_is_a_bug() -> None:
    settings = Settings((Path("forbid_motion"), Path("forbid_object")), constants=("forbidden_motion=dig",))
    with pytest.raises(BugError) as bug:
        certify_outcome(outcome(SMALL, (MIX, BAKE)), settings)
    assert str(bug.value) == (
        f"the answer is optimal, the units [1, 2] ({BOTH}, success 27/40), but there is a better tree, the "
        "units [0] (1 units, 2 inputs, 0 ingredients, 2 kitchen items, success 1/2)"
        + ASKED.format(objectives="units")
        + "\nconstraint: forbid_motion\nconstraint: forbid_object\nconstant: forbidden_motion=dig"
    )


SPEAKS = "the certificate speaks of the goals"


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"goals": [{"id": 3, "node": "middle"}]}, f"{SPEAKS} [3] under strict containers"),
        ({"containers": "implied"}, f"{SPEAKS} [2] under implied containers"),
        ({"claim": "infeasible"}, "the certificate proves that there is no tree"),
        (
            {"tree": [MIX, BAKE]},
            f"the certificate proves another tree optimal, the units [1, 2] ({BOTH}, success 27/40)",
        ),
        *(
            ({"bound": bound}, f"the certificate proves the bound {bound}, and the tree costs less")
            for bound in (["1", "3"], ["3/2", "-9"])
        ),
        *(({"bound": bound}, "") for bound in (["1", "2"], ["1", "1"], ["1/2", "70"], ["0", "2"])),
    ],
)
def test_what_a_certificate_says_against_a_tree(
    said: Callable[..., str], values: dict[str, Any], why: str
) -> None:
    claim = {"claim": "bound"} if "bound" in values else {}
    told = said(outcome(SMALL, (POUR,), UNITS, INPUTS), changed((UNITS, INPUTS), **claim, **values))
    assert told == (f"{POURED}, but {why}" + ASKED.format(objectives="units, inputs") if why else "")


def test_what_a_certificate_says_of_products(said: Callable[..., str]) -> None:
    """27/40 is the success of the tree: 3/4 and 9/10, and as much as that is no contradiction."""
    much: list[dict[str, str]] = [{"1/2": "1"}, {"3/4": "1", "9/10": "2"}, {"3/4": "2"}]
    right: list[dict[str, str]] = [{"3/4": "1", "9/10": "1"}, {"3/4": "1"}, {}, {"1/2": "-5", "3/4": "2"}]
    for part in (*much, *right):
        certificate = changed((SUCCESS,), claim="bound", bound=[part])
        told = said(outcome(SMALL, (MIX, BAKE), SUCCESS), certificate)
        assert ("and the tree costs less" in told) == (part in much)
        assert (told == "") == (part in right)


def test_what_a_certificate_says_against_no_tree(said: Callable[..., str]) -> None:
    answer = outcome(SMALL, None, status=Status.INFEASIBLE)
    assert said(answer, changed((UNITS,)), Settings(encodings=Path("by_need"))) == (
        "the answer is infeasible, no tree, but the certificate claims optimal"
        + ASKED.format(objectives="units")
        + "\nencodings: by_need"
    )


@pytest.mark.parametrize(
    ("rates", "success"),
    [
        (None, ""),
        (("1", "1"), ", success 1"),
        ((f"1/{2**12998}", "1/3"), f", success 1/{2**12998 * 3}"),  # 13,000 bits
        ((f"1/{2**12999}", "1/3"), ", success of too many digits to print"),
    ],
)
def test_costs_are_said_as_far_as_they_can_be_printed(
    said: Callable[..., str], rates: tuple[str, str] | None, success: str
) -> None:
    problem = replace(SMALL, rates=None) if rates is None else small(mix=rates[0], bake=rates[1])
    told = said(outcome(problem, (MIX, BAKE)), changed((UNITS,), claim="infeasible"))
    assert f"[1, 2] ({BOTH}{success}), but" in told


def test_a_certificate_holds_to_the_format_of_the_verifier() -> None:
    content = found(certify(SMALL, (UNITS,), [POUR])).content
    assert content["seal"] == seal(content)
    assert list(content) == [
        *("format", "version", "claim", "goals", "containers", "level", "objective", "digests"),
        *("rules", "measures", "not_covered", "tree", "costs", "bound", "cuts", "proof", "seal"),
    ]
    assert content["proof"] == {"weights": [[0, ["1"]]]}
    assert (content["tree"], content["costs"], content["cuts"]) == ([POUR], [1], [[END, MIDDLE]])
