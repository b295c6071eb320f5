"""What is claimed of rules: their kinds, and how far they see."""

from pathlib import Path

import pytest

from foon_asp.asp import Settings
from foon_asp.asp.assembly import assemble
from foon_asp.encoding.encoding import PUBLIC, read_encoding
from foon_asp.encoding.facts import FACT_PREDICATES
from foon_asp.grounding.stated import Loaded, Stated
from foon_asp.rules.constraint import RuleText
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.rules.fact_subject import SUBJECTS
from foon_asp.rules.rule_kind import Analysis, Kind, Rule

LOCAL, FAR = True, False

# Every ready-made constraint: what its constraints are with constants that are set, and without.
LIBRARY = {
    "at_least_videos": ([Kind.DELETING], [Kind.FACT]),
    "at_most_motion": ([Kind.SHRINKING], [Kind.FACT]),
    "at_most_price": ([Kind.SHRINKING, Kind.DELETING], [Kind.FACT, Kind.FACT]),
    "at_most_units": ([Kind.SHRINKING], [Kind.FACT]),
    "at_most_utensil_uses": ([Kind.SHRINKING], [Kind.FACT]),
    "at_most_utensils": ([Kind.SHRINKING], [Kind.FACT]),
    "before": ([Kind.SHRINKING], [Kind.FACT]),
    "forbid_ingredient": ([Kind.DELETING, Kind.DELETING, Kind.FACT],) * 2,
    "forbid_motion": ([Kind.DELETING],) * 2,
    "forbid_object": ([Kind.DELETING, Kind.DELETING],) * 2,
    "least_rate": ([Kind.DELETING], [Kind.FACT]),
    "motion_only_with": ([Kind.DELETING], [Kind.FACT]),
    "never_heated": ([Kind.DELETING],) * 2,
    "not_both_motions": ([Kind.SHRINKING],) * 2,
    "only_sources": ([Kind.DELETING],) * 2,
    "require_ingredient": ([Kind.REQUIRING], [Kind.FACT]),
    "require_intermediate": ([Kind.REQUIRING], [Kind.FACT]),
    "require_motion": ([Kind.REQUIRING], [Kind.FACT]),
    "require_object": ([Kind.REQUIRING], [Kind.FACT]),
}
ONE_OF = {"require_ingredient", "require_intermediate", "require_motion", "require_object"}


# Rules with what is claimed of the last one of each: its kind, and whether it sees no further than the tree.
WRITTEN = [
    # deleting
    (':- use(U), motion(U,"fry").', Kind.DELETING, LOCAL),
    (':- use(U), motion(U,("fry";"bake")).', Kind.DELETING, LOCAL),
    (":- use(17).", Kind.DELETING, LOCAL),
    (':- times(U,N), N > 0, motion(U,"fry").', Kind.DELETING, LOCAL),
    (":- #sum { N,U : times(U,N) } > 3.", Kind.SHRINKING, LOCAL),
    (":- not times(U,1) : inputs(U,3).", Kind.REQUIRING, LOCAL),
    (":- use(U), kitchen(O) : needs(U,O).", Kind.DELETING, LOCAL),
    (":- use(U), #count { O : input(U,O) } > 3.", Kind.DELETING, LOCAL),
    (":- use(U), N = #count { O : input(U,O) }, N > 3.", Kind.DELETING, LOCAL),
    (":- use(U), inputs(U,N), N+1 > 3.", Kind.DELETING, LOCAL),
    (":- use(U), rate(U,1..5).", Kind.DELETING, LOCAL),
    (":- use(U), input(U,O), output(U,O).", Kind.DELETING, LOCAL),
    (":- use(U), goal(O), output(U,O).", Kind.DELETING, LOCAL),
    (":- use(U), input(U,O), label(O,L), utensil(L).", Kind.DELETING, LOCAL),
    ('bad("fry"). bad("bake"). :- use(U), motion(U,M), bad(M).', Kind.DELETING, LOCAL),
    ("done(U) :- use(U), motion(U,M), hot(M). hot(fry). :- done(U), inputs(U,3).", Kind.DELETING, LOCAL),
    (":- available(O), goal(O), label(O,L), utensil(L).", Kind.DELETING, LOCAL),
    ("#const most = 3. :- use(U), inputs(U,N), N > most.", Kind.DELETING, LOCAL),
    (":- use(U), motion(U,M), #count { V : motion(V,M) } < 2.", Kind.DELETING, FAR),
    (":- use(U), input(U,O), input(V,O), U != V.", Kind.DELETING, FAR),
    (":- use(U), input(U,O), located(O,_,L), utensil(L).", Kind.DELETING, FAR),
    ('other(U) :- motion(V,M), motion(U,M), V != U. :- use(U), not other(U).', Kind.DELETING, FAR),
    (':- available(O), label(O,"soup").', Kind.DELETING, FAR),
    ('nut(L) :- label(_,L), ingredient(_,L). :- use(U), input(U,O), label(O,L), nut(L).', Kind.DELETING, FAR),
    # facts
    (':- goal(O), label(O,"soup").', Kind.FACT, LOCAL),
    ("limit(3). :- limit(N), N > 2.", Kind.FACT, LOCAL),
    (":- not missing.", Kind.FACT, LOCAL),
    ('#const off = "". :- off != "", use(U).', Kind.FACT, LOCAL),
    (":- #count { U : use(U) } > #sup.", Kind.FACT, LOCAL),
    (":- #count { U : unit(U) } > 5.", Kind.FACT, FAR),
    (":- kitchen(O), label(O,L), utensil(L).", Kind.FACT, FAR),
    ("one :- not missing. :- one, #true.", Kind.FACT, LOCAL),
    # shrinking
    (':- use(U), motion(U,"fry"), use(V), motion(V,"bake").', Kind.SHRINKING, LOCAL),
    (':- #count { U : use(U), motion(U,"pour") } > 3.', Kind.SHRINKING, LOCAL),
    (":- not #count { U : use(U) } <= 3.", Kind.SHRINKING, LOCAL),
    (":- 3 { use(U) : motion(U,M) }.", Kind.SHRINKING, LOCAL),
    (":- 3 { use(U) : use(U), inputs(U,2) }.", Kind.SHRINKING, LOCAL),
    (":- #sum { N,U : use(U), inputs(U,N) } > 20.", Kind.SHRINKING, LOCAL),
    (":- #sum+ { N-2,U : use(U), inputs(U,N) } > 20.", Kind.SHRINKING, LOCAL),
    (":- #sum { N*M,U : times(U,M), inputs(U,N) } > 20.", Kind.SHRINKING, LOCAL),
    (":- #max { N : use(U), inputs(U,N) } > 3, #min { N : use(U), inputs(U,N) } < 2.", Kind.SHRINKING, LOCAL),
    ('price("fry",3). :- #sum { P,U : use(U), motion(U,M), price(M,P) } > 9.', Kind.SHRINKING, LOCAL),
    ("#const n = 2. :- n < #count { L : use(U), input(U,O), label(O,L) }.", Kind.SHRINKING, LOCAL),
    ("most(3). :- most(N), #count { U : use(U) } > N.", Kind.SHRINKING, LOCAL),
    ("reached(O) :- goal(O). reached(O) :- use(U), reached(P), gives(U,P), needs(U,O). :- reached(O), "
     "located(O,W,L), use(V), motion(V,L).", Kind.SHRINKING, LOCAL),
    (":- not not use(U), use(U).", Kind.SHRINKING, LOCAL),
    (':- use(U) : motion(U,"fry").', Kind.SHRINKING, FAR),
    (":- available(O) : label(O,L), utensil(L).", Kind.SHRINKING, FAR),
    # requiring
    (':- not use(U) : motion(U,"bake").', Kind.REQUIRING, LOCAL),
    ('hot :- use(U), output(U,O), state(O,"hot"). :- not hot.', Kind.REQUIRING, LOCAL),
    (':- #count { U : use(U), motion(U,"bake") } < 1.', Kind.REQUIRING, LOCAL),
    (':- #count { U : use(U), motion(U,"bake") } = 0.', Kind.REQUIRING, LOCAL),
    (":- #count { U : use(U) } < 3.", Kind.REQUIRING, LOCAL),
    (':- goal(O), label(O,L), not has(L). has(L) :- use(U), input(U,O), label(O,L).', Kind.REQUIRING, LOCAL),
    (':- object(O), label(O,"soup"), not available(O).', Kind.REQUIRING, FAR),
    (':- motion(U,"fry"), not use(U).', Kind.REQUIRING, FAR),
    # other
    (":- #sum { -1,U : use(U) } < -3.", Kind.OTHER, LOCAL),
    (":- #sum { N-2,U : use(U), inputs(U,N) } > 3.", Kind.OTHER, LOCAL),
    (":- #sum { N*I,U : use(U), inputs(U,N), ingredients(U,I) } > 3.", Kind.OTHER, LOCAL),
    (":- #sum { M*(-1),U : times(U,M) } < -3.", Kind.OTHER, LOCAL),
    ('price("a",-3). :- #sum { P,U : use(U), motion(U,M), price(M,P) } > 9.', Kind.OTHER, LOCAL),
    (":- #count { U : use(U) } = 3.", Kind.OTHER, LOCAL),
    (":- #count { U : use(U) } != 3.", Kind.OTHER, LOCAL),
    (":- 2 <= #count { U : use(U) } <= 4.", Kind.OTHER, LOCAL),
    (":- N = #count { U : use(U) }, N > 3.", Kind.OTHER, LOCAL),
    ("number(N) :- N = #count { U : use(U) }. :- number(N), N > 3.", Kind.OTHER, LOCAL),
    (':- use(U), motion(U,"fry"), not use(V) : motion(V,"rinse").', Kind.OTHER, LOCAL),
    ("knife :- use(1). rinsed :- use(2). :- knife, not rinsed.", Kind.OTHER, LOCAL),
    ("{ mark(U) } :- use(U). :- mark(U), inputs(U,2).", Kind.OTHER, LOCAL),
    ("{ mark(U) : motion(U,_) }. :- mark(U), use(U).", Kind.OTHER, FAR),
    ("mark(U) ; spare(U) :- use(U). :- mark(U), inputs(U,2).", Kind.OTHER, LOCAL),
    ("{ mark(U) } :- use(U).", Kind.OTHER, LOCAL),
    ("not mark(U) :- use(U).", Kind.OTHER, LOCAL),
    ("p :- not q. q :- not p. :- p, use(U).", Kind.OTHER, LOCAL),
    ("p :- not p, use(U).", Kind.OTHER, LOCAL),
    ("p :- not not p. :- p.", Kind.OTHER, LOCAL),
    ("p :- #count { 1 : p } > 0. :- p.", Kind.OTHER, LOCAL),
    ("odd(O) :- label(O,L), not odd(O). :- use(U), input(U,O), odd(O).", Kind.OTHER, FAR),
    ("-hot(U) :- use(U).", Kind.OTHER, FAR),
    (":- use(U), -hot(U).", Kind.OTHER, FAR),
    (":- use(U), risk(U,N), N > 5.", Kind.OTHER, FAR),
    (":- use(U), cost(price,U,N), N > 5.", Kind.OTHER, FAR),
    (":- optimize(units,P).", Kind.OTHER, FAR),
    (":- _by_person(U), use(U).", Kind.OTHER, FAR),
    ("#heuristic use(U) : unit(U). [1,false]", Kind.OTHER, FAR),
    # helpers
    ("many(N) :- N = #count { U : unit(U) }.", Kind.HELPER, LOCAL),
    ("many(N) :- N = #count { U : use(U) }.", Kind.HELPER, LOCAL),
    ('bad("fry").', Kind.HELPER, LOCAL),
]  # fmt: skip


def rules(text: Loaded, *constants: str, varied: frozenset[tuple[str, int]] = frozenset()) -> list[Rule]:
    return list(Analysis(read_encoding(text).statements, constants, varied).rules)


@pytest.mark.parametrize(("text", "kind", "local"), WRITTEN)
def test_kinds_of_rules(text: str, kind: Kind, local: bool) -> None:
    found = rules(Stated("rule 1", text))
    rule = next((each for each in reversed(found) if each.kind is not Kind.HELPER), found[-1])
    assert (rule.kind, rule.local) == (kind, local)
    assert bool(rule.reason) >= (kind is Kind.OTHER)


@pytest.mark.parametrize(
    ("text", "varied"),
    [
        (":- use(U), needs(U,O), kitchen(O).", ("kitchen", 1)),
        (":- use(U), gives(U,O), available(O).", ("available", 1)),
        ("want(O) :- goal(O). :- want(O), use(U), gives(U,O).", ("goal", 1)),
    ],
)
def test_what_a_question_varies_is_in_doubt(text: str, varied: tuple[str, int]) -> None:
    assert rules(Stated("rule 1", text))[-1].kind is not Kind.OTHER
    rule = rules(Stated("rule 1", text), varied=frozenset({varied}))[-1]
    assert rule.kind is Kind.OTHER
    assert "varies within this question" in rule.reason


def test_a_rule_in_another_file_changes_what_one_does() -> None:
    text = ":- use(U), motion(U,M), bad(M)."
    assert rules(Stated("rule 1", text))[0].kind is Kind.DELETING
    with_choice = [*read_encoding(Stated("rule 1", text)).statements]
    with_choice += read_encoding(Stated("rule 2", '{ bad("fry") }.')).statements
    changed = Analysis(with_choice, ()).rules[0]
    assert changed.kind is Kind.OTHER
    assert changed.reason_source is not None
    assert changed.reason_source.file == "rule 2"


def test_constants_that_override_or_stand_for_others_are_not_known() -> None:
    for text in (
        '#const a = b. #const b = "". :- a != "", use(U), use(V).',
        '#const a = "". [override] :- a != "", use(U), use(V).',
        '#const a = "". #const a = "". :- a != "", use(U), use(V).',
    ):
        assert rules(Stated("rule 1", text))[0].kind is Kind.SHRINKING
    off = '#const a = "". :- a != "", use(U), use(V).'
    assert rules(Stated("rule 1", off))[0].kind is Kind.FACT
    assert rules(Stated("rule 1", off), 'a="x"')[0].kind is Kind.SHRINKING


@pytest.mark.parametrize("name", [each.name for each in library_constraints()])
def test_kinds_of_ready_made_constraints(name: str) -> None:
    constraint = next(each for each in library_constraints() if each.name == name)
    constants = [
        f'{each.name}="x"' if each.own_value == '""' else f"{each.name}=3" for each in constraint.parameters
    ]
    for settings, kinds in zip((constants, []), LIBRARY[name], strict=True):
        found = [rule for rule in rules(constraint.file, *settings) if rule.kind is not Kind.HELPER]
        assert [rule.kind for rule in found] == kinds
        assert all(rule.local for rule in found)
        asks = [name in ONE_OF] * len(found)
        assert [rule.one_of for rule in found] == [bool(each and settings) for each in asks]


def test_facts_are_known_or_unsure() -> None:
    unsure = {("risk", 2), ("cost", 3), ("optimize", 2)}
    used_up = {("stays", 2), ("uses_up", 2), ("stock", 2)}
    assert FACT_PREDICATES.items() - SUBJECTS.keys() == unsure | used_up
    for name, arity in FACT_PREDICATES.items() - SUBJECTS.keys():
        (rule,) = rules(Stated("rule 1", f":- {name}({','.join('XYZ'[:arity])})."))
        assert (rule.kind, rule.local) == (Kind.OTHER, FAR)


def test_every_predicate_that_a_rule_may_look_at_is_known_or_in_doubt() -> None:
    for name, arity in PUBLIC:
        (rule,) = rules(Stated("rule 1", f":- {name}({','.join('XYZ'[:arity])}), not missing."))
        assert rule.kind is not Kind.FACT or (name, arity) in SUBJECTS


def test_rules_are_understood_but_for_replaced_encodings() -> None:
    settings = Settings((RuleText(':- use(U), motion(U,"fry").'),))
    assert assemble(settings, lambda _: None).understood is not None
    assert assemble(settings, lambda _: None, used_up=True).understood is not None
    by_need = settings._replace(encodings=Path("by_need"))
    assert assemble(by_need, lambda _: None).understood is None
