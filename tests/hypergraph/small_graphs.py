"""Small random graphs, the cheapest derivation by brute force, and a check of proofs by their definition."""

import math
import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Protocol

from foon_asp.hypergraph.exact_optimum import Limit
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.proof_tree import Branch, Broken, CostFixing, Hopeless, Packing, Proof

NOBODY: frozenset[int] = frozenset()


class Bars(Protocol):
    """Rules, as far as a proof rests on them."""

    def barred_actions(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        """Return by rule the actions that are in no derivation with those used and none of the others."""


def random_graph(rng: random.Random, most: int = 11, *, idle: bool = False) -> Hypergraph:
    """Return a graph with cycles, in which every action can run, unless some may be ``idle``."""
    size, actions = rng.randint(4, 8 if most < 20 else 12), rng.randint(6, most)
    needs = [rng.sample(range(size), rng.choice([0, 1, 1, 2])) for _ in range(actions)]
    gives = [rng.sample(range(size), rng.randint(1, 3)) for _ in range(actions)]
    start = rng.sample(range(size), rng.randint(1, 2))
    reached = Hypergraph(size, needs, gives, start).reach()
    able = [a for a in range(actions) if idle or all(reached[o] for o in needs[a])]
    return Hypergraph(size, [needs[a] for a in able], [gives[a] for a in able], start)


def asked(seed: int, prices: Sequence[int] = (1, 1, 2, 10**12)) -> tuple[Hypergraph, list[int], list[int]]:
    """Return a graph, targets that can be reached, and what each action costs."""
    rng = random.Random(seed)
    graph = random_graph(rng)
    reached = graph.reach()
    able = [o for o in range(graph.size) if reached[o] and o not in graph.start]
    targets = rng.sample(able, min(len(able), rng.randint(1, 3)))
    return graph, targets, [rng.choice(prices) for _ in graph.needs]


def reaches(graph: Hypergraph, actions: Iterable[int], targets: Iterable[int]) -> bool:
    """Whether actions alone reach all targets."""
    reached = graph.reach(frozenset(range(len(graph.needs))).difference(actions))
    return all(reached[o] for o in targets)


def best_tree(graph: Hypergraph, targets: list[int], costs: list[int]) -> tuple[int, ...]:
    """Try all sets of actions, and return one of the cheapest that reach the targets."""
    every = range(len(costs))
    sets = (chosen for size in range(len(costs) + 1) for chosen in combinations(every, size))
    return min(
        (chosen for chosen in sets if reaches(graph, chosen, targets)),
        key=lambda chosen: sum(costs[a] for a in chosen),
    )


def cheapest(graph: Hypergraph, targets: list[int], costs: list[int]) -> int:
    """Return what the cheapest set of actions costs that reaches the targets."""
    return sum(costs[a] for a in best_tree(graph, targets, costs))


def crossing(graph: Hypergraph, objects: Iterable[int]) -> set[int]:
    """Return the actions that give one of some objects and need none of them."""
    inside = {*objects}
    sides = enumerate(zip(graph.needs, graph.gives, strict=True))
    return {a for a, (needed, given) in sides if inside.intersection(given) and inside.isdisjoint(needed)}


def parts(proof: Proof) -> Iterator[Proof]:
    """Return a proof and all that are parts of it."""
    yield proof
    below = {Branch: ("without", "using"), CostFixing: ("packing", "others")}.get(type(proof), ())
    for name in below:
        yield from parts(getattr(proof, name))


def require_proves(
    proof: Proof,
    graph: Hypergraph,
    targets: Sequence[int],
    costs: Sequence[int | Fraction],
    least: int | Fraction | None,
    limits: Sequence[Limit] = (),
    rules: Bars | None = None,
    *,
    whole: bool = False,
    used: frozenset[int] = NOBODY,
    without: frozenset[int] = NOBODY,
) -> None:
    """Require that a proof shows, by exact numbers alone, that no derivation costs less than ``least``.

    With ``None``, that there is no derivation at all. ``whole`` rounds all bounds up.
    """

    def nested(proof: Proof, used: frozenset[int], without: frozenset[int]) -> None:
        question = graph, targets, costs, least, limits, rules
        require_proves(proof, *question, whole=whole, used=used, without=without)

    if isinstance(proof, Branch):
        assert proof.action not in used | without
        nested(proof.without, used, without | {proof.action})
        nested(proof.using, used | {proof.action}, without)
        return
    bars = {} if rules is None else rules.barred_actions(used, without)
    if isinstance(proof, Broken):
        assert not used.isdisjoint(bars[proof.rule])
        return
    gone, wanted = without.union(*bars.values()), {*targets, *(o for a in used for o in graph.needs[a])}

    def landmark(objects: Sequence[int]) -> set[int]:
        assert wanted.intersection(objects)
        assert not {*graph.start}.intersection(objects)
        return crossing(graph, objects) - gone

    if isinstance(proof, Hopeless):
        assert not landmark(proof.cut.objects)
        return
    packing = proof.packing if isinstance(proof, CostFixing) else proof
    price = [0 if least is None else cost for cost in costs]
    proved, load = sum((Fraction(price[a]) for a in used), Fraction(0)), [Fraction(0)] * len(costs)
    for row, (weight,) in packing.limits:
        amounts, most = limits[row]
        assert weight > 0
        proved -= weight * (most - sum(amounts.get(a, 0) for a in used))
        for action, amount in amounts.items():
            load[action] -= weight * amount
    for cut, (weight,) in packing.weights:
        assert weight > 0
        proved += weight
        for action in landmark(cut.objects):
            load[action] += weight
    assert all(load[a] <= (0 if a in used else price[a]) for a in range(len(costs)) if a not in gone)
    if least is None:
        assert proved > 0
        return

    def enough(bound: Fraction) -> bool:
        return (math.ceil(bound) if whole or packing.rounded is not None else bound) >= least

    if isinstance(proof, CostFixing):
        assert proof.actions
        assert used.isdisjoint(proof.actions)
        assert all(enough(proved + price[a] - load[a]) for a in proof.actions)
        nested(proof.others, used, without.union(proof.actions))
    else:
        assert isinstance(packing, Packing)
        assert enough(proved)
