"""How large networks and hard ones are solved, with reductions before the search and without.

    python benchmarks/reduction.py --family deep --family recipe-like --units 1000 --units 10000 --seed 1
    python benchmarks/reduction.py DIR...      networks in folders, such as a universal FOON

Prints a table in Markdown, a row for each goal and objective: the units that the goal can need (``cone``),
the units left to clingo, seconds in the reductions and in clingo (facts, grounding, solving), how the answer
is proved, its value, and the bound on all trees. Below it are the seconds spent once for each network
(reading it, and the index of who makes what), and the answers that were not proved. ``--plain SECONDS``
solves each question again with ``--reduce none`` for at most so long; answers of both are compared, and the
exit code is 1 where they differ. Goals without a tree do not count where times are compared.
"""

import argparse
import gc
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import ALL, NONE, reduce
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import nodes_of_entry

COLUMNS = (
    "data",
    "goal",
    "objective",
    "cone",
    "left",
    "tree",
    "reduce s",
    "clingo s",
    "all s",
    "status",
    "proof",
    "value",
    "bound",
    "none s",
)


def main() -> int:
    """Read the command line, solve everything and print; 1 where two answers differ."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folders", nargs="*", type=Path, metavar="DIR")
    parser.add_argument("--family", action="append", default=[], metavar="NAME", help="see generate.py")
    parser.add_argument("--units", action="append", type=int, default=[])
    parser.add_argument("--seed", action="append", type=int, default=[])
    parser.add_argument("--goals", type=int, help="the number of last goals of each, by default all")
    parser.add_argument("--objectives", default="units,inputs,success")
    parser.add_argument("--containers", type=ContainerRule, default=ContainerRule.STRICT)
    parser.add_argument("--limit", type=float, default=60, metavar="SECONDS")
    parser.add_argument("--plain", type=float, metavar="SECONDS", help="also without reductions")
    arguments = parser.parse_args()
    print("| " + " | ".join(COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS))
    totals = _Totals()
    for folder in arguments.folders:
        _solve_folder(folder, arguments, totals)
    with tempfile.TemporaryDirectory() as made:
        for family in arguments.family:
            for units in arguments.units or [1000]:
                for seed in arguments.seed or [1]:
                    folder = Path(made) / f"{family}-{units}-{seed}"
                    words = [f"--family={family}", f"--units={units}", f"--seed={seed}", f"--out={folder}"]
                    script = Path(__file__).with_name("generate.py")
                    subprocess.run([sys.executable, script, *words], check=True, stdout=sys.stderr)
                    _solve_folder(folder, arguments, totals)
    return totals.tell()


class _Totals:
    """What is told at the end."""

    def __init__(self) -> None:
        self.once: dict[str, str] = {}
        self.seconds: dict[str, list[tuple[float, float]]] = {}
        self.unproved: list[str] = []
        self.different = 0

    def tell(self) -> int:
        for name, figures in self.seconds.items():
            ours = [spent for spent, _ in figures]
            print(
                f"{name}: {self.once[name]}; {len(figures)} questions, median {median(ours):.3f} s, "
                f"worst {max(ours):.2f} s"
            )
            ratios = [plain / spent for spent, plain in figures if plain]
            if ratios:
                print(f"  without reductions: {median(ratios):.1f} times as long in the median")
        print(f"not proved: {len(self.unproved)}; different: {self.different}")
        for line in self.unproved:
            print(f"  {line}")
        return 1 if self.different else 0


def _solve_folder(folder: Path, arguments: argparse.Namespace, totals: _Totals) -> None:
    began = time.perf_counter()
    data = read_data(find_data(folder, (), None, None, None, None), lenient=True)
    read = time.perf_counter() - began
    gc.collect()
    began = time.perf_counter()
    _ = data.network.producers  # an index of the network, which all goals share
    totals.once[folder.name] = f"read in {read:.2f} s, indexed in {time.perf_counter() - began:.2f} s"
    goals = list(dict.fromkeys(node for entry in data.goals for node in nodes_of_entry(entry, data.network)))
    chosen = range(len(goals))[-(arguments.goals or len(goals)) :]
    for number in chosen:
        problem = Problem(
            data.network, data.kitchen, (goals[number],), data.rates, data.utensils, arguments.containers
        )
        _ = problem.needs
        for name in arguments.objectives.split(","):
            _solve_one(folder.name, number + 1, problem, Objective(name), arguments, totals)


def _solve_one(
    data: str,
    number: int,
    problem: Problem,
    objective: Objective,
    arguments: argparse.Namespace,
    totals: _Totals,
) -> None:
    cone = len(reduce(problem, levels((objective,)), NONE).units)
    began = time.perf_counter()
    outcome = solve(problem, (objective,), Settings(deadline=Deadline(arguments.limit), reductions=ALL))
    spent = time.perf_counter() - began
    note, plain = "", 0.0
    if arguments.plain:
        began = time.perf_counter()
        other = solve(problem, (objective,), Settings(deadline=Deadline(arguments.plain), reductions=NONE))
        plain = time.perf_counter() - began
        note = f"{plain:.3f}"
        if other.status is Status.FEASIBLE:
            note = f"> {note}"
        elif not _agree(outcome, other, objective):
            totals.different += 1
            note += " DIFFERENT"
    totals.seconds.setdefault(data, []).append((spent, plain if outcome.units else 0.0))
    row = list(_row(data, number, objective, cone, outcome, spent, note))
    print("| " + " | ".join(row) + " |", flush=True)
    if outcome.status is Status.FEASIBLE:
        value, bound = row[-3:-1]
        totals.unproved.append(f"{data}, goal {number}, {objective}: {value}, bound {bound}")


def _agree(one: Outcome, plain: Outcome, objective: Objective) -> bool:
    if one.costs is None or plain.costs is None:
        return one.costs is plain.costs
    ours, theirs = (outcome.costs.key(levels((objective,))) for outcome in (one, plain) if outcome.costs)
    return ours == theirs if one.status is Status.OPTIMAL else ours >= theirs


def _row(
    data: str, number: int, objective: Objective, cone: int, outcome: Outcome, spent: float, plain: str
) -> Iterator[str]:
    figures = outcome.seconds
    yield from (data, str(number), objective, str(cone), str(outcome.left), str(len(outcome.units or ())))
    clingo = sum(figures.get(phase, 0) for phase in ("facts", "ground", "solve"))
    yield from (f"{figures['cut']:.3f}", f"{clingo:.3f}", f"{spent:.3f}")
    yield from (outcome.status, outcome.proof or "")
    if outcome.costs is None:
        yield from ("", "")
    else:
        yield f"{float(outcome.costs.measure(objective)):.4g}"
        yield f"{float(outcome.bounds[objective]):.4g}"
    yield plain


if __name__ == "__main__":
    sys.exit(main())
