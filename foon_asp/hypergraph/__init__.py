"""Presolve of a question before the search: reductions, an incumbent, and a lower bound.

Names are imported lazily: listing the reductions needs no search.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from foon_asp.hypergraph.exact_costs import ExactCosts as ExactCosts
    from foon_asp.hypergraph.gap_bounded_subproblem import Subproblem as Subproblem
    from foon_asp.hypergraph.reduction import BOUND as BOUND
    from foon_asp.hypergraph.reduction import Bounds as Bounds
    from foon_asp.hypergraph.reduction import Listener as Listener
    from foon_asp.hypergraph.reduction import Reduced as Reduced
    from foon_asp.hypergraph.reduction import reduce as reduce
    from foon_asp.hypergraph.reduction import reduce_under_rules as reduce_under_rules
    from foon_asp.hypergraph.reductions import ALL as ALL
    from foon_asp.hypergraph.reductions import NONE as NONE
    from foon_asp.hypergraph.reductions import SAFE as SAFE
    from foon_asp.hypergraph.reductions import Reduction as Reduction
    from foon_asp.hypergraph.reductions import parse_reductions as parse_reductions
    from foon_asp.hypergraph.solved_goals import SolvedGoals as SolvedGoals
else:  # not for type checkers, which then know each name
    _MODULES = {"ExactCosts": "exact_costs", "Subproblem": "gap_bounded_subproblem"}
    _MODULES["SolvedGoals"] = "solved_goals"
    _MODULES |= dict.fromkeys(
        ("BOUND", "Bounds", "Listener", "Reduced", "reduce", "reduce_under_rules"), "reduction"
    )
    _MODULES |= dict.fromkeys(("ALL", "NONE", "SAFE", "Reduction", "parse_reductions"), "reductions")

    def __getattr__(name: str) -> object:
        """Return an exported name; its module is imported at the first access."""
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f"foon_asp.hypergraph.{_MODULES[name]}"), name)
