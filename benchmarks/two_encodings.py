"""The two encodings of task trees side by side: the founded one and the one by need.

The same questions, each solved by both in turn in one process, without reading; the optima are compared.
Replaced encodings get everything that can be made, so a large network takes seconds for each question.

    python benchmarks/two_encodings.py                  the bundled kitchen
    python benchmarks/two_encodings.py --data DIR --every 500
"""

import argparse
import statistics
import sys
import time
from dataclasses import replace
from pathlib import Path

from foon_asp.asp import Settings, solve
from foon_asp.comparison.many import makeable
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.text.data_folder import find_data, read_data

# A folder with each encoding; the founded one goes in as a replacement too, so that both get the same cut.
ENCODINGS = Path(__file__).resolve().parents[1] / "encodings"
FOLDERS = {"founded": ENCODINGS, "by need": ENCODINGS / "by_need"}


def main() -> None:
    """Run the comparison and print it."""
    parser = argparse.ArgumentParser(description="Compare the two encodings of task trees.")
    parser.add_argument("--data", type=Path, default=ENCODINGS.parent / "data" / "kitchen")
    parser.add_argument("--every", type=int, default=4, help="take one of every N makeable objects")
    options = parser.parse_args()
    data = read_data(find_data(options.data))
    for rule in ContainerRule:
        one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, rule)
        goals = makeable(one)[:: options.every]
        for objective in (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS):
            seconds: dict[str, list[float]] = {name: [] for name in FOLDERS}
            for goal in goals:
                measures = set()
                for name, folder in FOLDERS.items():
                    began = time.perf_counter()
                    outcome = solve(replace(one, goals=(goal,)), (objective,), Settings(encodings=folder))
                    seconds[name].append(time.perf_counter() - began)
                    if outcome.costs is None:
                        sys.exit(f"no optimum for {data.network.objects[goal]}: {outcome.status}")
                    measures.add(outcome.costs.key((objective, Objective.UNITS)))
                if len(measures) > 1:
                    sys.exit(f"the encodings disagree on {data.network.objects[goal]} by {objective}")
            medians = {name: 1000 * statistics.median(times) for name, times in seconds.items()}
            ratios = [a / b for a, b in zip(seconds["founded"], seconds["by need"], strict=True)]
            print(
                f"{rule:<8}{objective:<8}{len(goals):>5} goals  "
                + "  ".join(f"{name} {median:6.1f} ms" for name, median in medians.items())
                + f"  founded / by need {statistics.median(ratios):.2f}, all optima equal"
            )


if __name__ == "__main__":
    main()
