"""The campaign at a small size; ``FOON_CAMPAIGN=2000`` says how many networks the long test asks of."""

import os

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.problem import Objective, Problem
from tests.oracle import campaign, task_trees


def hold(seeds: range) -> campaign.Tally:
    wrong: list[str] = []
    tally = campaign.campaign(seeds, wrong)
    assert not wrong, "\n".join(wrong)
    assert tally["networks"] == len(seeds)
    assert tally["cross-checked"] + tally["not checked"] == tally["optimal"] + tally["infeasible"]
    return tally


@pytest.mark.parametrize("seeds", [range(8), pytest.param(range(100, 130), marks=pytest.mark.slow)])
def test_a_few_networks(seeds: range) -> None:
    tally = hold(seeds)
    assert tally["optimal"] > 1
    assert tally["rules made a difference"] > 0
    assert tally["cross-checked"] > 3


@pytest.mark.nightly
def test_many_networks() -> None:
    number = int(os.environ.get("FOON_CAMPAIGN", "100"))
    tally = hold(range(1000, 1000 + number))
    print(dict(tally))  # noqa: T201 (what the campaign is for; shown with -s)
    assert min(tally[kind] for kind in ("optimal", "infeasible", "refused", "asked again in a session")) > 0


def test_wrong_answers_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tree of another cost, one that breaks a rule, one denied: brute force sees each."""
    lies = 0

    def lie(problem: Problem, objectives: tuple[Objective, ...], settings: Settings) -> Outcome:
        nonlocal lies
        outcome, names = solve(problem, objectives, settings), list(map(str, objectives))
        best = task_trees.key(problem, tuple(map(problem.network.unit, outcome.units or ())), names)
        numbers = {problem.network.unit(number): number for number in range(len(problem.network))}
        lies += 1
        for tree in task_trees.trees(problem):
            if outcome.units is None or task_trees.key(problem, tree, names) != best:
                units = tuple(numbers[unit] for unit in tree)
                return outcome._replace(status=Status.OPTIMAL, units=units, costs=problem.costs(units))
        lies -= outcome.units is None  # so there is none
        return outcome._replace(status=Status.INFEASIBLE, units=None, costs=None)

    monkeypatch.setattr(campaign, "solve", lie)
    wrong: list[str] = []
    tally = campaign.campaign(range(6), wrong)
    assert tally["wrong"] == lies > 1, wrong
