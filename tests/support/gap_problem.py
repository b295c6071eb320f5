"""Problems whose linear relaxation leaves a gap: covers of random graphs with odd cycles."""

import random
from fractions import Fraction
from itertools import combinations

from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import ContainerRule, Problem


def gap_problem(seed: int, corners: int = 5, density: float = 0.7) -> Problem:
    """Ask for every edge of a random graph with a triangle: an edge is made at either of its two corners.

    A corner is made ready by one of two units, whose rates and inputs differ; so the best tree is a least
    cover of the edges by corners. Half of every corner covers a triangle for 3/2, while a whole cover takes
    2.
    """
    rng = random.Random(seed)
    pairs = list(combinations(range(corners), 2))
    edges = sorted({(0, 1), (0, 2), (1, 2), *(pair for pair in pairs if rng.random() < density)})
    table = ObjectNode.of("table")
    tools = [ObjectNode.of("tool", [str(number)]) for number in range(3)]
    ready = [ObjectNode.of("corner", ["ready"], [("at", str(corner))]) for corner in range(corners)]
    made = {
        edge: ObjectNode.of("edge", ["made"], [("from", str(edge[0])), ("to", str(edge[1]))])
        for edge in edges
    }
    done = ObjectNode.of("figure", ["done"])
    builder = NetworkBuilder()
    line = 0
    for corner in range(corners):
        for motion in rng.sample(["clear", "wipe", "scrub"], 2):
            line += 1
            taken = rng.sample(tools, rng.randint(0, 2))
            builder.add(motion, [table, *taken], [ready[corner]], Source("gap", line))
    for edge, node in made.items():
        for corner in edge:
            line += 1
            builder.add("draw", [ready[corner]], [node], Source("gap", line))
    builder.add("finish", list(made.values()), [done], Source("gap", line + 1))
    network = builder.build()
    at_hand = (network.object_id(node) for node in (table, *tools))
    kitchen = frozenset(o for o in at_hand if o is not None)
    goal = network.object_id(done)
    assert goal is not None
    rates = {
        "clear": Fraction("0.9"),
        "wipe": Fraction("0.9"),
        "scrub": Fraction("0.85"),
        "draw": Fraction("0.95"),
    }
    rates["finish"] = Fraction(1)
    dear = {"clear": "0.30", "wipe": "0.1", "scrub": "0.25", "draw": "0.2", "finish": "0"}
    prices = UnitPrices({motion: Fraction(price) for motion, price in dear.items()}, {})
    given = frozenset[str](), ContainerRule.STRICT
    return Problem(network, kitchen, (goal,), rates, *given, unit_prices=prices)
