"""The two container rules: which inputs a unit asks for."""

from enum import StrEnum
from functools import lru_cache

from foon_asp.network import FunctionalUnit, Network, ObjectNode, node_at_level


class ContainerRule(StrEnum):
    """``strict``: a unit needs every input. ``implied``: the rule of the published searches.

    Under ``implied`` a utensil node that holds exactly one ingredient is taken as given when that
    ingredient, located in that utensil (by any relation), is also an input of the same unit.
    """

    STRICT = "strict"
    IMPLIED = "implied"


def conditions(rule: ContainerRule, level: int) -> str:
    """Say in a few words what a claim holds under: ``strict containers, level 2``; level 3 goes unsaid."""
    return f"{rule} containers" + (f", level {level}" if level < 3 else "")


def needed_inputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Give the inputs that the rule asks for, in the unit's order.

    Below level 3 a node does not say what it holds. A unit of a ``network`` of such a level then needs what
    all the level-3 units need that it stands for: what one of them takes as given, it takes as given.
    """
    if rule is ContainerRule.STRICT:
        return unit.inputs
    if network is not None and network.detailed is not None:
        unit_id = network.unit_id(unit)
        details = () if unit_id is None else network.stands_for[unit_id]
        needed = set(unit.inputs)
        for detail in map(network.detailed.unit, details):
            needed &= {node_at_level(node, network.level) for node in needed_inputs(detail, rule, utensils)}
        return tuple(node for node in unit.inputs if node in needed)
    return tuple(node for node in unit.inputs if not _is_implied(node, unit.inputs, utensils))


@lru_cache(maxsize=4)  # question after question is about the same network
def network_needs(
    network: Network, rule: ContainerRule, utensils: frozenset[str]
) -> tuple[tuple[int, ...], ...]:
    """Give for each unit of a network, at its level, the ids of the inputs that the rule asks for."""
    if rule is ContainerRule.STRICT:
        return network.inputs
    detailed = network.detailed or network
    vessels = {
        o for o, node in enumerate(detailed.objects) if node.label in utensils and len(node.ingredients) == 1
    }
    needs: list[tuple[int, ...]] = []
    for unit, inputs in enumerate(network.inputs):
        details = network.stands_for[unit] if network.detailed else (unit,)
        if all(vessels.isdisjoint(detailed.inputs[detail]) for detail in details):
            needs.append(inputs)
            continue
        needed = set(needed_inputs(network.unit(unit), rule, utensils, network))
        needs.append(tuple(o for o in inputs if network.objects[o] in needed))
    return tuple(needs)


def _is_implied(node: ObjectNode, inputs: tuple[ObjectNode, ...], utensils: frozenset[str]) -> bool:
    if node.label not in utensils or len(node.ingredients) != 1:
        return False
    ingredient = node.ingredients[0]
    return any(
        other is not node and other.label == ingredient and other.is_in(node.label) for other in inputs
    )
