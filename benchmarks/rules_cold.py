"""What a rule adds to a whole cold ``solve``: one process from start to end, with each ready-made constraint.

    python benchmarks/rules_cold.py DIR --goals 25             a universal FOON in a folder
    python benchmarks/rules_cold.py --goals 3                  a quick run on the bundled kitchen

Seeded goals among what can be made, each by ``units`` under both container rules, and every constraint with
constants that the goal's best tree makes sensible. A question under a constraint is held against the same
one without, run directly before it; seconds are those of processors, all processes included, and of several
``--runs`` those of the fastest. Prints a row for each constraint: medians, the worst, and how many were
*within* 1.3 times.
"""

import argparse
import random
import resource
import statistics
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

from rule_certificates import uses

from foon_asp.asp import Settings, solve
from foon_asp.comparison.many import makeable
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.text.data_folder import find_data, read_data

_ALLOWED = 1.3
_ENDED = {0, 1}  # a tree, or that there is none


def spent(words: list[str]) -> float:
    """Give the seconds of processors that a command takes from start to end."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    code = subprocess.run([sys.executable, "-m", "foon_asp", *words], capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert code.returncode in _ENDED, (words, code.stderr.decode())
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    """Ask everything and print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    bundled = Path(__file__).resolve().parents[1] / "data" / "kitchen"
    parser.add_argument("folder", nargs="?", type=Path, default=bundled, metavar="DIR")
    parser.add_argument("--goals", type=int, default=25)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=1, help="of each, of which the fastest counts")
    parser.add_argument("--only", nargs="*", default=(), metavar="CONSTRAINT")
    options = parser.parse_args()
    data = read_data(find_data(options.folder))
    motions = sorted(set(data.network.motions))
    prices = UnitPrices({motion: Fraction(place % 7 + 1, 4) for place, motion in enumerate(motions)}, {})
    rows: dict[str, list[tuple[float, float]]] = {}
    with tempfile.TemporaryDirectory() as name:
        table = Path(name) / "prices.txt"
        table.write_text("".join(f"{motion}\t{float(price)}\n" for motion, price in prices.motions.items()))
        for rule in ContainerRule:
            given = data.rates, data.utensils, rule
            one = Problem(data.network, data.kitchen, (0,), *given, unit_prices=prices)
            goals = random.Random(options.seed).sample(makeable(one), options.goals)
            for goal in goals:
                problem = Problem(data.network, data.kitchen, (goal,), *given, unit_prices=prices)
                units = solve(problem, (Objective.UNITS,), Settings()).units
                assert units
                words = ["solve", "--data", str(options.folder), "--containers", str(rule)]
                words += ["--goal", str(data.network.objects[goal])]
                for use in uses(problem, units, len(units), random.Random(f"{options.seed} {goal}")):
                    constraint = use.partition(":")[0]
                    if not options.only or constraint in options.only:
                        asked = [*words, *(["--unit-prices", str(table)] if "price" in use else [])]
                        pairs = [
                            (spent(asked), spent([*asked, "--constraint", use])) for _ in range(options.runs)
                        ]
                        without, with_ = zip(*pairs, strict=True)
                        rows.setdefault(constraint, []).append((min(without), min(with_)))
    print("| constraint | questions | without s | with s | times | worst | within |")
    print("|---|--:|--:|--:|--:|--:|--:|")
    for constraint, pairs in rows.items():
        ratios = [with_ / without for without, with_ in pairs]
        without, with_ = map(statistics.median, zip(*pairs, strict=True))
        median = statistics.median(ratios)
        print(
            f"| `{constraint}` | {len(pairs)} | {without:.2f} | {with_:.2f} | {median:.2f} "
            f"| {max(ratios):.2f} | {sum(ratio <= _ALLOWED for ratio in ratios)} |"
        )


if __name__ == "__main__":
    main()
