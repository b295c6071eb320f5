"""Conditions that the counts of executions in every plan satisfy, and costs of counts.

An *action* is a unit of the question, and an *object* an object node; both are numbers.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

Counts = dict[int, int]
"""How often each action is executed; actions that are not executed are omitted."""


class Measure(NamedTuple):
    """The cost of executions by one objective, to be minimized.

    ``costs``: the cost of each action, a whole number from 0.
    ``item``: the cost of each distinct endless item, and of each initial copy that is taken.
    ``exact``: a function from counts to their exact cost, if ``costs`` are rounded down; otherwise ``None``.
    ``classes``: if ``costs`` are rounded, the class of each action. Actions of a class have one exact cost.
    Class -1 has the actions that do not change the exact cost of a plan.
    """

    costs: Sequence[int]
    item: int = 0
    exact: Callable[[Mapping[int, int]], Fraction] | None = None
    classes: Sequence[int] = ()


class Landmark(NamedTuple):
    """The condition that an action of a set is executed, or that an initial copy of an object is taken.

    ``members``: the set of actions.
    ``stock``: the objects of which an initial copy satisfies the condition.
    ``action``: the condition only applies if this action is executed; ``None`` if it always applies.
    ``objects``: the objects of the cut from which the landmark follows.
    """

    members: tuple[int, ...]
    stock: tuple[int, ...] = ()
    action: int | None = None
    objects: tuple[int, ...] = ()


class Balance(NamedTuple):
    """The row of the state equation of an object: enough copies are initial or added.

    They are enough for the copies consumed and, if the object is a goal, for those wanted in the end.
    """

    object: int


class Supply(NamedTuple):
    """The condition that ``action``, if it is executed, is supplied with ``copies`` of an object.

    These copies are initial or added by other actions, since the action adds none before its first execution.
    """

    object: int
    action: int
    copies: int


class Remainder(NamedTuple):
    """The condition that ``copies`` of an object remain in the end if ``action`` is executed.

    The action has the object as a precondition. The last execution with this precondition leaves at least
    ``copies``, and later executions consume none.
    """

    object: int
    action: int
    copies: int


class Sum(NamedTuple):
    """The condition that executions keep to a limit on a weighted sum.

    ``limit`` is the index in the list of limits of the question (:data:`SumLimit`).
    """

    limit: int


class Rounded(NamedTuple):
    """The condition that follows from a sum of weighted conditions because counts are whole numbers.

    Its row is that of mixed-integer rounding, multiplied by ``scale``, which makes its coefficients whole.
    """

    weights: "tuple[tuple[Condition, Fraction], ...]"
    scale: Fraction


SumLimit = tuple[Mapping[int, int], int, bool, bool]
"""A limit on a sum: weights by action, a bound on the sum, whether this is a lower bound, and whether each
action counts once, however often it is executed."""


class Level(NamedTuple):
    """The condition that a plan is as good as the incumbent, the best plan so far, by an objective.

    The costs of its actions by ``measure.costs`` have to add up to at most ``max_cost``. If these costs are
    rounded down, the exact cost of the plan also has to be at most ``cost``. If ``strict``, the exact cost
    has to be below ``cost``.
    """

    measure: Measure
    cost: Fraction
    max_cost: int
    strict: bool = False


Condition = Landmark | Balance | Supply | Remainder | Sum | Level | Rounded
"""A condition on the counts of every plan; a row of the program states it."""
