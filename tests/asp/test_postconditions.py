"""With a part of the program broken, there is no answer but a bug report: what leaves is what it claims."""

import shutil
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.soft import solve_soft
from foon_asp.errors import BugError
from foon_asp.hypergraph import ALL, NONE, reduce
from foon_asp.network import ObjectNode
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, levels, parse_objectives
from foon_asp.questions.assist import assist
from foon_asp.questions.help_search import PricedHelp
from foon_asp.questions.pareto import pareto
from foon_asp.questions.regret import regret
from foon_asp.questions.solve import solve as solve_goals
from foon_asp.resources import bundled_kitchen, encodings_folder
from foon_asp.text.reader import FoonReader
from tests.conftest import Cli
from tests.encoding.test_rate_scale import two_ways
from tests.support.random_problems import random_problem
from tests.support.wrong_costs import with_measures

SUCCESS = (Objective.SUCCESS,)
TWO = (["0.3", "0.3"], ["0.09"])  # success is the same, units are not


def outcome_of(problem: Problem, objectives: str = "units", **how: Any) -> Outcome:
    return solve(problem, parse_objectives([objectives]), Settings(**how))


# --- Parts of the program broken, one at a time.


def break_wanted_product(patch: pytest.MonkeyPatch) -> None:
    """Let the search for what comes after success forget which product it was to keep."""
    patch.setattr("foon_asp.encoding.fact_writer.write_wanted", lambda _: "")


def break_models(patch: pytest.MonkeyPatch) -> None:
    """Read other units out of clingo's answers than it used."""
    patch.setattr("foon_asp.encoding.ground_program._used_units", lambda _: frozenset({0, 1}))


def break_costs(patch: pytest.MonkeyPatch) -> None:
    """Measure trees otherwise than the reductions and the encodings do."""
    costs = Problem.costs

    def wrong(problem: Problem, units: Any) -> Costs:
        found = costs(problem, units)
        return with_measures(found, units=found.units + 1, inputs=found.inputs + 1, success=Fraction(1, 7))

    patch.setattr(Problem, "costs", wrong)


@pytest.mark.parametrize(
    ("broken", "objectives", "reductions"),
    [
        (break_wanted_product, "success,units", NONE),
        (break_costs, "success", ALL),
        (break_costs, "inputs", NONE),
        (break_models, "units", NONE),
    ],
)
def test_a_broken_part_is_a_bug_and_no_answer(
    broken: Callable[[pytest.MonkeyPatch], None],
    objectives: str,
    reductions: Any,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = two_ways(["0.3", "0.2"], ["0.09"])  # the second way is better by every objective
    if broken is break_wanted_product:
        problem = two_ways(["0.5", "0.5"], ["0.2"])
    assert outcome_of(problem, objectives, reductions=reductions).status is Status.OPTIMAL
    broken(monkeypatch)
    with pytest.raises(BugError, match=r"foon-asp facts --goal goal --objective .* --containers strict"):
        outcome_of(problem, objectives, reductions=reductions)


def test_the_command_ends_with_70(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    assert cli("solve", "--goal", "ice").code == 0
    break_costs(monkeypatch)
    ran = cli("solve", "--goal", "ice")
    assert ran.code == 70
    assert ran.out == ""
    assert "foon-asp has a bug: BugError: the tree" in ran.err
    assert "foon-asp facts --goal 'ice" in ran.err


@pytest.mark.parametrize("objective", ["units", "success", "inputs+ingredients", "kitchen", "price"])
def test_other_objectives_in_our_own_encodings_are_a_bug(
    objective: str, cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "encodings"
    shutil.copytree(encodings_folder(), folder)
    for module in ("asp.assembly", "asp.settings", "encoding.own_encodings"):
        monkeypatch.setattr(f"foon_asp.{module}.encodings_folder", lambda: folder)
        monkeypatch.setattr(f"foon_asp.{module}.is_own", lambda _: True)
    motions = FoonReader().read_network([bundled_kitchen() / "FOON.txt"]).motions
    (tmp_path / "prices.txt").write_text("".join(f"{motion}\t2\n" for motion in motions))
    words = ["--goal", "ice", "--objective", objective, "--unit-prices", str(tmp_path / "prices.txt")]
    assert cli("solve", *words, "--reduce", "none").code == 0
    text = (folder / "objectives.lp").read_text()
    for criterion in ("1@P,U", "N@P,U", "N+M@P,U", "W@P,U", "1@P,O"):
        text = text.replace("{ " + criterion, "{ 3*" + criterion.replace("N+M", "(N+M)"))
    (folder / "objectives.lp").write_text(text)
    for verb in (["solve", "--reduce", "none"], ["alternatives", "--best", "2"]):
        ran = cli(*verb, *words)
        assert ran.code == 70, ran
        assert "clingo reports the costs" in ran.err
        assert ran.out == ""


@pytest.mark.parametrize("rule", ContainerRule)
def test_no_tree_is_said_where_there_is_none(rule: ContainerRule) -> None:
    seen = set()
    for seed in range(120):
        problem = random_problem(seed, rule)
        holds = Postconditions(problem, levels((Objective.UNITS,)), Settings())
        none = solve(problem, (Objective.UNITS,)).status is Status.INFEASIBLE
        seen.add(none)
        if none:
            holds.require_no_tree()
        else:
            with pytest.raises(BugError, match="can be made"):
                holds.require_no_tree()
    assert seen == {True, False}


# --- Outcomes with something wrong in them.


def changed(**parts: Any) -> Callable[[Outcome], Outcome]:
    return lambda outcome: outcome._replace(**parts)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda o: o._replace(costs=with_measures(o.costs, inputs=7)), "the answer says units 1, inputs 7, "),
        (lambda o: o._replace(costs=with_measures(o.costs, success=Fraction(1))), "the answer says"),
        (lambda o: o._replace(units=(*o.units, *o.units)), "twice"),
        (changed(bounds={Objective.SUCCESS: Fraction(9, 100), Objective.UNITS: 0}), "called optimal"),
        (changed(bounds={}), "called optimal"),
        (changed(status=Status.FEASIBLE, bounds={Objective.SUCCESS: Fraction(1, 99)}), "rules out"),
        (
            changed(status=Status.FEASIBLE, bounds={Objective.SUCCESS: Fraction(9, 100), Objective.UNITS: 9}),
            "rules out",
        ),
    ],
)
def test_what_an_outcome_claims_is_held_against_its_tree(
    change: Callable[[Outcome], Outcome], message: str
) -> None:
    problem = two_ways(*TWO)
    outcome = outcome_of(problem, "success")
    holds = Postconditions(problem, levels(SUCCESS), Settings())
    holds.require_true_claims(outcome)
    with pytest.raises(BugError, match=message):
        holds.require_true_claims(change(outcome))


def test_a_limit_may_leave_room_above_the_tree() -> None:
    problem = two_ways(*TWO)
    outcome = outcome_of(problem, "success")._replace(status=Status.FEASIBLE, proof=None)
    holds = Postconditions(problem, levels(SUCCESS), Settings())
    allowed: list[dict[Objective, int | Fraction]] = [
        {},
        {Objective.SUCCESS: Fraction(1)},
        {Objective.SUCCESS: Fraction(1), Objective.UNITS: 9},
    ]
    for bounds in allowed:
        holds.require_true_claims(outcome._replace(bounds=bounds))


def test_a_better_tree_heard_of_before_is_not_forgotten() -> None:
    problem = two_ways(*TWO)
    outcome = outcome_of(problem, "success")
    assert outcome.costs is not None
    holds = Postconditions(problem, levels(SUCCESS), Settings())
    holds.require_true_claims(outcome, outcome.costs)
    with pytest.raises(BugError, match="but one was found for"):
        holds.require_true_claims(outcome, with_measures(outcome.costs, success=Fraction(1, 2)))


# --- Other questions.


def test_a_penalty_is_counted_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text(':- use(U), motion(U,"other 0").\n')
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    found = solve_soft(problem, (Objective.UNITS,), Settings(), {rule: 2})
    assert found.penalty == 0
    # with the bound on the penalty lost, the second search takes the shorter way
    monkeypatch.setattr("foon_asp.asp.soft.write_greatest_penalty", lambda _: "")
    with pytest.raises(BugError, match=r"the penalty of .* is 2, but the least one was to be 0"):
        solve_soft(problem, (Objective.UNITS,), Settings(), {rule: 2})


def test_points_of_a_front_that_are_no_better_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    assert len(pareto(problem).points) == 2
    monkeypatch.setattr("foon_asp.questions.pareto.better_than", lambda *_: None)
    with pytest.raises(BugError, match="two points of the front"):
        pareto(problem)


def test_a_tree_for_less_than_its_parts_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    half = problem.network.object_id(ObjectNode.of("one", ["0"]))
    assert half is not None
    both = replace(problem, goals=(*problem.goals, half))

    def worse(asked: Problem, *given: Any) -> Outcome:
        outcome = solve(asked, *given)
        if asked is both or outcome.costs is None:
            return outcome
        return outcome._replace(costs=with_measures(outcome.costs, units=outcome.costs.units + 3))

    def better(asked: Problem, *given: Any) -> Outcome:
        outcome = solve(asked, *given)
        if asked is problem or outcome.costs is None:
            return outcome
        return outcome._replace(costs=with_measures(outcome.costs, units=0))

    assert solve_goals(both).goals_alone
    assert regret(problem).regrets
    monkeypatch.setattr("foon_asp.questions.several_goals.solve", worse)
    monkeypatch.setattr("foon_asp.questions.regret.solve", better)
    with pytest.raises(BugError, match="for goal"):
        solve_goals(both)
    with pytest.raises(BugError, match="without "):
        regret(problem)


def test_help_that_is_not_given_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    assert assist(problem).complete
    monkeypatch.setattr(PricedHelp, "helped_units", lambda _self, _most, units: frozenset(units))
    with pytest.raises(BugError, match="with help for"):
        assist(two_ways(["0.5", "0.5"], ["0.2", "0.1"]), most=1)


def test_cuts_prove_the_tree_that_they_were_found_for() -> None:
    problem = two_ways(["0.5", "0.5"], ["0.2"])
    found, outcome = reduce(problem, levels(SUCCESS)), outcome_of(problem, "success")
    holds = Postconditions(problem, levels(SUCCESS), Settings())
    holds.require_true_claims(outcome, None, found)
    for wrong in (found._replace(tree=frozenset({2})), found._replace(bound=found.bound * 2)):
        with pytest.raises(BugError, match=r"called optimal by cuts|bound all trees"):
            holds.require_true_claims(outcome, None, wrong)
