"""Questions that are stopped at any moment: what they found by then stands, and bounds hold."""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

import foon_asp
from foon_asp import Cancel, Problem, StoppedError
from foon_asp.problem import ContainerRule
from foon_asp.questions.assist import Assistance
from foon_asp.questions.ending import Ending
from foon_asp.questions.pareto import Front
from foon_asp.questions.result import Result
from foon_asp.questions.sensitivity import Sensitivity
from tests.questions.test_assist import ways as helped_ways
from tests.questions.test_sensitivity import ways as made_ways


class Countdown(Cancel):
    """A token that is cancelled after it was looked at so often."""

    def __init__(self, looks: int) -> None:
        super().__init__()
        self.looks = looks

    @property
    def cancelled(self) -> bool:
        """Whether that is so."""
        self.looks -= 1
        if self.looks < 0:
            self.cancel()
        return super().cancelled


def some_help(found: Assistance, whole: Assistance) -> int:
    """Compare rows: those before the last are proved, and the last is between its bounds."""
    *before, last = found.rows
    for row, best in zip(before, whole.rows, strict=False):
        assert (row.status, row.success) == (best.status, best.success)
    proved = whole.rows[last.most].success or Fraction(0)
    assert (last.success or 0) <= proved
    assert last.bound is None or proved <= last.bound
    assert not before or (last.success or 0) >= (before[-1].success or 0)
    return len(found.rows)


def some_points(found: Front, whole: Front) -> int:
    assert {point.units for point in found.points} <= {point.units for point in whole.points}
    assert "stopped at a limit" in found.text()
    return len(found.points)


def some_ends(found: Sensitivity, whole: Sensitivity) -> int:
    """Compare ends: those that are proved are right, and others are no nearer than the right ones."""
    right = {interval.motion: interval for interval in whole.intervals}
    proved = 0
    for interval in found.intervals:
        other = right[interval.motion]
        for end, true in ((interval.below, other.below), (interval.above, other.above)):
            proved += end.proved
            if end.proved:
                assert end == true
            elif end.at is not None and true.at is not None:
                assert abs(end.at.inwards - interval.rate) >= abs(true.at.inwards - interval.rate)
            else:
                assert end.at is None
    assert "stopped at a limit" in found.text() or not found.intervals
    return proved


def some_lists(found: foon_asp.Shopping, whole: foon_asp.Shopping) -> int:
    for some, other in zip(found.lists, whole.lists, strict=False):
        assert not some.proved or some.price == other.price
    return len(found.lists)


def posed(goal: str) -> Problem:
    return foon_asp.load().problem(goal)


WAYS = made_ways({"mix": "0.9", "cut": "0.7", "bake": "0.3"}, ("mix",) * 3, ("mix", "cut"), ("bake",))
HELPED = helped_ways(5002, ContainerRule.STRICT)
Compare = Callable[[Any, Any], int]


@pytest.mark.parametrize(
    ("ask", "problem", "named", "compare"),
    [
        (foon_asp.assist, HELPED, {}, some_help),
        (foon_asp.assist, HELPED, {"constraints": "least_rate", "constants": {"least_rate": 1}}, some_help),
        (foon_asp.pareto, posed("macaroni"), {"objectives": "units,success"}, some_points),
        (foon_asp.sensitivity, WAYS, {}, some_ends),
        (foon_asp.shopping_list, posed("hot cocoa"), {}, some_lists),
    ],
    ids=["assist", "assist by rates", "pareto", "sensitivity", "shopping-list"],
)
def test_what_was_found_before_a_stop_stands(
    ask: Callable[..., Result], problem: Problem, named: dict[str, Any], compare: Compare
) -> None:
    never = Countdown(10**9)
    whole = ask(problem, cancel=never, **named)
    assert whole.ending is not Ending.LIMIT
    looks = 10**9 - never.looks
    found = set()
    for number in range(1, 13):
        try:
            some = ask(problem, cancel=Countdown(looks * number // 13), **named)
        except StoppedError:
            continue
        if some.ending is Ending.LIMIT:
            found.add(compare(some, whole))
    assert len(found) > 1
