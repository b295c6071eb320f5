"""Plans with amounts by brute force: Dijkstra over multisets of copies, with a meaning of its own.

``python -m tests.oracle.amounts 0 5000`` holds answers to random problems against it.
"""

import random
import sys
from collections import Counter
from fractions import Fraction
from heapq import heappop, heappush
from typing import NamedTuple

from foon_asp.asp import Settings, Status
from foon_asp.asp.optimum import solve
from foon_asp.deadline import Deadline
from foon_asp.network import FunctionalUnit, NetworkBuilder, ObjectNode, Source, UnitAmounts, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, UsedUp
from tests.oracle.used_up import UTENSILS, stays

MAX_STATES = 4_000
"""States after which the oracle gives up a problem."""

RATES = {"a": Fraction(9, 10), "b": Fraction(1), "c": Fraction(1, 2), "d": Fraction(4, 5)}
LABELS = ("log", "plank", "stick", "coal", "torch", "knife", "bowl")


class Crafting(NamedTuple):
    """What one execution of a unit asks for, and what it changes."""

    asks: Counter[ObjectNode]
    change: Counter[ObjectNode]


def random_amounts(seed: int) -> Problem:
    """Make a small question with amounts: by-products, catalysts, cycles, stocks and several goals."""
    choose = random.Random(seed)
    nodes = [ObjectNode(label) for label in choose.sample(LABELS, choose.randint(3, 5))]
    builder, amounts = NetworkBuilder(), dict[FunctionalUnit, UnitAmounts]()
    for number in range(choose.randint(2, 5)):
        inputs, outputs = (choose.sample(nodes, choose.randint(1, 2)) for _ in range(2))
        motion = choose.choice("abcd")
        builder.add(motion, inputs, outputs, Source("by hand", number + 1))
        taken, made = (
            {node: choose.randint(2, 4) for node in side if choose.random() < 0.5}
            for side in (inputs, outputs)
        )
        amounts[FunctionalUnit.of(motion, inputs, outputs)] = UnitAmounts(taken, made)
    network = builder.build()
    ids = range(len(network.objects))
    kitchen = frozenset(choose.sample(ids, min(len(ids), choose.randint(1, 2))))
    stock = {network.objects[o]: choose.randint(0, 6) for o in sorted(kitchen) if choose.random() < 0.7}
    goals = tuple(choose.sample(ids, min(len(ids), choose.choice((1, 1, 1, 2)))))
    wanted = {network.objects[o]: choose.randint(2, 5) for o in goals if choose.random() < 0.7}
    told: dict[str | ObjectNode, bool] = {n: choose.random() < 0.5 for n in nodes if choose.random() < 0.1}
    return Problem(
        network,
        kitchen,
        goals,
        RATES,
        UTENSILS,
        choose.choice(list(ContainerRule)),
        unit_prices=UnitPrices({motion: Fraction(choose.randint(0, 6), 2) for motion in "abcd"}, {}),
        items=UsedUp(told, stock, wanted),
        amounts=amounts,
    )


def craftings(problem: Problem) -> list[Crafting]:
    """Say what each unit does with copies, as docs/plans.md words it; no node here has contents."""
    assert problem.items is not None
    found = []
    for number in range(len(problem.network)):
        unit = problem.network.unit(number)
        taken, made = problem.amounts.get(unit, UnitAmounts())
        asks = Counter({node: taken.get(node, 1) for node in unit.inputs})
        adds = Counter({node: made.get(node, 1) for node in unit.outputs})
        change: Counter[ObjectNode] = Counter()
        for node, n in asks.items():
            told = problem.items.told.get(node, problem.items.told.get(node.label))
            if told is None and node in adds:
                change[node] -= max(0, n - adds[node])
            elif not (stays(node, unit.inputs, unit.outputs) if told is None else told):
                change[node] -= n
        for node, n in adds.items():
            change[node] += max(0, n - asks[node])
        found.append(Crafting(asks, change))
    return found


def least_cost(problem: Problem, objective: Objective) -> Fraction | None:
    """Return the least cost of a plan by units, inputs, price or attempts; ``None`` where none was found.

    Raises :class:`OverflowError` where the search is given up.
    """
    assert problem.items is not None
    nodes = problem.network.objects
    endless = {nodes[o] for o in problem.kitchen if nodes[o] not in problem.items.stock}
    wanted = {nodes[o]: problem.items.wanted.get(nodes[o], 1) for o in problem.goals}
    start = Counter(
        {n: c for n, c in problem.items.stock.items() if problem.network.object_id(n) in problem.kitchen}
    )
    moves = craftings(problem)
    costs = [_cost(problem, unit, objective) for unit in range(len(moves))]
    waiting: list[tuple[Fraction, int, tuple[tuple[str, int], ...]]] = [(Fraction(0), 0, _state(start))]
    seen: set[tuple[tuple[str, int], ...]] = set()
    number = 0
    while waiting:
        cost, _, state = heappop(waiting)
        if state in seen:
            continue
        seen.add(state)
        copies = Counter({ObjectNode(label): n for label, n in state})
        if all(node in endless or copies[node] >= n for node, n in wanted.items()):
            return cost
        if len(seen) > MAX_STATES:
            raise OverflowError
        for unit, (asks, change) in enumerate(moves):
            if all(node in endless or copies[node] >= n for node, n in asks.items()):
                after = copies.copy()
                for node, n in change.items():
                    if node not in endless:
                        after[node] += n
                number += 1
                heappush(waiting, (cost + costs[unit], number, _state(after)))
    return None


def _state(copies: Counter[ObjectNode]) -> tuple[tuple[str, int], ...]:
    return tuple(sorted((node.label, n) for node, n in copies.items() if n))


def _cost(problem: Problem, unit: int, objective: Objective) -> Fraction:
    network = problem.network
    price = problem.prices[unit]
    assert price is not None
    return {
        Objective.UNITS: Fraction(1),
        Objective.INPUTS: Fraction(len(network.inputs[unit])),
        Objective.PRICE: price,
        Objective.ATTEMPTS: 1 / RATES[network.motions[unit]],
    }[objective]


OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.PRICE, Objective.ATTEMPTS)


def outcome(seed: int, objective: Objective, seconds: float = 10) -> str:
    """Hold our answer against the oracle: ``right``, ``wrong``, ``unknown``, or ``open`` if it gives up."""
    problem = random_amounts(seed)
    try:
        least = least_cost(problem, objective)
    except OverflowError:
        return "open"
    answer = solve(problem, (objective,), Settings(deadline=Deadline(seconds)))
    if answer.status is Status.INFEASIBLE:
        return "right" if least is None else "wrong"
    if answer.status is not Status.OPTIMAL or answer.costs is None:
        return "unknown"
    return "right" if answer.costs.measure(objective) == least else "wrong"


def main(first: int, last: int) -> Counter[str]:
    """Count the outcomes of many problems, each by one objective."""
    counts: Counter[str] = Counter()
    for seed in range(first, last):
        objective = OBJECTIVES[seed % len(OBJECTIVES)]
        found = outcome(seed, objective)
        counts[found] += 1
        if found in {"wrong", "unknown"}:
            print(f"seed {seed} by {objective}: {found}")
    return counts


if __name__ == "__main__":
    print(dict(main(*map(int, sys.argv[1:]))))
