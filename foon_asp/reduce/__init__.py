"""A question made small before it is searched, with a tree in hand and a bound on all others."""

from foon_asp.reduce.exact_costs import ExactCosts
from foon_asp.reduce.reduction import Listener, Reduced, reduce
from foon_asp.reduce.reductions import ALL, NONE, SAFE, Reduction, parse_reductions

__all__ = [
    "ALL",
    "NONE",
    "SAFE",
    "ExactCosts",
    "Listener",
    "Reduced",
    "Reduction",
    "parse_reductions",
    "reduce",
]
