"""The same question as weighted partial MaxSAT, solved by RC2 of PySAT."""

import importlib
from collections.abc import Iterator
from itertools import count
from typing import Any, NamedTuple

from contest.instance import Instance, cuts

_MOST_FILLED = 3_000_000  # clauses of eliminated nodes; above, cycles are cut off when they turn up


class Setting(NamedTuple):
    """How RC2 is set; see its documentation for the words.

    ``elimination`` says that cycles are ruled out in advance by eliminating nodes one after the other,
    instead of when an optimum has one.
    """

    stratified: bool = True
    elimination: bool = True
    solver: str = "g3"
    adapt: bool = True
    exhaust: bool = True
    minz: bool = True


def ready() -> None:
    """Import what solving needs."""
    importlib.import_module("pysat.examples.rc2")


def solve_max_sat(instance: Instance, setting: Setting) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none.

    Clauses that are added later go to a new solver: a stratified one may not be asked again after that.
    """
    formula: Any = importlib.import_module("pysat.formula").WCNF()
    rc2: Any = importlib.import_module("pysat.examples.rc2")
    if not all(instance.makers[goal] for goal in instance.goals):
        return None  # an empty clause, which the solver does not take
    for clause in _clauses(instance, setting.elimination):
        formula.append(clause)
    for action, cost in enumerate(instance.costs):
        if cost:
            formula.append([-action - 1], weight=cost)
    # Where nothing costs anything, there are no strata to begin with.
    kind = rc2.RC2Stratified if setting.stratified and any(instance.costs) else rc2.RC2
    while True:
        options = {"adapt": setting.adapt, "exhaust": setting.exhaust, "minz": setting.minz}
        with kind(formula, solver=setting.solver, incr=False, **options) as solver:
            model = solver.compute()
        if model is None:
            return None
        used = [literal - 1 for literal in model if 0 < literal <= len(instance.units)]
        found = cuts(instance, used)
        if not found:
            return used
        for supports, user in found:
            clause = [support + 1 for support in supports]
            formula.append(clause if user is None else [-user - 1, *clause])


def _clauses(instance: Instance, elimination: bool) -> Iterator[list[int]]:
    makers = instance.makers
    for action, needs in enumerate(instance.needs):
        for node in needs:
            yield [-action - 1, *(maker + 1 for maker in makers[node])]
    for goal in instance.goals:
        yield [maker + 1 for maker in makers[goal]]
    if elimination:
        ordered = _ordered(instance)
        if ordered is not None:
            yield from ordered


def _ordered(instance: Instance) -> list[list[int]] | None:
    """Give clauses that keep nodes on cycles in an order, or ``None`` where there would be too many.

    A literal for each pair of a node and what it is made of; nodes are eliminated one after the other, those
    with the fewest pairs first, and pairs that meet in the eliminated one are joined (vertex elimination,
    Rankooh and Rintanen, AAAI 2022).
    """
    sizes, component = instance.sizes, instance.component
    numbers = count(len(instance.units) + 1)
    clauses: list[list[int]] = []
    arcs: dict[tuple[int, int], int] = {}
    charges: dict[int, list[int]] = {}
    for node in range(instance.nodes):
        if sizes[component[node]] == 1:
            continue
        charges[node] = []
        for action in instance.makers[node]:
            inner = instance.inner(action, node)
            charge = next(numbers) if inner else action + 1
            charges[node].append(charge)
            if inner:
                clauses.append([-charge, action + 1])
            for need in inner:
                if (node, need) not in arcs:
                    arcs[node, need] = next(numbers)
                clauses.append([-charge, arcs[node, need]])
    for action, needs in enumerate(instance.needs):
        clauses += [[-action - 1, *charges[node]] for node in needs if node in charges]
    clauses += [charges[goal] for goal in instance.goals if goal in charges]
    below: dict[int, set[int]] = {node: set() for node in charges}
    above: dict[int, set[int]] = {node: set() for node in charges}
    for node, need in arcs:
        below[node].add(need)
        above[need].add(node)
    buckets: dict[int, set[int]] = {}
    for node in charges:
        buckets.setdefault(len(below[node]) * len(above[node]), set()).add(node)
    while buckets:
        least = min(buckets)
        node = buckets[least].pop()
        if not buckets[least]:
            del buckets[least]
        near = below[node] | above[node]
        before = {n: len(below[n]) * len(above[n]) for n in near}
        for top in above[node]:
            below[top].discard(node)
        for bottom in below[node]:
            above[bottom].discard(node)
        for top in above[node]:
            for bottom in below[node]:
                pair = [-arcs[top, node], -arcs[node, bottom]]
                if top == bottom:
                    clauses.append(pair)
                    continue
                if (top, bottom) not in arcs:
                    arcs[top, bottom] = next(numbers)
                    below[top].add(bottom)
                    above[bottom].add(top)
                clauses.append([*pair, arcs[top, bottom]])
        if len(clauses) > _MOST_FILLED:
            return None
        for n in near:
            now = len(below[n]) * len(above[n])
            if now != before[n]:
                buckets[before[n]].discard(n)
                if not buckets[before[n]]:
                    del buckets[before[n]]
                buckets.setdefault(now, set()).add(n)
    return clauses
