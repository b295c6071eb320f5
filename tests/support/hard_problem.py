"""Layered networks with much choice and sharing, on which a proof takes long."""

import random
from fractions import Fraction

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Problem


def hard_problem(width: int = 20, depth: int = 12, producers: int = 4, inputs: int = 3) -> Problem:
    """Make ``depth`` layers of ``width`` objects, each with so many producers from the layer before."""
    rng = random.Random(0)
    builder = NetworkBuilder()
    kitchen = [ObjectNode.of(f"item {i}") for i in range(width)]
    layer = kitchen
    rates: dict[str, Fraction] = {}
    for level in range(depth):
        made = [ObjectNode.of(f"part {level} {i}") for i in range(width)]
        for node in made:
            for _ in range(producers):
                motion = f"move {len(rates)}"
                rates[motion] = Fraction(rng.randint(100, 999), 1000)
                builder.add(motion, rng.sample(layer, inputs), [node], Source("layers", len(rates)))
        layer = made
    network = builder.build()
    ids = frozenset(o for node in kitchen if (o := network.object_id(node)) is not None)
    goal = network.object_id(layer[0])
    assert goal is not None
    return Problem(network, ids, (goal,), rates, frozenset(), ContainerRule.STRICT)
