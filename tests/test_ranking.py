"""Trees in order: which come out, after how many searches, and what is known when a limit comes first."""

import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Reporter, Settings
from foon_asp.asp.ranking import Ranked
from foon_asp.deadline import Deadline
from foon_asp.encoding import search
from foon_asp.errors import BugError, UserError
from foon_asp.grounding.run import Run
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.resources import encodings_folder
from tests.ways_problem import ways

UNITS, SUCCESS, INPUTS = Objective.UNITS, Objective.SUCCESS, Objective.INPUTS


class Searches:
    """Counts what is asked of clingo, and stops after so many answers."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, most: int = 99, last: Run | None = None) -> None:
        self.facts: list[str] = []
        self._most, self._last = most, last
        self._run = search.run
        monkeypatch.setattr(search, "run", self.run)

    def run(self, files: Any, facts: str, *given: Any, **named: Any) -> Run:
        self.facts.append(facts)
        if len(self.facts) > self._most:
            return self._last or Run()
        return self._run(files, facts, *given, **named)


def units_of(found: Sequence[tuple[tuple[int, ...], object]]) -> list[tuple[int, ...]]:
    return [units for units, _ in found]


@pytest.mark.parametrize(
    ("objectives", "order"),
    [
        ([UNITS], [(5,), (0, 1), (2, 3, 4)]),
        ([INPUTS], [(5,), (0, 1), (2, 3, 4)]),
        ([SUCCESS], [(2, 3, 4), (0, 1), (5,)]),  # 0.729, 0.25, 0.2
        ([UNITS, SUCCESS], [(5,), (0, 1), (2, 3, 4)]),
    ],
)
def test_each_objective_has_its_order(objectives: list[Objective], order: list[tuple[int, ...]]) -> None:
    problem = ways(["0.5", "0.5"], ["0.9", "0.9", "0.9"], ["0.2"])
    ranked = Ranked(problem, objectives, Settings())
    assert not ranked.complete
    assert ranked.known == []
    found = list(ranked)
    assert found == [(units, problem.costs(units)) for units in order]
    assert ranked.complete
    assert ranked.known == []


def test_rates_are_not_needed_for_the_number_of_units() -> None:
    problem = replace(ways(["0.5", "0.5"], ["0.2"]), rates=None)
    assert units_of(list(Ranked(problem, [UNITS], Settings()))) == [(2,), (0, 1)]
    with pytest.raises(UserError, match="the objective success needs the success rates of the motions"):
        Ranked(problem, [UNITS, SUCCESS], Settings())


def test_what_weighs_less_may_come_later() -> None:
    """Three times 0.7 weighs 107002482, and 0.3430000001, which is better, one more."""
    problem = ways(["0.7"] * 3, ["0.3430000001"])
    for objectives in ([SUCCESS], [Objective.KITCHEN, SUCCESS]):
        assert units_of(list(Ranked(problem, objectives, Settings()))) == [(3,), (0, 1, 2)]


def test_nothing_is_given_before_what_may_still_be_better() -> None:
    """Three times 0.7 weighs 107002482, and one more what is better and what is worse."""
    problem = ways(["0.7"] * 3, ["0.3429999985"], ["0.3430000001", "1"])
    found = units_of(list(Ranked(problem, [SUCCESS], Settings())))
    assert found == [(4, 5), (0, 1, 2), (3,)]


def test_what_weighs_the_same_comes_in_the_order_of_its_units() -> None:
    problem = ways(["0.5"], ["0.5"], ["0.5"], ["0.5"])
    assert units_of(list(Ranked(problem, [SUCCESS], Settings()))) == [(0,), (1,), (2,), (3,)]


def test_a_goal_at_hand_needs_no_unit() -> None:
    """Every other tree holds the one without units."""
    problem = ways(["0.5"], ["0.2"])
    problem = replace(problem, kitchen=problem.kitchen.union(problem.goals))
    for objectives in ([UNITS], [SUCCESS]):
        ranked = Ranked(problem, objectives, Settings())
        assert list(ranked) == [((), problem.costs(()))]
        assert ranked.complete


def test_nothing_is_searched_where_a_goal_cannot_be_made(monkeypatch: pytest.MonkeyPatch) -> None:
    searches = Searches(monkeypatch)
    problem = ways(["0.5"], ["0.2"])
    (start,) = problem.kitchen
    ranked = Ranked(
        replace(problem, kitchen=frozenset(problem.goals), goals=(*problem.goals, start)), [UNITS], Settings()
    )
    assert ranked.complete
    assert list(ranked) == []
    assert not searches.facts


# --- How many searches it takes.


@pytest.mark.parametrize(
    ("chains", "objectives", "first", "searches"),
    [
        ((["0.5"], ["0.5", "0.5"]), [UNITS], (0,), 1),  # there clingo's order is ours
        ((["0.5"], ["0.9", "0.9"]), [UNITS, SUCCESS], (0,), 2),  # the next one has more units
        ((["1"], ["0.5", "0.5"]), [SUCCESS], (0,), 1),  # nothing is better than certain
        # 0.5 weighs 69314718 and 0.499999995 one more: what is better may weigh the same
        ((["0.5"], ["0.499999995"], ["0.4"]), [SUCCESS], (0,), 2),
        # each of two units may have lost nearly 1: two more is too much, one more is not
        ((["0.5", "0.5"], ["0.24999999495"], ["0.1"]), [SUCCESS], (0, 1), 2),
        ((["0.5", "0.5"], ["0.249999998"], ["0.1"]), [SUCCESS], (0, 1), 3),
        # a unit of rate 1 loses nothing
        ((["0.5", "1"], ["0.499999995"], ["0.1"]), [SUCCESS], (0, 1), 2),
    ],
)
def test_a_tree_is_given_as_soon_as_none_can_come_before_it(
    chains: tuple[list[str], ...],
    objectives: list[Objective],
    first: tuple[int, ...],
    searches: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = Searches(monkeypatch)
    units, _ = next(iter(Ranked(ways(*chains), objectives, Settings())))
    assert units == first
    assert len(asked.facts) == searches


def test_what_the_goals_do_not_need_is_not_handed_to_clingo(monkeypatch: pytest.MonkeyPatch) -> None:
    searches = Searches(monkeypatch)
    problem = ways(["0.5"], ["0.5", "0.2"], beside=True)
    assert len(list(Ranked(problem, [UNITS], Settings()))) == 2
    assert all("garnish" not in facts and "source(" not in facts for facts in searches.facts)


def test_rules_of_the_user_see_all_that_can_be_made(tmp_path: Path) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text(':- not use(U) : motion(U,"garnish").  :- use(U), source(U,"way 1").\n')
    problem = ways(["0.5"], ["0.5", "0.2"], beside=True)
    found = list(Ranked(problem, [UNITS], Settings(constraints=(rule,))))
    assert units_of(found) == [(0, 3)]


def test_warnings_are_heard(tmp_path: Path) -> None:
    class Heard(Reporter):
        def __init__(self) -> None:
            self.warnings: list[str] = []

        def warning(self, message: str) -> None:
            self.warnings.append(message)

    rule = tmp_path / "rule.lp"
    rule.write_text(":- use(U), no_such_thing(U).\n")
    heard = Heard()
    settings = Settings(constraints=(rule,))
    assert len(list(Ranked(ways(["0.5"]), [UNITS], settings, heard))) == 1
    assert len(heard.warnings) == 1
    assert "no_such_thing" in heard.warnings[0]
    assert len(list(Ranked(ways(["0.5"]), [UNITS], settings))) == 1


# --- Limits.


def test_without_time_nothing_is_known() -> None:
    ranked = Ranked(ways(["0.5"]), [UNITS], Settings(deadline=Deadline(0)))
    assert list(ranked) == []
    assert not ranked.complete
    assert ranked.known == []


def test_what_was_found_before_a_limit_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Trees that may still have others before them, in order, with the one of the search that was stopped."""
    problem = ways(["0.5"], ["0.5"], ["0.4"], ["0.3", "0.3"])
    first = Run(frozenset({problem.network.unit_number(1)}), (69314718, 1), True)
    second = Run(frozenset({problem.network.unit_number(0)}), (69314718, 1), True)
    answers = [first, second, Run(frozenset(map(problem.network.unit_number, (3, 4))))]
    monkeypatch.setattr(search, "run", lambda *_, **__: answers.pop(0))
    ranked = Ranked(problem, [SUCCESS], Settings())
    assert list(ranked) == []
    assert not ranked.complete
    assert ranked.known == [(units, problem.costs(units)) for units in ((0,), (1,), (3, 4))]


def test_a_limit_without_another_tree(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"], ["0.5", "0.4"], ["0.3", "0.3", "0.3"])
    for most, given in ((0, []), (1, [(0,)]), (2, [(0,), (1, 2)])):
        with monkeypatch.context() as patch:
            Searches(patch, most)
            ranked = Ranked(problem, [UNITS], Settings())
            assert units_of(list(ranked)) == given
            assert not ranked.complete
            assert ranked.known == []


@pytest.mark.parametrize("after", [0, 1])
def test_ctrl_c_is_noted_wherever_it_comes(after: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """At the cut, or while facts are written, which is done once: it is heard once."""
    watched, calls = Deadline.watched, []

    def struck(deadline: Deadline, doing: str, late: bool = False) -> Any:
        calls.append(doing)
        if len(calls) == after + 1:
            raise KeyboardInterrupt
        return watched(deadline, doing, late)

    monkeypatch.setattr(Deadline, "watched", struck)
    deadline = Deadline()
    ranked = Ranked(ways(["0.5"], ["0.2", "0.2"]), [UNITS], Settings(deadline=deadline))
    assert list(ranked) == []
    assert calls == ["cutting the network", "writing facts"][: after + 1]
    assert not ranked.complete
    assert deadline.interrupted


# --- What clingo says is not believed.


def says(*answers: Run) -> Callable[..., Run]:
    waiting = list(answers)
    return lambda *_, **__: waiting.pop(0)


def test_answers_that_contradict_our_own_costs_are_bugs(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"], ["0.5", "0.2"], ["0.5", "0.2", "0.1"])
    numbers = [problem.network.unit_number(unit) for unit in range(6)]
    one, two, three = frozenset(numbers[:1]), frozenset(numbers[1:3]), frozenset(numbers[3:])
    wrong = [
        ([Run(one, (1 + 64,), True)], r"reports the costs \[65\], the units \(0,\) cost \(1,\)"),
        ([Run(one, (1 + 2**31,), True)], "reports the costs"),
        ([Run(one, (1, 0), True)], r"reports the costs \[1, 0\]"),
        ([Run(one, (), True)], r"reports the costs \[\]"),
        (
            [Run(two, (2,), True), Run(one, (1,), True)],
            r"the tree \(0,\) costs \(1,\), but comes after one for \(2,\)",
        ),
        (
            [Run(one, (1,), True), Run(three, (3,), True), Run(two, (2,), True)],
            r"the tree \(1, 2\) costs \(2,\), but comes after one for \(3,\)",
        ),
        ([Run(one, (1,), True)] * 2, r"the tree \(0,\) holds one that was found before"),
        ([Run(one, (1,), True), Run(one | two, (3,), True)], "holds one that was found before"),
    ]
    for answers, message in wrong:
        monkeypatch.setattr(search, "run", says(*answers))
        with pytest.raises(BugError, match=message):
            list(Ranked(problem, [UNITS], Settings()))


def test_every_cost_is_held_against_our_own(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"])
    unit = frozenset({problem.network.unit_number(0)})
    for costs in ((1, 1), (69_314_718, 2)):
        monkeypatch.setattr(search, "run", says(Run(unit, costs, True)))
        with pytest.raises(BugError, match=r"the units \(0,\) cost \(69314718, 1\)"):
            list(Ranked(problem, [SUCCESS], Settings()))


def test_costs_are_held_against_what_clingo_adds_up(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = Problem.costs
    monkeypatch.setattr(
        Problem, "costs", lambda problem, units: Costs({**costs(problem, units).measures, INPUTS: 2})
    )
    problem = ways(["0.5"])
    assert units_of(list(Ranked(problem, [SUCCESS], Settings()))) == [(0,)]
    with pytest.raises(BugError, match=r"reports the costs \[1, 1\], the units \(0,\) cost \(2, 1\)"):
        list(Ranked(problem, [INPUTS], Settings()))


def test_sums_beyond_32_bits_are_in_order() -> None:
    """Three units of 10^-9 weigh 6,216,979,749 together, which clingo reports modulo 2^32."""
    tiny = "0.000000001"
    problem = ways([tiny] * 3, [tiny, tiny, "0.1"], [tiny] * 2)
    assert units_of(list(Ranked(problem, [SUCCESS], Settings()))) == [(6, 7), (3, 4, 5), (0, 1, 2)]


@pytest.mark.parametrize(("old", "new"), [("{ 1@P,U ", "{ 65@P,U "), ("{ 1@P,U ", "{ -1@P,U ")])
def test_encodings_that_measure_something_else_are_refused(old: str, new: str, tmp_path: Path) -> None:
    own = tmp_path / "own"
    shutil.copytree(encodings_folder(), own)
    problem = ways(["0.5"], ["0.5", "0.2"], ["0.4", "0.2"])
    settings = Settings(encodings=own)
    assert sorted(units_of(list(Ranked(problem, [UNITS], settings)))) == [(0,), (1, 2), (3, 4)]
    text = (own / "objectives.lp").read_text()
    assert old in text
    (own / "objectives.lp").write_text(text.replace(old, new))
    with pytest.raises(UserError) as refused:
        list(Ranked(problem, [UNITS], settings))
    assert str(refused.value) == (
        f"{own / 'objectives.lp'} does not measure what the objectives units measure here, "
        "so trees cannot be ordered"
    )


def test_encodings_that_find_dear_trees_first_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "own"
    shutil.copytree(encodings_folder(), own)
    problem = ways(["0.5"], ["0.5", "0.2"])
    numbers = [problem.network.unit_number(unit) for unit in range(3)]
    answers = says(Run(frozenset(numbers[1:]), (2,), True), Run(frozenset(numbers[:1]), (1,), True))
    monkeypatch.setattr(search, "run", answers)
    with pytest.raises(UserError, match="trees cannot be ordered"):
        list(Ranked(problem, [UNITS], Settings(encodings=own)))


def test_units_that_the_network_has_not_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"])
    number = problem.network.unit_number(0)
    monkeypatch.setattr(search, "run", says(Run(frozenset({number, number + 7}), (2,), True)))
    with pytest.raises(UserError) as refused:
        list(Ranked(problem, [UNITS], Settings()))
    assert (
        str(refused.value) == "a tree was found with units that are not in the network: check the encodings"
    )
