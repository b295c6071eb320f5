"""What is best: one row for each objective, and lexicographic lists of them."""

from collections.abc import Callable, Collection, Iterable, Iterator
from enum import StrEnum
from fractions import Fraction
from functools import cache, partial
from typing import ClassVar, NamedTuple, Protocol

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode


class Known(StrEnum):
    """What objectives look at that not all data have."""

    RATES = "rates"
    PRICES = "prices"
    MEASURES = "measures"


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

    def measure(self, name: str) -> int | Fraction:
        """What it costs by a measure of the user's, from 0; raises ``ValueError`` for one not known."""


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


class _Listed(type):
    """Makes the class of objectives list those built in."""

    def __iter__(cls) -> Iterator["Objective"]:
        return iter(_BUILT_IN.values())

    def __len__(cls) -> int:
        return len(_BUILT_IN)

    def __contains__(cls, name: object) -> bool:
        return name in _BUILT_IN


class Objective(str, metaclass=_Listed):
    """What makes a tree the best: a name, with the row that says how it is measured.

    ``UNITS``: fewest functional units. ``INPUTS``: fewest input object nodes, summed over the units.
    ``INPUTS_AND_INGREDIENTS``: the same plus the ingredients of these nodes (the measure of a published
    heuristic). ``SUCCESS``: greatest product of success rates. ``KITCHEN``: fewest distinct kitchen items
    among the inputs needed. ``ATTEMPTS``: fewest expected executions of units, if a failed unit is repeated
    until it succeeds. ``PRICE``: least sum of the prices of units.

    These are the objectives that are built in; the class lists them. :meth:`of_measure` gives that of a
    measure of your own. There is one object for each.

    Example:
        >>> [str(objective) for objective in foon_asp.Objective][:3]
        ['units', 'inputs', 'inputs+ingredients']
        >>> foon_asp.Objective.of_measure("washing_up")
        <Objective: 'washing_up'>
        >>> foon_asp.Objective.of_row("steps", foon_asp.Objective.UNITS.row) == "steps"
        True
    """

    row: Row

    UNITS: ClassVar["Objective"]
    INPUTS: ClassVar["Objective"]
    INPUTS_AND_INGREDIENTS: ClassVar["Objective"]
    SUCCESS: ClassVar["Objective"]
    KITCHEN: ClassVar["Objective"]
    ATTEMPTS: ClassVar["Objective"]
    PRICE: ClassVar["Objective"]

    def __new__(cls, name: str) -> "Objective":
        """Give the objective of a name that is built in; raises ``ValueError`` for others."""
        if name not in _BUILT_IN:
            raise ValueError(f"{name!r} is no objective")
        return _BUILT_IN[name]

    @classmethod
    def of_row(cls, name: str, row: Row) -> "Objective":
        """Make an objective of a name and a row.

        Parameters:
            name: The name.
            row: How it is measured.
        """
        objective = str.__new__(cls, name)
        objective.__dict__["row"] = row
        return objective

    @staticmethod
    @cache
    def of_measure(name: str) -> "Objective":
        """Give the objective of a measure of the user's own: the least sum of what it says of the units.

        Parameters:
            name: The name of the measure.
        """
        row = Row(name, name, partial(_measure, name), needs=Known.MEASURES, is_fact=True, whole=False)
        return Objective.of_row(name, row)

    def __setattr__(self, name: str, value: object) -> None:
        """Raise ``AttributeError``: objectives do not change."""
        raise AttributeError(f"an objective does not change, and cannot be given {name!r}")

    def __reduce__(self) -> tuple[Callable[[str], "Objective"], tuple[str]]:
        """Pickle the name: another process has the same objectives."""
        return Objective.of_measure if self.row.needs is Known.MEASURES else Objective, (str(self),)

    def __repr__(self) -> str:
        return f"<Objective: {str(self)!r}>"


def _measure(name: str, unit: Measured) -> int | Fraction:
    return unit.measure(name)


_BUILT_IN = {
    str(objective): objective
    for objective in (
        Objective.of_row("units", Row("units", "functional units", lambda _: 1)),
        Objective.of_row(
            "inputs", Row("inputs", "input object nodes", lambda unit: sum(1 for _ in unit.inputs))
        ),
        Objective.of_row(
            "inputs+ingredients",
            Row(
                "inputs_and_ingredients",
                "input object nodes and ingredients",
                lambda unit: sum(1 + len(node.ingredients) for node in unit.inputs),
            ),
        ),
        Objective.of_row(
            "success",
            Row(
                "success",
                "success rate",
                lambda unit: unit.rate,
                multiplies=True,
                needs=Known.RATES,
                whole=False,
            ),
        ),
        Objective.of_row("kitchen", Row("kitchen", "kitchen items", lambda _: 0, item=1)),
        Objective.of_row(
            "attempts",
            Row(
                "attempts",
                "expected executions of units",
                lambda unit: 1 / unit.rate,
                needs=Known.RATES,
                is_fact=True,
                whole=False,
            ),
        ),
        Objective.of_row(
            "price",
            Row("price", "price", lambda unit: unit.price, needs=Known.PRICES, is_fact=True, whole=False),
        ),
    )
}
for _objective in _BUILT_IN.values():
    setattr(Objective, _objective.row.term.upper(), _objective)


def multiplies(objective: Objective) -> bool:
    """Whether an objective multiplies what units cost, and more is better; the others add, and less is."""
    return objective.row.multiplies


def parse_objectives(names: Iterable[str], measures: Collection[str] = ()) -> tuple[Objective, ...]:
    """Read a lexicographic list, first the most important; raises :class:`UserError` for unknown names.

    Each name may itself be a comma-separated list. ``measures`` are the names of the user's own.
    """
    objectives: list[Objective] = []
    for name in (part.strip() for item in names for part in item.split(",")):
        if name not in _BUILT_IN and name not in measures:
            known = ", ".join((*_BUILT_IN, *measures))
            raise UserError(
                f"found the objective {name!r}, expected one of {known}, or a measure whose rules are given"
            )
        objective = Objective.of_measure(name) if name in measures else Objective(name)
        if objective in objectives:
            raise UserError(f"the objective {name!r} is listed twice")
        objectives.append(objective)
    return tuple(objectives)


def levels(objectives: tuple[Objective, ...]) -> tuple[Objective, ...]:
    """Give the list that is optimized: ``units`` comes last, so that no tree carries a spare unit."""
    return objectives if Objective.UNITS in objectives else (*objectives, Objective.UNITS)
