"""Public instances: e-graphs as questions, what the gym's greedy finds, and what cannot be right of a row."""

import itertools
import json
import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
import records
from fields.egraph import EGraph, ENode

from foon_asp.deadline import Deadline
from foon_asp.questions.relax import solve_relaxation


def graph(seed: int, rewarded: bool) -> EGraph:
    """Make a small e-graph with cycles; with ``rewarded``, classes that each extraction has earn rewards."""
    rng = random.Random(seed)
    nodes, classes = [], [f"c{n}" for n in range(5)]
    for eclass in classes:
        for number in range(rng.randint(1, 3)):
            others = [other for other in classes if other != eclass]
            children = tuple(sorted(rng.sample(others, rng.choice((0, 1, 1, 2)))))
            cost = Fraction(rng.choice(("0", "0.1", "1", "2.5")))
            nodes.append(ENode(f"{eclass}.{number}", eclass, children, cost))
    if not rewarded:
        return EGraph("graph", nodes, ("c0", "c1"))
    earned = [ENode(f"r{n}.0", f"r{n}", (), Fraction(rng.choice(("-1", "-0.7")))) for n in range(4)]
    variables = [
        ENode(f"v{v}.{side}", f"v{v}", tuple(sorted(rng.sample([r.eclass for r in earned], 2))), Fraction(0))
        for v in range(3)
        for side in range(2)
    ]
    return EGraph("graph", [*variables, *earned], ("v0", "v1", "v2"))


def extractions(of: EGraph) -> list[Fraction]:
    """Give the costs of all extractions: a node for each class, such that no class needs itself."""
    costs = []
    for nodes in itertools.product(*of.members.values()):
        chosen = {node.eclass: node for node in nodes}
        made: set[str] = set()
        while fresh := {c for c, n in chosen.items() if c not in made and made.issuperset(n.children)}:
            made |= fresh
        if made.issuperset(of.roots):
            costs.append(of.cost(chosen))
    return costs


def test_a_node_without_a_cost_costs_one_and_roots_are_what_no_node_uses(tmp_path: Path) -> None:
    file = tmp_path / "graph.json"
    nodes = {
        "a": {"eclass": "0", "children": ["b", "c"]},
        "b": {"eclass": "1"},
        "c": {"eclass": "2", "children": [], "cost": 2.5},
        "d": {"eclass": "3", "children": ["b"]},
    }
    file.write_text(json.dumps({"nodes": nodes}))
    of = EGraph.read(file)
    assert of.roots == ("0", "3")
    task, offset = of.task()
    assert offset == 0
    assert solve_relaxation(task, Deadline(60)).cost == Fraction("5.5")


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("rewarded", [False, True])
def test_the_best_tree_is_the_cheapest_extraction(seed: int, rewarded: bool) -> None:
    of = graph(seed, rewarded)
    best = min(extractions(of), default=None)
    task, offset = of.task()
    found = solve_relaxation(task, Deadline(60))
    assert found.proved
    assert (None if found.cost is None else found.cost - offset) == best
    greedy = of.greedy()
    assert (greedy is None) == (best is None)
    assert greedy is None or best is None or greedy >= best


def row(engine: str, cost: str, proved: bool, status: str = "proved", known: str = "5") -> dict[str, Any]:
    return {
        "kind": "planning",
        "instance": "task",
        "limit": 5.0,
        "engine": engine,
        "cost": cost,
        "proved": proved,
        "status": status,
        "known": known,
        "took": 1.0,
        "certified": proved,
    }


def test_values_that_cannot_be_right_are_found() -> None:
    right = row("foon-asp", "5", True)
    assert not records.wrong(right, [])
    assert "has 4, and 5 is proved" in records.wrong(row("foon-asp", "4", False), [])
    assert "proves 6, and 5 is known" in records.wrong(row("HiGHS", "6", True), [])
    known = row("HiGHS", "9", True, "open", "9")
    assert not records.wrong(row("foon-asp", "9", False, "open", "9"), [known])
    better = row("foon-asp", "8", False, "open", "9")
    assert "foon-asp has 8 and HiGHS has 9" in records.wrong(better, [known])
    assert records.is_new(better)
    assert records.is_new(row("foon-asp", "9", True, "open", "9"))
    assert not records.is_new(row("foon-asp", "9", False, "open", "9"))
    table = records.report([right, row("HiGHS", "5", False)])
    assert "| foon-asp | 1 | 1 of 1 | 0 of 0 | 1.00 |  |  | 0 | 0 | 1 of 1 |" in table
    assert "| HiGHS | 1 | 0 of 1 | 0 of 0 | > 5.00 |  |  | 0 | 0 |  |" in table
