"""The two container rules: which inputs of a unit are preconditions, and which outputs are add effects."""

from collections.abc import Iterable
from enum import StrEnum
from functools import lru_cache
from typing import Final

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, node_at_level

Ids = tuple[tuple[int, ...], ...]


class ContainerRule(StrEnum):
    """The rule that decides which inputs of a unit are preconditions.

    ``STRICT``: all inputs are preconditions, and all outputs are add effects. ``IMPLIED``, the rule of the
    published searches: some containers are skipped. A skipped container is a utensil with exactly one
    ingredient. This ingredient is also an input of the unit, and is in, on or at the utensil. The container
    is then no precondition. If the unit also lists it as an output, it is no add effect either, since nothing
    made it before.

    Example:
        >>> [str(rule) for rule in foon_asp.ContainerRule]
        ['strict', 'implied']
    """

    STRICT = "strict"
    IMPLIED = "implied"


DEFAULT_RULE: Final = ContainerRule.STRICT
"""The container rule where none is named."""


def container_rule(name: str) -> ContainerRule:
    """Return the container rule of this name; raises :class:`UserError` for a name that is no rule."""
    try:
        return ContainerRule(name)
    except ValueError:
        raise UserError(
            f"found the containers {name!r}, expected one of {', '.join(ContainerRule)}"
        ) from None


def conditions(rule: ContainerRule, level: int, starting: bool = False) -> str:
    """Return the conditions under which a claim holds, in words: ``strict containers, level 2``.

    The default level 3 is not mentioned. If the user named no kitchen, ``starting`` is true, and ``, starting
    kitchen`` is added.
    """
    text = f"{rule} containers" + (f", level {level}" if level < 3 else "")
    return text + (", starting kitchen" if starting else "")


def needed_inputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Return the preconditions of a unit: the inputs that it needs under the rule, in the unit's order.

    ``utensils`` are the labels of utensils. Without a ``network``, and at level 3, only the unit itself
    decides. A unit of a network below level 3 stands for several level-3 units, whose nodes include their
    contents. The unit needs an input if all its level-3 units need the input. A unit that such a network
    lacks needs all its inputs.
    """
    return _preconditions_and_add_effects(unit, rule, utensils, network)[0]


def given_outputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None = None
) -> tuple[ObjectNode, ...]:
    """Return the add effects of a unit: the outputs that it makes under the rule, in the unit's order.

    An output is left out if it is also an input that the rule skips. Without a ``network``, and at level 3,
    only the unit itself decides. A unit of a network below level 3 stands for several level-3 units. The unit
    makes an output if at least one of its level-3 units makes the output. A unit that such a network lacks
    makes all its outputs.
    """
    return _preconditions_and_add_effects(unit, rule, utensils, network)[1]


def _preconditions_and_add_effects(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str], network: Network | None
) -> tuple[tuple[ObjectNode, ...], tuple[ObjectNode, ...]]:
    """Return as a pair what :func:`needed_inputs` and :func:`given_outputs` return for a unit."""
    if rule is ContainerRule.STRICT:
        return unit.inputs, unit.outputs
    if network is not None and network.detailed is not None:
        unit_id = network.unit_id(unit)
        if unit_id is None:  # it needs all its inputs
            return unit.inputs, unit.outputs
        details = [
            _preconditions_and_add_effects(network.detailed.unit(detail), rule, utensils, None)
            for detail in network.stands_for[unit_id]
        ]
        needed = set.intersection(*(_nodes_at_level(needs, network.level) for needs, _ in details))
        added = set.union(*(_nodes_at_level(gives, network.level) for _, gives in details))
    else:
        skipped = {node for node in unit.inputs if _is_implied(node, unit.inputs, utensils)}
        needed, added = set(unit.inputs) - skipped, set(unit.outputs) - skipped
    return tuple(n for n in unit.inputs if n in needed), tuple(n for n in unit.outputs if n in added)


def _nodes_at_level(nodes: Iterable[ObjectNode], level: int) -> set[ObjectNode]:
    """Return nodes with only the parts that count at a level: at level 1, only their labels.

    Nodes that differ only in parts that do not count become one node.
    """
    return {node_at_level(node, level) for node in nodes}


@lru_cache(maxsize=4)  # successive questions are mostly about the same network
def network_sides(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> tuple[Ids, Ids]:
    """Return two tuples indexed by unit id: the preconditions of each unit, and its add effects.

    Both consist of ids of object nodes, in the order of the unit. The last four results are cached.
    """
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
            needed, added = map(
                set, _preconditions_and_add_effects(network.unit(unit), rule, utensils, network)
            )
            needs[unit] = tuple(o for o in needs[unit] if network.objects[o] in needed)
            gives[unit] = tuple(o for o in gives[unit] if network.objects[o] in added)
    return tuple(needs), tuple(gives)


@lru_cache(maxsize=4)
def network_makers(network: Network, rule: ContainerRule, utensils: frozenset[str]) -> Ids:
    """Return a tuple indexed by object node id: the ids of the node's achievers under the rule, ascending.

    The last four results are cached.
    """
    achievers: dict[int, tuple[int, ...]] = {}  # of nodes for which they are not all producers
    _, gives = network_sides(network, rule, utensils)
    for unit, (outputs, added) in enumerate(zip(network.outputs, gives, strict=True)):
        if len(added) < len(outputs):
            for o in set(outputs).difference(added):
                remaining = achievers.get(o, network.producers[o])
                achievers[o] = tuple(other for other in remaining if other != unit)
    if not achievers:
        return network.producers
    return tuple(achievers.get(o, producers) for o, producers in enumerate(network.producers))


def _is_implied(node: ObjectNode, inputs: tuple[ObjectNode, ...], utensils: frozenset[str]) -> bool:
    """Whether the rule ``implied`` skips an input; see :class:`ContainerRule`."""
    if node.label not in utensils or len(node.ingredients) != 1:
        return False
    ingredient = node.ingredients[0]
    return any(
        other is not node and other.label == ingredient and other.is_in(node.label) for other in inputs
    )
