"""Conditions that the counts of executions in every plan satisfy, and costs of counts."""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

Counts = dict[int, int]
"""How often each action is executed, without actions that are not."""


class Measure(NamedTuple):
    """The cost of executions by one objective, to be minimized.

    ``costs``: the cost of each action, a whole number from 0.
    ``item``: the cost of each distinct item, and of each initial copy that is consumed.
    ``exact``: returns the exact cost of counts, if ``costs`` are rounded down; else ``None``.
    ``classes``: the class of each action. The exact cost depends only on the number of executions in each
    class; actions of class -1 do not change it.
    """

    costs: Sequence[int]
    item: int = 0
    exact: Callable[[Mapping[int, int]], Fraction] | None = None
    classes: Sequence[int] = ()


class Landmark(NamedTuple):
    """The condition that one of the ``members`` is executed, or an initial copy of ``stock`` is consumed.

    With an ``action``, the condition applies only if the action is executed. ``objects`` are the objects of
    the cut from which the landmark follows.
    """

    members: tuple[int, ...]
    stock: tuple[int, ...] = ()
    action: int | None = None
    objects: tuple[int, ...] = ()


class Balance(NamedTuple):
    """The row of the state equation of an object: no more copies are consumed than there are."""

    object: int


class Supply(NamedTuple):
    """The condition that ``copies`` of an object are supplied for ``action``, if this is executed.

    The copies are initial or added by other actions, since the action adds none before its first execution.
    """

    object: int
    action: int
    copies: int


class Remainder(NamedTuple):
    """The condition that ``copies`` of an object remain in the end if ``action`` is executed.

    The action asks for the object. The last execution that asks for it leaves at least ``copies``, and later
    executions consume none.
    """

    object: int
    action: int
    copies: int


class Sum(NamedTuple):
    """The condition that a weighted sum of executions keeps to the limit with the index ``limit``."""

    limit: int


class Rounded(NamedTuple):
    """The condition that a weighted sum of conditions on counts implies, as counts are whole numbers.

    Its row is that of mixed-integer rounding, times ``scale``, which makes its coefficients whole.
    """

    weights: "tuple[tuple[Condition, Fraction], ...]"
    scale: Fraction


SumLimit = tuple[Mapping[int, int], int, bool, bool]
"""Weights by action, a bound on their sum, whether it is a lower bound, whether an action counts once."""


class Level(NamedTuple):
    """An objective with the cost of the incumbent.

    A plan is as good as the incumbent if its (rounded) costs add up to at most ``max_cost``, and its exact
    cost is at most ``cost``. If ``strict``, the exact cost has to be below ``cost``.
    """

    measure: Measure
    cost: Fraction
    max_cost: int
    strict: bool = False


Condition = Landmark | Balance | Supply | Remainder | Sum | Level | Rounded
"""The condition on the counts of every plan that a row of the program states."""
