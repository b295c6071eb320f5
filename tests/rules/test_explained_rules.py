"""``foon-asp constraints --explain``: what rules do, for people and for programs."""

from pathlib import Path
from typing import Any

import pytest

from foon_asp.rules.constraint_library import LibraryConstraint, library_constraints
from tests.conftest import Cli

EXPLAIN = ("constraints", "--explain")
LOCAL, FAR = True, False
FACT, DELETING, SHRINKING = "fact", "deleting", "shrinking"
REQUIRING, OTHER, HELPER = "requiring", "other", "helper"

# Rules with what is said of the last one of each: its kind, and whether it sees no further than the tree.
WRITTEN: list[tuple[str, str, bool]] = [
    # deleting
    (':- use(U), motion(U,"fry").', DELETING, LOCAL),
    (":- use(17).", DELETING, LOCAL),
    (':- times(U,N), N > 0, motion(U,"fry").', DELETING, LOCAL),
    (":- #sum { N,U : times(U,N) } > 3.", SHRINKING, LOCAL),
    (":- not times(U,1) : inputs(U,3).", REQUIRING, LOCAL),
    (":- use(U), #count { O : input(U,O) } > 3.", DELETING, LOCAL),
    (":- use(U), inputs(U,N), N+1 > 3.", SHRINKING, LOCAL),
    (":- use(U), rate(U,1..5).", SHRINKING, LOCAL),
    ('bad("fry"). bad("bake"). :- use(U), motion(U,M), bad(M).', DELETING, LOCAL),
    ("done(U) :- use(U), motion(U,M), hot(M). hot(fry). :- done(U), inputs(U,3).", DELETING, LOCAL),
    (":- available(O), goal(O), label(O,L), utensil(L).", DELETING, LOCAL),
    ("#const most = 3. :- use(U), inputs(U,N), N > most.", DELETING, LOCAL),
    (":- use(U), motion(U,M), #count { V : motion(V,M) } < 2.", SHRINKING, FAR),
    (":- use(U), input(U,O), input(V,O), U != V.", SHRINKING, FAR),
    (":- use(U), input(U,O), located(O,_,L), utensil(L).", SHRINKING, FAR),
    ('other(U) :- motion(V,M), motion(U,M), V != U. :- use(U), not other(U).', SHRINKING, FAR),
    (':- available(O), label(O,"soup").', SHRINKING, FAR),
    ('nut(L) :- label(_,L), ingredient(_,L). :- use(U), input(U,O), label(O,L), nut(L).', SHRINKING, FAR),
    # facts
    (':- goal(O), label(O,"soup").', FACT, LOCAL),
    ("limit(3). :- limit(N), N > 2.", FACT, LOCAL),
    # by what a condition in it depends on
    (":- kitchen(O) : available(O), object(O).", REQUIRING, FAR),
    (':- motion(U,"bake") : use(U).', REQUIRING, LOCAL),
    (":- use(V) : available(O), needs(V,O).", OTHER, FAR),
    (":- use(V), not use(U) : use(U), inputs(U,2).", OTHER, LOCAL),
    ("p(O) :- object(O), kitchen(X) : p(X). :- goal(O), p(O).", OTHER, FAR),
    (":- inputs(U,3) : use(U), risk(U,5).", OTHER, FAR),
    ('#const off = "". :- off != "", use(U).', FACT, LOCAL),
    (":- #count { U : unit(U) } > 5.", FACT, FAR),
    (":- kitchen(O), label(O,L), utensil(L).", FACT, FAR),
    ("one :- not missing. :- one, #true.", FACT, LOCAL),
    (":- use(U), 3 > 2 > 4.", FACT, LOCAL),
    # shrinking
    (':- use(U), motion(U,"fry"), use(V), motion(V,"bake").', SHRINKING, LOCAL),
    (":- not #count { U : use(U) } <= 3.", SHRINKING, LOCAL),
    (":- 3 { use(U) : motion(U,M) }.", SHRINKING, LOCAL),
    (":- #sum { N,U : use(U), inputs(U,N) } > 20.", SHRINKING, LOCAL),
    (":- #sum+ { N-2,U : use(U), inputs(U,N), N > 1 } > 2.", SHRINKING, LOCAL),
    (":- #sum { N*M,U : times(U,M), inputs(U,N) } > 20.", SHRINKING, LOCAL),
    (":- #max { N : use(U), inputs(U,N) } > 3, #min { N : use(U), inputs(U,N) } < 2.", SHRINKING, LOCAL),
    ('pays("fry",3). :- #sum { P,U : use(U), motion(U,M), pays(M,P) } > 9.', SHRINKING, LOCAL),
    ("most(3). :- most(N), #count { U : use(U) } > N.", SHRINKING, LOCAL),
    ("reached(O) :- goal(O). reached(O) :- use(U), reached(P), gives(U,P), needs(U,O). :- reached(O), "
     "located(O,W,L), use(V), motion(V,L).", SHRINKING, LOCAL),
    (":- not not use(U), use(U).", SHRINKING, LOCAL),
    (':- use(U) : motion(U,"fry").', SHRINKING, FAR),
    (":- available(O) : label(O,L), utensil(L).", SHRINKING, FAR),
    # requiring
    (':- not use(U) : motion(U,"bake").', REQUIRING, LOCAL),
    ('hot :- use(U), output(U,O), state(O,"hot"). :- not hot.', REQUIRING, LOCAL),
    (':- #count { U : use(U), motion(U,"bake") } < 1.', REQUIRING, LOCAL),
    (':- #count { U : use(U), motion(U,"bake") } = 0.', REQUIRING, LOCAL),
    (":- #count { U : use(U) } < 3.", REQUIRING, LOCAL),
    (':- goal(O), label(O,L), not has(L). has(L) :- use(U), input(U,O), label(O,L).', REQUIRING, LOCAL),
    (':- object(O), label(O,"soup"), not available(O).', REQUIRING, FAR),
    (':- motion(U,"fry"), not use(U).', REQUIRING, FAR),
    # other
    (":- #sum { -1,U : use(U) } < -3.", OTHER, LOCAL),
    (":- #sum { N-2,U : use(U), inputs(U,N) } > 3.", OTHER, LOCAL),
    (":- #sum { N*I,U : use(U), inputs(U,N), ingredients(U,I) } > 3.", OTHER, LOCAL),
    (":- #sum { M*(-1),U : times(U,M) } < -3.", OTHER, LOCAL),
    ('pays("a",-3). :- #sum { P,U : use(U), motion(U,M), pays(M,P) } > 9.', OTHER, LOCAL),
    (":- #count { U : use(U) } = 3.", OTHER, LOCAL),
    (":- 2 <= #count { U : use(U) } <= 4.", OTHER, LOCAL),
    (":- N = #count { U : use(U) }, N > 3.", OTHER, LOCAL),
    ("number(N) :- N = #count { U : use(U) }. :- number(N), N > 3.", OTHER, LOCAL),
    (':- use(U), motion(U,"fry"), not use(V) : motion(V,"rinse").', OTHER, LOCAL),
    ("knife :- use(1). rinsed :- use(2). :- knife, not rinsed.", OTHER, LOCAL),
    ("{ mark(U) } :- use(U). :- mark(U), inputs(U,2).", OTHER, LOCAL),
    ("{ mark(U) : motion(U,_) }. :- mark(U), use(U).", OTHER, FAR),
    ("mark(U) ; spare(U) :- use(U). :- mark(U), inputs(U,2).", OTHER, LOCAL),
    ("not mark(U) :- use(U).", OTHER, LOCAL),
    ("p :- not q. q :- not p. :- p, use(U).", OTHER, LOCAL),
    ("p :- not p, use(U).", OTHER, LOCAL),
    ("p :- not not p. :- p.", OTHER, LOCAL),
    ("p :- #count { 1 : p } > 0. :- p.", OTHER, LOCAL),
    ("odd(O) :- label(O,L), not odd(O). :- use(U), input(U,O), odd(O).", OTHER, FAR),
    ("-hot(U) :- use(U).", OTHER, FAR),
    (":- use(U), -hot(U).", OTHER, FAR),
    (":- use(U), risk(U,N), N > 5.", OTHER, FAR),
    (":- use(U), cost(price,U,N), N > 5.", OTHER, FAR),
    (":- optimize(units,P).", OTHER, FAR),
    (":- _by_person(U), use(U).", OTHER, FAR),
    # helpers
    ("many(N) :- N = #count { U : unit(U) }.", HELPER, LOCAL),
    ('bad("fry").', HELPER, LOCAL),
    # constants that override others, or stand for them, are not known
    ('#const a = b. #const b = "". :- a != "", use(U), use(V).', SHRINKING, LOCAL),
    ('#const a = "". #const a = "". :- a != "", use(U), use(V).', SHRINKING, LOCAL),
    ('#const a = "". :- a != "", use(U), use(V).', FACT, LOCAL),
]  # fmt: skip
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
        (("--rule", f"{_RARE} :- not use(U) : motion(U,M), rare(M)."), "plain"),
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
  other: seen/1 is left open by a rule whose head is a choice (rule 1:1)
  local: it looks at nothing beyond the tree

rule 1:1
    {{ seen(never) }}.
  other: its head leaves a choice, or is negated
  local: it looks at nothing beyond the tree

together: bounds leave out what no better tree can have; the relevance cut does not hold, since a rule \
may ask for units that lead to no goal
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


def test_a_constant_of_nothing_is_refused(cli: Cli) -> None:
    ran = cli("constraints", "-c", "max_units=3")
    assert ran.code == 2
    assert "name that with --explain" in ran.err


def test_a_faulty_rule_is_refused(cli: Cli) -> None:
    ran = cli(*EXPLAIN, "before", "--rule", ":- use(U), available(O) :- input(U,O).")
    assert ran.code == 2
    assert "rule 1:1" in ran.err


def told(cli: Cli, *words: str) -> list[dict[str, Any]]:
    """Explain rules; gives what is said of those that are no helpers, or of all where all are."""
    rules: list[dict[str, Any]] = cli("constraints", *words, "--format", "json").json["rules"]
    return [each for each in rules if each["kind"] != HELPER] or rules


@pytest.mark.parametrize(("text", "kind", "local"), WRITTEN)
def test_kinds_of_rules(text: str, kind: str, local: bool, cli: Cli) -> None:
    rule = told(cli, "--rule", text)[-1]
    assert (rule["kind"], rule["local"]) == (kind, local)
    assert (rule["reason"] is not None) >= (kind == OTHER)
    assert (rule["looks_beyond"] is None) == local


@pytest.mark.parametrize("constraint", library_constraints(), ids=lambda constraint: constraint.name)
def test_all_is_known_of_ready_made_constraints(constraint: LibraryConstraint, cli: Cli) -> None:
    """They look at nothing beyond the tree, and without their constants most say nothing."""
    values = ",".join(f"{each.name}={each.example}" for each in constraint.parameters)
    rules = told(cli, "--explain", f"{constraint.name}:{values}")
    assert all(rule["local"] and rule["kind"] in {FACT, DELETING, SHRINKING, REQUIRING} for rule in rules)
    asks = constraint.name.startswith("require_")
    assert [rule["one_of_a_set"] for rule in rules] == [asks] * len(rules)
    plain = told(cli, "--explain", constraint.name)
    assert {rule["kind"] for rule in plain} <= {FACT, *(rule["kind"] for rule in rules)} - {REQUIRING}
