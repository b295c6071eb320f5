"""Where the time of one cold ``foon-asp solve`` goes, beside the least that any such program has to do.

Every figure is from fresh processes, opponents in turn, medians of ``--runs``. The floor is a bare
``python -c "import clingo, lark"`` that also splits the network file into lines and fields. The phases are
measured inside further processes, which import, read, index, cut, write facts, ground, solve and check.

    python benchmarks/solve_phases.py                       the bundled kitchen
    python benchmarks/solve_phases.py --data DIR --goal 'greek salad'
"""

import argparse
import json
import statistics
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

FLOOR = """
import clingo, lark, sys
fields = [line.split("\\t") for line in open(sys.argv[1], encoding="utf-8").read().split("\\n")]
"""

PHASES = """
import json, sys, time
marks = [("start", time.perf_counter())]
def mark(phase):
    marks.append((phase, time.perf_counter()))
from pathlib import Path
from foon_asp.asp import solve
from foon_asp.problem import ContainerRule, Problem, parse_objectives
from foon_asp.text.data_folder import find_data
from foon_asp.text.node_lookup import find_goal
from foon_asp.text.tables import read_utensils
from foon_asp.text.object_list import read_object_list
from foon_asp.text.tables import RATES
from foon_asp.text.reader import FoonReader
from foon_asp.cli.verbs import verb_command
verb_command("solve")
mark("import")
files = find_data(Path(sys.argv[1]))
network = FoonReader().read_network(files.network)
listed = read_object_list(files.goals)
items = read_object_list(files.kitchen)
rates, utensils = RATES.read(files.rates), read_utensils(files.utensils)
mark("read")
network.producers, network.consumers
kitchen = frozenset(o for item in items for o in network.find(item.pattern))
goal = find_goal(sys.argv[2], network, listed)
problem = Problem(network, kitchen, (goal,), rates, utensils, ContainerRule(sys.argv[4]))
mark("index")
outcome = solve(problem, parse_objectives([sys.argv[3]]))
phases = {name: after - before for (_, before), (name, after) in zip(marks, marks[1:])}
phases["relevance"] = outcome.seconds["cut"]
phases |= {name: outcome.seconds.get(name, 0.0) for name in ("facts", "ground", "solve", "check")}
print(json.dumps([str(outcome.status), phases]))
"""


def timed(command: Sequence[str]) -> tuple[float, str]:
    """Run a command in a process of its own; give wall seconds and what it printed."""
    began = time.perf_counter()
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - began
    if ended.returncode:
        sys.exit(f"{' '.join(command[:4])} ... failed:\n{ended.stderr}")
    return seconds, ended.stdout


def main() -> None:
    """Run the comparison and print it."""
    parser = argparse.ArgumentParser(description="Time one cold solve, phase by phase.")
    bundled = Path(__file__).resolve().parents[1] / "data" / "kitchen"
    parser.add_argument("--data", type=Path, default=bundled)
    parser.add_argument("--goal", default="greek salad")
    parser.add_argument("--objective", default="units")
    parser.add_argument("--containers", default="strict")
    parser.add_argument("--runs", type=int, default=11)
    options = parser.parse_args()

    question = [options.goal, options.objective, options.containers]
    floor = [sys.executable, "-c", FLOOR, str(options.data / "FOON.txt")]
    phased = [sys.executable, "-c", PHASES, str(options.data), *question]
    whole = [sys.executable, "-m", "foon_asp", "solve", "--data", str(options.data), "--format", "json"]
    whole += ["--goal", options.goal, "--objective", options.objective, "--containers", options.containers]
    times: dict[str, list[float]] = {"floor": [], "whole": []}
    status = ""
    for run in range(options.runs + 1):
        measured = {"floor": timed(floor)[0], "whole": timed(whole)[0]}
        status, phases = json.loads(timed(phased)[1])
        if run:  # the first round warms the caches of the disk and of Python
            for name, seconds in (measured | phases).items():
                times.setdefault(name, []).append(seconds)

    print(f"{options.goal} by {options.objective}, {options.containers}: {status}; {options.data}")
    print(f"medians of {options.runs} runs, each in a fresh process\n")
    for name in ("import", "read", "index", "relevance", "facts", "ground", "solve", "check"):
        print(f"  {name:<12}{1000 * statistics.median(times[name]):9.1f} ms")
    ratios = [a / b for a, b in zip(times["whole"], times["floor"], strict=True)]
    print(f"\n  {'whole':<12}{1000 * statistics.median(times['whole']):9.1f} ms   a cold foon-asp solve")
    print(
        f"  {'floor':<12}{1000 * statistics.median(times['floor']):9.1f} ms   import clingo, lark; split file"
    )
    print(f"  {'ratio':<12}{statistics.median(ratios):9.2f}      whole / floor, median of pairs")


if __name__ == "__main__":
    main()
