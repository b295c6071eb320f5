"""Recipes and certificates written by hand in few words."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import Problem
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.verified_claim import Verified
from foon_asp.text.line_parser import parse_node
from tests.support.handmade_certificate import Content, check, handmade


def recipe(
    *units: str,
    kitchen: str = "start",
    goals: str = "",
    utensils: str = "",
    rates: Mapping[str, Any] | None = None,
) -> Problem:
    """Build a problem of units written ``motion: input + input > output``.

    Without named goals, the goal is the first output of the last unit that is none of its inputs. Where there
    are ``rates``, those of other motions are 1/2.
    """
    builder = NetworkBuilder()
    for line, unit in enumerate(units, 1):
        motion, _, sides = unit.partition(":")
        inputs, outputs = map(_nodes, sides.split(">"))
        builder.add(motion, inputs, outputs, Source("by hand", line))
    network = builder.build()
    at_hand, wanted = (
        [o for node in _nodes(named) if (o := network.object_id(node)) is not None]
        for named in (kitchen, goals)
    )
    last = [o for o in network.outputs[-1] if o not in network.inputs[-1]]
    known = (
        None if rates is None else {motion: Fraction(rates.get(motion, "1/2")) for motion in network.motions}
    )
    return Problem(network, frozenset(at_hand), tuple(wanted or last[:1]), known, frozenset(utensils.split()))


def _nodes(listed: str) -> list[ObjectNode]:
    return [parse_node(each.strip()) for each in listed.split("+") if each.strip()]


def weigh(*weights: Any, **more: Any) -> Content:
    """Return the leaf of a proof in which the cuts have these weights, in order; ``None`` is no weight."""
    stated = [weight if weight is None or isinstance(weight, list) else [weight] for weight in weights]
    return {"weights": [[cut, weight] for cut, weight in enumerate(stated) if weight is not None], **more}


def branch(without: Any, using: Any, **member: Any) -> Content:
    """Return a branch of a proof on a unit, an item or a step."""
    return {"branch": member, "without": without, "using": using}


def bound(*least: Any, **values: Any) -> Content:
    """Return the claim that every tree costs at least so much, without a tree."""
    return {"claim": "bound", "bound": [*least], "tree": None, "costs": None, **values}


def goals(problem: Problem, *ids: int) -> Content:
    """Return the claim that a tree is about these goals."""
    return {"goals": [{"id": o, "node": str(problem.network.objects[o])} for o in ids]}


HOPELESS: Content = {"hopeless": 0}
NO_TREE: Content = {"claim": "infeasible", "objective": [], "tree": None, "costs": None}
UNPROVED: Content = {"cuts": [], "proof": weigh()}

# The end is poured of the start, or baked of a middle that is mixed; what is rare nobody has.
PLAIN = recipe(
    "pour: start > end",
    "mix: start + salt; contains {grain,iodine} > middle",
    "bake: middle > end",
    "dig: rare > other",
    kitchen="start + salt; contains {grain,iodine}",
    goals="end",
    rates={"mix": "3/4", "bake": 1, "dig": 0},
)
POUR, MIX, BAKE, DIG = range(4)
START, END, SALT, MIDDLE, RARE, OTHER = range(6)


def accepted(at: Problem = PLAIN, **values: Any) -> Verified:
    """Verify a certificate with these values, and those of no claim for the others."""
    return check(handmade(at, **values), at)


def refusal(at: Problem = PLAIN, **values: Any) -> str:
    """Return why a certificate is refused; nothing where it is accepted."""
    try:
        accepted(at, **values)
    except RefusedError as refused:
        return str(refused)
    return ""
