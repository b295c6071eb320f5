"""Reading a FOON file: the reader beside a hand-written strict line splitter, and the peak memory of both.

The splitter knows one clean dialect, keeps no locations, remarks on nothing and builds every object node anew
each time it is mentioned; it is the least code that gives the same nodes. Each figure is from processes of
its own, in turn, medians of ``--runs``; the answers are compared. ``units`` is reading alone, ``network``
merges the units into a network as well, with the same builder for both.

    python benchmarks/reading.py                              100,000 generated units
    python benchmarks/reading.py --units 1000000 --runs 3
    python benchmarks/reading.py --file FOON.txt
"""

import argparse
import gc
import hashlib
import json
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from foon_asp.network import Contents, NetworkBuilder, ObjectNode, Relation, Source
from foon_asp.text.reader import FoonReader

Unit = tuple[str, list[ObjectNode], list[ObjectNode]]
CONTENDERS = ("splitter", "reader")
TASKS = ("units", "network")


def split_strictly(text: str) -> Iterator[Unit]:
    """Give the units of clean FOON text, and fail in some way on any other."""
    inputs: list[ObjectNode] = []
    outputs: list[ObjectNode] = []
    side, motion, label = inputs, "", ""
    states: list[str] = []
    relations: list[Relation] = []
    contents: list[Contents] = []

    def node() -> ObjectNode:
        return ObjectNode(label, frozenset(states), frozenset(relations), tuple(sorted(contents)))

    for line in text.split("\n"):
        letter = line[:1]
        if letter == "S":
            fields = line.split("\t")
            if len(fields) == 2:
                states.append(fields[1])
            elif fields[2][0] == "[":
                relations.append(Relation(fields[1], fields[2][1:-1]))
            else:
                contents.append(Contents(fields[1], tuple(sorted(fields[2][1:-1].split(",")))))
        elif letter in {"O", "M", "/"}:
            if label:
                side.append(node())
                label, states, relations, contents = "", [], [], []
            if letter == "O":
                label = line.split("\t")[1]
            elif letter == "M":
                motion, side = line.split("\t")[1], outputs
            else:
                if motion:
                    yield motion, inputs, outputs
                inputs, outputs, motion = [], [], ""
                side = inputs


def run(contender: str, task: str, file: Path) -> dict[str, object]:
    """Read the file once; give seconds, peak memory in MB, and a digest of what was read."""
    gc.set_threshold(100_000, 50, 50)  # as the command line has it, for both
    text = file.read_text(encoding="utf-8")
    began = time.perf_counter()
    units: list[Unit] = []
    builder = NetworkBuilder()
    if contender == "splitter":
        for unit in split_strictly(text):
            if task == "units":
                units.append(unit)
            else:
                builder.add(*unit, Source(str(file), 1))
    else:
        for motion, inputs, outputs, sources, _ in FoonReader().units(text, str(file)):
            if task == "units":
                units.append((motion, inputs, outputs))
            else:
                builder.add(motion, inputs, outputs, *sources)
    network = builder.build() if task == "network" else None
    seconds = time.perf_counter() - began
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    digest = hashlib.sha256()
    for unit in units:
        digest.update(repr([unit[0], *map(str, unit[1]), "→", *map(str, unit[2])]).encode())
    if network:
        for unit_id in range(len(network)):
            digest.update(str(network.unit(unit_id)).encode())
    return {"seconds": seconds, "peak": peak, "units": len(network or units), "digest": digest.hexdigest()}


def generated(units: int, seed: int, folder: Path) -> Path:
    """Write a file with so many units and give its path."""
    script = Path(__file__).with_name("generate.py")
    words = ["--family", "recipe-like", "--units", str(units), "--seed", str(seed), "--out", str(folder)]
    subprocess.run([sys.executable, str(script), *words], check=True, stdout=subprocess.DEVNULL)
    return folder / "FOON.txt"


def compare(file: Path, runs: int) -> None:
    """Run the contenders in turn and print the table."""
    megabytes = file.stat().st_size / 1e6
    for task in TASKS:
        results: dict[str, list[dict[str, object]]] = {contender: [] for contender in CONTENDERS}
        for _ in range(runs):
            for contender in CONTENDERS:
                words = [sys.executable, __file__, "--run", contender, task, "--file", str(file)]
                ended = subprocess.run(words, check=True, capture_output=True, text=True)
                results[contender].append(json.loads(ended.stdout))
        if len({result["digest"] for found in results.values() for result in found}) > 1:
            raise SystemExit(f"{task}: the contenders did not read the same")
        medians = {}
        for contender, found in results.items():
            medians[contender] = statistics.median(float(str(result["seconds"])) for result in found)
            peak = statistics.median(float(str(result["peak"])) for result in found)
            speed = megabytes / medians[contender]
            print(
                f"{task:8} {contender:9} {medians[contender]:7.2f} s {speed:6.1f} MB/s {peak:7.0f} MB peak"
                f"   {found[0]['units']} units"
            )
        print(f"{task:8} reader / splitter: {medians['reader'] / medians['splitter']:.2f}")


def main() -> None:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--file", type=Path)
    parser.add_argument("--units", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--run", nargs=2, metavar=("CONTENDER", "TASK"), help=argparse.SUPPRESS)
    chosen = parser.parse_args()
    if chosen.run:
        contender, task = chosen.run
        print(json.dumps(run(contender, task, chosen.file)))
    elif chosen.file:
        compare(chosen.file, chosen.runs)
    else:
        with tempfile.TemporaryDirectory() as folder:
            compare(generated(chosen.units, chosen.seed, Path(folder)), chosen.runs)


if __name__ == "__main__":
    main()
