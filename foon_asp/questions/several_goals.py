"""Several goals of one tree: the optimum for each goal by itself, and the goals that each unit is for."""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.nearby import NearbyProblem
from foon_asp.problem import Objective, Problem, for_each_goal, levels, multiplies
from foon_asp.questions.answer import Alone, Answer, Serving, answer_under_rules
from foon_asp.results.values_of import node_of, nodes_of


class GoalsApartTuning(NamedTuple):
    """The limit of how many goals of a tree are also solved one by one.

    ``goals``: the greatest number of goals. Each goal takes one more search and one more line; for more goals
    there is the option ``--all-goals``.
    """

    goals: int = 8


def with_goals_apart(answer: Answer, settings: Settings, posed: Problem) -> Answer:
    """Return an answer with the goals that each unit of its tree is needed for.

    For up to eight goals, the answer also has the optimum for each goal by itself, and the sum of the optimal
    costs. ``posed`` is the problem that was asked about. If it is over a large store and not all of its units
    were read, the units for each goal are read separately.
    """
    problem, network = answer.problem, answer.problem.network
    serves = tuple(
        Serving(network.unit_number(unit), nodes_of(network, goals))
        for unit, goals in _goals_by_unit(problem, answer.outcome.units or ()).items()
    )
    if len(problem.goals) > GoalsApartTuning().goals:
        return answer.having(serves=serves)
    outcomes = _solve_apart(answer, settings, posed)
    nodes = [node_of(network, goal) for goal in problem.goals]
    return answer.having(
        goals_alone=tuple(
            Alone(node, outcome.status, outcome.costs) for node, outcome in zip(nodes, outcomes, strict=True)
        ),
        sum_of_goals_alone=_total_cost(outcomes, answer.objectives[0]),
        serves=serves,
    )


def _solve_apart(answer: Answer, settings: Settings, posed: Problem) -> list[Outcome]:
    """Return the best outcome for each goal by itself, in the order of the goals.

    Without rules, raises :class:`BugError` if one goal alone costs more than all goals together. ``posed`` is
    the problem that was asked about. Nothing is reported to the caller.
    """
    together, problem, objectives = answer.outcome, answer.problem, answer.objectives
    if isinstance(posed, NearbyProblem):
        problems = posed.single_goal_problems()
        outcomes = [
            answer_under_rules(goal_problem, objectives, settings, Reporter()).outcome
            for goal_problem in problems
        ]
    else:
        problems = for_each_goal(problem)
        outcomes = [solve(goal_problem, objectives, settings, Reporter()) for goal_problem in problems]
    if settings.constraints == () and settings.replaced is None:  # else goals may have rules of their own
        postconditions = Postconditions(problem, levels(objectives), settings)
        for goal, outcome in zip(problem.goals, outcomes, strict=True):
            postconditions.require_no_better(together, outcome, f"for goal {goal} alone")
    return outcomes


def _total_cost(outcomes: Sequence[Outcome], objective: Objective) -> int | Fraction | None:
    """Return the sum of the costs of the outcomes by an objective; for ``success``, the product.

    Return ``None`` if a goal has no tree.
    """
    total: int | Fraction = Fraction(1) if multiplies(objective) else 0
    for outcome in outcomes:
        if outcome.costs is None:
            return None
        measure = outcome.costs.measure(objective)
        total = total * measure if multiplies(objective) else total + measure
    return total


def _goals_by_unit(problem: Problem, units: Sequence[int]) -> dict[int, list[int]]:
    """Return, for each unit of a tree, the ids of the goals that it is needed for.

    ``units`` are in an order that executes. A goal needs its first achiever in this order, the first
    achievers of the inputs of that unit, and so on. Nodes of the kitchen need no unit. A unit that no goal
    needs has an empty list.
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
