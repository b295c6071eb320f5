"""How the time of a question grows with a network of a plain shape: chain, star, wide unit, ladder, grid, …

    python benchmarks/shapes.py                                   every shape, by units and by kitchen
    python benchmarks/shapes.py --shape chain --objective success --size 1000 --size 10000
    python benchmarks/shapes.py --limit 20                        ends a question after 20 seconds

Each question is a whole process, with all reductions and with none. Beside its processor time in seconds
stands the exponent of the growth from one size to the next: 1 is in proportion to the size.
"""

import argparse
import json
import math
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

Unit = tuple[list[str], list[str]]
SHAPES: dict[str, Callable[[int], tuple[list[Unit], str]]] = {}
STARTED = 0.5  # seconds: below, the start of a process hides how it grows


def shape(make: Callable[[int], tuple[list[Unit], str]]) -> Callable[[int], tuple[list[Unit], str]]:
    """Add a shape to the table, under the name of its function; it returns units and the goal."""
    SHAPES[make.__name__] = make
    return make


@shape
def chain(size: int) -> tuple[list[Unit], str]:
    """Each unit makes what the next one takes."""
    return [([f"o{i}"], [f"o{i + 1}"]) for i in range(size)], f"o{size}"


@shape
def star(size: int) -> tuple[list[Unit], str]:
    """One unit takes what all others make."""
    parts = [([f"raw {i}"], [f"part {i}"]) for i in range(size - 1)]
    return [*parts, ([f"part {i}" for i in range(size - 1)], ["whole"])], "whole"


@shape
def wide(size: int) -> tuple[list[Unit], str]:
    """A single unit takes everything."""
    return [([f"raw {i}" for i in range(size)], ["whole"])], "whole"


@shape
def ladder(size: int) -> tuple[list[Unit], str]:
    """Two chains, and between them units from each rung to the other's."""
    units: list[Unit] = []
    for i in range(size // 4):
        units += [([f"l{i}"], [f"l{i + 1}"]), ([f"r{i}"], [f"r{i + 1}"])]
        units += [([f"l{i + 1}"], [f"r{i + 1}"]), ([f"r{i + 1}"], [f"l{i + 1}"])]
    return units, f"l{size // 4}"


@shape
def grid(size: int) -> tuple[list[Unit], str]:
    """Each cell takes what the cells before it and above it make."""
    side = math.isqrt(size)
    cells = ((i, j) for i in range(1, side + 1) for j in range(1, side + 1))
    return [([f"{i - 1},{j}", f"{i},{j - 1}"], [f"{i},{j}"]) for i, j in cells], f"{side},{side}"


@shape
def cycle(size: int) -> tuple[list[Unit], str]:
    """A chain whose end leads to its beginning."""
    units, _ = chain(size - 2)
    return [(["raw"], ["o0"]), *units, ([f"o{size - 2}"], ["o0"])], f"o{size - 2}"


@shape
def twins(size: int) -> tuple[list[Unit], str]:
    """A chain with two units for each step, one of which takes something more."""
    units: list[Unit] = []
    for i in range(size // 2):
        units += [([f"o{i}"], [f"o{i + 1}"]), ([f"o{i}", f"raw {i}"], [f"o{i + 1}"])]
    return units, f"o{size // 2}"


def written(folder: Path, name: str, size: int) -> tuple[Path, str]:
    """Write a shape as neutral lines, with prices and beside it rates; return the file and the goal."""
    units, goal = SHAPES[name](size)
    file = folder / f"{name}-{size}.jsonl"
    lines = (
        json.dumps({"id": f"m{n % 3}", "inputs": inputs, "outputs": outputs, "price": 1 + n % 7})
        for n, (inputs, outputs) in enumerate(units)
    )
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "rates.txt").write_text("m0\t0.9\nm1\t0.99\nm2\t1\n", encoding="utf-8")
    return file, goal


def asked(file: Path, goal: str, objective: str, reductions: str, limit: float) -> tuple[float, str]:
    """Return the processor's seconds that a question takes, and the status of its answer."""
    words = [sys.executable, "-m", "foon_asp", "solve", str(file), "--goal", goal, "--objective", objective]
    words += ["--time-limit", str(limit), "--format", "json", "--quiet"]
    words += ["--rates", str(file.with_name("rates.txt"))]
    words += [] if reductions == "all" else ["--reduce", "none"]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    ran = subprocess.run(words, capture_output=True, text=True, check=False)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return seconds, json.loads(ran.stdout)["status"] if ran.stdout else f"ended with {ran.returncode}"


def rows(options: argparse.Namespace, folder: Path) -> Iterator[str]:
    """Ask about each shape at each size, and return a line for each."""
    head = ("objective", "units", "all", "grows", "none", "ratio")
    yield f"{'shape':8} " + "{:10} {:>8} {:>8} {:>6} {:>8} {:>6}  status".format(*head)
    for name in options.shape:
        for objective in options.objective:
            before: tuple[int, float] | None = None
            for size in options.size:
                file, goal = written(folder, name, size)
                seconds, status = asked(file, goal, objective, "all", options.limit)
                plain, _ = asked(file, goal, objective, "none", options.limit)
                grows = ""
                if before is not None and before[1] > STARTED:
                    grows = f"{math.log(seconds / before[1]) / math.log(size / before[0]):.2f}"
                before = size, seconds
                yield (
                    f"{name:8} {objective:10} {size:8,} {seconds:8.2f} {grows:>6} {plain:8.2f} "
                    f"{seconds / plain:6.2f}  {status}"
                )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--shape", action="append", choices=SHAPES)
    parser.add_argument("--objective", action="append")
    parser.add_argument("--size", action="append", type=int)
    parser.add_argument("--limit", type=float, default=60)
    options = parser.parse_args()
    options.shape = options.shape or list(SHAPES)
    options.objective = options.objective or ["units", "kitchen"]
    options.size = options.size or [1_000, 10_000, 100_000]
    with tempfile.TemporaryDirectory() as folder:
        for row in rows(options, Path(folder)):
            print(row, flush=True)


if __name__ == "__main__":
    main()
