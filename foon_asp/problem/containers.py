"""The two container rules: which inputs a unit asks for, and which outputs it makes."""

from collections.abc import Iterable
from enum import StrEnum
from functools import lru_cache

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, node_at_level

Ids = tuple[tuple[int, ...], ...]


class ContainerRule(StrEnum):
    """Whether a unit needs all its inputs (``STRICT``), or not every container (``IMPLIED``).

    ``strict``: a unit needs every input. ``implied``, the rule of the published searches: a unit need not be
    given a utensil that holds exactly one ingredient, if that ingredient, located in that utensil (by any
    relation), is also an input of the unit. A unit does not make an input that it skipped: nothing comes
    from nothing.

    Example:
        >>> [str(rule) for rule in foon_asp.ContainerRule]
        ['strict', 'implied']
    """

    STRICT = "strict"
    IMPLIED = "implied"


def container_rule(given: str) -> ContainerRule:
    """Read the name of a container rule."""
    try:
        return ContainerRule(given)
    except ValueError:
        raise UserError(
            f"found the containers {given!r}, expected one of {', '.join(ContainerRule)}"
        ) from None


def conditions(rule: ContainerRule, level: int, starting: bool = False) -> str:
    """Say in a few words what a claim holds under: ``strict containers, level 2``; level 3 goes unsaid.

    ``starting`` says that the kitchen was not given and is the starting one.
    """
    said = f"{rule} containers" + (f", level {level}" if level < 3 else "")
    return said + (", starting kitchen" if starting else "")


def needed_inputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Give the inputs that the rule asks for, in the unit's order.

    Below level 3 a node does not say what it holds. A unit of a ``network`` of such a level then needs what
    all the level-3 units need that it stands for: what one of them takes as given, it takes as given.
    """
    return _sides(unit, rule, utensils, network)[0]


def given_outputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Give the outputs that a unit makes under the rule, in its order: all but the inputs that it skips.

    A unit of a ``network`` below level 3 makes what any of the level-3 units makes that it stands for.
    """
    return _sides(unit, rule, utensils, network)[1]


def _sides(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None
) -> tuple[tuple[ObjectNode, ...], tuple[ObjectNode, ...]]:
    """Give what a unit needs and what it makes."""
    if rule is ContainerRule.STRICT:
        return unit.inputs, unit.outputs
    if network is not None and network.detailed is not None:
        unit_id = network.unit_id(unit)
        if unit_id is None:  # it needs all its inputs
            return unit.inputs, unit.outputs
        details = [
            _sides(network.detailed.unit(d), rule, utensils, None) for d in network.stands_for[unit_id]
        ]
        needed = set.intersection(*(_at_level(needs, network.level) for needs, _ in details))
        given = set.union(*(_at_level(gives, network.level) for _, gives in details))
    else:
        skipped = {node for node in unit.inputs if _is_implied(node, unit.inputs, utensils)}
        needed, given = set(unit.inputs) - skipped, set(unit.outputs) - skipped
    return tuple(n for n in unit.inputs if n in needed), tuple(n for n in unit.outputs if n in given)


def _at_level(nodes: Iterable[ObjectNode], level: int) -> set[ObjectNode]:
    return {node_at_level(node, level) for node in nodes}


@lru_cache(maxsize=4)  # question after question is about the same network
def network_sides(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> tuple[Ids, Ids]:
    """Give for each unit of a network, at its level, the ids of what it needs and of what it makes."""
    if rule is ContainerRule.STRICT:
        return network.inputs, network.outputs
    needs, gives = list(network.inputs), list(network.outputs)
    detailed = network.detailed or network
    vessels = {
        o for o, node in enumerate(detailed.objects) if node.label in utensils and len(node.ingredients) == 1
    }
    for unit in range(len(network)):
        details = network.stands_for[unit] if network.detailed else (unit,)
        if not all(vessels.isdisjoint(detailed.inputs[detail]) for detail in details):
            needed, given = map(set, _sides(network.unit(unit), rule, utensils, network))
            needs[unit] = tuple(o for o in needs[unit] if network.objects[o] in needed)
            gives[unit] = tuple(o for o in gives[unit] if network.objects[o] in given)
    return tuple(needs), tuple(gives)


@lru_cache(maxsize=4)
def network_makers(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> Ids:
    """Give for each object node the ids of the units that make it under the rule, in order."""
    makers: dict[int, tuple[int, ...]] = {}
    _, gives = network_sides(network, rule, utensils)
    for unit, (outputs, given) in enumerate(zip(network.outputs, gives, strict=True)):
        if len(given) < len(outputs):
            for o in set(outputs).difference(given):
                makers[o] = tuple(other for other in makers.get(o, network.producers[o]) if other != unit)
    if not makers:
        return network.producers
    return tuple(makers.get(o, producers) for o, producers in enumerate(network.producers))


def _is_implied(node: ObjectNode, inputs: tuple[ObjectNode, ...], utensils: frozenset[str]) -> bool:
    if node.label not in utensils or len(node.ingredients) != 1:
        return False
    ingredient = node.ingredients[0]
    return any(
        other is not node and other.label == ingredient and other.is_in(node.label) for other in inputs
    )
