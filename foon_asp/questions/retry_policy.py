"""The greatest chance of success with retries: which tree to follow, and when to go on with another one."""

from typing import Unpack

from foon_asp.asp import Settings
from foon_asp.planning.policy import best_policy
from foon_asp.problem import Objective
from foon_asp.questions.alternatives import alternatives
from foon_asp.questions.answer import Answer, PolicyTree, RetryPolicy
from foon_asp.questions.caller import asked_by, caller
from foon_asp.questions.python_options import CommonOptions
from foon_asp.results.values_of import costed_tree


def with_policy(answer: Answer, retries: int, settings: Settings, **options: Unpack[CommonOptions]) -> Answer:
    """Return an answer with the retry policy that has the greatest chance of success.

    The policy chooses among up to four trees: that of the answer, and the best ones by success, which
    :func:`alternatives` finds. The policy is ``None`` if the answer has no tree. It is also ``None`` if a
    limit came first; a note of the answer then says so. Raises :class:`UserError` if no rates are known.

    Parameters:
        answer: The answer.
        retries: How many executions may fail in a run that succeeds.
        settings: The settings of the question, whose time has begun.
        options: The rules that the trees keep to; limits among them are ignored.
    """
    max_trees = 4  # that a policy follows
    problem = answer.problem
    problem.require_known_for([Objective.SUCCESS])
    if answer.ids is None:
        return answer.having(policy=None)
    for limit in ("time_limit", "memory_limit"):  # hold for the whole question
        options.pop(limit, None)  # type: ignore[misc]
    with asked_by(caller()._replace(deadline=settings.effective_deadline)):
        best_trees = alternatives(problem, Objective.SUCCESS, best=max_trees, **options)
    trees = [answer.ids]
    for tree in best_trees.trees:
        units = problem.network.units_of_numbers(tree.ids)
        if len(trees) < max_trees and set(units) not in map(set, trees):
            trees.append(units)
    try:
        with settings.effective_deadline.watched("comparing policies"):
            policy = best_policy(problem, trees, retries)
    except KeyboardInterrupt:
        settings.effective_deadline.interrupt()
        return answer.having(
            [f"no policy for retries: stopped at {settings.effective_deadline.stopped}"], policy=None
        )
    return answer.having(
        policy=RetryPolicy(
            retries=retries,
            chance=policy.chance,
            bound=policy.bound,
            is_exact=policy.is_exact,
            considered=len(trees),
            branches=tuple(
                PolicyTree(branch.failures, costed_tree(problem, branch.units, problem.costs(branch.units)))
                for branch in policy.branches
            ),
        )
    )
