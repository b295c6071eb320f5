"""What a unit, or an item of the kitchen, is worth to a question."""

from collections.abc import Iterable

from foon_asp.api.answer import Answer, asked_with
from foon_asp.api.arguments import Constants, Objectives, chosen_objectives, settings
from foon_asp.api.shown import Shown
from foon_asp.api.warning import Warner
from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.explain import regret as explain
from foon_asp.problem import Problem
from foon_asp.report.drawing import Drawing
from foon_asp.report.regret import regrets_json, regrets_text


class Regrets(Shown, explain.Regrets):
    """An optimal tree, and what its parts are worth: what is missed most first.

    Each of ``regrets`` has ``part`` (``unit`` or ``item``), the ``id`` of that unit or object node in the
    problem's network, and ``status`` and ``costs`` of the optimum without it; ``json()`` has names, too.
    """

    __slots__ = ()

    @property
    def outcome(self) -> Answer:
        """The best tree with everything."""
        return Answer._make(super().outcome)

    def text(self) -> str:
        """Give the answer as ``foon-asp regret`` does."""
        return regrets_text(self)

    def json_text(self) -> str:
        """Give the answer as ``foon-asp regret --format json`` does."""
        return regrets_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture of the best tree shows."""
        return self.outcome.drawing()


def regret(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    units: Iterable[int] = (),
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Regrets:
    """Find the optimum without each unit of the best tree, and without each kitchen item it takes.

    ``units`` are ids, as in ``json()``, of further units to ask about. ``time_limit`` is for each answer.
    Otherwise as :func:`foon_asp.solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    numbers = tuple(units)
    asked = problem.whole if numbers else asked_with(problem, how)
    found = [asked.network.unit_of_number(number) for number in numbers]
    ids = [unit for unit in found if unit is not None]
    if len(ids) < len(found):
        raise UserError(f"there is no unit {numbers[found.index(None)]} in the network")
    return Regrets._make(explain.regrets(asked, chosen, how, ids, Warner()))
