"""Plans in which items are used up, by brute force: the rule anew, and every plan up to a length."""

import random
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from itertools import chain
from typing import NamedTuple

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, UsedUp, needed_inputs

RATES = {"a": Fraction(9, 10), "b": Fraction(1), "c": Fraction(1, 2), "d": Fraction(4, 5)}
UTENSILS = frozenset({"bowl", "knife"})

# Labels, states, places and contents of which nodes are made: so that every case of the rule comes up.
NODES = [
    *(ObjectNode.of(label, [state]) for label in ("egg", "oil", "stove") for state in ("raw", "done")),
    *(ObjectNode.of("bowl", [], [], [("contains", held)] if held else []) for held in ([], ["egg"], ["oil"])),
    ObjectNode.of("bowl", ["dirty"]),
    ObjectNode.of("bowl", [], [], [("contains", ["egg", "oil"])]),
    ObjectNode.of("knife"),
    ObjectNode.of("knife", ["dirty"]),
    ObjectNode.of("egg", ["raw"], [("in", "bowl")]),
    ObjectNode.of("oil", [], [("in", "bowl")]),
    ObjectNode.of("oil", [], [("on", "knife"), ("in", "bowl")]),
]


def stays(node: ObjectNode, inputs: tuple[ObjectNode, ...], outputs: tuple[ObjectNode, ...]) -> bool:
    """Say whether an input stays, as docs/plans.md words it."""
    if node in outputs:
        return True
    if node.label in [output.label for output in outputs]:
        return False
    utensil = node.label in UTENSILS
    tool = utensil and not node.contents
    vessel = utensil and node.label in {r.object for output in outputs for r in output.relations}
    related = {r.object for r in node.relations} & {each.label for each in inputs}
    inside = any(o.label in related and node.label in chain(*(c[1] for c in o.contents)) for o in outputs)
    return tool or vessel or inside


def random_problem(seed: int, most: int = 6) -> Problem:
    """Make a small question with odd things in it: cycles, stocks, goals at hand, inputs that are outputs.

    It has this many units at most.
    """
    choose = random.Random(seed)
    nodes = choose.sample(NODES, choose.randint(4, 9))
    builder = NetworkBuilder()
    for number in range(choose.randint(2, most)):
        inputs = choose.sample(nodes, choose.randint(1, 3))
        outputs = choose.sample(nodes, choose.randint(1, 3))
        builder.add(choose.choice("abcd"), inputs, outputs, Source("by hand", number + 1))
    network = builder.build()
    ids = range(len(network.objects))
    kitchen = frozenset(choose.sample(ids, min(len(ids), choose.randint(1, 4))))
    stocked = [o for o in sorted(kitchen) if choose.random() < 0.5]
    told: dict[str | ObjectNode, bool] = {
        node: choose.random() < 0.5 for node in network.objects if choose.random() < 0.1
    }
    return Problem(
        network,
        kitchen,
        tuple(choose.sample(ids, min(len(ids), choose.choice((1, 1, 2))))),
        RATES,
        UTENSILS,
        choose.choice(list(ContainerRule)),
        items=UsedUp(told, {network.objects[o]: choose.randint(0, 2) for o in stocked}),
    )


class State(NamedTuple):
    """How often each unit was executed, what is there of what runs out, and what was taken of the stock."""

    counts: tuple[int, ...]
    there: tuple[tuple[int, int], ...]
    lent: tuple[tuple[int, int], ...]


def plans(problem: Problem, longest: int) -> Iterator[tuple[Counter[int], int]]:
    """Give every plan up to a length: how often it executes each unit, and the kitchen items it takes."""
    network, items = problem.network, problem.items
    assert items is not None
    ids = {node: o for o, node in enumerate(network.objects)}
    asks: list[set[int]] = []
    uses: list[set[int]] = []
    adds: list[set[int]] = []
    for u in range(len(network)):
        unit = network.unit(u)
        needed = needed_inputs(unit, problem.containers, problem.utensils, network)
        skipped = set(unit.inputs) - set(needed)
        gone = [n for n in needed if not items.told.get(n, stays(n, unit.inputs, unit.outputs))]
        asks.append({ids[n] for n in needed})
        uses.append({ids[n] for n in gone})
        adds.append({ids[n] for n in unit.outputs if n not in unit.inputs and n not in skipped})
    stock = {o: items.stock[network.objects[o]] for o in problem.kitchen if network.objects[o] in items.stock}
    endless = problem.kitchen - stock.keys()

    def done(state: State) -> Iterator[int]:
        there, lent = dict(state.there), dict(state.lent)
        if all(goal in endless or there.get(goal, 0) > 0 for goal in problem.goals):
            for goal in problem.goals:
                if goal in stock:
                    lent[goal] = max(lent[goal], 1 + stock[goal] - there[goal])
            taken = {o for u, n in enumerate(state.counts) if n for o in asks[u] if o in endless}
            yield len(taken) + sum(lent.values())

    first = State((0,) * len(network), tuple(sorted(stock.items())), tuple((o, 0) for o in sorted(stock)))
    layer = {first}
    for length in range(longest + 1):
        following = set()
        for state in layer:
            for kitchen in done(state):
                yield Counter({u: n for u, n in enumerate(state.counts) if n}), kitchen
            for u in range(len(network)) if length < longest else ():
                there, lent = Counter(dict(state.there)), dict(state.lent)
                if not all(o in endless or there[o] > 0 for o in asks[u]):
                    continue
                for o in asks[u] & stock.keys():
                    lent[o] = max(lent[o], 1 + stock[o] - there[o])
                for o in uses[u] - endless:
                    there[o] -= 1
                for o in adds[u] - endless:
                    there[o] += 1
                counts = (*state.counts[:u], state.counts[u] + 1, *state.counts[u + 1 :])
                copies = tuple(sorted((o, n) for o, n in there.items() if n or o in stock))
                following.add(State(counts, copies, tuple(sorted(lent.items()))))
        layer = following


def key(
    problem: Problem, counts: Counter[int], kitchen: int, objectives: tuple[Objective, ...]
) -> tuple[Fraction, ...]:
    """Give what a plan costs, as a key that is smaller for a better one."""
    network = problem.network
    parts = []
    for objective in objectives:
        cost = Fraction(0)
        product = Fraction(1)
        for unit, times in counts.items():
            inputs = [network.objects[o] for o in network.inputs[unit]]
            rate = RATES[network.motions[unit]]
            product *= rate**times
            cost += times * {
                "units": Fraction(1),
                "inputs": Fraction(len(inputs)),
                "inputs+ingredients": Fraction(len(inputs) + sum(len(n.ingredients) for n in inputs)),
                "attempts": 1 / rate,
                "price": problem.prices[unit] or Fraction(0),
            }.get(str(objective), Fraction(0))
        parts.append({"success": -product, "kitchen": Fraction(kitchen)}.get(str(objective), cost))
    return tuple(parts)
