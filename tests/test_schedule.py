"""Schedules: shortest by brute force, played through by what knows no solver, and refused in words."""

import importlib.util
import random
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from rich.console import Console

import foon_asp
from foon_asp import Duration, FunctionalUnit, Problem, Source, TimedStep, Tool, UserError, parse_node
from foon_asp.deadline import Deadline
from foon_asp.planning import scheduling
from foon_asp.planning.schedule_task import ScheduleTask, Use, schedule_task
from foon_asp.planning.scheduling import _length, shortest, timed_steps
from foon_asp.problem import ContainerRule, UsedUp
from foon_asp.proof.replay import replay_for, waits
from foon_asp.proof.timetable import Asked, Means, timetable_fault, tools_asked
from foon_asp.report.gantt import Gantt, GanttRow, ShownGantt, gantt_lines, time_text
from foon_asp.report.robot_steps import replayable
from foon_asp.text.clip_times import median_clips
from foon_asp.text.diagnostics import InputError
from foon_asp.text.duration_list import read_durations
from foon_asp.text.tool_list import read_tools
from tests.conftest import ROOT, Cli
from tests.schedule_oracle import least_time
from tests.used_up_oracle import random_problem

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

each_case = pytest.mark.sampled(1)  # of those that take a millisecond
needs_solver = pytest.mark.skipif(
    importlib.util.find_spec("ortools") is None, reason="OR-Tools is not installed (foon-asp[schedule])"
)
KITCHEN = ROOT / "data" / "kitchen"


def kitchen(units: Sequence[str], at_hand: Sequence[str], utensils: str = "bowl,knife") -> Problem:
    """Give a problem in which items are used up; a unit is written ``motion: input + input > output``."""
    builder = foon_asp.NetworkBuilder()
    for number, unit in enumerate(units, 1):
        motion, _, rest = unit.partition(":")
        inputs, outputs = ([parse_node(each.strip()) for each in side.split("+")] for side in rest.split(">"))
        builder.add(motion, inputs, outputs, Source("by hand", number))
    network = builder.build()
    goal = [o for o in network.outputs[-1] if o not in network.inputs[-1]][:1]
    there = frozenset(o for node in at_hand if (o := network.object_id(parse_node(node))) is not None)
    labels = frozenset(utensils.split(","))
    return Problem(network, there, tuple(goal), None, labels, items=UsedUp())


def plan_of(problem: Problem) -> list[FunctionalUnit]:
    return [problem.network.unit(unit) for unit in range(len(problem.network))]


def task_of(
    problem: Problem, durations: Mapping[str, Any], agents: int = 9, tools: Any = None
) -> ScheduleTask:
    plan = plan_of(problem)
    replay = replay_for(problem, plan)
    assert replay.shortage is None
    means = Means({m: Duration(Fraction(d)) for m, d in durations.items()}, agents, tools or {})
    return schedule_task(problem, plan, replay, means)


# --- Which tools steps hold, and for how long.

SALT_AND_EGG = (
    "salt: salt + bowl; empty > bowl; contains {salt}",
    "crack: egg + bowl; empty > bowl; contains {egg}",
    "pour: bowl; contains {salt} + bowl; contains {egg} > bowl; contains {egg,salt} + bowl; empty",
)
TWO_CUTS = (
    "rinse: knife; dirty > knife; clean",
    "chop: onion + knife; clean > onion; chopped + knife; dirty",
    "rinse: knife; dirty > knife; clean",
    "chop: leek + knife; clean > leek; chopped + knife; dirty",
)


def test_a_vessel_is_held_while_there_is_something_in_it_that_is_needed() -> None:
    task = task_of(kitchen(SALT_AND_EGG, ["salt", "egg", "bowl; empty"]), {"salt": 1, "crack": 2, "pour": 3})
    assert task.uses == (Use("bowl", (0, 2)), Use("bowl", (1, 2)))
    assert task.counts == {"bowl": 1}
    assert task.after == (frozenset(), frozenset(), frozenset({0, 1}))


def test_a_knife_is_held_from_the_sink_to_the_cut() -> None:
    builder = ["knife; dirty", "onion", "leek"]
    units = [*TWO_CUTS[:2], TWO_CUTS[3]]
    problem = kitchen(units, builder)
    plan = [problem.network.unit(u) for u in (0, 1, 0, 2)]
    replay = replay_for(problem, plan)
    assert replay.shortage is None
    means = Means({"rinse": Duration(15), "chop": Duration(40)}, 2, {})
    task = schedule_task(problem, plan, replay, means)
    assert task.uses == (Use("knife", (0, 1)), Use("knife", (2, 3)))


def test_a_board_that_is_not_listed_is_the_one_that_the_thing_is_on() -> None:
    units = (
        "place: tomato + board; empty > tomato; on [board] + board; contains {tomato}",
        "slice: tomato; on [board] > tomato; sliced; on [board]",
        "slide: tomato; sliced; on [board] + board; contains {tomato} > salad + board; empty",
    )
    durations = {"place": 1, "slice": 1, "slide": 1}
    task = task_of(kitchen(units, ["tomato", "board; empty"], "board"), durations)
    assert task.uses == (Use("board", (0, 1, 2)),)


def test_a_jar_of_the_kitchen_is_counted_by_what_is_in_it() -> None:
    units = (
        "salt: soup + jar; contains {salt} > soup; salty + jar; contains {salt}",
        "spice: soup; salty + jar; contains {pepper} > soup; hot + jar; contains {pepper}",
        "close: jar > jar; closed",
    )
    at_hand = ["soup", "jar", "jar; contains {salt}", "jar; contains {pepper}"]
    problem = kitchen(units, at_hand, "jar")
    durations = {"salt": 1, "spice": 1, "close": 1}
    assert [str(use.name) for use in task_of(problem, durations).uses] == [
        "jar; contains {salt}",
        "jar; contains {pepper}",
        "jar",
    ]
    assert task_of(problem, durations, tools={"jar": 2}).counts == {"jar": 2}
    assert task_of(problem, durations, tools={"jar": None}).uses == ()


def test_what_never_runs_out_is_not_waited_for() -> None:
    units = ("look: egg + knife > egg; seen", "burn: knife + egg; seen > ash + knife; dirty")
    problem = kitchen(units, ["egg", "knife"])
    assert [*waits(replay_for(problem, plan_of(problem)))] == [set(), {0}]  # for the egg, not for the knife
    units = ("look: lamp > lamp + egg", "burn: lamp > ash")
    endless = kitchen(units, ["lamp"])
    assert [*waits(replay_for(endless, plan_of(endless)))] == [set(), set()]
    for copies, expected in ((1, {0}), (2, {0})):
        stocked = UsedUp({}, {parse_node("lamp"): copies})
        problem = Problem(endless.network, endless.kitchen, endless.goals, None, frozenset(), items=stocked)
        assert [*waits(replay_for(problem, plan_of(problem)))] == [set(), expected]
        twice = [*plan_of(problem), problem.network.unit(1)][: copies + 1]
        assert [*waits(replay_for(problem, twice))] == [set(), expected, set()][: copies + 1]


# --- What holds, found by what knows no solver.

BOWLS = [Tool("bowl", 1), Tool("bowl", 2)]
EGG_DURATIONS = {"salt": Duration(10), "crack": Duration(20), "pour": Duration(30, passive=True)}


def seconds(start: int, end: int, agent: int | None, *tools: Tool) -> TimedStep:
    return TimedStep(Fraction(start), Fraction(end), agent, tools)


GOOD = [seconds(0, 10, 1, BOWLS[0]), seconds(0, 20, 2, BOWLS[1]), seconds(20, 50, None, *BOWLS)]


@each_case
@pytest.mark.parametrize(
    ("changed", "fault"),
    [
        ({}, None),
        (
            {
                0: seconds(5, 15, 1, BOWLS[1]),
                1: seconds(15, 35, 1, BOWLS[0]),
                2: seconds(35, 65, None, *BOWLS),
            },
            None,
        ),
        ({0: seconds(0, 11, 1, BOWLS[0])}, "step 1 does not take the time that salt takes"),
        ({0: seconds(-1, 9, 1, BOWLS[0])}, "step 1 does not take the time"),
        ({2: seconds(20, 50, 1, *BOWLS)}, "step 3 is done by nobody, or by somebody"),
        ({0: seconds(0, 10, None, BOWLS[0])}, "step 1 is done by nobody"),
        ({0: seconds(0, 10, 3, BOWLS[0])}, "step 1 is done by agent 3, and there are 2"),
        ({0: seconds(0, 10, 0, BOWLS[0])}, "step 1 is done by agent 0, and there are 2"),
        ({0: seconds(0, 10, 2, BOWLS[0])}, r"step 2 \(crack\) waits for 2, which is at step 1"),
        ({0: seconds(0, 10, 1, BOWLS[1])}, r"step 2 \(crack\) waits for bowl 2, which is at step 1"),
        ({2: seconds(19, 49, None, *BOWLS)}, r"step 3 \(pour\) waits for bowl 2"),
        ({2: seconds(20, 50, None, BOWLS[0])}, "has 1 of bowl, and asks for 2"),
        ({0: seconds(0, 10, 1)}, "has 0 of bowl, and asks for 1"),
        ({0: seconds(0, 10, 1, Tool("bowl", 3))}, "has bowl 3, and there are 2"),
        ({0: seconds(0, 10, 1, Tool("bowl", 0))}, "has bowl 0, and there are 2"),
        ({0: seconds(0, 10, 1, BOWLS[0], Tool("knife", 1))}, "has 1 of knife, and asks for 0"),
        ({0: seconds(20, 30, 1, BOWLS[1])}, "waits for bowl 2"),
        (
            {0: seconds(20, 30, 1, BOWLS[1]), 2: seconds(30, 60, None, *BOWLS)},
            "has no bowl for bowl; contains {egg}",
        ),
        ({2: seconds(20, 50, None, BOWLS[0], BOWLS[0])}, "has the same tool twice"),
    ],
)
def test_a_schedule_is_played_through(changed: dict[int, TimedStep], fault: str | None) -> None:
    problem = kitchen(SALT_AND_EGG, ["salt", "egg", "bowl; empty"])
    steps = [changed.get(step, timed) for step, timed in enumerate(GOOD)]
    found = timetable_fault(problem, plan_of(problem), steps, Means(EGG_DURATIONS, 2, {"bowl": 2}))
    assert (found is None) == (fault is None), found
    assert re.search(fault or "", found or ""), found


@each_case
@pytest.mark.parametrize(
    ("starts", "fault"),
    [
        ((0, 10, 20), None),
        ((0, 9, 20), r"step 2 \(look\) lacks a copy of egg; hard"),
        ((0, 10, 19), r"step 3 \(eat\) lacks a copy of egg; hard"),  # while somebody looks at it
        ((0, 20, 10), r"step 2 \(look\) lacks a copy of egg; hard"),
    ],
)
def test_copies_are_there_when_they_are_taken(starts: tuple[int, ...], fault: str | None) -> None:
    units = ("boil: egg > egg; hard", "look: egg; hard > egg; hard + view", "eat: egg; hard > shell")
    problem = kitchen(units, ["egg"])
    means = Means({motion: Duration(10) for motion in ("boil", "look", "eat")}, 3, {})
    steps = [seconds(start, start + 10, agent) for agent, start in enumerate(starts, 1)]
    found = timetable_fault(problem, plan_of(problem), steps, means)
    assert (found is None) == (fault is None), found
    assert re.search(fault or "", found or "")


def test_a_schedule_of_other_steps_does_not_hold() -> None:
    problem = kitchen(SALT_AND_EGG, ["salt", "egg", "bowl; empty"])
    found = timetable_fault(problem, plan_of(problem), GOOD[:2], Means(EGG_DURATIONS, 2, {"bowl": 2}))
    assert found == "there are 3 steps, and times for 2"


@each_case
@pytest.mark.parametrize(
    ("plan", "starts", "holds"),
    [
        # boil is 0, look 1, eat 2, and stir 3, which takes a boiled egg and water, of which there is enough
        ((0, 1, 1, 2), (0, 10, 20, 30), True),
        ((0, 1, 1, 2), (0, 10, 20, 25), False),
        ((0, 0, 2, 1, 2), (0, 0, 10, 20, 30), True),
        ((0, 0, 2, 1, 2), (0, 0, 10, 20, 25), False),
        ((0, 0, 2, 2), (0, 0, 10, 10), True),
        ((0, 2, 2), (0, 10, 20), False),
        ((0, 3), (0, 10), True),
        ((0, 3), (0, 9), False),
        ((2, 0), (0, 10), False),  # the stock has an egg that is not in the kitchen
    ],
)
def test_no_copy_is_taken_that_is_gone_or_looked_at(
    plan: tuple[int, ...], starts: tuple[int, ...], holds: bool
) -> None:
    units = (
        *("boil: egg > egg; hard", "look: egg; hard > egg; hard + view", "eat: egg; hard > shell"),
        "stir: water + egg; hard > salad",
    )
    problem = replace(kitchen(units, ["egg", "water"]), items=UsedUp({}, {parse_node("egg; hard"): 1}))
    means = Means({motion: Duration(10) for motion in ("boil", "look", "eat", "stir")}, 9, {})
    steps = [seconds(start, start + 10, agent) for agent, start in enumerate(starts, 1)]
    found = timetable_fault(problem, [problem.network.unit(unit) for unit in plan], steps, means)
    assert found is None if holds else found is not None and "lacks a copy of egg; hard" in found


@each_case
@pytest.mark.parametrize(("bowl", "fault"), [(2, None), (1, "has no bowl for bowl; contains {egg}")])
def test_what_was_in_a_bowl_is_gone(bowl: int, fault: str | None) -> None:
    units = (
        *("crack: egg + bowl; empty > bowl; contains {egg}", "wash: bowl; contains {egg} > bowl; empty"),
        "bake: bowl; contains {egg} > cake",
    )
    problem = kitchen(units, ["egg", "bowl; empty"])
    plan = [problem.network.unit(unit) for unit in (0, 1, 0, 2)]
    means = Means({motion: Duration(10) for motion in ("crack", "wash", "bake")}, 1, {"bowl": 2})
    used = (1, 1, 2, bowl)
    steps = [seconds(10 * n, 10 * n + 10, 1, Tool("bowl", number)) for n, number in enumerate(used)]
    found = timetable_fault(problem, plan, steps, means)
    assert (found is None) == (fault is None), found
    assert (fault or "") in (found or "")


def test_a_bowl_that_nothing_says_the_contents_of_is_any() -> None:
    """One that something is put into is not listed; one that was skipped need not have been filled."""
    units = ("put: egg > egg; in [bowl]", "stir: egg; in [bowl] + bowl; contains {egg} > dough")
    problem = replace(kitchen(units, ["egg"]), containers=ContainerRule.IMPLIED)
    means = Means({"put": Duration(10), "stir": Duration(10)}, 1, {})
    steps = [seconds(0, 10, 1, BOWLS[0]), seconds(10, 20, 1, BOWLS[0])]
    assert timetable_fault(problem, plan_of(problem), steps, means) is None
    assert timetable_fault(problem, plan_of(problem), [steps[0], seconds(10, 20, 1)], means) is not None


def test_what_is_in_a_bowl_stays_when_something_else_is_put_into_it() -> None:
    units = (
        *("put: egg > egg; in [bowl]", "season: salt > salt; in [bowl]"),
        "stir: egg; in [bowl] + salt; in [bowl] > dough",
    )
    problem = kitchen(units, ["egg", "salt"])
    means = Means({motion: Duration(10) for motion in ("put", "season", "stir")}, 1, {"bowl": 2})
    steps = [seconds(10 * n, 10 * n + 10, 1, BOWLS[0]) for n in range(3)]
    assert timetable_fault(problem, plan_of(problem), steps, means) is None


def test_how_many_tools_a_unit_asks_for() -> None:
    knife, clean, dirty = map(parse_node, ("knife", "knife; clean", "knife; dirty"))
    assert Asked((), (), (), ()).number == 0
    assert Asked((knife,), (clean,), (), (None,)).number == 3
    assert Asked((knife,), (clean,), (dirty, knife, clean), (None,)).number == 4
    problem = kitchen(("press: olive > oil", "grate: cheese; on [board] + oil > dish"), ["olive"], "board")
    cheese, means = parse_node("cheese; on [board]"), Means({}, 1, {})
    (asked,) = tools_asked(problem, means, problem.network.unit(1)).items()
    assert asked == ("board", Asked((), (), (), (cheese,)))


def test_what_tools_are_counted_by_and_how_many_there_are() -> None:
    jar, salt, bowl = map(parse_node, ("jar; contains {salt}", "salt; in [jar]", "bowl; empty"))
    problem = kitchen(SALT_AND_EGG, ["salt", "egg", "bowl; empty"])
    free, said = Means({}, 1, {}), Means({}, 1, {jar: 2})
    assert free.name(jar, "jar") == free.name(salt, "jar") == jar
    assert free.name(bowl, "bowl") == "bowl"
    assert said.name(jar, "jar") is jar
    labelled = parse_node("jar; full; contains {salt}")
    assert Means({}, 1, {labelled: 2}).name(labelled, "jar") is labelled
    assert [said.waited_for(problem, label) for label in ("jar", "bowl", "lamp")] == [True, True, False]
    assert said.number_of(problem, jar) == 2
    assert free.number_of(problem, "bowl") == free.number_of(replace(problem, items=None), "bowl") == 1
    stocked = replace(problem, items=UsedUp({}, {jar: 3, bowl: 2, parse_node("bowl; dirty"): 2}))
    assert [free.number_of(stocked, name) for name in ("bowl", jar, "knife")] == [4, 3, 1]


# --- The shortest.


def random_task(seed: int) -> ScheduleTask:
    choose = random.Random(seed)
    steps = range(choose.randint(1, 6))
    names = ("knife", "bowl")
    return ScheduleTask(
        Fraction(1, 3),
        tuple(choose.randint(1, 3) for _ in steps),
        tuple(choose.random() < 0.3 for _ in steps),
        tuple(frozenset(each for each in range(step) if choose.random() < 0.3) for step in steps),
        tuple(
            Use(
                choose.choice(names),
                tuple(sorted(choose.sample(steps, choose.randint(1, min(3, len(steps)))))),
            )
            for _ in range(choose.randint(0, 4))
        ),
        {name: choose.randint(1, 2) for name in names},
        choose.randint(1, 3),
    )


@pytest.mark.slow
@needs_solver
@pytest.mark.parametrize("seeds", [range(30), pytest.param(range(30, 1000), marks=pytest.mark.slow)], ids=str)
def test_nothing_is_shorter_by_brute_force(seeds: range) -> None:
    without = 0
    for seed in seeds:
        task = random_task(seed)
        found, least = shortest(task, Deadline()), least_time(task)
        assert found.proved
        assert (found.starts is None) == (least is None), seed
        if found.starts is None:
            without += 1
            assert least_time(task._replace(counts=task.counts | found.lacking)) is not None
            for name, needed in found.lacking.items():  # and no fewer do
                counts = task.counts | found.lacking | {name: needed - 1}
                assert least_time(task._replace(counts=counts)) is None
        else:
            assert max(step.end for step in timed_steps(task, found.starts)) * 3 == least == found.bound
            assert task.bound <= found.bound
    assert 0 < without < len(seeds) / 2


def random_plan(problem: Problem, choose: random.Random) -> list[FunctionalUnit]:
    """Give a plan of up to nine steps that run one after the other."""
    plan: list[FunctionalUnit] = []
    for _ in range(30):
        unit = problem.network.unit(choose.randrange(len(problem.network)))
        if len(plan) < 9 and len(replay_for(problem, [*plan, unit]).steps) > len(plan):
            plan.append(unit)
    return plan


@needs_solver
@pytest.mark.parametrize("seeds", [range(25), pytest.param(range(25, 400), marks=pytest.mark.slow)], ids=str)
def test_schedules_of_random_plans_hold(seeds: range) -> None:
    held = 0
    for seed in seeds:
        choose = random.Random(seed)
        problem = random_problem(seed)
        if choose.random() < 0.3:
            problem = replayable(replace(problem, items=None), plan_of(problem))
        plan = random_plan(problem, choose)
        lengths = {motion: Duration(choose.randint(1, 4), choose.random() < 0.3) for motion in "abcd"}
        tools: dict[Any, int | None] = {"bowl": choose.choice((1, 2, None)), "knife": 2}
        means = Means(lengths, choose.randint(1, 3), {} if choose.random() < 0.3 else tools)
        task = schedule_task(problem, plan, replay_for(problem, plan), means)
        found = shortest(task, Deadline())
        if found.starts is None:
            assert found.lacking
            continue
        assert timetable_fault(problem, plan, timed_steps(task, found.starts), means) is None, seed
        held += len(plan) > 1
    assert held > len(seeds) / 5


@needs_solver
def test_at_a_limit_the_best_is_given_with_its_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    task = random_task(4)

    def answers(*_: object) -> Iterator[tuple[str, object]]:
        yield "found", [3 * number for number in range(len(task.lengths))]
        yield "bound", 5.0
        raise KeyboardInterrupt

    monkeypatch.setattr(scheduling._CpSat, "ask", answers)
    deadline = Deadline()
    found = shortest(task, deadline)
    assert deadline.stopped == "ctrl-C while scheduling"
    assert found.starts == tuple(3 * number for number in range(len(task.lengths)))
    assert not found.proved
    assert found.bound == max(5, task.bound)


@needs_solver
def test_there_is_always_a_schedule_or_a_proof_that_there_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> Iterator[tuple[str, object]]:
        raise KeyboardInterrupt

    monkeypatch.setattr(scheduling, "_idle", [])
    monkeypatch.setattr(scheduling, "_CpSat", lambda: SimpleNamespace(ask=interrupted, end=lambda: None))
    kinds = set()
    for seed in range(60):
        task = random_task(seed)
        found = shortest(task, Deadline())
        kinds.add((found.starts is None, found.proved))
        least = least_time(task)
        if found.starts is None:
            assert least is None
            enough = task.counts | found.lacking
            assert least_time(task._replace(counts=enough)) is not None
            for name in found.lacking:
                assert least_time(task._replace(counts={**enough, name: enough[name] - 1})) is None
        else:
            assert least is not None
            assert found.bound <= least <= _length(task, found.starts) <= sum(task.lengths)
            assert least == _length(task, found.starts) or not found.proved
    assert kinds == {(True, True), (False, False), (False, True)}


@needs_solver
def test_without_an_order_one_step_is_done_after_the_other(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(scheduling, "tool_order", interrupted)
    kinds = set()
    for seed in range(60):
        task = random_task(seed)
        found = shortest(task, Deadline())
        kinds.add(found.starts is None)
        assert not found.proved
        if found.starts is None:
            assert least_time(task._replace(counts=task.counts | found.lacking)) is not None
        else:
            assert found.bound <= (least_time(task) or 0) <= _length(task, found.starts)
    assert kinds == {True, False}


# --- As it is asked for.

ICE: dict[str, Any] = {"twist": "10", "crush": 0.5}


@pytest.mark.slow
@needs_solver
def test_the_bundled_kitchen(cli: Cli, tmp_path: Path) -> None:
    plan = tmp_path / "plan.json"
    plan.write_text(cli("solve", "--goal", "greek salad", "--items", "used-up", "--format", "json").out)
    files = ("--durations", KITCHEN / "durations.txt", "--tools", KITCHEN / "tools.txt")
    ran = cli("schedule", plan, *files, "--agents", "2", "--format", "json")
    assert (ran.code, ran.json["status"], ran.json["items"]) == (0, "optimal", "used-up")
    assert ran.json["makespan"]["exact"] == ran.json["lower_bound"]["exact"] == "290"
    assert [step["step"] for step in ran.json["steps"]] == list(range(1, 34))
    foon = foon_asp.load()
    problem = foon.problem("greek salad", items="used-up")
    for agents, makespan in ((1, 540), (3, 290)):
        found = foon_asp.schedule(problem, plan, durations=files[1], tools=files[3], agents=agents)
        assert found.makespan == makespan
        # one knife is rinsed and used five times, and nobody else has it between
        knife = sorted((step.start, step.end) for step in found.timetable if Tool("knife", 1) in step.tools)
        assert len(knife) == 10
        assert all(end <= start for (_, end), (start, _) in pairwise(knife))


@needs_solver
def test_a_tree_is_put_in_order_and_an_oven_works_alone(tmp_path: Path) -> None:
    problem = foon_asp.load().problem("apple crumble")
    tree = foon_asp.solve(problem).tree
    assert tree is not None
    durations = read_durations(KITCHEN / "durations.txt")
    found = foon_asp.schedule(problem, tree.units[::-1], durations=durations)
    assert found.status is foon_asp.Status.OPTIMAL
    baked = [step for step, unit in zip(found.timetable, found.plan, strict=True) if unit.motion == "bake"]
    assert [step.agent for step in baked] == [None]
    preheat = next(t for t, unit in zip(found.timetable, found.plan, strict=True) if unit.motion == "preheat")
    assert any(step.start < preheat.end and step.agent for step in found.timetable)
    with pytest.raises(UserError, match="the plan does not run: step 1"):
        foon_asp.schedule(problem.vary(without="apple"), tree, durations=durations)


@needs_solver
def test_too_few_tools_are_named(cli: Cli, tmp_path: Path) -> None:
    problem = kitchen(SALT_AND_EGG, ["salt", "egg", "bowl; empty"])
    durations = {"salt": 1, "crack": 1, "pour": 1}
    found = foon_asp.schedule(problem, plan_of(problem), durations=durations)
    assert found.status is foon_asp.Status.INFEASIBLE
    assert (found.makespan, found.timetable, dict(found.lacking)) == (None, (), {"bowl": 2})
    assert "\n  bowl\t2" in found.text()
    again = foon_asp.schedule(problem, plan_of(problem), durations=durations, tools={"bowl": 2})
    assert again.makespan == 3


@needs_solver
def test_a_plan_without_steps_takes_no_time() -> None:
    problem = foon_asp.load().problem("tea").vary(kitchen="tea; hot; in [mug]")
    found = foon_asp.schedule(problem, ())
    assert found.makespan == 0
    assert not found.timetable
    assert found.status is foon_asp.Status.OPTIMAL


def test_durations_are_asked_for(cli: Cli, tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    plan.write_text(cli("solve", "--goal", "ice", "--format", "foon").out)
    ran = cli("schedule", plan)
    assert ran.code == 2
    assert "no duration is known of 2 motions of the plan" in ran.err
    assert "\n  twist\tSECONDS\n  crush\tSECONDS" in ran.err
    problem = foon_asp.load().problem("ice")
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"twist": 1}, "1 motion of the plan"),
        ({"twist": 0, "crush": 1}, "found the duration 0 of 'twist'"),
        ({"twist": "soon", "crush": 1}, "found 'soon' for the duration of 'twist'"),
        ({"twist": "1e-99", "crush": 1}, "too fine"),
    ]
    for durations, message in wrong:
        with pytest.raises(UserError, match=message):
            foon_asp.schedule(problem, plan, durations=durations)
    few: list[dict[Any, Any]] = [{"knife": 0}, {"knife": True}, {"": 1}]
    for tools in few:
        with pytest.raises(UserError):
            foon_asp.schedule(problem, plan, durations=ICE, tools=tools)
    with pytest.raises(UserError, match="found agents=0"):
        foon_asp.schedule(problem, plan, durations=ICE, agents=0)


def test_without_or_tools_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduling, "find_spec", lambda _: None)
    problem = foon_asp.load().problem("ice")
    with pytest.raises(UserError, match=r"OR-Tools: pip install 'foon-asp\[schedule\]'"):
        foon_asp.schedule(problem, foon_asp.solve(problem).tree or (), durations=ICE)


# --- The files.


def test_durations_and_tools_are_read(tmp_path: Path) -> None:
    file = tmp_path / "table.txt"
    file.write_text("# how long\nchop\t40\nbake\t1.5 h\tpassive\npour\t0.25 min\nwait\t3 s\n")
    assert read_durations(file) == {
        "chop": Duration(40),
        "bake": Duration(5400, passive=True),
        "pour": Duration(15),
        "wait": Duration(3),
    }
    file.write_text("knife\t2\nstove\tfree\nspice jar; contains {salt}\t3\n")
    assert read_tools(file) == {"knife": 2, "stove": None, parse_node("spice jar; contains {salt}"): 3}
    assert set(read_durations(KITCHEN / "durations.txt")) == set(foon_asp.load().dataset.rates or ())


@pytest.mark.parametrize(
    ("read", "line", "message"),
    [
        (read_durations, "chop 40", "expected a tab and a number of seconds"),
        (read_durations, "chop\t", "expected a number of seconds such as 90"),
        (read_durations, "chop\t0", "expected one above 0"),
        (read_durations, "chop\t5 days", "'days', expected s, min or h"),
        (read_durations, "chop\t5\tactive", "'active', expected passive"),
        (read_durations, "chop\t5\nchop\t6", "a second duration for 'chop'"),
        (read_durations, "\t5", "the motion before it"),
        (read_tools, "knife\t0", "'0', expected a number from 1 or free"),
        (read_tools, "knife\tmany", "'many', expected"),
        (read_tools, "knife\t1\nknife\tfree", "and something else above"),
    ],
)
def test_a_wrong_line_is_an_error(read: Any, line: str, message: str, tmp_path: Path) -> None:
    file = tmp_path / "table.txt"
    file.write_text(f"{line}\n")
    with pytest.raises(InputError, match=message):
        read(file)


def annotated(times: str) -> str:
    return f"O\tegg\nM\tboil\t{times}\nO\tegg\nS\thard\n//\n"


def test_clips_are_told_from_what_is_assumed(tmp_path: Path) -> None:
    file = tmp_path / "video.txt"
    clips = ("0:10\t0:20", "<1:00-1:04,2:00-2:04>", "<0:00:59,0:01:59>", "Assumed\tAssumed", "0:10\t0:10")
    file.write_text("//\n" + "".join(map(annotated, clips)))
    assert median_clips([file]) == {"boil": 10}  # of 10, 8 and 60 seconds


@needs_solver
def test_clips_stand_in_for_durations_with_a_warning(tmp_path: Path, cli: Cli) -> None:
    video, plan, mine = tmp_path / "video.txt", tmp_path / "plan.txt", tmp_path / "mine.txt"
    video.write_text("//\n" + annotated("0:10\t0:20"))
    plan.write_text("//\n" + annotated(""))
    named = ("schedule", plan, "--network", video, "--kitchen", tmp_path / "kitchen.txt", "--from-video")
    (tmp_path / "kitchen.txt").write_text("//\nO\tegg\n//\n")
    ran = cli(*named)
    assert ran.code == 0, ran.err
    assert (
        "warning: these durations are medians of clips, and not of what happens in them: boil 0:10" in ran.err
    )
    assert "shortest for 1 agent: 0:10, proved" in ran.out
    mine.write_text("boil\t8 min\n")
    ran = cli(*named, "--durations", mine)
    assert "medians" not in ran.err
    assert "shortest for 1 agent: 8:00, proved" in ran.out


# --- The charts.

ROWS = Gantt(
    "tea",
    (
        GanttRow(1, "fill", "kettle", Fraction(0), Fraction(10), 1),
        GanttRow(2, "boil", "water", Fraction(10), Fraction(190), None),
        GanttRow(3, "pick-and-place", "tea bag", Fraction(10), Fraction(15), 2),
        GanttRow(4, "pour", "mug of tea, which is hot", Fraction(190), Fraction(200), 12),
    ),
    Fraction(200),
)


@pytest.mark.parametrize("width", [60, 79, 132])
def test_the_chart_in_letters_is_as_wide_as_the_console(width: int) -> None:
    lines = [*gantt_lines(ROWS, width)]
    assert [len(line) for line in lines] == [width] * 5
    assert [line.split()[0] for line in lines] == ["step", "1", "3", "2", "4"]
    bars = [line.split()[-1] for line in lines[1:]]
    assert [set(bar) - {"."} for bar in bars] == [{"1"}, {"2"}, {"~"}, {"C"}]
    assert all("mug of tea" in line for line in lines[4:]) == (width > 79)
    console = Console(width=width, force_terminal=True, color_system=None)
    with console.capture() as printed:
        console.print(ShownGantt(["a title"], ROWS, ["an end"]))
    assert printed.get().split("\n") == ["a title", *lines, "an end", ""]


def test_a_chart_that_has_no_room_has_its_words() -> None:
    lines = [*gantt_lines(ROWS, 10)]
    assert all("pick-and-place" in line for line in lines[2:3])
    assert len({*map(len, lines)}) == 1
    assert [*gantt_lines(Gantt("nothing", (), Fraction(0)))] == []


@pytest.mark.parametrize(
    ("number", "text"),
    [
        ("0", "0:00"),
        ("61", "1:01"),
        ("3600", "1:00:00"),
        ("86399", "23:59:59"),
        ("1/3", "0:00.333"),
        ("59.9996", "1:00"),
        ("0.5", "0:00.5"),
    ],
)
def test_times_are_written_as_on_a_clock(number: str, text: str) -> None:
    assert time_text(Fraction(number)) == text


@needs_solver
@pytest.mark.parametrize("suffix", [".svg", ".png"])
def test_a_chart_is_written(suffix: str, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    problem = foon_asp.load().problem("ice")
    found = foon_asp.schedule(problem, foon_asp.solve(problem).tree or (), durations=ICE)
    chart = tmp_path / f"chart{suffix}"
    found.write_chart(chart)
    content = chart.read_bytes()
    assert content.startswith(b"\x89PNG") if suffix == ".png" else b"crush (ice)" in content
    with pytest.raises(UserError, match="no step"):
        replace(found, timetable=()).write_chart(chart)
