"""How large networks and hard ones are solved, with reductions before the search and without.

    python benchmarks/generate.py --family deep --units 100000 --seed 1 --out DIR
    python benchmarks/reductions.py DIR... [--goals N] [--plain SECONDS] [--limit SECONDS]

Prints a table in Markdown, a row for each goal and objective: the units that the goal can need, the units
left to clingo, the time of every phase without reading, and how the answer is proved. ``--plain`` solves
each question again with ``--reduce none`` for at most so long. Answers of both are compared, and a difference
ends the run.
"""

import argparse
import gc
import sys
import time
from pathlib import Path
from statistics import median

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.reduce import ALL, NONE, reduce
from foon_asp.text import find_data, read_data

COLUMNS = (
    "data",
    "goal",
    "objective",
    "cone",
    "left",
    "tree",
    "cut s",
    "search s",
    "all s",
    "status",
    "proof",
    "value",
    "bound",
    "none s",
)


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folders", nargs="+", type=Path, metavar="DIR")
    parser.add_argument("--goals", type=int, help="the last so many goals of each, all by default")
    parser.add_argument("--objectives", default="units,inputs,success")
    parser.add_argument("--containers", type=ContainerRule, default=ContainerRule.STRICT)
    parser.add_argument("--limit", type=float, default=60, metavar="SECONDS")
    parser.add_argument("--plain", type=float, metavar="SECONDS", help="also without reductions")
    arguments = parser.parse_args()
    objectives = [Objective(name) for name in arguments.objectives.split(",")]
    print("| " + " | ".join(COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS))
    seconds: dict[str, list[float]] = {}
    unproved = different = 0
    for folder in arguments.folders:
        data = read_data(find_data(folder, (), None, None, None, None), lenient=False)
        gc.collect()
        _ = data.network.producers  # an index of the network, which all goals share
        goals = dict.fromkeys(data.network.find(entry.pattern)[0] for entry in data.goals)
        for number, goal in list(enumerate(goals))[-(arguments.goals or len(goals)) :]:
            problem = Problem(
                data.network, data.kitchen, (goal,), data.rates, data.utensils, arguments.containers
            )
            _ = problem.needs
            cone = len(reduce(problem, levels(tuple(objectives[:1])), NONE).units)
            for objective in objectives:
                began = time.perf_counter()
                outcome = solve(problem, (objective,), Settings(time_limit=arguments.limit, reductions=ALL))
                spent = time.perf_counter() - began
                seconds.setdefault(folder.name, []).append(spent)
                unproved += outcome.status is not Status.OPTIMAL
                plain = ""
                if arguments.plain:
                    began = time.perf_counter()
                    other = solve(
                        problem, (objective,), Settings(time_limit=arguments.plain, reductions=NONE)
                    )
                    plain = f"{time.perf_counter() - began:.2f}"
                    if other.status is not Status.OPTIMAL:
                        plain = f"> {plain}"
                    elif not _agree(outcome, other, objective):
                        different += 1
                        plain += " DIFFERENT"
                print(_row(folder.name, number, objective, cone, outcome, spent, plain), flush=True)
    for name, figures in seconds.items():
        print(f"{name}: {len(figures)} questions, median {median(figures):.2f} s, worst {max(figures):.2f} s")
    print(f"not proved: {unproved}; different: {different}")
    return 1 if different else 0


def _agree(one: Outcome, plain: Outcome, objective: Objective) -> bool:
    if one.costs is None or plain.costs is None:
        return one.costs is plain.costs
    ours, theirs = (outcome.costs.key(levels((objective,))) for outcome in (one, plain) if outcome.costs)
    return ours == theirs if one.status is Status.OPTIMAL else ours >= theirs


def _row(
    data: str, number: int, objective: Objective, cone: int, outcome: Outcome, spent: float, plain: str
) -> str:
    figures = outcome.seconds
    value = bound = ""
    if outcome.costs is not None:
        value, bound = (
            f"{float(x):.4g}" for x in (outcome.costs.measure(objective), outcome.bounds[objective])
        )
    cells = (
        data,
        number + 1,
        objective,
        cone,
        outcome.left,
        len(outcome.units or ()),
        f"{figures['cut']:.2f}",
        f"{sum(figures.get(phase, 0) for phase in ('facts', 'ground', 'solve')):.2f}",
        f"{spent:.2f}",
        outcome.status,
        outcome.proof or "",
        value,
        bound,
        plain,
    )
    return "| " + " | ".join(map(str, cells)) + " |"


if __name__ == "__main__":
    sys.exit(main())
