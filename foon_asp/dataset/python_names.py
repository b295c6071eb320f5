"""Lookup of names that Python callers pass: object nodes, motions, units."""

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from typing import Any, Protocol

from foon_asp.errors import UserError
from foon_asp.network import MAX_AMOUNT, FunctionalUnit, Network, ObjectNode, UnitPrices, node_at_level
from foon_asp.problem import Names, Number, UnitPricesNamed, success_rate, unit_price
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name
from foon_asp.text.node_lookup import find_goal
from foon_asp.text.node_names import NodeNames
from foon_asp.text.object_list import ListedObject
from foon_asp.text.unknown_node import GoalError, Wording


class NamedData(Protocol):
    """Data in which names are looked up, such as a dataset."""

    @property
    def names(self) -> NodeNames:
        """The lookup of object nodes by name."""

    @property
    def goal_entries(self) -> Sequence[ListedObject]:
        """The entries of the goals file; a goal may also be called by the name that its entry has."""

    def at_hand(self, o: int) -> bool:
        """Whether an object node, by id, is in the kitchen."""


class NodeAndUnitNames(NodeNames, Protocol):
    """The lookup of object nodes by name, and of the ids of units."""

    def unit_id(self, unit: FunctionalUnit) -> int | None:
        """Return the id of a unit, or ``None`` where the network does not have it."""


def node_id(dataset: NamedData, name: str | ObjectNode, noun: str) -> int:
    """Return the id of a named node in the whole network; ``noun`` is what it is, such as ``kitchen item``.

    If the noun is ``goal``, names that the goals file has are also understood. An :class:`ObjectNode` is
    compared at the level of the network. Raises :class:`UserError` with candidates for a name that means no
    object node, or several.
    """
    names = dataset.names
    if isinstance(name, ObjectNode):
        object_id = names.object_id(node_at_level(name, names.level))
        if object_id is None:
            raise UserError(f"no object node of the network is the {noun} {str(name)!r}")
        return object_id
    try:
        return find_goal(name, names, dataset.goal_entries if noun == "goal" else (), Wording(noun, ""))
    except GoalError as error:
        raise UserError(python_error_text(error)) from None


def node_ids(dataset: NamedData, names: Names, noun: str) -> list[int]:
    """Return the id of each named object node, found as by :func:`node_id`."""
    return [node_id(dataset, name, noun) for name in names_as_list(names)]


def stated_copies(
    dataset: NamedData, amounts: Mapping[Any, int | None], noun: str, least: int = 1
) -> dict[ObjectNode, int]:
    """Return numbers of copies by object node, from ``amounts`` by name; names with ``None`` are left out.

    ``noun`` is what the names are, as in :func:`node_id`. Raises :class:`UserError` as :func:`node_id` does.
    Also raises it for a number that is not a whole one from ``least`` to :data:`MAX_AMOUNT`.
    """
    copies: dict[ObjectNode, int] = {}
    for name, amount in amounts.items():
        if amount is None:
            continue
        if not isinstance(amount, int) or isinstance(amount, bool) or not least <= amount <= MAX_AMOUNT:
            raise UserError(
                f"found the amount {amount!r} of {str(name)!r}, expected a whole number from {least} to "
                f"{MAX_AMOUNT}"
            )
        copies[dataset.names.node(node_id(dataset, name, noun))] = amount
    return copies


def item_id(dataset: NamedData, name: str | ObjectNode) -> int:
    """Return the id of a named kitchen item.

    A label means the item that has no more than this label. Without such an item, it means the only item with
    the label.

    Raises :class:`UserError`
    - for a name that is no item,
    - for a label of several items, with the items as candidates, and
    - in a store, for a label of more than twelve nodes.
    """
    names = dataset.names
    label = None if isinstance(name, ObjectNode) else _bare_label(name)
    if label is not None:
        bare_node = names.object_id(ObjectNode(label))
        if bare_node is not None and dataset.at_hand(bare_node):
            return bare_node
        count, ids = names.labelled(label)
        if count > len(ids):
            raise UserError(f"{count} object nodes have the label {label!r}: name the one you mean in full")
        items = [o for o in ids if dataset.at_hand(o)]
        if len(items) > 1:
            message = f"the kitchen has {len(items)} items with the label {label!r}; name those you mean"
            raise UserError(python_error_text(GoalError(message, [str(names.node(o)) for o in items])))
        if count:
            if not items:
                raise UserError(f"the kitchen has nothing with the label {label!r}")
            return items[0]
    item = node_id(dataset, name, "kitchen item")
    if not dataset.at_hand(item):
        raise UserError(f"the kitchen does not have {str(name)!r}")
    return item


def _bare_label(name: str) -> str | None:
    """Return the label if a name is nothing but a label. Return ``None`` for the notation of a whole node.

    A name that is not valid notation counts as a label, as written.
    """
    try:
        named = parse_name(name)
    except LineError:
        return name
    return named if isinstance(named, str) else None


def changed_rates(
    rates: Mapping[str, Fraction] | None, changed: Mapping[str, Number] | None, motions: Collection[str]
) -> Mapping[str, Fraction] | None:
    """Return success rates by motion: ``rates``, with those in ``changed`` replaced or added.

    If ``changed`` is ``None``, return ``rates``; ``None`` for no rates. ``motions``: all motions of the
    network.

    Raises :class:`UserError` for a rate that is not above 0 and at most 1. If there are ``rates``, also
    raises it for a motion that is in neither ``rates`` nor ``motions``.
    """
    if changed is None:
        return rates
    by_motion = dict(rates or {})
    for motion, value in changed.items():
        rate = success_rate(value, f"the success rate of {motion!r}")
        if rates is not None and motion not in rates and motion not in motions:
            import difflib  # noqa: PLC0415 (only for an error message)

            similar_names = difflib.get_close_matches(motion, rates, n=3, cutoff=0.6)
            similar = f"; similar are {', '.join(map(repr, similar_names))}" if similar_names else ""
            raise UserError(f"no motion {motion!r} has a success rate{similar}")
        by_motion[motion] = rate
    return by_motion


def changed_prices(
    prices: UnitPrices, changed: UnitPricesNamed, motions: Collection[str], names: NodeAndUnitNames
) -> UnitPrices:
    """Return ``prices`` with the prices in ``changed``, by motion or unit, replaced or added.

    ``motions``: all motions of the network.
    ``names``: looks up units. Below level 3, the price of a unit counts for all units of level 3 that were
    merged into it.

    Raises :class:`UserError` for a motion or unit that the network lacks, and for a price below 0.
    """
    by_motion, by_unit = dict(prices.motions), dict(prices.units)
    for named, value in changed.items():
        price = unit_price(value, f"the price of {str(named)!r}")
        if isinstance(named, FunctionalUnit):
            unit_id = names.unit_id(named)
            if unit_id is None:
                raise UserError(f"no unit of the network is {str(named)!r}")
            if isinstance(names, Network) and names.detailed is not None:
                by_unit |= dict.fromkeys(map(names.detailed.unit, names.stands_for[unit_id]), price)
            else:
                by_unit[named] = price
        elif named in motions:
            by_motion[named] = price
        else:
            import difflib  # noqa: PLC0415 (only for an error message)

            similar_names = difflib.get_close_matches(named, motions, n=3, cutoff=0.6)
            similar = f"; similar are {', '.join(map(repr, similar_names))}" if similar_names else ""
            raise UserError(f"no unit has the motion {named!r}{similar}")
    return UnitPrices(by_motion, by_unit)


def names_as_list(names: Names) -> list[str | ObjectNode]:
    """Return one name or several as a list."""
    # a node is a tuple, and so could pass for several names
    return [names] if isinstance(names, str | ObjectNode) else list(names)


def python_error_text(error: GoalError) -> str:
    """Return the text of an error, with a line for each candidate as a Python string.

    A last line says how many more candidates there are.
    """
    lines = [error.message, *(f"  {candidate!r}" for candidate in error.candidates)]
    return "\n".join(lines + ([f"  ... and {error.hidden} more"] if error.hidden else []))
