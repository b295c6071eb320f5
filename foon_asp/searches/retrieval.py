"""The result of a search, and the backward retrieval that most published searches share."""

from collections import deque
from enum import StrEnum
from typing import NamedTuple

from foon_asp.problem import Problem
from foon_asp.searches.ties import Choose


class Ending(StrEnum):
    """How a search ended.

    ``tree``: with the units of a tree, which may or may not execute.
    ``stuck``: at an object that is not in the kitchen and that no unit makes.
    ``none``: with the proof that no tree executes.
    ``unknown``: at a limit.
    """

    TREE = "tree"
    STUCK = "stuck"
    NONE = "none"
    UNKNOWN = "unknown"


class Retrieval(NamedTuple):
    """The result of a search.

    ``units``: the ids of the units of the tree, in the order listed; empty without a tree.
    ``stuck_at``: the id of the object that cannot be had; ``None`` unless the ending is ``stuck``.
    """

    ending: Ending
    units: tuple[int, ...] = ()
    stuck_at: int | None = None


class Count(StrEnum):
    """What is counted as inputs: input object nodes and their ingredients, or the nodes alone."""

    INGREDIENTS = "ingredients"
    NODES = "nodes"


def retrieve_backward(problem: Problem, choose: Choose, stack: bool = False) -> Retrieval:
    """Retrieve a tree backward from the goals, without backtracking, as the published programs do.

    Open objects, at first the goals, are in a queue, or with ``stack`` in a stack. An object that was
    processed before or is in the kitchen is skipped. For any other object, ``choose`` returns one achiever.
    An achiever that the tree does not have yet is appended to the tree, and its preconditions become open. In
    the end, the order of the units is reversed. An object without achievers ends the search as ``stuck``.

    No choice is revised, so that the tree may be larger than necessary and may not execute. The only
    guarantee is that every precondition is in the kitchen or an output of a unit of the tree. Outputs are
    the annotated ones, as in the published programs. So a container that a unit takes as given under the rule
    ``implied`` counts as made here, but not when the tree is executed.

    Source: D. Paulius et al., "Functional Object-Oriented Network for Manipulation Learning", IROS 2016
    (retrieval of task trees), and the published programs that followed (docs/dev/sources.md).
    """
    network, kitchen = problem.network, problem.kitchen
    open_objects = deque(problem.goals)
    closed: set[int] = set()
    units: dict[int, None] = {}
    while open_objects:
        o = open_objects.pop() if stack else open_objects.popleft()
        if o in closed or o in kitchen:
            continue
        closed.add(o)
        candidates = network.producers[o]
        if not candidates:
            return Retrieval(Ending.STUCK, stuck_at=o)
        unit = choose(candidates)
        if unit not in units:
            units[unit] = None
            open_objects.extend(problem.needs[unit])
    return Retrieval(Ending.TREE, tuple(reversed(units)))
