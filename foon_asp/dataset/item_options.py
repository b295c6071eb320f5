"""The options of a question about items that are used up, checked against the data."""

from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from types import MappingProxyType

from foon_asp.dataset.dataset import Dataset
from foon_asp.dataset.python_names import node_id, stated_copies
from foon_asp.errors import UserError
from foon_asp.network import MAX_AMOUNT, ObjectNode, counted
from foon_asp.problem import ITEMS, UsedUp
from foon_asp.text.line import LineError
from foon_asp.text.tables import STAYS, read_stock, stated_name

Stock = str | PathLike[str] | Mapping[str | ObjectNode, int] | Mapping[ObjectNode, int]
"""The path of a stock file, or the number of copies by object node."""

Stays = str | PathLike[str] | Mapping[str | ObjectNode, bool]
"""The path of a file that says what stays, or the same by label or object node."""


def items_for(
    dataset: Dataset,
    goals: Sequence[int],
    amounts: Sequence[int],
    items: str | None,
    stock: Stock | None,
    stays: Stays | None,
) -> UsedUp | None:
    """Return how items are used up in a question about ``goals``, by id. Return ``None`` if items last.

    ``amounts`` has the number of copies wanted of each goal, in the order of the goals. If it is empty, the
    amounts of the goals file count. ``items`` is ``used-up``, ``lasting`` or ``None``. With ``None``, items
    are used up if some goal has an amount, and last otherwise. With ``lasting``, amounts of the goals file
    are ignored.

    Raises :class:`UserError` as :func:`items_of` does, for ``amounts`` that do not fit the goals, and for
    ``amounts`` together with ``lasting``.
    """
    if not amounts:
        amounts_by_id = dataset.goal_amounts
        goal_copies = {
            dataset.names.node(goal): amounts_by_id[goal] for goal in goals if goal in amounts_by_id
        }
        items = items or ("used-up" if goal_copies else "lasting")
        return items_of(dataset, items, stock, stays, {} if items == "lasting" else goal_copies)
    wanted = _amounts_by_goal(dataset, goals, amounts)
    if items == "lasting":
        raise UserError("an amount of a goal is for items that are used up: leave --items lasting out")
    return items_of(dataset, items or "used-up", stock, stays, wanted)


def _amounts_by_goal(dataset: Dataset, goals: Sequence[int], amounts: Sequence[int]) -> dict[ObjectNode, int]:
    """Return the number of copies wanted of each goal; ``amounts`` has them in the order of the goals.

    Raises :class:`UserError` if there are more or fewer amounts than goals, or for an amount that is not from
    1 to :data:`MAX_AMOUNT`.
    """
    if len(amounts) != len(goals):
        numbers = f"{counted(len(amounts), 'amount')} for {counted(len(goals), 'goal')}"
        raise UserError(f"found {numbers}, expected one for each, in the order of the goals")
    for amount in amounts:
        if not 1 <= amount <= MAX_AMOUNT:
            raise UserError(f"found the amount {amount} of a goal, expected one from 1 to {MAX_AMOUNT}")
    nodes = map(dataset.names.node, goals)
    return dict(zip(nodes, amounts, strict=True))


def items_of(
    dataset: Dataset,
    items: str,
    stock: Stock | None,
    stays: Stays | None,
    wanted: Mapping[ObjectNode, int] = MappingProxyType({}),
) -> UsedUp | None:
    """Return how items are used up, or ``None`` if they last.

    ``items``: ``used-up`` or ``lasting``.
    ``stock``: numbers of copies of kitchen items, which replace those that the kitchen states.
    ``stays``: for labels or nodes, whether they stay (true) or are used up, against the usual rule.
    ``wanted``: the number of copies of each goal; the result has only those above 1.

    The stock of the result has the copies that the kitchen states. Items that are no longer in the kitchen
    are left out.

    Raises :class:`UserError` for
    - another word as ``items``,
    - a ``stock`` or ``stays`` where items last,
    - an item of the stock that the kitchen lacks,
    - a name that the network lacks,
    - a network below level 3.
    """
    if items not in ITEMS:
        raise UserError(f"found the items {items!r}, expected one of {', '.join(ITEMS)}")
    if items == "lasting":
        if stock is not None or stays is not None:
            option = "a stock" if stock is not None else "what stays"
            raise UserError(f"{option} is for items that are used up: add --items used-up (items='used-up')")
        return None
    require_contents(dataset.names.level)
    exceptions = {} if stays is None else _read_exceptions(dataset, stays)
    copies = {
        node: count
        for node, count in dataset.stock.items()
        if dataset.at_hand(node_id(dataset, node, "item"))
    }
    if stock is not None:
        copies |= _read_stock_copies(dataset, stock)
    return UsedUp(exceptions, copies, {node: amount for node, amount in wanted.items() if amount > 1})


def require_contents(level: int) -> None:
    """Raise :class:`UserError` below level 3: without contents, it is unknown which items are used up."""
    if level < 3:
        raise UserError(
            f"items are used up at level 3 only, and this is level {level}: whether an input stays depends "
            "on contents (--items lasting asks for the other reading)"
        )


def _read_exceptions(dataset: Dataset, stays: Stays) -> dict[str | ObjectNode, bool]:
    """Return the exceptions from the usual rule: by label or node, true if it stays, false if it is used up.

    ``stays`` is the path of a file, or a mapping from names. Raises :class:`UserError` for a name that the
    network lacks.
    """
    if isinstance(stays, str | PathLike):
        exceptions = STAYS.read(Path(stays))
    else:
        try:
            exceptions = {
                stated_name(name) if isinstance(name, str) else name: bool(lasts)
                for name, lasts in stays.items()
            }
        except LineError as error:
            raise UserError(f"what stays: {error}") from None
    for name in exceptions:
        if isinstance(name, ObjectNode):
            node_id(dataset, name, "item that stays or goes")
        elif not dataset.names.labelled(name)[0]:
            raise UserError(f"what stays: no object node of the network has the label {name!r}")
    return exceptions


def _read_stock_copies(dataset: Dataset, stock: Stock) -> dict[ObjectNode, int]:
    """Return the number of copies in the stock, by object node; it may be 0.

    ``stock`` is the path of a file, or a mapping of names. Names with ``None`` as their number are left out.
    Raises :class:`UserError` for a node that the kitchen lacks.
    """
    if isinstance(stock, str | PathLike):
        copies = read_stock(Path(stock))
    else:
        copies = stated_copies(dataset, stock, "kitchen item", least=0)
    for node in copies:
        if not dataset.at_hand(node_id(dataset, node, "kitchen item")):
            raise UserError(f"the stock counts {str(node)!r}, which the kitchen does not have")
    return copies
