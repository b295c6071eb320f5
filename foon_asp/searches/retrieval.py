"""What a search ended with, and the backward procedure that the published searches share."""

from collections import deque
from collections.abc import Callable, Sequence
from enum import StrEnum
from fractions import Fraction
from typing import NamedTuple

from foon_asp.problem import Problem

Choose = Callable[[Sequence[int]], int]
"""Chooses one of the units that make an object; they come in file order and there is at least one."""


class Ending(StrEnum):
    """How a search ended.

    ``tree``: with units, which may or may not execute. ``stuck``: at an object that is not in the kitchen
    and that no unit makes. ``none``: having shown that no tree executes. ``unknown``: at a limit.
    """

    TREE = "tree"
    STUCK = "stuck"
    NONE = "none"
    UNKNOWN = "unknown"


class Retrieval(NamedTuple):
    """The result of a search: ``units`` by id in the order listed, ``stuck_at`` the object in the way."""

    ending: Ending
    units: tuple[int, ...] = ()
    stuck_at: int | None = None


class Count(StrEnum):
    """What counts as inputs: input object nodes and their ingredients, or the nodes alone."""

    INGREDIENTS = "ingredients"
    NODES = "nodes"


class Ties(StrEnum):
    """Which of several equally good units is taken: the first or the last in file order."""

    FIRST = "first"
    LAST = "last"


def backward(problem: Problem, choose: Choose, stack: bool = False) -> Retrieval:
    """Retrieve a tree as the published programs do, from a queue of objects, or with ``stack`` a stack.

    It starts with the goals. An object that was taken before or is in the kitchen is skipped; for any
    other, one unit that makes it is chosen, appended (unless it is there already) and its needed inputs
    are queued. At the end the list is reversed. Nothing is ever taken back, so the tree may be larger
    than need be and may not execute: it promises only that every needed input is in the kitchen or an
    output of some unit of the tree. Outputs are taken as annotated, as published: a container that the rule
    ``implied`` let a unit skip counts as made here, and not when the tree is executed.

    Source: D. Paulius et al., "Functional Object-Oriented Network for Manipulation Learning", IROS 2016
    (retrieval of task trees), and the published programs that followed (docs/dev/sources.md).
    """
    network, kitchen = problem.network, problem.kitchen
    waiting = deque(problem.goals)
    taken: set[int] = set()
    units: dict[int, None] = {}
    while waiting:
        o = waiting.pop() if stack else waiting.popleft()
        if o in taken or o in kitchen:
            continue
        taken.add(o)
        candidates = network.producers[o]
        if not candidates:
            return Retrieval(Ending.STUCK, stuck_at=o)
        unit = choose(candidates)
        if unit not in units:
            units[unit] = None
            waiting.extend(problem.needs[unit])
    return Retrieval(Ending.TREE, tuple(reversed(units)))


def least(ties: Ties, size: Callable[[int], int | Fraction] = lambda _: 0) -> Choose:
    """Choose the unit of the least size; of several, the first or the last in file order."""
    return lambda candidates: min(candidates if ties is Ties.FIRST else reversed(candidates), key=size)
