"""Trees in order: which come out, and what is known when a limit comes first."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Settings
from foon_asp.asp.ranking import Ranked
from foon_asp.deadline import Deadline
from foon_asp.encoding import clingo_run
from foon_asp.encoding.run import Run
from foon_asp.errors import BugError, UserError
from foon_asp.problem import Costs, Objective, Problem, UsedUp
from tests.asp.test_solver import Heard, numbers, own_encodings
from tests.support.ways_problem import ways

UNITS, SUCCESS, INPUTS, KITCHEN = Objective.UNITS, Objective.SUCCESS, Objective.INPUTS, Objective.KITCHEN
Tree = tuple[int, ...]


def units_of(found: Sequence[tuple[Tree, object]]) -> list[Tree]:
    return [units for units, _ in found]


def ranked_units(problem: Problem, *objectives: Objective, **settings: Any) -> list[Tree]:
    """Rank trees and give their units; their costs are those of the problem."""
    ranked = Ranked(problem, objectives, Settings(**settings))
    assert not ranked.complete
    found = list(ranked)
    assert found == [(units, problem.costs(units)) for units in units_of(found)]
    assert (ranked.complete, ranked.pending) == (True, [])
    return units_of(found)


TINY = "0.000000001"
ALL_WAYS = (["0.5", "0.5"], ["0.9", "0.9", "0.9"], ["0.2"])


@pytest.mark.parametrize(
    ("chains", "objectives", "order"),
    [
        (ALL_WAYS, [UNITS], [(5,), (0, 1), (2, 3, 4)]),
        (ALL_WAYS, [INPUTS], [(5,), (0, 1), (2, 3, 4)]),
        (ALL_WAYS, [SUCCESS], [(2, 3, 4), (0, 1), (5,)]),  # 0.729, 0.25, 0.2
        (ALL_WAYS, [UNITS, SUCCESS], [(5,), (0, 1), (2, 3, 4)]),
        # what weighs less may come later: three times 0.7 weighs 107002482, and what is better one more
        ((["0.7"] * 3, ["0.3430000001"]), [SUCCESS], [(3,), (0, 1, 2)]),
        ((["0.7"] * 3, ["0.3430000001"]), [KITCHEN, SUCCESS], [(3,), (0, 1, 2)]),
        # nothing is given before what may still be better: one more weighs also what is worse
        ((["0.7"] * 3, ["0.3429999985"], ["0.3430000001", "1"]), [SUCCESS], [(4, 5), (0, 1, 2), (3,)]),
        # 0.5 weighs 69314718 and 0.499999995 one more; a unit of rate 1 loses nothing
        ((["0.5", "1"], ["0.499999995"], ["0.1"]), [SUCCESS], [(0, 1), (2,), (3,)]),
        # what is as good comes in the order of its units
        ((["0.5"], ["0.5"], ["0.5"]), [SUCCESS], [(0,), (1,), (2,)]),
        # three units of 10^-9 weigh 6,216,979,749 together, which clingo reports modulo 2^32
        (([TINY] * 3, [TINY, TINY, "0.1"], [TINY] * 2), [SUCCESS], [(6, 7), (3, 4, 5), (0, 1, 2)]),
    ],
)
def test_each_objective_has_its_order(
    chains: tuple[list[str], ...], objectives: list[Objective], order: list[Tree]
) -> None:
    assert ranked_units(ways(*chains), *objectives) == order


def test_rates_are_not_needed_for_the_number_of_units() -> None:
    problem = replace(ways(["0.5", "0.5"], ["0.2"]), rates=None)
    assert ranked_units(problem, UNITS) == [(2,), (0, 1)]
    with pytest.raises(UserError, match="the objective success needs the success rates of the motions"):
        Ranked(problem, [UNITS, SUCCESS], Settings())
    with pytest.raises(UserError, match="not built for items that are used up"):
        Ranked(replace(problem, items=UsedUp()), [UNITS], Settings())


def test_a_goal_at_hand_needs_no_unit() -> None:
    """Every other tree holds the one without units; where another goal cannot be made, there is none."""
    problem = ways(["0.5"], ["0.2"])
    (start,) = problem.kitchen
    at_hand = replace(problem, kitchen=problem.kitchen.union(problem.goals))
    assert ranked_units(at_hand, UNITS) == ranked_units(at_hand, SUCCESS) == [()]
    nowhere = replace(at_hand, kitchen=frozenset(problem.goals), goals=(*problem.goals, start))
    ranked = Ranked(nowhere, [UNITS], Settings())
    assert (ranked.complete, list(ranked)) == (True, [])


def test_rules_of_the_user_see_all_that_can_be_made(tmp_path: Path) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text(':- not use(U) : motion(U,"garnish").  :- use(U), source(U,"way 1"), no_such_thing(U).\n')
    problem = ways(["0.5"], ["0.5", "0.2"], beside=True)
    heard = Heard()
    found = list(Ranked(problem, [UNITS], Settings(constraints=(rule,)), heard))
    assert units_of(found) == [(0, 3), (1, 2, 3)]
    assert len(heard.warnings) == 1
    assert "no_such_thing" in heard.warnings[0]


# --- Limits.


def says(*answers: Run) -> Callable[..., Run]:
    """Answer each search in turn; one more is stopped by a limit."""
    waiting = list(answers)
    return lambda *_, **__: waiting.pop(0) if waiting else Run()


def stopped(problem: Problem, objective: Objective, **settings: Any) -> tuple[list[Tree], list[Tree]]:
    """Rank trees up to a limit; gives those in order, and those known beside them."""
    ranked = Ranked(problem, [objective], Settings(**settings))
    given = units_of(list(ranked))
    assert not ranked.complete
    assert ranked.pending == [(units, problem.costs(units)) for units in units_of(ranked.pending)]
    return given, units_of(ranked.pending)


def test_what_was_found_before_a_limit_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trees that may still have others before them, in order, with the one of the search that was stopped."""
    problem = ways(["0.5"], ["0.5"], ["0.4"], ["0.3", "0.3"])
    assert stopped(problem, SUCCESS, deadline=Deadline(0)) == ([], [])
    one, other = (Run(numbers(problem, unit), (69314718, 1), True) for unit in (0, 1))
    monkeypatch.setattr(clingo_run, "run", says(other, one, Run(numbers(problem, 3, 4))))
    assert stopped(problem, SUCCESS) == ([], [(0,), (1,), (3, 4)])
    two = Run(numbers(problem, 3, 4), (2,), True)
    for answers, given in (([], []), ([replace(one, cost=(1,)), two], [(0,), (3, 4)])):
        monkeypatch.setattr(clingo_run, "run", says(*answers))
        assert stopped(problem, UNITS) == (given, [])


# --- What clingo says is not believed.


@pytest.mark.parametrize(
    ("answers", "message"),
    [
        ([((0,), (65,))], r"reports the costs \[65\], the units \(0,\) cost \(1,\)"),
        ([((0,), (1 + 2**31,))], "reports the costs"),
        ([((0,), (1, 0))], r"reports the costs \[1, 0\]"),
        ([((0,), ())], r"reports the costs \[\]"),
        ([((1, 2), (2,)), ((0,), (1,))], r"the tree \(0,\) costs \(1,\), but comes after one for \(2,\)"),
        (
            [((0,), (1,)), ((3, 4, 5), (3,)), ((1, 2), (2,))],
            r"\(1, 2\) costs \(2,\), but comes after one",
        ),
        ([((0,), (1,))] * 2, r"the tree \(0,\) holds one that was found before"),
        ([((0,), (1,)), ((0, 1, 2), (3,))], "holds one that was found before"),
    ],
)
def test_answers_that_contradict_our_own_costs_are_bugs(
    answers: list[tuple[Tree, Tree]], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = ways(["0.5"], ["0.5", "0.2"], ["0.5", "0.2", "0.1"])
    runs = [Run(numbers(problem, *units), costs, True) for units, costs in answers]
    monkeypatch.setattr(clingo_run, "run", says(*runs))
    with pytest.raises(BugError, match=message):
        list(Ranked(problem, [UNITS], Settings()))


def test_costs_are_held_against_what_clingo_adds_up(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = Problem.costs
    monkeypatch.setattr(
        Problem, "costs", lambda problem, units: Costs({**costs(problem, units).measures, INPUTS: 2})
    )
    problem = ways(["0.5"])
    assert units_of(list(Ranked(problem, [SUCCESS], Settings()))) == [(0,)]
    with pytest.raises(BugError, match=r"reports the costs \[1, 1\], the units \(0,\) cost \(2, 1\)"):
        list(Ranked(problem, [INPUTS], Settings()))


@pytest.mark.parametrize(("objective", "new"), [(UNITS, "{ 65@P,U "), (UNITS, "{ -1@P,U "), (SUCCESS, "")])
def test_encodings_that_measure_something_else_are_refused(
    objective: Objective, new: str, tmp_path: Path
) -> None:
    change = ("{ 1@P,U ", new) if new else ("{ W@P,U ", "{ -W@P,U ")
    settings = Settings(encodings=own_encodings(tmp_path, objectives=change))
    with pytest.raises(UserError) as refused:
        list(Ranked(ways(["0.5"], ["0.5", "0.2"], ["0.4", "0.2"]), [objective], settings))
    assert str(refused.value).endswith(
        f"objectives.lp does not measure what the objectives {'units' if new else 'success, units'} "
        "measure here, so trees cannot be ordered"
    )


def test_other_encodings_that_measure_the_same_may_be_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But are refused where they find dear trees first, or units that there are not."""
    own = own_encodings(tmp_path)
    problem = ways(["0.5"], ["0.5", "0.2"])
    assert ranked_units(problem, UNITS, encodings=own) == [(0,), (1, 2)]
    one, two = Run(numbers(problem, 0), (1,), True), Run(numbers(problem, 1, 2), (2,), True)
    strange = Run(frozenset({77, *numbers(problem, 0)}), (2,), True)
    for answers, message in (
        ((two, one), "trees cannot be ordered"),
        ((strange,), "^a tree was found with units that are not in the network: check the encodings$"),
    ):
        monkeypatch.setattr(clingo_run, "run", says(*answers))
        with pytest.raises(UserError, match=message):
            list(Ranked(problem, [UNITS], Settings(encodings=own)))
