"""One question over a network, and its cut down to what can matter."""

from foon_asp.problem.containers import (
    ContainerRule,
    conditions,
    container_rule,
    given_outputs,
    needed_inputs,
)
from foon_asp.problem.costs import Costs
from foon_asp.problem.number import Number, exact, success_rate
from foon_asp.problem.objective import Objective, levels, multiplies, parse_objectives
from foon_asp.problem.order import executable_order
from foon_asp.problem.problem import Names, Origin, Problem, require_rates
from foon_asp.problem.relevance import Reached, first_tree, reach, relevant
from foon_asp.problem.unit_count import unit_count

__all__ = [
    "ContainerRule",
    "Costs",
    "Names",
    "Number",
    "Objective",
    "Origin",
    "Problem",
    "Reached",
    "conditions",
    "container_rule",
    "exact",
    "executable_order",
    "first_tree",
    "given_outputs",
    "levels",
    "multiplies",
    "needed_inputs",
    "parse_objectives",
    "reach",
    "relevant",
    "require_rates",
    "success_rate",
    "unit_count",
]
