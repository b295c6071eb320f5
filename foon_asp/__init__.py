"""Provably optimal task trees for FOON, by answer set programming.

>>> from pathlib import Path
>>> import foon_asp
>>> data = foon_asp.read_data(foon_asp.find_data(Path("data/kitchen")))
>>> goal = foon_asp.find_goal("ice", data.network, data.goals)
>>> problem = foon_asp.Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils)
>>> outcome = foon_asp.solve(problem, [foon_asp.Objective.SUCCESS])
>>> str(outcome.status), outcome.costs.units
('optimal', 3)
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
    from foon_asp.errors import BugError, UserError
    from foon_asp.network import FunctionalUnit, Network, NetworkBuilder, ObjectNode, Source, TaskTree
    from foon_asp.problem import ContainerRule, Costs, Objective, Problem
    from foon_asp.proof import Simulation, Verdict, simulate, simulate_for
    from foon_asp.text import FoonReader, find_data, find_goal, parse_node, read_data, write_units

__version__ = "0.1.0"

# Where each public name lives; a room is imported when a name of it is first asked for.
_ROOMS = {
    "asp": ("Outcome", "Reporter", "Settings", "Status", "solve"),
    "errors": ("BugError", "UserError"),
    "network": ("FunctionalUnit", "Network", "NetworkBuilder", "ObjectNode", "Source", "TaskTree"),
    "problem": ("ContainerRule", "Costs", "Objective", "Problem"),
    "proof": ("Simulation", "Verdict", "simulate", "simulate_for"),
    "text": ("FoonReader", "find_data", "find_goal", "parse_node", "read_data", "write_units"),
}

__all__ = [
    "BugError",
    "ContainerRule",
    "Costs",
    "FoonReader",
    "FunctionalUnit",
    "Network",
    "NetworkBuilder",
    "ObjectNode",
    "Objective",
    "Outcome",
    "Problem",
    "Reporter",
    "Settings",
    "Simulation",
    "Source",
    "Status",
    "TaskTree",
    "UserError",
    "Verdict",
    "find_data",
    "find_goal",
    "parse_node",
    "read_data",
    "simulate",
    "simulate_for",
    "solve",
    "write_units",
]


def __getattr__(name: str) -> object:
    for room, names in _ROOMS.items():
        if name in names:
            return getattr(importlib.import_module(f"foon_asp.{room}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
