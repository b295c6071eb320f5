"""What a unit uses up: which of its inputs stay when it has run, and which are gone; docs/plans.md."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Network, ObjectNode

ITEMS = ("lasting", "used-up")
"""How items are meant: what is there can be used again and again, or it is used up."""

Named = str | ObjectNode
"""What somebody says stays or goes: all object nodes of a label, or one object node."""


class Fate(StrEnum):
    """Why an input of a unit stays, or that it is ``USED_UP``.

    ``OUTPUT``: the very same node is also an output. ``TOOL``: a utensil with no contents. ``VESSEL``: a
    utensil that some output is in, on or at. ``INSIDE``: the ingredient of something that the unit has before
    and after. ``TOLD_STAYS`` and ``TOLD_GOES``: a file says so.

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
        """Whether the input is still there when the unit has run."""
        return self not in {Fate.USED_UP, Fate.TOLD_GOES}


def fate(
    node: ObjectNode,
    inputs: Iterable[ObjectNode],
    outputs: Iterable[ObjectNode],
    utensils: frozenset[str],
    told: Mapping[Named, bool] = MappingProxyType({}),
) -> Fate:
    """Say what becomes of an input of a unit.

    ``inputs`` and ``outputs`` are all of the unit, also those that a container rule skips. ``told`` says of
    labels and nodes whether they stay, before anything else is looked at; what it says of a node counts more
    than what it says of its label.
    """
    stays = told.get(node, told.get(node.label))
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
    if holders and any(each.label in holders for each in inputs):
        return Fate.INSIDE
    return Fate.USED_UP


class Flow(NamedTuple):
    """What a unit does with items, by id.

    It runs when a copy of each node that it ``asks`` for is there. One copy of each that it ``uses`` up is
    gone then, and there is one more of each that it ``adds``.
    """

    asks: tuple[int, ...]
    uses: tuple[int, ...]
    adds: tuple[int, ...]


@dataclass(frozen=True)
class UsedUp:
    """That items are used up: what is said of some of them, and the stock.

    ``told`` says of labels and of object nodes whether they stay, whatever the rule makes of them. ``stock``
    counts the copies of kitchen nodes; those that it does not name never run out.

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

    def fate(self, unit: FunctionalUnit, node: ObjectNode, utensils: frozenset[str]) -> Fate:
        """Say what becomes of an input of a unit.

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
    ) -> Flow:
        """Say what a unit asks for, uses up and adds.

        Parameters:
            network: The network of the unit.
            unit: The id of the unit.
            needs: The inputs that the container rule asks for, by id.
            gives: The outputs that the unit makes under it, by id.
            utensils: The labels of utensils.
        """
        value, needs = network.unit(unit), tuple(needs)
        inputs = set(network.inputs[unit])
        gone = [o for o in needs if not self.fate(value, network.objects[o], utensils).stays]
        return Flow(needs, tuple(gone), tuple(o for o in gives if o not in inputs))
