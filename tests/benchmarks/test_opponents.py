"""The comparison of engines: every opponent is right, is ended as a whole, and is counted as it should be."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import opponents
import pytest
from contest.engines import ENGINES, Engine
from contest.instance import Instance, cuts, raw_units
from contest.trial import End, attempt

from foon_asp.hypergraph import reduce
from foon_asp.network import Network
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from tests.oracle import task_trees
from tests.support.gap_problem import gap_problem
from tests.support.random_problems import random_problem

RULES = list(ContainerRule)
OPPONENTS = [
    pytest.param(
        engine,
        id=engine.name,
        marks=[
            pytest.mark.skipif(not engine.installed, reason=f"{engine.package} is not installed"),
            *([pytest.mark.slow] if engine.name == "Fast Downward" else []),
        ],
    )
    for engine in ENGINES
]


def measured(problem: Problem, units: Any, objective: Objective) -> float:
    """Give what a set of units costs, after the oracle has executed it."""
    network: Network = problem.network
    tree = tuple(map(network.unit, units))
    assert task_trees.makes(problem, tree)
    return float(task_trees.measure(problem, tree, str(objective)))


def asked() -> list[Problem]:
    """Give small questions whose optima the oracle can find; the last is one that relaxations get wrong."""
    return [*(random_problem(seed, RULES[seed % 2]) for seed in range(10)), gap_problem(1, 3)]


@cache
def optima() -> list[float | None]:
    """Give the optimum of each question by each objective."""
    found: list[float | None] = []
    for problem in asked():
        trees = list(task_trees.trees(problem))
        for objective in opponents.OBJECTIVES:
            best = min((task_trees.measure(problem, tree, str(objective)) for tree in trees), default=None)
            found.append(None if best is None else float(best))
    return found


def answers(name: str) -> list[tuple[float | None, float | None]]:
    """Put all questions to an engine, raw and reduced, and measure what it finds."""
    engine = next(engine for engine in ENGINES if engine.name == name)
    found = []
    for problem in asked():
        for objective in opponents.OBJECTIVES:
            both = []
            for units in (raw_units(problem), reduce(problem, levels((objective,))).units):
                used = engine.solve(problem, units, objective, 60.0)
                both.append(None if used is None else measured(problem, used, objective))
            found.append((both[0], both[1]))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("engine", OPPONENTS)
def test_every_opponent_finds_known_optima(engine: Engine) -> None:
    # in a process of its own, not forked: two of the libraries cannot be loaded together
    with ProcessPoolExecutor(1, get_context("spawn")) as pool:
        found = pool.submit(answers, engine.name).result()
    assert sum(best not in {None, 0.0, -1.0} for best in optima()) > 16
    for best, both in zip(optima(), found, strict=True):
        for cost in both:
            if cost is None or best is None:
                assert cost is best
            else:  # to a millionth of each logarithm: rates that differ in the ninth digit are one
                assert cost == pytest.approx(best, rel=1e-5)


def test_circles_are_cut_off() -> None:
    # two nodes that make each other for nothing, and a dear way to begin; a goal made of the second
    instance = Instance(
        units=(10, 11, 12, 13, 14),
        needs=((1,), (0,), (), (1,), (0,)),
        gives=((0,), (1,), (0,), (2,), (1,)),
        costs=(0, 0, 5, 1, 3),
        goals=(2,),
        nodes=3,
    )
    assert instance.component[0] == instance.component[1] != instance.component[2]
    assert cuts(instance, [1, 2, 3]) == []
    assert instance.tree([0, 1, 2, 3]) == (10, 11, 12, 13)
    assert instance.tree([0, 1, 3]) is None
    # all nodes are unmade: what makes one of them from nothing is the third; so too for the circle alone,
    # where each action that needs one of its nodes asks for it
    assert cuts(instance, [0, 1, 3]) == [([2], None), ([2], 0), ([2], 1), ([2], 3)]


def alive(file: Path) -> bool:
    try:
        os.kill(int(file.read_text(encoding="ascii")), 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.slow
def test_a_trial_that_takes_too_long_is_ended_with_all_it_started(tmp_path: Path) -> None:
    noted = tmp_path / "pid"

    def work(start: Callable[[], None]) -> dict[str, Any]:
        start()
        with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]) as sleeping:
            noted.write_text(str(sleeping.pid), encoding="ascii")
            sleeping.wait()
        return {}

    began = time.monotonic()
    trial = attempt(work, 2.0)
    assert (trial.end, trial.seconds) == (End.TIME, 2.0)
    assert time.monotonic() - began < 30
    end = time.monotonic() + 30
    while alive(noted) and time.monotonic() < end:  # init may take a moment to bury it
        time.sleep(0.02)
    assert not alive(noted)


@pytest.mark.slow
def test_a_trial_says_what_it_found_and_needed() -> None:
    def work(start: Callable[[], None]) -> dict[str, Any]:
        time.sleep(1.5)  # which is no part of what is timed
        start()
        held = bytearray(200 * 2**20)
        time.sleep(0.1)
        return {"size": len(held), "long": "x" * 200_000}

    trial = attempt(work, 20.0)
    assert trial.end is End.ANSWERED
    assert trial.said["size"] == 200 * 2**20
    assert len(trial.said["long"]) == 200_000
    assert 0.1 <= trial.seconds < 1.5
    assert trial.memory > 200 * 2**20


def test_a_trial_that_fails_gives_up_or_dies_has_no_answer() -> None:
    def fails(start: Callable[[], None]) -> dict[str, Any]:
        raise RuntimeError("no such thing")

    def gives_up(start: Callable[[], None]) -> dict[str, Any]:
        start()
        raise TimeoutError

    def dies(start: Callable[[], None]) -> dict[str, Any]:
        start()
        os._exit(9)

    failed = attempt(fails, 5.0)
    assert (failed.end, "no such thing" in failed.trouble) == (End.FAILED, True)
    assert attempt(gives_up, 5.0)[:3] == (End.TIME, 5.0, {})
    assert attempt(dies, 5.0).end is End.FAILED
