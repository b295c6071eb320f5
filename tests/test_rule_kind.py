"""What is claimed of rules: their kinds, and how far they see."""

from pathlib import Path

import pytest

from foon_asp.asp.constraint_library import library_constraints
from foon_asp.asp.encoding import read_encoding
from foon_asp.asp.fact_subject import SUBJECTS
from foon_asp.asp.facts import FACT_PREDICATES
from foon_asp.asp.rule_kind import Analysis, Kind, Rule

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
ONE_OF = {"require_ingredient", "require_motion", "require_object"}


def rules(file: Path, *constants: str, varied: frozenset[tuple[str, int]] = frozenset()) -> tuple[Rule, ...]:
    return Analysis(read_encoding(file).statements, constants, varied).rules


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
        assert all(rule.one_of == (name in ONE_OF and bool(settings)) for rule in found)


def test_facts_are_known_or_unsure() -> None:
    assert FACT_PREDICATES.items() - SUBJECTS.keys() == {("risk", 2), ("cost", 3), ("optimize", 2)}
