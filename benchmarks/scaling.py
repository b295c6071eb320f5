"""Cost against size: seconds of each step from reading to search, and peak memory; and how each grows.

    python benchmarks/scaling.py                                     a quick run
    python benchmarks/scaling.py --units 1000 --units 10000 --units 100000 --units 1000000 --plot FILE.svg

Each size is a generated network in a process of its own. Reading, import and indexing happen once for each;
the other steps are medians over its harder half of goals, those whose cones grow with the network. The *cone*
is what the plain program leaves, units that can run and that the goal can need; the program itself never
looks at all of the network to answer. *Reduction* is from the indexed network to what clingo gets, *search*
is all after that, simulating the tree included.

Memory is the peak of a process, in MB: of *import* by itself; of a question to the *store*, its median over
the same goals, each in a process of its own; and of all else, where the network is read from *text*.

The exponent is the slope of a straight line through the logarithms of size and figures, by least squares:
1 is linear, 0 a cost that does not grow.
"""

import argparse
import gc
import json
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from contest.page import put, table
from contest.plot import draw_growth
from generate import Family, generate

import foon_asp
from foon_asp.asp import Settings, Status, solve
from foon_asp.deadline import Deadline
from foon_asp.problem import Objective, Problem, reach, relevant_units
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import find_goal

STEPS = ("reading", "import", "indexing", "cone", "reduction", "search")
MEMORY = ("text", "import", "store")


def measure(folder: Path, objective: Objective, limit: float) -> dict[str, float]:
    """Give the seconds of each step on the network in a folder, what of memory, and what was not proved."""
    gc.set_threshold(100_000, 50, 50)  # as the program does
    files, store = find_data(folder), folder / "network.foon"
    entries = json.loads((folder / "goal_nodes.json").read_text(encoding="utf-8"))
    entries = entries[(len(entries) + 1) // 2 :]
    start = time.perf_counter()
    importing = peak(lambda: import_files(files, store))
    imported = time.perf_counter() - start
    stored = [peak(partial(_ask, store, entry["label"], objective, limit)) for entry in entries]
    began = time.perf_counter()
    data = read_data(files)
    read = time.perf_counter()
    network = data.network
    network.producers, network.consumers, network.by_label  # noqa: B018 (made when first asked for)
    indexed = time.perf_counter()
    gc.freeze()  # the network stays; only what is made for a question is looked at for what to free
    steps: dict[str, list[float]] = {"cone": [], "reduction": [], "search": []}
    unproved = 0
    for entry in entries:
        goal = find_goal(entry["label"], network, data.goals)
        problem = Problem(network, data.kitchen, (goal,), data.rates, data.utensils)
        start = time.perf_counter()
        relevant_units(problem, reach(problem))
        cut = time.perf_counter()
        outcome = solve(problem, (objective,), Settings(deadline=Deadline(limit)))
        whole = time.perf_counter() - cut
        unproved += outcome.status is not Status.OPTIMAL
        steps["cone"].append(cut - start)
        steps["reduction"].append(outcome.seconds["cut"])
        steps["search"].append(whole - outcome.seconds["cut"])
    medians = {step: statistics.median(seconds) for step, seconds in steps.items()}
    once = {"reading": read - began, "import": imported, "indexing": indexed - read}
    text = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    memory = {"MB text": text, "MB import": importing, "MB store": statistics.median(stored)}
    return {**once, **medians, **memory, "unproved": unproved}


def peak(work: Callable[[], object]) -> float:
    """Do work in a process forked from this one, and give its peak memory in MB."""
    child = os.fork()
    if not child:
        code = 1
        try:
            work()
            code = 0
        finally:
            os._exit(code)
    _, status, usage = os.wait4(child, 0)
    assert os.waitstatus_to_exitcode(status) == 0
    return usage.ru_maxrss / 1024


def _ask(store: Path, label: str, objective: Objective, limit: float) -> None:
    with foon_asp.load(store) as foon:
        foon_asp.solve(foon.problem(label), objective, time_limit=limit)


def slope(points: Sequence[tuple[int, float]]) -> float:
    """Give the exponent of a power law, by least squares on logarithms; needs two sizes at least."""
    xs, ys = [math.log(size) for size, _ in points], [math.log(figure) for _, figure in points]
    return statistics.linear_regression(xs, ys).slope


def main() -> None:
    """Measure every size and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--family", type=Family, choices=list(Family), default=Family.RECIPE_LIKE)
    parser.add_argument("--units", type=int, action="append")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--objective", type=Objective, default=Objective.UNITS)
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for each question")
    parser.add_argument("--runs", type=int, default=3, help="processes for each size; medians are taken")
    parser.add_argument("--plot", type=Path, help="a file for the plot")
    parser.add_argument("--page", type=Path, help="a page whose section gets the table")
    parser.add_argument("--section", default="scaling")
    parser.add_argument("--run", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.run:
        print(json.dumps(measure(options.run, options.objective, options.limit)))
        return

    curves: dict[str, list[tuple[int, float]]] = {step: [] for step in STEPS}
    memory: dict[str, list[tuple[int, float]]] = {name: [] for name in MEMORY}
    unproved = 0.0
    for size in sorted(options.units or [1000, 3000, 10_000]):
        with tempfile.TemporaryDirectory() as folder:
            generate(options.family, size, options.seed, Path(folder))
            words = [sys.executable, __file__, "--run", folder, "--objective", options.objective]
            words += ["--limit", str(options.limit)]
            outputs = [
                subprocess.run(words, check=True, capture_output=True, text=True).stdout
                for _ in range(options.runs)
            ]
        found = [json.loads(output) for output in outputs]
        unproved += found[0]["unproved"]
        for step in STEPS:
            curves[step].append((size, statistics.median(one[step] for one in found)))
        for name in MEMORY:
            memory[name].append((size, statistics.median(one[f"MB {name}"] for one in found)))
        print(f"{options.family}: {size} units measured", file=sys.stderr)
    sizes = [size for size, _ in curves["reading"]]
    header = ["step", *(f"{size:,} units" for size in sizes), "exponent"]
    lines = [
        [step, *(f"{seconds:.3g} s" for _, seconds in points), f"{slope(points):.2f}"]
        for step, points in curves.items()
    ] + [
        [f"memory, {name}", *(f"{megabytes:,.0f} MB" for _, megabytes in points), f"{slope(points):.2f}"]
        for name, points in memory.items()
    ]
    title = f"{options.family}, {options.objective}"
    text = f"**{title}**, median of {options.runs} runs\n\n{table(header, lines)}"
    if unproved:
        text += f"\n\nNot proved within {options.limit:g} s: {unproved:g} questions."
    print(text)
    if options.page:
        put(options.page, options.section, text)
    if options.plot:
        draw_growth({"seconds": curves, "peak memory, MB": memory}, title, options.plot)


if __name__ == "__main__":
    main()
