"""The items of a certificate of a plan: stock, items that stay, amounts and copies, read from JSON."""

from collections.abc import Collection
from itertools import chain
from typing import Any

from foon_asp.proof.certificate_fields import read_list, read_number, read_pair
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import require

COUNTS = range(10**9)  # of copies of an item, and of executions of a unit


def read_copies(value: Any, what: str) -> dict[int, int]:
    """Return numbers of copies by id, from a list of pairs in order; ``what`` names them in errors."""
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    for number in chain.from_iterable(pairs):
        read_number(number, COUNTS, what)
    ids = [o for o, _ in pairs]
    require(ids == sorted(set(ids)), f"expected {what} in order, each of them once")
    return dict(pairs)


def read_stock(value: Any, kitchen: Collection[int]) -> dict[int, int]:
    """Return the copies in stock by id; refuse nodes that are no kitchen items."""
    stock = read_copies(value, "items and their copies in stock")
    require(all(o in kitchen for o in stock), "expected kitchen items in stock")
    return stock


def read_amounts(value: Any, subject: Subject) -> dict[int, tuple[dict[int, int], dict[int, int]]]:
    """Return the stated amounts of inputs and of outputs by unit id.

    Refuse amounts that differ from the data.
    """
    what = "units and the amounts of their inputs and outputs"
    stated: dict[int, tuple[dict[int, int], dict[int, int]]] = {}
    for row in read_list(value):
        columns = read_list(row)
        require(len(columns) == 3 and type(columns[0]) is int, f"expected {what}")
        stated[columns[0]] = read_copies(columns[1], what), read_copies(columns[2], what)
    network = subject.network
    of_data: dict[int, tuple[dict[int, int], dict[int, int]]] = {}
    for unit, sides in subject.amounts.items():
        number = network.unit_id(unit)
        if number is not None and any(sides):
            inputs, outputs = (
                {o: n for node, n in side.items() if (o := network.object_id(node)) is not None}
                for side in sides
            )
            of_data[number] = inputs, outputs
    require(stated == of_data, "the amounts of units are not those of the data")
    return stated


def read_stays(value: Any, nodes: int) -> dict[str | int, bool]:
    """Return for labels, and for nodes by id, whether they stay when used, as the certificate states it."""
    what = "labels and nodes, and whether they stay"
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    well_formed = all(type(name) in (int, str) and type(stays) is bool for name, stays in pairs)
    require(well_formed, f"expected {what}")
    labels = [name for name, _ in pairs if type(name) is str]
    ids = [name for name, _ in pairs if type(name) is int]
    require([*labels, *ids] == [name for name, _ in pairs], "expected labels, and then nodes")
    require(labels == sorted(set(labels)) and ids == sorted(set(ids)), "expected each of them once, in order")
    require(all(0 <= o < nodes for o in ids), "expected ids of nodes that stay or go")
    require(all(label.isprintable() for label in labels), "a label has letters that cannot be printed")
    return dict(pairs)
