"""Small random problems, seeded: cycles, skipped utensils that are put out, rates whose products collide."""

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
    """Make a problem of at most so many units; the rule changes nothing else.

    Many a unit with salt in a cup has the cup of salt as an input and as an output, which it does not make
    under ``implied``. So has a unit with flour in a bowl, and some of the problems ask for just that.
    """
    rng = random.Random(seed)
    held = random.Random(f"what is held {seed}")  # of its own, so that nothing else changes with it
    salt, cup = (
        ObjectNode.of("salt", [], [("in", "cup")]),
        ObjectNode.of("cup", [], [], [("contains", ["salt"])]),
    )
    flour = ObjectNode.of("flour", [], [("in", "bowl")])
    bowl = ObjectNode.of("bowl", [], [], [("contains", ["flour"])])
    nodes = [
        ObjectNode.of("salt"),
        salt,
        cup,
        ObjectNode.of("cup", ["empty"]),
        ObjectNode.of("bowl", ["empty"]),
        bowl,
        flour,
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
        if salt in inputs and rng.random() < 0.7:
            inputs.append(cup)
        outputs = rng.sample(nodes, rng.choice((1, 1, 2)))
        for item, vessel in ((salt, cup), (flour, bowl)):
            if item in inputs and held.random() < 0.6:
                inputs.append(vessel)
                outputs.append(vessel)
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
    vessels = [o for o in objects if network.objects[o] in (cup, bowl) and o not in kitchen]
    if vessels and held.random() < 0.2:
        goals = (held.choice(vessels),)
    rates = {motion: Fraction(rng.choice(RATES)) for motion in MOTIONS}
    return Problem(network, kitchen, goals, rates, UTENSILS, rule)
