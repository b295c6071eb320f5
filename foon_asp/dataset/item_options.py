"""Items that are used up: the options of a question, checked against the data."""

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from foon_asp.dataset.dataset import Dataset
from foon_asp.dataset.named_ids import node_id
from foon_asp.errors import UserError
from foon_asp.network import MAX_AMOUNT, ObjectNode, counted
from foon_asp.problem import ITEMS, UsedUp
from foon_asp.text.line import LineError
from foon_asp.text.tables import STAYS, read_stock, stated_name

Stock = str | PathLike[str] | Mapping[str | ObjectNode, int] | Mapping[ObjectNode, int]
"""The path of a stock file, or the number of copies by object node."""

Stays = str | PathLike[str] | Mapping[str | ObjectNode, bool]
"""The path of a file that says what stays, or the same by label or object node."""


def wanted_of(dataset: Dataset, goals: Sequence[int], amounts: Sequence[int]) -> dict[ObjectNode, int]:
    """Return how many copies of goals are wanted, where that is not one; ``amounts`` has one for each.

    Raises :class:`UserError` where there are more or fewer, and for one that is out of range.
    """
    if amounts and len(amounts) != len(goals):
        numbers = f"{counted(len(amounts), 'amount')} for {counted(len(goals), 'goal')}"
        raise UserError(f"found {numbers}, expected one for each, in the order of the goals")
    for amount in amounts:
        if not 1 <= amount <= MAX_AMOUNT:
            raise UserError(f"found the amount {amount} of a goal, expected one from 1 to {MAX_AMOUNT}")
    nodes = map(dataset.names.node, goals)
    return {node: amount for node, amount in zip(nodes, amounts, strict=False) if amount > 1}


def items_of(
    dataset: Dataset,
    items: str,
    stock: Stock | None,
    stays: Stays | None,
    wanted: Mapping[ObjectNode, int] = MappingProxyType({}),
) -> UsedUp | None:
    """Return how items are used up; ``None`` if they last.

    Raises :class:`UserError` for another word, a stock or an exception where items last, a node that the
    kitchen does not have, a name that the network does not have, and below level 3.
    """
    if items not in ITEMS:
        raise UserError(f"found the items {items!r}, expected one of {', '.join(ITEMS)}")
    if items == "lasting":
        if stock is not None or stays is not None:
            option = "a stock" if stock is not None else "what stays"
            raise UserError(f"{option} is for items that are used up: add --items used-up (items='used-up')")
        if wanted:
            raise UserError("an amount of a goal is for items that are used up: leave --items lasting out")
        return None
    require_contents(dataset.names.level)
    exceptions = {} if stays is None else _exceptions(dataset, stays)
    return UsedUp(exceptions, {} if stock is None else _copies(dataset, stock), dict(wanted))


def require_contents(level: int) -> None:
    """Raise :class:`UserError` below level 3, where contents do not show which items are used up."""
    if level < 3:
        raise UserError(
            f"items are used up at level 3 only, and this is level {level}: whether an input stays depends "
            "on contents (--items lasting asks for the other reading)"
        )


def _exceptions(dataset: Dataset, stays: Stays) -> dict[str | ObjectNode, bool]:
    """Return whether labels and nodes stay, from a file or a mapping of names."""
    if isinstance(stays, str | PathLike):
        exceptions = STAYS.read(Path(stays))
    else:
        try:
            exceptions = {
                stated_name(n) if isinstance(n, str) else n: bool(lasts) for n, lasts in stays.items()
            }
        except LineError as error:
            raise UserError(f"what stays: {error}") from None
    for name in exceptions:
        if isinstance(name, ObjectNode):
            node_id(dataset, name, "item that stays or goes")
        elif not dataset.names.labelled(name)[0]:
            raise UserError(f"what stays: no object node of the network has the label {name!r}")
    return exceptions


def _copies(dataset: Dataset, stock: Stock) -> dict[ObjectNode, int]:
    """Return the number of copies of nodes in the stock, from a file or a mapping of names."""
    if isinstance(stock, str | PathLike):
        copies = read_stock(Path(stock))
    else:
        copies = {}
        for name, count in stock.items():
            if not isinstance(count, int) or isinstance(count, bool) or count < 0:
                raise UserError(f"found the stock {count!r} of {str(name)!r}, expected a whole number from 0")
            copies[dataset.names.node(node_id(dataset, name, "kitchen item"))] = count
    for node in copies:
        if not dataset.at_hand(node_id(dataset, node, "kitchen item")):
            raise UserError(f"the stock counts {str(node)!r}, which the kitchen does not have")
    return copies
