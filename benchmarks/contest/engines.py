"""Every engine that takes part: how it is set, and how it is asked."""

import importlib.util
import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from contest.clingo_plain import plain_facts, solve_plain
from contest.clingo_plain import ready as clingo_ready
from contest.cp_sat import ready as cp_sat_ready
from contest.cp_sat import solve_cp_sat
from contest.instance import Instance, instance_of
from contest.max_sat import Setting, solve_max_sat
from contest.max_sat import ready as max_sat_ready
from contest.mixed_integer import ready as mixed_integer_ready
from contest.mixed_integer import solve_mixed_integer
from contest.supported import solve_supported
from foon_asp.asp.assembly import CLINGO_OPTIONS
from foon_asp.engines import fast_downward
from foon_asp.problem import Objective, Problem

# Units of the problem that may be used, and seconds; gives units, or None where there is no tree.
Solve = Callable[[Problem, Sequence[int], Objective, float], Sequence[int] | None]
OnInstance = Callable[[Instance, Objective, float], list[int] | None]


class Engine(NamedTuple):
    """An opponent: the engine, how it is set, and the package that it needs.

    ``ready`` imports what ``solve`` uses, which no clock counts; both run in a process of their own.
    ``first`` says that this is the setting of the engine that did best of those tried.
    """

    name: str
    engine: str
    setting: str
    package: str
    ready: Callable[[], None]
    solve: Solve
    first: bool = True

    @property
    def installed(self) -> bool:
        """Whether the package is there."""
        return importlib.util.find_spec(self.package) is not None


def on_instance(solve: OnInstance) -> Solve:
    """Number units and nodes for an engine, and give what executes of what it uses."""

    def solve_units(
        problem: Problem, units: Sequence[int], objective: Objective, seconds: float
    ) -> Sequence[int] | None:
        began = time.monotonic()
        instance = instance_of(problem, units, objective)
        used = solve(instance, objective, seconds - (time.monotonic() - began))
        return None if used is None else instance.tree(used)

    return solve_units


def _clingo(name: str, setting: str, options: Sequence[str], by_need: bool, first: bool = True) -> Engine:
    def answer(instance: Instance, objective: Objective, seconds: float) -> list[int] | None:
        return solve_plain(plain_facts(instance, objective), seconds, options, by_need)

    solve = on_instance(answer)
    return Engine(name, "clingo", setting, "clingo", clingo_ready, solve, first)


def _highs(
    name: str, setting: str, levels: bool, threads: int, first: bool, elimination: bool = False
) -> Engine:
    solve = on_instance(lambda i, _, seconds: solve_mixed_integer(i, seconds, levels, threads, elimination))
    return Engine(name, "HiGHS", setting, "highspy", mixed_integer_ready, solve, first)


def _cp_sat(
    name: str, setting: str, levels: bool, parameters: dict[str, Any], first: bool, elimination: bool = False
) -> Engine:
    solve = on_instance(lambda i, _, seconds: solve_cp_sat(i, seconds, levels, parameters, elimination))
    return Engine(name, "CP-SAT", setting, "ortools", cp_sat_ready, solve, first)


def _rc2(name: str, words: str, setting: Setting, first: bool) -> Engine:
    solve = on_instance(lambda i, _, __: solve_max_sat(i, setting))
    return Engine(name, "RC2", words, "pysat", max_sat_ready, solve, first)


def _fast_downward() -> Engine:
    def solve(
        problem: Problem, units: Sequence[int], objective: Objective, seconds: float
    ) -> Sequence[int] | None:
        forbidden = frozenset(range(len(problem.network))).difference(units)
        # It is ended from outside when its time is up, so that its own limit is never the one that is met.
        answer = fast_downward.solve_with_fast_downward(problem, (objective,), forbidden, 2 * seconds + 60)
        if not answer.finished:
            raise MemoryError
        return answer.units

    return Engine("Fast Downward", "Fast Downward", "astar(lmcut())", "up_fast_downward", lambda: None, solve)


ENGINES: tuple[Engine, ...] = (
    _clingo("clingo tuned", " ".join(CLINGO_OPTIONS), CLINGO_OPTIONS, by_need=False),
    _clingo("clingo cores", "--opt-strategy=usc,oll", ("--opt-strategy=usc,oll",), by_need=False),
    _clingo("clingo default", "branch and bound, no options", (), by_need=False),
    _clingo("clingo by need", f"encodings/by_need, {' '.join(CLINGO_OPTIONS)}", CLINGO_OPTIONS, by_need=True),
    _highs("HiGHS", "cycles cut off as they turn up, 1 thread", levels=False, threads=1, first=True),
    _highs("HiGHS levels", "levels on cycles, 1 thread", levels=True, threads=1, first=False),
    _highs("HiGHS elimination", "vertex elimination, 1 thread", False, 1, first=False, elimination=True),
    Engine(
        "clingo supported",
        "clingo",
        "supported models, vertex elimination, --opt-strategy=usc",
        "clingo",
        clingo_ready,
        on_instance(lambda i, _, seconds: solve_supported(i, seconds)),
        first=False,
    ),
    _cp_sat("CP-SAT", "levels on cycles, 8 workers", True, {"num_workers": 8}, first=True),
    _cp_sat("CP-SAT loops", "cycles cut off, 8 workers", False, {"num_workers": 8}, first=False),
    _cp_sat("CP-SAT 1 worker", "cycles cut off, 1 worker", False, {"num_workers": 1}, first=False),
    _cp_sat(
        "CP-SAT core",
        "cycles cut off, 1 worker, optimize_with_core",
        False,
        {"num_workers": 1, "optimize_with_core": True},
        first=False,
    ),
    _cp_sat(
        "CP-SAT elimination",
        "vertex elimination, 1 worker",
        False,
        {"num_workers": 1},
        first=False,
        elimination=True,
    ),
    _rc2(
        "RC2",
        "not stratified, no options, Glucose 3; vertex elimination",
        Setting(stratified=False, adapt=False, exhaust=False, minz=False),
        first=True,
    ),
    _rc2("RC2 stratified", "adapt, exhaust, minz; vertex elimination", Setting(), first=False),
    _rc2("RC2 loops", "as stratified; cycles cut off", Setting(elimination=False), first=False),
    _rc2("RC2 glucose 4", "as stratified, with Glucose 4.1", Setting(solver="g4"), first=False),
    _rc2("RC2 no minz", "as stratified, without minz", Setting(minz=False), first=False),
    _fast_downward(),
)
