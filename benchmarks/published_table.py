"""How much of the published table of the literature comes out here, and under which rule for ties.

The figures are numbers of functional units (data/published/table1.json). Three things are tried for every
column: ties to the first and to the last unit in file order, under both container rules and both counts of
inputs; and then *any* tie-breaking at all, one choice for each object: clingo says for every published figure
whether some choice among equally good units gives a tree of that many units, and what the least and the
greatest are.

    python benchmarks/published_table.py --data DIR      a folder with the universal FOON of 2021
"""

import argparse
from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path

import clingo

from foon_asp.comparison.published_table import read_published
from foon_asp.problem import ContainerRule, Problem
from foon_asp.resources import published_table
from foon_asp.searches import SEARCHES, Count, SearchSettings, Ties
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import find_goal

# The published procedure with a free choice among equally good units: an object that is needed and not in
# the kitchen is made by exactly one of its candidates, whose needed inputs are needed in turn. It takes the
# outputs of units as annotated, a container that was skipped among them.
FREE_CHOICE = """
needed(O) :- goal(O), not kitchen(O).
{ pick(O,U) : candidate(O,U) } = 1 :- needed(O).
needed(I) :- pick(O,U), needs(U,I), not kitchen(I).
used(U) :- pick(O,U).
#show used/1.
"""

Key = Callable[[int], object]


def candidates(problem: Problem, key: Key) -> dict[int, list[int]]:
    """List for each object the units that are best by a key; all of them where the key is constant."""
    found: dict[int, list[int]] = {}
    for o, producers in enumerate(problem.network.producers):
        if producers:
            best = min(key(unit) for unit in producers)  # type: ignore[type-var]
            found[o] = [unit for unit in producers if key(unit) == best]
    return found


def sizes(problem: Problem, key: Key, wanted: int) -> tuple[int, int, bool]:
    """Give the least and greatest number of units under any choice, and whether one gives ``wanted``."""
    facts = [f"kitchen({o})." for o in problem.kitchen] + [f"goal({o})." for o in problem.goals]
    for o, units in candidates(problem, key).items():
        facts += [f"candidate({o},{unit})." for unit in units]
    for unit, needed in enumerate(problem.needs):
        facts += [f"needs({unit},{o})." for o in needed]

    def best(rules: str, strategy: str = "--opt-strategy=usc,oll,4") -> int | None:
        control = clingo.Control([strategy, "--opt-usc-shrink=min"])
        control.add("base", [], FREE_CHOICE + "".join(facts) + rules)
        control.ground([("base", [])])
        last: list[int] = []
        control.solve(on_model=lambda model: last.append(len(model.symbols(shown=True))))
        return last[-1] if last else None

    least = best("#minimize { 1,U : used(U) }.")
    greatest = best("#maximize { 1,U : used(U) }.")
    exact = best(f":- #count {{ U : used(U) }} != {wanted}.")
    return least or 0, greatest or 0, exact is not None


def keys(problem: Problem, column: str, count: Count) -> Key:
    """Give what a search makes smallest when it chooses a unit; constant where it takes any."""
    network, rates = problem.network, problem.rates or {}

    def inputs(unit: int) -> int:
        nodes = network.inputs[unit]
        if count is Count.NODES:
            return len(nodes)
        return len(nodes) + sum(len(network.objects[o].ingredients) for o in nodes)

    def risk(unit: int) -> Fraction:
        return -rates[network.motions[unit]]

    return {"greedy-success": risk, "greedy-inputs": inputs}.get(column, lambda _: 0)


def main() -> None:
    """Try everything and print it."""
    parser = argparse.ArgumentParser(description="Reproduce the published table as far as it goes.")
    parser.add_argument("--data", type=Path, required=True)
    data = read_data(find_data(parser.parse_args().data))
    table = read_published(published_table())
    goals = {label: find_goal(label, data.network, data.goals) for label in table.goals}

    def problem(label: str, rule: ContainerRule) -> Problem:
        return Problem(data.network, data.kitchen, (goals[label],), data.rates, data.utensils, rule)

    print(f"published: {table.source}")
    print(f"goals: {', '.join(goals)}\n")
    for column in table.columns:
        published = [table.goals[label][column] for label in goals]
        print(f"{column}: published {_list(published)}")
        counts: Sequence[Count] = list(Count) if column == "greedy-inputs" else [Count.INGREDIENTS]
        for rule in ContainerRule:
            for count in counts:
                named = f"{rule}" + (f", counting {count}" if len(counts) > 1 else "")
                for ties in Ties:
                    settings = SearchSettings(ties, count, published=True)
                    found = [len(SEARCHES[column].run(problem(g, rule), settings).units) for g in goals]
                    agree = sum(a == b for a, b in zip(found, published, strict=True))
                    print(f"  {named}, ties to the {ties}: {_list(found)}  ({agree} of {len(found)})")
                ranges = []
                for label, wanted in zip(goals, published, strict=True):
                    one = problem(label, rule)
                    least, greatest, possible = sizes(one, keys(one, column, count), wanted)
                    ranges.append(f"{least}-{greatest}{' yes' if possible else ' NO'}")
                print(f"  {named}, any choice among equals (least-greatest, published figure possible?):")
                print(f"    {' / '.join(ranges)}")
        print()


def _list(numbers: Sequence[int]) -> str:
    return " / ".join(map(str, numbers))


if __name__ == "__main__":
    main()
