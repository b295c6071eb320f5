"""Schedules: shortest by brute force, played through by what knows no solver, and refused in words."""

import importlib.util
import random
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

import foon_asp
from foon_asp import Duration, FunctionalUnit, ObjectNode, Problem, UserError, parse_node
from foon_asp.deadline import Deadline, LimitError
from foon_asp.pictures.gantt import time_text
from foon_asp.planning import scheduling
from foon_asp.planning.schedule_task import ScheduleTask, Use, schedule_task
from foon_asp.planning.scheduling import shortest_schedule, timed_steps
from foon_asp.problem import ContainerRule, UsedUp
from foon_asp.processes.worker import Worker
from foon_asp.proof.replay import replay_for, replayable_problem
from foon_asp.proof.timetable import ScheduleResources, TimedStep, Tool, timetable_fault
from foon_asp.text.clip_times import median_clips
from foon_asp.text.diagnostics import InputError
from foon_asp.text.tables import DURATIONS, TOOLS
from tests.conftest import ROOT, Cli
from tests.oracle.schedules import least_time
from tests.oracle.used_up import random_problem
from tests.proof.by_hand import recipe

needs_solver = pytest.mark.skipif(
    importlib.util.find_spec("ortools") is None, reason="OR-Tools is not installed (foon-asp[schedule])"
)
KITCHEN = ROOT / "data" / "kitchen"


def kitchen(*units: str, there: str, utensils: str = "bowl knife", **more: Any) -> Problem:
    """Build a problem in which items are used up; a unit is written ``motion: input + input > output``."""
    return replace(recipe(*units, kitchen=there, utensils=utensils), **{"items": UsedUp(), **more})


def plan_of(problem: Problem) -> list[FunctionalUnit]:
    return [problem.network.unit(unit) for unit in range(len(problem.network))]


def means_of(problem: Problem, seconds: int = 10, agents: int = 9, tools: Any = None) -> ScheduleResources:
    """Return means by which every motion takes the same time."""
    return ScheduleResources(dict.fromkeys(problem.network.motions, Duration(seconds)), agents, tools or {})


def task_of(problem: Problem, *order: int, tools: Any = None) -> ScheduleTask:
    plan = [problem.network.unit(unit) for unit in order] or plan_of(problem)
    replay = replay_for(problem, plan)
    assert replay.shortage is None
    return schedule_task(problem, plan, replay, means_of(problem, tools=tools))


# --- Which tools steps hold, and for how long.

SALT_AND_EGG = (
    "salt: salt + bowl; empty > bowl; contains {salt}",
    "crack: egg + bowl; empty > bowl; contains {egg}",
    "pour: bowl; contains {salt} + bowl; contains {egg} > bowl; contains {egg,salt} + bowl; empty",
)
TWO_CUTS = (
    "rinse: knife; dirty > knife; clean",
    "chop: onion + knife; clean > onion; chopped + knife; dirty",
    "chop: leek + knife; clean > leek; chopped + knife; dirty",
)


EGGS = kitchen(*SALT_AND_EGG, there="salt + egg + bowl; empty")
CUTS = kitchen(*TWO_CUTS, there="knife; dirty + onion + leek")
LOOKS = kitchen(
    *("boil: egg > egg; hard", "look: egg; hard > egg; hard + view", "smell: egg; hard > egg; hard + air"),
    there="egg",
)
BOARD = kitchen(
    "place: tomato + board; empty > tomato; on [board] + board; contains {tomato}",
    "slice: tomato; on [board] > tomato; sliced; on [board]",
    "slide: tomato; sliced; on [board] + board; contains {tomato} > salad + board; empty",
    there="tomato + board; empty",
    utensils="board",
)
JARS = kitchen(
    "salt: soup + jar; contains {salt} > soup; salty + jar; contains {salt}",
    "spice: soup; salty + jar; contains {pepper} > soup; hot + jar; contains {pepper}",
    "close: jar > jar; closed",
    there="soup + jar + jar; contains {salt} + jar; contains {pepper}",
    utensils="jar",
)
SALT, PEPPER = "jar; contains {salt}", "jar; contains {pepper}"


@pytest.mark.parametrize(
    ("problem", "order", "uses"),
    [
        # a vessel while there is something in it that is needed
        (EGGS, (), [("bowl", (0, 2)), ("bowl", (1, 2))]),
        # a knife from the sink to the cut
        (CUTS, (0, 1, 0, 2), [("knife", (0, 1)), ("knife", (2, 3))]),
        # a board that is not listed is the one that the thing is on
        (BOARD, (), [("board", (0, 1, 2))]),
        # a jar of the kitchen is counted by what is in it
        (JARS, (), [(SALT, (0,)), (PEPPER, (1,)), ("jar", (2,))]),
    ],
)
def test_tools_are_held_as_long_as_they_are_needed(
    problem: Problem, order: tuple[int, ...], uses: list[tuple[str, tuple[int, ...]]]
) -> None:
    assert [(str(use.name), use.steps) for use in task_of(problem, *order).uses] == uses


def test_tools_are_counted() -> None:
    bowls = {parse_node("bowl; empty"): 2, parse_node("bowl; dirty"): 2}
    assert task_of(EGGS).counts == {"bowl": 1}
    assert task_of(replace(EGGS, items=UsedUp({}, bowls))).counts == {"bowl": 4}
    assert task_of(JARS, tools={"jar": 2}).counts == {"jar": 2}
    assert task_of(JARS, tools={"jar": None}).uses == ()
    assert task_of(JARS, tools={parse_node(SALT): 3}).counts == {
        parse_node(SALT): 3,
        parse_node(PEPPER): 1,
        "jar": 1,
    }


LAMP = ("look: lamp > lamp + egg", "burn: lamp > ash")


def test_what_never_runs_out_is_not_waited_for() -> None:
    units = ("look: egg + knife > egg; seen", "burn: knife + egg; seen > ash + knife; dirty")
    assert task_of(kitchen(*units, there="egg + knife")).after[1] == {0}  # for the egg, not for the knife
    assert task_of(kitchen(*LAMP, there="lamp", utensils="")).after == (frozenset(), frozenset())
    for copies in (1, 2):
        stock = UsedUp({}, {parse_node("lamp"): copies})
        stocked = kitchen(*LAMP, there="lamp", utensils="", items=stock)
        assert task_of(stocked, 0, *[1] * copies).after[:2] == (frozenset(), frozenset({0}))
    assert task_of(EGGS).after[2] == {0, 1}
    assert task_of(LOOKS).sharing == ((1, 2),)
    assert task_of(LOOKS, tools={"egg": None}).sharing == ()


# --- What holds, found by what knows no solver.

BOWLS = [Tool("bowl", 1), Tool("bowl", 2)]
EGG_DURATIONS = {"salt": Duration(10), "crack": Duration(20), "pour": Duration(30, passive=True)}
EGG_MEANS = ScheduleResources(EGG_DURATIONS, 2, {"bowl": 2})


def seconds(start: int, end: int, agent: int | None, *tools: Tool) -> TimedStep:
    return TimedStep(Fraction(start), Fraction(end), agent, tools)


GOOD = [seconds(0, 10, 1, BOWLS[0]), seconds(0, 20, 2, BOWLS[1]), seconds(20, 50, None, *BOWLS)]


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
    steps = [changed.get(step, timed) for step, timed in enumerate(GOOD)]
    found = timetable_fault(EGGS, plan_of(EGGS), steps, EGG_MEANS)
    assert (found is None) == (fault is None), found
    assert re.search(fault or "", found or ""), found
    assert timetable_fault(EGGS, plan_of(EGGS), steps[:2], EGG_MEANS) == "there are 3 steps, and times for 2"


def fault_of(
    problem: Problem, starts: Sequence[int], *order: int, tools: Any = None, agents: int = 9, used: Any = ()
) -> str | None:
    """Return what is wrong with steps of 10 seconds, of one agent each or each with a bowl."""
    units = [problem.network.unit(unit) for unit in order] or plan_of(problem)
    bowls = [[Tool("bowl", number)] * (number > 0) for number in used or [0] * len(units)]
    timed = [
        seconds(start, start + 10, min(agent, agents), *bowl)
        for agent, (start, bowl) in enumerate(zip(starts, bowls, strict=True), 1)
    ]
    return timetable_fault(problem, units, timed, means_of(problem, agents=agents, tools=tools))


def test_one_copy_is_at_one_step_at_a_time() -> None:
    assert fault_of(LOOKS, (0, 10, 10)) == "step 3 (smell) lacks a copy of egg; hard"
    assert fault_of(LOOKS, (0, 10, 10), tools={"egg": None}) is None


@needs_solver
@pytest.mark.parametrize("items", ["used-up", "lasting"])
def test_two_agents_do_not_share_a_copy(items: str) -> None:
    problem, lengths = replace(LOOKS, items=None), dict.fromkeys(("boil", "look", "smell"), 10)
    counts: list[tuple[dict[str | ObjectNode, int | None], int]] = [({}, 30), ({"egg": None}, 20)]
    for tools, makespan in counts:
        found = foon_asp.schedule(
            problem, plan_of(problem), durations=lengths, agents=2, items=items, tools=tools
        )
        assert found.makespan == makespan


@needs_solver
def test_a_plan_is_read_with_items_used_up(cli: Cli, tmp_path: Path) -> None:
    plan, durations = tmp_path / "plan.json", KITCHEN / "durations.txt"
    plan.write_text(cli("solve", "--goal", "greek salad", "--format", "json").out)
    ran = cli("schedule", plan, "--durations", durations)
    assert ran.code == 1
    assert re.search(r"step 14, core .* lacks a copy of knife; clean; used up by step 4", ran.err)
    assert "--items lasting" in ran.err
    lasting = cli(
        "schedule", plan, "--durations", durations, "--tools", KITCHEN / "tools.txt", "--items", "lasting"
    )
    assert lasting.code == 0


@needs_solver
def test_steps_are_put_in_an_order_that_runs() -> None:
    rinse, chop_onion, chop_leek = plan_of(CUTS)
    stocked = replace(CUTS, items=UsedUp({}, {parse_node("knife; dirty"): 1}))
    wrong = [chop_leek, chop_onion, rinse, rinse]
    found = foon_asp.schedule(stocked, wrong, durations={"rinse": 1, "chop": 1})
    assert [step.motion for step in found.timetable] == ["rinse", "chop"] * 2
    units = ("boil: egg > egg; hard", "eat: egg; hard > shell", "slice: egg; hard > egg; sliced")
    twice = kitchen(*units, there="egg")
    with pytest.raises(UserError, match=r"step 3, slice .* lacks a copy of egg; hard; used up by step 2"):
        foon_asp.schedule(twice, plan_of(twice), durations={})


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
    problem = kitchen(*units, there="egg + water", items=UsedUp({}, {parse_node("egg; hard"): 1}))
    found = fault_of(problem, starts, *plan)
    assert found is None if holds else found is not None and "lacks a copy of egg; hard" in found


@pytest.mark.parametrize(("bowl", "fault"), [(2, None), (1, "has no bowl for bowl; contains {egg}")])
def test_what_was_in_a_bowl_is_gone(bowl: int, fault: str | None) -> None:
    units = (
        *("crack: egg + bowl; empty > bowl; contains {egg}", "wash: bowl; contains {egg} > bowl; empty"),
        "bake: bowl; contains {egg} > cake",
    )
    problem = kitchen(*units, there="egg + bowl; empty")
    found = fault_of(problem, (0, 10, 20, 30), 0, 1, 0, 2, tools={"bowl": 2}, agents=1, used=(1, 1, 2, bowl))
    assert (found is None) == (fault is None), found
    assert (fault or "") in (found or "")


def test_a_bowl_that_nothing_says_the_contents_of_is_any() -> None:
    """One that something is put into is not listed; one that was skipped need not have been filled."""
    units = ("put: egg > egg; in [bowl]", "stir: egg; in [bowl] + bowl; contains {egg} > dough")
    problem = kitchen(*units, there="egg", containers=ContainerRule.IMPLIED)
    assert fault_of(problem, (0, 10), agents=1, used=(1, 1)) is None
    assert fault_of(problem, (0, 10), agents=1, used=(1, 0)) is not None
    # what is in a bowl stays when something else is put into it
    seasoned = (
        *("put: egg > egg; in [bowl]", "season: salt > salt; in [bowl]"),
        "stir: egg; in [bowl] + salt; in [bowl] > dough",
    )
    both = kitchen(*seasoned, there="egg + salt")
    assert fault_of(both, (0, 10, 20), tools={"bowl": 2}, agents=1, used=(1, 1, 1)) is None


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
        tuple(tuple(choose.sample(steps, 2)) for _ in range(choose.randint(0, 2)) if len(steps) > 1),
    )


def ended(task: ScheduleTask, starts: Sequence[int]) -> Fraction:
    """Return the end of a schedule, in ticks."""
    return max((step.end for step in timed_steps(task, starts)), default=Fraction(0)) / task.tick


@needs_solver
@pytest.mark.parametrize(
    "seeds", [range(30), pytest.param(range(30, 1000), marks=pytest.mark.nightly)], ids=str
)
def test_nothing_is_shorter_by_brute_force(seeds: range) -> None:
    without = 0
    for seed in seeds:
        task = random_task(seed)
        found, least = shortest_schedule(task, Deadline()), least_time(task)
        assert found.proved
        assert (found.starts is None) == (least is None), seed
        if found.starts is None:
            without += 1
            assert least_time(task._replace(counts=task.counts | found.lacking)) is not None
            for name, needed in found.lacking.items():  # and no fewer do
                counts = task.counts | found.lacking | {name: needed - 1}
                assert least_time(task._replace(counts=counts)) is None
        else:
            assert ended(task, found.starts) == least == found.bound
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
@pytest.mark.parametrize(
    "seeds", [range(25), pytest.param(range(25, 400), marks=pytest.mark.nightly)], ids=str
)
def test_schedules_of_random_plans_hold(seeds: range) -> None:
    held = 0
    for seed in seeds:
        choose = random.Random(seed)
        problem = random_problem(seed)
        if choose.random() < 0.3:
            problem = replayable_problem(replace(problem, items=None), plan_of(problem))
        plan = random_plan(problem, choose)
        lengths = {motion: Duration(choose.randint(1, 4), choose.random() < 0.3) for motion in "abcd"}
        tools: dict[Any, int | None] = {"bowl": choose.choice((1, 2, None)), "knife": 2}
        means = ScheduleResources(lengths, choose.randint(1, 3), {} if choose.random() < 0.3 else tools)
        task = schedule_task(problem, plan, replay_for(problem, plan), means)
        found = shortest_schedule(task, Deadline())
        if found.starts is None:
            assert found.lacking
            continue
        assert timetable_fault(problem, plan, timed_steps(task, found.starts), means) is None, seed
        held += len(plan) > 1
    assert held > len(seeds) / 5


@needs_solver
def test_at_a_limit_the_best_is_given_with_its_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    task = random_task(4)

    def ask(
        _: object, __: bytes, deadline: Deadline, hear: dict[str, Callable[[object], None]]
    ) -> tuple[str, object]:
        hear["found"]([3 * number for number in range(len(task.lengths))])
        hear["bound"](5.0)
        deadline.interrupt()
        raise LimitError(deadline)

    monkeypatch.setattr(Worker, "ask", ask)
    deadline = Deadline()
    found = shortest_schedule(task, deadline)
    assert deadline.stopped == "ctrl-C while scheduling"
    assert found.starts == tuple(3 * number for number in range(len(task.lengths)))
    assert not found.proved
    assert found.bound == max(5, task.bound)


@needs_solver
def test_without_time_the_bound_is_that_of_the_longest_chain_and_of_all_work() -> None:
    for seed in range(20):
        task = random_task(seed)._replace(uses=(), sharing=(), agents=9)
        alone = task._replace(agents=1, passive=(False,) * len(task.lengths))
        for each in (task, alone):
            assert shortest_schedule(each, Deadline(1e-9)).bound == least_time(each)


@needs_solver
def test_without_time_one_step_is_done_after_the_other() -> None:
    kinds = set()
    for seed in range(60):
        task = random_task(seed)
        found = shortest_schedule(task, Deadline(1e-9))
        kinds.add(found.starts is None)
        assert not found.proved
        if found.starts is None:
            assert least_time(task._replace(counts=task.counts | found.lacking)) is not None
        else:
            assert found.bound <= (least_time(task) or 0) <= ended(task, found.starts)
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
        knife = sorted(
            (step.start, step.end) for step in found.timetable if foon_asp.Tool("knife", 1) in step.tools
        )
        assert len(knife) == 10
        assert all(end <= start for (_, end), (start, _) in pairwise(knife))


@needs_solver
def test_a_tree_is_put_in_order_and_an_oven_works_alone(tmp_path: Path) -> None:
    problem = foon_asp.load().problem("apple crumble")
    tree = foon_asp.solve(problem).tree
    assert tree is not None
    durations = DURATIONS.read(KITCHEN / "durations.txt")
    found = foon_asp.schedule(problem, tree.units[::-1], durations=durations, items="lasting")
    assert found.status is foon_asp.Status.OPTIMAL
    assert [step.agent for step in found.timetable if step.motion == "bake"] == [None]
    preheat = next(step for step in found.timetable if step.motion == "preheat")
    assert any(step.start < preheat.end and step.agent for step in found.timetable)
    with pytest.raises(UserError, match="the plan does not run: step 1"):
        foon_asp.schedule(problem.vary(without="apple"), tree, durations=durations)


@needs_solver
def test_too_few_tools_are_named() -> None:
    durations = {"salt": 1, "crack": 1, "pour": 1}
    found = foon_asp.schedule(EGGS, plan_of(EGGS), durations=durations)
    assert found.status is foon_asp.Status.INFEASIBLE
    assert (found.makespan, found.timetable) == (None, ())
    assert [(lack.tool, lack.there, lack.needed) for lack in found.lacking] == [("bowl", 1, 2)]
    assert "\n  bowl\t2" in found.text()
    again = foon_asp.schedule(EGGS, plan_of(EGGS), durations=durations, tools={"bowl": 2})
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
    assert "--from-video" in ran.err
    assert "--default-duration 60" in ran.err
    problem = foon_asp.load().problem("ice")
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"durations": {"twist": 1}}, "1 motion of the plan"),
        ({"durations": {"twist": 0, "crush": 1}}, "found the duration 0 of 'twist'"),
        ({"durations": {"twist": "soon", "crush": 1}}, "found 'soon' for the duration of 'twist'"),
        ({"durations": {"twist": "1e-99", "crush": 1}}, "too fine"),
        *(({"tools": tools}, "found") for tools in ({"knife": 0}, {"knife": True}, {"": 1})),
        ({"agents": 0}, "found agents=0"),
    ]
    for asked, message in wrong:
        with pytest.raises(UserError, match=message):
            foon_asp.schedule(problem, plan, **{"durations": ICE, **asked})


def test_without_or_tools_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scheduling, "find_spec", lambda _: None)
    problem = foon_asp.load().problem("ice")
    with pytest.raises(UserError, match=r"OR-Tools: pip install 'foon-asp\[schedule\]'"):
        foon_asp.schedule(problem, foon_asp.solve(problem).tree or (), durations=ICE)


# --- The files.


def test_durations_and_tools_are_read(tmp_path: Path) -> None:
    file = tmp_path / "table.txt"
    file.write_text("# how long\nchop\t40\nbake\t1.5 h\tpassive\npour\t0.25 min\nwait\t3 s\n")
    assert DURATIONS.read(file) == {
        "chop": Duration(40),
        "bake": Duration(5400, passive=True),
        "pour": Duration(15),
        "wait": Duration(3),
    }
    file.write_text("knife\t2\nstove\tfree\nspice jar; contains {salt}\t3\n")
    assert TOOLS.read(file) == {"knife": 2, "stove": None, parse_node("spice jar; contains {salt}"): 3}
    assert set(DURATIONS.read(KITCHEN / "durations.txt")) == set(foon_asp.load().dataset.rates or ())


@pytest.mark.parametrize(
    ("read", "line", "message"),
    [
        (DURATIONS.read, "chop 40", "expected a tab and a number of seconds"),
        (DURATIONS.read, "chop\t", "expected a number of seconds such as 90"),
        (DURATIONS.read, "chop\t0", "expected one above 0"),
        (DURATIONS.read, "chop\t5 days", "'days', expected s, min or h"),
        (DURATIONS.read, "chop\t5\tactive", "'active', expected passive"),
        (DURATIONS.read, "chop\t5\nchop\t6", "a second duration for 'chop'"),
        (DURATIONS.read, "\t5", "the motion before it"),
        (TOOLS.read, "knife\t0", "'0', expected a number from 1 or free"),
        (TOOLS.read, "knife\tmany", "'many', expected"),
        (TOOLS.read, "knife\t1\nknife\tfree", "and something else above"),
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


@needs_solver
def test_a_template_is_filled_in_or_a_default_counts(tmp_path: Path, cli: Cli) -> None:
    plan, file = tmp_path / "plan.txt", tmp_path / "durations.txt"
    plan.write_text(cli("solve", "--goal", "ice", "--format", "foon").out)
    ran = cli("schedule", plan, "--durations-template", file)
    assert (ran.code, ran.out) == (
        0,
        f"wrote {file}: say 2 durations in place of SECONDS, and give it as --durations\n",
    )
    assert "twist\tSECONDS\ncrush\tSECONDS\n" in file.read_text()
    assert cli("schedule", plan, "--durations-template", file).code == 2  # it may be filled in by now
    file.write_text(file.read_text().replace("SECONDS", "90"))
    assert "3:00, proved" in cli("schedule", plan, "--durations", file).out
    ran = cli("schedule", plan, "--default-duration", "0.5 min")
    assert "1:00, proved" in ran.out
    assert "these motions count as 0:30 each: twist, crush" in ran.err
    file.write_text("crush\t1.5\tpassive\n")
    ran = cli("schedule", plan, "--durations", file, "--durations-template", tmp_path / "more.txt")
    assert "twist\tSECONDS\ncrush\t1.5\tpassive\n" in (tmp_path / "more.txt").read_text()
    problem = foon_asp.load().problem("ice")
    with pytest.warns(foon_asp.FoonWarning, match="0:02 each: twist"):
        found = foon_asp.schedule(problem, plan, durations={"crush": 1}, default_duration=2)
    assert found.makespan == 3
    assert "found 'soon'" in cli("schedule", plan, "--default-duration", "soon").err


# --- The charts.

STEPS = (
    ("fill", "kettle", 0, 10, 1),
    ("boil", "water", 10, 190, None),
    ("pick-and-place", "tea bag", 10, 15, 2),
    ("pour", "mug of tea, which is hot", 190, 200, 12),
)


@needs_solver
def test_the_table_has_the_steps_as_they_start() -> None:
    problem = foon_asp.load().problem("ice")
    found = foon_asp.schedule(problem, foon_asp.solve(problem).tree or (), durations=ICE)
    steps = [
        foon_asp.TimedStep(number, None, motion, (), product, Fraction(start), Fraction(end), agent, (), ())
        for number, (motion, product, start, end, agent) in enumerate(STEPS, 1)
    ]
    assert structs.replace(found, timetable=tuple(steps)).text().splitlines()[4:9] == [
        "step  start   end  agent",
        "   1   0:00  0:10      1  fill (kettle)",
        "   3   0:10  0:15      2  pick-and-place (tea bag)",
        "   2   0:10  3:10      -  boil (water)",
        "   4   3:10  3:20     12  pour (mug of tea, which is hot)",
    ]


@pytest.mark.parametrize(
    ("number", "text"),
    [
        ("0", "0:00"),
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
        structs.replace(found, timetable=()).write_chart(chart)
