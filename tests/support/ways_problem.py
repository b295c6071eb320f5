"""Problems small enough to be worked out by hand: several ways to one goal."""

from collections.abc import Sequence
from fractions import Fraction

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import Problem

GOAL = ObjectNode.of("goal")


def ways(*chains: Sequence[str], beside: bool = False) -> Problem:
    """Ask for a goal that is made by any of some chains of units, numbered on, with these rates.

    With ``beside``, a last unit makes something that the goal does not need.
    """
    builder = NetworkBuilder()
    rates = {"garnish": Fraction(1)}
    for way, chain in enumerate(chains):
        before = ObjectNode.of("start")
        for step, rate in enumerate(chain):
            after = GOAL if step == len(chain) - 1 else ObjectNode.of(f"way {way}", [str(step)])
            rates[f"go {way} {step}"] = Fraction(rate)
            builder.add(f"go {way} {step}", [before], [after], Source(f"way {way}", step + 1))
            before = after
    if beside:
        builder.add("garnish", [ObjectNode.of("start")], [ObjectNode.of("garnish")], Source("ways", 99))
    network = builder.build()
    goal = network.object_id(GOAL)
    assert goal is not None
    start = network.object_id(ObjectNode.of("start"))
    assert start is not None
    return Problem(network, frozenset({start}), (goal,), rates, frozenset())
