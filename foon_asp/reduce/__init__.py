"""A question made small before it is searched, with a tree in hand and a bound on all others."""

from foon_asp.reduce.exact_costs import ExactCosts as ExactCosts
from foon_asp.reduce.reduction import Bounds as Bounds
from foon_asp.reduce.reduction import Listener as Listener
from foon_asp.reduce.reduction import Reduced as Reduced
from foon_asp.reduce.reduction import reduce as reduce
from foon_asp.reduce.reductions import ALL as ALL
from foon_asp.reduce.reductions import NONE as NONE
from foon_asp.reduce.reductions import SAFE as SAFE
from foon_asp.reduce.reductions import Reduction as Reduction
from foon_asp.reduce.reductions import parse_reductions as parse_reductions
from foon_asp.reduce.wide import Wide as Wide
