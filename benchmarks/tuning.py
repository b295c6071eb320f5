"""What moves when a tuning number is halved or doubled: seconds, proofs and candidates, by instance set.

    python benchmarks/tuning.py                                    every number, on all sets
    python benchmarks/tuning.py --set kitchen --field rounds       one number on one set
    python benchmarks/tuning.py DIR...                             folders of data, also by price

Sets: ``kitchen`` (the bundled kitchen, all goals that can be made), ``recipe-like``, ``deep`` and
``adversarial`` (generated, see generate.py, of ``--units`` units), by units and by success; ``limits`` (deep,
under one use of the commonest motion fewer) and ``proofs`` (certificates of adversarial, by units).
Folders may hold planning tasks and e-graphs written as data (see neutral.py), which are asked by price.

Each number of ``foon_asp/hypergraph/tuning.py`` is halved and doubled in turn. A line says what moved: work
on the set, which is calls of functions and so the same on a busy machine, as a factor where it is off by more
than ``--noise``; questions proved; and questions whose units left to clingo differ. A number that moves
nothing on any set should go. What HiGHS and clingo do in themselves is not in the calls.
"""

import argparse
import cProfile
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import foon_asp
from foon_asp.hypergraph import tuning

CLASSES = ("PRESOLVE", "CUTS", "RELAXATION", "PROOF", "PRICES")
GENERATED = ("recipe-like", "deep", "adversarial")
KITCHEN = Path(__file__).resolve().parents[1] / "data" / "kitchen"


class Run(NamedTuple):
    """A set asked once: calls of functions, the questions proved, and the units left to clingo."""

    calls: int
    proved: tuple[bool, ...]
    units: tuple[int, ...]


def questions(
    folder: Path, objectives: tuple[str, ...], most: int, **options: Any
) -> Iterator[Callable[[], Any]]:
    """Return a question for each of the last goals of a folder and each objective."""
    foon = foon_asp.load(folder, lenient=True)
    for goal in [str(goal) for goal in foon.goals][-most:]:
        for objective in objectives:
            problem = foon.problem(goal)
            yield lambda problem=problem, objective=objective: foon_asp.solve(  # type: ignore[misc]
                problem, objective, time_limit=60, **options
            )


def run(asked: list[Callable[[], Any]]) -> Run:
    """Ask every question once."""
    profile = cProfile.Profile()
    answers = profile.runcall(lambda: [ask() for ask in asked])
    proved = tuple(answer.status in {"optimal", "infeasible"} for answer in answers)
    calls = sum(entry.callcount for entry in profile.getstats())
    return Run(calls, proved, tuple(answer.outcome.left or 0 for answer in answers))


def moved(before: Run, after: Run, noise: float) -> str:
    """Return what differs, empty where nothing does."""
    remarks = []
    factor = after.calls / before.calls
    if abs(factor - 1) > noise:
        remarks.append(f"calls x {factor:.2f}")
    if after.proved != before.proved:
        remarks.append(f"proved {sum(before.proved)} -> {sum(after.proved)}")
    differing = sum(a != b for a, b in zip(before.units, after.units, strict=True))
    if differing:
        remarks.append(f"units left to clingo differ in {differing}")
    return ", ".join(remarks)


def variants(only: list[str]) -> Iterator[tuple[str, str, Any]]:
    """Return the class, a description and the tuning with one number halved, then doubled."""
    for name in CLASSES:
        plain = getattr(tuning, name)
        for field, value in plain._asdict().items():
            if only and field not in only:
                continue
            for factor, word in ((Fraction(1, 2), "halved"), (2, "doubled")):
                changed = max(1, round(value * factor)) if isinstance(value, int) else value * factor
                yield (
                    name,
                    f"{name}.{field} {word} ({float(changed):g})",
                    plain._replace(**{field: changed}),
                )


def sets(options: argparse.Namespace, made: Path) -> Iterator[tuple[str, list[Callable[[], Any]]]]:
    """Return the instance sets by name."""
    chosen, by = options.set or ["kitchen", *GENERATED, "limits", "proofs"], ("units", "success")
    for folder in options.folders:
        yield folder.name, [*questions(folder, ("price",), options.goals)]
    if options.folders:
        return
    if "kitchen" in chosen:
        yield "kitchen", [*questions(KITCHEN, by, options.goals)]
    for family in GENERATED:
        folder = made / family
        words = ["--family", family, "--units", str(options.units), "--seed", "1", "--out", str(folder)]
        script = str(Path(__file__).with_name("generate.py"))
        subprocess.run([sys.executable, script, *words], check=True, stdout=subprocess.DEVNULL)
        if family in chosen:
            yield family, [*questions(folder, by, options.goals)]
        if family == "deep" and "limits" in chosen:
            yield "limits", [*limited(folder, options.goals)]
        if family == "adversarial" and "proofs" in chosen:
            proof = str(made / "proof.json")
            yield "proofs", [*questions(folder, ("units",), options.goals, certificate=proof)]


def limited(folder: Path, most: int) -> Iterator[Callable[[], Any]]:
    """Return questions under a limit that the best tree is beyond."""
    foon = foon_asp.load(folder, lenient=True)
    for goal in [str(goal) for goal in foon.goals][-most:]:
        problem = foon.problem(goal)
        best = foon_asp.solve(problem, "units").outcome
        motions = [problem.network.motions[unit] for unit in best.units or ()]
        if motions:
            motion = max(sorted(set(motions)), key=motions.count)
            rule = f"at_most_motion:limited_motion={motion},max_uses={motions.count(motion) - 1}"
            yield lambda problem=problem, rule=rule: foon_asp.solve(  # type: ignore[misc]
                problem, "units", constraints=[rule], time_limit=60
            )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, metavar="DIR")
    parser.add_argument("--set", action="append")
    parser.add_argument("--field", action="append", default=[])
    parser.add_argument("--units", type=int, default=1000)
    parser.add_argument("--goals", type=int, default=4, help="goals of each network, at most")
    parser.add_argument("--noise", type=float, default=0.02, help="share of calls that counts as nothing")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        asked = dict(sets(options, Path(made)))
        for each in asked.values():
            run(each)  # indexes of the networks are made once
        before = {name: run(each) for name, each in asked.items()}
        for name, plain in before.items():
            print(f"{name}: {len(plain.proved)} questions, {plain.calls:,} calls, {sum(plain.proved)} proved")
        for variable, described, changed in variants(options.field):
            unchanged = getattr(tuning, variable)
            setattr(tuning, variable, changed)
            try:
                remarks = {
                    name: moved(before[name], run(each), options.noise) for name, each in asked.items()
                }
            finally:
                setattr(tuning, variable, unchanged)
            print(
                f"{described}: " + ("; ".join(f"{n}: {r}" for n, r in remarks.items() if r) or "nothing"),
                flush=True,
            )


if __name__ == "__main__":
    main()
