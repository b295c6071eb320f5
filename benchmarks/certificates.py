"""How many optima have a certificate, how large it is, and how long finding and checking it take.

A seeded sample of the objects that can be made; for each, both container rules and three objectives. Times
are those of one process in which everything is imported and read: what finding a certificate, checking it
and solving take by themselves. Every certificate is written as JSON, read again and verified, and where the
checker proved in Coq is built, accepted by it as well: a process of its own, which is given all data as text.

    python benchmarks/certificates.py                       the bundled kitchen
    python benchmarks/certificates.py --data DIR --sample 500
"""

import argparse
import random
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from foon_asp.asp import solve
from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.comparison.many import makeable
from foon_asp.hypergraph.covering import Covering
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.proof import proved_checker
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.verifier import verify
from foon_asp.text.data_folder import find_data, read_data

Result = TypeVar("Result")
_OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)


class Row(NamedTuple):
    """One goal under one rule and objective; ``leaves`` is 0 where not all of the claim is certified."""

    cuts: int
    leaves: int
    size: int
    certify: float
    solve: float
    verify: float
    proved: float


def timed(function: Callable[[], Result]) -> tuple[float, Result]:
    """Give the seconds that a call takes, and its result."""
    began = time.perf_counter()
    result = function()
    return time.perf_counter() - began, result


def leaves(proof: dict[str, Any]) -> int:
    """Count the leaves of a proof."""
    return leaves(proof["without"]) + leaves(proof["using"]) if "branch" in proof else 1


def measure(problem: Problem, objective: Objective, limit: float) -> Row:
    """Solve, certify and verify one goal."""
    solving, outcome = timed(lambda: solve(problem, (objective,)))
    units, wanted = outcome.units, levels((objective,))
    assert units is not None
    end = time.monotonic() + limit
    seconds, found = timed(lambda: certify(problem, wanted, units, expired=lambda: time.monotonic() >= end))
    if found is None or found.claim != "optimal" or found.certified != wanted:
        return Row(0, 0, 0, seconds, solving, 0.0, 0.0)
    text = found.text()
    content = read_certificate(text)
    checking, _ = timed(lambda: verify(content, subject_of(problem)))
    proving, answer = timed(lambda: proved_checker.check_certificate(content, subject_of(problem)))
    assert answer in (proved_checker.ACCEPTED, proved_checker.NOT_BUILT)
    size = len(text.encode())
    return Row(len(content["cuts"]), leaves(content["proof"]), size, seconds, solving, checking, proving)


def spread(values: Sequence[float], factor: float, form: str) -> str:
    """Give median and worst."""
    return f"{statistics.median(values) * factor:{form}} / {max(values) * factor:{form}}"


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(description="Certificates of a sample of all makeable objects.")
    bundled = Path(__file__).resolve().parents[1] / "data" / "kitchen"
    parser.add_argument("--data", type=Path, default=bundled)
    parser.add_argument("--sample", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for one certificate")
    options = parser.parse_args()
    data = read_data(find_data(options.data))
    loading, _ = timed(lambda: Covering([1.0]))
    print(f"{len(data.network)} units; loading HiGHS takes {loading * 1000:.0f} ms, once\n")
    print(
        "| containers | objective | goals | certified | branching | cuts | kB | certificate ms | solving ms "
        "| certificate / solving | verifying ms | by the proved checker ms |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for rule in ContainerRule:
        one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, rule)
        goals = makeable(one)
        goals = random.Random(options.seed).sample(goals, min(options.sample, len(goals)))
        for objective in _OBJECTIVES:
            rows = []
            for number, goal in enumerate(goals, 1):
                problem = Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, rule)
                rows.append(measure(problem, objective, options.limit))
                if sys.stderr.isatty():
                    print(f"\r{rule} {objective} {number}", end="", file=sys.stderr)
            done = [row for row in rows if row.leaves]
            print(
                f"| {rule} | {objective} | {len(rows)} | {len(done)} | {sum(row.leaves > 1 for row in done)} "
                f"| {spread([row.cuts for row in done], 1, '.0f')} "
                f"| {spread([row.size for row in done], 0.001, '.1f')} "
                f"| {spread([row.certify for row in rows], 1000, '.0f')} "
                f"| {spread([row.solve for row in rows], 1000, '.0f')} "
                f"| {spread([row.certify / row.solve for row in rows], 1, '.1f')} "
                f"| {spread([row.verify for row in done], 1000, '.0f')} "
                f"| {spread([row.proved for row in done], 1000, '.0f')} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
