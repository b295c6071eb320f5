"""``foon-asp constraints --explain``: what rules do, for people and for programs."""

import re
from pathlib import Path

import pytest

from tests.conftest import Cli

EXPLAIN = ("constraints", "--explain")
_RARE = "rare(M) :- motion(_,M), #count { U : motion(U,M) } < 3."


@pytest.mark.parametrize(
    ("asked", "together"),
    [
        (("forbid_motion:forbidden_motion=fry",), "reduced"),
        (("at_most_units",), "reduced"),
        (("require_motion:required_motion=fry", "--explain", "forbid_motion"), "required"),
        (("at_most_units:max_units=3",), "cut"),
        (("require_intermediate", "-c", "required_intermediate=dough"), "required"),
        (("before", "--rule", ":- #count { U : use(U) } = 3."), "bounded"),
        (("--rule", f"{_RARE} :- not use(U) : motion(U,M), rare(M)."), "required"),
        (("--rule", ':- object(O), label(O,"ice"), not available(O).'), "plain"),
        (("at_most_units:max_units=3", "--rule", ":- use(U), use(V), input(U,O), input(W,O)."), "plain"),
    ],
)
def test_what_stays_of_the_reductions(cli: Cli, asked: tuple[str, ...], together: str) -> None:
    words = asked if asked[0] == "--rule" else ("--explain", *asked)
    said = cli("constraints", *words, "--format", "json")
    assert said.json["together"] == together
    text = " ".join(cli("constraints", *words).out.split())
    assert text.endswith(f"together: {said.json['meaning']}")


def test_a_rule_is_shown_as_written_with_its_place(cli: Cli, tmp_path: Path) -> None:
    mine = tmp_path / "mine.lp"
    mine.write_text('% mine\nseen(M) :- use(U),\n  motion(U,M).\n:- seen("fry"), not seen("rinse").\n')
    out = cli(*EXPLAIN, mine, "--rule", "{ seen(never) }.").out
    assert (
        out
        == f"""{mine}:2
    seen(M) :- use(U), motion(U,M).
  helper: other rules look at what it derives

{mine}:4
    :- seen("fry"), not seen("rinse").
  other: seen/1 is left open by a rule whose head is a
  choice (rule 1:1)
  local: it looks at nothing beyond the tree

rule 1:1
    {{ seen(never) }}.
  other: its head leaves a choice, or is negated
  local: it looks at nothing beyond the tree

together: bounds leave out what no better tree can have; the
  relevance cut does not hold, since a rule may ask for
  units that lead to no goal
"""
    )


def test_a_ready_made_constraint_is_shown_as_in_its_file(cli: Cli) -> None:
    asked = "before:earlier_motion=rinse,later_motion=chop"
    found = cli(*EXPLAIN, asked, "--format", "json").json["rules"]
    plain = cli(
        *EXPLAIN, "before", "-c", "earlier_motion=rinse", "-c", "later_motion=chop", "--format", "json"
    )
    assert [each["constraint"] for each in found] == [asked] * 4
    assert [each | {"constraint": None} for each in found] == plain.json["rules"]


def test_what_is_said_is_narrow(cli: Cli) -> None:
    rule = ":- use(U), motion(U,M), #count { V : motion(V,M) } < 2, risk(U,N), N > 3."
    lines = cli(*EXPLAIN, "require_ingredient", "--rule", rule).out.splitlines()
    # The place of a rule is a path and as long as that is.
    said = [line for line in lines if not re.search(r"\.lp:\d+$", line)]
    assert len(lines) - len(said) == 3
    assert max(map(len, said)) <= 60


def test_a_constant_of_nothing_is_refused(cli: Cli) -> None:
    ran = cli("constraints", "-c", "max_units=3")
    assert ran.code == 2
    assert "name that with --explain" in ran.err


def test_a_faulty_rule_is_refused(cli: Cli) -> None:
    ran = cli(*EXPLAIN, "before", "--rule", ":- use(U), available(O) :- input(U,O).")
    assert ran.code == 2
    assert "rule 1:1" in ran.err
