"""The program beside every other engine, on the same questions in one run.

    python benchmarks/opponents.py                                    a quick run on generated networks
    python benchmarks/opponents.py --units 100000 --limit 60
    python benchmarks/opponents.py --data DIR --goals 50              a network of your own

Each engine answers each question in a process of its own, which has the network in memory: read, indexed,
and with all imports done. Then its clock starts; it stops with a tree in an order that executes, simulated.
A process that has no answer at the limit is killed with all it started. *Raw* is the question after what the
plain program does, which is to leave out units that cannot run and those that the goals cannot need;
*reduced* is it after all of the program's reductions, from whose end on its seconds count, ours too. Where
bounds have met, the program then knows that its tree is the best; opponents are only given the units left.
The clock of raw questions runs from the beginning. *Whole* is loading and solving the tuned plain encoding
with all of the network, whose facts are there before the clock starts.

Goals are the harder half of those that come with a generated network, or, from other data, what can be made;
so many of them as are asked for, evenly spread.

Engines are asked for the best by the one objective; the program also for the fewest units among the best.
All answers have to agree, which is tested with rational numbers; a disagreement ends the run. Where rates
multiply, engines add logarithms rounded to a millionth, and may differ by what that can hide.
"""

import argparse
import json
import math
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from contest.clingo_plain import plain_facts, solve_plain
from contest.clingo_plain import ready as clingo_ready
from contest.engines import ENGINES, Engine
from contest.instance import instance_of, raw_units
from contest.page import put, table
from contest.plot import draw_ratios
from contest.ratio import Figure, median, ratio
from contest.trial import End, Trial, Work, attempt
from generate import Family, generate

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.assembly import CLINGO_OPTIONS
from foon_asp.comparison.many import makeable
from foon_asp.deadline import Deadline
from foon_asp.engines import EngineAnswer, agreed_objectives
from foon_asp.hypergraph import reduce
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, executable_order, levels
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.text.data_folder import Data, find_data, read_data
from foon_asp.text.node_lookup import find_goal

OURS = "foon-asp"
OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.INPUTS_AND_INGREDIENTS, Objective.SUCCESS)
HEADERS = {
    "whole": ("whole: times", "proved", "s", "most s", "peak MB"),
    "raw": ("raw: times", "proved", "s", "most s", "peak MB"),
    "reduced": ("reduced: times", "proved", "s", "most s"),
}
_CLOSE = 2e-6  # for each unit of two trees, how far engines may be apart that round logarithms
_MEGABYTE = 2**20


class Question(NamedTuple):
    """One question, with the name of the network that it is about and of its goal."""

    network: str
    goal: str
    problem: Problem
    objective: Objective


class Row(NamedTuple):
    """What an engine made of a question: raw, reduced, or (``whole``) without leaving anything out."""

    network: str
    objective: str
    goal: str
    engine: str
    view: str
    end: str
    seconds: float
    memory: int
    left: int
    reducing: float
    status: str
    cost: str
    bound: str
    limit: float

    @property
    def time(self) -> Figure:
        """The seconds it took, from below where there is no answer."""
        return Figure(self.seconds, self.end != End.ANSWERED)

    @property
    def rest(self) -> Figure:
        """The seconds after the reductions."""
        return Figure(max(self.seconds - self.reducing, 1e-6), self.end != End.ANSWERED)


def networks(options: argparse.Namespace) -> Iterator[tuple[str, Data, list[str | int]]]:
    """Read the networks that the command line asks for; with each its name and goals."""
    if options.data:
        data = read_data(find_data(options.data))
        one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, options.containers)
        name = f"{len(data.network):,} units in {options.data.resolve().name}, {options.containers}"
        yield name, data, spread(makeable(one), options.goals)
        return
    for family in options.family or [Family.RECIPE_LIKE, Family.DEEP]:
        with tempfile.TemporaryDirectory() as folder:
            generate(family, options.units, options.seed, Path(folder))
            data = read_data(find_data(Path(folder)))
            entries = json.loads(Path(folder, "goal_nodes.json").read_text(encoding="utf-8"))
        labels = [entry["label"] for entry in entries]
        hard = labels[(len(labels) + 1) // 2 :]  # whose cones grow with the network; the list is in order
        yield f"{family}, {options.units:,} units", data, spread(hard, options.goals)


def spread(items: Sequence[Any], count: int) -> list[Any]:
    """Take ``count`` items, evenly and with both ends; all of them if there are no more, or for 0."""
    if not 0 < count < len(items):
        return list(items)
    if count == 1:
        return [items[-1]]
    return [items[round(place * (len(items) - 1) / (count - 1))] for place in range(count)]


def questions(options: argparse.Namespace) -> Iterator[list[Question]]:
    """Give the questions about each network, with all indexes made that any engine may use."""
    for name, data, goals in networks(options):
        network = data.network
        network.producers, network.consumers  # noqa: B018 (made when first asked for)
        found = []
        for goal in goals:
            node = goal if isinstance(goal, int) else find_goal(goal, network, data.goals)
            problem = Problem(network, data.kitchen, (node,), data.rates, data.utensils, options.containers)
            problem.needs, problem.makers  # noqa: B018
            wanted = options.objective or [Objective.UNITS, Objective.SUCCESS]
            found += [Question(name, str(network.objects[node]), problem, o) for o in wanted]
        yield found


def unshare(problem: Problem) -> None:
    """Touch what a forked process shares with its parent, so that no clock counts the copying of pages.

    Looking at a number counts a reference to it, which is a write.
    """
    network = problem.network
    for lists in (
        problem.needs,
        problem.gives,
        problem.makers,
        network.inputs,
        network.outputs,
        [network.motions],
    ):
        for members in lists:
            for _ in members:
                pass


def our_work(question: Question, limit: float) -> Work:
    """Answer a question as the program does."""

    def work(start: Any) -> dict[str, Any]:
        clingo_ready()
        unshare(question.problem)
        start()
        outcome = solve(question.problem, (question.objective,), Settings(deadline=Deadline(limit)))
        return {
            "units": outcome.units,
            "status": outcome.status,
            "left": outcome.left,
            "reducing": outcome.seconds["cut"],
            "bound": str(outcome.bounds.get(question.objective, "")),
        }

    return work


def their_work(question: Question, engine: Engine, view: str, limit: float) -> Work:
    """Answer a question with another engine."""
    problem, objective = question.problem, question.objective

    def work(start: Any) -> dict[str, Any]:
        engine.ready()
        unshare(problem)
        start()
        began = time.perf_counter()
        reduced = None if view == "raw" else reduce(problem, levels((objective,)))
        units = raw_units(problem) if reduced is None else reduced.units
        reducing = time.perf_counter() - began
        used = engine.solve(problem, units, objective, limit - reducing)
        return _checked(problem, used) | {"left": len(units), "reducing": reducing}

    return work


def whole_work(question: Question, limit: float) -> Work:
    """Load and solve the plain encoding with all of the network, its facts being written beforehand."""
    problem, objective = question.problem, question.objective

    def work(start: Any) -> dict[str, Any]:
        clingo_ready()
        instance = instance_of(problem, range(len(problem.network)), objective)
        facts = plain_facts(instance, objective)
        start()
        used = solve_plain(facts, limit, CLINGO_OPTIONS, by_need=False)
        units = None if used is None else instance.tree(used)
        return _checked(problem, units) | {"left": len(problem.network), "reducing": 0.0}

    return work


def _checked(problem: Problem, used: Sequence[int] | None) -> dict[str, Any]:
    """Put units in order and simulate them, as the program does with every tree."""
    if used is None:
        return {"units": None, "status": Status.INFEASIBLE}
    order = executable_order(problem, used)
    if order is None or simulate_for(problem, problem.tree(order)).verdict is not Verdict.AS_LISTED:
        raise RuntimeError("the tree does not execute")
    return {"units": order, "status": Status.OPTIMAL}


def noted(question: Question, engine: str, view: str, trial: Trial, limit: float) -> Row:
    """Note what came of a trial; costs are computed here from the units."""
    said = trial.said
    cost = ""
    if said.get("units") is not None:
        cost = str(question.problem.costs(said["units"]).measure(question.objective))
    proved = said.get("status") in {Status.OPTIMAL, Status.INFEASIBLE}
    return Row(
        question.network,
        question.objective,
        question.goal,
        engine,
        view,
        trial.end if proved or trial.end is not End.ANSWERED else End.TIME,
        trial.seconds if proved else limit,
        trial.memory,
        said.get("left", 0),
        said.get("reducing", 0.0),
        said.get("status", ""),
        cost,
        said.get("bound", "") if not proved else "",
        limit,
    )


def answer(question: Question, engines: Sequence[Engine], options: argparse.Namespace) -> Iterator[Row]:
    """Let all engines answer a question in turn, and hold the answers against each other."""
    limit = options.limit
    trials: list[tuple[str, str, Trial]] = [(OURS, "ours", attempt(our_work(question, limit), limit + 30.0))]
    if options.data:
        trials.append(("clingo tuned", "whole", attempt(whole_work(question, limit), limit)))
    trials += [
        (engine.name, view, attempt(their_work(question, engine, view, limit), limit))
        for engine in engines
        for view in options.view
    ]
    for name, view, trial in trials:
        if trial.end is End.FAILED and "MemoryError" not in trial.trouble:
            sys.exit(f"{name} ({view}) failed on {question.goal} by {question.objective}:\n{trial.trouble}")
    compare(question, trials)
    yield from (noted(question, name, view, trial, limit) for name, view, trial in trials)


def compare(question: Question, trials: Sequence[tuple[str, str, Trial]]) -> None:
    """Raise where two answers cannot both be right."""
    problem, objective = question.problem, question.objective
    answered = [
        (f"{name} ({view})", trial)
        for name, view, trial in trials
        if trial.said.get("status") in {Status.OPTIMAL, Status.INFEASIBLE}
    ]
    if not answered:
        return
    first, reference = answered[0]
    units = reference.said["units"]
    costs = None if units is None else problem.costs(units)
    if first.startswith(OURS):
        outcome = Outcome(problem, (objective,), Status(reference.said["status"]), units, costs, {}, {})
        for name, trial in answered[1:]:
            found = trial.said["units"]
            agreed_objectives(outcome, EngineAnswer(name, (objective,), found, True))
        return
    for name, trial in answered[1:]:
        found = trial.said["units"]
        other = None if found is None else problem.costs(found)
        if not same(objective, costs, other):
            raise RuntimeError(f"{first} finds {costs} and {name} finds {other} for {question.goal}")


def same(objective: Objective, one: Costs | None, other: Costs | None) -> bool:
    """Whether two trees are equally good, as far as engines that round logarithms can tell."""
    if one is None or other is None:
        return one is other
    if objective is not Objective.SUCCESS:
        return one.measure(objective) == other.measure(objective)
    if not one.success or not other.success:
        return one.success == other.success
    quotient = one.success / other.success
    apart = abs(math.log(quotient.numerator) - math.log(quotient.denominator))
    return apart <= _CLOSE * (1 + one.units + other.units)


def summary(rows: Sequence[Row]) -> str:
    """Lay out the tables, one for each network and objective."""
    parts = []
    for network, objective in dict.fromkeys((r.network, r.objective) for r in rows):
        some = [r for r in rows if (r.network, r.objective) == (network, objective)]
        ours = {r.goal: r for r in some if r.engine == OURS}
        own = list(ours.values())
        views = [view for view in HEADERS if any(r.view == view for r in some)]
        header = ["engine", *(cell for view in views for cell in HEADERS[view])]
        lines = [[f"**{OURS}**", *(cell for view in views for cell in _cells(own, ours, view))]]
        for engine in dict.fromkeys(r.engine for r in some if r.engine != OURS):
            line = [engine]
            for view in views:
                line += _cells([r for r in some if (r.engine, r.view) == (engine, view)], ours, view)
            lines.append(line)
        parts.append(f"**{network}, `{objective}`**, {len(ours)} goals, limit {some[0].limit:g} s")
        parts.append(table(header, lines))
        settled = sum(r.end == End.ANSWERED and r.left == 0 for r in own)
        sizes = f"Bounds met before any search for {settled} of {len(own)} goals."
        for view in ("raw", "reduced"):
            left = [r.left for r in some if r.view == view and r.end == End.ANSWERED]
            if left:
                sizes += f" Units in the {view} questions: {min(left):,} to {max(left):,}."
        parts.append(sizes)
        parts += [
            f"Not proved: {r.goal}: {r.status}, {r.objective} {r.cost or 'unknown'}, bound {r.bound}."
            for r in own
            if r.end != End.ANSWERED
        ]
    return "\n\n".join(parts)


def plotted(rows: Sequence[Row]) -> dict[str, dict[str, Figure]]:
    """Give how many times slower each engine is on raw questions, for each network and objective."""
    groups: dict[str, dict[str, Figure]] = {}
    for network, objective in dict.fromkeys((r.network, r.objective) for r in rows):
        some = [r for r in rows if (r.network, r.objective) == (network, objective)]
        ours = {r.goal: r.time for r in some if r.engine == OURS and not r.time.beyond}
        bars = groups[f"{network}, {objective}"] = {}
        for engine in dict.fromkeys(r.engine for r in some if r.view == "raw"):
            theirs = [r for r in some if (r.engine, r.view) == (engine, "raw") and r.goal in ours]
            if theirs:
                bars[engine] = median([ratio(r.time, ours[r.goal]) for r in theirs])
    return groups


def _cells(some: Sequence[Row], ours: dict[str, Row], view: str) -> list[str]:
    """Give the cells of an engine under the headers of a view."""
    if not some:
        return [""] * len(HEADERS[view])

    def figure(r: Row) -> Figure:
        return r.rest if view == "reduced" else r.time

    ratios = [ratio(figure(r), figure(ours[r.goal])) for r in some if not ours[r.goal].time.beyond]
    cells = [
        str(median(ratios)) if ratios else "",
        f"{sum(r.end == End.ANSWERED for r in some)}/{len(some)}",
        str(median([figure(r) for r in some])),
        str(max(figure(r) for r in some)),
    ]
    if view != "reduced":
        cells.append(f"{max(r.memory for r in some) / _MEGABYTE:,.0f}")
    return cells


def run(engines: Sequence[Engine], options: argparse.Namespace) -> list[Row]:
    """Measure everything that the command line asks for, and say so line by line."""
    rows: list[Row] = []
    for asked in questions(options):
        for question in asked:
            for measured in answer(question, engines, options):
                rows.append(measured)
                print(
                    f"{measured.network} {measured.objective:<8} {measured.goal[:40]:<40} "
                    f"{measured.engine:<16} {measured.view:<8} {measured.end:<9} {measured.seconds:8.3f} s",
                    file=sys.stderr,
                )
                if options.rows:
                    with options.rows.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(measured._asdict()) + "\n")
    return rows


def main() -> None:
    """Read the command line, run all, and print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--family", type=Family, choices=list(Family), action="append")
    parser.add_argument("--units", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--data", type=Path, help="a folder with a network, in place of generated ones")
    parser.add_argument("--containers", type=ContainerRule, choices=list(ContainerRule), default="strict")
    parser.add_argument("--objective", type=Objective, choices=OBJECTIVES, action="append")
    parser.add_argument("--goals", type=int, default=5, help="how many for each network; 0 is all")
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for each engine and question")
    parser.add_argument("--view", choices=["raw", "reduced"], action="append")
    names = [engine.name for engine in ENGINES]
    parser.add_argument(
        "--engine", choices=names, action="append", help="the best setting of each, if absent"
    )
    parser.add_argument("--all-settings", action="store_true", help="every setting of every engine")
    parser.add_argument("--rows", type=Path, help="a file for all that was measured, as JSON Lines")
    parser.add_argument("--from-rows", type=Path, help="lay out such a file again, and measure nothing")
    parser.add_argument("--plot", type=Path, help="a file for a plot of the ratios on raw questions")
    parser.add_argument("--page", type=Path, help="a page whose section gets the tables")
    parser.add_argument("--section", default="opponents")
    options = parser.parse_args()
    options.containers = ContainerRule(options.containers)
    options.view = options.view or ["raw", "reduced"]
    chosen = [
        e
        for e in ENGINES
        if (e.name in options.engine if options.engine else e.first or options.all_settings)
    ]
    engines = [engine for engine in chosen if engine.installed]
    for engine in chosen:
        if engine not in engines:
            print(f"left out: {engine.name}, since {engine.package} is not installed", file=sys.stderr)

    if options.from_rows:
        lines = options.from_rows.read_text(encoding="utf-8").splitlines()
        rows = [Row(**json.loads(line)) for line in lines]
    else:
        rows = run(engines, options)
    text = summary(rows)
    print(text)
    if options.page:
        put(options.page, options.section, text)
    if options.plot:
        draw_ratios(plotted(rows), "times slower than foon-asp on the raw question, medians", options.plot)


if __name__ == "__main__":
    main()
