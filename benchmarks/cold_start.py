"""How long a whole ``solve`` takes from a cold start, in multiples of a floor that it cannot go below.

    python benchmarks/cold_start.py                              the bundled kitchen
    python benchmarks/cold_start.py DIR --goal 'greek salad'     a universal FOON in a folder
    python benchmarks/cold_start.py DIR --against CHECKOUT       beside another checkout, in turn

The floor imports clingo and lark and splits the file of the network. Runs alternate, so that a busy machine
is busy for all; the medians of the ratios are printed.
"""

import argparse
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def seconds(words: list[str], checkout: Path = ROOT) -> float:
    """Return the seconds that a Python process takes from start to end."""
    began = time.perf_counter()
    subprocess.run(
        [sys.executable, *words],
        env=os.environ | {"PYTHONPATH": str(checkout)},
        capture_output=True,
        check=True,
    )
    return time.perf_counter() - began


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("data", nargs="?", type=Path, default=ROOT / "data" / "kitchen")
    parser.add_argument("--goal", default="greek salad")
    parser.add_argument("--runs", type=int, default=15)
    parser.add_argument("--against", type=Path, metavar="CHECKOUT")
    options = parser.parse_args()
    network = options.data / "FOON.txt"
    floor = ["-c", f"import clingo, lark; open({str(network)!r}, encoding='utf-8').read().split('//')"]
    solve = ["-m", "foon_asp", "solve", "--data", str(options.data), "--goal", options.goal]
    solve += ["--format", "json"]
    checkouts = [ROOT, *([options.against.resolve()] if options.against else [])]
    for checkout in checkouts:  # compiles and fills caches
        seconds(solve, checkout)
    rows = [[seconds(floor), *(seconds(solve, each) for each in checkouts)] for _ in range(options.runs)]
    for place, checkout in enumerate(checkouts, 1):
        ratio = statistics.median(row[place] / row[0] for row in rows)
        print(f"{ratio:.2f} times the floor  {checkout}")
    if options.against:
        print(f"{statistics.median(row[1] / row[2] for row in rows):.2f} times the other checkout")


if __name__ == "__main__":
    main()
