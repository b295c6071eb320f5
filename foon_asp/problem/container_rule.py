"""The two container rules: which inputs of a unit are preconditions, and which outputs are add effects."""

from collections.abc import Iterable
from enum import StrEnum
from functools import lru_cache
from typing import Final

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, node_at_level

Ids = tuple[tuple[int, ...], ...]


class ContainerRule(StrEnum):
    """The container rule: a unit needs all its inputs (``STRICT``), or not every container (``IMPLIED``).

    ``strict``: a unit needs every input. ``implied``, the rule of the published searches: a unit does not
    need a utensil that holds exactly one ingredient, if that ingredient, located in that utensil (by any
    relation), is also an input of the unit. A skipped container is no output of the unit
    either: nothing has made it before.

    Example:
        >>> [str(rule) for rule in foon_asp.ContainerRule]
        ['strict', 'implied']
    """

    STRICT = "strict"
    IMPLIED = "implied"


DEFAULT_RULE: Final = ContainerRule.STRICT
"""The container rule where none is named."""


def container_rule(name: str) -> ContainerRule:
    """Return the container rule of a name; raises :class:`UserError` for an unknown one."""
    try:
        return ContainerRule(name)
    except ValueError:
        raise UserError(
            f"found the containers {name!r}, expected one of {', '.join(ContainerRule)}"
        ) from None


def conditions(rule: ContainerRule, level: int, starting: bool = False) -> str:
    """Return the conditions of a claim in words: ``strict containers, level 2``, without the default level 3.

    ``starting`` says that no kitchen is named, so that the starting kitchen is assumed.
    """
    text = f"{rule} containers" + (f", level {level}" if level < 3 else "")
    return text + (", starting kitchen" if starting else "")


def needed_inputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Return the inputs that a unit needs under the rule (its preconditions), in the unit's order.

    Below level 3, nodes do not include their contents. A unit of a ``network`` of such a level stands for
    several level-3 units, and needs the inputs that all of these units need.
    """
    return _sides(unit, rule, utensils, network)[0]


def given_outputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Return the outputs that a unit makes under the rule (its add effects), in the unit's order.

    These are all outputs except inputs that the rule skips. Below level 3, a unit of a ``network`` stands for
    several level-3 units, and makes the outputs that at least one of these units makes.
    """
    return _sides(unit, rule, utensils, network)[1]


def _sides(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None
) -> tuple[tuple[ObjectNode, ...], tuple[ObjectNode, ...]]:
    """Return the preconditions and the add effects of a unit."""
    if rule is ContainerRule.STRICT:
        return unit.inputs, unit.outputs
    if network is not None and network.detailed is not None:
        unit_id = network.unit_id(unit)
        if unit_id is None:  # it needs all its inputs
            return unit.inputs, unit.outputs
        details = [
            _sides(network.detailed.unit(detail), rule, utensils, None)
            for detail in network.stands_for[unit_id]
        ]
        needed = set.intersection(*(_at_level(needs, network.level) for needs, _ in details))
        added = set.union(*(_at_level(gives, network.level) for _, gives in details))
    else:
        skipped = {node for node in unit.inputs if _is_implied(node, unit.inputs, utensils)}
        needed, added = set(unit.inputs) - skipped, set(unit.outputs) - skipped
    return tuple(n for n in unit.inputs if n in needed), tuple(n for n in unit.outputs if n in added)


def _at_level(nodes: Iterable[ObjectNode], level: int) -> set[ObjectNode]:
    return {node_at_level(node, level) for node in nodes}


@lru_cache(maxsize=4)  # successive questions are mostly about the same network
def network_sides(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> tuple[Ids, Ids]:
    """Return for each unit of a network, at its level, the ids of its preconditions and its add effects."""
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
            needed, added = map(set, _sides(network.unit(unit), rule, utensils, network))
            needs[unit] = tuple(o for o in needs[unit] if network.objects[o] in needed)
            gives[unit] = tuple(o for o in gives[unit] if network.objects[o] in added)
    return tuple(needs), tuple(gives)


@lru_cache(maxsize=4)
def network_makers(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> Ids:
    """Return for each object node its achievers under the rule, as ids of units, in order."""
    achievers: dict[int, tuple[int, ...]] = {}  # of nodes for which they are not all producers
    _, gives = network_sides(network, rule, utensils)
    for unit, (outputs, added) in enumerate(zip(network.outputs, gives, strict=True)):
        if len(added) < len(outputs):
            for o in set(outputs).difference(added):
                earlier = achievers.get(o, network.producers[o])
                achievers[o] = tuple(other for other in earlier if other != unit)
    if not achievers:
        return network.producers
    return tuple(achievers.get(o, producers) for o, producers in enumerate(network.producers))


def _is_implied(node: ObjectNode, inputs: tuple[ObjectNode, ...], utensils: frozenset[str]) -> bool:
    """Return whether an input is a container that the rule ``implied`` skips."""
    if node.label not in utensils or len(node.ingredients) != 1:
        return False
    ingredient = node.ingredients[0]
    return any(
        other is not node and other.label == ingredient and other.is_in(node.label) for other in inputs
    )
