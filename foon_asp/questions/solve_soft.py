"""The best tree under constraints that may be broken at a price: ``foon-asp solve --soft``."""

from collections.abc import Mapping, Sequence

from msgspec.structs import asdict

from foon_asp.asp import Settings
from foon_asp.asp.soft import solve_soft
from foon_asp.problem import Objective, Problem
from foon_asp.questions.answer import Answer, SoftConstraint
from foon_asp.questions.caller import caller
from foon_asp.questions.python_arguments import over_whole_network
from foon_asp.rules.passed_constraint import Constraint


def solve_under_soft_constraints(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, weights: Mapping[Constraint, int]
) -> Answer:
    """Return the answer of least penalty and, among trees of this penalty, the best by the objectives.

    Each way to break a constraint costs its weight (``weights``). The answer has the total penalty, and for
    each constraint in how many ways it is broken. The whole network is read.
    """
    current_caller = caller()
    outcome, penalty, constraints = solve_soft(
        over_whole_network(problem), objectives, settings, weights, current_caller.reporter
    )
    if current_caller.read_seconds is not None:
        outcome.seconds["read"] = current_caller.read_seconds
    listed = tuple(
        SoftConstraint(**asdict(rule.listed), weight=weight, broken=broken)
        for rule, weight, broken in constraints
    )
    return Answer.of(outcome, penalty=penalty, soft_constraints=listed)
