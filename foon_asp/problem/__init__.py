"""One question over a network, and its cut down to what can matter."""

from foon_asp.problem.containers import (
    ContainerRule,
    conditions,
    container_rule,
    given_outputs,
    needed_inputs,
)
from foon_asp.problem.costs import Costs, tree_costs
from foon_asp.problem.number import Number, exact, success_rate, unit_price
from foon_asp.problem.objective import Known, Measured, Objective, Row, levels, multiplies, parse_objectives
from foon_asp.problem.order import executable_order
from foon_asp.problem.problem import (
    Changes,
    Names,
    Origin,
    Problem,
    UnitPricesNamed,
    Unpriced,
    count_unpriced,
    require_rates,
)
from foon_asp.problem.relevance import Reached, backwards, first_tree, reach, relevant
from foon_asp.problem.root import Root

__all__ = [
    "Changes",
    "ContainerRule",
    "Costs",
    "Known",
    "Measured",
    "Names",
    "Number",
    "Objective",
    "Origin",
    "Problem",
    "Reached",
    "Root",
    "Row",
    "UnitPricesNamed",
    "Unpriced",
    "backwards",
    "conditions",
    "container_rule",
    "count_unpriced",
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
    "tree_costs",
    "unit_price",
]
