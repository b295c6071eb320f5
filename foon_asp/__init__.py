"""Provably optimal task trees for FOON, by answer set programming.

>>> import foon_asp
>>> foon = foon_asp.load("data/kitchen")
>>> problem = foon.problem("ice")
>>> answer = foon_asp.solve(problem, "success")
>>> str(answer.status), answer.costs.units
('optimal', 3)

docs/api.md has a function for each question, with examples.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from foon_asp.api.alternatives import Alternatives, alternatives
    from foon_asp.api.answer import Answer, SoftAnswer, solve, solve_soft
    from foon_asp.api.assist import Assistance, assist
    from foon_asp.api.certified import Certified, VerifiedCertificate, certify, verify
    from foon_asp.api.check import Checked, check
    from foon_asp.api.clash import Clash, clash
    from foon_asp.api.comparison import Compared, compare_searches
    from foon_asp.api.cross_check import CrossChecked, cross_check
    from foon_asp.api.difference import Difference, diff
    from foon_asp.api.explanation import Explanation, why_not
    from foon_asp.api.menu import Menu, menu
    from foon_asp.api.pareto import Front, pareto
    from foon_asp.api.regret import Regrets, regret
    from foon_asp.api.retrieval import Retrieved, retrieve
    from foon_asp.api.shopping import Shopping, shopping_list
    from foon_asp.api.tree import Tree
    from foon_asp.asp import Outcome, Reporter, Status
    from foon_asp.errors import BugError, FoonWarning, UserError
    from foon_asp.foon import Foon, build, load
    from foon_asp.network import FunctionalUnit, Network, NetworkBuilder, ObjectNode, Source, TaskTree
    from foon_asp.problem import ContainerRule, Costs, Objective, Problem
    from foon_asp.proof import Simulation, Verdict
    from foon_asp.proof.verify import RefusedError
    from foon_asp.text import FoonReader, parse_node, write_units

__version__ = "0.1.0"

# Where each public name lives; a room is imported when a name of it is first asked for.
_ROOMS = {
    "api.alternatives": ("Alternatives", "alternatives"),
    "api.answer": ("Answer", "SoftAnswer", "solve", "solve_soft"),
    "api.assist": ("Assistance", "assist"),
    "api.certified": ("Certified", "VerifiedCertificate", "certify", "verify"),
    "api.check": ("Checked", "check"),
    "api.clash": ("Clash", "clash"),
    "api.comparison": ("Compared", "compare_searches"),
    "api.cross_check": ("CrossChecked", "cross_check"),
    "api.difference": ("Difference", "diff"),
    "api.explanation": ("Explanation", "why_not"),
    "foon": ("Foon", "build", "load"),
    "api.menu": ("Menu", "menu"),
    "api.pareto": ("Front", "pareto"),
    "api.regret": ("Regrets", "regret"),
    "api.retrieval": ("Retrieved", "retrieve"),
    "api.shopping": ("Shopping", "shopping_list"),
    "api.tree": ("Tree",),
    "asp": ("Outcome", "Reporter", "Status"),
    "errors": ("BugError", "FoonWarning", "UserError"),
    "network": ("FunctionalUnit", "Network", "NetworkBuilder", "ObjectNode", "Source", "TaskTree"),
    "problem": ("ContainerRule", "Costs", "Objective", "Problem"),
    "proof": ("Simulation", "Verdict"),
    "proof.verify": ("RefusedError",),
    "text": ("FoonReader", "parse_node", "write_units"),
}

__all__ = [
    "Alternatives",
    "Answer",
    "Assistance",
    "BugError",
    "Certified",
    "Checked",
    "Clash",
    "Compared",
    "ContainerRule",
    "Costs",
    "CrossChecked",
    "Difference",
    "Explanation",
    "Foon",
    "FoonReader",
    "FoonWarning",
    "Front",
    "FunctionalUnit",
    "Menu",
    "Network",
    "NetworkBuilder",
    "ObjectNode",
    "Objective",
    "Outcome",
    "Problem",
    "RefusedError",
    "Regrets",
    "Reporter",
    "Retrieved",
    "Shopping",
    "Simulation",
    "SoftAnswer",
    "Source",
    "Status",
    "TaskTree",
    "Tree",
    "UserError",
    "Verdict",
    "VerifiedCertificate",
    "alternatives",
    "assist",
    "build",
    "certify",
    "check",
    "clash",
    "compare_searches",
    "cross_check",
    "diff",
    "load",
    "menu",
    "pareto",
    "parse_node",
    "regret",
    "retrieve",
    "shopping_list",
    "solve",
    "solve_soft",
    "verify",
    "why_not",
    "write_units",
]


def __getattr__(name: str) -> object:
    for room, names in _ROOMS.items():
        if name in names:
            return getattr(importlib.import_module(f"foon_asp.{room}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    """Name what is public, for those who complete names with a key."""
    return [*__all__, "__version__"]
