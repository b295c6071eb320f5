"""The items of a certificate of a plan: stock, items that stay, amounts and copies, read from JSON."""

from collections.abc import Collection
from itertools import chain
from typing import Any

from foon_asp.proof.certificate_fields import read_list, read_number, read_pair
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import require

COUNTS = range(10**9)  # of copies of an item, and of executions of a unit


def read_copies(value: Any, what: str) -> dict[int, int]:
    """Return numbers of copies by node id, from a list of pairs of id and number.

    Refuse ids that do not ascend, and numbers not in :data:`COUNTS`. ``what`` names the list in errors.
    """
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    for id_or_count in chain.from_iterable(pairs):
        read_number(id_or_count, COUNTS, what)
    ids = [o for o, _ in pairs]
    require(ids == sorted(set(ids)), f"expected {what} in order, each of them once")
    return dict(pairs)


def read_stock(value: Any, kitchen: Collection[int]) -> dict[int, int]:
    """Return the numbers of copies in stock by node id; refuse nodes that are not in ``kitchen``."""
    stock = read_copies(value, "items and their copies in stock")
    require(all(o in kitchen for o in stock), "expected kitchen items in stock")
    return stock


def read_amounts(value: Any, subject: Subject) -> dict[int, tuple[dict[int, int], dict[int, int]]]:
    """Return the stated amounts by unit id: those of inputs and those of outputs, each by node id.

    Refuse a list that differs from the amounts of ``subject``. Amounts of units and nodes that the network
    does not have are ignored.
    """
    what = "units and the amounts of their inputs and outputs"
    stated_amounts: dict[int, tuple[dict[int, int], dict[int, int]]] = {}
    for entry in read_list(value):
        fields = read_list(entry)
        require(len(fields) == 3 and type(fields[0]) is int, f"expected {what}")
        stated_amounts[fields[0]] = read_copies(fields[1], what), read_copies(fields[2], what)
    network = subject.network
    amounts_of_data: dict[int, tuple[dict[int, int], dict[int, int]]] = {}
    for unit, sides in subject.amounts.items():
        unit_id = network.unit_id(unit)
        if unit_id is not None and any(sides):
            inputs, outputs = (
                {o: n for node, n in side.items() if (o := network.object_id(node)) is not None}
                for side in sides
            )
            amounts_of_data[unit_id] = inputs, outputs
    require(stated_amounts == amounts_of_data, "the amounts of units are not those of the data")
    return stated_amounts


def read_stays(value: Any, node_count: int) -> dict[str | int, bool]:
    """Return, for labels and for node ids, whether a certificate states that they stay when used.

    ``value`` has to be a list of pairs: first sorted labels, then ascending ids below ``node_count``.
    """
    what = "labels and nodes, and whether they stay"
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    well_formed = all(type(name) in (int, str) and type(stays) is bool for name, stays in pairs)
    require(well_formed, f"expected {what}")
    labels = [name for name, _ in pairs if type(name) is str]
    ids = [name for name, _ in pairs if type(name) is int]
    require([*labels, *ids] == [name for name, _ in pairs], "expected labels, and then nodes")
    require(labels == sorted(set(labels)) and ids == sorted(set(ids)), "expected each of them once, in order")
    require(all(0 <= o < node_count for o in ids), "expected ids of nodes that stay or go")
    require(all(label.isprintable() for label in labels), "a label has letters that cannot be printed")
    return dict(pairs)
