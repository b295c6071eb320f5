"""Several goals together: what one tree for all costs beside a tree for each."""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.problem import Objective, Problem, levels, multiplies


class Menu(NamedTuple):
    """A tree for all goals, and one for each, in the order of the goals.

    ``serves[u]`` are the goals (by object node id) that unit ``u`` of the tree for all is needed for, going
    back from each goal through the first makers.
    """

    together: Outcome
    separate: tuple[Outcome, ...]
    serves: dict[int, tuple[int, ...]]

    @property
    def shared(self) -> tuple[int, ...]:
        """The units of the tree for all that serve several goals, in the order of the tree."""
        return tuple(u for u in self.together.units or () if len(self.serves[u]) > 1)

    def sum_of_separate(self, objective: Objective) -> int | Fraction | None:
        """Add up what the trees cost one by one (``success``: multiply); ``None`` where one has no tree."""
        total: int | Fraction = Fraction(1) if multiplies(objective) else 0
        for outcome in self.separate:
            if outcome.costs is None:
                return None
            figure = outcome.costs.measure(objective)
            total = total * figure if multiplies(objective) else total + figure
        return total


def menu(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
) -> Menu:
    """Solve a question with several goals at once, and goal by goal.

    The time limit is for all of it. Raises :class:`UserError` like :func:`foon_asp.asp.solve`.
    """
    settings = (settings or Settings()).limited()
    together = solve(problem, objectives, settings, reporter)
    separate = tuple(
        solve(replace(problem, goals=(goal,)), objectives, settings, Reporter()) for goal in problem.goals
    )
    if settings.constraints == () and settings.replaced is None:  # else goals may have rules of their own
        holds = Postconditions(problem, levels(tuple(objectives)), settings)
        for goal, alone in zip(problem.goals, separate, strict=True):
            holds.no_better(together, alone, f"for goal {goal} alone")
    return Menu(together, separate, _serves(problem, together.units or ()))


def _serves(problem: Problem, units: Sequence[int]) -> dict[int, tuple[int, ...]]:
    """Say which goals each unit of a tree, given in an order that executes, is needed for."""
    makers: dict[int, int] = {}
    for unit in units:
        for o in problem.gives[unit]:
            if o not in problem.kitchen:
                makers.setdefault(o, unit)
    served: dict[int, list[int]] = {unit: [] for unit in units}
    for goal in problem.goals:
        stack, seen = [goal], set[int]()
        while stack:
            maker = makers.get(stack.pop())
            if maker is not None and maker not in seen:
                seen.add(maker)
                served[maker].append(goal)
                stack.extend(problem.needs[maker])
    return {unit: tuple(goals) for unit, goals in served.items()}
