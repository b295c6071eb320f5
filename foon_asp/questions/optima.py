"""The optimum of every goal under every objective, in one table."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from foon_asp.asp import Outcome, Settings
from foon_asp.asp import solve as find
from foon_asp.dataset.nearby import NearbyProblem, shown
from foon_asp.dataset.nearby_optimum import near_goals
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel, Deadline
from foon_asp.document.json_document import document
from foon_asp.problem import Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, answered_nearby
from foon_asp.questions.arguments import (
    Constants,
    asked_with,
    chosen_objectives,
    limits,
    read,
    settings,
    usual_objectives,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, question
from foon_asp.questions.options import CONTAINERS, EACH_GOAL, EACH_LIMITS, ITEMS, OBJECTIVES, RULES
from foon_asp.questions.posing import each_goal_or_nearby
from foon_asp.questions.result import Ending, Result
from foon_asp.report.optima_table import optima_table
from foon_asp.report.renderable import Renderable, plain_text


@dataclass(frozen=True, repr=False)
class Optima(Result):
    """The best trees for each goal of a ``problem`` by itself.

    ``outcomes`` has the answers goal by goal, with one for each objective in order.

    Example:
        >>> best = foon_asp.optima(foon_asp.load().problem("ice"))
        >>> [str(answer.objectives[0]) for answer in best.outcomes]
        ['units', 'inputs', 'success']
    """

    problem: Problem
    outcomes: tuple[Answer, ...]

    @property
    def ending(self) -> Ending:
        """Done when every answer is proved, a goal without a tree included."""
        stopped = any(outcome.ending is Ending.LIMIT for outcome in self.outcomes)
        return Ending.LIMIT if stopped else Ending.DONE

    def text(self) -> str:
        """Give the table; equal trees share a row."""
        return plain_text(self.renderable())

    def renderable(self) -> Renderable:
        """Give the table, as wide and in such colours as a console has."""
        return optima_table(self.outcomes)

    def json_dict(self) -> object:
        """Give the answers; the objectives are all that were asked about."""
        objectives = dict.fromkeys(each for outcome in self.outcomes for each in outcome.objectives)
        answers = [outcome.json_dict() for outcome in self.outcomes]
        return document("optima", self.problem, objectives, answers=answers)

    def __repr__(self) -> str:
        return f"<Optima: {len(self.outcomes)} answers>"


@question(
    EACH_GOAL,
    OBJECTIVES._replace(
        help="An objective, or a list by commas of which the first counts most; one row each. By default "
        "units, inputs and, where rates are known, success.",
        default=None,
    ),
    CONTAINERS,
    *ITEMS,
    *RULES,
    *EACH_LIMITS,
    formats=TABLES,
    help_="""
    The limits are for each answer. Exits with 0 when every answer is proved, a goal without a tree
    included, and with 3 when one was stopped at the limit.
    """,
    pose=each_goal_or_nearby,
)
def optima(
    problem: Problem,
    objectives: str | Iterable[str] = (),
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Optima:
    """Find the best tree for each goal of a problem by itself, under several objectives.

    The limits are for each answer.

    Parameters:
        objectives: Several objectives; each is one name, or a list separated by commas. Without any: units,
            inputs and, where rates are known, success.

    Returns:
        The ``outcomes``: for each goal in order, one :class:`Answer` for each objective.

    Raises:
        UserError: for a wrong argument or constraint, or an objective that needs rates or prices not given.

    Example:
        >>> problem = foon_asp.load().problem("ice", "tea")
        >>> [answer.costs.units for answer in foon_asp.optima(problem, ["units", "success"]).outcomes]
        [2, 3, 7, 7]
    """
    asked = usual_objectives(problem, objectives, ("units", "inputs", "success"), ("units", "inputs"))
    texts = [asked] if isinstance(asked, str) else asked
    lists = [chosen_objectives(problem, text) for text in texts]
    # limits are for each answer, ctrl-C is for all of them
    how, whole = settings(constraints, constants, encodings), Deadline(within=caller().deadline)
    each_limits = limits(time_limit, memory_limit)
    outcomes: list[Outcome] = []
    for goal in _each_goal(problem, how):
        for chosen in lists:
            within = how._replace(deadline=Deadline(*each_limits, within=whole))
            near = near_goals(goal, chosen, within)
            if near is None:
                outcomes.append(find(read(goal), chosen, within, caller().reporter))
            else:
                outcomes.append(answered_nearby(near, chosen, within))
    return Optima(shown(problem), tuple(map(Answer._make, outcomes)))


def _each_goal(problem: Problem, how: Settings) -> list[Problem]:
    """Give a problem for each goal; of a large store without rules, it is read as far as an answer takes."""
    if isinstance(problem, NearbyProblem) and not how.constraints and how.replaced is None:
        return problem.each_goal()
    problem = asked_with(problem, how)
    return [replace(problem, goals=(goal,)) for goal in problem.goals]
