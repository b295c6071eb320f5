"""Costs of a tree by all objectives, computed exactly from its units."""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from fractions import Fraction

from foon_asp.problem.objective import Measured, Objective, OptionalData, multiplies

_BUILT_IN_OBJECTIVES = tuple(Objective)


class Costs:
    """The costs of one tree or plan: ``measures`` maps each objective to its exact value.

    Objectives whose data are missing, such as rates, have no value. ``inputs`` is the number of input object
    nodes, summed over the units. It includes inputs that a container rule skips. ``kitchen`` is the number of
    distinct kitchen items that the units need. If items are used up, each copy of a consumable item counts as
    one kitchen item.

    Example:
        >>> costs = foon_asp.solve(foon_asp.load().problem("ice")).costs
        >>> costs.units, costs.inputs, str(costs.success)
        (2, 6, '161/250')
        >>> objectives = [foon_asp.Objective.INPUTS, foon_asp.Objective.UNITS]
        >>> costs.measure(objectives[0]), costs.key(objectives)
        (6, (6, 2))
    """

    __slots__ = ("measures",)

    def __init__(self, measures: Mapping[Objective, int | Fraction]) -> None:
        self.measures = measures

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Costs) and self.measures == other.measures

    def __hash__(self) -> int:
        return hash(tuple(self.measures.items()))

    def __repr__(self) -> str:
        return f"Costs({dict(self.measures)!r})"

    @property
    def units(self) -> int:
        """The number of units."""
        return int(self.measures[Objective.UNITS])

    @property
    def inputs(self) -> int:
        """The number of input object nodes of all units."""
        return int(self.measures[Objective.INPUTS])

    @property
    def ingredients(self) -> int:
        """The number of ingredients in the inputs, summed over the units."""
        return int(self.measures[Objective.INPUTS_AND_INGREDIENTS]) - self.inputs

    @property
    def kitchen(self) -> int:
        """The number of kitchen items that the units need."""
        return int(self.measures[Objective.KITCHEN])

    @property
    def success(self) -> Fraction | None:
        """The product of the success rates; ``None`` if no rates are known."""
        success = self.measures.get(Objective.SUCCESS)
        return None if success is None else Fraction(success)

    def measure(self, objective: Objective) -> int | Fraction:
        """Return the exact value by an objective.

        A greater value of ``success`` is better. For any other objective, a smaller value is better.
        ``dissimilarity`` is 0 for a problem without stand-ins.

        Parameters:
            objective: The objective.

        Raises:
            ValueError: if data are missing, as for ``success`` without rates, or for ``attempts`` with a rate
                of 0.
        """
        if objective not in self.measures and objective.row.needs is OptionalData.STAND_INS:
            return Fraction(0)  # there are none
        if objective not in self.measures:
            needs = objective.row.needs
            condition = " above 0" if needs is OptionalData.RATES else ""
            raise ValueError(f"{str(objective)!r} cannot be computed: it needs {needs}{condition}")
        return self.measures[objective]

    def key(self, objectives: Sequence[Objective]) -> tuple[int | Fraction, ...]:
        """Return a tuple of values for lexicographic comparison: a better tree has a smaller tuple.

        If more is better by an objective, its value is negated.

        Parameters:
            objectives: The objectives, the most important first.

        Raises:
            ValueError: if data are missing; see :meth:`measure`.
        """
        return tuple(
            -self.measure(objective) if multiplies(objective) else self.measure(objective)
            for objective in objectives
        )


def tree_costs(
    units: Mapping[Measured, int],
    items: int,
    available: Collection[OptionalData],
    user_objectives: Iterable[Objective] = (),
) -> Costs:
    """Return the exact costs of a tree or plan, by all objectives whose data are available.

    ``units``: the number of executions of each unit.
    ``items``: the number of kitchen items that the units need.
    ``available``: the kinds of optional data that all units have. Objectives that need other data are left
    out; ``attempts`` is also left out if a rate is 0.
    ``user_objectives``: objectives to measure in addition to the built-in ones.
    """
    measures: dict[Objective, int | Fraction] = {}
    for objective in (*_BUILT_IN_OBJECTIVES, *user_objectives):
        row = objective.row
        if row.needs is not None and row.needs not in available:
            continue
        try:
            figures = [(row.unit(unit), times) for unit, times in units.items()]
        except ZeroDivisionError:  # with a rate of 0, the expected number of attempts is infinite
            continue
        if row.multiplies:
            measures[objective] = _product([figure**times for figure, times in figures])
        else:
            totals = [figure * times for figure, times in figures]
            total = sum(totals) if row.whole else _sum(totals)
            measures[objective] = total + items * row.item
    return Costs(measures)


def _product(figures: Collection[int | Fraction]) -> Fraction:
    """Return the product of numbers as a fraction, which is reduced only once, at the end, to save time."""
    numerator = math.prod(figure.numerator for figure in figures)
    return Fraction(numerator, math.prod(figure.denominator for figure in figures))


def _sum(figures: Iterable[int | Fraction]) -> Fraction:
    """Return the sum of numbers as a fraction.

    Numbers of equal denominators are added first, which is fast if there are few distinct denominators.
    """
    numerators: dict[int, int] = {}
    for figure in figures:
        denominator = figure.denominator
        numerators[denominator] = numerators.get(denominator, 0) + figure.numerator
    parts = (Fraction(numerator, denominator) for denominator, numerator in numerators.items())
    return sum(parts, start=Fraction(0))
