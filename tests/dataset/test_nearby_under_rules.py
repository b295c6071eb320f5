"""Large stores under rules that may ask for units no goal needs: the answer of the whole, from less of it."""

import random
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest

from foon_asp.asp import Proof, Reporter, Settings, Status, solve
from foon_asp.asp.assembly import ReachOfRules, hold_for_subtrees, reach_of_rules
from foon_asp.asp.outcome import Outcome
from foon_asp.dataset import nearby_under_rules
from foon_asp.dataset.nearby import NearbyProblem
from foon_asp.dataset.nearby_under_rules import NEARBY, solve_nearby_under
from foon_asp.dataset.reading_store import read_store
from foon_asp.deadline import Deadline, LimitError
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, levels
from foon_asp.questions.answer import Answer, answer_under_rules
from foon_asp.rules.passed_constraint import RuleText
from foon_asp.store.import_files import import_files
from foon_asp.store.unit_distances import UnitDistances
from foon_asp.text.data_folder import DataFiles
from tests.dataset.test_nearby import LISTS, LONG, SHORT, asked, assert_same, stored
from tests.oracle.constraints import random_rule, settings_of
from tests.support.random_problems import SERIES, random_problem

UNITS = (Objective.UNITS,)
WAVE = Settings((Path("require_motion"),), constants=('required_motion="wave"',))
LABEL = Settings((Path("require_object"),), constants=('required_object="waved"',))
# Each of these has the best tree of the first, and says less of the motion.
EITHER = Settings(
    (RuleText(':- not use(U) : motion(U,"wave"); not use(U) : output(U,O), label(O,"waved").'),)
)
WAVED_BY_NONE = Settings(
    (RuleText(':- not use(U) : unit(U), not motion(U,"cook 0"), output(U,O), label(O,"waved").'),)
)
OF_ANOTHER = Settings(
    (RuleText(':- not use(U) : output(U,O), label(O,"waved"), output(V,O), motion(V,"wave").'),)
)


def near_stew(
    folder: Path,
    *more: tuple[str, str, str],
    first: int = 4,
    long: Sequence[tuple[str, str, str]] = LONG,
    rates: str = "",
) -> Problem:
    """Ask for a stew by two ways, of 3 and of 12 units, and more units; bones and water are at hand."""
    units = (*SHORT, *long, *more)
    text = "".join(
        "".join(f"O\t{each}\n" for each in needs.split("+")) + f"M\t{motion}\nO\t{give}\n//\n"
        for motion, needs, give in units
    )
    (folder / "stew.txt").write_text(text, encoding="utf-8")
    (folder / "kitchen.txt").write_text("O\twater\nO\tbones\n", encoding="utf-8")
    (folder / "motion.txt").write_text(rates, encoding="utf-8")
    files = DataFiles(
        (folder / "stew.txt",), folder / "kitchen.txt", folder / "motion.txt" if rates else None
    )
    import_files(files, folder / "stew.foon")
    dataset = read_store(DataFiles((folder / "stew.foon",)), 3)
    return dataset.nearby(dataset.command_goal_ids(["stew"]), "strict", units_at_first=first)


def read_little(problem: Problem) -> bool:
    return isinstance(problem, NearbyProblem) and "full_problem" not in vars(problem)


def test_a_unit_more_near_the_goals_is_proved_with_the_rest_unread(tmp_path: Path) -> None:
    problem = near_stew(tmp_path, ("wave", "boiled", "plated"), ("turn", "plated", "boiled"))
    heard: list[Costs] = []

    class Heard(Reporter):
        def tree(self, costs: Costs) -> None:
            heard.append(costs)

    found = answer_under_rules(problem, UNITS, WAVE, Heard())
    assert found.costs is not None
    assert (found.status, found.costs.units) == (Status.OPTIMAL, 3)
    assert "wave" in {unit.motion for unit in found.tree.units} if found.tree else False
    assert heard == [found.costs]
    assert read_little(problem)
    assert len(found.problem.network) < len(SHORT + LONG)
    assert found.outcome.cuts == ()  # those of what was read may be none of the whole


# The tree under the rule that is near the goals has two units more than the best one without it.
SLOW = (("soak", "water", "soaked"), ("fold", "soaked", "folded"), ("wave", "folded", "boiled"))


def test_a_unit_from_elsewhere_is_better_than_two_near_the_goals(tmp_path: Path) -> None:
    problem = near_stew(tmp_path, *SLOW, ("wave", "boiled", "waved"))
    found = answer_under_rules(problem, UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units, found.proof) == (Status.OPTIMAL, 4, Proof.CUTS)
    assert read_little(problem)


@pytest.mark.parametrize("asked", [WAVE, LABEL])
def test_a_unit_that_the_kitchen_is_enough_for_is_found_wherever_it_is(
    asked: Settings, tmp_path: Path
) -> None:
    problem = near_stew(tmp_path, *SLOW, ("wave", "bones+water", "waved"))
    found = answer_under_rules(problem, UNITS, asked)
    assert found.costs is not None
    assert (found.status, found.costs.units, read_little(problem)) == (Status.OPTIMAL, 4, True)


RATES = "boil\t0.5\nplate\t1\nserve\t1\nwave\t0.92\n" + "".join(f"cook {n}\t1\n" for n in range(12))
BY_SUCCESS = (Objective.SUCCESS,)


@pytest.mark.parametrize("asked", [WAVE, LABEL, EITHER, WAVED_BY_NONE, OF_ANOTHER])
def test_by_success_a_unit_with_what_is_asked_for_is_proved_the_best(asked: Settings, tmp_path: Path) -> None:
    problem = near_stew(tmp_path, ("wave", "bones", "waved"), rates=RATES)
    found = answer_under_rules(problem, BY_SUCCESS, asked)
    assert found.costs is not None
    whole = solve(replace(problem.whole, origin=None), BY_SUCCESS, asked)
    assert (found.status, found.costs) == (Status.OPTIMAL, whole.costs)
    problem = near_stew(tmp_path, ("wave", "bones", "waved"), rates=RATES)
    near = solve_nearby_under(problem, BY_SUCCESS, asked, Reporter())
    assert asked is OF_ANOTHER or (near is not None and near.status is Status.OPTIMAL)


def test_by_success_a_tree_that_was_not_read_to_its_end_may_be_better(tmp_path: Path) -> None:
    """The wave near the goal is 0.92 * 0.51 with what was not read, and one to spare 0.92 * 0.5."""
    long = [*LONG[:-1], ("wave", "stock 11", "stew")]
    rates = RATES.replace("cook 10\t1", "cook 10\t0.51")
    more = ("wave", "bones", "waved")
    problem = near_stew(tmp_path, more, first=6, long=long, rates=rates)
    found = answer_under_rules(problem, BY_SUCCESS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.success) == (Status.OPTIMAL, Fraction("0.4692"))


WIDE = (
    ("join", "left+right+top", "stew"),
    ("wave", "bones", "left"),
    ("cut", "bones", "right"),
    ("dice", "bones", "top"),
)


def test_what_units_that_were_not_read_make_may_lead_to_a_better_tree(tmp_path: Path) -> None:
    """The tree of what is read at first has four units, and the best one three, of which one is open."""
    problem = near_stew(tmp_path, *WIDE, ("wave", "water", "boiled"), first=8)
    near = asked(problem)
    assert len(solve(near.problem, UNITS, WAVE).units or ()) == 4
    found = answer_under_rules(near_stew(tmp_path, *WIDE, ("wave", "water", "boiled"), first=8), UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units) == (Status.OPTIMAL, 3)


def test_what_rules_ask_for_may_be_far(tmp_path: Path) -> None:
    problem = near_stew(tmp_path, ("wave", "plated", "waved"), first=1)
    found = answer_under_rules(problem, UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units, read_little(problem)) == (Status.OPTIMAL, 4, True)


def test_a_unit_near_the_goals_may_be_cheaper_by_a_way_that_leads_to_none(tmp_path: Path) -> None:
    """The wave of x is on a way to the goal that is long, and 4 soaks are the cheapest way to x.

    With the soaks, that way is longer than the tree found first, which waves what 5 cuts give.
    """
    more = [(f"press {n}", "bones", f"part {n}") for n in range(5)]
    more += [("knead", "+".join(f"part {n}" for n in range(5)), "x")]
    more += [("soak", "bones", "s0"), ("soak", "s0", "s1"), ("soak", "s1", "s2"), ("soak", "s2", "x")]
    more += [
        ("wave", "x", "z0"),
        *((f"keep {n}", f"z{n}", f"z{n + 1}") for n in range(5)),
        ("end", "z5", "stew"),
    ]
    more += [(f"cut {n}", "water", f"cut {n}") for n in range(5)]
    more += [("wave", "+".join(f"cut {n}" for n in range(5)), "waved")]
    problem = near_stew(tmp_path, *more)
    found = answer_under_rules(problem, UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units, read_little(problem)) == (Status.OPTIMAL, 8, True)


@pytest.mark.parametrize(
    ("unit", "asked"),
    [
        (("stir", "boiled", "waved"), WAVE),
        (("wave", "nothing", "waved"), WAVE),
        (("wave", "boiled+waved", "waved"), LABEL),
    ],
)
def test_what_no_unit_has_that_can_execute_is_known_at_once(
    unit: tuple[str, str, str], asked: Settings, tmp_path: Path
) -> None:
    problem = near_stew(tmp_path, unit, first=1)
    assert (answer_under_rules(problem, UNITS, asked).status, read_little(problem)) == (
        Status.INFEASIBLE,
        True,
    )


@pytest.mark.parametrize("how", ["when", "or"])
def test_what_rules_ask_for_in_some_networks_may_be_missing(how: str, tmp_path: Path) -> None:
    text = {
        "when": ':- goal(O), label(O,"soup"), not use(U) : motion(U,"wave").',
        "or": ':- not goal(O) : label(O,"stew"); not use(U) : motion(U,"wave").',
    }[how]
    found = answer_under_rules(near_stew(tmp_path, first=1), UNITS, Settings((RuleText(text),)))
    assert found.costs is not None
    assert (found.status, found.costs.units) == (Status.OPTIMAL, 3)


@pytest.mark.parametrize(
    ("text", "near"),
    [
        (':- not use(U) : motion(U,"wave").', True),
        (':- use(U), needs(U,O), kitchen(O), motion(U,"wave").', True),  # of trees alone
        (":- use(U), motion(U,M), #count { V : motion(V,M) } > 9.", False),  # of units that were not read
    ],
)
def test_rules_that_see_beyond_a_tree_read_all(text: str, near: bool, tmp_path: Path) -> None:
    problem = near_stew(tmp_path, ("wave", "boiled", "plated"))
    how = Settings((RuleText(text),))
    assert (reach_of_rules(how) is not ReachOfRules.ALL) is near
    assert (solve_nearby_under(problem, UNITS, how, Reporter()) is not None) is near


def stopped_at(times: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the question about what was read stop at a limit, after some times."""
    given: list[Outcome] = []

    def stopping(*asked: object) -> Outcome:
        given.append(solve(*asked))  # type: ignore[arg-type]
        if len(given) <= times:
            return given[-1]
        stopped = given[-1]._replace(status=Status.UNKNOWN, proof=None, stopped="a limit", bounds={})
        return stopped._replace(units=None, costs=None)

    monkeypatch.setattr(nearby_under_rules, "solve", stopping)


@pytest.mark.parametrize(("times", "status", "units"), [(0, Status.UNKNOWN, None), (1, Status.FEASIBLE, 4)])
def test_a_limit_gives_the_tree_and_the_bound(
    times: int, status: Status, units: int | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = near_stew(tmp_path, *SLOW, ("wave", "boiled", "waved"))
    stopped_at(times, monkeypatch)
    found = answer_under_rules(problem, UNITS, WAVE)
    assert (found.status, found.stopped, found.proof) == (status, "a limit", None)
    assert (found.costs and found.costs.units, found.outcome.bounds) == (units, {Objective.UNITS: 3})
    assert read_little(problem)


def test_a_limit_while_more_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*asked: object) -> None:
        raise LimitError(Deadline(0))

    more = *SLOW, ("wave", "boiled", "waved")
    with monkeypatch.context() as patched:
        patched.setattr(UnitDistances, "relevant_units", stopped)
        found = answer_under_rules(near_stew(tmp_path, *more), UNITS, WAVE)
        assert found.costs is not None
        assert (found.status, found.costs.units, found.outcome.bounds) == (
            Status.FEASIBLE,
            4,
            {Objective.UNITS: 3},
        )
        assert found.stopped
    with monkeypatch.context() as patched:  # where what is elsewhere cannot be told, the rest is read
        patched.setattr(nearby_under_rules, "NEARBY", NEARBY._replace(max_units=-1))
        again = answer_under_rules(near_stew(tmp_path, *more), UNITS, WAVE)
        assert (again.status, again.costs) == (Status.OPTIMAL, found.costs)
        patched.setattr("foon_asp.questions.answer._answer_with_reading", stopped)
        again = answer_under_rules(near_stew(tmp_path, *more), UNITS, WAVE)
        assert (again.status, again.costs, bool(again.stopped)) == (Status.FEASIBLE, found.costs, True)
        with pytest.raises(LimitError):
            answer_under_rules(near_stew(tmp_path, *more), UNITS, OF_ANOTHER)


def test_ctrl_c_keeps_the_tree_and_the_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*asked: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(UnitDistances, "relevant_units", interrupted)
    found = answer_under_rules(near_stew(tmp_path, *SLOW, ("wave", "boiled", "waved")), UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units, found.outcome.bounds) == (
        Status.FEASIBLE,
        4,
        {Objective.UNITS: 3},
    )
    assert found.stopped == "ctrl-C while reading"


def test_a_goal_that_few_units_lead_to_reads_no_others(tmp_path: Path) -> None:
    others = [("turn", f"other {n}", f"other {n + 1}") for n in range(40)]
    more = ("wave", "water", "waved"), ("start", "bones", "other 0"), *others
    problem = near_stew(tmp_path, *more, first=100)
    found = answer_under_rules(problem, UNITS, WAVE)
    assert found.costs is not None
    assert (found.status, found.costs.units, read_little(problem)) == (Status.OPTIMAL, 4, True)
    assert len(found.problem.network) < 10


def test_a_limit_before_the_best_tree_without_rules_gives_its_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*asked: object) -> Outcome:
        found = solve(*asked)  # type: ignore[arg-type]
        return found._replace(status=Status.FEASIBLE, proof=None, stopped="a limit")

    problem = near_stew(tmp_path, *SLOW, first=9)
    monkeypatch.setattr("foon_asp.dataset.nearby_optimum.solve", stopped)
    found = answer_under_rules(problem, UNITS, WAVE)
    assert (found.status, found.units, found.costs, found.stopped) == (Status.UNKNOWN, None, None, "a limit")
    assert found.outcome.bounds == {Objective.UNITS: 3}


def random_ways(rng: random.Random) -> list[tuple[str, str, str]]:
    """Return two ways to what a wave needs, one of which looks as cheap as its longest branch.

    What the wave gives leads to the stew by a long way; another wave needs many things, each close by.
    """

    def fan(name: str, item: str) -> tuple[list[tuple[str, str, str]], str]:
        parts = [f"{name} {n}" for n in range(rng.randint(3, 7))]
        return [("cut", item, part) for part in parts], "+".join(parts)

    def chain(*nodes: str) -> list[tuple[str, str, str]]:
        return [("heat", *pair) for pair in pairwise(nodes)]

    parts, all_parts = fan("part", "bones")
    others, all_others = fan("other", "water")
    soaks = [f"soaked {n}" for n in range(rng.randint(1, 5))]
    later = [f"kept {n}" for n in range(rng.randint(1, 8))]
    more = [*parts, ("knead", all_parts, "x"), *chain("bones", *soaks, "x"), ("wave", "x", "waved")]
    more += [*chain("waved", *later, "stew"), *others, ("wave", all_others, "waved too")]
    if rng.random() < 0.3:
        more.append(("turn", rng.choice(soaks), rng.choice(later)))
    return more


@pytest.mark.slow
@SERIES
def test_random_ways_to_what_rules_ask_for(
    part: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(nearby_under_rules, "NEARBY", NEARBY._replace(widths=((1, 0),)))
    proved = 0
    for seed in range(100 if part == 1 else 30):
        rng = random.Random(seed)
        ways, first = random_ways(rng), rng.choice((1, 4, 20))
        varied = ("cut", "heat", "wave", "knead", "turn")
        rates = RATES.replace("wave\t0.92\n", "") + "".join(
            f"{motion}\t{rng.choice((0.5, 0.9, 1))}\n" for motion in varied
        )
        objectives = rng.choice((UNITS, BY_SUCCESS, (Objective.UNITS, Objective.SUCCESS)))
        problem = near_stew(tmp_path, *ways, first=first, rates=rates)
        near = solve_nearby_under(problem, objectives, WAVE, Reporter())
        expected = solve(replace(problem.whole, origin=None), objectives, WAVE)
        assert expected.costs is not None
        if near is not None and near.status is Status.OPTIMAL:
            assert near.costs is not None
            assert near.costs.key(levels(objectives)) == expected.costs.key(levels(objectives)), seed
            proved += 1
    assert proved > 10


@SERIES
def test_random_problems_under_rules(part: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    compared = little = far = 0
    for seed in range(60 if part == 1 else 10):
        rng = random.Random(seed)
        rule = rng.choice(list(ContainerRule))
        problem = replace(random_problem(seed, rule, units=14, readable=True), unit_prices=None)
        asking, *others = (random_rule(rng, problem) for _ in range(rng.choice((1, 1, 2))))
        while hold_for_subtrees(settings_of([asking])):
            asking = random_rule(rng, problem)
        how = settings_of([*{each["rule"]: each for each in (*others, asking)}.values()])
        dataset = stored(problem, tmp_path)
        objectives = rng.choice(LISTS)
        order = levels(objectives)
        posed = dataset.nearby(problem.goals, rule.value, units_at_first=1)
        if not isinstance(posed, NearbyProblem):
            continue
        # a poor first tree, and little that may be read besides: without these, all is found near
        widths = rng.choice((((1, 0),), ((100, 0), (100, 6))))
        tuning = NEARBY._replace(widths=widths, max_units=rng.choice((0, 2, 30_000, 30_000)))
        monkeypatch.setattr(nearby_under_rules, "NEARBY", tuning)
        near = solve_nearby_under(posed, objectives, how, Reporter())
        found: Answer = answer_under_rules(posed, objectives, how)
        expected = solve(dataset.problem(problem.goals, rule.value, everything=True), objectives, how)
        assert_same(found.outcome, expected, objectives, seed)
        compared += 1
        far += found.units is not None and (near is None or near.status is not Status.OPTIMAL)
        if near is not None and near.costs is not None:
            assert expected.costs is not None
            little += near.status is Status.OPTIMAL
            measured = expected.costs.measure(order[0])
            bound = near.bounds[order[0]]
            assert bound >= measured if order[0].row.multiplies else bound <= measured
    assert compared > 20 // part
    assert min(little, far) > compared // 10 or part > 1
