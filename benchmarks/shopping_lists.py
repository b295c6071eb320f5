"""Is a kitchen item that was taken away on a shopping list, where a goal cannot be made without it?

For each goal of the goals files, both container rules and each kitchen item of the best tree:
``python benchmarks/shopping_lists.py`` for the bundled kitchen, ``--data DIR`` for others, ``--lists N`` for
other numbers of lists, ``--all`` to name each item that is on no list.
"""

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import foon_asp
from foon_asp.problem import ContainerRule, Problem
from foon_asp.problem.relevance import reach


class Case(NamedTuple):
    """A question without one kitchen item that is needed, and the first list that has it, if one has."""

    goal: str
    containers: str
    item: str
    place: int | None
    lists: tuple[tuple[str, ...], ...]


def cases(foon: foon_asp.Foon, lists: int, rules: Sequence[str]) -> Iterator[Case]:
    """Take away one needed item at a time, for each goal of the goals file."""
    for goal in foon.goals:
        for rule in rules:
            problem = foon.problem(goal, containers=rule)
            for o in needed(problem):
                found = foon_asp.shopping_list(problem.vary(without=problem.network.objects[o]), lists=lists)
                named = tuple(tuple(map(str, each.items)) for each in found.lists)
                item = str(problem.network.objects[o])
                place = next((n for n, each in enumerate(named, 1) if item in each), None)
                yield Case(str(goal), rule, item, place, named)


def needed(problem: Problem) -> list[int]:
    """Give the kitchen items without which there is no tree: every tree takes all of them."""
    units = foon_asp.solve(problem).ids or ()
    taken = sorted({o for unit in units for o in problem.needs[unit] if o in problem.kitchen})
    return [o for o in taken if not makeable(replace(problem, kitchen=problem.kitchen - {o}))]


def makeable(problem: Problem) -> bool:
    """Whether all goals can be made."""
    available = reach(problem).available
    return all(available[goal] for goal in problem.goals)


def main(arguments: Sequence[str] | None = None) -> None:
    """Print how many items are on the first list, and on one of those shown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", action="append", help="a data folder; several are counted together")
    parser.add_argument("--lists", type=int, default=3, help="how many lists are shown")
    parser.add_argument(
        "--containers", action="append", choices=list(ContainerRule), help="both if not given"
    )
    parser.add_argument("--all", action="store_true", help="name the items that are not on the first list")
    chosen = parser.parse_args(arguments)
    found: list[Case] = []
    for folder in chosen.data or [None]:
        for case in cases(foon_asp.load(folder), chosen.lists, chosen.containers or list(ContainerRule)):
            found.append(case)
            if chosen.all and case.place != 1:
                print(
                    f"{case.place}: {case.goal} ({case.containers}) without {case.item}: {case.lists}",
                    flush=True,
                )
    first = sum(case.place == 1 for case in found)
    shown = sum(case.place is not None for case in found)
    print(f"{len(found)} items: on the first list {first}, on one of {chosen.lists} lists {shown}")


if __name__ == "__main__":
    main()
