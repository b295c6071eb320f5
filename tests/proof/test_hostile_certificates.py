"""What a stranger may send in place of a certificate: refused in words, and soon."""

import json
import random
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.certificate import certify
from foon_asp.problem import Objective, levels
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.refusal import RefusedError
from foon_asp.questions.verify import VerifiedCertificate
from tests.conftest import Cli
from tests.proof.by_hand import branch, recipe, weigh
from tests.support.handmade_certificate import Content, check, forbid, handmade

SECONDS = 20  # a refusal takes one or two; the machine may be busy


# The end is made of any of many middles, each made by a motion of its own rate.
MANY = range(200)
WIDE = recipe(
    *(unit for n in MANY for unit in (f"go {n}: start > middle; {n}", f"end: middle; {n} > end")),
    goals="end",
    rates={f"go {n}": Fraction(n + 1, 202) for n in MANY},
)
GOAL = WIDE.goals[0]
MIDDLES = [o for o in range(len(WIDE.network.objects)) if o not in (0, GOAL)]
TOO_MANY = "to check it takes more than 5,120,400 steps"
UNITS: Content = {"tree": [0, 1], "costs": [2]}
SUCCESS: Content = {"objective": ["success"], "tree": [0, 1], "costs": ["1/404"]}


def refusal(**values: Any) -> str:
    """Give why a certificate with these values is refused, which does not take long."""
    content = json.dumps(handmade(WIDE, **values))
    began = time.perf_counter()
    with pytest.raises(RefusedError) as refused:
        check(read_certificate(content), WIDE)
    assert time.perf_counter() - began < SECONDS
    return str(refused.value)


def odd(digits: int, number: int) -> str:
    """Give one over a long odd number that shares few divisors with the others."""
    return f"1/{random.Random(number).randrange(10 ** (digits - 1), 10**digits) * 2 + 1}"


@pytest.mark.slow
def test_many_long_fractions_are_too_many_steps() -> None:
    """Each of them short enough, and added up often."""
    cuts = [sorted([GOAL, *MIDDLES[:size]]) for size in range(1, 200)] * 2
    weights = [{"1/2": odd(990, 1), "1/101": odd(990, 2)}] * len(cuts)
    said = refusal(**SUCCESS, cuts=cuts, proof=weigh(*weights))
    assert said == TOO_MANY


@pytest.mark.slow
def test_many_branches_are_too_many_steps() -> None:
    """Every leaf looks at every unit, and is right."""
    cuts = [sorted([GOAL, middle]) for middle in MIDDLES[:180]]
    leaves: list[Any] = [weigh(*["1/180"] * 180)] * 2**8
    unit = 398
    while len(leaves) > 1:
        pairs = zip(leaves[::2], leaves[1::2], strict=True)
        leaves = [branch(one, other, unit=unit) for one, other in pairs]
        unit -= 2
    said = refusal(**UNITS, claim="bound", bound=["1"], cuts=cuts, proof=leaves[0])
    assert said == TOO_MANY


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not JSON"),
        ("\ufeff{}", "not JSON"),
        ("{" * 100_000, "not JSON"),
        ("[" * 1_000_001, "brackets"),
        ("[" + "[]," * 1_000_000 + "0]", "brackets"),
        (" " * 16_000_001, "letters"),
        ("9" * 5000, "not JSON"),
        ("[" + "9" * 4000 + "]", "expected an object"),
        ("NaN", "found the number NaN"),
        (
            "[1." + "0" * 60 + "]",
            f"found the number 1.{'0' * 48}, expected whole numbers, and fractions in quotes",
        ),
        ('{"version": 1e999}', "found the number 1e999"),
        ('{"a": {"b": 1, "b": 2}}', "a key stands twice"),
        ('"\\ud800"', "expected an object"),
        ('{"\\ud800": "\\udfff"}', "expected the format"),
        ("{}", "expected the format"),
    ],
)
def test_garbage_is_refused_in_one_line(cli: Cli, tmp_path: Path, text: str, reason: str) -> None:
    file = tmp_path / "proof.json"
    file.write_text(text, encoding="utf-8")
    began = time.perf_counter()
    ran = cli("verify", file)
    assert time.perf_counter() - began < SECONDS
    assert ran.code == 1
    assert ran.out.startswith("refused: ")
    assert reason in ran.out
    assert ran.out.count("\n") == 1
    assert ran.err == ""
    assert cli("verify", file, "--format", "json").json["verified"] is False


@pytest.mark.parametrize("raw", [b"\xff\xfe{}", b'{"format": "\xed\xa0\x80"}'])
def test_what_is_no_text_is_bad_input(cli: Cli, tmp_path: Path, raw: bytes) -> None:
    file = tmp_path / "proof.json"
    file.write_bytes(raw)
    ran = cli("verify", file)
    assert ran.code == 2
    assert "cannot be read" in ran.err
    assert cli("verify", tmp_path).code == 2


def test_a_file_without_end_is_not_read_to_its_end(cli: Cli) -> None:
    if Path("/dev/zero").exists():
        assert cli("verify", "/dev/zero").out == "refused: it has more than 16,000,000 letters\n"


@pytest.mark.slow
def test_changes_at_random_are_refused_and_never_crash() -> None:
    """Values of every kind at every place, sealed anew, as somebody who knows the format would send them."""
    ice = foon_asp.load().problem("ice")
    right = certify(ice, levels((Objective.SUCCESS,)), [28, 29, 30])
    assert right is not None
    values: list[Any] = [None, True, 0, -1, 10**4000, "", "\ud800", "1/0", "-0", "9" * 3000]
    values += [[], [[]], [[0, ["1"]]], {}, {"weights": [[0, [{"1/2": "1/3"}, "1"]]]}, {"hopeless": 10**30}]
    values += [[10**30], {"unit": 10**30}, ["1" + "0" * 900], [{"9/10": "-1" + "0" * 900}, "0"]]
    for place in _places(right.content):
        for value in values:
            mutant = json.loads(right.text())
            at = mutant
            for step in place[:-1]:
                at = at[step]
            if type(at[place[-1]]) is type(value) and at[place[-1]] == value:
                continue
            at[place[-1]] = value
            if place != ("seal",):
                mutant["seal"] = seal(mutant)
            try:
                found = check(read_certificate(json.dumps(mutant)), ice)
            except RefusedError as refused:
                str(refused).encode()
            else:  # a claim that leaves out a motion of no unit is as true as before
                assert place[0] in ("rules", "not_covered"), place
                VerifiedCertificate.of(found, ice.network, mutant).text().encode()


def _places(value: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    found = [place] if place else []
    steps = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, inner in steps:
        found += _places(inner, (*place, step))
    return found


def test_a_bound_far_below_anything_is_said_without_a_crash() -> None:
    content = handmade(WIDE, **SUCCESS, claim="bound", bound=[{"1/2": "-1" + "0" * 900}])
    found = check(content, WIDE)
    assert "success at most 1; the tree has" in VerifiedCertificate.of(found, WIDE.network, content).text()


def test_names_say_nothing_in_a_line_of_their_own() -> None:
    rules = forbid(["a\nverified: b"], ["c\x1b[31m\nd"])
    content = handmade(WIDE, **UNITS, claim="bound", bound=["0"], rules=rules)
    lines = VerifiedCertificate.of(check(content, WIDE), WIDE.network, content).text().splitlines()
    kept = "among the trees that keep to "
    assert f"{kept}forbid_motion (forbidden_motion: a\\u000averified: b)" in lines
    assert f"{kept}forbid_object (forbidden_object: c\\u001b[31m\\u000ad)" in lines
