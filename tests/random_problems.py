"""Small random problems, seeded: cycles, utensils, rates whose products collide."""

import random
from fractions import Fraction

import pytest

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem

UTENSILS = frozenset({"bowl", "cup"})
MOTIONS = ("pour", "cut", "mix", "wash", "cook", "bake")

# Products of these collide exactly (0.3 * 0.3 = 0.09, 0.1 * 0.9 = 0.09, 0.5 * 0.18 = 0.09) or nearly
# (0.300000001 * 0.3 and 0.09 * 1 differ in the ninth digit), and 1 costs nothing.
RATES = ("0.3", "0.09", "0.1", "0.9", "0.5", "0.18", "0.300000001", "0.090000001", "1", "0.25")

# How many seeds of a series a test takes: the first third of them, and all among the slow tests.
SERIES = pytest.mark.parametrize("part", [3, pytest.param(1, marks=pytest.mark.slow)])


def random_problem(seed: int, rule: ContainerRule, units: int = 8) -> Problem:
    """Make a problem of at most so many units; the rule changes nothing else."""
    rng = random.Random(seed)
    nodes = [
        ObjectNode.of("salt"),
        ObjectNode.of("salt", [], [("in", "cup")]),
        ObjectNode.of("cup", [], [], [("contains", ["salt"])]),
        ObjectNode.of("cup", ["empty"]),
        ObjectNode.of("bowl", ["empty"]),
        ObjectNode.of("bowl", [], [], [("contains", ["flour"])]),
        ObjectNode.of("flour", [], [("in", "bowl")]),
        ObjectNode.of("bowl", [], [], [("contains", ["flour", "salt"])]),
        ObjectNode.of("dough", ["raw"], [("in", "bowl")]),
        ObjectNode.of("dough", ["baked"], [("on", "tray")]),
        ObjectNode.of("tray", ["hot"], [], [("contains", ["dough"]), ("greased", ["butter"])]),
        ObjectNode.of("knife"),
    ]
    nodes = rng.sample(nodes, rng.randint(6, len(nodes)))
    builder = NetworkBuilder()
    for line in range(rng.randint(units // 2, units)):
        inputs: list[ObjectNode] = rng.sample(nodes, rng.choice((1, 1, 2, 2, 3)))
        if ObjectNode.of("salt", [], [("in", "cup")]) in inputs and rng.random() < 0.7:
            inputs.append(ObjectNode.of("cup", [], [], [("contains", ["salt"])]))
        outputs = rng.sample(nodes, rng.choice((1, 1, 2)))
        builder.add(rng.choice(MOTIONS), inputs, outputs, Source("random", line + 1))
    network = builder.build()
    objects = range(len(network.objects))
    kitchen = frozenset(rng.sample(objects, min(len(objects), rng.randint(1, 4))))
    others = [o for o in objects if o not in kitchen] or list(objects)
    made = set(kitchen)
    for _ in range(len(network)):
        for needs, gives in zip(network.inputs, network.outputs, strict=True):
            if made.issuperset(needs):
                made.update(gives)
    if rng.random() < 0.8:  # mostly ask for what can be made, and sometimes for anything
        others = sorted(made - kitchen) or others
    goals = tuple(rng.sample(others, min(len(others), rng.choice((1, 1, 1, 2)))))
    rates = {motion: Fraction(rng.choice(RATES)) for motion in MOTIONS}
    return Problem(network, kitchen, goals, rates, UTENSILS, rule)
