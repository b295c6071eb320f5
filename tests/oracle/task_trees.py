"""The brute-force oracle: every set of units, simulated naively. Shares no code with the program's search."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import combinations

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import ContainerRule, Problem

Allowed = Callable[[tuple[FunctionalUnit, ...]], bool]


def needed(unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str]) -> set[ObjectNode]:
    """Apply the container rule, word for word as the design states it."""
    needs = set(unit.inputs)
    if rule is ContainerRule.IMPLIED:
        for vessel in unit.inputs:
            held = [item for contents in vessel.contents for item in contents.ingredients]
            if vessel.label in utensils and len(held) == 1:
                for item in unit.inputs:
                    located = [relation.object for relation in item.relations]
                    if item != vessel and item.label == held[0] and vessel.label in located:
                        needs.discard(vessel)
    return needs


def made(unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str]) -> set[ObjectNode]:
    """Give what a unit makes: nothing that it put out comes from nothing."""
    asked = needed(unit, rule, utensils)
    return {node for node in unit.outputs if node in asked or node not in unit.inputs}


def makes(problem: Problem, units: tuple[FunctionalUnit, ...]) -> bool:
    """Whether all the units execute in some order and every goal is at hand afterwards."""
    objects = problem.network.objects
    at_hand = {objects[o] for o in problem.kitchen}
    left = list(units)
    while left:
        ready = [u for u in left if needed(u, problem.containers, problem.utensils) <= at_hand]
        if not ready:
            return False
        for unit in ready:
            at_hand |= made(unit, problem.containers, problem.utensils)
        left = [u for u in left if u not in ready]
    return all(objects[goal] in at_hand for goal in problem.goals)


def trees(problem: Problem, allowed: Allowed = lambda _: True) -> Iterator[tuple[FunctionalUnit, ...]]:
    """Give every set of units that is a task tree and is allowed."""
    units = [problem.network.unit(u) for u in range(len(problem.network))]
    for size in range(len(units) + 1):
        for chosen in combinations(units, size):
            if makes(problem, chosen) and allowed(chosen):
                yield chosen


def measure(problem: Problem, tree: tuple[FunctionalUnit, ...], objective: str) -> Fraction:
    """Give what an objective makes small; success counts negative."""
    objects = problem.network.objects
    if objective == "units":
        return Fraction(len(tree))
    if objective == "inputs":
        return Fraction(sum(len(set(unit.inputs)) for unit in tree))
    if objective == "inputs+ingredients":
        total = 0
        for unit in tree:
            for node in set(unit.inputs):
                total += 1 + sum(len(contents.ingredients) for contents in node.contents)
        return Fraction(total)
    if objective == "kitchen":
        at_hand = {objects[o] for o in problem.kitchen}
        used = {n for unit in tree for n in needed(unit, problem.containers, problem.utensils)}
        return Fraction(len(used & at_hand))
    if objective in {"attempts", "price", "dissimilarity"}:
        return sum((_cost(problem, unit, objective) for unit in tree), start=Fraction(0))
    assert problem.rates is not None
    assert objective == "success"
    product = Fraction(1)
    for unit in tree:
        product *= problem.rates[unit.motion]
    return -product


def _cost(problem: Problem, unit: FunctionalUnit, objective: str) -> Fraction:
    if objective == "dissimilarity":  # of what stands in, and here nothing does
        return Fraction(0)
    if objective == "attempts":
        assert problem.rates is not None
        return 1 / problem.rates[unit.motion]
    assert problem.unit_prices is not None
    motions, units = problem.unit_prices
    return units[unit] if unit in units else motions[unit.motion]


def key(problem: Problem, tree: tuple[FunctionalUnit, ...], objectives: list[str]) -> tuple[Fraction, ...]:
    """Give the lexicographic measure of a tree; fewest units decide last."""
    return tuple(measure(problem, tree, objective) for objective in [*objectives, "units"])


def best(
    found: list[tuple[FunctionalUnit, ...]], problem: Problem, objectives: list[str]
) -> tuple[Fraction, ...] | None:
    """Give the best measure among trees, or ``None`` when there is no tree."""
    return min((key(problem, tree, objectives) for tree in found), default=None)
