"""The first half of a question: which rules are applied before the search, and which units are left."""

from dataclasses import replace
from typing import NamedTuple

import pytest

from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError, UserError
from foon_asp.problem import Objective, Problem, UsedUp, parse_objectives
from foon_asp.reduce import NONE, ExactCosts, Listener, Reduction
from foon_asp.rules.constraint import given_constraint
from foon_asp.rules.measure import read_measures
from foon_asp.rules.rules import Rules
from tests.test_constraint_meanings import small
from tests.test_solver import struck

PROBLEM = small("cut: start > a", "mix: a > end", "boil: start > end", "junk: start > x")
SETTLED = ':- use(U), motion(U,"boil").'
ASKED = ':- not use(U) : motion(U,"junk").'
SHRINKING = ':- use(U), use(V), motion(U,"boil"), motion(V,"junk").'
SPARE = ':- use(U), motion(U,"boil"), not use(3).'
NEVER = ":- unit(0)."
SOME = frozenset({Reduction.FORCED})


class Heard(Listener):
    """Notes what it hears."""

    def __init__(self) -> None:
        self.trees: list[list[int]] = []
        self.bounds: list[int] = []

    def tree(self, units: frozenset[int]) -> None:
        self.trees.append(sorted(units))

    def bound(self, costs: ExactCosts, bound: int) -> None:
        self.bounds.append(bound)


def asked(rule: str = "", listener: Listener | None = None, **named: object) -> Prepared:
    settings = Settings((given_constraint(rule),) if rule else ())._replace(**named)  # type: ignore[arg-type]
    return prepare(PROBLEM, (Objective.UNITS,), settings, assemble(settings, print), listener)


class Found(NamedTuple):
    """Whether rules were applied, whether some are left, and which tree and units there are."""

    applied: bool
    rest: bool
    tree: list[int]
    units: tuple[int, ...]


ALL, NEEDED = (0, 1, 2, 3), (0, 1, 2)


@pytest.mark.parametrize(
    ("rule", "reduced", "less_reduced", "alone"),
    [
        # by all reductions, by few, and without a listener
        (
            "",
            Found(False, False, [2], (2,)),
            Found(False, False, [2], NEEDED),
            Found(False, False, [2], NEEDED),
        ),
        (
            SETTLED,
            Found(True, False, [0, 1], (0, 1)),
            Found(True, False, [0, 1], (0, 1)),
            Found(True, False, [0, 1], (0, 1)),
        ),
        (
            ASKED,
            Found(True, False, [2, 3], (2, 3)),
            Found(True, False, [2, 3], ALL),
            Found(True, False, [2, 3], ALL),
        ),
        (
            SHRINKING,
            Found(True, True, [2], (2,)),
            Found(True, True, [2], NEEDED),
            Found(True, True, [2], NEEDED),
        ),
        (SPARE, Found(True, True, [2], (2,)), Found(True, True, [2], ALL), Found(True, True, [2], ALL)),
    ],
)
def test_which_rules_are_applied_and_what_is_left(
    rule: str, reduced: Found, less_reduced: Found, alone: Found
) -> None:
    for named, listener, expected in (
        ({}, Heard(), reduced),
        ({"reductions": SOME}, Heard(), less_reduced),
        ({}, None, alone),
    ):
        first = asked(rule, listener, **named)
        assert first.tree is not None
        assert Found(first.kept is not None, first.rest, sorted(first.tree), first.units) == expected
        assert (first.asked is not None) == expected.applied
        assert first.program.own == (not expected.rest)
        assert (first.stopped, first.contradicted) == (False, False)
        if listener is not None and named == {}:
            # a tree that may break a rule is passed on to nobody
            assert listener.trees == ([] if expected.rest else [expected.tree])
            assert listener.bounds == {"": [1], ASKED: [1, 2], SETTLED: [2]}.get(rule, [1])
        assert first.spare == (rule == SPARE)
        if first.reduced is not None and first.reduced.wide is not None:
            assert first.reduced.wide.spare == first.spare
    untouched = asked(rule, Heard(), reductions=NONE)
    assert (untouched.kept, untouched.rest, untouched.asked) == (None, False, None)
    assert untouched.units == (ALL if rule else NEEDED)


def test_rules_that_no_tree_can_keep_to() -> None:
    first = asked(NEVER, Heard())
    assert (first.contradicted, first.tree, first.units, first.asked is None) == (True, None, (), False)
    assert not asked(NEVER, Heard(), reductions=NONE).contradicted


def test_what_may_be_bought_is_there_and_rules_wait_for_the_search() -> None:
    settings = Settings((given_constraint(SETTLED),))
    (start,) = PROBLEM.kitchen
    problem = replace(PROBLEM, kitchen=frozenset())
    first = prepare(problem, (Objective.UNITS,), settings, assemble(settings, print), None, (start,))
    assert (first.kept, first.rest, first.units) == (None, False, ALL)
    assert sorted(first.tree or ()) == [2]


def test_what_is_said_of_people_is_open_where_bounds_come_with_it() -> None:
    rule = ":- use(U), _by_person(U)."
    bounded = asked(rule, Heard(), bounded=Bounded("_by_person(0..3).\n", ()))
    assert (bounded.kept, bounded.asked) == (None, None)
    assert asked(SETTLED, Heard(), bounded=Bounded("", ())).kept is not None


def test_bounds_leave_out_nothing_that_the_goals_may_need() -> None:
    first = asked("", Heard(), bounded=Bounded(":- use(2).\n", ()))
    assert first.units == NEEDED
    assert asked(SHRINKING, Heard(), bounded=Bounded(":- use(2).\n", ())).units == NEEDED


def test_a_tree_is_held_against_all_rules() -> None:
    for rule, kept, broken in (
        (SETTLED, [0, 1], [2]),
        (ASKED, [2, 3], [2]),
        (SHRINKING, [2], [2, 3]),
        (SPARE, [2, 3], [2]),
    ):
        first = asked(rule, Heard())
        assert first.keeps(kept) is True
        assert first.keeps(broken) is False
        first.require_kept(kept)
        if first.rest:
            first.require_kept(broken)  # which the search asks anyway
        else:
            with pytest.raises(BugError, match="does not keep to the rules that were added"):
                first.require_kept(broken)
    plain = asked("", Heard())
    plain.require_kept([2])
    # where that is not known in time, it is no fault
    late = replace(asked(SETTLED, Heard()), deadline=Deadline(0.0))
    assert late.keeps([2]) is None
    late.require_kept([2])


def test_rules_that_cannot_be_applied_are_left_to_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Rules, "applied", lambda *_: None)
    first = asked(SETTLED, Heard())
    assert (first.kept, first.asked, first.contradicted, first.units) == (None, None, False, ALL)


def test_a_constant_that_is_called_like_a_measure_is_refused() -> None:
    problem = replace(PROBLEM, measures=read_measures("cost(mine,U,1) :- unit(U)."))
    settings = Settings((given_constraint("#const mine = 3. :- use(mine)."),))
    program = assemble(settings, print)
    with pytest.raises(UserError, match="found #const mine in a constraint"):
        prepare(problem, parse_objectives(["mine"], problem.measures), settings, program)
    assert prepare(problem, (Objective.UNITS,), settings, program).tree == frozenset({2})


def test_ctrl_c_while_facts_are_written_is_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    first = asked(SETTLED, Heard(), deadline=Deadline())
    struck(monkeypatch, "writing facts")
    assert first.keeps([2]) is None
    assert first.deadline.interrupted


def test_items_that_are_used_up_are_refused() -> None:
    with pytest.raises(UserError, match="not built for items that are used up"):
        prepare(replace(PROBLEM, items=UsedUp()), (Objective.UNITS,), Settings(), assemble(Settings(), print))


def test_measures_are_worked_out_within_the_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    within: list[Deadline | None] = []
    monkeypatch.setattr(Problem, "apply_measures", lambda _, deadline=None: within.append(deadline))
    problem = replace(PROBLEM, measures=read_measures("cost(mine,U,1) :- unit(U)."))
    settings = Settings(deadline=Deadline())
    prepare(problem, (Objective.UNITS,), settings, assemble(settings, print))
    assert within[0] is settings.deadline
    late = Settings(deadline=Deadline(0.0))
    prepare(problem, (Objective.UNITS,), late, assemble(late, print))
    assert late.begun.stopped == "the time limit of 0 s while measuring units"


def test_sets_of_which_one_is_asked_for_are_facts_of_the_units_that_are_left() -> None:
    def required(first: Prepared) -> list[str]:
        return [line for line in first.facts.splitlines() if line.startswith(("_required", "_one_of"))]

    assert required(asked("", Heard())) == []
    assert required(asked(ASKED, Heard())) == ["_required(0).", "_one_of(0,3)."]
    assert required(asked(SETTLED, Heard())) == []


def test_where_time_is_up_nothing_is_known() -> None:
    first = asked("", None, deadline=Deadline(0.0))
    assert (first.stopped, first.tree) == (True, None)
    assert asked("", None, deadline=Deadline(60.0)).stopped is False
