"""Goals that cannot be made: they are left out of a problem, each with its cause."""

from dataclasses import replace

from foon_asp.problem import Problem, reach
from foon_asp.problem.dead_ends import Cause, dead_ends
from foon_asp.questions.answer import SkippedGoal
from foon_asp.questions.python_arguments import read_deferred
from foon_asp.results.values_of import node_of


def without_unreachable(problem: Problem) -> tuple[Problem, tuple[SkippedGoal, ...]]:
    """Return the problem with only the reachable goals, and the other goals with their causes.

    A goal is reachable if it can be made while items last and constraints are ignored. Where no goal is
    reachable, all stay in the problem, and no goal is skipped.
    """
    problem = read_deferred(problem)
    available = reach(problem).available
    reached = tuple(goal for goal in problem.goals if available[goal])
    unreached = [goal for goal in problem.goals if not available[goal]] if reached else []
    skipped = tuple(_skipped_goal(problem, goal) for goal in unreached)
    return (replace(problem, goals=reached) if skipped else problem), skipped


def _skipped_goal(problem: Problem, goal: int) -> SkippedGoal:
    """Return an unreachable goal with a cause: the first one on the path that lacks the fewest nodes.

    If the cause is a cycle, the result also has its number of nodes; otherwise this is 0.
    """
    root = dead_ends(replace(problem, goals=(goal,))).roots[0]
    cycle = root.cycle.nodes if root.cause is Cause.CYCLE and root.cycle else ()
    network = problem.network
    return SkippedGoal(node_of(network, goal), root.cause, node_of(network, root.object), len(cycle))
