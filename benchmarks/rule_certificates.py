"""How many answers under each ready-made constraint have a certificate, and the gap of those without.

A seeded sample of the objects that can be made. The constants are set by the best tree without the
constraint, so that most of the constraints rule it out: its most common motion is limited to one less, and so
on. Every certificate is written as JSON, read again and verified.

    python benchmarks/rule_certificates.py --data DIR --sample 100
    python benchmarks/rule_certificates.py --data DIR --only before at_most_motion
"""

import argparse
import random
import statistics
import time
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Settings, Status, solve
from foon_asp.certificate import certify_outcome
from foon_asp.certificate.certificate import subject_of
from foon_asp.comparison.many import makeable
from foon_asp.deadline import Deadline
from foon_asp.network import UnitPrices
from foon_asp.problem import Objective, Problem, levels
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.verifier import verify
from foon_asp.questions.certificate_text import bound_text
from foon_asp.rules.passed_constraint import given_constraint
from foon_asp.text.data_folder import find_data, read_data


class Row(NamedTuple):
    """One answer: how it ended, whether all of it is proved, or else what is; branches, and seconds."""

    status: str
    proved: bool
    gap: str
    branches: int
    solving: float
    certifying: float


def uses(problem: Problem, units: tuple[int, ...], least: int, rng: random.Random) -> Iterator[str]:
    """Give each constraint with constants that a tree makes sensible; ``least`` units are enough."""
    network = problem.network
    motions = Counter(network.motions[unit] for unit in units)
    common = motions.most_common(1)[0][0]
    sides = [(*network.inputs[unit], *network.outputs[unit]) for unit in units]
    labels = Counter(network.objects[o].label for nodes in sides for o in nodes)
    utensils = [label for label, _ in labels.most_common() if label in problem.utensils] or ["knife"]
    ingredients = [label for label in labels if label not in problem.utensils] or ["salt"]
    made = [network.objects[o].label for unit in units for o in problem.gives[unit]]
    others = sorted(set(network.motions) - motions.keys())
    total = sum((problem.price(unit) for unit in units), Fraction())
    first, last = network.motions[units[0]], network.motions[units[-1]]
    yield f'forbid_motion:forbidden_motion="{rng.choice(sorted(motions))}"'
    yield f'forbid_object:forbidden_object="{utensils[-1]}"'
    yield f'forbid_ingredient:forbidden_ingredient="{rng.choice(ingredients)}"'
    yield "least_rate:least_rate=800000"
    yield f'only_sources:allowed_source="{network.sources[units[-1]][0].file}"'
    yield "at_least_videos:least_videos=1"
    yield f'motion_only_with:tied_motion="{common}",tied_utensil="{utensils[0]}"'
    yield f'never_heated:unheated_ingredient="{rng.choice(ingredients)}"'
    yield f'require_motion:required_motion="{rng.choice(others)}"'
    yield f'require_object:required_object="{rng.choice(sorted(problem.utensils))}"'
    yield f'require_ingredient:required_ingredient="{rng.choice(["garlic", "salt", "butter", "onion"])}"'
    yield f'require_intermediate:required_intermediate="{rng.choice(made)}"'
    yield f"at_most_units:max_units={least}"
    yield f'at_most_motion:limited_motion="{common}",max_uses={motions[common] - 1}'
    yield f'at_most_utensil_uses:limited_utensil="{utensils[0]}",max_utensil_uses={labels[utensils[0]] // 2}'
    yield f"at_most_utensils:max_utensils={max(len(utensils) - 1, 0)}"
    yield f"at_most_price:max_price={int(total * 100) - 1}"
    yield f'not_both_motions:one_motion="{first}",other_motion="{last}"'
    pair = rng.sample([*sorted(motions), common, rng.choice(others)], 2)
    yield f'before:earlier_motion="{pair[0]}",later_motion="{pair[1]}"'


def branches(proof: object) -> int:
    """Count the branches of a proof."""
    if not isinstance(proof, dict) or "branch" not in proof:
        return 0
    return 1 + branches(proof["without"]) + branches(proof["using"])


def measure(problem: Problem, objective: Objective, use: str, limit: float) -> Row:
    """Solve, certify and verify one goal under one constraint."""
    settings = Settings((given_constraint(use),), deadline=Deadline(limit))
    began = time.perf_counter()
    outcome = solve(problem, (objective,), settings)
    solving = time.perf_counter() - began
    if outcome.proof is None:
        return Row(outcome.status, False, "not solved", 0, solving, 0.0)
    began = time.perf_counter()
    end = time.monotonic() + limit
    _, found = certify_outcome(outcome, settings, lambda: time.monotonic() >= end)
    certifying = time.perf_counter() - began
    if found is None:
        return Row(outcome.status, False, "nothing found", 0, solving, certifying)
    content = read_certificate(found.text())
    assert not verify(content, subject_of(problem)).not_covered
    proved = found.claim == "infeasible" or (
        found.claim == "optimal" and found.certified == levels((objective,))
    )
    gap = "" if proved else bound_text(content)
    return Row(outcome.status, proved, gap, branches(content["proof"]), solving, certifying)


def main() -> None:
    """Measure and print a table, and what is not proved."""
    parser = argparse.ArgumentParser(description="Certificates under each ready-made constraint.")
    bundled = Path(__file__).resolve().parents[1] / "data" / "kitchen"
    parser.add_argument("--data", type=Path, default=bundled)
    parser.add_argument("--sample", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=20.0, help="seconds for solving, and for certifying")
    parser.add_argument("--only", nargs="*", default=(), metavar="CONSTRAINT")
    options = parser.parse_args()
    data = read_data(find_data(options.data))
    motions = sorted(set(data.network.motions))
    prices = UnitPrices({motion: Fraction(place % 7 + 1, 4) for place, motion in enumerate(motions)}, {})
    one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, unit_prices=prices)
    goals = makeable(one)
    goals = random.Random(options.seed).sample(goals, min(options.sample, len(goals)))
    rows: dict[tuple[str, Objective], list[Row]] = {}
    left: list[str] = []
    for goal in goals:
        least = 0
        for objective in (Objective.UNITS, Objective.SUCCESS):
            given = data.network, data.kitchen, (goal,), data.rates, data.utensils
            problem = Problem(*given, unit_prices=prices)
            units = solve(problem, (objective,)).units
            assert units
            least = least or len(units)
            for use in uses(problem, units, least, random.Random(f"{options.seed} {goal}")):
                name = use.partition(":")[0]
                if not options.only or name in options.only:
                    row = measure(problem, objective, use, options.limit)
                    rows.setdefault((name, objective), []).append(row)
                    if not row.proved:
                        node = data.network.objects[goal]
                        left.append(f"{node} by {objective} under {use}: {row.status}, {row.gap}")
    print(
        "| constraint | objective | optimal | infeasible | proved | branching | solving ms | certificate ms |"
    )
    print("|---|---|--:|--:|--:|--:|--:|--:|")
    for (name, objective), found in rows.items():
        states = Counter(row.status for row in found)
        times = [
            f"{statistics.median(values) * 1000:.0f} / {max(values) * 1000:.0f}"
            for values in ([row.solving for row in found], [row.certifying for row in found])
        ]
        print(
            f"| `{name}` | {objective} | {states[Status.OPTIMAL]} | {states[Status.INFEASIBLE]} "
            f"| {sum(row.proved for row in found)} | {sum(row.branches > 0 for row in found)} "
            f"| {times[0]} | {times[1]} |"
        )
    print(*left, sep="\n")


if __name__ == "__main__":
    main()
