"""Several goals of one tree: the optimum for each goal by itself, and the goals that each unit serves."""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.nearby import NearbyProblem
from foon_asp.problem import Objective, Problem, for_each_goal, levels, multiplies
from foon_asp.questions.answer import Alone, Answer, Serving, answered_under
from foon_asp.results.values_of import node_of, nodes_of


class GoalsApartTuning(NamedTuple):
    """When the goals of a tree are also solved one by one.

    ``goals`` is the greatest number of such goals, since each goal is one more search and one more line.
    For more goals there is the option ``--all-goals``.
    """

    goals: int = 8


def with_goals_apart(answer: Answer, settings: Settings, posed: Problem) -> Answer:
    """Return an answer with the goals that each unit serves and, for few goals, the optimum of each goal.

    ``posed`` is the problem as it was posed. Of a large store, only what each goal needs is read.
    """
    problem, network = answer.problem, answer.problem.network
    serves = tuple(
        Serving(network.unit_number(unit), nodes_of(network, goals))
        for unit, goals in _served(problem, answer.outcome.units or ()).items()
    )
    if len(problem.goals) > GoalsApartTuning().goals:
        return answer.having(serves=serves)
    apart = _solved_apart(answer, settings, posed)
    nodes = [node_of(network, goal) for goal in problem.goals]
    return answer.having(
        goals_alone=tuple(
            Alone(node, alone.status, alone.costs) for node, alone in zip(nodes, apart, strict=True)
        ),
        sum_of_goals_alone=_sum(apart, answer.objectives[0]),
        serves=serves,
    )


def _solved_apart(answer: Answer, settings: Settings, posed: Problem) -> list[Outcome]:
    """Return the optimum of each goal by itself."""
    together, problem, objectives = answer.outcome, answer.problem, answer.objectives
    if isinstance(posed, NearbyProblem):
        single = posed.single_goal_problems()
        apart = [
            answered_under(goal_problem, objectives, settings, Reporter()).outcome for goal_problem in single
        ]
    else:
        single = for_each_goal(problem)
        apart = [solve(goal_problem, objectives, settings, Reporter()) for goal_problem in single]
    if settings.constraints == () and settings.replaced is None:  # else goals may have rules of their own
        holds = Postconditions(problem, levels(objectives), settings)
        for goal, alone in zip(problem.goals, apart, strict=True):
            holds.no_better(together, alone, f"for goal {goal} alone")
    return apart


def _sum(apart: Sequence[Outcome], objective: Objective) -> int | Fraction | None:
    """Return the summed costs of trees (``success``: the product); ``None`` if a goal has no tree."""
    total: int | Fraction = Fraction(1) if multiplies(objective) else 0
    for alone in apart:
        if alone.costs is None:
            return None
        measure = alone.costs.measure(objective)
        total = total * measure if multiplies(objective) else total + measure
    return total


def _served(problem: Problem, units: Sequence[int]) -> dict[int, list[int]]:
    """Return the goals that each unit of a tree, in an order that executes, is needed for.

    Each goal is followed back through the first achievers.
    """
    achievers: dict[int, int] = {}
    for unit in units:
        for o in problem.gives[unit]:
            if o not in problem.kitchen:
                achievers.setdefault(o, unit)
    served: dict[int, list[int]] = {unit: [] for unit in units}
    for goal in problem.goals:
        stack, seen = [goal], set[int]()
        while stack:
            achiever = achievers.get(stack.pop())
            if achiever is not None and achiever not in seen:
                seen.add(achiever)
                served[achiever].append(goal)
                stack.extend(problem.needs[achiever])
    return served
