"""Objectives: how each is measured, and lexicographic lists of them."""

from collections.abc import Callable, Collection, Iterable, Iterator
from enum import StrEnum
from fractions import Fraction
from functools import cache, partial
from typing import ClassVar, NamedTuple, Protocol

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode


class OptionalData(StrEnum):
    """A kind of data that a problem may lack and an objective may need."""

    RATES = "rates"
    PRICES = "prices"
    MEASURES = "measures"
    STAND_INS = "stand-ins"


class Measured(Protocol):
    """A unit with the properties that objectives read."""

    @property
    def inputs(self) -> Iterable[ObjectNode]:
        """The input object nodes."""

    @property
    def rate(self) -> Fraction:
        """The success rate, above 0 and at most 1; raises ``ValueError`` where it is not known."""

    @property
    def price(self) -> Fraction:
        """The price, from 0; raises ``ValueError`` where it is not known."""

    @property
    def dissimilarity(self) -> Fraction:
        """The dissimilarity of the unit if it is a stand-in; 0 for other units."""

    def measure(self, name: str) -> int | Fraction:
        """Return the cost by the user measure of this name, from 0.

        Raises ``ValueError`` for an unknown measure.
        """


class Row(NamedTuple):
    """The definition of an objective: a sum over units and kitchen items, or a product over units.

    ``term``: the name of the objective in the encodings.
    ``words``: its name on the axis of a chart.
    ``unit``: a function that returns the cost of a unit, an exact number.
    ``item``: the cost of each distinct kitchen item that the units need.
    ``multiplies``: whether the values of units are multiplied, and more is better. Otherwise they are added
    up, and less is better.
    ``needs``: the kind of optional data that the objective needs; ``None`` if it needs none.
    ``is_fact``: whether the encodings read the costs of units from facts ``cost/3``. No other facts state
    these costs.
    ``whole``: whether all costs are integers.
    """

    term: str
    words: str
    unit: Callable[[Measured], int | Fraction]
    item: int = 0
    multiplies: bool = False
    needs: OptionalData | None = None
    is_fact: bool = False
    whole: bool = True


class _IterableOverBuiltIns(type):
    """The metaclass of objectives: ``iter``, ``len`` and ``in`` of the class are about the built-in ones."""

    def __iter__(cls) -> Iterator["Objective"]:
        return iter(_BUILT_IN.values())

    def __len__(cls) -> int:
        return len(_BUILT_IN)

    def __contains__(cls, name: object) -> bool:
        return name in _BUILT_IN


class Objective(str, metaclass=_IterableOverBuiltIns):
    """An objective by which trees are optimized: a name, with the ``row`` that defines how it is measured.

    ``UNITS``: fewest functional units.
    ``INPUTS``: fewest input object nodes, summed over the units.
    ``INPUTS_AND_INGREDIENTS``: fewest input object nodes and ingredients in them, the measure of a published
    heuristic.
    ``SUCCESS``: greatest product of success rates.
    ``KITCHEN``: fewest distinct kitchen items among the inputs needed.
    ``ATTEMPTS``: fewest expected executions of units, if a failed unit is repeated until it succeeds.
    ``PRICE``: least sum of the prices of units.
    ``DISSIMILARITY``: least sum of the dissimilarities of stand-ins.

    Iteration over the class yields these built-in objectives. :meth:`of_measure` returns the objective of a
    user measure. There is only one object for each objective, so objectives can be compared by ``is``.

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
    DISSIMILARITY: ClassVar["Objective"]

    def __new__(cls, name: str) -> "Objective":
        """Return the built-in objective of this name; raises ``ValueError`` for other names."""
        if name not in _BUILT_IN:
            raise ValueError(f"{name!r} is no objective")
        return _BUILT_IN[name]

    @classmethod
    def of_row(cls, name: str, row: Row) -> "Objective":
        """Return a new objective, which is not among the built-in ones.

        Parameters:
            name: The name.
            row: The definition of how it is measured.
        """
        objective = str.__new__(cls, name)
        objective.__dict__["row"] = row
        return objective

    @staticmethod
    @cache
    def of_measure(name: str) -> "Objective":
        """Return the objective of a user measure: least sum of the costs that the measure assigns to units.

        Each call with the same name returns the same object.

        Parameters:
            name: The name of the measure.
        """
        row = Row(
            name, name, partial(_user_cost, name), needs=OptionalData.MEASURES, is_fact=True, whole=False
        )
        return Objective.of_row(name, row)

    def __setattr__(self, name: str, value: object) -> None:
        """Raise ``AttributeError``: objectives do not change."""
        raise AttributeError(f"an objective does not change, and cannot be given {name!r}")

    def __reduce__(self) -> tuple[Callable[[str], "Objective"], tuple[str]]:
        """Pickle an objective as its name: unpickling returns the single object of that name.

        Unpickling raises ``ValueError`` for an objective of :meth:`of_row`.
        """
        return Objective.of_measure if self.row.needs is OptionalData.MEASURES else Objective, (str(self),)

    def __repr__(self) -> str:
        return f"<Objective: {str(self)!r}>"


def _user_cost(name: str, unit: Measured) -> int | Fraction:
    """Return the cost of a unit by a user measure."""
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
                needs=OptionalData.RATES,
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
                needs=OptionalData.RATES,
                is_fact=True,
                whole=False,
            ),
        ),
        Objective.of_row(
            "price",
            Row(
                "price",
                "price",
                lambda unit: unit.price,
                needs=OptionalData.PRICES,
                is_fact=True,
                whole=False,
            ),
        ),
        Objective.of_row(
            "dissimilarity",
            Row(
                "dissimilarity",
                "dissimilarity of stand-ins",
                lambda unit: unit.dissimilarity,
                needs=OptionalData.STAND_INS,
                is_fact=True,
                whole=False,
            ),
        ),
    )
}
for _objective in _BUILT_IN.values():
    setattr(Objective, _objective.row.term.upper(), _objective)


def multiplies(objective: Objective) -> bool:
    """Whether an objective is a product, of which more is better.

    Any other objective is a sum, of which less is better.
    """
    return objective.row.multiplies


def parse_objectives(names: Iterable[str], measures: Collection[str] = ()) -> tuple[Objective, ...]:
    """Return the lexicographic list of objectives with these names, the most important first.

    Each of the ``names`` may be a comma-separated list; spaces around names are ignored. ``measures`` are the
    names of user measures.

    Raises :class:`UserError` for an unknown name, and for an objective that is listed twice.
    """
    objectives: list[Objective] = []
    for name in (word.strip() for item in names for word in item.split(",")):
        if name not in _BUILT_IN and name not in measures:
            expected = ", ".join((*_BUILT_IN, *measures))
            raise UserError(
                f"found the objective {name!r}, expected one of {expected}, "
                "or a measure whose rules are given"
            )
        objective = Objective.of_measure(name) if name in measures else Objective(name)
        if objective in objectives:
            raise UserError(f"the objective {name!r} is listed twice")
        objectives.append(objective)
    return tuple(objectives)


def with_dissimilarity(objectives: tuple[Objective, ...]) -> tuple[Objective, ...]:
    """Return a list of objectives with ``dissimilarity``: put first if the list does not have it."""
    return objectives if Objective.DISSIMILARITY in objectives else (Objective.DISSIMILARITY, *objectives)


def levels(objectives: tuple[Objective, ...]) -> tuple[Objective, ...]:
    """Return the list by which trees are optimized: ``units`` is put last if the list does not have it.

    With ``units`` in the list, optimal trees are irredundant.
    """
    return objectives if Objective.UNITS in objectives else (*objectives, Objective.UNITS)
