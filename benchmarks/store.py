"""A store among few and among many units: what a question costs, and what an import does.

The same recipes, kitchen and goals are imported twice: by themselves (``--small`` units), and with as many
others as make ``--units``, whose objects have other labels; so every question has the same cone and the same
answer in both. Every figure is of whole processes, each new, in turn: medians of ``--runs``, seconds from
start to end, seconds of processor (which other work on the machine disturbs less), peak memory as the system
counts it. Files are in the page cache. Answers are compared.

*read*: the text is read and its units dropped, with nothing merged; *import*: ``foon-asp merge --store``;
*solve*: ``foon-asp solve --network STORE --goal NAME``, for each goal with a cone of up to ``--cone`` units.

    python benchmarks/store.py                                 10,000 units and 100,000
    python benchmarks/store.py --units 1000000
    python benchmarks/store.py --units 1000000 --family deep   one store, and all goals of its own
"""

import argparse
import json
import math
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.problem import ContainerRule
from foon_asp.store.store import Store
from foon_asp.store.stored_ids import StoredIds
from foon_asp.text.node_lookup import find_goal

READ = """
import gc, sys
from pathlib import Path
from foon_asp.text.reader import FoonReader
gc.set_threshold(100_000, 50, 50)  # as the command line has it
reader = FoonReader()
for unit in reader.units(reader.text(Path(sys.argv[1])), sys.argv[1]):
    pass
"""

# A process counts the peak of the one that started it as its own, so that has to be a small one.
START = """
import json, os, sys, time
began = time.perf_counter()
process = os.posix_spawn(sys.executable, [sys.executable, *sys.argv[1:]], os.environ)
_, status, usage = os.wait4(process, 0)
seconds = time.perf_counter() - began
processor, peak = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024
print(json.dumps([seconds, processor, peak, os.waitstatus_to_exitcode(status)]), file=sys.stderr)
"""


class Run(NamedTuple):
    """One process: seconds, those of processor, peak memory in MB, and what it printed."""

    seconds: float
    processor: float
    peak: float
    output: str


class Medians(NamedTuple):
    """Medians of several runs."""

    seconds: float
    processor: float
    peak: float


def run(*words: object) -> Run:
    """Run Python with these words to the end."""
    ended = subprocess.run(
        [sys.executable, "-c", START, *map(str, words)], check=True, capture_output=True, text=True
    )
    *messages, figures = ended.stderr.splitlines()
    seconds, processor, peak, code = json.loads(figures)
    if code:
        raise SystemExit("\n".join([f"{words} ended with {code}", *messages]))
    return Run(seconds, processor, peak, ended.stdout)


def medians(runs: Sequence[Run]) -> Medians:
    """Give the median of each figure."""
    return Medians(
        statistics.median(one.seconds for one in runs),
        statistics.median(one.processor for one in runs),
        statistics.median(one.peak for one in runs),
    )


def generate(units: int, seed: int, folder: Path, family: str = "recipe-like") -> None:
    """Write a network with all that stands beside it."""
    words = ["--family", family, "--units", units, "--seed", seed, "--out", folder]
    run(Path(__file__).with_name("generate.py"), *words)


def add_others(folder: Path, others: Path) -> None:
    """Add a network and its kitchen to a folder, under other labels."""
    files = folder / "FOON.txt", others / "FOON.txt"
    with files[0].open("a", encoding="utf-8") as written, files[1].open(encoding="utf-8") as lines:
        written.writelines("O\tother " + line[2:] if line.startswith("O\t") else line for line in lines)
    entries = json.loads((others / "kitchen.json").read_text(encoding="utf-8"))
    for entry in entries:
        entry["label"] = f"other {entry['label']}"
    kitchen = folder / "kitchen.json"
    entries = json.loads(kitchen.read_text(encoding="utf-8")) + entries
    kitchen.write_text(json.dumps(entries), encoding="utf-8")


def small_cones(store: Path, largest: int) -> dict[str, int]:
    """Give the goals of a store whose cones are not too large, with their units."""
    opened = Store(store)
    kitchen = StoredIds(opened, "kitchen")
    cones: dict[str, int] = {}
    for entry in opened.goals:
        goal = find_goal(entry.pattern.label, opened, opened.goals)
        units = len(opened.cone([goal], ContainerRule.STRICT, opened.utensils, kitchen).units)
        if units <= largest:
            cones[entry.pattern.label] = units
    return cones


def answer(output: str) -> object:
    """Give what an answer says, without times and places."""
    found = json.loads(output)
    nodes = [[node["node"] for node in (*unit["inputs"], *unit["outputs"])] for unit in found["units"]]
    trees = [(unit["motion"], *names) for unit, names in zip(found["units"], nodes, strict=True)]
    return found["status"], found["costs"], trees


def measure_import(folder: Path, store: Path, units: int, runs: int) -> Medians:
    """Read and import in turn, print both and the ratio; give the figures of the import."""
    reads, imports = [], []
    for _ in range(runs):
        reads.append(run("-c", READ, folder / "FOON.txt"))
        imports.append(run("-m", "foon_asp", "merge", "--data", folder, "--store", store))
    read, imported = medians(reads), medians(imports)
    for task, found, file in (("read", read, folder / "FOON.txt"), ("import", imported, store)):
        print(
            f"{units:>9} units   {task:6} {found.seconds:8.2f} s {found.processor:8.2f} s of processor"
            f" {found.peak:7.0f} MB peak {file.stat().st_size / 1e6:8.1f} MB"
        )
    print(
        f"{'':15}   import / read: time {imported.seconds / read.seconds:.2f},"
        f" processor {imported.processor / read.processor:.2f}",
        flush=True,
    )
    return imported


def measure_solve(stores: Sequence[Path], goal: str, cone: int, runs: int) -> Medians:
    """Ask both stores in turn, print, and give the ratios."""
    asked: list[list[Run]] = [[], []]
    for _ in range(runs):
        for store, found in zip(stores, asked, strict=True):
            words = ["solve", "--network", store, "--goal", goal, "--format", "json"]
            found.append(run("-m", "foon_asp", *words))
    if len({json.dumps(answer(one.output)) for found in asked for one in found}) > 1:
        raise SystemExit(f"{goal}: the stores do not answer the same")
    few, many = map(medians, asked)
    ratios = Medians(*(b / a for a, b in zip(few, many, strict=True)))
    print(
        f"{cone:>6}  {few.seconds:6.3f} {many.seconds:6.3f} {ratios.seconds:5.2f}"
        f"   {few.processor:6.3f} {many.processor:6.3f} {ratios.processor:5.2f}"
        f"   {few.peak:6.1f} {many.peak:6.1f} {ratios.peak:5.2f}   {goal}",
        flush=True,
    )
    return ratios


def measure_goals(folder: Path, units: int, seed: int, runs: int, family: str) -> None:
    """Import one network, ask each of its goals, print the trees and the medians of the figures."""
    generate(units, seed, folder / family, family)
    store = folder / f"{family}.foon"
    measure_import(folder / family, store, units, runs)
    print("\n  tree  seconds  of processor  MB peak   goal")
    for entry in Store(store).goals:
        words = ["solve", "--network", store, "--goal", entry.pattern.label, "--format", "json"]
        asked = [run("-m", "foon_asp", *words) for _ in range(runs)]
        found, figures = json.loads(asked[0].output), medians(asked)
        if found["status"] != "optimal":
            raise SystemExit(f"{entry.pattern.label}: {found['status']}")
        print(
            f"{len(found['units']):>6} {figures.seconds:8.2f} {figures.processor:13.2f} {figures.peak:8.0f}"
            f"   {entry.pattern.label}",
            flush=True,
        )


def main() -> None:
    """Make the data, run everything and print the ratios."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--units", type=int, default=100_000)
    parser.add_argument("--small", type=int, default=10_000)
    parser.add_argument("--cone", type=int, default=1_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--family", help="of one network, whose own goals are asked")
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        if chosen.family is not None:
            measure_goals(Path(name), chosen.units, chosen.seed, chosen.runs, chosen.family)
            return
        few, many, others = (Path(name) / part for part in ("few", "many", "others"))
        generate(chosen.small, chosen.seed, few)
        shutil.copytree(few, many)
        generate(chosen.units - chosen.small, chosen.seed + 1, others)
        add_others(many, others)
        stores = [Path(name) / "few.foon", Path(name) / "many.foon"]
        imports = [
            measure_import(folder, store, units, chosen.runs)
            for folder, store, units in zip((few, many), stores, (chosen.small, chosen.units), strict=True)
        ]
        growth = math.log(imports[1].seconds / imports[0].seconds) / math.log(chosen.units / chosen.small)
        print(f"{'':15}   import grows with the power {growth:.2f} of the units\n")
        print("  solve: seconds              of processor           MB peak")
        print("  cone     few   many ratio      few   many ratio      few   many ratio   goal")
        ratios = [
            measure_solve(stores, goal, cone, chosen.runs)
            for goal, cone in small_cones(stores[0], chosen.cone).items()
        ]
    for figure, found in zip(Medians._fields, zip(*ratios, strict=True), strict=True):
        print(f"many / few, {figure}: median {statistics.median(found):.2f}, largest {max(found):.2f}")


if __name__ == "__main__":
    main()
