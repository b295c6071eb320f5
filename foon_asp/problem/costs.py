"""What a tree costs, computed exactly from its units."""

from fractions import Fraction
from typing import NamedTuple

from foon_asp.errors import BugError
from foon_asp.problem.objective import Objective, multiplies


class Costs(NamedTuple):
    """All measures of one tree.

    ``inputs`` counts the input object nodes of every unit (once per unit, whatever the container rule
    asks for), ``ingredients`` the ingredients of those nodes, ``kitchen`` the distinct kitchen items
    among the needed inputs. ``success`` is the product of the rates, ``None`` where no rates are known.
    """

    units: int
    inputs: int
    ingredients: int
    kitchen: int
    success: Fraction | None

    def measure(self, objective: Objective) -> int | Fraction:
        """Give the figure an objective looks at; for ``success`` more is better, else less.

        Raises ``ValueError`` for ``success`` where no rates are known, and :class:`BugError` for an objective
        that is not known here.
        """
        if multiplies(objective):
            if self.success is None:
                raise ValueError("no success rates are known")
            return self.success
        known = {
            Objective.UNITS: self.units,
            Objective.INPUTS: self.inputs,
            Objective.INPUTS_AND_INGREDIENTS: self.inputs + self.ingredients,
            Objective.KITCHEN: self.kitchen,
        }
        if objective not in known:
            raise BugError(f"nothing says what a tree has by the objective {str(objective)!r}")
        return known[objective]

    def key(self, objectives: tuple[Objective, ...]) -> tuple[int | Fraction, ...]:
        """Give a tuple that is smaller for a better tree under the lexicographic list."""
        return tuple(
            -self.measure(objective) if multiplies(objective) else self.measure(objective)
            for objective in objectives
        )
