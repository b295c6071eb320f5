"""What is best: one row for each objective, and lexicographic lists of them."""

from collections.abc import Callable, Iterable
from enum import StrEnum
from fractions import Fraction
from typing import NamedTuple, Protocol, Self

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode


class Known(StrEnum):
    """What objectives look at that not all data have."""

    RATES = "rates"
    PRICES = "prices"


class Measured(Protocol):
    """What an objective may look at in a unit."""

    @property
    def inputs(self) -> Iterable[ObjectNode]:
        """Its input object nodes."""

    @property
    def rate(self) -> Fraction:
        """Its success rate, above 0 and at most 1; raises ``ValueError`` where it is not known."""

    @property
    def price(self) -> Fraction:
        """Its price, from 0; raises ``ValueError`` where it is not known."""


class Row(NamedTuple):
    """How an objective is measured.

    ``unit`` is what a unit costs by it, an exact number, and ``item`` what each distinct kitchen item costs
    that the units need. What units cost is added up, and less is better; or, where it ``multiplies``, it is
    a factor, and more is better. ``term`` is the objective's name in the encodings, ``words`` are what a
    chart has on its axis. ``is_fact`` says that the encodings read what each unit costs from
    ``cost/3``, since they have no other predicate for it. ``whole`` says that all costs are whole numbers,
    and ``needs`` what has to be known for it.
    """

    term: str
    words: str
    unit: Callable[[Measured], int | Fraction]
    item: int = 0
    multiplies: bool = False
    needs: Known | None = None
    is_fact: bool = False
    whole: bool = True


class Objective(StrEnum):
    """What makes a tree the best.

    ``UNITS``: fewest functional units. ``INPUTS``: fewest input object nodes, summed over the units.
    ``INPUTS_AND_INGREDIENTS``: the same plus the ingredients of these nodes (the measure of a published
    heuristic). ``SUCCESS``: greatest product of success rates. ``KITCHEN``: fewest distinct kitchen items
    among the inputs needed. ``ATTEMPTS``: fewest expected executions of units, if a failed unit is repeated
    until it succeeds. ``PRICE``: least sum of the prices of units.

    Example:
        >>> [str(objective) for objective in foon_asp.Objective][:3]
        ['units', 'inputs', 'inputs+ingredients']
    """

    row: Row

    def __new__(cls, name: str, row: Row | None = None) -> Self:
        """Make an objective of its name and its row."""
        assert row is not None
        objective = str.__new__(cls, name)
        objective._value_, objective.row = name, row
        return objective

    UNITS = "units", Row("units", "functional units", lambda _: 1)
    INPUTS = "inputs", Row("inputs", "input object nodes", lambda unit: sum(1 for _ in unit.inputs))
    INPUTS_AND_INGREDIENTS = (
        "inputs+ingredients",
        Row(
            "inputs_and_ingredients",
            "input object nodes and ingredients",
            lambda unit: sum(1 + len(node.ingredients) for node in unit.inputs),
        ),
    )
    SUCCESS = (
        "success",
        Row(
            "success",
            "success rate",
            lambda unit: unit.rate,
            multiplies=True,
            needs=Known.RATES,
            whole=False,
        ),
    )
    KITCHEN = "kitchen", Row("kitchen", "kitchen items", lambda _: 0, item=1)
    ATTEMPTS = (
        "attempts",
        Row(
            "attempts",
            "expected executions of units",
            lambda unit: 1 / unit.rate,
            needs=Known.RATES,
            is_fact=True,
            whole=False,
        ),
    )
    PRICE = (
        "price",
        Row("price", "price", lambda unit: unit.price, needs=Known.PRICES, is_fact=True, whole=False),
    )


def multiplies(objective: Objective) -> bool:
    """Whether an objective multiplies what units cost, and more is better; the others add, and less is."""
    return objective.row.multiplies


def parse_objectives(names: Iterable[str]) -> tuple[Objective, ...]:
    """Read a lexicographic list, first the most important; raises :class:`UserError` for unknown names.

    Each name may itself be a comma-separated list.
    """
    objectives: list[Objective] = []
    for name in (part.strip() for item in names for part in item.split(",")):
        try:
            objective = Objective(name)
        except ValueError:
            raise UserError(f"found the objective {name!r}, expected one of {', '.join(Objective)}") from None
        if objective in objectives:
            raise UserError(f"the objective {name!r} is listed twice")
        objectives.append(objective)
    return tuple(objectives)


def levels(objectives: tuple[Objective, ...]) -> tuple[Objective, ...]:
    """Give the list that is optimized: ``units`` comes last, so that no tree carries a spare unit."""
    return objectives if Objective.UNITS in objectives else (*objectives, Objective.UNITS)
