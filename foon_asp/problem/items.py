"""Consumption of items: which inputs of a unit stay after it, and which are used up (docs/plans.md)."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import lru_cache
from types import MappingProxyType
from typing import NamedTuple, overload

from foon_asp.network import FunctionalUnit, Network, ObjectNode, UnitAmounts
from foon_asp.problem.container_rule import ContainerRule, network_sides

ITEMS = ("lasting", "used-up")
"""The two models of items: an item lasts, and can be used any number of times; or it is used up."""

Named = str | ObjectNode
"""The subject of a declaration by the user: a label, for all object nodes with it, or one object node."""


class Fate(StrEnum):
    """The reason why an input of a unit stays available, or why it is used up.

    ``OUTPUT``: stays, since the same node is also an output.
    ``TOOL``: stays, since it is a utensil with no ingredients.
    ``VESSEL``: stays, since it is a utensil that some output is in, on or at.
    ``INSIDE``: stays, since it is inside an item that remains. It is an ingredient in, on or at the item. An
    input and an output have the label of the item, and the output contains the ingredient.
    ``USED_UP``: is used up, since no reason applies.
    ``TOLD_STAYS``: stays, since a file of the user says so.
    ``TOLD_GOES``: is used up, since a file of the user says so.

    Example:
        >>> str(foon_asp.Fate.TOOL)
        'stays: a utensil with no contents'
    """

    OUTPUT = "stays: it is also an output"
    TOOL = "stays: a utensil with no contents"
    VESSEL = "stays: a utensil that an output is related to"
    INSIDE = "stays: an ingredient of what it is related to, before and after"
    USED_UP = "used up"
    TOLD_STAYS = "stays: the file says so"
    TOLD_GOES = "used up: the file says so"

    @property
    def stays(self) -> bool:
        """Whether the input is still available after the unit is executed."""
        return self not in {Fate.USED_UP, Fate.TOLD_GOES}


def fate(
    node: ObjectNode,
    inputs: Iterable[ObjectNode],
    outputs: Iterable[ObjectNode],
    utensils: frozenset[str],
    declared: Mapping[Named, bool] = MappingProxyType({}),
) -> Fate:
    """Return whether an input of a unit stays or is used up, with the reason.

    ``inputs`` and ``outputs`` are all inputs and outputs of the unit, including any that a container rule
    skips. ``declared`` maps labels and nodes to whether the user declared that they stay. A declaration
    overrides all other reasons. A declaration of a node overrides one of its label. If some outputs have the
    label of the input, but none is the same node, the unit changes the input. Then the input is used up.
    """
    stays = declared.get(node, declared.get(node.label))
    if stays is not None:
        return Fate.TOLD_STAYS if stays else Fate.TOLD_GOES
    outputs = tuple(outputs)
    if any(output.label == node.label for output in outputs):
        return Fate.OUTPUT if node in outputs else Fate.USED_UP
    if node.label in utensils and not node.ingredients:
        return Fate.TOOL
    if node.label in utensils and any(output.is_in(node.label) for output in outputs):
        return Fate.VESSEL
    holders = {output.label for output in outputs if node.label in output.ingredients}
    holders.intersection_update(relation.object for relation in node.relations)
    if holders and any(holder.label in holders for holder in inputs):
        return Fate.INSIDE
    return Fate.USED_UP


class Flow(NamedTuple):
    """The preconditions and effects of one execution of a unit, as numbers of copies by object node id.

    A unit is applicable when there are at least as many copies of each node as it ``asks`` for. It consumes
    the copies in ``uses``, and makes the copies in ``adds``.
    """

    asks: Mapping[int, int]
    uses: Mapping[int, int]
    adds: Mapping[int, int]


class UnitFlows(Sequence[Flow]):
    """The flows of all units of a network; each is computed at the first access to it, and kept.

    So for a question about a few units of a large network, only a few flows are computed. ``units`` is the
    number of units. The function ``flow`` computes the flow of a unit by id.
    """

    def __init__(self, units: int, flow: Callable[[int], Flow]) -> None:
        self._flow = flow
        self._flows: list[Flow | None] = [None] * units

    def __len__(self) -> int:
        """Return the number of units."""
        return len(self._flows)

    @overload
    def __getitem__(self, unit: int) -> Flow: ...
    @overload
    def __getitem__(self, unit: slice) -> Sequence[Flow]: ...

    def __getitem__(self, unit: int | slice) -> Flow | Sequence[Flow]:
        """Return the flow of a unit; for a slice, a list of flows."""
        if isinstance(unit, slice):
            return [self[u] for u in range(len(self))[unit]]
        flow = self._flows[unit]
        if flow is None:
            flow = self._flows[unit] = self._flow(unit)
        return flow


@dataclass(frozen=True)
class UsedUp:
    """The model in which items are used up: declarations of the user, the stock, and wanted copies.

    ``told`` maps labels and object nodes to whether they stay, which overrides the reasons of :class:`Fate`.
    ``stock`` has the number of copies of kitchen nodes. A kitchen node without such a number never runs out.
    If a goal is wanted more than once, ``wanted`` has the number of copies.

    Example:
        >>> foon_asp.UsedUp(stock={foon_asp.parse_node("egg"): 2}).told
        {}
        >>> egg = foon_asp.parse_node("egg")
        >>> crack = foon_asp.FunctionalUnit.of("crack", [egg], [foon_asp.parse_node("egg; cracked")])
        >>> str(foon_asp.UsedUp().fate(crack, egg, frozenset()))
        'used up'
    """

    told: Mapping[Named, bool] = field(default_factory=dict)
    stock: Mapping[ObjectNode, int] = field(default_factory=dict)
    wanted: Mapping[ObjectNode, int] = field(default_factory=dict)

    def fate(self, unit: FunctionalUnit, node: ObjectNode, utensils: frozenset[str]) -> Fate:
        """Return whether an input of a unit stays or is used up, with the reason.

        Parameters:
            unit: The unit.
            node: The input.
            utensils: The labels of utensils.
        """
        return fate(node, unit.inputs, unit.outputs, utensils, self.told)

    def flow(
        self,
        network: Network,
        unit: int,
        needs: Iterable[int],
        gives: Iterable[int],
        utensils: frozenset[str],
        amounts: UnitAmounts,
    ) -> Flow:
        """Return the preconditions and effects of a unit on copies of items.

        If a node is both an input and an output, only the difference of the two amounts is used up or made.
        An input that the user declared as used up is used up in full. A node without an amount counts as one
        copy. Nodes of which no copy is used up or made are left out of the effects.

        Parameters:
            network: The network of the unit.
            unit: The id of the unit.
            needs: The inputs that the unit needs under the container rule, by id.
            gives: The outputs that the unit makes under the rule, by id.
            utensils: The labels of utensils.
            amounts: How many of each node the unit takes and makes.
        """
        functional_unit, objects, inputs = network.unit(unit), network.objects, set(network.inputs[unit])
        input_amounts, output_amounts = amounts
        asks = {o: input_amounts.get(objects[o], 1) for o in needs}
        uses, adds = dict[int, int](), dict[int, int]()
        for o, amount in asks.items():
            reason = self.fate(functional_unit, objects[o], utensils)
            if reason is Fate.OUTPUT:
                uses[o] = amount - output_amounts.get(objects[o], 1)
            elif not reason.stays:
                uses[o] = amount
        for o in gives:
            amount = output_amounts.get(objects[o], 1)
            adds[o] = amount - input_amounts.get(objects[o], 1) if o in inputs else amount
        return Flow(asks, *({o: n for o, n in effect.items() if n > 0} for effect in (uses, adds)))


@lru_cache(maxsize=4)  # successive questions are mostly about the same network
def plain_flows(
    network: Network, rule: ContainerRule, utensils: frozenset[str], told: frozenset[tuple[Named, bool]]
) -> UnitFlows:
    """Return the flows of the units of a network if each unit takes and makes one copy of each node.

    ``told`` has what the user declared: pairs of a label or node, and whether it stays. The last four results
    are cached.
    """
    needs, gives = network_sides(network, rule, utensils)
    items, one_of_each = UsedUp(told=dict(told)), UnitAmounts()
    return UnitFlows(
        len(network), lambda unit: items.flow(network, unit, needs[unit], gives[unit], utensils, one_of_each)
    )
